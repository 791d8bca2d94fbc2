"""The recorded performance: paths of hands, objects and eyes, and who held what."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.signal import savgol_coeffs, savgol_filter
from scipy.spatial import KDTree
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import measures_of
from capar.body.human import Human
from capar.body.recording import HAND_SEGMENTS
from capar.body.sensors import CUTOFF_HZ, target
from capar.body.shapes import segment_surface
from capar.body.skeleton import eyes_between
from capar.body.virtual_scenes import Thing
from capar.model.capture import Capture, Shape, Stream, TagObject, TagType
from capar.model.facts import Displaced, Resting, Touching
from capar.model.geometry import quaternions, runs, transforms
from capar.model.observation import Observation
from capar.regeneration.holds import (
    CoHeld,
    Load,
    Release,
    Throw,
    apart,
    co_held_of,
    holds_of,
    leanings_of,
    loads_of,
    meetings_of,
    releases_of,
    usual_pose,
    with_blows,
    with_touches,
)
from capar.regeneration.holds import Hold as Hold
from capar.regeneration.holds import Leaning as Leaning
from capar.regeneration.holds import Meeting as Meeting
from capar.regeneration.scenes import PlanError, Scene
from extractors.signals.intervals import time_step

SAMPLES, SHAPES = 5000, 32  # Points on each surface, and surfaces that are kept [1].

PATCH_M = 0.0015
"""Points that are further apart than the nearest by no more than this are in the patch [m]."""


def contact_points(
    first: Shape, second: Shape, relative: RigidTransform
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """The middle of the contact on each of two shapes, in each one's own frame [m]."""
    one, two = _surface(first), _surface(second)
    gaps, nearest = one.query(relative.apply(two.data))
    patch = gaps < gaps.min() + PATCH_M
    return one.data[nearest[patch]].mean(axis=0), two.data[patch].mean(axis=0)


@lru_cache(maxsize=SHAPES)
def _surface(shape: Shape) -> KDTree:
    """Corners of a shape and points on it."""
    return KDTree(np.concatenate([np.array(shape.vertices), surface_samples(shape)[0]]))


def surface_samples(
    shape: Shape,
) -> tuple[Float[np.ndarray, "points 3"], Float[np.ndarray, "points 3"]]:
    """Points on a surface and its normals there, outwards, in the shape's frame [m, 1]."""
    mesh = trimesh.Trimesh(np.array(shape.vertices), np.array(shape.faces), process=False)
    points, faces = trimesh.sample.sample_surface(mesh, SAMPLES, seed=0)
    outwards = 1.0 if mesh.volume >= 0.0 else -1.0
    return np.array(points), outwards * np.array(mesh.face_normals[faces])


LEAST_SINE = 0.5  # Of the angle between a palm's direction and its fingers' [1].

HandAxes = tuple[np.ndarray, np.ndarray]
"""To where a hand's straight fingers point and its palm faces, in the frame of its sensor."""


@dataclass(frozen=True, eq=False)
class HandFrame:
    """Where the frame is on a body, and how large the hand is in it."""

    pose: RigidTransform
    """``T_body_frame``: of the sensor of a capture, or of the hand's segment of a body."""

    extents: Float[np.ndarray, "3"]
    """Lengths of the hand along the frame's axes [m]."""


def _framed(hull: trimesh.Trimesh, x: np.ndarray, z: np.ndarray) -> HandFrame:
    turn = Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=1))
    pose = RigidTransform.from_components(np.array(hull.center_mass), turn)
    return HandFrame(pose, np.ptp(pose.inv().apply(hull.vertices), axis=0))


def stated_hand_frame(shape: Shape, axes: HandAxes) -> HandFrame:
    """The frame along axes that are known, whatever the shape of the half-bent hand is.

    Raises:
        PlanError: The two are along one line.
    """
    fingers, palm = axes
    z = palm / np.linalg.norm(palm)
    x = fingers - (fingers @ z) * z
    if np.linalg.norm(x) < LEAST_SINE * np.linalg.norm(fingers):
        raise PlanError("a palm does not face along its own fingers")
    hull = trimesh.convex.convex_hull(np.array(shape.vertices))
    return _framed(hull, x / np.linalg.norm(x), z)


def hand_frame(shape: Shape, axes: HandAxes) -> HandFrame:
    """The frame along the principal axes of a hand's hull, each towards the given directions."""
    hull = trimesh.convex.convex_hull(np.array(shape.vertices))
    principal = np.array(hull.principal_inertia_vectors)
    moments = np.array(hull.principal_inertia_components)
    x, z = principal[int(np.argmin(moments))], principal[int(np.argmax(moments))]
    fingers, palm = axes
    return _framed(hull, x if x @ fingers >= 0.0 else -x, z if z @ palm >= 0.0 else -z)


def hand_surface(human: Human, side: str) -> Shape:
    """A body's own hand, in the frame of the hand's segment."""
    names = tuple(f"{side}_{each}" for each in HAND_SEGMENTS)
    return segment_surface(human.measures, names, f"{side}_hand")


def body_hand_frame(human: Human, side: str) -> HandFrame:
    """The frame on a body's own hand, in the frame of the hand's segment."""
    palm = Rotation.from_quat(human.model.site(f"{side}_palm").quat, scalar_first=True)
    axes = palm.apply([1.0, 0.0, 0.0]), palm.apply([0.0, 0.0, 1.0])
    return hand_frame(hand_surface(human, side), axes)


START_FRAMES = 10  # Frames from which it is taken where everything is at the beginning [1].
WALKS_M = 0.8  # A head that goes further aside is carried there by steps [m].
STANDS_M = 0.5  # While a head stays within this, its bearer is taken to stand [m].

LAUNCH_FRAMES = 3
"""An object may be seen to move so long before the frame of the blow: filters blur it [1]."""

FACED_M = 0.02
"""Points of a surface that are further from a hand's middle than the nearest by no more than this
are faced by its palm [m]."""

STILL_M, STILL_RAD = 0.005, float(np.radians(5.0))
"""An interval in which a body stays so near where it was is one of rest [m, rad]."""

LONGEST_S, WIDER, SURE = 0.25, 1.5, 2.0
"""A motion is a parabola for up to so long before and after a frame, windows that are tried are so
many times as long each as the one before, and estimates differ by no more than so many deviations
[s, 1, 1]."""

MOVES_M, MOVES_RAD = 0.02, float(np.radians(10.0))
"""An object that never goes or turns further does not move [m, rad]."""


@dataclass(frozen=True, eq=False)
class HandTrack:
    """A hand that acts, along the capture."""

    sensor: str
    side: str
    frame: HandFrame
    path: RigidTransform
    """``T_world_frame`` at every frame."""


@dataclass(frozen=True, eq=False)
class Source:
    """A recorded performance, as it is performed again."""

    capture: Capture
    observation: Observation
    human: Human
    """The body that was recorded."""

    scene: Scene
    """The scene as it was."""

    hands: Mapping[str, HandTrack]
    """By side."""

    paths: Mapping[str, RigidTransform]
    """``T_world_thing`` by name at every frame."""

    eyes: RigidTransform
    """Between the eyes, x along the level line of sight, at every frame."""

    holds: tuple[Hold, ...]
    meetings: tuple[Meeting, ...]
    leanings: tuple[Leaning, ...]
    notes: tuple[str, ...]
    releases: tuple[Release, ...] = ()
    """Objects that a hand set going, after which they moved on alone."""

    throws: tuple[Throw, ...] = ()
    """Objects that fly from one hold to the next."""

    others: tuple[Hold, ...] = ()
    """When other performers hold objects."""

    loads: tuple[Load, ...] = ()
    """What held objects bear."""

    co_held: tuple[CoHeld, ...] = ()
    """What lies in a hand beside another object."""

    pace: float = 1.0
    """How many times as long everything takes as it did [1]."""

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        """[s]."""
        return np.asarray(self.capture.times * self.pace)

    @property
    def carried(self) -> tuple[Hold | Load | Throw, ...]:
        """When objects may move: somebody holds them, something bears them, or they fly."""
        return (*self.holds, *self.others, *self.loads, *self.throws)

    @property
    def met(self) -> frozenset[str]:
        """Names of the objects that meet the performer's head."""
        return frozenset(meeting.thing for meeting in self.meetings)

    @property
    def rate_hz(self) -> float:
        """Frames a second."""
        return self.capture.rate_hz / self.pace


def source_of(
    capture: Capture,
    observation: Observation,
    *,
    stance: tuple[tuple[float, float], float] | None = None,
    floor_m: float = 0.0,
    axes: Mapping[str, HandAxes] | None = None,
    notes: tuple[str, ...] = (),
    cutoff_hz: float | None = CUTOFF_HZ,
    checked: bool = True,
) -> Source:
    """What a capture and its observation say of the performance of one.

    Args:
        capture: What was recorded.
        observation: What was done in it.
        stance: Where the performer stands [m] and faces [rad]; by the head, unless stated.
        floor_m: Height of the floor [m].
        axes: Which way hands point and face, by side; by their shapes and what they touch,
            unless stated.
        notes: What is to be reported of it.
        cutoff_hz: Of the filter that takes noise from paths [Hz]; None leaves them as recorded.
        checked: Whether it is refused if the performer walks, or something moves that no hand holds
            or set going; what several performers do is checked when all of it is known.

    Raises:
        PlanError: It is not known where the performer stands, a hand or object has no shape, or it
            is refused when checked.
    """
    human = Human.of(measures_of(capture.agent))
    noise, rests = _noise(observation), _rests(capture, observation)
    tracks = {
        name: _path(body.stream, cutoff_hz, rests.get(name, ()), noise[name])
        if name in noise
        else _path(body.stream, cutoff_hz)
        for name, body in capture.bodies.items()
    }
    eyes = _eyes(capture, cutoff_hz)
    place, heading = stance or _stance(human, eyes)
    things, paths = {}, {}
    for each in capture.objects:
        if each.tag is not TagType.SELF:
            things[each.name], paths[each.name] = _thing(each, tracks[each.name])
    touching = [fact for fact in observation.facts if isinstance(fact, Touching)]
    shoulder = eyes.translation.mean(axis=0) - [0.0, 0.0, 0.12 * human.measures["stature"]]
    hands = {}
    for sensor in capture.acting:
        side = sensor.side
        if sensor.end_effector == "hand" and side in {"right", "left"}:
            path, shape = tracks[sensor.name], sensor.shape
            if shape is None:
                raise PlanError(
                    f"sensor {sensor.name!r} has no shape of the hand; give it a mesh or a box"
                )
            if axes and side in axes:
                frame = stated_hand_frame(shape, axes[side])
            else:
                near = [f for f in touching if f.body == sensor.name and f.other in things]
                frame = hand_frame(shape, _hand_axes(shape, path, shoulder, near, things, paths))
            hands[side] = HandTrack(sensor.name, side, frame, path * frame.pose)
    by_side = {side: (hand.sensor, hand.path) for side, hand in hands.items()}
    displaced = [fact for fact in observation.facts if isinstance(fact, Displaced)]
    for guide in observation.guides:
        if any(fact.object == guide.base for fact in displaced):
            raise PlanError(
                f"{guide.object!r} is a part of {guide.base!r}, which moves as well; only parts on "
                "bases that stay where they are can be regenerated"
            )
    holds = holds_of(by_side, paths, touching)
    holds = with_touches(holds, by_side, touching, displaced, capture.times)
    sides = {hand.sensor: side for side, hand in hands.items()}
    releases, throws = releases_of(observation.forces, sides, holds, capture.times, paths)
    holds = with_blows(holds, releases)
    entered = _entered(capture, holds, hands, touching)
    told = [*notes, "the point of contact on each hand is measured on the capture's meshes"]
    told += [
        f"hands and forearms may enter {name!r}, whose size is assumed, as the recorded hand does"
        for name in sorted(entered)
    ]
    co_held = co_held_of(holds, paths)
    scene = Scene(
        things, place, heading, floor_m, entered=entered,
        fastened={one.object: one.base for one in observation.guides if one.object in things},
        together={pair.hold.thing: pair.lead.thing for pair in co_held},
    )  # fmt: skip
    meetings = meetings_of(capture, eyes, paths, touching)
    eyes = _eyes(capture, cutoff_hz, [(m.first, m.last) for m in meetings if m.steady])
    made = Source(
        capture, observation, human, scene, hands, paths, eyes, holds, meetings,
        leanings_of(observation, {side: name for name, side in sides.items()}, things, holds),
        tuple(told), releases, throws,
        loads=loads_of(paths, holds, touching), co_held=co_held,
    )  # fmt: skip
    if checked:
        check_source(made)
    return made


def captured_scene(capture: Capture) -> Scene:
    """The scene that a capture was recorded in: its objects, and where the performer stood.

    Raises:
        PlanError: An object has no shape, or there is no sensor of the head.
    """
    place, heading = _stance(Human.of(measures_of(capture.agent)), _eyes(capture))
    objects = [each for each in capture.objects if each.tag is not TagType.SELF]
    things = {each.name: _thing(each, _path(each.stream))[0] for each in objects}
    return Scene(things, place, heading)


def moves(path: RigidTransform) -> bool:
    """Whether an object goes or turns far enough from where it is at first."""
    gone = np.linalg.norm(path.translation - path.translation[0], axis=1)
    turned = (path.rotation * path.rotation[0].inv()).magnitude()
    return bool(gone.max() >= MOVES_M or turned.max() >= MOVES_RAD)


def _noise(observation: Observation) -> dict[str, tuple[float, float]]:
    """Deviations of a coordinate and of the turn about an axis of noisy bodies [m, rad]."""
    known = observation.calibration
    if known is None:
        return {}
    return {
        each.name: (each.noise_m, each.noise_rad)
        for each in (*known.objects, *known.sensors)
        if each.noise_m > known.thresholds["smoothing_noise_m"]
    }


def _rests(capture: Capture, observation: Observation) -> dict[str, list[tuple[int, int]]]:
    """From when to when bodies rest, by name: objects while they are not displaced."""
    out: dict[str, list[tuple[int, int]]] = {}
    for fact in observation.facts:
        if isinstance(fact, Resting):
            out.setdefault(fact.ee, []).append((fact.first, fact.last))
    for each in capture.objects:
        rests = np.ones(len(capture.times), dtype=bool)
        for fact in observation.facts:
            if isinstance(fact, Displaced) and fact.object == each.name:
                rests[fact.first + 1 : fact.last] = False
        out[each.name] = runs(rests)
    return out


def _path(
    stream: Stream,
    cutoff_hz: float | None = CUTOFF_HZ,
    rests: Iterable[tuple[int, int]] = (),
    noise: tuple[float, float] = (0.0, 0.0),
) -> RigidTransform:
    """A stream without noise, its losses filled from both sides; what rests has one pose.

    Each motion is smoothed alone, from the pose of the rest before it to that of the rest after it.

    Args:
        stream: As it was recorded.
        cutoff_hz: Of the filter [Hz]; None leaves it as recorded.
        rests: Intervals of rest. One in which it goes on average further than ``STILL_M`` from its
            median is none.
        noise: Deviations of a coordinate and of the turn about an axis [m, rad].
    """
    spots, turns = np.array(stream.positions), np.array(stream.orientations)
    still = np.zeros(len(spots), dtype=bool)
    for first, last in rests if cutoff_hz else ():
        part = slice(first, last + 1)
        known = ~np.isnan(spots[part, 0])
        if known.any():
            poses = transforms(spots[part][known], turns[part][known])
            usual = usual_pose(poses)
            off, turned = apart(poses, usual)
            if off.mean() < STILL_M and turned.mean() < STILL_RAD:
                spots[part], turns[part] = usual.translation, quaternions(usual.rotation)
                still[part] = True
    longest = round(LONGEST_S / time_step(stream.times))
    smooth = _fitted(spots, noise[0], longest), _fitted(turns, 0.5 * noise[1], longest)
    for first, last in runs(~still):
        inner, part = slice(first, last + 1), slice(max(first - 1, 0), last + 2)
        spots[inner], turns[inner] = (each[inner] for each in smooth)
        one = target(Stream(stream.times[part], spots[part], turns[part]), cutoff_hz=cutoff_hz)
        spots[part], turns[part] = one.positions, one.orientations
    made = Stream(stream.times, spots, turns)  # of continuous signs
    frames, known = np.arange(len(spots)), np.flatnonzero(~made.lost)
    spots = np.stack([np.interp(frames, known, c[known]) for c in made.positions.T], axis=1)
    turns = np.stack([np.interp(frames, known, c[known]) for c in made.orientations.T], axis=1)
    return transforms(spots, turns / np.linalg.norm(turns, axis=1, keepdims=True))


def _fitted(
    values: Float[np.ndarray, "frames columns"], deviation: float, longest: int
) -> Float[np.ndarray, "frames columns"]:
    """At each frame the parabola through the most frames about it that noise allows.

    Windows grow by up to so many frames on both sides, until what they estimate differs by more
    than noise of that deviation explains: until the confidence intervals no longer all intersect
    (Goldenshluger and Nemirovski 1997). Frames about a loss stay as they are.
    """
    out, low, high = np.array(values), values - SURE * deviation, values + SURE * deviation
    going, half = ~np.isnan(values[:, 0]), 2
    while half <= longest and 2 * half < len(values) and going.any():
        width = 2 * half + 1
        fit = savgol_filter(values, width, 2, axis=0, mode="interp")
        weights = [savgol_coeffs(width, 2, pos=row, use="dot") for row in range(half + 1)]
        doubt = np.full((len(values), 1), SURE * deviation * np.linalg.norm(weights[half]))
        for row in range(half):  # at the ends by the first and the last whole window
            doubt[[row, -1 - row]] = SURE * deviation * np.linalg.norm(weights[row])
        low, high = np.maximum(low, fit - doubt), np.minimum(high, fit + doubt)
        going &= (low <= high).all(axis=1)
        out[going] = fit[going]
        half = max(half + 1, round(WIDER * half))
    return out


def _eyes(
    capture: Capture,
    cutoff_hz: float | None = CUTOFF_HZ,
    rests: Iterable[tuple[int, int]] = (),
) -> RigidTransform:
    heads = [each for each in capture.sensors if each.end_effector == "head"]
    if not heads:
        raise PlanError(
            f"capture {capture.name!r} has no sensor of the head, which says where the performer "
            "stands and looks; there are " + ", ".join(each.name for each in capture.sensors)
        )
    head = heads[0]
    path = _path(head.stream, cutoff_hz, rests)
    ahead = path.rotation[:START_FRAMES].mean().apply(np.array(head.gaze))
    x = np.array([ahead[0], ahead[1], 0.0]) / np.hypot(ahead[0], ahead[1])
    z = np.array([0.0, 0.0, 1.0])
    level = Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=1))
    local = path.rotation[:START_FRAMES].mean().inv() * level
    return path * RigidTransform.from_components(np.array(head.eye), local)


def _stance(human: Human, eyes: RigidTransform) -> tuple[tuple[float, float], float]:
    spot = np.median(eyes.translation[:START_FRAMES], axis=0)
    ahead = eyes.rotation[:START_FRAMES].mean().apply([1.0, 0.0, 0.0])
    heading = float(np.arctan2(ahead[1], ahead[0]))
    local = eyes_between(human.measures)
    x = float(spot[0] - np.cos(heading) * local[0])
    y = float(spot[1] - np.sin(heading) * local[0])
    return (x, y), heading


def _thing(each: TagObject, path: RigidTransform) -> tuple[Thing, RigidTransform]:
    """The object with an upright frame, and its path."""
    if each.shape is None:
        raise PlanError(f"object {each.name!r} has no shape; give it a mesh or a box")
    count = len(path) if each.tag is TagType.FIXED else START_FRAMES
    turn = path.rotation[:count].mean()
    x = turn.apply([1.0, 0.0, 0.0])
    heading = float(np.arctan2(x[1], x[0]))
    tilt = Rotation.from_euler("z", heading).inv() * turn
    shape = Shape(
        tilt.apply(np.array(each.shape.vertices)), np.array(each.shape.faces),
        each.shape.source, each.shape.description,
    )  # fmt: skip
    x0, y0, z0 = (float(v) for v in np.median(path.translation[:count], axis=0))
    made = Thing(each.name, shape, (x0, y0, z0), heading, each.tag, each.kind, mass_kg=each.mass_kg)
    return made, path * RigidTransform.from_rotation(tilt.inv())


def _hand_axes(
    shape: Shape,
    path: RigidTransform,
    shoulder: Float[np.ndarray, "3"],
    near: list[Touching],
    things: Mapping[str, Thing],
    paths: Mapping[str, RigidTransform],
) -> HandAxes:
    """Roughly to where fingers point, off the shoulder, and the palm faces, to what it touches."""
    middle = 0.5 * shape.bounds.sum(axis=0)
    fingers = path.rotation.inv().apply(path.apply(middle) - shoulder).mean(axis=0)
    palm = np.zeros(3)
    for contact in near:
        # Against the surface, not towards it: a recorded hand may be inside of what it holds.
        frame = (contact.first + contact.last) // 2
        points, normals = surface_samples(things[contact.other].shape)
        pose = paths[contact.other][frame]
        apart = np.linalg.norm(pose.apply(points) - path[frame].apply(middle), axis=1)
        facing = -pose.rotation.apply(normals)[apart < apart.min() + FACED_M].mean(axis=0)
        palm = palm + path[frame].rotation.inv().apply(facing)
    if not near:  # a hand that touches nothing hangs with its palm to the body
        here = path[0].apply(middle)
        palm = path.rotation[0].inv().apply([shoulder[0] - here[0], shoulder[1] - here[1], 0.0])
    return fingers, palm


def _entered(
    capture: Capture,
    holds: tuple[Hold, ...],
    hands: Mapping[str, HandTrack],
    touching: list[Touching],
) -> frozenset[str]:
    """Assumed objects that a hand touched while it held another: they cannot be as assumed."""
    assumed = {each.name for each in capture.objects if each.assumed}
    return frozenset(
        contact.other
        for hold in holds
        for contact in touching
        if contact.body == hands[hold.side].sensor
        and contact.other in assumed - {hold.thing}
        and contact.first <= hold.last
        and hold.first <= contact.last
    )


def check_source(source: Source) -> None:
    """Whoever performs stands, and whatever moves is in a hand or was set going by one.

    Raises:
        PlanError: The performer walks, or something moves that no hand holds or set going.
    """
    spots, times = source.eyes.translation[:, :2], source.times
    apart = np.linalg.norm(spots - spots[0], axis=1)
    if apart.max() > WALKS_M:
        first, last = _longest_stand(spots)
        raise PlanError(
            f"the performer walks: the head is {apart.max():.2f} m aside at "
            f"{times[int(apart.argmax())]:.2f} s, and feet keep their place when an action is "
            f"performed again; it stays within {STANDS_M:g} m from {times[first]:.2f} to "
            f"{times[last]:.2f} s: state from_s and to_s of such a part with --assume FILE"
        )
    for name, path in source.paths.items():
        held = np.zeros(len(times), dtype=bool)
        for carried in source.carried:
            if carried.thing == name:
                held[carried.first : carried.last + 1] = True
        for release in source.releases:
            if release.thing == name:
                held[max(release.frame - LAUNCH_FRAMES, 0) :] = True
        moved = np.linalg.norm(path.translation - path.translation[0], axis=1)
        for first, last in runs(~held):
            far_m = float(np.ptp(moved[first : last + 1]))
            if far_m > MOVES_M:
                raise PlanError(
                    f"{name!r} moves by {1e3 * far_m:.0f} mm from {times[first]:.2f} to "
                    f"{times[last]:.2f} s without a steady grip, and no hand was seen to set it "
                    "going; end the recording before, or begin it after, with to_s and from_s in "
                    "a file given with --assume FILE"
                )


def _longest_stand(spots: Float[np.ndarray, "frames 2"]) -> tuple[int, int]:
    """First and last frame of the longest interval whose places are all near each other."""
    best, first = (0, 0), 0
    for last in range(len(spots)):
        while np.linalg.norm(spots[first : last + 1] - spots[last], axis=1).max() > STANDS_M:
            first += 1
        best = max(best, (first, last), key=lambda span: span[1] - span[0])
    return best
