"""Audit of a rule base over every possible segment: uncovered, ambiguous and shadowed cases."""

import json
import re
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import Atom, brave, rule_file, store_reduced, worlds
from capar_rules.engine.syntax import (
    FITS,
    Signature,
    Statement,
    heads_of,
    parse,
    parse_text,
    signatures_below,
    towards,
)

ASKED: tuple[Signature, ...] = (
    ("nameless", 4),
    ("clash", 6),
    ("fitting", 1),
    ("winning", 1),
    ("possible", 4),
    ("primitive", 1),
    ("excused", 5),
)

BATCH = 30
"""Worlds for each call of the solver, when much is asked of each: with fewer the rules are grounded
more often, with more the search takes longer; of 10 to 200 this was the fastest."""

Features = tuple[str, str, str, str]
"""Relations at the start and at the end, change of location, and force."""


@dataclass(frozen=True, slots=True, order=True)
class Clash:
    """Two primitives that fit one segment, neither of which specialises the other."""

    first: str
    second: str
    features: tuple[Features, ...]
    """Feature sets of the segments that both fit, sorted."""


@dataclass(frozen=True, slots=True)
class Audit:
    """What the solver found over every possible segment."""

    possible: int
    """Number of possible feature sets."""

    uncovered: tuple[Features, ...]
    """Feature sets that no rule names, sorted."""

    excused: tuple[tuple[Features, str], ...]
    """Uncovered feature sets for which ``worlds/uncovered.lp`` gives a reason."""

    ambiguous: tuple[Clash, ...]
    shadowed: tuple[str, ...]
    """Primitives that fit some segment, but never as the most specific one."""

    unreachable: tuple[str, ...]
    """Primitives that fit no possible segment, though the audit can decide their conditions."""

    unchecked: tuple[str, ...] = ()
    """Those with conditions that it cannot decide: on what no world contains, or other segments."""

    @property
    def clean(self) -> bool:
        """Whether each name fits some segment, wins one without a rival, and no case lacks one.

        A case without a name that has a reason lacks none.
        """
        unreasoned = set(self.uncovered) - {features for features, _ in self.excused}
        return not (self.ambiguous or self.shadowed or self.unreachable or unreasoned)


def summarise(atoms: frozenset[Atom], *, undecided: Container[object] = ()) -> Audit:
    """The audit of what holds in some world."""
    primitives = {str(each) for (each,) in _rows(atoms, "primitive")}
    fitting = {str(each) for (each,) in _rows(atoms, "fitting")}
    winning = {str(each) for (each,) in _rows(atoms, "winning")}
    return Audit(
        possible=len(_rows(atoms, "possible")),
        uncovered=tuple(sorted(map(_features, _rows(atoms, "nameless")))),
        excused=tuple(sorted((_features(each), str(each[4])) for each in _rows(atoms, "excused"))),
        ambiguous=_clashes(_rows(atoms, "clash")),
        shadowed=tuple(sorted(fitting - winning)),
        unreachable=tuple(sorted(each for each in primitives - fitting if each not in undecided)),
        unchecked=tuple(sorted(each for each in primitives - fitting if each in undecided)),
    )


@cache
def given_in_audit() -> frozenset[Signature]:
    """The predicates that the worlds of the audit define, in place of measurements."""
    return heads_of([*_own("space.lp"), *_own("scene.lp"), *_own("words.lp")]) | {
        ("force_transfer", 0),
        ("gap", 4),
        ("aside", 2),
    }


EMPTY: frozenset[Signature] = frozenset((("gap", 4), ("aside", 2), ("together", 4)))
"""Predicates that hold of nothing in any world, though they may of a segment."""

MEASURED: frozenset[Signature] = frozenset(
    {("course", 2), ("member", 3), ("solid", 1), ("shapeless", 1)}
)
"""What ``words.lp`` chooses that no rule derives, as it is measured or numbered outside."""


def evaluate(
    rules: Sequence[Statement],
    asked: Iterable[Signature],
    *,
    limbs: Container[str] | None = None,
    batch: int = BATCH,
) -> frozenset[Atom]:
    """What rules derive in some possible segment; a call of the solver holds many at a time.

    Args:
        rules: A rule base.
        asked: The predicates that are wanted.
        limbs: Ask only the worlds of these end-effectors; each world has one of its own.
        batch: How many worlds each call of the solver holds.

    Raises:
        RuleError: The rules have an error.
    """
    words = [*_own("scene.lp"), *words_of(rules)]
    given = heads_of([*_own("space.lp"), *words])
    base = [each for each in rules if not {head.signature for head in each.heads} & given]
    questions = [*_own("cases.lp"), *_own("uncovered.lp")]
    stated = heads_of(_own("space.lp")) - heads_of(words)
    kept = towards([*base, *words, *questions], asked, given=stated)
    program = "\n".join(each.text for each in kept)
    texts = [text for limb, text in world_facts().items() if limbs is None or limb in limbs]
    found: set[Atom] = set()
    for at in range(0, len(texts), batch):
        facts = "\n".join(texts[at : at + batch])
        found |= brave(f"{program}\n{facts}\n{{ force_transfer }}.", asked, known=found)
    return frozenset(found)


def words_of(rules: Sequence[Statement]) -> list[Statement]:
    """The rules of ``words.lp`` for relations that a rule base uses."""
    words = _own("words.lp")
    spoken = heads_of([*rules, *_own("space.lp")]) | MEASURED
    return [each for each in words if signatures_below([each]) | heads_of([each]) <= spoken]


@cache
def chosen_in_audit() -> frozenset[Signature]:
    """The relations that the worlds choose freely, some only over a few of their arguments."""
    return heads_of(each for each in _own("words.lp") if each.head_kind == "choice")


def premises() -> tuple[Statement, ...]:
    """Every rule that says which worlds there are, and what can hold in them."""
    return tuple(
        each for name in ("space", "physical", "scene", "words") for each in _own(f"{name}.lp")
    )


@cache
def world_facts() -> Mapping[str, str]:
    """Every world as facts about an end-effector of its own, by its name."""
    rules = (*_own("space.lp"), *_own("physical.lp"))
    fixed = "\n".join(each.text for each in rules if not each.body and each.head_kind == "atom")
    texts = {}
    for number, atoms in enumerate(worlds("\n".join(each.text for each in rules))):
        own = " ".join(f"{each}." for each in atoms)
        texts[f"limb{number}"] = _LIMB.sub(f"limb{number}", f"{own} {fixed}")
    return texts


_LIMB = re.compile(r"\blimb\b")


@cache
def _own(name: str) -> tuple[Statement, ...]:
    """The rules of one file of the audit, without those of the files that it includes."""
    text = (rule_file("lint/worlds") / name).read_text(encoding="utf-8")
    return tuple(each for each in parse_text(_INCLUDE.sub("", text)) if each.kind == "rule")


_INCLUDE = re.compile(r"^#include .*$", re.MULTILINE)


def _rows(atoms: Iterable[Atom], predicate: str) -> list[tuple[object, ...]]:
    return [arguments for name, arguments in atoms if name == predicate]


def _features(row: Sequence[object]) -> Features:
    start, end, change, force = map(str, row[:4])
    return start, end, change, force


def _clashes(rows: Iterable[tuple[object, ...]]) -> tuple[Clash, ...]:
    found: dict[tuple[str, str], set[Features]] = {}
    for first, second, *features in rows:
        found.setdefault((str(first), str(second)), set()).add(_features(features))
    return tuple(Clash(*pair, tuple(sorted(found[pair]))) for pair in sorted(found))


NAMED: Signature = ("named", 2)
PROFILES = ("thesis", "extended")

Worlds = frozenset[str]
"""Worlds by the names of their end-effectors."""


@dataclass(frozen=True, slots=True)
class Extents:
    """The worlds in which each shipped primitive can fit the segment, and can name it."""

    fits: Mapping[str, Worlds]
    named: Mapping[str, Worlds]


@cache
def every_world() -> Worlds:
    """All worlds of the audit."""
    return frozenset(world_facts())


def extents_of(rules: Sequence[Statement]) -> Extents:
    """What is stored of these shipped rules; where nothing is, each can fit in every world."""
    for stored in _stored().values():
        if stored["fingerprint"] == fingerprint(rules):
            return Extents(_unpacked(stored["fits"]), _unpacked(stored["named"]))
    return Extents({}, {})


def computed(rules: Sequence[Statement]) -> Extents:
    """The same by asking the solver about every world."""
    atoms = evaluate(rules, (FITS, NAMED))
    return Extents(_by_name(atoms, "fits"), _by_name(atoms, "named"))


def fingerprint(rules: Sequence[Statement]) -> str:
    """SHA-256 of rules and of what makes the worlds, without comments and places."""
    texts = "\n".join(each.text for each in (*rules, *premises()))
    return sha256(texts.encode()).hexdigest()


def _by_name(atoms: Iterable[tuple[str, tuple[Any, ...]]], predicate: str) -> dict[str, Worlds]:
    found: dict[str, set[str]] = {}
    for name, arguments in atoms:
        if name == predicate:
            (_, limb, _), primitive = arguments
            found.setdefault(primitive, set()).add(limb)
    return {name: frozenset(found[name]) for name in sorted(found)}


def _path() -> Path:
    return rule_file("lint/worlds") / "extents.json"


@cache
def _stored() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(_path().read_text(encoding="utf-8"))
    return found


def _packed(worlds: Mapping[str, Worlds]) -> dict[str, str]:
    """Each set as a number in hexadecimal, in which a bit stands for a world."""
    numbers = {limb: number for number, limb in enumerate(world_facts())}
    return {
        name: f"{sum(1 << numbers[limb] for limb in limbs):x}" for name, limbs in worlds.items()
    }


def _unpacked(packed: Mapping[str, str]) -> dict[str, Worlds]:
    limbs = list(world_facts())
    bits = {name: f"{int(text, 16):b}"[::-1] for name, text in packed.items()}
    return {
        name: frozenset(limbs[at] for at, bit in enumerate(text) if bit == "1")
        for name, text in bits.items()
    }


def store() -> None:
    """Compute and store the extents of every profile, and its rules reduced for the solver."""
    store_reduced(profile(name).files for name in PROFILES)
    stored = {}
    for name in PROFILES:
        rules = parse(profile(name).files)
        found = computed(rules)
        stored[name] = {
            "fingerprint": fingerprint(rules),
            "fits": _packed(found.fits),
            "named": _packed(found.named),
        }
    _path().write_text(json.dumps(stored, indent=1, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    store()
