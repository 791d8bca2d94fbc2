"""Vectors, NLTs and paths as compact literals: numbers divided by single spaces."""

import math
from collections.abc import Iterable

from pyoxigraph import Literal

from capar.model.errors import CaparError
from capar.model.locations import SampledTrack
from capar.model.par import Nlt, PathPoint
from ontology import CAPAR


class LiteralError(CaparError):
    """A compact literal that is not what its datatype promises."""


def vector(values: Iterable[float]) -> Literal:
    """Numbers as a literal that keeps each of them exactly.

    Raises:
        LiteralError: A number that is not finite.
    """
    return Literal(_text(values, "vector"), datatype=CAPAR.vector)


def nlt(value: Nlt) -> Literal:
    """A normalised local transform as a literal.

    Raises:
        LiteralError: A number that is not finite.
    """
    return Literal(_text((*value.position, *value.orientation), "NLT"), datatype=CAPAR.nlt)


def path(points: Iterable[PathPoint]) -> Literal:
    """Significant points as a literal: time and place of each.

    Raises:
        LiteralError: A number that is not finite.
    """
    numbers = [each for point in points for each in (point.time, *point.position)]
    return Literal(_text(numbers, "path"), datatype=CAPAR.path)


def track(value: SampledTrack) -> Literal:
    """Sampled places as a literal: the seconds between two samples, and their text."""
    return Literal(f"{value.step_s!r} {value.samples}", datatype=CAPAR.sampledTrack)


def track_of(text: str) -> SampledTrack:
    """The sampled places that a literal states, of a body without a name.

    Raises:
        LiteralError: It is no step of time and places.
    """
    step, _, samples = text.partition(" ")
    try:
        return SampledTrack("", float(step), samples)
    except (ValueError, CaparError):
        raise LiteralError(f"{text[:40]!r} is no step in seconds and places in Base64") from None


def numbers(text: str) -> tuple[float, ...]:
    """The numbers of a compact literal.

    Raises:
        LiteralError: Something that is not a finite number.
    """
    try:
        values = tuple(float(each) for each in text.split())
    except ValueError:
        values = (math.nan,)
    if not all(map(math.isfinite, values)):
        raise LiteralError(f"{text!r} is no row of finite numbers divided by spaces")
    return values


def nlt_of(text: str) -> Nlt:
    """The normalised local transform that a literal states.

    Raises:
        LiteralError: It has not seven finite numbers.
    """
    values = numbers(text)
    if len(values) != 7:
        raise LiteralError(f"{text!r} has {len(values)} numbers; an NLT has 7: x y z, then w x y z")
    return Nlt((values[0], values[1], values[2]), (values[3], values[4], values[5], values[6]))


def path_of(text: str) -> tuple[PathPoint, ...]:
    """The significant points that a literal states.

    Raises:
        LiteralError: Its numbers are no fours.
    """
    values = numbers(text)
    if len(values) % 4:
        raise LiteralError(f"{text!r} has {len(values)} numbers; a path has four for each point")
    fours = [values[at : at + 4] for at in range(0, len(values), 4)]
    return tuple(PathPoint(time, (x, y, z)) for time, x, y, z in fours)


def _text(values: Iterable[float], what: str) -> str:
    floats = [float(each) for each in values]
    if not all(map(math.isfinite, floats)):
        raise LiteralError(f"{what} {floats} has a number that is not finite")
    return " ".join(map(repr, floats))
