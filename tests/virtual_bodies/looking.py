"""What a virtual performer looks at, by its script, and what is measured of it.

The truth is a list of fixations: stretches of ``LEAST_S`` or more in which the point that the
performance directs the eyes to stays on one thing, or stays where no thing is. A shift of gaze
from one point to the next is no fixation. While a thing is brought somewhere the gaze waits for it
where it is to arrive; until it is there, that is a fixation of no thing.

A fixation is *right* by the share of its frames in which ``LookingAt`` facts tell its thing; one of
no thing by the share in which they tell no mobile thing (a table is behind every point above it).
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from capar.body.gaze import lines_of_sight
from capar.body.performing import Performance
from capar.model import geometry
from capar.model.capture import Capture, TagType
from capar.model.facts import LookingAt
from extractors.measure import measure

LEAST_S = 0.1
"""Shorter stays are no fixations [s]: people's last 0.2 s and more (Land & Hayhoe 2001)."""

STILL_M = 1e-4
"""A point of gaze that moves no farther than this between two frames stays [m]."""

NO_THING = ""


@dataclass(frozen=True)
class Fixation:
    """A stretch in which one point is looked at."""

    thing: str
    """On which thing the point lies; ``NO_THING`` where none is."""

    first: int
    last: int
    told: float
    """Share of its frames for which facts say what is so [1]."""

    missed_rad: float
    """Largest angle between the line of sight of both eyes and the point [rad]."""


def fixations(made: Performance, capture: Capture) -> tuple[Fixation, ...]:
    """Every fixation of a performance, judged by the facts measured in a capture of it.

    Raises:
        ValueError: The capture has other frames than the performance.
    """
    if len(capture.times) != len(made.times):
        raise ValueError("the capture is not one of this performance")
    facts = [fact for fact in measure(capture).facts if isinstance(fact, LookingAt)]
    told = {name: _told(facts, name, len(made.times)) for name in made.scene.things}
    missed = _missed(made)
    still = np.linalg.norm(np.diff(made.gazes, axis=0), axis=1) <= STILL_M
    stays = np.concatenate([still[:1], still])
    within = {
        name: stays & _within(made, name)
        for name, thing in made.scene.things.items()
        if thing.tag is TagType.MOBILE
    }
    told_mobile = np.any([told[name] for name in within], axis=0)
    within[NO_THING] = stays & ~np.any(list(within.values()), axis=0)
    told[NO_THING] = ~told_mobile
    out = []
    for name, holds in within.items():
        for first, last in geometry.runs(holds):
            if made.times[last] - made.times[first] >= LEAST_S:
                part = slice(first, last + 1)
                right = float(told[name][part].mean())
                out.append(Fixation(name, first, last, right, float(missed[part].max())))
    return tuple(sorted(out, key=lambda fixation: fixation.first))


def share_told(found: Iterable[Fixation], *, of_things: bool) -> float:
    """The share of all frames of fixations, on things or on none, that is told right [1]."""
    some = [fixation for fixation in found if bool(fixation.thing) is of_things]
    frames = [fixation.last - fixation.first + 1 for fixation in some]
    return float(np.average([fixation.told for fixation in some], weights=frames))


def _told(facts: list[LookingAt], name: str, frames: int) -> Bool[np.ndarray, "frames"]:
    out = np.zeros(frames, dtype=bool)
    for fact in facts:
        if fact.object == name:
            out[fact.first : fact.last + 1] = True
    return out


def _within(made: Performance, name: str) -> Bool[np.ndarray, "frames"]:
    """Where the point looked at lies in a thing's own box."""
    path, bounds = made.things[name], made.scene.thing(name).shape.bounds
    local = path.rotation.inv().apply(made.gazes - path.translation)
    return np.asarray(((local >= bounds[0]) & (local <= bounds[1])).all(axis=1))


def _missed(made: Performance) -> np.ndarray:
    """Angles between the eyes' mean line of sight and the point looked at [rad]."""
    spots, ways = lines_of_sight(made.human, made.motion)
    to = made.gazes - spots
    return np.arctan2(np.linalg.norm(np.cross(ways, to), axis=1), np.sum(ways * to, axis=1))
