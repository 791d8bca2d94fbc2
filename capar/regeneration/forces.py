"""Forces: objects that a hand strikes, pushes or throws, and how they move on."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.model.capture import TagType
from capar.model.errors import UnknownNameError
from capar.model.facts import Displaced
from capar.regeneration.holds import Release, Throw
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.sources import Source
from extractors.forces.forces import VELOCITY_S, velocity_at
from extractors.forces.free_motion import GRAVITY_MPS2, FreeMotion, Resistance, Surface, free_motion


class ForceKind(StrEnum):
    """What is the same on another body."""

    SIMILAR = "similar"
    """The force, in proportion to the arm and its speed, and what follows from it."""

    SAME = "same"
    """The object's motion; the hand strikes as fast as that takes."""


def force_kind(name: str) -> ForceKind:
    """The kind of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in set(ForceKind):
        raise UnknownNameError("force", name, list(ForceKind))
    return ForceKind(name)


ARM = ("upper_arm", "forearm", "hand", "fingers", "fingertips", "thumb")
"""The link whose mass strikes, taken to be at the hand (thesis 3.4.3.3)."""

SHARE = 0.98
"""The largest share of a blow's momentum that a striker keeps for its own mass [1]."""

SLOWEST, FASTEST = 0.2, 2.5
"""How many times as fast a hand may be led into a blow as its own path has it [1]."""

DAMPING, BOUNCE = (2.0, 2.0), 0.4
"""Of an object that was not seen to slide, or to bounce [1/s], [1]."""


@dataclass(frozen=True, eq=False)
class Flight:
    """An object's motion on its own, from a frame on."""

    launch: Release
    velocity: Float[np.ndarray, "3"]
    """With which it begins [m/s]."""

    hand_mps: float
    """The hand's speed just before, along the line of impact or the object's path [m/s]."""

    motion: FreeMotion


def first_guess(
    source: Source, scene: Scene, things: Mapping[str, RigidTransform]
) -> dict[str, RigidTransform]:
    """The paths of objects if each were set going as in the recording."""
    out = dict(things)
    for launch in source.releases:
        velocity = _turned(scene.heading - source.scene.heading, launch.force.velocity_mps)
        motion = _motion(source, scene, launch, out[launch.thing], velocity)
        out[launch.thing] = _with(source, scene, launch, out[launch.thing], motion)
    return out


def flights(
    source: Source,
    scene: Scene,
    humans: tuple[Human, Human],
    things: Mapping[str, RigidTransform],
    hands: Mapping[str, RigidTransform],
    kind: ForceKind,
) -> tuple[dict[str, RigidTransform], dict[str, RigidTransform], list[Flight]]:
    """Paths of objects and of hands, with the motion that each launch gives.

    By eq. 3.5 and the conservation of momentum an object at rest gets (1 + e) q / (1 + q) of the
    striker's speed, q being the striker's mass over the object's. The recorded speeds give q, which
    the masses of both arms and the object's size carry over. An object that is let go has the speed
    of the hand, in the recorded proportion.

    Raises:
        PlanError: The hand would have to strike faster than it can.
    """
    ways, paths, out = dict(things), dict(hands), []
    for launch in source.releases:
        force, turn = launch.force, scene.heading - source.scene.heading
        recorded = np.array(force.velocity_mps)
        speed = float(np.linalg.norm(recorded))
        line = recorded / speed
        came = _velocity(source, source.hands[launch.side].path, launch.frame)
        old = float(came @ line)
        share = _share(source, scene, humans, launch, old, speed)
        before = _velocity(source, paths[launch.side], launch.frame)
        about = _angle(came, before, turn)
        new_line = _turned(about, line) if kind is ForceKind.SIMILAR else _turned(turn, line)
        new = float(before @ new_line)
        if kind is ForceKind.SIMILAR:
            velocity = max(new, 0.0) * share * new_line
        else:
            velocity = speed * new_line
            if force.struck:
                needed = speed / share
                paths[launch.side] = _faster(source, launch, paths[launch.side], needed, new)
                new = needed
        motion = _motion(source, scene, launch, ways[launch.thing], velocity)
        ways[launch.thing] = _with(source, scene, launch, ways[launch.thing], motion)
        out.append(Flight(launch, velocity, new, motion))
    return ways, paths, out


def flight_notes(source: Source, found: list[Flight]) -> list[str]:
    """The speed of each object that was set going, and the phases of its motion."""
    return [
        f"{flight.launch.thing!r} is set going at {source.times[flight.launch.frame]:.2f} s with "
        f"{np.linalg.norm(flight.velocity):.2f} m/s by the {flight.launch.side} hand at "
        f"{flight.hand_mps:.2f} m/s: {', '.join(phase.value for _, phase in flight.motion.phases)}"
        for flight in found
    ]


def arm_mass(human: Human, side: str) -> float:
    """Mass of the link that a hand ends [kg]."""
    return sum(float(human.model.body(f"{side}_{part}").mass[0]) for part in ARM)


def surfaces_of(scene: Scene) -> list[Surface]:
    """What bears objects in a scene: level tops of fixed objects, and the floor."""
    out = []
    for thing in scene.things.values():
        if thing.tag is TagType.FIXED:
            corners = thing.pose.apply(np.array(thing.shape.vertices))
            (x0, y0, _), (x1, y1, top) = corners.min(axis=0), corners.max(axis=0)
            out.append(Surface(float(top), (float(x0), float(y0)), (float(x1), float(y1))))
    return [*out, Surface(scene.floor_m)]


def _share(
    source: Source,
    scene: Scene,
    humans: tuple[Human, Human],
    launch: Release,
    old: float,
    speed: float,
) -> float:
    """The object's speed over the hand's [1]."""
    force = launch.force
    if old <= 0.0:
        return 1.0
    if not force.struck or force.restitution is None:
        return speed / old
    kept = min(speed / ((1.0 + force.restitution) * old), SHARE)
    ratio = kept / (1.0 - kept)
    masses = [arm_mass(human, launch.side) for human in humans]
    sizes = [float(np.prod(s.thing(launch.thing).size)) for s in (source.scene, scene)]
    ratio *= (masses[1] / masses[0]) / (sizes[1] / sizes[0])
    return (1.0 + force.restitution) * ratio / (1.0 + ratio)


def _velocity(source: Source, hand: RigidTransform, frame: int) -> Float[np.ndarray, "3"]:
    """Of a hand just before a frame [m/s]."""
    count = max(round(VELOCITY_S * source.rate_hz), 4)
    part = slice(max(frame - count, 0), frame + 1)
    return velocity_at(source.times[part], hand.translation[part], float(source.times[frame]))


def _angle(old: Float[np.ndarray, "3"], new: Float[np.ndarray, "3"], usual: float) -> float:
    """How far a velocity has turned about z [rad]."""
    if min(np.hypot(*old[:2]), np.hypot(*new[:2])) < 0.1:
        return usual
    return float(np.arctan2(new[1], new[0]) - np.arctan2(old[1], old[0]))


def _turned(angle: float, vector: tuple[float, float, float] | np.ndarray) -> np.ndarray:
    return np.asarray(Rotation.from_euler("z", angle).apply(np.array(vector)))


def _motion(
    source: Source,
    scene: Scene,
    launch: Release,
    path: RigidTransform,
    velocity: Float[np.ndarray, "3"],
) -> FreeMotion:
    """The object's middle from the launch to the end."""
    thing, pose = scene.thing(launch.thing), path[launch.frame]
    force = launch.force
    corners = pose.rotation.apply(np.array(thing.shape.vertices))
    return free_motion(
        pose.apply(thing.shape.bounds.mean(axis=0)),
        velocity,
        source.times[launch.frame :] - source.times[launch.frame],
        half=0.5 * np.ptp(corners, axis=0),
        surfaces=surfaces_of(scene),
        resistance=Resistance(
            force.damping_per_s or DAMPING, BOUNCE if force.bounce is None else force.bounce
        ),
    )


def _with(
    source: Source, scene: Scene, launch: Release, path: RigidTransform, motion: FreeMotion
) -> RigidTransform:
    """An object's path that goes on alone from the launch."""
    turn = path.rotation[launch.frame]
    middle = turn.apply(scene.thing(launch.thing).shape.bounds.mean(axis=0))
    spots = path.translation.copy()
    spots[launch.frame :] = motion.positions - middle
    turns = path.rotation.as_quat()
    turns[launch.frame :] = turn.as_quat()
    return RigidTransform.from_components(spots, Rotation.from_quat(turns))


def _faster(
    source: Source, launch: Release, hand: RigidTransform, needed: float, own: float
) -> RigidTransform:
    """A hand's path that comes to the blow with the needed speed, on the same places."""
    factor = needed / own if own > 0.0 else np.inf
    if not SLOWEST <= factor <= FASTEST:
        raise PlanError(
            f"for {launch.thing!r} to move as it did the {launch.side} hand would have to strike "
            f"with {needed:.2f} m/s instead of {max(own, 0.0):.2f}; a heavier body, a smaller "
            f"{launch.thing!r}, or --force similar would do"
        )
    before = [h.last for h in source.holds if h.side == launch.side and h.last < launch.frame]
    first, last = max(before, default=0), launch.frame
    u = np.linspace(0.0, 1.0, last - first + 1)
    # A cubic that keeps both ends, leaves as before and arrives so many times as fast.
    share = u + (factor - 1.0) * (u**3 - u**2)
    share = np.maximum.accumulate(np.clip(share, 0.0, 1.0))
    spots, turns = hand.translation.copy(), hand.rotation
    part = spots[first : last + 1]
    spots[first : last + 1] = np.stack([np.interp(share, u, c) for c in part.T], axis=1)
    rows = turns.as_quat(canonical=False)
    return RigidTransform.from_components(spots, Rotation.from_quat(rows))


FALLS = np.array([0.0, 0.0, -GRAVITY_MPS2])
"""Acceleration in flight [m/s^2]."""

SWING_S = 0.4
"""Over so long at most a hand's own path is changed to throw, and to catch, as the flight asks."""


@dataclass(frozen=True)
class FlightFaults:
    """What of a flight no thrown object would do."""

    off_m: tuple[float, int]
    """Distance from the parabola of gravity, at worst [m], and the frame."""

    gain: tuple[float, int]
    """Growth of the energy of motion and of height [J/kg], and the frame."""


def caught_pose(
    source: Source, scene: Scene, toss: Throw, released: RigidTransform, ratio: float
) -> RigidTransform:
    """Where an object is caught that was let go somewhere.

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


def with_throws(source: Source, scene: Scene, name: str, path: RigidTransform) -> RigidTransform:
    """The path of an object with its flights, and hands' swings that have the flights' velocities.

    A swing is changed by (u^3 - u^2) T dv before the release, and by u (1 - u)^2 T dv after
    it is caught, so that it keeps its ends and its other velocity.
    """
    own = [toss for toss in source.throws if toss.thing == name]
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
        # The path after, from its end and with its times reversed, has the opposite velocity.
        spots[swing] += np.outer(_arriving(times[swing]), before)
        spots[stop] += np.outer(-_arriving(-times[stop][::-1])[::-1], after)
        past = times[part] - times[toss.first]
        spots[part] = spots[toss.first] + np.outer(past, start) + np.outer(0.5 * past**2, FALLS)
    rotation = Rotation.from_quat(turns)
    return RigidTransform.from_components(spots - rotation.apply(local), rotation)


def flight_faults(
    times: Float[np.ndarray, "frames"], spots: Float[np.ndarray, "frames 3"]
) -> FlightFaults:
    """What of a flight from hand to hand no thrown object would do.

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
    times: Float[np.ndarray, "frames"], start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"]
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


def _swings(source: Source, toss: Throw) -> tuple[int, int]:
    """The frames from which the throwing hand swings, and to which the catching one gives path."""
    frames = round(SWING_S * source.rate_hz)
    first, last = toss.first - frames, toss.last + frames
    for fact in source.observation.facts:
        if isinstance(fact, Displaced) and fact.object == toss.thing:
            if fact.first < toss.first <= fact.last:
                first = max(first, fact.first)
            if fact.first <= toss.last < fact.last:
                last = min(last, fact.last)
    for hold in source.carried:
        if isinstance(hold, Throw) or hold.thing != toss.thing:
            continue
        if hold.last == toss.first:
            first = max(first, hold.first)
        if hold.first == toss.last:
            last = min(last, hold.last)
    return min(first, toss.first - 2), max(last, toss.last + 2)


def _middle(scene: Scene, name: str) -> Float[np.ndarray, "3"]:
    """Of an object, in its frame [m]: it is taken to be the centre of mass."""
    return np.asarray(scene.thing(name).shape.bounds.mean(axis=0))


def _turn(source: Source, scene: Scene) -> Rotation:
    """How far the new scene faces another way."""
    return Rotation.from_euler("z", scene.heading - source.scene.heading)


def _spun(source: Source, scene: Scene, toss: Throw, released: Rotation) -> Rotation:
    """How an object is turned from when it is let go to when it is caught: it spins as it did."""
    turn, recorded = _turn(source, scene), source.paths[toss.thing].rotation
    part = recorded[toss.first : toss.last + 1]
    return turn * part * part[0].inv() * turn.inv() * released
