"""Virtual bodies that drink from mugs of five sizes, standing on five tables."""

from dataclasses import dataclass

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import perform
from capar.body.recording import record
from capar.body.scenes import Thing, cup, scene, table
from capar.body.scripts import drink
from capar.body.sensors import PERFECT, Tracker
from capar.model.capture import Capture
from capar.model.observation import Observation

AGENTS = ("man", "woman", "child")
PROFILES = ("extended", "thesis")

TURN_RAD_PER_M = Tracker().noise_rad / Tracker().noise_m
"""Noise of orientations by that of positions, as of a MotionStar [rad/m]."""


@dataclass(frozen=True)
class Setting:
    """A table and a mug on it; places as shares of the performer's stature [1]."""

    table: float
    """Height of the table top."""

    ahead: float
    left: float
    radius_m: float
    height_m: float


SCENES = (
    Setting(0.52, 0.22, -0.10, 0.035, 0.09),
    Setting(0.56, 0.24, -0.14, 0.040, 0.10),
    Setting(0.50, 0.21, -0.08, 0.032, 0.08),
    Setting(0.54, 0.26, -0.02, 0.036, 0.12),
    Setting(0.50, 0.23, -0.18, 0.042, 0.09),
)
"""From a low table to a high one, from in front of the left shoulder to beside the right one."""


def drinking(who: str, number: int, *, noise_m: float = 0.0, rate_hz: float = 60.0) -> Capture:
    """What a tracker records of somebody who drinks in a scene, with noise of its positions.

    Args:
        who: One of ``AGENTS``.
        number: Of the scene.
        noise_m: Deviation of each coordinate [m]; the turns' one is 0.4 degrees for 1.5 mm.
        rate_hz: Frames a second.
    """
    human, setting = Human.of(ready_made(who)), SCENES[number]
    tall = human.measures["stature"]
    top = setting.table * tall
    mug = Thing(
        "mug",
        cup(setting.radius_m, setting.height_m),
        (setting.ahead * tall, setting.left * tall, top),
        round=True,
    )
    where = scene(table(top, near_m=0.12 * tall), mug)
    made = perform(human, where, drink("mug"), rate_hz=rate_hz)
    tracker = Tracker(noise_m, noise_m * TURN_RAD_PER_M) if noise_m else PERFECT
    return record(made, name=f"{who}_{number}", seed=10 + number, tracker=tracker)


def steps_of(seen: Observation) -> tuple[str, ...]:
    """What the right hand does, with what, without its rests."""
    (link,) = [each for each in seen.links if each.ee == "right_hand"]
    return tuple(
        f"{each.name}({', '.join(each.objects)})" for each in link.segments if each.name != "Rest"
    )
