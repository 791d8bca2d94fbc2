"""What other skeletons and marker sets call the places on the body: one data file a convention."""

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from importlib.resources import files
from typing import Any

from capar.model.errors import CaparError, UnknownNameError
from extractors.readers.body_names.spelling import key_of, matched, spellings

LEAST_SHARE = 0.7
"""Share of a convention's names that a recording has to have to be taken for it [1]."""


class ConventionError(CaparError):
    """Names that are of no known convention."""


@dataclass(frozen=True)
class Convention:
    """Names of joints or key points, and the places on the body that they mean."""

    name: str
    title: str
    source: str
    oriented: bool
    """Whether its files give orientations; else those of segments are derived from points."""

    markers: bool
    """Whether its names are those of markers on the skin, not of joints or key points."""

    points: Mapping[str, str]
    """Segment (its joint with the parent) or site of the body, by foreign name."""

    weights: Mapping[str, float]
    """How much a place counts, where it is not 1 [1]."""

    on: Mapping[str, str] = field(default_factory=dict)
    """Segment by the name of a marker that rides somewhere on it."""

    computed: tuple[str, ...] = ()
    """Patterns of names that its files give to computed quantities, which are no markers."""

    units_m: tuple[float, ...] = ()
    """Units that its files are in without stating them [m]."""

    whole_names: bool = False
    """Whether prefixes up to a colon belong to its names."""

    def named(self, names: Iterable[str]) -> dict[str, str]:
        """The place of each name that it knows, however it is spelled, whoever's it is."""
        if self.whole_names:
            return {name: self.points[name] for name in names if name in self.points}
        found = matched(spellings(names), self.keys)
        return {n: self.points[known] for n, (_, known) in found.items() if known in self.points}

    @cached_property
    def keys(self) -> Mapping[str, str]:
        """Its names by their keys; names of different places that have one key are left out."""
        places: dict[str, set[str]] = {}
        for name, place in (*self.points.items(), *self.on.items()):
            places.setdefault(key_of(name), set()).add(place)
        return {
            key_of(name): name
            for name in (*self.points, *self.on)
            if len(places[key_of(name)]) == 1
        }

    def weight(self, place: str) -> float:
        """How much a place counts [1]."""
        return self.weights.get(place, 1.0)


@cache
def conventions() -> Mapping[str, Convention]:
    """Every convention by name."""
    folder = files("extractors.readers.body_names") / "data" / "conventions"
    out = {}
    for file in sorted(folder.iterdir(), key=lambda each: each.name):
        if file.name.endswith(".toml"):
            name = file.name.removesuffix(".toml")
            out[name] = _convention(name, tomllib.loads(file.read_text("utf-8")))
    return out


def _convention(name: str, row: Mapping[str, Any]) -> Convention:
    return Convention(
        name,
        row["title"],
        row["source"],
        oriented=row["orientations"] == "given",
        markers=row["orientations"] == "markers",
        points=dict(_both_sides(row["points"])),
        weights=row.get("weights", {}),
        on=dict(_both_sides(row.get("on", {}))),
        computed=tuple(row.get("computed", ())),
        units_m=tuple(row.get("units_m", ())),
    )


def _both_sides(names: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Names with their places; those with a placeholder of a side once for each side."""
    for name, place in names.items():
        for side in ("right", "left") if "{" in name else ("none",):
            letter = side[0]
            own = name.format(S=letter.upper(), s=letter, Side=side.title())
            yield own, place.format(side=side)


def convention(name: str) -> Convention:
    """The convention of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in conventions():
        raise UnknownNameError("convention", name, conventions())
    return conventions()[name]


def coverage(names: Iterable[str]) -> dict[str, float]:
    """By convention, the share of its places that some names are of [1]."""
    known = list(names)
    return {
        each.name: len(set(each.named(known).values())) / len(set(each.points.values()))
        for each in conventions().values()
    }


def recognise(names: Iterable[str]) -> Convention:
    """The convention that a recording's names are of: the one of which it has most places.

    Raises:
        ConventionError: It has too few of any.
    """
    known = list(names)
    shares = coverage(known)
    size = {name: len(convention(name).named(known)) for name in shares}
    fits = [name for name, share in shares.items() if share >= LEAST_SHARE]
    if not fits:
        best = max(shares, key=lambda name: shares[name])
        missing = sorted(set(convention(best).points) - {n.rpartition(":")[2] for n in known})
        raise ConventionError(
            f"names of no known convention; nearest is {best!r}, of which there are "
            f"{shares[best]:.0%}, without {', '.join(missing[:6])}; known: {', '.join(shares)}"
        )
    return convention(max(fits, key=lambda name: (size[name], shares[name])))
