"""Controlled English in; an instruction or a question out."""

from typing import Annotated

import typer

from capar.cli._options import Rules, opened

app = typer.Typer()


@app.command()
def parse(
    sentence: Annotated[
        str,
        typer.Argument(help="Such as: move the mug from the table to the head with the right hand"),
    ],
    actionary: Annotated[
        str | None, typer.Option(help="Folder or address; else CAPAR_ACTIONARY, else ./actionary.")
    ] = None,
    rules: Rules = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Read an instruction, or a question such as 'who moved the mug to the table?'.

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
        if not isinstance(value, Question):
            if json:
                print_json(value, sort_keys=True)
            else:
                typer.echo(_instruction(value))
            return
        answers = list(store.ask(value.sparql).plain()) if store else None
        if json:
            print_json(
                {
                    "asks": value.ask.value,
                    "about": value.about,
                    "sparql": value.sparql,
                    "answers": answers,
                },
                sort_keys=True,
            )
        elif answers is None:
            typer.echo(value.sparql)
        else:
            _print_answers(answers)


def _instruction(value: object) -> str:
    from kb.language import Instruction

    assert isinstance(value, Instruction)
    lines = [f"action   {value.call.action}", f"objects  {', '.join(value.call.objects) or 'none'}"]
    said = {
        "agent": value.agent,
        "ee": value.ee,
        "from": value.source,
        "purpose": value.call.purpose,
    }
    return "\n".join([*lines, *(f"{name:<9}{each}" for name, each in said.items() if each)])


def _print_answers(
    answers: list[dict[str, object]] | list[dict[str, str | int | float | bool | None]],
) -> None:
    if not answers:
        typer.echo("Nobody did, in any observation.")
    for row in answers:
        typer.echo(
            "  ".join(f"{name}: {_short(each)}" for name, each in row.items() if each is not None)
        )


def _short(value: object) -> object:
    """A number to milliseconds, for people."""
    return round(value, 3) if isinstance(value, float) else value
