"""When a held thing leans over another one, as in pouring."""

from collections.abc import Mapping
from dataclasses import dataclass

from capar.body.scenes import Thing
from capar.model.capture import TagType
from capar.model.facts import Leans, Lies
from capar.model.observation import Observation
from capar.regeneration.holding import Hold


@dataclass(frozen=True)
class Poise:
    """A held thing that leans over above or in another one that can be moved."""

    thing: str
    other: str
    lowest: int
    """The frame in the middle of its leaning over."""

    frames: tuple[int, ...]
    """Borders of the hand's steps meanwhile."""


def poises_of(
    observation: Observation,
    sensors: Mapping[str, str],
    things: Mapping[str, Thing],
    holds: tuple[Hold, ...],
) -> tuple[Poise, ...]:
    """When held things lean over others that can be moved, in order of time.

    Args:
        observation: What was observed.
        sensors: The sensor of the hand on each side.
        things: The things by name.
        holds: When hands hold them.
    """
    leans = [fact for fact in observation.facts if isinstance(fact, Leans)]
    out = []
    for fact in observation.facts:
        if not isinstance(fact, Lies) or fact.how not in {"above", "inside"}:
            continue
        tilts = [
            lean
            for lean in leans
            if lean.object == fact.body and fact.first <= lean.first and lean.last <= fact.last
        ]
        held = [
            hold
            for hold in holds
            if hold.thing == fact.body
            and any(hold.first <= tilt.first and tilt.last <= hold.last for tilt in tilts)
        ]
        if held and fact.other in things and things[fact.other].tag is TagType.MOBILE:
            first = max(fact.first, min(hold.first for hold in held))
            last = min(fact.last, max(hold.last for hold in held))
            acting = {sensors[hold.side] for hold in held}
            ends = {part.last for part in observation.segments if part.ee in acting}
            frames = tuple(sorted(frame for frame in ends if first <= frame <= last))
            lowest = (tilts[0].first + tilts[0].last) // 2
            if frames:
                out.append(Poise(fact.body, fact.other, lowest, frames))
    return tuple(sorted(out, key=lambda poise: poise.frames))
