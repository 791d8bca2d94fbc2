"""What other skeletons call the places on the body: one data file a convention."""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from capar.model.errors import CaparError, UnknownNameError

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

    points: Mapping[str, str]
    """Segment (its joint with the parent) or site of the body, by foreign name."""

    weights: Mapping[str, float]
    """How much a place counts, where it is not 1 [1]."""

    def named(self, names: Iterable[str]) -> dict[str, str]:
        """The place of each name that it knows; prefixes up to a colon are left out."""
        short = {name: name.rpartition(":")[2] for name in names}
        return {name: self.points[bare] for name, bare in short.items() if bare in self.points}

    def weight(self, place: str) -> float:
        """How much a place counts [1]."""
        return self.weights.get(place, 1.0)


@cache
def conventions() -> Mapping[str, Convention]:
    """Every convention by name."""
    folder = files("capar.body") / "data" / "conventions"
    out = {}
    for file in sorted(folder.iterdir(), key=lambda each: each.name):
        if file.name.endswith(".toml"):
            name = file.name.removesuffix(".toml")
            row = tomllib.loads(file.read_text("utf-8"))
            oriented = row["orientations"] == "given"
            out[name] = Convention(
                name, row["title"], row["source"], oriented, row["points"], row.get("weights", {})
            )
    return out


def convention(name: str) -> Convention:
    """The convention of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in conventions():
        raise UnknownNameError("convention", name, conventions())
    return conventions()[name]


def recognise(names: Iterable[str]) -> Convention:
    """The convention that a recording's names are of: the one of which it has most places.

    Raises:
        ConventionError: It has too few of any.
    """
    known = list(names)
    shares = {
        each.name: len(set(each.named(known).values())) / len(set(each.points.values()))
        for each in conventions().values()
    }
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
