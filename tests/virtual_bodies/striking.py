"""A virtual man strikes a crate, pushes a mug and tosses one: known restitution and damping."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import RigidTransform, Rotation, Slerp

from capar.body.scripted_actions import action_capture
from capar.model.capture import Capture, Sensor, Stream, TagObject
from capar.model.facts import Touching
from capar.model.geometry import transforms
from capar.pipelines.observation import observe
from extractors.forces.free_motion import Resistance, Surface, free_motion

RATE_HZ = 60.0
BLOW_S, THROUGH_S, BACK_S, END_S = 1.6, 0.25, 2.8, 3.4
"""When the hand meets the crate, for how long it goes on, and when it hangs again [s]."""

STRIKE_MPS = 1.2
"""Along the table, to the left."""

MASSES = 2.0
"""How many times the crate's mass the arm's is."""

SKIN_M = 0.002
"""How far the skin gives way [m]."""

LINE = np.array([0.0, 1.0, 0.0])


@cache
def _picked_up() -> tuple[Capture, int]:
    """A crate is picked up with both hands, and when the right one arrives."""
    capture = action_capture("pick_up", rate_hz=RATE_HZ)
    frames = [
        fact.first
        for fact in observe(capture).facts
        if isinstance(fact, Touching) and (fact.body, fact.other) == ("right_hand", "crate")
    ]
    return capture, min(frames)


def struck(
    *, restitution: float = 0.5, damping: float = 3.0, noise_m: float = 0.0, seed: int = 0
) -> Capture:
    """A crate that was at rest is struck, and slides away along the table.

    Args:
        restitution: Between hand and crate [1].
        damping: Of the crate on the table [1/s].
        noise_m: Standard deviation of every recorded place along each axis [m].
        seed: Of the noise.
    """
    picked, arrives = _picked_up()
    times = np.arange(round(END_S * RATE_HZ)) / RATE_HZ
    given = (1.0 + restitution) * MASSES / (1.0 + MASSES) * STRIKE_MPS
    hand = _swing(times, picked.sensor("right_hand"), arrives, STRIKE_MPS - given / MASSES)
    crate = _slide(times, picked, given * LINE, Resistance((damping, damping), restitution))
    return _recorded(picked, "strike", times, {"right_hand": hand, "crate": crate}, noise_m, seed)


def _swing(
    times: Float[np.ndarray, "frames"], sensor: Sensor, arrives: int, follow_mps: float
) -> RigidTransform:
    """From hanging up beside the crate, against it, on a little, and back."""
    known = transforms(sensor.stream.positions, sensor.stream.orientations)
    hangs, meets = known[0], known[arrives]
    start, end = hangs.translation, meets.translation + SKIN_M * LINE
    aside = start + [0.3, 0.0, 0.0] * (end - start)
    aside = np.array([aside[0], end[1] - 0.2, end[2] + 0.12])
    stops = end + 0.5 * THROUGH_S * follow_mps * LINE
    clock = [0.5, 1.15, BLOW_S]
    drawn = 0.9 * (end - start) / (BLOW_S - 0.5) * [1.0, 0.0, 1.0]
    ahead = CubicHermiteSpline(clock, [start, aside, end], [0 * start, drawn, STRIKE_MPS * LINE])
    after = [BLOW_S, BLOW_S + THROUGH_S]
    on = CubicHermiteSpline(after, [end, stops], [follow_mps * LINE, 0 * end])
    behind = [BLOW_S + THROUGH_S, 2.3, BACK_S]
    back = CubicHermiteSpline(behind, [stops, aside, start], [0 * start, -drawn, 0 * start])
    late = np.clip(times, 0.5, BACK_S)
    pieces = [late < BLOW_S, late < BLOW_S + THROUGH_S]
    spots = np.where(
        pieces[0][:, None],
        ahead(np.minimum(late, BLOW_S)),
        np.where(pieces[1][:, None], on(late), back(np.maximum(late, behind[0]))),
    )
    both = Rotation.concatenate([hangs.rotation, meets.rotation, meets.rotation, hangs.rotation])
    turned = Slerp([0.5, 1.15, behind[0], BACK_S], both)(late)
    return RigidTransform.from_components(spots, turned)


def _slide(
    times: Float[np.ndarray, "frames"],
    picked: Capture,
    velocity: Float[np.ndarray, "3"],
    resistance: Resistance,
) -> RigidTransform:
    crate, table = picked.tag_object("crate"), picked.tag_object("table")
    assert crate.shape is not None
    assert table.shape is not None
    pose = crate.stream.pose(0)
    corners = table.stream.pose(0).apply(np.array(table.shape.vertices))
    (x0, y0, _), (x1, y1, top) = corners.min(axis=0), corners.max(axis=0)
    after = times >= BLOW_S
    moved = free_motion(
        pose.apply(crate.shape.bounds.mean(axis=0)),
        velocity,
        np.concatenate([[BLOW_S], times[after]]),
        half=0.5 * crate.shape.size,
        surfaces=[Surface(top, (x0, y0), (x1, y1)), Surface(0.0)],
        resistance=resistance,
    )
    spots = np.tile(pose.translation, (len(times), 1))
    spots[after] += moved.positions[1:] - moved.positions[0]
    return RigidTransform.from_components(spots, Rotation.concatenate([pose.rotation] * len(times)))


def let_go(
    action: str,
    *,
    faster: float = 2.0,
    damping: float = 3.0,
    bounce: float = 0.3,
    noise_m: float = 0.0,
    seed: int = 0,
) -> Capture:
    """An action in which the right hand takes a mug, that lets it go where it is fastest aside.

    Args:
        action: ``slide`` makes it a push, ``carry`` a toss.
        faster: How many times as fast the action is done [1].
        damping: Of the mug on the table [1/s].
        bounce: Of the mug on the table [1].
        noise_m: Standard deviation of every recorded place along each axis [m].
        seed: Of the noise.
    """
    done = action_capture(action, rate_hz=RATE_HZ / faster)
    mug, table, hand = done.tag_object("mug"), done.tag_object("table"), done.sensor("right_hand")
    assert mug.shape is not None
    assert table.shape is not None
    steps = np.linalg.norm(np.diff(mug.stream.positions[:, :2], axis=0), axis=1) * RATE_HZ
    leaves = int(np.argmax(steps)) + 1
    paces = (mug.stream.positions[leaves] - mug.stream.positions[leaves - 1]) * RATE_HZ
    slows = round(0.2 * RATE_HZ)
    frames = leaves + slows + leaves
    times = np.arange(frames + 1) / RATE_HZ
    there = transforms(hand.stream.positions[: leaves + 1], hand.stream.orientations[: leaves + 1])
    late = np.arange(1, slows + 1) / RATE_HZ
    on = np.outer(late - late**2 * RATE_HZ / (2.0 * slows), paces) + there.translation[-1]
    lift = np.outer(np.minimum(np.arange(1, leaves + 1) / RATE_HZ, 0.3), [0.0, 0.0, 0.3])
    ways = (
        there.translation[-2::-1]
        + (on[-1] - there.translation[-1]) * np.linspace(1.0, 0.0, leaves)[:, None]
    )
    fade = np.linspace(1.0, 0.0, leaves)[:, None]
    spots = np.concatenate([there.translation, on, ways + lift * fade])
    held = Rotation.concatenate([there.rotation[-1]] * slows)
    turns = Rotation.concatenate([there.rotation, held, there.rotation[-2::-1]])
    pose = mug.stream.pose(leaves)
    corners = table.stream.pose(0).apply(np.array(table.shape.vertices))
    (x0, y0, _), (x1, y1, top) = corners.min(axis=0), corners.max(axis=0)
    alone = free_motion(
        pose.apply(mug.shape.bounds.mean(axis=0)),
        paces,
        times[leaves:],
        half=0.5 * mug.shape.size,
        surfaces=[Surface(top, (x0, y0), (x1, y1)), Surface(0.0)],
        resistance=Resistance((damping, damping), bounce),
    )
    rests = alone.positions - alone.positions[0] + mug.stream.positions[leaves]
    path = np.concatenate([mug.stream.positions[:leaves], rests])
    own = {
        "right_hand": RigidTransform.from_components(spots, turns),
        "mug": RigidTransform.from_components(
            path,
            Rotation.concatenate(
                [
                    Rotation.from_quat(mug.stream.orientations[:leaves], scalar_first=True),
                    *([pose.rotation] * (frames + 1 - leaves)),
                ]
            ),
        ),
    }
    return _recorded(done, f"let_go_{action}", times, own, noise_m, seed)


def _recorded(
    capture: Capture,
    name: str,
    times: Float[np.ndarray, "frames"],
    ways: Mapping[str, RigidTransform],
    noise_m: float,
    seed: int,
) -> Capture:
    """A capture of these ways; what has none stays where it was at first."""
    rng = np.random.default_rng(seed)

    def stream(body: Sensor | TagObject) -> Stream:
        path = ways.get(body.name)
        if path is None:
            path = RigidTransform.concatenate([body.stream.pose(0)] * len(times))
        loud = 0.0 if body.name in {"table", "head"} else noise_m
        spots = path.translation + rng.normal(scale=loud, size=(len(times), 3))
        return Stream(times, spots, path.rotation.as_quat(scalar_first=True))

    return replace(
        capture,
        name=name,
        sensors=tuple(replace(sensor, stream=stream(sensor)) for sensor in capture.sensors),
        objects=tuple(replace(thing, stream=stream(thing)) for thing in capture.objects),
    )
