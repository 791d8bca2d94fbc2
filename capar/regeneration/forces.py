"""Forces: objects that a hand strikes, pushes or throws, and how they move on."""

from collections.abc import Mapping
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

SHARE = 0.98  # The largest share of a blow's momentum that a striker keeps for its own mass [1].
LEVEL_MPS = 0.1  # A slower hand has no level direction [m/s].

SLOWEST, FASTEST = 0.2, 2.5
"""How many times as fast a hand may be led into a blow as its own path has it [1]."""

DAMPING, BOUNCE = (2.0, 2.0), 0.4
"""Of an object that was not seen to slide, or to bounce [1/s], [1]."""


def first_guess(
    source: Source, scene: Scene, things: Mapping[str, RigidTransform]
) -> dict[str, RigidTransform]:
    """The paths of objects if each were set going as in the recording."""
    out = dict(things)
    for release in source.releases:
        velocity = _turn(source, scene).apply(release.force.velocity_mps)
        out[release.thing], _ = _going_on(source, scene, release, out[release.thing], velocity)
    return out


def flights(
    source: Source,
    scene: Scene,
    humans: tuple[Human, Human],
    things: Mapping[str, RigidTransform],
    hands: Mapping[str, RigidTransform],
    kind: ForceKind,
) -> tuple[dict[str, RigidTransform], dict[str, RigidTransform], list[str]]:
    """Paths of objects and of hands, with the motion that each release gives, and notes on it.

    By eq. 3.5 and the conservation of momentum an object at rest gets (1 + e) q / (1 + q) of the
    striker's speed, q being the striker's mass over the object's. The recorded speeds give q, which
    the masses of both arms and the object's size carry over. An object that is let go has the speed
    of the hand, in the recorded proportion.

    Raises:
        PlanError: The hand would have to strike faster than it can.
    """
    out, paths, notes = dict(things), dict(hands), []
    for release in source.releases:
        force, side, frame = release.force, release.side, release.frame
        recorded = np.array(force.velocity_mps)
        speed = float(np.linalg.norm(recorded))
        came = _velocity(source, source.hands[side].path, frame)
        share = _share(source, scene, humans, release, float(came @ recorded) / speed)
        before = _velocity(source, paths[side], frame)
        line = _turn(source, scene).apply(recorded / speed)
        level = min(np.hypot(*came[:2]), np.hypot(*before[:2]))
        if kind is ForceKind.SIMILAR and level >= LEVEL_MPS:
            angles = [np.arctan2(way[1], way[0]) for way in (came, before)]
            line = Rotation.from_euler("z", angles[1] - angles[0]).apply(recorded / speed)
        hand_mps = float(before @ line)
        if kind is ForceKind.SIMILAR:
            velocity = max(hand_mps, 0.0) * share * line
        else:
            velocity = speed * line
            if force.struck:
                paths[side] = _faster(source, release, paths[side], speed / share, hand_mps)
                hand_mps = speed / share
        out[release.thing], motion = _going_on(source, scene, release, out[release.thing], velocity)
        notes.append(
            f"{release.thing!r} is set going at {source.times[frame]:.2f} s with "
            f"{np.linalg.norm(velocity):.2f} m/s by the {side} hand at {hand_mps:.2f} m/s: "
            f"{', '.join(phase.value for _, phase in motion.phases)}"
        )
    return out, paths, notes


def arm_mass(human: Human, side: str) -> float:
    """Mass of the link that a hand ends [kg]."""
    return sum(float(human.model.body(f"{side}_{part}").mass[0]) for part in ARM)


def _share(
    source: Source, scene: Scene, humans: tuple[Human, Human], release: Release, hand_mps: float
) -> float:
    """The object's speed over the hand's, given the recorded hand's [1]."""
    force, speed = release.force, float(np.linalg.norm(release.force.velocity_mps))
    if hand_mps <= 0.0:
        return 1.0
    if not force.struck or force.restitution is None:
        return speed / hand_mps
    kept = min(speed / ((1.0 + force.restitution) * hand_mps), SHARE)
    masses = [arm_mass(human, release.side) for human in humans]
    sizes = [float(np.prod(s.thing(release.thing).size)) for s in (source.scene, scene)]
    ratio = kept / (1.0 - kept) * (masses[1] / masses[0]) / (sizes[1] / sizes[0])
    return (1.0 + force.restitution) * ratio / (1.0 + ratio)


def _velocity(source: Source, hand: RigidTransform, frame: int) -> Float[np.ndarray, "3"]:
    """Of a hand just before a frame [m/s]."""
    count = max(round(VELOCITY_S * source.rate_hz), 4)
    part = slice(max(frame - count, 0), frame + 1)
    return velocity_at(source.times[part], hand.translation[part], float(source.times[frame]))


def _going_on(
    source: Source,
    scene: Scene,
    release: Release,
    path: RigidTransform,
    velocity: Float[np.ndarray, "3"],
) -> tuple[RigidTransform, FreeMotion]:
    """An object's path that goes on alone from its release, and the motion of its middle."""
    frame, force, turn = release.frame, release.force, path.rotation[release.frame]
    surfaces = []
    for thing in scene.things.values():
        if thing.tag is TagType.FIXED:  # its level top bears objects
            corners = thing.pose.apply(np.array(thing.shape.vertices))
            (x0, y0, _), (x1, y1, top) = corners.min(axis=0), corners.max(axis=0)
            surfaces.append(Surface(float(top), (float(x0), float(y0)), (float(x1), float(y1))))
    surfaces.append(Surface(scene.floor_m))
    corners = turn.apply(np.array(scene.thing(release.thing).shape.vertices))
    middle = _middle(scene, release.thing)
    motion = free_motion(
        path[frame].apply(middle),
        velocity,
        source.times[frame:] - source.times[frame],
        half=0.5 * np.ptp(corners, axis=0),
        surfaces=surfaces,
        resistance=Resistance(
            force.damping_per_s or DAMPING, BOUNCE if force.bounce is None else force.bounce
        ),
    )
    spots, turns = path.translation.copy(), path.rotation.as_quat()
    spots[frame:], turns[frame:] = motion.positions - turn.apply(middle), turn.as_quat()
    return RigidTransform.from_components(spots, Rotation.from_quat(turns)), motion


def _faster(
    source: Source, release: Release, hand: RigidTransform, needed: float, own: float
) -> RigidTransform:
    """A hand's path that comes to the blow with the needed speed, on the same places."""
    factor = needed / own if own > 0.0 else np.inf
    if not SLOWEST <= factor <= FASTEST:
        raise PlanError(
            f"for {release.thing!r} to move as it did the {release.side} hand would have to strike "
            f"with {needed:.2f} m/s instead of {max(own, 0.0):.2f}; a heavier body, a smaller "
            f"{release.thing!r}, or --force similar would do"
        )
    before = [h.last for h in source.holds if h.side == release.side and h.last < release.frame]
    first, last = max(before, default=0), release.frame
    u = np.linspace(0.0, 1.0, last - first + 1)
    # A cubic that keeps both ends, leaves as before and arrives so many times as fast.
    share = u + (factor - 1.0) * (u**3 - u**2)
    share = np.maximum.accumulate(np.clip(share, 0.0, 1.0))
    spots = hand.translation.copy()
    part = spots[first : last + 1]
    spots[first : last + 1] = np.stack([np.interp(share, u, c) for c in part.T], axis=1)
    return RigidTransform.from_components(spots, hand.rotation)


FALLS = np.array([0.0, 0.0, -GRAVITY_MPS2])  # Acceleration in flight [m/s^2].

SWING_S = 0.4
"""Over so long at most a hand's own path is changed to throw, and to catch, as the flight asks."""


def caught_pose(
    source: Source, scene: Scene, throw: Throw, released: RigidTransform, ratio: float
) -> RigidTransform:
    """Where an object is caught that was let go somewhere.

    As far away level as it was times a ratio, and as much higher in metres as it was, so that the
    recorded time of flight gives the velocity.
    """
    recorded, turn = source.paths[throw.thing], _turn(source, scene)
    spots = recorded[throw.first : throw.last + 1].apply(_middle(source.scene, throw.thing))
    by = turn.apply(spots[-1] - spots[0]) * [ratio, ratio, 1.0]
    spun = _spun(source, scene, throw, released.rotation)[-1]
    middle = _middle(scene, throw.thing)
    spot = released.apply(middle) + by - spun.apply(middle)
    return RigidTransform.from_components(spot, spun)


def with_throws(source: Source, scene: Scene, name: str, path: RigidTransform) -> RigidTransform:
    """The path of an object with its flights, and hands' swings that have the flights' velocities.

    A swing is changed by (u^3 - u^2) T dv before the release, and by u (1 - u)^2 T dv after
    it is caught, so that it keeps its ends and its other velocity.
    """
    own = [throw for throw in source.throws if throw.thing == name]
    if not own:
        return path
    local, times = _middle(scene, name), source.times
    spots, turns = path.apply(local), path.rotation.as_quat()
    for throw in own:
        part = slice(throw.first, throw.last + 1)
        spun = _spun(source, scene, throw, path.rotation[throw.first])
        turns[part] = spun.as_quat()
        start, end = _velocities(times[part], spots[throw.first], spots[throw.last])
        first, last = _swings(source, throw)
        swing, stop = slice(first, throw.first + 1), slice(throw.last, last + 1)
        before = start - end_velocity(times[swing], spots[swing])
        after = end + end_velocity(-times[stop][::-1], spots[stop][::-1])
        # The path after, from its end and with its times reversed, has the opposite velocity.
        spots[swing] += np.outer(_arriving(times[swing]), before)
        spots[stop] += np.outer(-_arriving(-times[stop][::-1])[::-1], after)
        past = times[part] - times[throw.first]
        spots[part] = spots[throw.first] + np.outer(past, start) + np.outer(0.5 * past**2, FALLS)
    rotation = Rotation.from_quat(turns)
    return RigidTransform.from_components(spots - rotation.apply(local), rotation)


def flight_faults(
    times: Float[np.ndarray, "frames"], spots: Float[np.ndarray, "frames 3"]
) -> tuple[tuple[float, int], tuple[float, int]]:
    """What of a flight from hand to hand no thrown object would do, at worst, and in which frame.

    The distance from the parabola of gravity [m], and the growth of its energy [J/kg].

    Args:
        times: From when it is let go to when it is caught [s].
        spots: Of its middle [m].
    """
    past = times - times[0]
    start, _ = _velocities(times, spots[0], spots[-1])
    parabola = spots[0] + np.outer(past, start) + np.outer(0.5 * past**2, FALLS)
    off = np.linalg.norm(spots - parabola, axis=1)
    # Differences over two frames are exact for a parabola.
    speeds = np.linalg.norm((spots[2:] - spots[:-2]) / (times[2:] - times[:-2])[:, None], axis=1)
    energy = 0.5 * speeds**2 + GRAVITY_MPS2 * spots[1:-1, 2]
    gain = energy - np.minimum.accumulate(energy) if len(energy) else np.zeros(1)
    worst, most = int(off.argmax()), int(gain.argmax())
    return (float(off[worst]), worst), (float(gain[most]), most + 1)


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


def _swings(source: Source, throw: Throw) -> tuple[int, int]:
    """The frames from which the throwing hand swings, and to which the catching one yields."""
    frames = round(SWING_S * source.rate_hz)
    first, last = [throw.first - frames], [throw.last + frames]
    for fact in source.observation.facts:
        if isinstance(fact, Displaced) and fact.object == throw.thing:
            first += [fact.first] if fact.first < throw.first <= fact.last else []
            last += [fact.last] if fact.first <= throw.last < fact.last else []
    for hold in source.carried:
        if not isinstance(hold, Throw) and hold.thing == throw.thing:
            first += [hold.first] if hold.last == throw.first else []
            last += [hold.last] if hold.first == throw.last else []
    return min(max(first), throw.first - 2), max(min(last), throw.last + 2)


def _middle(scene: Scene, name: str) -> Float[np.ndarray, "3"]:
    """Of an object, in its frame [m]: it is taken to be the centre of mass."""
    return np.asarray(scene.thing(name).shape.bounds.mean(axis=0))


def _turn(source: Source, scene: Scene) -> Rotation:
    """How far the new scene faces another way."""
    return Rotation.from_euler("z", scene.heading - source.scene.heading)


def _spun(source: Source, scene: Scene, throw: Throw, released: Rotation) -> Rotation:
    """How an object is turned from when it is let go to when it is caught: it spins as it did."""
    turn, recorded = _turn(source, scene), source.paths[throw.thing].rotation
    part = recorded[throw.first : throw.last + 1]
    return turn * part * part[0].inv() * turn.inv() * released
