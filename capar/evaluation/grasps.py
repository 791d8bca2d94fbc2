"""Where hands change on an object: passes, changes over a support, and regrasps."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture
from capar.model.facts import Fact, Lies, Moving, Touching
from capar.model.observation import Observation
from capar_rules.borders.ticks import Tick
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import rule_file, solve
from extractors.handling_facts import SHIFTS
from extractors.measure import Measurements

PASS, OVER_TABLE, REGRASP = "pass", "over_table", "regrasp"
KINDS = (PASS, OVER_TABLE, REGRASP)

Times = Float[np.ndarray, "frames"]


@dataclass(frozen=True, slots=True, order=True)
class Change:
    """A change of the hands on an object."""

    start_s: float
    end_s: float
    kind: str
    ee: str
    object: str = ""
    other: str = ""


def changes(
    observation: Observation,
    capture: Capture,
    measurements: Measurements,
    borders: Sequence[Fact],
    base: Profile,
) -> tuple[Change, ...]:
    """Every pass, change of hands over a support, and regrasp in a capture, in order of time.

    Passes are segments named Give, changes over a support follow from stored contacts, and
    regrasps are those that ``capar facts --derive`` prints.

    Args:
        observation: What was observed.
        capture: For its clock.
        measurements: What was measured, with its flicker resolved.
        borders: Numbered borders, as ``facts_program`` returns them.
        base: The rules.
    """
    answer = solve((*base.files, rule_file("explain/derived.lp")), (*measurements.facts, *borders))
    frames = {(each.ee, each.tick): each.frame for each in borders if isinstance(each, Tick)}
    told = set()
    for segment, thing in answer.of("regrasps"):
        assert isinstance(segment, tuple)
        told.add((str(segment[1]), frames[str(segment[1]), int(str(segment[2]))], str(thing)))
    times = capture.times
    found = (
        *_passes(observation, times),
        *_over(observation, times),
        *_regrasps(observation, times, told),
    )
    return tuple(sorted(found))


def _passes(observation: Observation, times: Times) -> Iterable[Change]:
    """Each segment named Give, from when the other hand touched the object."""
    touches = _touches(observation)
    for segment in observation.segments:
        if "Give" not in (segment.name, *segment.general):
            continue
        for touch in touches:
            taken = touch.other in segment.objects and touch.body != segment.ee
            if taken and touch.first <= segment.first <= touch.last:
                start = times[touch.first]
                yield Change(
                    float(start), segment.start_s, PASS, segment.ee, touch.other, touch.body
                )


def _over(observation: Observation, times: Times) -> Iterable[Change]:
    """Each time that one hand lets go of what stands, and another is the next to touch it."""
    moves = [each for each in observation.facts if isinstance(each, Moving)]
    touches = _touches(observation)
    for thing in sorted({each.other for each in touches}):
        own = [each for each in touches if each.other == thing]
        for one, two in pairwise(own):
            between = [
                each
                for each in moves
                if each.object == thing and each.first < two.first and each.last > one.last
            ]
            if one.body != two.body and one.last < two.first and not between:
                start, end = times[one.last], times[two.first]
                yield Change(float(start), float(end), OVER_TABLE, one.body, thing, two.body)


def _regrasps(
    observation: Observation, times: Times, told: set[tuple[str, int, str]]
) -> Iterable[Change]:
    """What the rules tell, at the time of the shift that begins in the segment, if one does."""
    shifts = [each for each in observation.facts if isinstance(each, Lies) and each.how == SHIFTS]
    for segment in observation.segments:
        for thing in segment.objects:
            if (segment.ee, segment.first, thing) not in told:
                continue
            inside = [
                (float(times[each.first]), float(times[each.last]))
                for each in shifts
                if (each.body, each.other) == (segment.ee, thing)
                and segment.first <= each.first < segment.last
            ]
            for start, end in inside or [(segment.start_s, segment.end_s)]:
                yield Change(start, end, REGRASP, segment.ee, thing)


def _touches(observation: Observation) -> list[Touching]:
    """Contacts of end-effectors, in order of time."""
    hands = {each.ee for each in observation.links}
    found = [
        each for each in observation.facts if isinstance(each, Touching) and each.body in hands
    ]
    return sorted(found, key=lambda each: (each.first, each.body))
