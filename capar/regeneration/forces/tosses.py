"""How a thing flies from one hand to the next on another body: by gravity alone."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.facts import Displaced
from capar.regeneration.launches import Toss
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source
from extractors.forces.free_motion import GRAVITY_MPS2

FALLS = np.array([0.0, 0.0, -GRAVITY_MPS2])
"""Acceleration in flight [m/s^2]."""

SWING_S = 0.4
"""Over so long at most a hand's own way is changed to throw, and to catch, as the flight asks."""


@dataclass(frozen=True)
class FlightFaults:
    """What of a flight no thrown thing would do."""

    off_m: tuple[float, int]
    """Distance from the parabola of gravity, at worst [m], and the frame."""

    gain: tuple[float, int]
    """Growth of the energy of motion and of height [J/kg], and the frame."""


def caught_pose(
    source: Source, scene: Scene, toss: Toss, released: RigidTransform, ratio: float
) -> RigidTransform:
    """Where a thing is caught that was let go somewhere.

    As far away level as it was times a ratio, and as much higher in metres as it was, so that the
    recorded time of flight gives the velocity.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        toss: What flies.
        released: ``T_world_thing`` where it is let go.
        ratio: How many times as far it flies level [1].
    """
    recorded, turn = source.paths[toss.thing], _turn(source, scene)
    spots = recorded[toss.first : toss.last + 1].apply(_middle(source.scene, toss.thing))
    by = turn.apply(spots[-1] - spots[0]) * [ratio, ratio, 1.0]
    spun = _spun(source, scene, toss, released.rotation)[-1]
    middle = _middle(scene, toss.thing)
    spot = released.apply(middle) + by - spun.apply(middle)
    return RigidTransform.from_components(spot, spun)


def with_tosses(source: Source, scene: Scene, name: str, path: RigidTransform) -> RigidTransform:
    """The way of a thing with its flights, and hands' swings that have the flights' velocities.

    A swing is changed by (u^3 - u^2) T dv before the thing is let go, and by u (1 - u)^2 T dv after
    it is caught, so that it keeps its ends and its other velocity.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        name: Of the thing.
        path: ``T_world_thing`` at every frame, as it should be at both ends of each flight.
    """
    own = [toss for toss in source.tosses if toss.thing == name]
    if not own:
        return path
    local, times = _middle(scene, name), source.times
    spots, turns = path.apply(local), path.rotation.as_quat()
    for toss in own:
        part = slice(toss.first, toss.last + 1)
        spun = _spun(source, scene, toss, path.rotation[toss.first])
        turns[part] = spun.as_quat()
        start, end = _velocities(times[part], spots[toss.first], spots[toss.last])
        first, last = _swings(source, toss)
        swing, stop = slice(first, toss.first + 1), slice(toss.last, last + 1)
        before = start - end_velocity(times[swing], spots[swing])
        after = end + end_velocity(-times[stop][::-1], spots[stop][::-1])
        # The way after, from its end and with its times reversed, has the opposite velocity.
        spots[swing] += np.outer(_arriving(times[swing]), before)
        spots[stop] += np.outer(-_arriving(-times[stop][::-1])[::-1], after)
        past = times[part] - times[toss.first]
        spots[part] = spots[toss.first] + np.outer(past, start) + np.outer(0.5 * past**2, FALLS)
    rotation = Rotation.from_quat(turns)
    return RigidTransform.from_components(spots - rotation.apply(local), rotation)


def toss_notes(source: Source, scene: Scene, path: RigidTransform, name: str) -> list[str]:
    """What is told of the flights of a thing.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        path: ``T_world_thing`` at every frame.
        name: Of the thing.
    """
    out = []
    for toss in source.tosses:
        if toss.thing == name:
            start, old = (
                _velocities(source.times[part], *ends)[0]
                for part, ends in (
                    (slice(toss.first, toss.last + 1), _ends(way, at, toss))
                    for way, at in ((path, scene), (source.paths[name], source.scene))
                )
            )
            new_mps, old_mps = np.linalg.norm(start), np.linalg.norm(old)
            out.append(
                f"the {toss.side} hand throws {name!r} at {source.times[toss.first]:.2f} s with "
                f"{new_mps:.2f} m/s (recorded {old_mps:.2f}); it flies by gravity and is caught "
                f"by the {toss.catcher} hand at {source.times[toss.last]:.2f} s"
            )
    return out


def flight_faults(
    times: Float[np.ndarray, "frames"], spots: Float[np.ndarray, "frames 3"]
) -> FlightFaults:
    """What of a flight from hand to hand no thrown thing would do.

    Args:
        times: From when it is let go to when it is caught [s].
        spots: Of its middle [m].
    """
    past = times - times[0]
    start, _ = _velocities(times, spots[0], spots[-1])
    parabola = spots[0] + np.outer(past, start) + np.outer(0.5 * past**2, FALLS)
    off = np.linalg.norm(spots - parabola, axis=1)
    worst = int(off.argmax())
    # Differences over two frames are exact for a parabola.
    speeds = np.linalg.norm((spots[2:] - spots[:-2]) / (times[2:] - times[:-2])[:, None], axis=1)
    energy = 0.5 * speeds**2 + GRAVITY_MPS2 * spots[1:-1, 2]
    gain = energy - np.minimum.accumulate(energy) if len(energy) else np.zeros(1)
    most = int(gain.argmax())
    return FlightFaults((float(off[worst]), worst), (float(gain[most]), most + 1))


def end_velocity(
    times: Float[np.ndarray, "frames"], spots: Float[np.ndarray, "frames 3"]
) -> Float[np.ndarray, "3"]:
    """Velocity in the last frame, of the parabola through the last three [m/s].

    Args:
        times: Of the frames [s].
        spots: Of a point [m].
    """
    if len(spots) < 3:
        return np.asarray((spots[-1] - spots[-2]) / (times[-1] - times[-2]))
    late = (spots[-1] - spots[-2]) / (times[-1] - times[-2])
    early = (spots[-2] - spots[-3]) / (times[-2] - times[-3])
    lead = (times[-1] - times[-2]) / (times[-1] - times[-3])
    return np.asarray(late + lead * (late - early))


def _velocities(
    times: Float[np.ndarray, "frames"],
    start: Float[np.ndarray, "3"],
    end: Float[np.ndarray, "3"],
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Velocities at both ends of a flight from one place to another [m/s]."""
    lasts = float(times[-1] - times[0])
    middle = (end - start) / lasts
    return middle - 0.5 * FALLS * lasts, middle + 0.5 * FALLS * lasts


def _arriving(times: Float[np.ndarray, "frames"]) -> Float[np.ndarray, "frames"]:
    """What a velocity of 1 in the last frame adds at each frame [s], with both ends kept."""
    lasts = float(times[-1] - times[0])
    u = (times - times[0]) / lasts
    return np.asarray((u**3 - u**2) * lasts)


def _swings(source: Source, toss: Toss) -> tuple[int, int]:
    """The frames from which the throwing hand swings, and to which the catching one gives way."""
    frames = round(SWING_S * source.rate_hz)
    first, last = toss.first - frames, toss.last + frames
    for fact in source.observation.facts:
        if isinstance(fact, Displaced) and fact.object == toss.thing:
            if fact.first < toss.first <= fact.last:
                first = max(first, fact.first)
            if fact.first <= toss.last < fact.last:
                last = min(last, fact.last)
    for hold in source.carried:
        if isinstance(hold, Toss) or hold.thing != toss.thing:
            continue
        if hold.last == toss.first:
            first = max(first, hold.first)
        if hold.first == toss.last:
            last = min(last, hold.last)
    return min(first, toss.first - 2), max(last, toss.last + 2)


def _ends(
    path: RigidTransform, scene: Scene, toss: Toss
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Where a thing's middle is let go and caught [m]."""
    middle = _middle(scene, toss.thing)
    return np.asarray(path[toss.first].apply(middle)), np.asarray(path[toss.last].apply(middle))


def _middle(scene: Scene, name: str) -> Float[np.ndarray, "3"]:
    """Of a thing, in its frame [m]: it is taken to be the centre of mass."""
    return np.asarray(scene.thing(name).shape.bounds.mean(axis=0))


def _turn(source: Source, scene: Scene) -> Rotation:
    """How far the scene's way is turned."""
    return Rotation.from_euler("z", scene.heading - source.scene.heading)


def _spun(source: Source, scene: Scene, toss: Toss, released: Rotation) -> Rotation:
    """How a thing is turned from when it is let go to when it is caught: it spins as it did."""
    turn, recorded = _turn(source, scene), source.paths[toss.thing].rotation
    part = recorded[toss.first : toss.last + 1]
    return turn * part * part[0].inv() * turn.inv() * released
