"""Rules that people write: new ones from what was seen, trying, adding and removing them."""

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from capar.model.errors import CaparError, FileError, RuleError, UnknownNameError
from capar.model.facts import (
    Fact,
    read_fact,
)
from capar.model.par import FeatureSet
from capar_rules.authoring.user_rules import actionary_rules, make_folder, taught
from capar_rules.authoring.user_rules import user_rules as user_rules
from capar_rules.engine.profiles import DEFAULT, Profile, profile
from capar_rules.engine.syntax import FITS, parse, parse_text, split_arguments, stated
from capar_rules.lint.checking import admitted_profile, check, require
from capar_rules.lint.findings import errors
from capar_rules.lint.text_checks import PRIMITIVE, known, read_rules
from capar_rules.lint.world_checks import rivals
from capar_rules.pars.inference import infer


@dataclass(frozen=True, slots=True, order=True)
class RuleInfo:
    """One primitive and where it comes from."""

    name: str
    origin: str
    """``core`` if it ships, ``user`` if it is beside the Actionary, ``project`` otherwise."""

    file: str
    definition: str
    verb: str
    general: tuple[str, ...]


def rules_of(base: Profile, *, actionary: str | Path | None = None) -> tuple[RuleInfo, ...]:
    """Every primitive of a rule base, by name."""
    statements = parse(base.files)
    mine = actionary_rules(actionary)
    verbs: dict[str, str] = {}
    for name, verb in stated(statements, ("verb", 2)):
        verbs[name] = verb
    general: dict[str, list[str]] = {}
    for name, other in stated(statements, ("specialises", 2)):
        general.setdefault(name, []).append(other)
    heads: dict[str, str] = {}
    for each in statements:
        if each.kind == "comment":
            text = " ".join(each.text.strip("%* \n").split())
            heads.setdefault(each.place.file, text.partition(": ")[2] or text)
    added = {str(each): each for each in base.added}
    found = []
    for each in statements:
        for (name,) in stated([each], PRIMITIVE):
            file, origin = each.place.file, "core"
            if file in added:
                own = mine and added[file].resolve().parent == mine.resolve()
                origin = "user" if own else "project"
            definition, above = heads.get(file, ""), tuple(general.get(name, ()))
            found.append(RuleInfo(name, origin, file, definition, verbs.get(name, ""), above))
    return tuple(sorted(found))


def rule_of(base: Profile, name: str, *, actionary: str | Path | None = None) -> RuleInfo:
    """One primitive of a rule base.

    Raises:
        UnknownNameError: There is none of that name.
    """
    known = {each.name: each for each in rules_of(base, actionary=actionary)}
    if name not in known:
        raise UnknownNameError("primitive", name, known)
    return known[name]


_LIKELY = re.compile(r'\bprimitive\s*\(\s*"([^"\n]*)"\s*\)\s*\.')


def introduced(path: Path) -> list[str]:
    """The primitives that a rule file introduces, in order.

    Of a file with syntax errors, those that it seems to introduce, so that it can be removed.
    """
    reading = read_rules(path, folders=(path.parent,))
    if reading.findings:
        return list(dict.fromkeys(_LIKELY.findall(reading.text)))
    return list(dict.fromkeys(name for (name,) in stated(reading.statements, PRIMITIVE)))


ORDERING = (("specialises", 2), ("precedes", 2))
"""Predicates whose second argument is another primitive."""


def dependants(path: Path, *, files: Sequence[Path]) -> dict[str, Path]:
    """Primitives of other rule files that depend on what a file introduces, each with its file.

    They specialise or precede it, or a rule of theirs asks whether a segment fits it.
    """
    names = set(introduced(path))
    found: dict[str, Path] = {}
    for each in files:
        if each.resolve() == path.resolve():
            continue
        for rule in read_rules(each, folders=(each.parent,)).statements:
            atoms = [head for head in rule.heads if head.signature in ORDERING]
            atoms += [atom for one in rule.body for atom in one.atoms if atom.signature == FITS]
            if names & {split_arguments(atom.text)[1].strip('"') for atom in atoms}:
                found |= dict.fromkeys(introduced(each) or [each.stem], each)
    return found


def preceded(path: Path) -> dict[str, list[str]]:
    """For each primitive of a rule file, those that it precedes."""
    pairs = stated(read_rules(path, folders=(path.parent,)).statements, ("precedes", 2))
    return {name: [other for one, other in pairs if one == name] for name in introduced(path)}


_EXAMPLE = re.compile(r"%\*\s*(Example|Counter-example):\s*(.*?)\n(.*?)\*%", re.DOTALL)
_FACT = re.compile(r"([a-z]\w*(?:\([^()]*\))?)\.(?=\s|$)")


@dataclass(frozen=True)
class Example:
    """Facts, and the names of each link's segments that must be inferred from them."""

    story: str
    positive: bool
    """Whether the file's primitive must occur in it; in a counter-example it must not."""

    facts: tuple[Fact, ...]
    names: tuple[tuple[str, tuple[str, ...]], ...]
    """End-effector and names, in order."""

    line: int


def read_examples(text: str, *, file: Path | str = "") -> tuple[Example, ...]:
    """The examples of a rule file.

    Raises:
        RuleError: One has no facts, no expectation, or something that is no fact.
    """
    examples = []
    for found in _EXAMPLE.finditer(text):
        line = text.count("\n", 0, found.start()) + 1
        story, body = found[2].strip(), found[3]
        rows = [each.strip() for each in body.splitlines()]
        expected = [each[2:].strip() for each in rows if each.startswith("=>")]
        told = "\n".join("" if each.startswith("=>") else each for each in rows)
        facts = tuple(_facts(told, f"in the example {story!r}: ", str(file), line + 1))
        if not facts or not expected:
            raise RuleError(
                f"{file}:{line}: the example {story!r} needs facts and a line such as "
                "=> right_hand: Reach, Lift"
            )
        names = []
        for each in expected:
            ee, colon, listed = each.partition(":")
            if not colon:
                raise RuleError(f"{file}:{line}: expected END_EFFECTOR: Name, Name; found {each!r}")
            named = tuple(one.strip() for one in listed.split(",") if one.strip())
            names.append((ee.strip(), named))
        examples.append(Example(story, found[1] == "Example", facts, tuple(names), line))
    return tuple(examples)


def _facts(stated: str, where: str, file: str, first: int) -> Iterator[Fact]:
    """Every fact of an example; nothing else may stand between them."""
    at = 0
    while rest := stated[at:].lstrip():
        at = len(stated) - len(rest)
        place = f"{file}:{first + stated.count(chr(10), 0, at)}: {where}"
        found = _FACT.match(stated, at)
        if found is None:
            told = rest.splitlines()[0].rstrip()
            raise RuleError(
                f"{place}{told!r} is no fact; a fact reads moving(cup, 0, 200). and "
                "ends with a full stop"
            )
        try:
            yield read_fact(found[1])
        except CaparError as error:
            raise RuleError(f"{place}{error}") from None
        at = found.end()


def written(example: Example) -> str:
    """The example as a comment of a rule file."""
    kind = "Example" if example.positive else "Counter-example"
    lines = [f"%* {kind}: {example.story}"]
    lines += [f"   {each}." for each in example.facts]
    lines += [f"   => {ee}: {', '.join(names)}" for ee, names in example.names]
    return "\n".join(lines) + "\n*%\n"


LACKING = "% Before it can be added it needs an Example and a Counter-example.\n"


def new_rule(
    name: str,
    features: FeatureSet,
    *,
    definition: str = "",
    general: str | Sequence[str] = (),
    besides: Sequence[str] = (),
    verb: str = "",
    rule: str = "",
) -> str:
    """The text of a rule file for a primitive with these features.

    Args:
        name: What it is called.
        features: The feature set that a segment has.
        definition: What it is, in words.
        general: The primitives that it specialises.
        besides: Others that fit some of the same segments, over which it takes precedence.
        verb: The verb for it; its name in small letters if empty.
        rule: Which segments fit it, in place of the row of features.

    Raises:
        RuleError: The name is no name of a primitive, or a text would not stay a text.
    """
    said = " ".join((definition or "named by a user for this feature set").split())
    if "%*" in said or "*%" in said or set(verb) & set('"\\\n'):
        raise RuleError("a definition holds no *% and a verb no quotes; write plain words")
    _, *lines = taught(name, features, verb=verb).splitlines(keepends=True)
    over = [general] if isinstance(general, str) else general
    kept = [each for each in lines if not (rule and each.startswith("feature_row("))]
    text = f"%* {name}: {said.rstrip('.')}. *%\n{''.join(kept)}"
    text += "".join(f'specialises("{name}", "{each}").\n' for each in over if each)
    if besides:
        text += "% These name segments with the same features: it takes precedence over them.\n"
        text += "".join(f'precedes("{name}", "{each}").\n' for each in besides)
    text += rule or (
        "% The row fits every segment with these features. To fit fewer, put a rule in its place:\n"
        f'%   fits(Segment, "{name}") :- fits(Segment, "{next(iter(over), "") or "General"}"), '
        "further conditions.\n"
    )
    return text


def try_rule(path: Path, *, base: str = DEFAULT, beside: Sequence[Path] = ()) -> tuple[str, ...]:
    """A message for each example whose names are not inferred; empty if all hold.

    Raises:
        RuleError: An example cannot be read, or the rules have an error.
    """
    examples = read_examples(_text(path), file=path)
    failures = []
    rules = admitted_profile(base, added=(*(each for each in beside if each != path), path))
    for example in examples:
        links = infer(example.facts, profile=rules).links
        found = {link.ee: tuple(one.name for one in link.segments) for link in links}
        failures += [
            f"{path}:{example.line}: {example.story!r} expects "
            f"{ee}: {', '.join(expected)}; found {', '.join(found.get(ee, ()))}"
            for ee, expected in example.names
            if found.get(ee) != expected
        ]
    for name in introduced(path):
        shown = {
            each.positive
            for each in examples
            if each.positive == any(name in names for _, names in each.names)
        }
        if True not in shown:
            failures.append(f"{path}: it lacks an Example in which {name} occurs")
        if False not in shown:
            failures.append(f"{path}: it lacks a Counter-example in which {name} does not occur")
    return tuple(failures)


def add_rule(
    path: Path,
    *,
    folder: Path,
    base: str = DEFAULT,
    over: Sequence[str] = (),
    kind_of: Sequence[str] = (),
    beside: Sequence[Path] | None = None,
) -> Path:
    """Add a rule file to the user's rules, if its check finds no error and its examples hold.

    Args:
        path: The file.
        folder: The folder of rules to which it is copied.
        base: The profile that it joins.
        over: Primitives that it is to precede, which resolves ambiguities; ``all`` stands for each
            that names a segment with it, or may do so.
        kind_of: Primitives that it is to specialise.
        beside: Every rule file loaded already; None for those of the folder.

    Returns:
        Where it now is.

    Raises:
        RuleError: The check finds errors, an ambiguity among them, or an example fails.
        FileError: A file of that name is there already.
    """
    with checked_draft(
        path, folder=folder, base=base, over=over, kind_of=kind_of, beside=beside
    ) as draft:
        return draft.replace(folder / path.name)


@contextmanager
def checked_draft(
    path: Path,
    *,
    folder: Path,
    base: str = DEFAULT,
    over: Sequence[str] = (),
    kind_of: Sequence[str] = (),
    beside: Sequence[Path] | None = None,
) -> Iterator[Path]:
    """The same up to the last step: a checked copy that only needs to be moved into the folder.

    Raises:
        RuleError: The check finds errors, an ambiguity among them, or an example fails.
        FileError: A file of that name is there already.
    """
    target = folder / path.name
    if target.exists():
        raise FileError(target, "exists already.", "Remove that rule first, or rename this file.")
    make_folder(folder)
    others = user_rules(folder) if beside is None else tuple(beside)
    others = tuple(each for each in others if each.resolve() != path.resolve())
    with TemporaryDirectory(dir=folder, prefix=".draft") as place:
        draft = Path(place) / path.name
        draft.write_text(_text(path), encoding="utf-8")
        if over or kind_of:
            ordering = _ordering(draft, over, kind_of, base=base, beside=others)
            draft.write_text(_text(path) + ordering, encoding="utf-8")
        findings = check(draft, profile=base, beside=others)
        require(
            path,
            [
                replace(each, place=replace(each.place, file=str(path)))
                if each.place.file == str(draft)
                else each
                for each in findings
            ],
        )
        try:
            failures = try_rule(draft, base=base, beside=others)
        except RuleError as error:
            raise RuleError(str(error).replace(str(draft), str(path))) from None
        if failures:
            told = "\n".join(failures).replace(str(draft), str(path))
            raise RuleError(f"its examples do not hold:\n{told}")
        yield draft


def removable(name: str, *, files: Sequence[Path], every: Sequence[Path] = ()) -> Path:
    """The rule file that introduces a primitive, if it can be removed.

    Raises:
        UnknownNameError: None of the files introduces it.
        RuleError: Another rule depends on it.
    """
    info = {each: path for path in reversed(files) for each in introduced(path)}
    if name not in info:
        folders = ", ".join(sorted({str(each.parent) for each in files}))
        raise UnknownNameError("rule of the user's", name, info, where=folders)
    path = info[name]
    resting = dependants(path, files=every)
    if resting:
        told = ", ".join(f"{each} ({file})" for each, file in sorted(resting.items()))
        raise RuleError(
            f"{path} stays: {told} rests on {', '.join(introduced(path))}. Remove that first, or "
            "have it specialise another primitive."
        )
    return path


ALL = "all"
"""Stands for every primitive that names a segment together with a new one."""


def _ordering(
    path: Path, over: Sequence[str], kind_of: Sequence[str], *, base: str, beside: Sequence[Path]
) -> str:
    """The facts that put the primitives of a file before others, or make them kinds of those."""
    lines = []
    for name in introduced(path):
        own_lines = [f'specialises("{name}", "{other}").' for other in kind_of]
        own_lines += [f'precedes("{name}", "{other}").' for other in over if other != ALL]
        lines += own_lines
        if ALL in over:
            found = errors(check(path, profile=base, beside=beside))
            if all(each.code == "ambiguous" for each in found):
                own = [*parse([path]), *parse_text("\n".join(own_lines))]
                shipped = known(parse(profile(base).files))
                every = rivals(name, own, shipped, parse(beside) if beside else ())
                lines += [f'precedes("{name}", "{other}").' for other in every]
    return "".join(f"{each}\n" for each in lines)


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror}.", "Name a rule file.") from None
    except UnicodeDecodeError:
        raise FileError(path, "is no UTF-8 text.", "Save it as UTF-8.") from None
