"""What a verb means to the system, and which verbs fit a segment."""

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._options import Rules, opened, rule_base

if TYPE_CHECKING:
    from rich.console import Console

    from kb.lexicon.evidence import Seen
    from kb.lexicon.fitting import Fit
    from kb.lexicon.verb_report import VerbAnswer
    from kb.store.stores import Store

app = typer.Typer()

FIRST_SENSES = 4
"""How many of a verb's most frequent senses are shown beside those as a motion."""


@app.command()
def verb(
    lemma: Annotated[str, typer.Argument(help="A verb, such as carry or 'pick up'.")] = "",
    segment: Annotated[
        str,
        typer.Option("--for", help="A segment, as CAPTURE/END_EFFECTOR/INDEX: which verbs fit it?"),
    ] = "",
    kinds: Annotated[
        bool, typer.Option("--kinds", help="Which primitives do the verb, or a kind of it?")
    ] = False,
    actionary: Annotated[
        str | None, typer.Option(help="Folder or address; else CAPAR_ACTIONARY, else ./actionary.")
    ] = None,
    rules: Rules = None,
    most: Annotated[int, typer.Option(help="How many verbs of a segment to show.", min=1)] = 15,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Say what is known of a verb: senses, classes, roles, primitives, and where it was seen."""
    from capar.cli._options import open_words, rule_words
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
            from kb.lexicon.verb_report import keys_of_primitives
            from kb.lexicon.verb_report import kinds as kinds_of

            names = kinds_of(lemma, keys_of_primitives(words))
            _print_kinds(lemma, names, store, json=json)
        else:
            from capar.pipelines.linguistic_report import answer_verb
            from kb.lexicon.claims import doubts_of

            for doubt in doubts_of(words):
                typer.echo(f"note [unknown-word]: {doubt}", err=True)
            _print_verb(answer_verb(lemma, words, store=store), json=json)


def _print_verb(answer: "VerbAnswer", *, json: bool) -> None:
    from capar.cli._output import print_json
    from kb.lexicon.evidence import often, summed

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
    from kb.lexicon.evidence import often, summed

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
    from capar.cli._output import print_json
    from kb.lexicon.evidence import often, seen_in, summed

    seen = [each for each in (seen_in(store) if store else ()) if each.primitive in names]
    if json:
        print_json({"verb": lemma, "primitives": names, "seen": seen}, sort_keys=True)
        return
    typer.echo(f"{lemma}, and every kind of it: {', '.join(names) or 'no primitive'}")
    for row in summed(seen):
        typer.echo(f"  {row.observation}: {row.primitive}, {often(row.count)}")


def _print_fits(fits: "tuple[Fit, ...]", *, json: bool) -> None:
    from capar.cli._output import print_json

    if json:
        print_json(fits, sort_keys=True)
        return
    for number, each in enumerate(fits, 1):
        typer.echo(f"{number:2d}. {each.verb}  ({each.source})")
        for reason in each.reasons:
            typer.echo(f"      + {reason}")
        for reason in each.against:
            typer.echo(f"      - {reason}")
