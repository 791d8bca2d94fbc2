"""Rules that people write: which there are, new ones from what was seen, adding, removing."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from capar.model.errors import FileError, RuleError, UnknownNameError
from capar.model.facts import (
    Fact,
    ForceTransfer,
    Frames,
    Gap,
    Link,
    Moving,
    RateMhz,
    Tag,
    Touching,
    ZeroCrossing,
)
from capar.model.par import FeatureSet
from capar_rules.checking import check, require
from capar_rules.examples import Example, lacking, read_examples, try_examples, written
from capar_rules.profiles import DEFAULT, Profile, profile
from capar_rules.syntax import Statement, parse, split_arguments
from capar_rules.teaching import actionary_rules, make_folder, taught
from capar_rules.teaching import user_rules as user_rules

TELLING = (Frames, RateMhz, Link, Tag, ZeroCrossing, Touching, Gap, Moving, ForceTransfer)
"""The facts that an example tells: contacts and motions, without places and courses."""


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
    """Every primitive of a rule base, by name.

    Args:
        base: The rule base.
        actionary: The Actionary whose rules are the user's own; None for ``CAPAR_ACTIONARY``'s.
    """
    statements = parse(base.files)
    mine = actionary_rules(actionary)
    origins = {
        str(each): "user" if mine and each.resolve().parent == mine.resolve() else "project"
        for each in base.added
    }
    verbs = dict(_pairs(statements, "verb"))
    general: dict[str, list[str]] = {}
    for name, other in _pairs(statements, "specialises"):
        general.setdefault(name, []).append(other)
    heads: dict[str, str] = {}
    for each in statements:
        if each.kind == "comment":
            heads.setdefault(each.place.file, each.text)
    found = [
        RuleInfo(
            split_arguments(each.heads[0].text)[0].strip('"'),
            origins.get(each.place.file, "core"),
            each.place.file,
            _definition(heads.get(each.place.file, "")),
            "",
            (),
        )
        for each in statements
        if each.heads and each.heads[0].signature == ("primitive", 1)
    ]
    return tuple(
        sorted(
            replace(each, verb=verbs.get(each.name, ""), general=tuple(general.get(each.name, ())))
            for each in found
        )
    )


def rule_of(base: Profile, name: str, *, actionary: str | Path | None = None) -> RuleInfo:
    """One primitive of a rule base.

    Raises:
        UnknownNameError: There is none of that name.
    """
    known = {each.name: each for each in rules_of(base, actionary=actionary)}
    if name not in known:
        raise UnknownNameError("primitive", name, known)
    return known[name]


def new_rule(
    name: str,
    features: FeatureSet,
    *,
    definition: str = "",
    general: str = "",
    verb: str = "",
    examples: Sequence[Example] = (),
) -> str:
    """The rule file of a primitive that has these features.

    Args:
        name: What it is called.
        features: The feature set that a segment has.
        definition: What it is, in words.
        general: The primitive that it specialises, if any.
        verb: The verb for it; its name in small letters if empty.
        examples: Stories that it must, or must not, match.

    Raises:
        RuleError: The name is no name of a primitive.
    """
    _, *lines = taught(name, features, verb=verb).splitlines(keepends=True)
    said = definition or "named by a user for this feature set"
    text = f"%* {name}: {said.rstrip('.')}. *%\n{''.join(lines)}"
    if general:
        text += f'specialises("{name}", "{general}").\n'
    return "\n".join([text, *map(written, examples)])


def telling(facts: Sequence[Fact]) -> tuple[Fact, ...]:
    """Of a capture's facts those that an example tells."""
    return tuple(each for each in facts if isinstance(each, TELLING))


def try_rule(path: Path, *, base: str = DEFAULT, beside: Sequence[Path] = ()) -> tuple[str, ...]:
    """What the examples of a rule file do not show as they say; empty if all is well.

    Raises:
        RuleError: An example cannot be read, or the rules have a fault.
    """
    examples = read_examples(_text(path), file=path)
    names = introduced(path)
    failures = []
    rules = profile(base, added=(*(each for each in beside if each != path), path))
    for outcome in try_examples(examples, profile=rules):
        if not outcome.met:
            found = dict(outcome.found)
            for ee, expected in outcome.example.names:
                if found.get(ee) != expected:
                    failures.append(
                        f"{path}:{outcome.example.line}: {outcome.example.story!r} expects "
                        f"{ee}: {', '.join(expected)}; found {', '.join(found.get(ee, ()))}"
                    )
    return (
        *failures,
        *(f"{path}: it lacks {each}" for name in names for each in lacking(examples, name)),
    )


def add_rule(
    path: Path,
    *,
    folder: Path,
    base: str = DEFAULT,
    over: Sequence[str] = (),
    beside: Sequence[Path] | None = None,
) -> Path:
    """Take a rule file among the user's rules, once it is checked and its examples hold.

    Args:
        path: The file.
        folder: The folder of rules that it goes to.
        base: The profile that it joins.
        over: Primitives that it is to be more specific than, which orders what is ambiguous.
        beside: Every rule file that counts already; None for those of the folder.

    Returns:
        Where it now is.

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
        draft.write_text(_text(path) + _ordering(path, over), encoding="utf-8")
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
        failures = try_rule(draft, base=base, beside=others)
        if failures:
            told = "\n".join(failures).replace(str(draft), str(path))
            raise RuleError(f"its examples do not hold:\n{told}")
        draft.replace(target)
    return target


def remove_rule(name: str, *, files: Sequence[Path]) -> Path:
    """Take a primitive out of rule files that people wrote.

    Args:
        name: The primitive.
        files: The files to look through.

    Returns:
        The first file that introduces it, which is gone.

    Raises:
        UnknownNameError: None of them introduces it.
    """
    info = {each: path for path in reversed(files) for each in introduced(path)}
    if name not in info:
        folders = ", ".join(sorted({str(each.parent) for each in files}))
        raise UnknownNameError("rule of the user's", name, info, where=folders)
    info[name].unlink()
    return info[name]


def _ordering(path: Path, over: Sequence[str]) -> str:
    names = introduced(path) if over else []
    return "".join(f'specialises("{name}", "{other}").\n' for name in names for other in over)


def introduced(path: Path) -> list[str]:
    """The primitives that a rule file states, in their order."""
    return re.findall(r'^\s*primitive\("(\w+)"\)', _text(path), re.MULTILINE)


def _pairs(statements: Sequence[Statement], predicate: str) -> Iterator[tuple[str, str]]:
    for each in statements:
        for head in each.heads:
            if head.signature == (predicate, 2):
                first, second = split_arguments(head.text)
                yield first.strip('"'), second.strip('"')


def _definition(comment: str) -> str:
    text = " ".join(comment.strip("%* \n").split())
    return text.partition(": ")[2] or text


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror}.", "Name a rule file.") from None
    except UnicodeDecodeError:
        raise FileError(path, "is no UTF-8 text.", "Save it as UTF-8.") from None
