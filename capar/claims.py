"""Claims about captures, written in words and checked: a test tool for motion.

A claim reads like ``right_hand MoveObjTo(mug, head) before head looks away from mug``.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from capar.model.errors import CaparError
from capar.model.facts import Fact, LookingAt, Moving, Touching
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


class ClaimError(CaparError):
    """A claim that cannot be read, or that speaks of what is not there."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether a claim holds of a capture, and what was found instead."""

    claim: str
    capture: str
    holds: bool
    found: str


def judge(claim: str, observation: Observation) -> Verdict:
    """Check a claim against an observed capture.

    Raises:
        ClaimError: The claim cannot be read.
    """
    holds, found = _judged(claim.strip(), observation)
    return Verdict(claim, observation.capture, holds, found)


def _judged(claim: str, seen: Observation) -> tuple[bool, str]:
    sequence = re.fullmatch(r"(\w+):\s*(.+)", claim)
    if sequence:
        return _sequence(sequence[1], sequence[2], seen)
    lasting = re.fullmatch(r"(.+) lasts ([\d.]+) to ([\d.]+) s", claim)
    if lasting:
        spans = list(_event(lasting[1], seen))
        low, high = float(lasting[2]), float(lasting[3])
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


def _related(first: str, relation: str, second: str, seen: Observation) -> tuple[bool, str]:
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


def _sequence(ee: str, names: str, seen: Observation) -> tuple[bool, str]:
    """The whole sequence of an end-effector; ... stands for any steps."""
    segments = _of(ee, seen)
    wanted = [each.strip() for each in re.split(r",\s*(?![^()]*\))", names)]
    found = ", ".join(each.name for each in segments)
    return _follows(wanted, list(segments)), f"{ee}: {found}"


def _follows(wanted: list[str], segments: list[Segment]) -> bool:
    if not wanted:
        return not segments
    if wanted[0] == "...":
        return any(_follows(wanted[1:], segments[at:]) for at in range(len(segments) + 1))
    return bool(segments and _fits(segments[0], wanted[0]) and _follows(wanted[1:], segments[1:]))


_STEP = re.compile(r"([A-Z]\w*)(?:\(([^()]*)\))?")


def _fits(segment: Segment, text: str) -> bool:
    """Whether a segment is of that name, or of one that specialises it, with those objects."""
    step = _STEP.fullmatch(text)
    if step is None:
        raise ClaimError(f"{text!r} is no step such as MoveObjTo(mug, head)")
    if step[1] not in (segment.name, *segment.general):
        return False
    if step[2] is None:
        return True
    objects = [each.strip() for each in step[2].split(",") if each.strip()]
    return len(objects) <= len(segment.objects) and all(
        each in ("_", found) for each, found in zip(objects, segment.objects, strict=False)
    )


def _event(text: str, seen: Observation) -> Iterator[Span]:
    """When an event is."""
    for pattern, spans in _EVENTS:
        found = re.fullmatch(pattern, text)
        if found:
            return spans(found, seen)
    raise ClaimError(f"{text!r} is no event; {HELP}")


def _looks(found: re.Match[str], seen: Observation) -> Iterator[Span]:
    for each in _facts(seen, LookingAt):
        if (each.sensor, each.object) == (found[1], found[3]):
            yield _when(each.first, each.last, seen, ending=found[2] != "at")


def _meets(found: re.Match[str], seen: Observation) -> Iterator[Span]:
    pair = {_known(found[1], seen), _known(found[3], seen)}
    spans = {
        _when(each.first, each.last, seen, ending=found[2] != "touches")
        for each in _facts(seen, Touching)
        if {each.body, each.other} == pair
    }
    return iter(sorted(spans))


def _moves(found: re.Match[str], seen: Observation) -> Iterator[Span]:
    name = _known(found[1], seen)
    for each in _facts(seen, Moving):
        if each.object == name:
            yield _when(each.first, each.last, seen, ending=False)


def _step(found: re.Match[str], seen: Observation) -> Iterator[Span]:
    for segment in _of(found[1], seen):
        if _fits(segment, found[2]):
            yield segment.start_s, segment.end_s


def _together(found: re.Match[str], seen: Observation) -> Iterator[Span]:
    """When several end-effectors do a step as one action."""
    who = [found[1].strip()] if found[1].startswith("both ") else found[1].split(" and ")
    if len(who) > 1:
        for ee in who:
            _of(ee, seen)
    segments = {(each.ee, each.index): each for each in seen.segments}
    for joint in seen.joint:
        parts = [segments[each] for each in zip(joint.ees, joint.segments, strict=True)]
        acting = [seen.who(joint)] if len(who) == 1 else joint.ees
        if sorted(acting) == sorted(who) and all(_fits(each, found[2]) for each in parts):
            yield joint.start_s, joint.end_s


_EVENTS: tuple[tuple[str, Callable[[re.Match[str], Observation], Iterator[Span]]], ...] = (
    (r"(\w+) looks (at|away from) (\w+)", _looks),
    (r"(\w+) (touches|lets go of) (\w+)", _meets),
    (r"(\w+) moves", _moves),
    (r"(both (?:hands|feet)|\w+(?: and \w+)+) do ([A-Z]\w*(?:\([^()]*\))?)", _together),
    (r"(\w+) ([A-Z]\w*(?:\([^()]*\))?)", _step),
)


def _facts(seen: Observation, kind: type[_Kind]) -> Iterator[_Kind]:
    return (each for each in seen.facts if isinstance(each, kind))


def _when(first: int, last: int, seen: Observation, *, ending: bool) -> Span:
    rate = seen.rate_hz
    return (last / rate, last / rate) if ending else (first / rate, last / rate)


def _of(ee: str, seen: Observation) -> Sequence[Segment]:
    links = {each.ee: each.segments for each in seen.links}
    if ee not in links:
        raise ClaimError(
            f"no end-effector {ee!r} acts in {seen.capture!r}; there are {sorted(links)}"
        )
    return links[ee]


def _known(name: str, seen: Observation) -> str:
    names = {each.name for each in seen.objects} | {each.ee for each in seen.links}
    if name not in names:
        raise ClaimError(f"no body {name!r} in {seen.capture!r}; there are {sorted(names)}")
    return name


def _told(spans: Sequence[Span]) -> str:
    return ", ".join(f"{first:.2f} to {last:.2f} s" for first, last in spans) or "never"
