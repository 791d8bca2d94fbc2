"""What regeneration takes from a capture and its observation: paths, holds, meetings and gaze."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import measures_of
from capar.body.human import Human
from capar.body.skeleton import eyes_between
from capar.body.targets import target
from capar.body.things import Thing
from capar.model.capture import Capture, Sensor, Shape, Stream, TagObject, TagType
from capar.model.facts import Leans, Lies, Touching
from capar.model.geometry import runs, transforms
from capar.model.observation import Observation
from capar.regeneration.errors import PlanError
from capar.regeneration.hand_frames import HandFrame, hand_frame
from capar.regeneration.scenes import Scene

START_FRAMES = 10
"""Frames from which it is taken where everything is at the beginning [1]."""

SETTLED_M = 0.0025
"""While two bodies' relative pose is so near its median, they are rigidly together [m]."""

SETTLED_RAD = float(np.radians(2.0))
"""Likewise the angle [rad]."""

LOOSER = (1.0, 2.0)
"""Multiples of both that are tried: noisy sensors keep less still [1]."""

SETTLED_SHARE = 0.8
"""Noise may take so small a share of the frames in between out of that [1]."""

MOVES_M, MOVES_RAD = 0.02, float(np.radians(10.0))
"""A thing that never goes or turns further does not move [m, rad]."""


@dataclass(frozen=True, eq=False)
class HandTrack:
    """A hand that acts, along the capture."""

    sensor: str
    side: str
    frame: HandFrame
    path: RigidTransform
    """``T_world_frame`` at every frame."""


@dataclass(frozen=True)
class Hold:
    """A hand and a thing that are rigidly together."""

    side: str
    thing: str
    first: int
    last: int


@dataclass(frozen=True)
class Meeting:
    """A held thing that is rigidly together with the performer's head."""

    thing: str
    part: str
    first: int
    last: int


@dataclass(frozen=True)
class Poise:
    """A held thing that leans over above or in another one that can be moved."""

    thing: str
    other: str
    lowest: int
    """The frame in the middle of its leaning over."""

    frames: tuple[int, ...]
    """Borders of the hand's steps meanwhile."""


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
    poises: tuple[Poise, ...]
    notes: tuple[str, ...]
    pace: float = 1.0
    """How many times as long everything takes as it did [1]."""

    @property
    def times(self) -> Float[np.ndarray, "frames"]:
        """[s]."""
        return np.asarray(self.capture.times * self.pace)

    @property
    def rate_hz(self) -> float:
        """Frames a second."""
        return self.capture.rate_hz / self.pace


def source_of(capture: Capture, observation: Observation) -> Source:
    """What a capture and its observation say of the performance.

    Raises:
        PlanError: It is not known where the performer stands, or a hand or thing has no shape.
    """
    human = Human.of(measures_of(capture.agent))
    eyes = _eyes(capture)
    place, heading = _stance(human, eyes)
    tracks = {name: _path(body.stream) for name, body in capture.bodies.items()}
    objects = [each for each in capture.objects if each.tag is not TagType.SELF]
    things, paths = {}, {}
    for each in objects:
        things[each.name], paths[each.name] = _thing(each, tracks[each.name])
    touching = [each for each in observation.facts if isinstance(each, Touching)]
    shoulder = eyes.translation.mean(axis=0) - [0.0, 0.0, 0.12 * human.measures["stature"]]
    hands = {}
    for sensor in capture.acting:
        if sensor.end_effector == "hand" and sensor.side in {"right", "left"}:
            near = _touched(sensor, touching, paths, things)
            hands[sensor.side] = _hand(sensor, tracks[sensor.name], shoulder, near)
    notes = ["the point of contact on each hand is measured on the capture's meshes"]
    holds = _holds(hands, paths, touching)
    meetings = _meetings(capture, eyes, paths, touching)
    poises = _poises(observation, hands, things, holds)
    made = Source(
        capture, observation, human, Scene(things, place, heading),
        hands, paths, eyes, holds, meetings, poises, tuple(notes),
    )  # fmt: skip
    _check_movers(made)
    return made


def scene_of(capture: Capture, human: Human) -> Scene:
    """The things of a capture where they are at the beginning, and where the performer stands.

    Raises:
        PlanError: A thing has no shape, or there is no sensor of the head.
    """
    place, heading = _stance(human, _eyes(capture))
    objects = [each for each in capture.objects if each.tag is not TagType.SELF]
    things = {each.name: _thing(each, _path(each.stream))[0] for each in objects}
    return Scene(things, place, heading)


def eyes_in_body(human: Human) -> Float[np.ndarray, "3"]:
    """Between the eyes of the standing body, from the place where it stands [m]."""
    return np.asarray(eyes_between(human.measures))


def moves(path: RigidTransform) -> bool:
    """Whether a thing goes or turns far enough from where it is at first."""
    gone = np.linalg.norm(path.translation - path.translation[0], axis=1)
    turned = (path.rotation * path.rotation[0].inv()).magnitude()
    return bool(gone.max() >= MOVES_M or turned.max() >= MOVES_RAD)


def _path(stream: Stream) -> RigidTransform:
    """A stream without noise, its losses filled from both sides."""
    one = target(stream)
    frames = np.arange(len(stream.times))
    known = np.flatnonzero(~np.isnan(one.positions[:, 0]))
    spots = np.stack([np.interp(frames, known, c[known]) for c in one.positions.T], axis=1)
    turns = np.stack([np.interp(frames, known, c[known]) for c in one.orientations.T], axis=1)
    return transforms(spots, turns / np.linalg.norm(turns, axis=1, keepdims=True))


def _eyes(capture: Capture) -> RigidTransform:
    heads = [each for each in capture.sensors if each.end_effector == "head"]
    if not heads:
        raise PlanError(
            f"capture {capture.name!r} has no sensor of the head, which says where the performer "
            "stands and looks; there are " + ", ".join(each.name for each in capture.sensors)
        )
    head = heads[0]
    path = _path(head.stream)
    ahead = path.rotation[:START_FRAMES].mean().apply(np.array(head.gaze))
    x = np.array([ahead[0], ahead[1], 0.0]) / np.hypot(ahead[0], ahead[1])
    z = np.array([0.0, 0.0, 1.0])
    level = Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=1))
    local = path.rotation[:START_FRAMES].mean().inv() * level
    return path * RigidTransform.from_components(np.array(head.eye), local)


def _stance(human: Human, eyes: RigidTransform) -> tuple[tuple[float, float], float]:
    spot = np.median(eyes.translation[:START_FRAMES], axis=0)
    ahead = eyes.rotation[0].apply([1.0, 0.0, 0.0])
    heading = float(np.arctan2(ahead[1], ahead[0]))
    local = eyes_in_body(human)
    x = float(spot[0] - np.cos(heading) * local[0])
    y = float(spot[1] - np.sin(heading) * local[0])
    return (x, y), heading


def _thing(each: TagObject, path: RigidTransform) -> tuple[Thing, RigidTransform]:
    """The thing with an upright frame, and its path."""
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


def _touched(
    sensor: Sensor,
    touching: list[Touching],
    paths: Mapping[str, RigidTransform],
    things: Mapping[str, Thing],
) -> list[tuple[int, np.ndarray]]:
    """The frames in the middle of a hand's contacts, and corners of what it touches there."""
    out = []
    for each in touching:
        if each.body == sensor.name and each.other in things:
            frame = (each.first + each.last) // 2
            out.append(
                (frame, paths[each.other][frame].apply(np.array(things[each.other].shape.vertices)))
            )
    return out


def _hand(
    sensor: Sensor,
    path: RigidTransform,
    shoulder: Float[np.ndarray, "3"],
    near: list[tuple[int, np.ndarray]],
) -> HandTrack:
    if sensor.shape is None:
        raise PlanError(f"sensor {sensor.name!r} has no shape of the hand; give it a mesh or a box")
    middle = 0.5 * sensor.shape.bounds.sum(axis=0)
    outwards = path.apply(middle) - shoulder
    fingers = path.rotation.inv().apply(outwards).mean(axis=0)
    palm = np.zeros(3)
    for frame, corners in near:
        here = path[frame].inv().apply(corners)
        nearest = here[np.argsort(np.linalg.norm(here - middle, axis=1))[:8]]
        palm = palm + nearest.mean(axis=0) - middle
    if not near:  # a hand that touches nothing hangs with its palm to the body
        here = path[0].apply(middle)
        palm = path.rotation[0].inv().apply([shoulder[0] - here[0], shoulder[1] - here[1], 0.0])
    own = hand_frame(sensor.shape, fingers, palm)
    return HandTrack(sensor.name, sensor.side, own, path * own.pose)


def _holds(
    hands: Mapping[str, HandTrack], paths: Mapping[str, RigidTransform], touching: list[Touching]
) -> tuple[Hold, ...]:
    out = []
    for side, hand in hands.items():
        for each in touching:
            if each.body == hand.sensor and each.other in paths:
                part = slice(each.first, each.last + 1)
                span = _settled(paths[each.other][part].inv() * hand.path[part])
                if span:
                    out.append(Hold(side, each.other, each.first + span[0], each.first + span[1]))
    return tuple(sorted(out, key=lambda hold: (hold.first, hold.side)))


def _meetings(
    capture: Capture,
    eyes: RigidTransform,
    paths: Mapping[str, RigidTransform],
    touching: list[Touching],
) -> tuple[Meeting, ...]:
    own = {each.name for each in capture.objects if each.tag is TagType.SELF}
    out = []
    for each in touching:
        for thing, part in ((each.body, each.other), (each.other, each.body)):
            if thing in paths and part in own:
                span = slice(each.first, each.last + 1)
                found = _settled(eyes[span].inv() * paths[thing][span])
                if found:
                    first, last = (each.first + edge for edge in found)
                    out.append(Meeting(thing, part, first, last))
    return tuple(sorted(out, key=lambda meeting: meeting.first))


def _poises(
    observation: Observation,
    hands: Mapping[str, HandTrack],
    things: Mapping[str, Thing],
    holds: tuple[Hold, ...],
) -> tuple[Poise, ...]:
    leans = [fact for fact in observation.facts if isinstance(fact, Leans)]
    out = []
    for fact in observation.facts:
        if not isinstance(fact, Lies) or fact.how not in {"above", "inside"}:
            continue
        tilts = [
            lean
            for lean in leans
            if lean.object == fact.body and fact.first <= lean.first and lean.last <= fact.last
        ]
        held = [
            hold
            for hold in holds
            if hold.thing == fact.body
            and any(hold.first <= tilt.first and tilt.last <= hold.last for tilt in tilts)
        ]
        if held and fact.other in things and things[fact.other].tag is TagType.MOBILE:
            first = max(fact.first, min(hold.first for hold in held))
            last = min(fact.last, max(hold.last for hold in held))
            sensors = {hands[hold.side].sensor for hold in held}
            ends = {part.last for part in observation.segments if part.ee in sensors}
            frames = tuple(sorted(frame for frame in ends if first <= frame <= last))
            lowest = (tilts[0].first + tilts[0].last) // 2
            if frames:
                out.append(Poise(fact.body, fact.other, lowest, frames))
    return tuple(sorted(out, key=lambda poise: poise.frames))


def _settled(relative: RigidTransform) -> tuple[int, int] | None:
    """First and last of the frames in which a relative pose is near its median, if most are."""
    spots = relative.translation
    off = np.linalg.norm(spots - np.median(spots, axis=0), axis=1)
    near = off <= np.median(off)
    turned = (relative.rotation * relative.rotation[near].mean().inv()).magnitude()
    for factor in LOOSER:
        steady = (off < factor * SETTLED_M) & (turned < factor * SETTLED_RAD)
        frames = np.flatnonzero(steady)
        if len(frames) > 1 and steady[frames[0] : frames[-1] + 1].mean() >= SETTLED_SHARE:
            return int(frames[0]), int(frames[-1])
    return None


def _check_movers(source: Source) -> None:
    """Whatever moves does so in a hand."""
    for name, path in source.paths.items():
        held = np.zeros(len(source.times), dtype=bool)
        for hold in source.holds:
            if hold.thing == name:
                held[hold.first : hold.last + 1] = True
        moved = np.linalg.norm(path.translation - path.translation[0], axis=1)
        for first, last in runs(~held):
            if float(np.ptp(moved[first : last + 1])) > MOVES_M:
                raise PlanError(
                    f"{name!r} moves by {np.ptp(moved[first : last + 1]) * 1000:.0f} mm from "
                    f"{source.times[first]:.2f} to {source.times[last]:.2f} s without a steady "
                    "contact with a hand; throwing, hitting and pushing are not regenerated"
                )
