"""Where hands change on an object: passes and regrasps by the rules, beside what pictures show."""

import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture
from capar.model.errors import FileError
from capar.model.facts import Lies, Moving, Touching
from capar.model.observation import Observation
from capar.pipelines.observation import facts_program, observe_measured
from capar_rules.borders.ticks import Tick
from capar_rules.engine.profiles import DEFAULT, profile
from capar_rules.engine.solver import rule_file, solve
from extractors.handling_facts import SHIFTS

PASS, OVER_TABLE, REGRASP = "pass", "over_table", "regrasp"
KINDS = (PASS, OVER_TABLE, REGRASP)

Times = Float[np.ndarray, "frames"]

SLACK_S = 0.3
"""Pictures were taken so far apart: what is seen may be so much earlier or later [s]."""


@dataclass(frozen=True, slots=True, order=True)
class Change:
    """A change of the hands on an object."""

    start_s: float
    end_s: float
    kind: str
    ee: str
    object: str = ""
    other: str = ""
    sure: bool = True
    """Whether who saw it was sure."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """What was found beside what was seen."""

    found: tuple[tuple[Change, Change], ...]
    """Seen and found, in pairs."""

    missed: tuple[Change, ...]
    """Seen for sure and not found."""

    open: tuple[Change, ...]
    """Found where the pictures leave it open."""

    extra: tuple[Change, ...]
    """Found and not seen."""


def changes(capture: Capture) -> tuple[Change, ...]:
    """Every pass, change of hands over a support, and regrasp in a capture, in order of time."""
    base = profile(DEFAULT)
    measurements, borders = facts_program(capture, rules=base)
    observation = observe_measured(capture, measurements, rules=base)
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


def read_seen(path: Path, take: str) -> tuple[Change, ...]:
    """What somebody saw in the pictures of a take, in order of time.

    Raises:
        FileError: It is no TOML, has no such take, or an entry is not as it should be.
    """
    try:
        rows = tomllib.loads(path.read_text(encoding="utf-8"))[take]
        seen = [
            Change(
                start_s=float(row["from_s"]),
                end_s=float(row["to_s"]),
                kind=KINDS[KINDS.index(row["kind"])],
                ee=str(row["ee"]),
                other=str(row.get("other", "")),
                sure=bool(row.get("sure", True)),
            )
            for row in rows
        ]
    except (tomllib.TOMLDecodeError, KeyError, TypeError, ValueError) as error:
        raise FileError(
            path,
            f"no list of what was seen in {take!r} ({type(error).__name__}: {error}).",
            f"Each entry, under [[{take}]], has kind ({', '.join(KINDS)}), ee, from_s and to_s.",
        ) from error
    return tuple(sorted(seen))


def compare(seen: Sequence[Change], found: Sequence[Change]) -> Comparison:
    """Pair what was seen with what was found: of one kind and hands, at the same time.

    Each is paired once, those nearest in time first.
    """
    fitting = sorted(
        (abs(_middle(one) - _middle(other)), one, other)
        for one in seen
        for other in found
        if _same(one, other)
    )
    pairs: dict[Change, Change] = {}
    for _, one, other in fitting:
        if one not in pairs and other not in pairs.values():
            pairs[one] = other
    return Comparison(
        found=tuple((one, pairs[one]) for one in seen if one.sure and one in pairs),
        missed=tuple(one for one in seen if one.sure and one not in pairs),
        open=tuple(pairs[one] for one in seen if not one.sure and one in pairs),
        extra=tuple(each for each in found if each not in pairs.values()),
    )


def _middle(change: Change) -> float:
    return (change.start_s + change.end_s) / 2.0


def _same(one: Change, other: Change) -> bool:
    meet = one.start_s - SLACK_S <= other.end_s and other.start_s <= one.end_s + SLACK_S
    return meet and (one.kind, one.ee, one.other) == (other.kind, other.ee, other.other)


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
    moves = [fact for fact in observation.facts if isinstance(fact, Moving)]
    touches = _touches(observation)
    for thing in sorted({touch.other for touch in touches}):
        own = [touch for touch in touches if touch.other == thing]
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
    shifts = [fact for fact in observation.facts if isinstance(fact, Lies) and fact.how == SHIFTS]
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
    hands = {link.ee for link in observation.links}
    found = [
        fact for fact in observation.facts if isinstance(fact, Touching) and fact.body in hands
    ]
    return sorted(found, key=lambda each: (each.first, each.body))
