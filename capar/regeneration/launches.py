"""Which things the recorded performer set going, and what of that can be performed again."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.model.observation import ForceStyle
from capar.regeneration.errors import PlanError
from capar.regeneration.holding import Hold
from extractors.forces.free_motion import GRAVITY_MPS2

NEAR_S = 0.25
"""A hold may end so long before a thing is seen to move on alone [s]."""

FLIES_M = 0.025
"""What is nowhere farther than this from the parabola of gravity between two holds flew [m]."""


@dataclass(frozen=True)
class Launch:
    """A thing that a hand sets going, after which it moves on alone."""

    side: str
    thing: str
    frame: int
    """Of the blow, or the last of the hold."""

    force: ForceStyle


@dataclass(frozen=True)
class Toss:
    """A thing that a hand lets go, and that is taken again after nothing but gravity moved it."""

    side: str
    """Of the hand that lets it go."""

    thing: str
    first: int
    """Last frame of the hold before."""

    last: int
    """First frame of the hold after."""

    catcher: str
    """Side of the hand that takes it."""


def launches_of(
    forces: tuple[ForceStyle, ...],
    sides: Mapping[str, str],
    holds: tuple[Hold, ...],
    times: Float[np.ndarray, "frames"],
    paths: Mapping[str, RigidTransform],
) -> tuple[tuple[Launch, ...], tuple[Toss, ...]]:
    """The launches of a recording after which a thing is left alone, and the flights to a hand.

    Args:
        forces: As they were observed.
        sides: Of the hands, by sensor.
        holds: As they were recorded.
        times: The clock [s].
        paths: ``T_world_thing`` by name at every frame.

    Returns:
        Both in order of time.

    Raises:
        PlanError: Something else than a hand sets a thing going; or the thing is taken again
            after it was struck, slid or met something.
    """
    out, tosses = [], []
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
            toss = Toss(side, force.object, frame, later[0].first, later[0].side)
            if force.struck or not _flies(toss, times, paths[force.object]):
                raise PlanError(
                    f"{force.object!r} is taken again at {times[later[0].first]:.2f} s after it "
                    "moved on alone otherwise than in free flight from a hand that let it go, "
                    "where another body's may not come; end the recording before, with to_s in a "
                    "file given with --assume"
                )
            tosses.append(toss)
            continue
        out.append(Launch(side, force.object, frame, force))
    return tuple(out), tuple(tosses)


def _flies(toss: Toss, times: Float[np.ndarray, "frames"], path: RigidTransform) -> bool:
    """Whether a thing is near the parabola of gravity from where it is let go to where it is taken.

    Any such thing is for a moment: with two frames between, it is not known.
    """
    spots = path.translation[toss.first : toss.last + 1]
    past = times[toss.first : toss.last + 1] - times[toss.first]
    straight = spots[0] + np.outer(past / past[-1], spots[-1] - spots[0])
    straight[:, 2] += 0.5 * GRAVITY_MPS2 * past * (past[-1] - past)
    return len(past) > 2 and bool(np.linalg.norm(spots - straight, axis=1).max() < FLIES_M)


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
