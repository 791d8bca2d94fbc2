"""Which things the recorded performer set going, and what of that can be performed again."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model.forces import ForceStyle
from capar.regeneration.errors import PlanError
from capar.regeneration.holding import Hold

NEAR_S = 0.25
"""A hold may end so long before a thing is seen to move on alone [s]."""


@dataclass(frozen=True)
class Launch:
    """A thing that a hand sets going, after which it moves on alone."""

    side: str
    thing: str
    frame: int
    """Of the blow, or the last of the hold."""

    force: ForceStyle


def launches_of(
    forces: tuple[ForceStyle, ...],
    sides: Mapping[str, str],
    holds: tuple[Hold, ...],
    times: Float[np.ndarray, "frames"],
) -> tuple[Launch, ...]:
    """The launches of a recording, in order of time.

    Args:
        forces: As they were observed.
        sides: Of the hands, by sensor.
        holds: As they were recorded.
        times: The clock [s].

    Raises:
        PlanError: Something else than a hand sets a thing going, or the thing is taken again.
    """
    out = []
    for force in forces:
        if force.ee not in sides:
            raise PlanError(
                f"{force.ee!r} sets {force.object!r} going at {force.start_s:.2f} s; only hands "
                "do so when an action is performed again, since feet keep their place"
            )
        side = sides[force.ee]
        own = [hold for hold in holds if hold.side == side and hold.thing == force.object]
        frame = int(np.argmin(np.abs(times - force.start_s)))
        if not force.struck:
            ends = [h.last for h in own if abs(times[h.last] - force.start_s) < NEAR_S]
            if not ends:
                continue
            frame = min(ends, key=lambda last: abs(float(times[last]) - force.start_s))
        later = [h for h in holds if h.thing == force.object and h.first > frame]
        if later:
            raise PlanError(
                f"{force.object!r} is taken again at {times[later[0].first]:.2f} s after it moved "
                "on alone, where another body's may not come; end the recording before, with "
                "to_s in a file given with --assume"
            )
        out.append(Launch(side, force.object, frame, force))
    return tuple(out)


def with_blows(holds: tuple[Hold, ...], launches: tuple[Launch, ...]) -> tuple[Hold, ...]:
    """The holds, and a momentary one for each blow: hand and thing meet in that frame alone."""
    blows = [
        Hold(launch.side, launch.thing, launch.frame, launch.frame)
        for launch in launches
        if launch.force.struck
    ]
    kept = [
        hold
        for hold in holds
        if not any(
            blow.side == hold.side
            and blow.thing == hold.thing
            and hold.first - 1 <= blow.first <= hold.last + 1
            for blow in blows
        )
    ]
    return tuple(sorted([*kept, *blows], key=lambda hold: (hold.first, hold.side)))
