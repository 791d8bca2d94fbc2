"""How something is done: the way between two events, and when which part of it is covered."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from capar.regeneration.errors import PlanError
from capar.regeneration.forces.force_kinds import ForceKind
from capar.regeneration.sources import Hold, Meeting, Source
from capar.regeneration.style_kinds import Kind

SHORTEST_S = 0.15
"""A shorter hold may not be observed any more [s]."""


@dataclass(frozen=True, eq=False)
class Style:
    """The ways of hands and things that are led to new ends."""

    kind: Kind
    hands: Mapping[str, RigidTransform]
    """By side, at every frame of the source."""

    things: Mapping[str, RigidTransform]
    """By name."""

    name: str = ""
    """Of whom it is borrowed; empty for the recorded performer's own."""

    force: ForceKind = ForceKind.SIMILAR
    """What of a force that sets things going is kept."""


def own_style(source: Source, kind: Kind = Kind.PATH) -> Style:
    """The style in which something was recorded."""
    hands = {side: hand.path for side, hand in source.hands.items()}
    return Style(kind, hands, source.paths)


def borrowed_style(source: Source, other: Source, kind: Kind = Kind.PATH) -> Style:
    """The style of another recording of the same: its ways and timing between the same events.

    Args:
        source: What is done.
        other: How it is done.
        kind: What of it is kept.

    Raises:
        PlanError: Other hands do something, or in another order.
    """
    one, two = _steps(source), _steps(other)
    if one != two:
        raise PlanError(
            f"{other.capture.name!r} has another order of events, whose style cannot be borrowed: "
            f"{_told(two)} instead of {_told(one)}"
        )
    frames = np.interp(np.arange(len(source.times)), _events(source), _events(other))
    names = dict(zip(_moved(source), _moved(other), strict=True))
    hands = {side: _at(other.hands[side].path, frames) for side in source.hands}
    things = {n: _at(other.paths[names[n]], frames) for n in source.paths if n in names}
    return Style(kind, hands, {**source.paths, **things}, other.capture.agent.name)


def paced(source: Source, duration_s: float) -> Source:
    """The same in another time, every part of it as much faster or slower.

    Raises:
        PlanError: A hold would become shorter than can be observed.
    """
    pace = duration_s / float(source.times[-1] - source.times[0])
    for span in _spans(source):
        held_s = float(source.times[span.last] - source.times[span.first])
        if 0.0 < held_s * pace < SHORTEST_S:  # a blow lasts no time
            least = SHORTEST_S * duration_s / (held_s * pace)
            raise PlanError(
                f"in {duration_s:g} s the contact with {span.thing!r} would last "
                f"{held_s * pace:.2f} s, too short to be observed; at least {least:.1f} s would do"
            )
    return replace(source, pace=source.pace * pace)


def _spans(source: Source) -> list[Hold | Meeting]:
    return [*source.holds, *source.meetings]


def _steps(source: Source) -> list[tuple[str, ...]]:
    """What holds and meetings there are, in order, whatever the things are called."""
    order = _moved(source)
    holds = [(h.first, "hold", h.side, str(_number(order, h.thing))) for h in source.holds]
    meetings = [(m.first, "meet", m.part, str(_number(order, m.thing))) for m in source.meetings]
    return [tuple(event[1:]) for event in sorted([*holds, *meetings])]


def _moved(source: Source) -> list[str]:
    """Names of held things in the order in which they are taken."""
    return list(dict.fromkeys(hold.thing for hold in source.holds))


def _number(order: list[str], thing: str) -> int:
    return order.index(thing) if thing in order else -1


def _events(source: Source) -> Float[np.ndarray, "events"]:
    """Frames at which holds and meetings begin and end, the capture's ends included."""
    spans = _spans(source)
    edges = {0, len(source.times) - 1} | {e for s in spans for e in (s.first, s.last)}
    return np.array(sorted(edges), dtype=float)


def _told(steps: list[tuple[str, ...]]) -> str:
    return ", ".join(f"{verb}s {who}" for verb, who, _ in steps) or "nothing"


def _at(path: RigidTransform, frames: Float[np.ndarray, "frames"]) -> RigidTransform:
    """A path between its frames."""
    known = np.arange(len(path), dtype=float)
    spots = np.stack([np.interp(frames, known, c) for c in path.translation.T], axis=1)
    turns: Rotation = Slerp(known, path.rotation)(frames)
    return RigidTransform.from_components(spots, turns)
