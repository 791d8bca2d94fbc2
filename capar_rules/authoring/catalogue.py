"""The primitives of a rule base: where each comes from, what it specialises, and what it is."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from capar.model.errors import UnknownNameError
from capar_rules.authoring.user_rules import actionary_rules
from capar_rules.engine.profiles import Profile
from capar_rules.engine.syntax import Statement, parse, split_arguments


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


def _pairs(statements: Sequence[Statement], predicate: str) -> Iterator[tuple[str, str]]:
    for each in statements:
        for head in each.heads:
            if head.signature == (predicate, 2):
                first, second = split_arguments(head.text)
                yield first.strip('"'), second.strip('"')


def _definition(comment: str) -> str:
    text = " ".join(comment.strip("%* \n").split())
    return text.partition(": ")[2] or text
