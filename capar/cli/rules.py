"""The commands for rules that people write, from a first draft to their place in the rule base."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from capar.cli import options
from capar.cli.output import answer, check_writable, emit, print_json

if TYPE_CHECKING:
    from capar.rulebook.changes import Renamed
    from capar_rules.authoring.glossary import Glossary
    from capar_rules.lint.audit import Audit

rules = typer.Typer(no_args_is_help=True, help="Write, check, add and remove primitives as rules.")

File = Annotated[Path, Argument(help="A rule file.")]
Reclassify = Annotated[
    bool, Option("--reclassify", help="Rename the stored segments that this changes.")
]
Captures = Annotated[
    list[Path] | None,
    Option(help="With --reclassify: a folder that holds captures; else this one."),
]


def _others(file: Path, project: Path | None, actionary: str | None) -> tuple[Path, ...]:
    """The rule files that people wrote, without this one."""
    from capar_rules.authoring.user_rules import user_rules

    files = user_rules(project, actionary=options.opened(actionary))
    return tuple(each for each in files if each.resolve() != file.resolve())


@rules.command("list")
def list_rules(
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
    json: options.Json = False,
) -> None:
    """List every primitive: its origin, what it specialises, what it is.

    Rules that ship are core, those in the Actionary's folder rules are user, and those in a folder
    that --rules or CAPAR_RULES names, or else in ./rules, are project.
    """
    from capar_rules.authoring.user_primitives import rules_of

    place = options.opened(actionary)
    found = rules_of(options.rule_base(profile, rules, place), actionary=place)
    lines = (
        f"{each.origin}  {each.name}"
        + (f" < {', '.join(each.general)}" if each.general else "")
        + f": {each.definition}"
        for each in found
    )
    answer(found, lines, json=json)


@rules.command()
def show(
    name: Annotated[str, Argument(help="A primitive.")],
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
) -> None:
    """Print the rule file of a primitive."""
    from capar_rules.authoring.user_primitives import rule_of

    info = rule_of(options.rule_base(profile, rules, options.opened(actionary)), name)
    typer.echo(Path(info.file).read_text(encoding="utf-8"), nl=False)


@rules.command()
def new(
    name: Annotated[str, Argument(help="What the primitive is called, such as Lift.")],
    source: Annotated[
        str | None,
        Option("--from", help="A segment of a capture or observation: NAME/END_EFFECTOR/INDEX."),
    ] = None,
    features: Annotated[str | None, Option(help="In bits, such as 100,101,10,00.")] = None,
    definition: Annotated[str, Option(help="What it is, in words.")] = "",
    general: Annotated[str, Option(help="The primitive that it specialises.")] = "",
    verb: Annotated[str, Option(help="The verb for it.")] = "",
    output: options.OutputFile = None,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
) -> None:
    """Write a rule file from a segment or a feature set, to be edited."""
    from capar.model.errors import FileError, RuleError
    from capar.rulebook.drafts import rule_from_features, rule_from_segment

    words = {"definition": definition, "general": general, "verb": verb}
    if (source is None) == (features is None):
        raise RuleError(
            "say either --from CAPTURE/END_EFFECTOR/INDEX or --features START,END,CHANGE,FORCE"
        )
    if output is not None:
        if output.exists():
            raise FileError(output, "exists already.", "Choose another file.")
        check_writable(output)
    place = options.opened(actionary)
    base = options.rule_base(profile, rules, place)
    if source is not None:
        kept = place if options.has_actionary(place, named=actionary) else None
        text = rule_from_segment(name, source, rules=base, actionary=kept, **words)
    else:
        text = rule_from_features(name, features or "", rules=base, **words)
    emit(text, output)
    if output is not None:
        typer.echo(f"wrote {output}; edit it, then: capar rules check {output}", err=True)


@rules.command()
def check(
    file: File,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
    json: options.Json = False,
) -> None:
    """Say what is wrong with a rule file; nothing of it is run."""
    from capar_rules.lint.checking import check as checked
    from capar_rules.lint.findings import errors

    findings = checked(file, profile=profile, beside=_others(file, rules, actionary))
    lines = findings or [f"{file}: nothing is wrong"]
    answer([each.as_json() for each in findings], lines, json=json)
    if errors(findings):
        raise typer.Exit(2)


@rules.command()
def test(
    file: File,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
) -> None:
    """Run the examples in a rule file: what it must match, and must not."""
    from capar_rules.authoring.user_primitives import try_rule
    from capar_rules.lint.checking import admit, require
    from capar_rules.lint.checking import check as checked

    beside = _others(file, rules, actionary)
    admit(beside, profile=profile)
    require(file, checked(file, profile=profile, beside=beside))
    failures = try_rule(file, base=profile, beside=beside)
    for failure in failures:
        typer.echo(failure)
    if failures:
        raise typer.Exit(2)
    typer.echo(f"{file}: its examples hold")


@rules.command()
def add(
    file: File,
    over: Annotated[
        list[str] | None,
        Option(help="A primitive that it precedes where both fit, or all; may be repeated."),
    ] = None,
    kind_of: Annotated[
        list[str] | None, Option(help="A primitive that it is a kind of; may be repeated.")
    ] = None,
    reclassify: Reclassify = False,
    captures: Captures = None,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
) -> None:
    """Add a rule file to your rules.

    It must be free of errors and ambiguities, and its examples must hold. It goes to the folder
    that --rules or CAPAR_RULES names, else to the folder rules of the Actionary that --actionary or
    CAPAR_ACTIONARY names, else to ./rules.
    """
    from capar.rulebook.changes import add_reclassifying
    from capar_rules.authoring.user_primitives import add_rule, preceded
    from capar_rules.authoring.user_rules import actionary_rules, make_folder, new_rules_folder

    folder = new_rules_folder(rules, actionary=actionary)
    if reclassify or actionary:
        options.require_actionary(actionary, observed=reclassify)
    if rules:
        make_folder(folder)
    options.rule_base(profile, rules, options.opened(actionary))
    if folder == actionary_rules():
        options.require_actionary(actionary)
    make_folder(folder)
    beside = _others(file, rules, actionary)
    stated = (over or (), kind_of or ())
    if reclassify:
        added, effect = add_reclassifying(
            file, folder=folder, actionary=actionary, base=profile, over=stated[0],
            kind_of=stated[1], beside=beside, captures=captures or [Path()],
        )  # fmt: skip
    else:
        effect = None
        added = add_rule(
            file, folder=folder, base=profile, over=stated[0], kind_of=stated[1], beside=beside
        )
    typer.echo(f"added {added}")
    for name, others in preceded(added).items() if over else ():
        typer.echo(f"{name} precedes {', '.join(others) or 'nothing'}; {added} says so")
    if effect:
        _print_changes(effect.changes, effect.others)


@rules.command()
def remove(
    name: Annotated[str, Argument(help="A primitive of yours.")],
    reclassify: Reclassify = False,
    captures: Captures = None,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
) -> None:
    """Remove a primitive from your rules.

    Your project's are searched first, then those of the Actionary; with --rules alone or
    --actionary alone, only that folder. A rule on which another one rests stays.
    """
    from capar.rulebook.changes import bearing, remove_reclassifying
    from capar_rules.authoring.user_primitives import introduced, removable
    from capar_rules.authoring.user_rules import actionary_rules, rule_files, user_rules
    from capar_rules.lint.checking import admitted_profile

    place = options.opened(actionary)
    mine = actionary_rules(place)
    project = rule_files(rules) if rules or not actionary else ()
    beside = rule_files(mine) if mine and mine.is_dir() and (actionary or not rules) else ()
    every = user_rules(rules, actionary=place)
    path = removable(name, files=(*project, *beside), every=every)
    names = introduced(path)
    if reclassify:
        options.require_actionary(actionary, observed=True)
        others = tuple(each for each in every if each.resolve() != path.resolve())
        effect = remove_reclassifying(
            path, actionary=actionary, after=admitted_profile(profile, added=others),
            captures=captures or [Path()],
        )  # fmt: skip
        typer.echo(f"removed {path}")
        _print_changes(effect.changes, effect.others)
        return
    path.unlink()
    typer.echo(f"removed {path}")
    count = bearing(actionary, names) if options.has_actionary(place, named=actionary) else 0
    if count:
        typer.echo(
            f"stored segments that still bear the name {' or '.join(names)}: {count}; observe "
            "again, or remove with --reclassify, to rename them",
            err=True,
        )


@rules.command()
def diff(
    file: File,
    on: Annotated[
        list[str] | None, Option(help="A capture, instead of the Actionary; may be repeated.")
    ] = None,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
    json: options.Json = False,
) -> None:
    """Show which segments would change their name if a file were added.

    Of an Actionary, those observations are compared that were made with the same profile.
    """
    from capar.rulebook.changes import captured, renamed, stored
    from capar_rules.lint.checking import admitted_profile, require
    from capar_rules.lint.checking import check as checked

    before = options.rule_base(profile, rules, options.opened(actionary))
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
        print_json(changes)
    _print_changes(() if json else changes, others, counted=not json)


@rules.command()
def audit(
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
    json: options.Json = False,
) -> None:
    """Audit the whole rule base over every possible segment."""
    from capar_rules.lint.world_checks import audit as audited

    found = audited(options.rule_base(profile, rules, options.opened(actionary)))
    answer({**asdict(found), "clean": found.clean}, _audit_lines(found), json=json)
    if not found.clean:
        raise typer.Exit(1)


@rules.command("words")
def list_words(
    name: Annotated[str | None, Argument(help="One word, such as carried_off.")] = None,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    actionary: options.Place = None,
    json: options.Json = False,
) -> None:
    """Explain the words of rules: what a rule file may read or state.

    Each is written with its arguments; with NAME also where it is defined, and by which rules.
    """
    from capar_rules.authoring.glossary import glossary

    found = glossary(options.rule_base(profile, rules, options.opened(actionary)))
    rows = [
        {
            "name": word.name,
            "arguments": word.arguments,
            "meaning": word.meaning,
            "file": word.file,
            "line": word.line,
            "defined": [str(each) for each in found.rules_of(word.signature)],
        }
        for word in (found.find(name) if name else found.words)
    ]
    answer(rows, _word_lines(found, name) if name else _glossary_lines(found), json=json)


def _print_changes(
    changes: "tuple[Renamed, ...]", others: Sequence[str], *, counted: bool = True
) -> None:
    """The segments that have another name now, and how many; what was left alone."""
    from capar.model.observation import SegmentAddress
    from capar.rulebook.changes import NOTHING

    shared: set[str] = set()
    for change in changes:
        before, after = (
            f"{name} (or {', '.join(rest)})" if rest else name
            for name, rest in (
                (change.before, change.before_others),
                (change.after, change.after_others),
            )
        )
        what = f"{before} -> {after}"
        if NOTHING in (change.before, change.after):
            what = f"{before} vanishes" if change.after == NOTHING else f"{after} appears"
        address = SegmentAddress(change.ee, change.index, change.capture)
        typer.echo(f"{address}  {change.start_s:.2f} to {change.end_s:.2f} s: {what}")
        if change.after_others:
            old = {change.before, *change.before_others}
            names = (change.after, *change.after_others)
            added, *rest = sorted(names, key=lambda name: (name in old, name))
            shared.add(
                f"{added} and {' and '.join(rest)} share a segment. To settle it, state "
                f'precedes("{added}", "{rest[0]}"), or add the file with --over {rest[0]}; if '
                f"{added} is a kind of {rest[0]}, with --kind-of {rest[0]}."
            )
    if counted:
        typer.echo(f"segments that change: {len(changes)}")
    for line in sorted(shared):
        typer.echo(line)
    if others:
        typer.echo(f"observations made with another profile, left alone: {len(others)}", err=True)


def _audit_lines(found: "Audit") -> Iterator[str]:
    """What an audit found, and whether the rules are clean.

    Every feature set without a name is listed under its reason, a line for the relations at its
    ends; what follows each is change of location and force.
    """
    yield f"{found.possible} feature sets can be; {len(found.uncovered)} have no name:"
    reasons = dict(found.excused)
    groups: dict[str, dict[str, list[str]]] = {}
    for start, end, change, force in found.uncovered:
        reason = reasons.get((start, end, change, force), "NO REASON IS GIVEN")
        ends = f"{start or '-'} > {end or '-'}"
        groups.setdefault(reason, {}).setdefault(ends, []).append(f"{change or '-'}/{force or '-'}")
    for reason, cases in groups.items():
        yield f"  {sum(map(len, cases.values()))}: {reason}"
        yield from (f"    {ends}  {' '.join(rest)}" for ends, rest in cases.items())
    for clash in found.ambiguous:
        where = " ".join(part or "-" for part in clash.features[0])
        yield f"ambiguous: {clash.first} and {clash.second}, first at {where}"
    yield from (f"shadowed: {name}" for name in found.shadowed)
    for name in found.unreachable:
        yield f"never fits in the worlds of the audit: {name} (`capar rules check` says why)"
    for name in found.unchecked:
        yield (
            f"not checked: {name}; its conditions are outside the worlds of the audit "
            "(`capar rules check` lists them)"
        )
    yield "the rules are clean" if found.clean else "the rules are not clean"


def _glossary_lines(found: "Glossary") -> Iterator[str]:
    """Every word, file by file, and what each file keeps to itself."""
    within: dict[str, list[str]] = {}
    for file, (name, arity) in found.internal:
        within.setdefault(file, []).append(f"{name}/{arity}")
    words = {file: list(own) for file, own in groupby(found.words, key=lambda each: each.file)}
    for file in dict.fromkeys((*words, *within)):
        yield file
        yield from (f"  {word}  {word.meaning}" for word in words.get(file, ()))
        if file in within:
            yield f"  within this file alone: {', '.join(within[file])}"
        yield ""


def _word_lines(found: "Glossary", name: str) -> Iterator[str]:
    """One word: what it means, where it is explained, and the rules that define it."""
    words = found.find(name)
    for each in words:
        yield f"{each}  {each.meaning}"
        yield f"  explained in {each.file}:{each.line}" if each.line else f"  in {each.file}"
    for signature in dict.fromkeys(word.signature for word in words):
        for place in found.rules_of(signature):
            lines = Path(place.file).read_text(encoding="utf-8").splitlines()[place.line - 1 :]
            ends = (at for at, each in enumerate(lines, 1) if each.rstrip().endswith("."))
            yield f"  defined at {place}"
            yield from (f"    {each}" for each in lines[: next(ends, len(lines))])
