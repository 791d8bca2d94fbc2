"""How a thing moves on alone after another body set it going, in another scene."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.model.capture import TagType
from capar.regeneration.errors import PlanError
from capar.regeneration.forces.force_kinds import ForceKind
from capar.regeneration.launches import Launch
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source
from extractors.forces.forces import VELOCITY_S, velocity_at
from extractors.forces.free_motion import FreeMotion, Resistance, Surface, free_motion

ARM = ("upper_arm", "forearm", "hand", "fingers", "fingertips", "thumb")
"""The link whose mass strikes, taken to be at the hand (thesis 3.4.3.3)."""

SHARE = 0.98
"""The largest share of a blow's momentum that a striker keeps for its own mass [1]."""

SLOWEST, FASTEST = 0.2, 2.5
"""How many times as fast a hand may be led into a blow as its own way has it [1]."""

DAMPING, BOUNCE = (2.0, 2.0), 0.4
"""Of a thing that was not seen to slide, or to bounce [1/s], [1]."""


@dataclass(frozen=True, eq=False)
class Flight:
    """A thing's motion on its own, from a frame on."""

    launch: Launch
    velocity: Float[np.ndarray, "3"]
    """With which it begins [m/s]."""

    hand_mps: float
    """The hand's speed just before, along the line of impact or the thing's way [m/s]."""

    motion: FreeMotion


def first_guess(
    source: Source, scene: Scene, things: Mapping[str, RigidTransform]
) -> dict[str, RigidTransform]:
    """The ways of things if each were set going as in the recording."""
    out = dict(things)
    for launch in source.launches:
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
    """Ways of things and of hands, with the motion that each launch gives.

    By eq. 3.5 and the conservation of momentum a thing at rest gets (1 + e) q / (1 + q) of the
    striker's speed, q being the striker's mass over the thing's. The recorded speeds give q, which
    the masses of both arms and the thing's size carry over. A thing that is let go has the speed
    of the hand, in the recorded proportion.

    Args:
        source: The recorded performance.
        scene: Where it is performed.
        humans: The recorded body and the new one.
        things: ``T_world_thing`` by name at every frame.
        hands: ``T_world_hand`` by side at every frame.
        kind: What is the same on the new body.

    Raises:
        PlanError: The hand would have to strike faster than it can.
    """
    ways, paths, out = dict(things), dict(hands), []
    for launch in source.launches:
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
    """What is told of things that were set going."""
    out = []
    for flight in found:
        launch, force = flight.launch, flight.launch.force
        verb = "strikes" if force.struck else "lets go of"
        old = np.linalg.norm(force.velocity_mps)
        end = ", ".join(f"{value:.2f}" for value in flight.motion.positions[-1])
        course = ", ".join(phase.value for _, phase in flight.motion.phases)
        out.append(
            f"the {launch.side} hand {verb} {launch.thing!r} at "
            f"{source.times[launch.frame]:.2f} s with {flight.hand_mps:.2f} m/s; it goes "
            f"{np.linalg.norm(flight.velocity):.2f} m/s (recorded {old:.2f}), {course}, and is at "
            f"({end}) m at the end"
        )
    return out


def arm_mass(human: Human, side: str) -> float:
    """Mass of the link that a hand ends [kg]."""
    return sum(float(human.model.body(f"{side}_{part}").mass[0]) for part in ARM)


def surfaces_of(scene: Scene) -> list[Surface]:
    """What bears things in a scene: level tops of fixed things, and the floor."""
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
    launch: Launch,
    old: float,
    speed: float,
) -> float:
    """The thing's speed over the hand's [1]."""
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
    launch: Launch,
    path: RigidTransform,
    velocity: Float[np.ndarray, "3"],
) -> FreeMotion:
    """The thing's middle from the launch to the end."""
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
    source: Source, scene: Scene, launch: Launch, path: RigidTransform, motion: FreeMotion
) -> RigidTransform:
    """A thing's way that goes on alone from the launch."""
    turn = path.rotation[launch.frame]
    middle = turn.apply(scene.thing(launch.thing).shape.bounds.mean(axis=0))
    spots = path.translation.copy()
    spots[launch.frame :] = motion.positions - middle
    turns = path.rotation.as_quat()
    turns[launch.frame :] = turn.as_quat()
    return RigidTransform.from_components(spots, Rotation.from_quat(turns))


def _faster(
    source: Source, launch: Launch, hand: RigidTransform, needed: float, own: float
) -> RigidTransform:
    """A hand's way that comes to the blow with the needed speed, on the same places."""
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
