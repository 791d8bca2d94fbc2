"""The primitives of rule bases and files: where each comes from, and which depend on which."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from capar.model.errors import UnknownNameError
from capar_rules.authoring.user_rules import actionary_rules
from capar_rules.engine.profiles import Profile
from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Statement, parse, split_arguments
from capar_rules.lint.rule_text import read_rules


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
            split_arguments(statement.heads[0].text)[0].strip('"'),
            origins.get(statement.place.file, "core"),
            statement.place.file,
            _definition(heads.get(statement.place.file, "")),
            "",
            (),
        )
        for statement in statements
        if statement.heads and statement.heads[0].signature == ("primitive", 1)
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


def _pairs(statements: Sequence[Statement], predicate: str) -> Iterator[tuple[str, str]]:
    for statement in statements:
        for head in statement.heads:
            if head.signature == (predicate, 2):
                first, second = split_arguments(head.text)
                yield first.strip('"'), second.strip('"')


def _definition(comment: str) -> str:
    text = " ".join(comment.strip("%* \n").split())
    return text.partition(": ")[2] or text


_LIKELY = re.compile(r'\bprimitive\s*\(\s*"([^"\n]*)"\s*\)\s*\.')


def introduced(path: Path) -> list[str]:
    """The primitives that a rule file introduces, in order.

    Of a file with syntax errors, those that it seems to introduce, so that it can be removed.
    """
    reading = read_rules(path, folders=(path.parent,))
    if reading.findings:
        return list(dict.fromkeys(_LIKELY.findall(reading.text)))
    return list(
        dict.fromkeys(
            split_arguments(head.text)[0].strip('"')
            for each in reading.statements
            for head in each.heads
            if head.signature == ("primitive", 1)
        )
    )


ORDERING = (("specialises", 2), ("precedes", 2))
"""Predicates whose second argument is another primitive."""


def dependants(path: Path, *, files: Sequence[Path]) -> dict[str, Path]:
    """Primitives of other rule files that depend on what a file introduces, each with its file.

    They specialise or precede it, or a rule of theirs asks whether a segment fits it.
    """
    names = set(introduced(path))
    found: dict[str, Path] = {}
    for each in files:
        if each.resolve() != path.resolve():
            reading = read_rules(each, folders=(each.parent,))
            if any(names & _read(rule) for rule in reading.statements):
                found |= dict.fromkeys(introduced(each) or [each.stem], each)
    return found


def preceded(path: Path) -> dict[str, list[str]]:
    """For each primitive of a rule file, those that it precedes."""
    found: dict[str, list[str]] = {name: [] for name in introduced(path)}
    for name, other in _pairs(read_rules(path, folders=(path.parent,)).statements, "precedes"):
        found.setdefault(name, []).append(other)
    return found


def _read(rule: Statement) -> set[str]:
    """The primitives that a rule depends on."""
    atoms = [head for head in rule.heads if head.signature in ORDERING]
    atoms += [atom for each in rule.body for atom in each.atoms if atom.signature == FITS]
    return {split_arguments(each.text)[1].strip('"') for each in atoms}
