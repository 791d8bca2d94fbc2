"""In which worlds of the audit each shipped primitive can fit: computed once, and stored.

A rule that asks for ``fits(Segment, "Lift")`` can only fire in the worlds in which Lift can fit, so
that the check of a rule has few worlds to look at. What is stored holds for one text of the rules
alone; where that differs, nothing is taken as known and every world is looked at.
``python -m capar_rules.lint.extents`` computes it again, in about half a minute.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from capar_rules.engine.profiles import profile
from capar_rules.engine.slicing import FITS
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Signature, Statement, parse
from capar_rules.lint.audit import evaluate, premises, world_facts

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
    """Compute and store the extents of every profile."""
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
