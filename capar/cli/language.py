"""Language: describe a capture, read sentences, look verbs up, report on them."""

from collections.abc import Iterable
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import (
    Beside,
    Capture,
    Corrected,
    Json,
    New,
    OutputFile,
    Place,
    ProfileName,
    Rules,
    confirm_new,
    open_words,
    opened,
    rule_base,
    rule_words,
)
from capar.cli.output import check_writable, emit, print_json

if TYPE_CHECKING:
    from rich.console import Console

    from capar.model.observation import Observation
    from kb.language import Question
    from kb.lexicon.verbs import Fit, Seen, VerbAnswer
    from kb.store.stores import Store


class Detail(StrEnum):
    """How much is described."""

    STEPS = "steps"
    SUMMARY = "summary"


def describe(
    capture: Capture,
    detail: Annotated[
        Detail, Option(help="Every step, or a summary of what changed.")
    ] = Detail.STEPS,
    timed: Annotated[bool, Option("--timed", help="Say when each step was.")] = False,
    profile: ProfileName = "extended",
    corrected: Corrected = False,
    rules: Rules = None,
    actionary: Beside = None,
    json: Json = False,
) -> None:
    """Say in plain English what was done in a capture."""
    from capar.pipelines.observation import observe
    from capar.views.notices import reservation_lines, reservations_on_told
    from kb.language.describe import describe as told
    from kb.language.describe import nouns

    observation = observe(capture, rules=rule_base(profile, rules, actionary))
    if corrected:
        observation = _corrected(observation, actionary)
    words = rule_words(rules, actionary)
    text = told(observation, detail=detail.value, timed=timed, words=words)
    notices = reservations_on_told(observation)
    if json:
        told_of = {"capture": observation.capture, "description": text}
        print_json(told_of | {"notices": [each.document() for each in notices]}, sort_keys=True)
    else:
        typer.echo(
            "\n".join((text, *reservation_lines(notices, called=nouns(observation.objects))))
        )


def _corrected(observation: "Observation", actionary: str | None) -> "Observation":
    """The same with the segments that persons claim in an Actionary."""
    from dataclasses import replace

    from kb import Actionary
    from kb.corrections import claims, corrected_links

    with Actionary.open(actionary, read_only=True) as opened:
        said = claims(opened.store, observation.capture)
    links = corrected_links(observation.links, said)
    return replace(observation, links=links, relations=(), joint=())


def parse(
    sentence: Annotated[
        str, Argument(help="Such as: pick up the mug with both hands and put it in the box")
    ],
    actionary: Place = None,
    rules: Rules = None,
    json: Json = False,
) -> None:
    """Read instructions, a description, or a question in English.

    A question is one such as 'who moved the mug to the table?'.

    With an Actionary, objects and performers are those that it knows, and a question is answered;
    without one any noun will do.
    """
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


FIRST_SENSES = 4
"""How many of a verb's most frequent senses are shown beside those as a motion."""


def verb(
    lemma: Annotated[str, Argument(help="A verb, such as carry or 'pick up'.")] = "",
    segment: Annotated[
        str, Option("--for", help="A segment, as CAPTURE/END_EFFECTOR/INDEX: which verbs fit it?")
    ] = "",
    kinds: Annotated[
        bool, Option("--kinds", help="Which primitives do the verb, or a kind of it?")
    ] = False,
    actionary: Place = None,
    rules: Rules = None,
    most: Annotated[int, Option(help="How many verbs of a segment to show.", min=1)] = 15,
    json: Json = False,
) -> None:
    """Say what is known of a verb, or which verbs fit a segment.

    That is its senses, classes, roles, primitives, and where it was seen.
    """
    from capar.model.errors import CaparError

    if bool(lemma) == bool(segment):
        raise CaparError("name a verb, or a segment with --for CAPTURE/END_EFFECTOR/INDEX")
    place = opened(actionary)
    words = rule_words(rules, place)
    with open_words(actionary) as store:
        if segment:
            from capar.pipelines.language import verbs_for

            base = rule_base("extended", rules, place)
            _print_fits(verbs_for(segment, words, store=store, rules=base)[:most], json=json)
        elif kinds:
            from kb.lexicon.verbs import keys_of_primitives
            from kb.lexicon.verbs import kinds as kinds_of

            names = kinds_of(lemma, keys_of_primitives(words))
            _print_kinds(lemma, names, store, json=json)
        else:
            from capar.pipelines.linguistic_report import answer_verb
            from kb.lexicon.verbs import doubts_of

            for doubt in doubts_of(words):
                typer.echo(f"note [unknown-word]: {doubt}", err=True)
            _print_verb(answer_verb(lemma, words, store=store), json=json)


def _print_verb(answer: "VerbAnswer", *, json: bool) -> None:
    from kb.lexicon.verbs import often, summed

    if json:
        print_json(answer, sort_keys=True)
        return
    from rich.console import Console

    console = Console(highlight=False, soft_wrap=True)
    console.print(f"[bold]{answer.verb}[/]: {answer.standing.words}.")
    shown = [each for each in answer.senses if each.motion or each.sense.number <= FIRST_SENSES]
    for sense in shown:
        mark, gloss = "→" if sense.motion else " ", sense.synset.definition
        console.print(f" {mark} {sense.sense.number}. {gloss} [dim]{sense.sense.key}[/]")
    if len(shown) < len(answer.senses):
        console.print(f"   and {len(answer.senses) - len(shown)} more senses (--json shows all)")
    _print_classes(console, answer)
    for near in answer.neighbours:
        by = f" ({', '.join(near.primitives)})" if near.primitives else ""
        console.print(f"{near.relation} {', '.join(near.verbs)}{by}: [dim]{near.definition}[/]")
    for claim in answer.claims:
        console.print(f"Thesis {claim.section}: {claim.status.value}. {claim.reason}")
    for seen in summed(answer.seen):
        console.print(f"Seen: {seen.primitive} in {seen.observation}, {often(seen.count)}.")
    if answer.general_seen:
        console.print(f"Not seen; what is more general was: {_in_all(answer.general_seen)}.")


def _in_all(seen: "Iterable[Seen]") -> str:
    """Primitives with how often each was seen in every observation together."""
    from kb.lexicon.verbs import often, summed

    sums = summed(replace(each, observation="") for each in seen)
    return ", ".join(f"{each.primitive} {often(each.count)}" for each in sums)


def _print_classes(console: "Console", answer: "VerbAnswer") -> None:
    for found in answer.classes:
        title = (
            f"Levin {found.levin.number} {found.levin.title}" if found.levin else "no Levin class"
        )
        verbnet = f", VerbNet {found.verbnet}" if found.verbnet else ""
        roles = f": {', '.join(found.roles)}" if found.roles else ""
        console.print(f"{title}{verbnet}{roles}")
        if found.frame and found.frame.example:
            meaning = " ".join(map(str, found.frame.semantics))
            console.print(f"   “{found.frame.example}” [dim]{meaning}[/]")
    if not any(each.verbnet for each in answer.classes):
        console.print("[dim]VerbNet's classes come with `capar lexicon import verbnet DIR`.[/]")


def _print_kinds(lemma: str, names: tuple[str, ...], store: "Store | None", *, json: bool) -> None:
    from kb.lexicon.verbs import often, seen_in, summed

    seen = [each for each in (seen_in(store) if store else ()) if each.primitive in names]
    if json:
        print_json({"verb": lemma, "primitives": names, "seen": seen}, sort_keys=True)
        return
    typer.echo(f"{lemma}, and every kind of it: {', '.join(names) or 'no primitive'}")
    for row in summed(seen):
        typer.echo(f"  {row.observation}: {row.primitive}, {often(row.count)}")


def _print_fits(fits: "tuple[Fit, ...]", *, json: bool) -> None:

    if json:
        print_json(fits, sort_keys=True)
        return
    for number, each in enumerate(fits, 1):
        typer.echo(f"{number:2d}. {each.verb}  ({each.source})")
        for reason in each.reasons:
            typer.echo(f"      + {reason}")
        for reason in each.against:
            typer.echo(f"      - {reason}")


lexicon = typer.Typer(no_args_is_help=True, help="Words in an Actionary: WordNet, Levin, VerbNet.")


@lexicon.command()
def load(actionary: Place = None, rules: Rules = None, new: New = False) -> None:
    """Load WordNet's verbs, Levin's classes and primitives' links, once."""
    from kb.actionary import Actionary
    from kb.lexicon.loading import load_words

    confirm_new(actionary, new=new)
    words = rule_words(rules, opened(actionary))
    with Actionary.open(actionary) as book:
        loaded = load_words(book.store, words)
    typer.echo("The words are loaded." if loaded else "The words were there already.")


@lexicon.command("import")
def import_words(
    source: Annotated[str, Argument(help="What to import: verbnet.")],
    folder: Annotated[Path, Argument(help="The folder with VerbNet's XML files.")],
    actionary: Place = None,
    new: New = False,
    json: Json = False,
) -> None:
    """Read VerbNet 3.x from your own copy, in place of an earlier one."""
    from capar.model.errors import UnknownNameError
    from kb.actionary import Actionary
    from kb.lexicon.loading import load_verbnet
    from kb.lexicon.verbnet import key_rate, read_verbnet
    from kb.lexicon.wordnet import wordnet

    if source != "verbnet":
        raise UnknownNameError("source of words", source, ("verbnet",))
    confirm_new(actionary, new=new)
    classes = read_verbnet(folder)
    rate = key_rate(classes, wordnet())
    with Actionary.open(actionary) as book:
        loaded = load_verbnet(book.store, classes, wordnet())
    every = [each for top in classes for each in top.family]
    figures = {
        "files": len(classes),
        "classes": len(every),
        "members": sum(len(each.members) for each in every),
        "keys": rate.keys,
        "keys_resolved": rate.resolved,
        "loaded": loaded,
    }
    if json:
        print_json(figures, sort_keys=True)
        return
    typer.echo(
        f"{len(classes)} files with {len(every)} classes and {figures['members']} members; "
        f"{rate.resolved} of {rate.keys} WordNet keys ({100 * rate.share:.1f} %) "
        "are in WordNet 3.1."
    )
    if not loaded:
        typer.echo("The Actionary had them already.")


reports = typer.Typer(no_args_is_help=True, help="Reports over the rule base and an Actionary.")


@reports.callback()
def _reports() -> None:
    """Reports over the rule base and an Actionary."""


class Format(StrEnum):
    """How a report is written."""

    TEXT = "text"
    MD = "md"
    HTML = "html"
    CSV = "csv"
    JSON = "json"
    LATEX = "latex"
    SVG = "svg"


@reports.command()
def linguistics(
    actionary: Place = None,
    form: Annotated[
        Format, Option("--format", help="How to write it; svg is the drawing alone.")
    ] = Format.TEXT,
    rules: Rules = None,
    output: OutputFile = None,
    cases: Annotated[
        Path | None, Option(help="Folder of rule cases that count as proof, as tests/rules.")
    ] = None,
    corrected: Corrected = False,
    json: Annotated[bool, Option("--json", help="The same as --format json.")] = False,
) -> None:
    """Report which verbs and verb classes are addressed, with the proof."""
    from capar.pipelines.linguistic_report import cases_of, primitive_files
    from capar.pipelines.linguistic_report import linguistics as report_of
    from kb.reports.formats import write

    if output is not None:
        check_writable(output)
    files = primitive_files(rule_base("extended", rules, opened(actionary)).added)
    with open_words(actionary, corrected=corrected) as store:
        report = report_of(files, store=store, cases=cases_of(files, cases))
    emit(write(report, Format.JSON.value if json else form.value), output)
