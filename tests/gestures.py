"""Gestures of a virtual body with nothing in its hands, by its hinges."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from jaxtyping import Float
from scenes.people.virtual import Bend, Sway, both
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import RELAXED
from capar.body.scripts import SIDES, minimum_jerk

Acts = Sequence[Bend | Sway]


@cache
def human(who: str) -> Human:
    """A man, a woman or a child of middle size."""
    return Human.of(ready_made(who))


def posed(body: Human, acts: Acts, time: float) -> Float[np.ndarray, "posture"]:
    """The posture at a time [s], from standing at ease."""
    out = body.posture({f"{side}_{n}": np.radians(a) for n, a in RELAXED.items() for side in SIDES})
    for each in acts:
        share = (time - each.start) / (each.end - each.start)
        if isinstance(each, Bend):
            angle = minimum_jerk(share)
        else:
            since = time - each.start
            fade = minimum_jerk(2.0 * each.rate_hz * min(since, each.end - time))
            angle = fade * np.sin(2.0 * np.pi * each.rate_hz * since)
        out[body.index(each.joint)] += np.radians(each.angle * angle)
    return out


def motion(
    who: str, acts: Acts, rate_hz: float, *, stance: str = "left"
) -> tuple[Human, Float[np.ndarray, "frames"], Float[np.ndarray, "frames posture"]]:
    """A body, times [s] and its postures; one foot stays where it stands."""
    body = human(who)
    times = np.arange(0.0, max(each.end for each in acts) + 0.8, 1.0 / rate_hz)
    made = np.stack([posed(body, acts, time) for time in times])
    places, turns = body.sites(made, [f"{stance}_foot"])[f"{stance}_foot"]
    root = poses(made[:, :3], made[:, 3:7])
    foot = poses(places, turns)
    kept = foot[0] * foot.inv() * root
    made[:, :3] = kept.translation
    made[:, 3:7] = kept.rotation.as_quat(scalar_first=True)
    return body, times, made


def poses(
    places: Float[np.ndarray, "frames 3"], turns: Float[np.ndarray, "frames 4"]
) -> RigidTransform:
    """Poses from places [m] and quaternions (w x y z)."""
    return RigidTransform.from_components(places, Rotation.from_quat(turns, scalar_first=True))


def undone(acts: Acts, start: float, end: float) -> list[Bend]:
    """The same turns the other way round, later [s]."""
    return [Bend(each.joint, start, end, -each.angle) for each in acts if isinstance(each, Bend)]


def clap(who: str, *, times: int = 3, beat_s: float = 0.6) -> list[Bend]:
    """Both forearms come up; palms meet so many times."""
    ready = [*both("shoulder_flexion", 0.8, 1.7, 40.0), *both("elbow_flexion", 0.8, 1.7, 75.0)]
    body, inward = human(who), 0.0
    while True:  # until palms meet
        inward += 0.5
        posture = posed(body, [*ready, *both("shoulder_rotation", 0.8, 1.7, inward)], 1.7)
        if abs(body.sites(posture[None], ["left_palm"])["left_palm"][0][0, 1]) < 0.006:
            break
    beats = [2.0 + number * beat_s for number in range(times)]
    meet = [
        bend
        for at in beats
        for bend in (
            *both("shoulder_rotation", at, at + 0.4 * beat_s, inward),
            *both("shoulder_rotation", at + 0.5 * beat_s, at + beat_s, -inward),
        )
    ]
    return [*ready, *meet, *undone(ready, beats[-1] + beat_s, beats[-1] + beat_s + 1.0)]


def raised(*sides: str, hold_s: float = 0.9, up_s: float = 1.1) -> list[Bend]:
    """Arms go up over the head, and come down."""
    up = [Bend(f"{side}_shoulder_flexion", 0.8, 0.8 + up_s, 155.0) for side in sides]
    down = 0.8 + up_s + hold_s
    return [*up, *undone(up, down, down + up_s)]


def wave(*sides: str, rate_hz: float = 1.6, cycles: int = 4, angle: float = 22.0) -> Acts:
    """Arms go up beside the head, wave, and come down."""
    turns = {"shoulder_abduction": 70.0, "shoulder_rotation": -76.0, "elbow_flexion": 95.0}
    up = [Bend(f"{s}_{joint}", 0.8, 1.8, turn) for joint, turn in turns.items() for s in sides]
    swings = [Sway(f"{s}_elbow_flexion", 1.8, rate_hz, cycles, angle) for s in sides]
    return [*up, *swings, *undone(up, swings[0].end, swings[0].end + 1.0)]


def kick(side: str, *, swing_s: float = 0.35) -> list[Bend]:
    """A foot is drawn back, swings out through the air, and comes down where it stood."""
    hip, knee = f"{side}_hip_flexion", f"{side}_knee_flexion"
    back, out = 0.8 + 1.4 * swing_s, 0.8 + 2.4 * swing_s
    begin, end = out + 0.4 * swing_s, out + 2.7 * swing_s
    return [
        Bend(hip, 0.8, back, -15.0), Bend(knee, 0.8, back, 60.0),
        Bend(hip, back, out, 75.0), Bend(knee, back + 0.05, out + 0.05, -50.0),
        Bend(hip, begin, end, -60.0), Bend(knee, begin, end, -10.0),
    ]  # fmt: skip


def push() -> list[Bend]:
    """Both hands come up before the chest, go straight ahead, and come down."""
    up = [*both("shoulder_flexion", 0.8, 1.7, -20.0), *both("elbow_flexion", 0.8, 1.7, 110.0)]
    out = [*both("shoulder_flexion", 2.2, 2.7, 85.0), *both("elbow_flexion", 2.2, 2.7, -95.0)]
    return [*up, *out, *undone([*up, *out], 3.3, 4.3)]


def touch_head(side: str) -> list[Bend]:
    """A hand is laid on the side of the head, stays, and comes down; of a woman."""
    turns = {"shoulder_flexion": 141.0, "shoulder_abduction": 26.0, "shoulder_rotation": 34.5,
             "elbow_flexion": 94.5, "wrist_flexion": 44.5}  # fmt: skip
    up = [Bend(f"{side}_{joint}", 0.8, 2.0, turn) for joint, turn in turns.items()]
    return [*up, *undone(up, 3.0, 4.2)]
