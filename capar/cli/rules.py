"""The commands for rules that people write, from a first draft to their place in the rule base."""

from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import Place, Rules, has_actionary, opened, require_actionary, rule_base
from capar.cli._output import print_json
from capar.cli._rule_writing import (
    Base,
    Json,
    list_words,
    new,
    print_audit,
    print_bearing,
    print_changes,
    print_others,
    print_precedence,
)

app = typer.Typer(no_args_is_help=True)

File = Annotated[Path, typer.Argument(help="A rule file.")]
Reclassify = Annotated[
    bool, typer.Option("--reclassify", help="Rename the stored segments that this changes.")
]
Captures = Annotated[
    list[Path] | None,
    typer.Option(help="With --reclassify: a folder that holds captures; else this one."),
]


@app.callback()
def _root() -> None:
    """Write primitives as rules: checked before they count, their effect shown before they do."""


def _others(file: Path, rules: Path | None, actionary: str | None) -> tuple[Path, ...]:
    """The rule files that people wrote, without this one."""
    from capar_rules.authoring.user_rules import user_rules

    files = user_rules(rules, actionary=opened(actionary))
    return tuple(each for each in files if each.resolve() != file.resolve())


@app.command("list")
def list_rules(
    profile: Base = "extended", rules: Rules = None, actionary: Place = None, json: Json = False
) -> None:
    """List every primitive: where it comes from, what it specialises, and what it is.

    Rules that ship are core, those in the Actionary's folder rules are user, and those in a folder
    that --rules or CAPAR_RULES names, or else in ./rules, are project.
    """
    from dataclasses import asdict

    from capar_rules.authoring.user_primitives import rules_of

    place = opened(actionary)
    found = rules_of(rule_base(profile, rules, place), actionary=place)
    if json:
        print_json([asdict(each) for each in found])
        return
    for entry in found:
        general = f" < {', '.join(entry.general)}" if entry.general else ""
        typer.echo(f"{entry.origin}  {entry.name}{general}: {entry.definition}")


@app.command()
def show(
    name: Annotated[str, typer.Argument(help="A primitive.")],
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
) -> None:
    """Print the rule file of a primitive."""
    from capar_rules.authoring.user_primitives import rule_of

    info = rule_of(rule_base(profile, rules, opened(actionary)), name)
    typer.echo(Path(info.file).read_text(encoding="utf-8"), nl=False)


@app.command()
def check(
    file: File,
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
    json: Json = False,
) -> None:
    """Say what is wrong with FILE, with line and column; nothing of it is run."""
    from capar_rules.lint.checking import check as checked
    from capar_rules.lint.findings import errors

    findings = checked(file, profile=profile, beside=_others(file, rules, actionary))
    if json:
        print_json([each.as_json() for each in findings])
    else:
        for finding in findings:
            typer.echo(str(finding))
        if not findings:
            typer.echo(f"{file}: nothing is wrong")
    if errors(findings):
        raise typer.Exit(2)


@app.command()
def test(
    file: File, profile: Base = "extended", rules: Rules = None, actionary: Place = None
) -> None:
    """Run the examples that FILE carries: what it must match, and what it must not."""
    from capar_rules.authoring.user_primitives import try_rule
    from capar_rules.lint.admission import admit
    from capar_rules.lint.checking import check as checked
    from capar_rules.lint.checking import require

    beside = _others(file, rules, actionary)
    admit(beside, profile=profile)
    require(file, checked(file, profile=profile, beside=beside))
    failures = try_rule(file, base=profile, beside=beside)
    for failure in failures:
        typer.echo(failure)
    if failures:
        raise typer.Exit(2)
    typer.echo(f"{file}: its examples hold")


@app.command()
def add(
    file: File,
    over: Annotated[
        list[str] | None,
        typer.Option(
            help="A primitive that it precedes where both fit; may be repeated. all stands for "
            "each that names a segment with it, or may. It is written into the file."
        ),
    ] = None,
    kind_of: Annotated[
        list[str] | None,
        typer.Option(
            help="A primitive that it is a kind of; may be repeated. It is written into the file."
        ),
    ] = None,
    reclassify: Reclassify = False,
    captures: Captures = None,
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
) -> None:
    """Take FILE among your rules, once it is checked, unambiguous, and its examples hold.

    It goes to the folder that --rules or CAPAR_RULES names, else to the folder rules of the
    Actionary that --actionary or CAPAR_ACTIONARY names, else to ./rules.
    """
    from capar.rulebook.changes import add_reclassifying
    from capar_rules.authoring.user_primitives import add_rule
    from capar_rules.authoring.user_rules import actionary_rules, make_folder, new_rules_folder

    place = opened(actionary)
    folder = new_rules_folder(rules, actionary=actionary)
    if reclassify or actionary:
        require_actionary(actionary, observed=reclassify)
    if rules:
        make_folder(folder)
    rule_base(profile, rules, place)
    if folder == actionary_rules():
        require_actionary(actionary)
    make_folder(folder)
    beside = _others(file, rules, actionary)
    if not reclassify:
        added = add_rule(
            file, folder=folder, base=profile, over=over or (), kind_of=kind_of or (),
            beside=beside,
        )  # fmt: skip
        typer.echo(f"added {added}")
        print_precedence(added, over or ())
        return
    added, effect = add_reclassifying(
        file, folder=folder, actionary=actionary, base=profile, over=over or (),
        kind_of=kind_of or (), beside=beside, captures=captures or [Path()],
    )  # fmt: skip
    typer.echo(f"added {added}")
    print_precedence(added, over or ())
    print_changes(effect.changes, effect.others)


@app.command()
def remove(
    name: Annotated[str, typer.Argument(help="A primitive of yours.")],
    reclassify: Reclassify = False,
    captures: Captures = None,
    profile: Base = "extended",
    rules: Rules = None,
    actionary: Place = None,
) -> None:
    """Take a primitive out of your rules: first your project's, then those of the Actionary.

    With --rules alone or --actionary alone, only that folder is looked through. A rule on which
    another one rests stays.
    """
    from capar.rulebook.changes import bearing, remove_reclassifying
    from capar_rules.authoring.user_primitives import introduced, removable
    from capar_rules.authoring.user_rules import actionary_rules, rule_files, user_rules
    from capar_rules.lint.admission import admitted_profile

    place = opened(actionary)
    mine = actionary_rules(place)
    project = rule_files(rules) if rules or not actionary else ()
    beside = rule_files(mine) if mine and mine.is_dir() and (actionary or not rules) else ()
    every = user_rules(rules, actionary=place)
    path = removable(name, files=(*project, *beside), every=every)
    names = introduced(path)
    if not reclassify:
        path.unlink()
        typer.echo(f"removed {path}")
        if has_actionary(place, named=actionary):
            print_bearing(bearing(actionary, names), names)
        return
    require_actionary(actionary, observed=True)
    others = tuple(each for each in every if each.resolve() != path.resolve())
    effect = remove_reclassifying(
        path, actionary=actionary, after=admitted_profile(profile, added=others),
        captures=captures or [Path()],
    )  # fmt: skip
    typer.echo(f"removed {path}")
    print_changes(effect.changes, effect.others)


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
    """Show which segments, of which captures, would change their name if FILE were added.

    Of an Actionary, those observations are compared that were made with the same profile.
    """
    from dataclasses import asdict

    from capar.rulebook.changes import captured, renamed, stored
    from capar_rules.lint.admission import admitted_profile
    from capar_rules.lint.checking import check as checked
    from capar_rules.lint.checking import require

    before = rule_base(profile, rules, opened(actionary))
    beside = _others(file, rules, actionary)
    findings = checked(file, profile=profile, beside=beside)
    require(file, [each for each in findings if each.code != "ambiguous"])
    after = admitted_profile(profile, added=(*beside, file))
    others: tuple[str, ...] = ()
    if on:
        seen = captured(on, rules=before)
    else:
        kept = stored(actionary, profile=profile)
        seen, others = kept.seen, kept.others
    changes = renamed(seen, before=before, after=after)
    if json:
        print_json([asdict(each) for each in changes])
        print_others(others)
    else:
        print_changes(changes, others)


@app.command()
def audit(
    profile: Base = "extended", rules: Rules = None, actionary: Place = None, json: Json = False
) -> None:
    """Audit the whole rule base over every segment that there can be."""
    from dataclasses import asdict

    from capar_rules.lint.profile_audit import audit as audited

    found = audited(rule_base(profile, rules, opened(actionary)))
    if json:
        print_json({**asdict(found), "clean": found.clean})
    else:
        print_audit(found)
    if not found.clean:
        raise typer.Exit(1)


app.command("new")(new)
app.command("words")(list_words)
