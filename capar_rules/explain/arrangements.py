"""How a segment's thing lies to others, and goes to the end-effector, as sentences tell it."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from capar_rules.borders.ticks import constants, in_frames, times
from capar_rules.explain import quantities
from capar_rules.explain.clock import Clock

AHEAD_DEG, AFTER_DEG = 45.0, 135.0
"""Up to which angle a thing goes ahead of what moves it, and from which on after it [degrees]."""

MOVED_ON = 0.5
"""How near what came down and was moved on is taken to come to being put down [1]."""


@dataclass(frozen=True, slots=True)
class Bearing:
    """At which level angles a thing goes from a segment's start to its end."""

    offset_deg: float
    """To the line from the end-effector to the thing's middle, as both are at the start."""

    press_deg: float | None = None
    """To the direction in which the end-effector presses on it; None where it presses not aside."""

    @property
    def ahead_deg(self) -> float:
        """The angle that is told where it goes ahead: that of pressing if only that is small."""
        by_press = self.press_deg is not None and self.offset_deg > AHEAD_DEG
        return self.press_deg if by_press and self.press_deg is not None else self.offset_deg

    @property
    def by_press(self) -> bool:
        """Whether only by the direction of pressing it goes ahead."""
        near = self.press_deg is not None and self.press_deg <= AHEAD_DEG
        return near and AHEAD_DEG < self.offset_deg < 90.0


def bearing(clock: Clock, segment: str) -> Bearing | None:
    """At which angles a segment's thing goes; None where it goes nowhere, or that is not known."""
    span, thing, hand = clock.span(segment), clock.objects.get(segment, ""), hand_of(segment)
    if span is None:
        return None
    places = clock.measured.places
    from_hand, start, end = (
        places.get(key) for key in ((hand, span[0]), (thing, span[0]), (thing, span[1]))
    )
    if from_hand is None or start is None or end is None:
        return None
    course = end[0] - start[0], end[1] - start[1]
    line = start[0] - from_hand[0], start[1] - from_hand[1]
    if not any(course) or not any(line):
        return None
    met = clock.measured.contact(hand, thing, span[0], in_frames(times().merge_ms, clock.rate_hz))
    press = clock.measured.presses.get((hand, thing), {}).get(met[0]) if met else None
    aside = press is not None and math.hypot(*press) >= constants()["steep_permille"]
    return Bearing(_angle(line, course), _angle(press, course) if aside and press else None)


def little_way(clock: Clock, segment: str) -> float | None:
    """How far aside a segment's thing ended, if that is too near to tell a direction [m]."""
    span, thing = clock.span(segment), clock.objects.get(segment, "")
    ends = [clock.measured.places.get((thing, frame)) for frame in span or ()]
    if len(ends) < 2 or ends[0] is None or ends[1] is None:
        return None
    aside = math.hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1])
    return aside / 1000.0 if aside < constants()["slide_mm"] else None


def _angle(one: tuple[int, int], other: tuple[int, int]) -> float:
    across = one[0] * other[1] - one[1] * other[0]
    return math.degrees(abs(math.atan2(across, one[0] * other[0] + one[1] * other[1])))


def hand_of(segment: str) -> str:
    """The end-effector of the segment that a term names."""
    return segment.removeprefix("seg(").split(",")[0]


def frame_of(clock: Clock, segment: str, side: str) -> int | None:
    """The frame of a side of a segment."""
    span = clock.span(segment)
    return None if span is None or side not in ("start", "end") else span[side == "end"]


def normal_deg(clock: Clock, body: str, other: str, frame: int) -> float | None:
    """How far from straight up the other pushes a body where they touch at a frame [degrees].

    None where they do not touch then, or the direction was not measured.
    """
    known = clock.measured
    met = known.contact(body, other, frame, in_frames(times().merge_ms, clock.rate_hz))
    permille = known.upward(body, other, met[0]) if met else None
    return (
        None if permille is None else math.degrees(math.acos(max(-1.0, min(1.0, permille / 1e3))))
    )


def steepest_deg() -> float:
    """Up to which angle from straight up what pushes a body bears it [degrees]."""
    return math.degrees(math.acos(constants()["steep_permille"] / 1000.0))


def met_at(clock: Clock, segment: str, side: str) -> tuple[str, ...]:
    """What the segment's thing touches at a side of the segment, but the end-effector."""
    thing = clock.objects.get(segment, "")
    found = clock.met.get((segment, side, thing), ())
    return tuple(other for other in dict.fromkeys(found) if other != hand_of(segment))


def kept(clock: Clock, segment: str) -> tuple[str, ...]:
    """What the segment's thing touches at its start and at its end."""
    at_end = met_at(clock, segment, "end")
    return tuple(other for other in met_at(clock, segment, "start") if other in at_end)


def keeper(clock: Clock, segment: str) -> tuple[int, str, int] | None:
    """Who else has a segment's thing since before its end-effector touched it.

    Returns:
        The frame since which, who, and the frame at which the segment's end-effector touched it.
    """
    thing, span = clock.objects.get(segment, ""), clock.span(segment)
    contacts, hand = clock.measured.held.get(thing, ()), hand_of(segment)
    if span is None:
        return None
    own = [first for ee, first, last in contacts if ee == hand and first <= span[0]]
    before = [
        (first, clock.called(ee), ee)
        for ee, first, last in contacts
        if ee != hand and own and first <= max(own) and last >= span[1]
    ]
    if not before:
        return None
    since, _, other = min(before)
    return since, other, max(own)


def left(clock: Clock, segment: str) -> tuple[str, ...]:
    """What the segment's thing touches at its start and no longer at its end."""
    at_end = met_at(clock, segment, "end")
    return tuple(other for other in met_at(clock, segment, "start") if other not in at_end)


def reached(clock: Clock, segment: str) -> tuple[str, ...]:
    """What the segment's thing touches at its end and did not touch at its start."""
    at_start = met_at(clock, segment, "start")
    return tuple(other for other in met_at(clock, segment, "end") if other not in at_start)


def laid(clock: Clock, segment: str) -> str:
    """How a thing that came down was left there; empty where its hold is not known."""
    span = clock.span(segment)
    held = _held(clock, segment)
    if span is None or held is None:
        return ""
    alone = ""
    if not met_at(clock, segment, "end"):
        alone = ", in contact with no other recorded or assumed object"
    let_go = _let_go(clock, segment, held[1])
    later = held[1] - span[1] > in_frames(times().merge_ms, clock.rate_hz)
    stilled = _stilled(clock, segment)
    if later:
        return f"did not move from the end until {let_go}{alone}"
    if stilled is None or stilled >= held[1]:
        return f"came down to where {let_go}{alone}"
    return f"came down and did not count as moving from {clock.at(stilled)} until {let_go}{alone}"


def _stilled(clock: Clock, segment: str) -> int | None:
    """The last frame in which a segment's thing counts as moving within it."""
    span, moves = clock.span(segment), clock.measured.moving.get(clock.objects.get(segment, ""), ())
    return max((last for first, last in moves if span and first < span[1]), default=None)


def not_laid(clock: Clock, segment: str) -> str:
    """Why a thing was not put down; empty where that is not known."""
    span, thing = clock.span(segment), clock.objects.get(segment, "")
    places, held = clock.measured.places, _held(clock, segment)
    if span is None or held is None:
        return ""
    start, end = (places.get((thing, frame)) for frame in span)
    if start is None or end is None:
        return ""
    if start[2] - end[2] < constants()["height_mm"]:
        x, y, z = (after - before for before, after in zip(start, end, strict=True))
        return quantities.not_down(x, y, z).text
    moves = clock.measured.moving.get(thing, ())
    again = [first for first, last in moves if last > span[1] and first < held[1]]
    if not again:
        objects = clock.listed.get(segment, ())
        new = sorted(reached(clock, segment), key=lambda other: other not in objects)
        return (
            f"came to touch the {clock.called(new[0])} (a PutDown makes no new contact)"
            if new
            else ""
        )
    let_go = _let_go(clock, segment, held[1])
    if min(again) > span[1]:
        return f"was moved again from {clock.at(min(again))} on, before {let_go}"
    late = held[1] - span[1] > in_frames(times().merge_ms, clock.rate_hz)
    still = f"at the end ({clock.at(span[1])}), before" if late else "when"
    return f"was still moving {still} {let_go}"


def laid_frames(clock: Clock, segment: str) -> tuple[int, ...]:
    """When a thing that came down is moved again, if it is, and let go of."""
    span, held = clock.span(segment), _held(clock, segment)
    if span is None or held is None:
        return ()
    moves = clock.measured.moving.get(clock.objects.get(segment, ""), ())
    again = [first for first, last in moves if last > span[1] and span[1] < first < held[1]]
    return (*again[:1], held[1])


def _let_go(clock: Clock, segment: str, frame: int) -> str:
    """When an end-effector let go of its thing, or, if not tracked then, was last seen at it."""
    hand, thing = hand_of(segment), clock.objects.get(segment, "")
    called, at, it = clock.called(hand), clock.at(frame), clock.it(thing, object_=True)
    gaps = clock.measured.lost.get(hand, ())
    if any(first <= frame + 1 <= last for first, last in gaps):
        return f"the {called} was last tracked at {it}, at {at} (taken for letting go)"
    return f"the {called} let go of {it} at {at}"


def nearly_laid(clock: Clock, segment: str) -> float:
    """How near a thing that was not put down came to that: a share of what is asked for."""
    span, thing = clock.span(segment), clock.objects.get(segment, "")
    ends = [clock.measured.places.get((thing, frame)) for frame in span or ()]
    if len(ends) < 2 or ends[0] is None or ends[1] is None:
        return 0.0
    share = (ends[0][2] - ends[1][2]) / constants()["height_mm"]
    return max(share, quantities.FAR_OFF) if share < 1.0 else MOVED_ON


def _held(clock: Clock, segment: str) -> tuple[int, int] | None:
    """The contact of a segment's end-effector with its thing at the segment's end."""
    span, thing = clock.span(segment), clock.objects.get(segment, "")
    if span is None:
        return None
    merge = in_frames(times().merge_ms, clock.rate_hz)
    return clock.measured.contact(hand_of(segment), thing, span[1], merge)


def lying(clock: Clock, how: str, body: str, other: str, frame: int) -> int | None:
    """The frame at which a body lies so to another: this, or the first one soon after it."""
    merge = in_frames(times().merge_ms, clock.rate_hz)
    spans = clock.measured.lies.get((how, body, other), ())
    found = [max(first, frame) for first, last in spans if first <= frame + merge and last >= frame]
    return min(found, default=None)


def untracked(clock: Clock, bodies: tuple[str, ...]) -> Iterator[tuple[str, list[tuple[int, int]]]]:
    """Which of some bodies were not tracked in the explained segment, and from when to when."""
    own = clock.span(clock.own)
    for body in bodies:
        gaps = clock.measured.lost.get(body, ())
        inside = [(max(first, own[0]), min(last, own[1])) for first, last in gaps] if own else []
        inside = [(first, last) for first, last in inside if first <= last]
        if inside:
            yield body, inside
