"""English in; instructions or the answer to a question out."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from capar.cli._options import Rules, opened

if TYPE_CHECKING:
    from kb.language import Question
    from kb.store.stores import Store

app = typer.Typer()


@app.command()
def parse(
    sentence: Annotated[
        str,
        typer.Argument(help="Such as: pick up the mug with both hands and put it in the box"),
    ],
    actionary: Annotated[
        str | None, typer.Option(help="Folder or address; else CAPAR_ACTIONARY, else ./actionary.")
    ] = None,
    rules: Rules = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Read instructions, a description, or a question such as 'who moved the mug to the table?'.

    With an Actionary, objects and performers are those that it knows, and a question is answered;
    without one any noun will do.
    """
    from capar.cli._options import open_words, rule_words
    from capar.cli._output import print_json
    from capar.pipelines.language import vocabulary
    from kb.language import Question
    from kb.language import parse as read

    words = rule_words(rules, opened(actionary))
    with open_words(actionary) as store:
        value = read(sentence, vocabulary(words, store))
        if isinstance(value, Question):
            _ask(value, store, json=json)
        elif json:
            print_json(value, sort_keys=True)
        else:
            from capar.views.readings import reading_lines

            typer.echo("\n".join(reading_lines(value)))


def _ask(value: "Question", store: "Store | None", *, json: bool) -> None:
    from capar.cli._output import print_json
    from capar.views.readings import answer_lines, question_lines

    queries = (value.sparql, *value.others)
    answers: list[list[Any]] | None = None
    if store is not None:
        answers = [list(value.chosen(list(store.ask(each).plain()))) for each in queries]
    if json:
        told: dict[str, object] = {
            "asks": value.ask.value,
            "about": value.about,
            "sparql": value.sparql,
        }
        told |= {"rank": value.rank, "others": (*value.alternatives, *value.also)}
        told |= {"answers": None if answers is None else answers[0]}
        told |= {"other_answers": None if answers is None else answers[1:]}
        print_json(told, sort_keys=True)
        return
    typer.echo("\n".join(question_lines(value)))
    if answers is None:
        typer.echo("\n".join(queries))
        return
    for about, rows in zip((value.about, *value.alternatives, *value.also), answers, strict=True):
        typer.echo("\n".join(answer_lines(value, about, rows)))
