"""A virtual performer: a body that does what a script says, with the exact truth of it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.acting import LEAD_S, Actor, Frame
from capar.body.human import Human
from capar.body.scripts import SIDES, Script
from capar.body.things import Scene, SceneError
from capar.model.capture import TagType

RATE_HZ = 103.3
"""Of the thesis's tracker (thesis 3.1) [Hz]."""

REACH_TOLERANCE_M = 0.003
"""A palm further than this from where it is to be cannot reach it [m]."""

TOUCH_M = 0.003
"""Where a palm is nearer than this to its grip, it touches the thing [m]."""


class PerformanceError(SceneError):
    """Something that this body cannot do in this scene."""


@dataclass(frozen=True, eq=False)
class Performance:
    """What was done, to the last joint."""

    human: Human
    scene: Scene
    script: Script
    times: Float[np.ndarray, "frames"]
    """[s]."""

    motion: Float[np.ndarray, "frames posture"]
    things: Mapping[str, RigidTransform]
    """``T_world_thing`` of every thing at every frame."""

    phases: tuple[tuple[str, float, float], ...]
    """Name, start and end of each [s]."""

    gazes: Float[np.ndarray, "frames 3"]
    """Point looked at [m]."""

    looks: tuple[str, ...]
    """What is looked at in each phase."""

    slip_m: Mapping[str, Float[np.ndarray, "frames"]]
    """By side, distance of a palm from where it is to be [m]."""


def perform(
    human: Human,
    scene: Scene,
    script: Script,
    *,
    place: tuple[float, float] = (0.0, 0.0),
    heading: float = 0.0,
    rate_hz: float = RATE_HZ,
) -> Performance:
    """Let a body do a script in a scene.

    Args:
        human: Of any size.
        scene: Any that its hands can reach.
        script: What it does.
        place: Where it stands [m].
        heading: Which way it faces [rad].
        rate_hz: Frames a second.

    Raises:
        PerformanceError: A hand cannot come where it is to be; the message says by how much.
        UnknownNameError: The script names a thing that is not there.
    """
    actor = Actor(human, scene, place, heading)
    actor.choose_grips(script)
    frames, phases, start = [], [], 0.0
    for number, phase in enumerate(script):
        actor.begin(phase)
        count = max(round(phase.seconds * rate_hz), 2)
        following = script[number + 1] if number + 1 < len(script) else phase
        for frame in range(count):
            share = (frame + 1) / count
            left = (1.0 - share) * phase.seconds
            ahead = following if left < LEAD_S and following.look else phase
            frames.append(actor.frame(phase, share, ahead, 1.0 / rate_hz))
        phases.append((phase.name, start, start + count / rate_hz))
        start += count / rate_hz
    made = gathered(human, scene, script, frames, phases, rate_hz)
    check_holds(made)
    return made


def gathered(
    human: Human,
    scene: Scene,
    script: Script,
    frames: list[Frame],
    phases: list[tuple[str, float, float]],
    rate_hz: float,
) -> Performance:
    """The performance that consists of these frames.

    Args:
        human: Who performs.
        scene: Where.
        script: What is done.
        frames: One after the other.
        phases: Name, start and end of each [s].
        rate_hz: Frames a second.
    """
    things = {
        name: RigidTransform.concatenate([each.things[name] for each in frames])
        for name in scene.things
    }
    return Performance(
        human=human,
        scene=scene,
        script=script,
        times=np.arange(len(frames)) / rate_hz,
        motion=np.array([each.posture for each in frames]),
        things=things,
        phases=tuple(phases),
        gazes=np.array([each.gaze for each in frames]),
        looks=tuple(phase.look for phase in script),
        slip_m={side: np.array([each.slip[side] for each in frames]) for side in SIDES},
    )


def check_holds(made: Performance) -> None:
    """Hands are where the script has them whenever they hold something.

    Raises:
        PerformanceError: A hand misses what it is to hold; the message says by how much.
    """
    for phase, (name, start, end) in zip(made.script, made.phases, strict=True):
        now = (made.times >= start) & (made.times < end)
        for side, hand in phase.hands.items():
            worst = float(made.slip_m[side][now].max())
            if hand.does == "holds" and worst > REACH_TOLERANCE_M:
                raise PerformanceError(
                    f"the {side} hand misses {hand.thing!r} by {worst * 1000:.0f} mm in {name!r}; "
                    "put the thing or the performer nearer, or use another grip"
                )


def moved(made: Performance, name: str) -> bool:
    """Whether a thing is one that may move and did."""
    path = made.things[name].translation
    mobile = made.scene.thing(name).tag is TagType.MOBILE
    return mobile and float(np.ptp(path, axis=0).max()) > 0.0
