"""A performance as a tracker would have recorded it: a capture, a bundle, and the exact truth."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.gaze import lines_of_sight
from capar.body.mounting import Mount
from capar.body.performing import TOUCH_M, Performance
from capar.body.scripts import SIDES
from capar.body.sensing import Tracker, recorded, sense, strap_on
from capar.body.skeleton import skeleton
from capar.body.surfaces import segment_surface
from capar.model import geometry
from capar.model.capture import Agent, Capture, Role, Sensor, Shape, Stream, TagObject, TagType

HAND_SEGMENTS = ("hand", "fingers", "fingertips")
"""What a hand's surface consists of; the thumb is left out, as it moves against them."""

LINKS = {"hand": "arm", "foot": "leg", "head": "neck"}


@dataclass(frozen=True, eq=False)
class Truth:
    """What is so in a performance, to the frame."""

    contacts: tuple[tuple[str, str, float, float], ...]
    """Two bodies that touch, from when to when [s], sorted."""

    motions: tuple[tuple[str, float, float], ...]
    """A thing that moves, from when to when [s]."""

    phases: tuple[tuple[str, float, float], ...]
    """Name, start and end of each phase of the script [s]."""

    looks: tuple[tuple[str, float, float], ...]
    """What is looked at while a phase lasts, from when to when [s]."""


def truth_of(made: Performance) -> Truth:
    """What is so, from the script's own places and not from what a tracker sees."""
    contacts = []
    for side in SIDES:
        for name, holds in _holds(made, side).items():
            contacts += [(f"{side}_hand", name, a, b) for a, b in _intervals(made, holds)]
    for name, thing in made.scene.things.items():
        if made.scene.table and thing.tag is TagType.MOBILE:
            stands = np.abs(made.things[name].translation[:, 2] - thing.place[2]) < TOUCH_M
            upright = (made.things[name].rotation * thing.pose.rotation.inv()).magnitude() < 0.01
            for a, b in _intervals(made, stands & upright):
                contacts.append((name, made.scene.table.name, a, b))
        for a, b in _intervals(made, _at_mouth(made, name)):
            contacts.append((name, "head", a, b))
    motions = [
        (name, a, b)
        for name in made.scene.things
        for a, b in _intervals(made, _moves(made.things[name]))
    ]
    looks = [
        (look, start, end)
        for look, (_, start, end) in zip(made.looks, made.phases, strict=True)
        if look
    ]
    return Truth(tuple(sorted(contacts)), tuple(motions), made.phases, tuple(looks))


def record(
    made: Performance,
    *,
    name: str,
    seed: int,
    tracker: Tracker | None = None,
    sensors: tuple[str, ...] = ("right_hand", "left_hand", "head"),
    eye_tracker: bool = True,
    agent: Agent | None = None,
) -> Capture:
    """The capture of a performance.

    Args:
        made: What was done.
        name: Of the capture.
        seed: Of noise, places of sensors and losses.
        tracker: Its faults; a MotionStar's where None.
        sensors: Places of those that are worn.
        eye_tracker: Whether a head that is worn is recorded with where its eyes look (a sensor
            ``eyes``); else only the face is known.
        agent: Who performed; sex and all measures of the body where None.

    Raises:
        UnknownNameError: A place is none of the model's.
    """
    tracker, rng = tracker or Tracker(), np.random.default_rng(seed)
    mounts = strap_on(made.human, sensors, tracker, rng)
    streams = sense(made.human, made.times, made.motion, mounts, tracker, rng)
    worn = [_sensor(made, mounts[place], streams[place]) for place in sensors]
    things = [_thing(made, each, tracker, rng) for each in made.scene.things]
    heads = [_head(made, each) for each in worn if each.name == "head"]
    if eye_tracker and heads:  # drawn last, so that the others' noise does not depend on it
        worn.append(_eyes(made, tracker, rng))
    measures = {k: round(v, 4) for k, v in made.human.measures.values.items()}
    kind = "child" if made.human.measures.adult_share < 0.5 else made.human.measures.adult
    return Capture(
        name=name,
        sensors=tuple(worn),
        objects=(*heads, *things),
        agent=agent or Agent("performer", kind, {"age": made.human.measures.age, **measures}),
    )


def _holds(made: Performance, side: str) -> dict[str, Bool[np.ndarray, "frames"]]:
    """When a hand touches each thing: while it holds it, and nearby to within ``TOUCH_M``."""
    out: dict[str, np.ndarray] = {}
    for phase, (_, start, end) in zip(made.script, made.phases, strict=True):
        hand = phase.hand(side)
        if hand.does == "holds":
            now = (made.times >= start - 1e-9) & (made.times < end - 1e-9)
            for thing in (hand.thing, *hand.beside):
                out.setdefault(thing, np.zeros(len(made.times), dtype=bool))[now] = True
    return out


def _at_mouth(made: Performance, name: str) -> Bool[np.ndarray, "frames"]:
    thing = made.scene.thing(name)
    turn = made.things[name].rotation
    rim = -thing.shape.bounds[0, 0]
    mouth = made.human.sites(made.motion, ["mouth"])["mouth"][0]
    local = turn.inv().apply(mouth - made.things[name].translation)
    height = np.abs(local[:, 2] - thing.shape.bounds[1, 2])
    apart = np.hypot(np.linalg.norm(local[:, :2], axis=1) - rim, height)
    return np.asarray(apart < TOUCH_M)


def _moves(path: RigidTransform) -> Bool[np.ndarray, "frames"]:
    step = np.linalg.norm(np.diff(path.translation, axis=0), axis=1)
    turn = (path.rotation[1:] * path.rotation[:-1].inv()).magnitude()
    return np.append((step > 1e-9) | (turn > 1e-9), False)


def _intervals(made: Performance, holds: np.ndarray) -> list[tuple[float, float]]:
    return [
        (float(made.times[a]), float(made.times[b])) for a, b in geometry.runs(np.asarray(holds))
    ]


def _sensor(made: Performance, mount: Mount, stream: Stream) -> Sensor:
    """A worn sensor with the surface of what it is worn on, in its own frame."""
    side, _, part = mount.place.rpartition("_")
    seat = mount.pose.inv()
    if mount.place == "head":
        spots, _ = lines_of_sight(made.human, made.human.posture()[None])
        head = _standing_frame(made, "head")
        eye = seat.apply(head.inv().apply(spots[0]))
        ahead = seat.rotation.apply(head.rotation.inv().apply([1.0, 0.0, 0.0]))
        surface = _moved(segment_surface(made.human.measures, ("head",), "head"), seat)
        return Sensor(
            "head", "head", "none", "neck", stream, surface,
            Role.ATTENDS, _three(ahead), _three(eye),
        )  # fmt: skip
    shape = None
    if part == "hand":
        parts = tuple(f"{side}_{segment}" for segment in HAND_SEGMENTS)
        shape = _moved(segment_surface(made.human.measures, parts, f"{side}_hand"), seat)
    acts = part in {"hand", "foot"}
    link = f"{side}_{LINKS[part]}" if acts else f"{side}_{part}" if side else mount.place
    return Sensor(
        mount.place, part, side or "none", link, stream, shape, Role.ACTS if acts else Role.ATTENDS
    )


def _eyes(made: Performance, tracker: Tracker, rng: np.random.Generator) -> Sensor:
    """What an eye tracker on the head records: origin between the eyes, x along the sight."""
    spots, ways = lines_of_sight(made.human, made.motion)
    pose = RigidTransform.from_components(spots, _looking(ways))
    stream = recorded(made.times, pose, tracker, rng)
    return Sensor("eyes", "eyes", "none", "neck", stream, None, Role.ATTENDS)


def _looking(ways: Float[np.ndarray, "frames 3"]) -> Rotation:
    """Orientations whose x axis is a direction, level otherwise."""
    yaw = np.arctan2(ways[:, 1], ways[:, 0])
    pitch = np.arcsin(np.clip(-ways[:, 2], -1.0, 1.0))
    return Rotation.from_euler("ZY", np.stack([yaw, pitch], axis=1))


def _thing(made: Performance, name: str, tracker: Tracker, rng: np.random.Generator) -> TagObject:
    thing = made.scene.thing(name)
    fixed = thing.tag is TagType.FIXED
    faultless = Tracker(0.0, 0.0, 0.0, 0.0)
    stream = recorded(made.times, made.things[name], faultless if fixed else tracker, rng)
    return TagObject(
        name, thing.tag, stream, thing.shape, thing.kind or name, mass_kg=thing.mass_kg
    )


def _head(made: Performance, worn: Sensor) -> TagObject:
    return TagObject("head", TagType.SELF, worn.stream, worn.shape, "head")


def _standing_frame(made: Performance, segment: str) -> RigidTransform:
    origin = skeleton(made.human.measures)[segment].origin
    return RigidTransform.from_translation(origin)


def _moved(shape: Shape, pose: RigidTransform) -> Shape:
    return Shape(pose.apply(shape.vertices), np.array(shape.faces), description=shape.description)


def _three(vector: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(each) for each in vector)
    return x, y, z
