"""Ticks: the frames of a link at which anything may change, numbered so that rules join neighbours.

Joining intervals by comparing frames inside the rules is quadratic or worse; numbered outside, a
rule meets a border only with its neighbour, and grounding stays linear in the number of events.
"""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Any

from capar.model.facts import (
    Displaced,
    Fact,
    Frames,
    Link,
    Moving,
    Pause,
    RateMhz,
    Resting,
    Touching,
    ZeroCrossing,
)
from capar_rules.borders.motion_borders import Edge, as_borne, by_pair, edges, landings, true_ends
from capar_rules.borders.shared_contacts import by_object, overlapping, shared
from capar_rules.borders.spans import Stretches
from capar_rules.borders.ticks import FreeBetween as FreeBetween
from capar_rules.borders.ticks import LastTick as LastTick
from capar_rules.borders.ticks import Meanwhile as Meanwhile
from capar_rules.borders.ticks import MovesBetween as MovesBetween
from capar_rules.borders.ticks import MovesDuring as MovesDuring
from capar_rules.borders.ticks import Shares as Shares
from capar_rules.borders.ticks import Tick as Tick
from capar_rules.borders.ticks import Within as Within
from capar_rules.borders.times import in_frames, times
from capar_rules.borders.undisturbed_rest import undisturbed


def number_borders(facts: Sequence[Fact], *, crossings_only: bool) -> tuple[Fact, ...]:
    """The facts that number the borders of every link.

    Args:
        facts: What the extractors measured.
        crossings_only: Whether ticks are the zero crossings, as in the thesis, or else the first
            and last frames of every contact and motion that concerns the link.
    """
    scene = _Scene(facts)
    numbered = (
        fact for link in scene.links for fact in _number_link(scene, link.ee, crossings_only)
    )
    return tuple(sorted(numbered, key=lambda each: (type(each).predicate, each)))


class _Scene:
    """The measurements by what they are about, in order of time."""

    def __init__(self, facts: Sequence[Fact]) -> None:
        self.stretches = Stretches(facts)
        self.seats = by_pair(facts)
        self.touching: dict[str, list[Touching]] = defaultdict(list)
        self.moving: dict[str, list[Moving]] = defaultdict(list)
        self.crossings: dict[str, list[int]] = defaultdict(list)
        self.pauses: dict[str, list[int]] = defaultdict(list)
        self.rests: dict[str, list[Resting]] = defaultdict(list)
        kinds: dict[type, list[Any]] = defaultdict(list)
        for fact in facts:
            kinds[type(fact)].append(fact)
        self.links: list[Link] = kinds[Link]
        self.displaced: list[Displaced] = kinds[Displaced]
        self.frames: Frames = next(iter(kinds[Frames]), Frames(0, 0))
        self.rate = next((each.rate / 1000.0 for each in kinds[RateMhz]), 0.0)
        for touch in kinds[Touching]:
            self.touching[touch.body].append(touch)
        for move in kinds[Moving]:
            self.moving[move.object].append(move)
        for crossing in kinds[ZeroCrossing]:
            self.crossings[crossing.ee].append(crossing.frame)
        for pause in kinds[Pause]:
            self.pauses[pause.ee].append(pause.frame)
        for rest in kinds[Resting]:
            self.rests[rest.ee].append(rest)
        for touches in self.touching.values():
            touches.sort(key=lambda each: each.first)
        self.by_object = {link.ee: by_object(self.touching[link.ee]) for link in self.links}
        for moves in self.moving.values():
            moves.sort(key=lambda each: each.first)
        for frames in (*self.crossings.values(), *self.pauses.values()):
            frames.sort()


def _number_link(scene: _Scene, ee: str, crossings_only: bool) -> Iterable[Fact]:
    own = scene.touching[ee]
    reach = _reach(own, round(in_frames(times().margin_ms, scene.rate)))
    others = [
        each
        for name in reach
        for each in scene.touching[name]
        if each.other != ee and _overlap(reach[name], each.first, each.last)
    ]
    moves = {
        name: [each for each in scene.moving[name] if _overlap(reach[name], each.first, each.last)]
        for name in reach
    }
    moves |= {each.other: scene.moving[each.other] for each in others if each.other not in moves}
    crossings = scene.crossings[ee]
    refined: tuple[Edge, ...] = ()
    borne: list[Touching] = []
    if crossings_only:
        frames = set(crossings)
    else:
        held = (each for name in reach for each in moves[name])
        refined = edges(own, held, scene.displaced)
        frames = {frame for each in (*own, *others) for frame in (each.first, each.last)}
        frames |= {frame for name in reach for each in moves[name] for frame in _ends(each)}
        frames |= {each.refined for each in refined}
        frames |= {frame for each in others for frame in true_ends(each, scene.seats)}
        borne = sorted((as_borne(each, scene.seats) for each in own), key=_ends)
        frames |= {frame for each in borne for frame in _ends(each)}
        frames |= {
            pause
            for gap in _free(own)
            for pause in scene.pauses[ee][
                bisect_right(scene.pauses[ee], gap[0]) : bisect_left(scene.pauses[ee], gap[1])
            ]
        }
        frames |= {frame for ends in scene.stretches.frames(ee) for frame in ends}
        frames |= {
            frame
            for name in reach
            for ends in scene.stretches.frames(name)
            if _overlap(reach[name], *ends)
            for frame in ends
        }
    first, last = scene.frames.first, scene.frames.last
    ticks = sorted({first, last} | {frame for frame in frames if first < frame < last})
    yield from (Tick(ee, index, frame) for index, frame in enumerate(ticks))
    yield LastTick(ee, len(ticks) - 1)
    yield from _within(ee, ticks, own, others)
    yield from _moves(ee, ticks, moves)
    yield from (
        each.kind(ee, each.object, each.frame, bisect_left(ticks, each.refined)) for each in refined
    )
    yield from (
        FreeBetween(ee, bisect_left(ticks, gap[0]), bisect_left(ticks, gap[1]))
        for gap in (() if crossings_only else _free(own))
    )
    yield from (
        MovesDuring(ee, each.other, each.first)
        for each in own
        if _overlap(
            [(each.first, each.last) for each in scene.moving[each.other]], each.first, each.last
        )
    )
    if not crossings_only:
        yield from landings(ee, ticks, own, others, scene.seats)
        yield from scene.stretches.numbered(ee, ticks, reach)
        yield from undisturbed(ee, ticks, scene.rests[ee], borne)
        others_too = [scene.by_object[link.ee] for link in scene.links if link.ee != ee]
        pairs = overlapping(own, others_too)
        yield from shared(ee, ticks, pairs, rate_hz=scene.rate)
        yield from _within(ee, ticks, (), sorted({each for _, each in pairs}))


def _reach(own: Iterable[Touching], margin: int) -> dict[str, list[tuple[int, int]]]:
    """For each object that the end-effector touches, when: disjoint intervals, a little wider."""
    reach: dict[str, list[tuple[int, int]]] = {}
    for contact in own:
        spans = reach.setdefault(contact.other, [])
        first, last = contact.first - margin, contact.last + margin
        if spans and first <= spans[-1][1]:
            spans[-1] = (spans[-1][0], max(last, spans[-1][1]))
        else:
            spans.append((first, last))
    return dict(sorted(reach.items()))


def _free(own: Iterable[Touching]) -> list[tuple[int, int]]:
    """Last and first frames of neighbouring contacts, whatever is touched, with none between."""
    gaps: list[tuple[int, int]] = []
    last = None
    for contact in own:
        if last is not None and contact.first > last + 1:
            gaps.append((last, contact.first))
        last = contact.last if last is None else max(last, contact.last)
    return gaps


def _overlap(spans: Sequence[tuple[int, int]], first: int, last: int) -> bool:
    """Whether disjoint, sorted spans share a frame with an interval."""
    index = bisect_right(spans, (last, 1 << 62)) - 1
    return index >= 0 and spans[index][1] >= first


def _ends(fact: Moving | Touching) -> tuple[int, int]:
    return fact.first, fact.last


def _within(
    ee: str, ticks: list[int], own: Iterable[Touching], others: Iterable[Touching]
) -> Iterable[Fact]:
    for contact in (*own, *others):
        first, last = bisect_left(ticks, contact.first), bisect_right(ticks, contact.last) - 1
        if first <= last:
            yield Within(ee, contact.body, contact.other, contact.first, first, last)


def _moves(ee: str, ticks: list[int], moves: dict[str, list[Moving]]) -> Iterable[Fact]:
    found = {
        (name, gap)
        for name, group in moves.items()
        for each in group
        for gap in range(bisect_right(ticks, each.first) - 1, bisect_left(ticks, each.last))
        if 0 <= gap < len(ticks) - 1
    }
    return (MovesBetween(ee, name, gap) for name, gap in sorted(found))
