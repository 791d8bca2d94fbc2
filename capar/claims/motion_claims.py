"""Claims about captures, written in words and checked: a test tool for motion.

A claim reads like ``right_hand MoveObjTo(mug, head) before head looks away from mug``.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from capar.claims.names import ClaimError as ClaimError
from capar.claims.names import Names, names_of, parts
from capar.model.facts import Fact, Frames, LookingAt, Moving, Touching
from capar.model.observation import Observation, Segment

Span = tuple[float, float]
"""When something was, from one time to another [s]."""

RELATIONS = ("begins before", "ends before", "before", "after", "while")

HELP = (
    "a claim is EVENT; no EVENT; EVENT before EVENT (or after, while, begins before, ends before); "
    "EVENT lasts 0.5 to 2 s; or END_EFFECTOR: Name, Name, ... with its whole sequence. An event is "
    "END_EFFECTOR Name(object, _); both hands do Name(object, _); BODY touches BODY; "
    "BODY lets go of BODY; OBJECT moves; "
    "HEAD looks at OBJECT; HEAD looks away from OBJECT"
)


_Kind = TypeVar("_Kind", bound=Fact)

_NUMBER = r"\d+(?:\.\d*)?|\.\d+"


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether a claim holds of a capture, and what was found instead."""

    claim: str
    capture: str
    holds: bool
    found: str
    mistake: str = ""
    """Why it could not be judged at all; else empty."""


@dataclass(frozen=True, slots=True)
class _Scene:
    """What was observed, and the names that may be spoken of."""

    seen: Observation
    names: Names


def judge(claim: str, observation: Observation, *, names: Names | None = None) -> Verdict:
    """Check a claim against an observed capture.

    Args:
        claim: In words; ``HELP`` says in which.
        observation: The capture, observed.
        names: What may be spoken of; None for what the observation itself shows.

    Raises:
        ClaimError: The claim cannot be read, or names what there is not.
    """
    scene = _Scene(observation, names or names_of(observation))
    holds, found = _judged(claim.strip(), scene)
    return Verdict(claim, observation.capture, holds, found)


def _judged(claim: str, seen: _Scene) -> tuple[bool, str]:
    sequence = re.fullmatch(r"(\w+):\s*(.+)", claim)
    if sequence:
        return _sequence(sequence[1], sequence[2], seen)
    lasting = re.fullmatch(rf"(.+) lasts ({_NUMBER}) to ({_NUMBER}) s", claim)
    if lasting:
        spans = list(_event(lasting[1], seen))
        low, high = float(lasting[2]), float(lasting[3])
        if low > high:
            raise ClaimError(
                f"nothing lasts {lasting[2]} to {lasting[3]} s; the shorter time first"
            )
        times = [last - first for first, last in spans]
        return bool(times) and all(low <= each <= high for each in times), _told(spans)
    if claim.startswith("no "):
        spans = list(_event(claim[3:], seen))
        return not spans, _told(spans)
    for relation in RELATIONS:
        first, word, second = claim.partition(f" {relation} ")
        if word:
            return _related(first, relation, second, seen)
    spans = list(_event(claim, seen))
    return bool(spans), _told(spans)


def _related(first: str, relation: str, second: str, seen: _Scene) -> tuple[bool, str]:
    one, other = list(_event(first, seen)), list(_event(second, seen))
    holds = any(_stand(each, relation, every) for each in one for every in other)
    return holds, f"{first}: {_told(one)}; {second}: {_told(other)}"


def _stand(one: Span, relation: str, other: Span) -> bool:
    return {
        "before": one[1] <= other[0],
        "after": one[0] >= other[1],
        "while": one[0] < other[1] and other[0] < one[1],
        "begins before": one[0] < other[0],
        "ends before": one[1] < other[1],
    }[relation]


def _sequence(ee: str, names: str, seen: _Scene) -> tuple[bool, str]:
    """The whole sequence of an end-effector; ... stands for any steps."""
    segments = _of(ee, seen)
    wanted = [each.strip() for each in re.split(r",\s*(?![^()]*\))", names)]
    for step in wanted:
        if step != "...":
            seen.names.step(step)
    found = ", ".join(segment.name for segment in segments)
    return _follows(wanted, list(segments)), f"{ee}: {found}"


def _follows(wanted: list[str], segments: list[Segment]) -> bool:
    if not wanted:
        return not segments
    if wanted[0] == "...":
        return any(_follows(wanted[1:], segments[at:]) for at in range(len(segments) + 1))
    return bool(segments and _fits(segments[0], wanted[0]) and _follows(wanted[1:], segments[1:]))


def _fits(segment: Segment, text: str) -> bool:
    """Whether a segment is of that name, or of one that specialises it, with those objects."""
    name, objects = parts(text)
    if name not in (segment.name, *segment.general):
        return False
    if objects is None:
        return True
    return len(objects) <= len(segment.objects) and all(
        each in ("_", found) for each, found in zip(objects, segment.objects, strict=False)
    )


def _event(text: str, seen: _Scene) -> Iterator[Span]:
    """When an event is."""
    for pattern, spans in _EVENTS:
        found = re.fullmatch(pattern, text)
        if found:
            return spans(found, seen)
    raise ClaimError(f"{text!r} is no event; {HELP}")


def _looks(found: re.Match[str], seen: _Scene) -> Iterator[Span]:
    pair = seen.names.sensor(found[1]), seen.names.object(found[3])
    ending = found[2] != "at"
    for look in _facts(seen, LookingAt):
        if (look.sensor, look.object) == pair and not (ending and _cut_off(look.last, seen)):
            yield _when(look.first, look.last, seen, ending=ending)


def _meets(found: re.Match[str], seen: _Scene) -> Iterator[Span]:
    pair = {seen.names.body(found[1]), seen.names.body(found[3])}
    if len(pair) == 1:
        raise ClaimError(f"{found[0]!r}: nothing touches itself")
    ending = found[2] != "touches"
    spans = {
        _when(each.first, each.last, seen, ending=ending)
        for each in _facts(seen, Touching)
        if {each.body, each.other} == pair and not (ending and _cut_off(each.last, seen))
    }
    return iter(sorted(spans))


def _moves(found: re.Match[str], seen: _Scene) -> Iterator[Span]:
    name = seen.names.object(found[1])
    for motion in _facts(seen, Moving):
        if motion.object == name:
            yield _when(motion.first, motion.last, seen, ending=False)


def _step(found: re.Match[str], seen: _Scene) -> Iterator[Span]:
    segments, step = _of(found[1], seen), seen.names.step(found[2])
    for segment in segments:
        if _fits(segment, step):
            yield segment.start_s, segment.end_s


def _together(found: re.Match[str], seen: _Scene) -> Iterator[Span]:
    """When several end-effectors do a step as one action."""
    both = found[1].startswith("both ")
    who = [seen.names.pair(found[1])] if both else [*map(seen.names.ee, found[1].split(" and "))]
    if len(set(who)) < len(who):
        raise ClaimError(f"{found[0]!r} names an end-effector twice")
    step = seen.names.step(found[2])
    segments = {(segment.ee, segment.index): segment for segment in seen.seen.segments}
    for joint in seen.seen.joint:
        own = [segments[each] for each in zip(joint.ees, joint.segments, strict=True)]
        acting = [seen.seen.who(joint)] if both else joint.who
        if sorted(acting) == sorted(who) and all(_fits(each, step) for each in own):
            yield joint.start_s, joint.end_s


_EVENTS: tuple[tuple[str, Callable[[re.Match[str], _Scene], Iterator[Span]]], ...] = (
    (r"(\w+) looks (at|away from) (\w+)", _looks),
    (r"(\w+) (touches|lets go of) (\w+)", _meets),
    (r"(\w+) moves", _moves),
    (r"(both (?:hands|feet)|\w+(?: and \w+)+) do ([A-Z]\w*(?:\([^()]*\))?)", _together),
    (r"(\w+) ([A-Z]\w*(?:\([^()]*\))?)", _step),
)


def _facts(seen: _Scene, kind: type[_Kind]) -> Iterator[_Kind]:
    return (fact for fact in seen.seen.facts if isinstance(fact, kind))


def _when(first: int, last: int, seen: _Scene, *, ending: bool) -> Span:
    rate = seen.seen.rate_hz
    return (last / rate, last / rate) if ending else (first / rate, last / rate)


def _cut_off(last: int, seen: _Scene) -> bool:
    """Whether something lasts until the capture's end: nobody saw it end."""
    return any(each.last == last for each in _facts(seen, Frames))


def _of(ee: str, seen: _Scene) -> Sequence[Segment]:
    seen.names.ee(ee)
    return next(link.segments for link in seen.seen.links if link.ee == ee)


def _told(spans: Sequence[Span]) -> str:
    return ", ".join(f"{first:.2f} to {last:.2f} s" for first, last in spans) or "never"
