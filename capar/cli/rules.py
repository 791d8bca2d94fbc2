"""The commands for rules that people write, from a first draft to their place in the rule base."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli.options import Place, Rules, has_actionary, opened, require_actionary, rule_base
from capar.cli.output import print_json

if TYPE_CHECKING:
    from capar.rulebook.changes import Renamed
    from capar_rules.authoring.glossary import Glossary, Word
    from capar_rules.lint.audit import Audit


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
    from capar.cli.output import check_writable, written
    from capar.model.errors import FileError, RuleError
    from capar.rulebook.drafts import rule_from_features, rule_from_segment

    words = {"definition": definition, "general": general, "verb": verb}
    if (source is None) == (features is None):
        raise RuleError(
            "say either --from CAPTURE/END_EFFECTOR/INDEX or --features START,END,CHANGE,FORCE"
        )
    if out is not None and out.exists():
        raise FileError(out, "exists already.", "Choose another file.")
    if out is not None:
        check_writable(out)
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
    from capar_rules.authoring.glossary import glossary

    found = glossary(rule_base(profile, rules, opened(actionary)))
    if json:
        print_words_json(found, name)
    elif name:
        print_word(found, name)
    else:
        print_glossary(found)


def print_changes(changes: "tuple[Renamed, ...]", others: tuple[str, ...] = ()) -> None:
    """The segments that have another name now, and how many; who was left alone."""
    from capar.model.observation import SegmentAddress
    from capar.rulebook.changes import NOTHING

    for change in changes:
        before, after = (
            f"{name} (or {', '.join(shared)})" if shared else name
            for name, shared in (
                (change.before, change.before_others), (change.after, change.after_others)
            )
        )  # fmt: skip
        what = f"{before} -> {after}"
        if NOTHING in (change.before, change.after):
            what = f"{before} vanishes" if change.after == NOTHING else f"{after} appears"
        address = SegmentAddress(change.ee, change.index, change.capture)
        typer.echo(f"{address}  {change.start_s:.2f} to {change.end_s:.2f} s: {what}")
    told = "1 segment changes" if len(changes) == 1 else f"{len(changes)} segments change"
    typer.echo(told if changes else f"{told}: none that was observed gets another name")
    for line in sorted({_settling(change) for change in changes if change.after_others}):
        typer.echo(line)
    print_others(others)


def _settling(change: "Renamed") -> str:
    """How several names that share a segment are ordered."""
    old = {change.before, *change.before_others}
    new, *rest = sorted((change.after, *change.after_others), key=lambda name: (name in old, name))
    return (
        f"{new} and {' and '.join(rest)} share a segment. To settle it, state "
        f'precedes("{new}", "{rest[0]}"), or add the file with --over {rest[0]}; if {new} is a '
        f"kind of {rest[0]}, with --kind-of {rest[0]}."
    )


def print_precedence(file: Path, over: Sequence[str]) -> None:
    """What the primitives of a file precede, where that was asked for."""
    from capar_rules.authoring.user_primitives import preceded

    if over:
        for name, others in preceded(file).items():
            typer.echo(f"{name} precedes {', '.join(others) or 'nothing'}; {file} says so")


def print_others(others: tuple[str, ...]) -> None:
    """How many observations were left alone, as they were made with another profile."""
    if others:
        several = "s were" if len(others) > 1 else " was"
        typer.echo(
            f"{len(others)} observation{several} made with another profile: left alone", err=True
        )


def print_bearing(count: int, names: list[str]) -> None:
    """How many stored segments bear a name that no rule gives any longer."""
    if count:
        told = "1 stored segment still bears" if count == 1 else f"{count} segments still bear"
        typer.echo(
            f"{told} the name {' or '.join(names)}; observing again renames them, as would "
            "--reclassify have done",
            err=True,
        )


def print_audit(found: "Audit") -> None:
    """What an audit found, and whether the rules are clean."""
    without = len(found.uncovered)
    typer.echo(f"{found.possible} feature sets can be; {without} of them have no name:")
    for line in _uncovered(found):
        typer.echo(line)
    for clash in found.ambiguous:
        where = " ".join(part or "-" for part in clash.features[0])
        typer.echo(f"ambiguous: {clash.first} and {clash.second}, first at {where}")
    for name in found.shadowed:
        typer.echo(f"shadowed: {name}")
    for name in found.unreachable:
        typer.echo(f"never fits in the worlds of the audit: {name} (`capar rules check` says why)")
    for name in found.unchecked:
        typer.echo(
            f"not checked: {name}; its conditions are outside the worlds of the audit "
            "(`capar rules check` lists them)"
        )
    typer.echo("the rules are clean" if found.clean else "the rules are not clean")


def _uncovered(found: "Audit") -> Iterator[str]:
    """Every feature set without a name, under its reason, a line for the relations at its ends.

    What follows each is change of location and force.
    """
    reasons = dict(found.excused)
    groups: dict[str, dict[str, list[str]]] = {}
    for start, end, change, force in found.uncovered:
        reason = reasons.get((start, end, change, force), "NO REASON IS GIVEN")
        ends = f"{start or '-'} > {end or '-'}"
        groups.setdefault(reason, {}).setdefault(ends, []).append(f"{change or '-'}/{force or '-'}")
    for reason, cases in groups.items():
        yield f"  {sum(map(len, cases.values()))}: {reason}"
        for ends, rest in cases.items():
            yield f"    {ends}  {' '.join(rest)}"


def print_glossary(found: "Glossary") -> None:
    """Every word, file by file, and what each file keeps to itself."""
    within: dict[str, list[str]] = {}
    for file, (name, arity) in found.internal:
        within.setdefault(file, []).append(f"{name}/{arity}")
    for file, words in groupby(found.words, key=lambda each: each.file):
        typer.echo(file)
        for word in words:
            typer.echo(f"  {word}  {word.meaning}")
        if file in within:
            typer.echo(f"  within this file alone: {', '.join(within.pop(file))}")
        typer.echo()
    for file, names in within.items():
        typer.echo(f"{file}\n  within this file alone: {', '.join(names)}\n")


def print_word(found: "Glossary", name: str) -> None:
    """One word: what it means, where it is explained, and the rules that define it."""
    words = found.find(name)
    for each in words:
        typer.echo(f"{each}  {each.meaning}")
        typer.echo(f"  explained in {each.file}:{each.line}" if each.line else f"  in {each.file}")
    for signature in dict.fromkeys(word.signature for word in words):
        if ways := found.needed(signature):
            told = "; or ".join(", ".join(way) for way in ways)
            typer.echo(f"  an example needs, beside frames, links and tags: {told}")
        for place in found.rules_of(signature):
            typer.echo(f"  defined at {place}\n{_rule(Path(place.file), place.line)}")


def _rule(file: Path, line: int) -> str:
    """The text of the rule that begins on that line."""
    lines = file.read_text(encoding="utf-8").splitlines()[line - 1 :]
    end = next((at for at, each in enumerate(lines, 1) if each.rstrip().endswith(".")), len(lines))
    return "\n".join(f"    {each}" for each in lines[:end])


def print_words_json(found: "Glossary", name: str | None) -> None:
    """The same as JSON: one word, or all of them."""
    words = found.find(name) if name else found.words
    print_json([_row(word, found) for word in words])


def _row(word: "Word", found: "Glossary") -> dict[str, object]:
    return {
        "name": word.name,
        "arguments": list(word.arguments),
        "meaning": word.meaning,
        "file": word.file,
        "line": word.line,
        "needs": [list(way) for way in found.needed(word.signature)],
        "defined": [str(each) for each in found.rules_of(word.signature)],
    }


rules = typer.Typer(no_args_is_help=True)

File = Annotated[Path, typer.Argument(help="A rule file.")]
Reclassify = Annotated[
    bool, typer.Option("--reclassify", help="Rename the stored segments that this changes.")
]
Captures = Annotated[
    list[Path] | None,
    typer.Option(help="With --reclassify: a folder that holds captures; else this one."),
]


@rules.callback()
def _root() -> None:
    """Write primitives as rules: checked before they count, their effect shown before they do."""


def _others(file: Path, rules: Path | None, actionary: str | None) -> tuple[Path, ...]:
    """The rule files that people wrote, without this one."""
    from capar_rules.authoring.user_rules import user_rules

    files = user_rules(rules, actionary=opened(actionary))
    return tuple(each for each in files if each.resolve() != file.resolve())


@rules.command("list")
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


@rules.command()
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


@rules.command()
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


@rules.command()
def test(
    file: File, profile: Base = "extended", rules: Rules = None, actionary: Place = None
) -> None:
    """Run the examples that FILE carries: what it must match, and what it must not."""
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


@rules.command()
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
    from capar_rules.lint.checking import admitted_profile

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


@rules.command()
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
    from capar_rules.lint.checking import admitted_profile, require
    from capar_rules.lint.checking import check as checked

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


@rules.command()
def audit(
    profile: Base = "extended", rules: Rules = None, actionary: Place = None, json: Json = False
) -> None:
    """Audit the whole rule base over every segment that there can be."""
    from dataclasses import asdict

    from capar_rules.lint.world_checks import audit as audited

    found = audited(rule_base(profile, rules, opened(actionary)))
    if json:
        print_json({**asdict(found), "clean": found.clean})
    else:
        print_audit(found)
    if not found.clean:
        raise typer.Exit(1)


rules.command("new")(new)
rules.command("words")(list_words)
