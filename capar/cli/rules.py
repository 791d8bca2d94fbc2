"""The commands for rules that people write, from a first draft to their place in the rule base."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli._actionary import Place

if TYPE_CHECKING:
    from capar.rule_changes import Renamed
    from capar_rules.profiles import Profile

app = typer.Typer(no_args_is_help=True)

Rules = Annotated[
    Path | None,
    typer.Option("--rules", help="Folder of your own rule files; else CAPAR_RULES, else ./rules."),
]
Base = Annotated[str, typer.Option("--profile", help="The rules: extended or thesis.")]
File = Annotated[Path, typer.Argument(help="A rule file.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.callback()
def _root() -> None:
    """Write primitives as rules: checked before they count, their effect shown before they do."""


def _base(profile: str, rules: Path | None) -> "Profile":
    from capar_rules.authoring import user_rules
    from capar_rules.profiles import profile as named_profile

    return named_profile(profile, added=user_rules(rules))


@app.command("list")
def list_rules(profile: Base = "extended", rules: Rules = None, json: Json = False) -> None:
    """List every primitive, what it specialises, and what it is."""
    from dataclasses import asdict

    from capar_rules.authoring import rules_of

    found = rules_of(_base(profile, rules))
    if json:
        _json([asdict(each) for each in found])
        return
    for each in found:
        general = f" < {', '.join(each.general)}" if each.general else ""
        typer.echo(f"{each.origin}  {each.name}{general}: {each.definition}")


@app.command()
def show(
    name: Annotated[str, typer.Argument(help="A primitive.")],
    profile: Base = "extended",
    rules: Rules = None,
) -> None:
    """Print the rule file of a primitive."""
    from capar_rules.authoring import rule_of

    info = rule_of(_base(profile, rules), name)
    typer.echo(Path(info.file).read_text(encoding="utf-8"), nl=False)


@app.command()
def new(
    name: Annotated[str, typer.Argument(help="What the primitive is called, such as Lift.")],
    source: Annotated[
        str | None,
        typer.Option("--from", help="CAPTURE:SEGMENT whose features it has: take:right_hand/3."),
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
) -> None:
    """Write a rule file for NAME from a segment or a feature set, ready to be edited."""
    from capar.model.errors import FileError, RuleError
    from capar.rule_changes import rule_from_features, rule_from_segment

    words = {"definition": definition, "general": general, "verb": verb}
    if (source is None) == (features is None):
        raise RuleError("say either --from CAPTURE:SEGMENT or --features START,END,CHANGE,FORCE")
    if source is not None:
        text = rule_from_segment(name, source, rules=_base(profile, rules), **words)
    else:
        text = rule_from_features(name, features or "", **words)
    if out is None:
        typer.echo(text, nl=False)
        return
    if out.exists():
        raise FileError(out, "exists already.", "Choose another file.")
    out.write_text(text, encoding="utf-8")
    typer.echo(f"wrote {out}; edit it, then: capar rules check {out}", err=True)


@app.command()
def check(file: File, profile: Base = "extended", rules: Rules = None, json: Json = False) -> None:
    """Say what is wrong with FILE, with line and column; nothing of it is run."""
    from capar_rules.authoring import user_rules
    from capar_rules.checking import check as checked
    from capar_rules.findings import errors

    beside = [each for each in user_rules(rules) if each.resolve() != file.resolve()]
    findings = checked(file, profile=profile, beside=beside)
    if json:
        _json([each.as_json() for each in findings])
    else:
        for each in findings:
            typer.echo(str(each))
        if not findings:
            typer.echo(f"{file}: nothing is wrong")
    if errors(findings):
        raise typer.Exit(1)


@app.command()
def test(file: File, profile: Base = "extended", rules: Rules = None) -> None:
    """Run the examples that FILE carries: what it must match, and what it must not."""
    from capar_rules.authoring import try_rule, user_rules
    from capar_rules.checking import check as checked
    from capar_rules.checking import require

    require(file, checked(file, profile=profile, beside=_others(file, user_rules(rules))))
    failures = try_rule(file, base=profile, beside=user_rules(rules))
    for each in failures:
        typer.echo(each)
    if failures:
        raise typer.Exit(1)
    typer.echo(f"{file}: its examples hold")


def _others(file: Path, files: tuple[Path, ...]) -> list[Path]:
    return [each for each in files if each.resolve() != file.resolve()]


@app.command()
def add(
    file: File,
    over: Annotated[
        list[str] | None,
        typer.Option(help="A primitive that it is to be more specific than; may be repeated."),
    ] = None,
    reclassify: Annotated[
        bool, typer.Option("--reclassify", help="Rename the stored segments that it changes.")
    ] = False,
    captures: Annotated[
        list[Path] | None,
        typer.Option(help="With --reclassify: a folder that holds captures; else this one."),
    ] = None,
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
) -> None:
    """Take FILE among your rules, once it is checked, unambiguous, and its examples hold."""
    from capar.rule_changes import reclassified
    from capar_rules.authoring import add_rule
    from capar_rules.teaching import rules_folder

    before = _base(profile, rules if rules and rules.is_dir() else None)
    added = add_rule(file, folder=rules_folder(rules), base=profile, over=over or ())
    typer.echo(f"added {added}")
    if reclassify:
        changed = reclassified(
            actionary,
            before=before,
            after=_base(profile, added.parent),
            captures=captures or [Path()],
        )
        _print_changes(changed)


@app.command()
def remove(
    name: Annotated[str, typer.Argument(help="A primitive of yours.")], rules: Rules = None
) -> None:
    """Take a primitive out of your rules."""
    from capar_rules.authoring import remove_rule
    from capar_rules.teaching import rules_folder

    typer.echo(f"removed {remove_rule(name, folder=rules_folder(rules))}")


@app.command()
def diff(
    file: File,
    on: Annotated[
        list[str] | None,
        typer.Option(help="A capture to compare on, instead of the Actionary; may be repeated."),
    ] = None,
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Show which segments, of which captures, would change their name if FILE were added."""
    from dataclasses import asdict

    from capar.rule_changes import captured_facts, renamed, stored_facts
    from capar_rules.checking import check as checked
    from capar_rules.checking import require
    from capar_rules.profiles import profile as named_profile

    before = _base(profile, rules)
    findings = checked(file, profile=profile, beside=_others(file, before.added))
    require(file, [each for each in findings if each.code != "ambiguous"])
    after = named_profile(profile, added=(*_others(file, before.added), file))
    seen = captured_facts(on) if on else stored_facts(actionary)
    changes = renamed(seen, before=before, after=after)
    if json:
        _json([asdict(each) for each in changes])
    else:
        _print_changes(changes)


def _print_changes(changes: "tuple[Renamed, ...]") -> None:
    for each in changes:
        typer.echo(
            f"{each.capture}  {each.ee}/{each.index}  {each.start_s:.2f} to {each.end_s:.2f} s: "
            f"{each.before} -> {each.after}"
        )
    typer.echo("1 segment changes" if len(changes) == 1 else f"{len(changes)} segments change")


@app.command()
def audit(profile: Base = "extended", rules: Rules = None, json: Json = False) -> None:
    """Audit the whole rule base over every segment that there can be."""
    from dataclasses import asdict

    from capar_rules.auditing import audit as audited

    found = audited(_base(profile, rules))
    if json:
        _json({**asdict(found), "clean": found.clean})
    else:
        _print_audit(found)
    if not found.clean:
        raise typer.Exit(1)


def _print_audit(found: object) -> None:
    from capar_rules.auditing import Audit

    assert isinstance(found, Audit)
    reasons = dict(found.excused)
    typer.echo(f"{found.possible} feature sets can be; {len(found.uncovered)} have no name")
    for each in found.uncovered:
        shown = " ".join(part or "-" for part in each)
        typer.echo(f"  {shown}: {reasons.get(each, 'NO REASON GIVEN')}")
    for clash in found.ambiguous:
        where = " ".join(part or "-" for part in clash.features[0])
        typer.echo(f"ambiguous: {clash.first} and {clash.second}, first at {where}")
    for name in found.shadowed:
        typer.echo(f"shadowed: {name}")
    for name in found.unreachable:
        typer.echo(f"never fits in the audit's world: {name}")
    typer.echo("the rules are clean" if found.clean else "the rules are not clean")


def _json(content: object) -> None:
    import json

    typer.echo(json.dumps(content, indent=2))
