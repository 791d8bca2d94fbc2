"""The commands that help to write a rule: a first draft, and the words that it may use."""

from pathlib import Path
from typing import Annotated

import typer

from capar.cli._actionary import Place
from capar.cli._rules import Rules, has_actionary, opened, rule_base

Base = Annotated[str, typer.Option("--profile", help="The rules: extended or thesis.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]


def new(
    name: Annotated[str, typer.Argument(help="What the primitive is called, such as Lift.")],
    source: Annotated[
        str | None,
        typer.Option(
            "--from",
            help="A segment whose features it has, as CAPTURE/END_EFFECTOR/INDEX. "
            "CAPTURE may also be the name of an observation in the Actionary.",
        ),
    ] = None,
    features: Annotated[
        str | None,
        typer.Option(help="START,END,CHANGE,FORCE in bits, such as 100,101,10,00."),
    ] = None,
    definition: Annotated[str, typer.Option(help="What it is, in words.")] = "",
    general: Annotated[str, typer.Option(help="The primitive that it specialises.")] = "",
    verb: Annotated[str, typer.Option(help="The verb for it.")] = "",
    out: Annotated[Path | None, typer.Option(help="The file to write; else it is printed.")] = None,
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
) -> None:
    """Write a rule file for NAME from a segment or a feature set, ready to be edited."""
    from capar.cli._places import written
    from capar.model.errors import FileError, RuleError
    from capar.rulebook.drafts import rule_from_features, rule_from_segment

    words = {"definition": definition, "general": general, "verb": verb}
    if (source is None) == (features is None):
        raise RuleError(
            "say either --from CAPTURE/END_EFFECTOR/INDEX or --features START,END,CHANGE,FORCE"
        )
    place = opened(actionary)
    base = rule_base(profile, rules, place)
    if source is not None:
        kept = place if has_actionary(place, named=actionary) else None
        text = rule_from_segment(name, source, rules=base, actionary=kept, **words)
    else:
        text = rule_from_features(name, features or "", rules=base, **words)
    if out is None:
        typer.echo(text, nl=False)
        return
    if out.exists():
        raise FileError(out, "exists already.", "Choose another file.")
    with written(out) as draft:
        draft.write_text(text, encoding="utf-8")
    typer.echo(f"wrote {out}; edit it, then: capar rules check {out}", err=True)


def list_words(
    name: Annotated[str | None, typer.Argument(help="One word, such as carried_off.")] = None,
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Explain the words of rules: what a rule file may read or state, and with which arguments.

    With NAME also where it is defined, and by which rules.
    """
    from capar.cli._words_of_rules import print_glossary, print_word, print_words_json
    from capar_rules.authoring.glossary import glossary

    found = glossary(rule_base(profile, rules, opened(actionary)))
    if json:
        print_words_json(found, name)
    elif name:
        print_word(found, name)
    else:
        print_glossary(found)
