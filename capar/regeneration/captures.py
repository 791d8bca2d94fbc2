"""Captures: assumptions about a recording, its mirror image, and motions written out."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body import virtual_scenes
from capar.body.anthropometry import measures_of
from capar.body.human import Human
from capar.body.performing import Performance
from capar.body.recording import Truth, joined, record, write_bundle
from capar.body.scripts import SIDES
from capar.body.sensors import PERFECT, Tracker, places
from capar.body.shapes import segment_surface
from capar.body.skeleton import eyes_between
from capar.body.virtual_scenes import Thing, box
from capar.model.capture import Capture, Role, Sensor, Shape, Stream, TagObject, TagType
from capar.model.errors import CaparError, FileError
from capar.model.geometry import runs
from capar.regeneration.hand_overs import JointMotion
from capar.regeneration.motion import Motion
from capar.regeneration.scenes import Scene, check_keys, read_toml
from capar.regeneration.sources import HandAxes, Source
from capar.regeneration.stepping import Stepping


def capture_of(
    motion: Motion, *, name: str, agent: str, tracker: Tracker = PERFECT, seed: int = 0
) -> Capture:
    """What a tracker would have recorded of a motion; without faults, unless stated.

    Worn are sensors on head and acting hands, and what else the recorded performer wore.
    """
    plan = motion.plan
    made = Performance(
        human=plan.human, scene=virtual_scenes.Scene(plan.scene.things), script=(),
        times=np.array(plan.source.times), motion=motion.postures, things=plan.things,
        phases=(), gazes=plan.looks, looks=(), slip_m={},
    )  # fmt: skip
    hands = tuple(f"{side}_hand" for side in plan.hands)
    recorded = (each.name for each in plan.source.capture.sensors if each.name in places())
    worn = tuple(dict.fromkeys((*hands, "head", *recorded)))
    return record(
        made, name=name, seed=seed, tracker=tracker, sensors=worn, acting=hands, agent=agent
    )


def renamed(capture: Capture, names: Mapping[str, str]) -> Capture:
    """The capture with other names of its objects."""
    objects = tuple(replace(each, name=names.get(each.name, each.name)) for each in capture.objects)
    return replace(capture, objects=objects)


def scene_after(motion: Motion, names: Mapping[str, str], scene: Scene) -> Scene:
    """The scene as a motion leaves it."""
    plan = motion.plan
    left = dict(scene.things)
    for name, thing in plan.scene.things.items():
        own = names[name]
        ahead = plan.things[name].rotation[-1].apply([1.0, 0.0, 0.0])
        heading = float(np.arctan2(ahead[1], ahead[0]))
        x, y, z = (float(value) for value in plan.things[name].translation[-1])
        left[own] = replace(thing, name=own, place=(x, y, z), heading=heading)
    return replace(scene, things=left, place=plan.scene.place, heading=plan.scene.heading)


def write_motion(motion: Motion, capture: Capture, folder: Path) -> None:
    """Write a motion's capture as a bundle, with what was planned as the truth beside it."""
    write_bundle(capture, truth_of_motion(motion), folder)


def truth_of_motion(motion: Motion) -> Truth:
    """What was planned, as the truth of a motion."""
    source, times = motion.plan.source, motion.plan.source.times
    contacts = [(f"{h.side}_hand", h.thing, h.first, h.last) for h in source.holds]
    contacts += [(m.thing, m.part, m.first, m.last) for m in source.meetings]
    rows = sorted((one, two, float(times[a]), float(times[b])) for one, two, a, b in contacts)
    goals = motion.plan.goals.items()
    moves = tuple((n, float(times[g[0].frame]), float(times[g[-1].frame])) for n, g in goals)
    phases = tuple(
        (f"{each.ee}_{each.index}_{each.name}", float(times[each.first]), float(times[each.last]))
        for each in source.observation.segments
    )
    return Truth(tuple(rows), moves, phases, ())


LOCAL = np.diag([1.0, -1.0, 1.0])
"""How each body's own frame is mirrored, so that it stays right-handed."""

OTHER = {"right": "left", "left": "right"}


def mirrored(capture: Capture, place: tuple[float, float], heading: float) -> Capture:
    """The capture mirrored at the median plane of a performer, hands renamed.

    Args:
        capture: As it was recorded.
        place: Where the performer stands [m].
        heading: Which way the performer faces [rad].
    """
    normal = np.array([[-np.sin(heading), np.cos(heading), 0.0]])
    origin = np.array([[*place, 0.0]])

    def other(name: str) -> str:
        """``right_hand`` and ``hand_right`` for the other side."""
        return "_".join(OTHER.get(part, part) for part in name.split("_"))

    names = {sensor.name: other(sensor.name) for sensor in capture.sensors}
    sensors = tuple(
        replace(
            _reflected(sensor, origin, normal),
            name=names[sensor.name],
            side=OTHER.get(sensor.side, sensor.side),
            link=other(sensor.link),
            gaze=(sensor.gaze[0], -sensor.gaze[1], sensor.gaze[2]),
            eye=(sensor.eye[0], -sensor.eye[1], sensor.eye[2]),
            part_of=names.get(sensor.part_of, sensor.part_of),
        )
        for sensor in capture.sensors
    )
    pivots = tuple(
        replace(p, first=names.get(p.first, p.first), second=names.get(p.second, p.second))
        for p in capture.pivot_contacts
    )
    return replace(
        capture, sensors=sensors, pivot_contacts=pivots, purposes=(),
        objects=tuple(_reflected(each, origin, normal) for each in capture.objects),
        conventions={names.get(name, name): one for name, one in capture.conventions.items()},
    )  # fmt: skip


Body = TypeVar("Body", Sensor, TagObject)


def _reflected(
    body: Body, origins: Float[np.ndarray, "#frames 3"], normals: Float[np.ndarray, "#frames 3"]
) -> Body:
    """A body as a mirror shows it, which may be elsewhere at every frame.

    Its shape is mirrored in its own frame, so that the frame stays right-handed.
    """
    stream, shape = body.stream, body.shape
    planes = np.eye(3) - 2.0 * np.einsum("fi,fj->fij", normals, normals)
    spots = np.einsum("fij,fj->fi", planes, stream.positions - origins) + origins
    turns, known = np.full_like(stream.orientations, np.nan), ~stream.lost
    before = Rotation.from_quat(stream.orientations[known], scalar_first=True).as_matrix()
    planes = np.broadcast_to(planes, (len(known), 3, 3))
    turned = Rotation.from_matrix(planes[known] @ before @ LOCAL)
    turns[known] = turned.as_quat(scalar_first=True)
    if shape is not None:
        vertices, faces = np.array(shape.vertices) @ LOCAL, np.array(shape.faces)[:, ::-1]
        shape = Shape(vertices, faces, shape.source, shape.description)
    return replace(body, stream=Stream(np.array(stream.times), spots, turns), shape=shape)


KEYS = {"from_s", "to_s", "performer", "mirrored", "assumed_size", "hand"}
PERFORMER_KEYS = {"kind", "stature_m", "place", "heading_deg", "floor_m"}
HAND_KEYS = ("fingers", "palm")


@dataclass(frozen=True)
class Completion:
    """What is assumed of a recording that does not say it."""

    from_s: float = 0.0
    to_s: float = np.inf
    """What is kept of it [s]."""

    kind: str = ""
    """``man``, ``woman`` or ``child``; empty where the capture says it."""

    stature_m: float | None = None
    place: tuple[float, float] | None = None
    """Where the performer stands [m]; None where a head that begins upright says it."""

    heading_deg: float = 0.0
    """Which way the performer faces there, from x towards y."""

    floor_m: float = 0.0
    """Height of the floor [m]."""

    mirrored: Mapping[str, str] = field(default_factory=dict)
    """Hands without a sensor (``left_hand``), and the object in whose middle plane each is the
    other hand's mirror image."""

    sizes: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Other lengths along x and y of objects whose size the capture only assumes [m]."""

    axes: Mapping[str, HandAxes] = field(default_factory=dict)
    """Which way the hands with a sensor point and face in its frame, by side."""

    @property
    def stance(self) -> tuple[tuple[float, float], float] | None:
        """Where the performer stands [m] and faces [rad]; None where the head says it."""
        return None if self.place is None else (self.place, float(np.radians(self.heading_deg)))

    @property
    def notes(self) -> tuple[str, ...]:
        """What is assumed, in words."""
        out = [f"{hand!r} mirrors the other at {thing!r}" for hand, thing in self.mirrored.items()]
        out += [f"{thing!r} is {x:.2f} x {y:.2f} m" for thing, (x, y) in self.sizes.items()]
        out += [
            f"the {side} hand's fingers point to {fingers} and its palm faces {palm}"
            for side, (fingers, palm) in self.axes.items()
        ]
        if self.place is not None:
            x, y = self.place
            out.insert(
                0, f"the performer stands at ({x:.2f}, {y:.2f}) m, {self.heading_deg:.0f} deg"
            )
        if self.floor_m:
            out.insert(0, f"the floor is at {self.floor_m:.2f} m")
        if self.stature_m is not None:
            out.insert(0, f"a {self.kind or 'person'} of {self.stature_m:.2f} m was recorded")
        if self.from_s > 0.0 or np.isfinite(self.to_s):
            out.insert(0, f"only {self.from_s:g} to {self.to_s:g} s of the recording")
        return tuple(f"assumed: {text}" for text in out)


def read_completion(path: Path) -> Completion:
    """What a TOML file states of a recording.

    ``from_s`` and ``to_s``; ``[performer]`` with ``kind``, ``stature_m``, ``place``,
    ``heading_deg`` and ``floor_m``; ``[mirrored]`` with ``left_hand = "OBJECT"``;
    ``[assumed_size]`` with ``OBJECT = [X, Y]`` of objects whose size is assumed in the capture [m];
    ``[hand.right]`` and ``[hand.left]`` with ``fingers`` and ``palm``, directions [X, Y, Z] in the
    frame of the hand's sensor.

    Raises:
        FileError: The file cannot be read, or says something else.
    """
    table = read_toml(path, KEYS)
    performer, mirrored, sizes, hand = (
        _table(path, table, name) for name in ("performer", "mirrored", "assumed_size", "hand")
    )
    check_keys(path, "[performer]", performer, PERFORMER_KEYS)
    check_keys(path, "[hand]", hand, set(OTHER))
    try:
        axes: dict[str, HandAxes] = {}
        for side in hand:
            row = _table(path, hand, side)
            check_keys(path, f"[hand.{side}]", row, set(HAND_KEYS))
            fingers, palm = (np.array([float(x) for x in row[name]]) for name in HAND_KEYS)
            for direction in (fingers, palm):
                if direction.shape != (3,) or not np.linalg.norm(direction) > 0.0:
                    raise ValueError(f"{direction.tolist()} is no direction [x, y, z]")
            axes[side] = fingers, palm
        place = performer.get("place")
        return Completion(
            from_s=float(table.get("from_s", 0.0)),
            to_s=float(table.get("to_s", np.inf)),
            kind=str(performer.get("kind", "")),
            stature_m=float(performer["stature_m"]) if "stature_m" in performer else None,
            place=None if place is None else (float(place[0]), float(place[1])),
            heading_deg=float(performer.get("heading_deg", 0.0)),
            floor_m=float(performer.get("floor_m", 0.0)),
            mirrored={str(hand): str(thing) for hand, thing in mirrored.items()},
            sizes={n: (float(s[0]), float(s[1])) for n, s in sizes.items()},
            axes=axes,
        )
    except KeyError as error:
        raise FileError(path, f"[hand] lacks {error}.", "State both fingers and palm.") from None
    except (TypeError, ValueError, IndexError) as error:
        raise FileError(path, f"{error}.", "Numbers are needed, and place = [x, y].") from None


def completed(capture: Capture, completion: Completion) -> Capture:
    """The capture with what is assumed of it.

    Raises:
        CaparError: It contradicts the capture, or leaves nothing of it.
    """
    agent = capture.agent
    if completion.kind:
        agent = replace(agent, kind=completion.kind)
    if completion.stature_m is not None:
        agent = replace(agent, measures={**agent.measures, "stature": completion.stature_m})
    made = replace(_cut(capture, completion.from_s, completion.to_s), agent=agent)
    for name, size in completion.sizes.items():
        thing = capture.tag_object(name)
        if not thing.assumed or thing.shape is None:
            known = ", ".join(o.name for o in capture.objects if o.assumed)
            raise CaparError(
                f"the size of {name!r} is recorded; [assumed_size] is for "
                f"{known or 'nothing in this capture'}"
            )
        middle = thing.shape.bounds.mean(axis=0)
        factors = np.array([*size, thing.shape.size[2]]) / thing.shape.size
        vertices = (np.array(thing.shape.vertices) - middle) * factors + middle
        shape = replace(thing.shape, vertices=vertices)
        objects = (replace(o, shape=shape) if o.name == name else o for o in made.objects)
        made = replace(made, objects=tuple(objects))
    sensors = list(made.sensors)
    if completion.place is not None and not any(s.end_effector == "head" for s in sensors):
        sensors.append(_head(made, completion))
    for hand, thing_name in completion.mirrored.items():
        sensors.append(_mirrored_hand(made, hand, thing_name, completion.heading_deg))
    return replace(made, sensors=tuple(sensors))


def _cut(capture: Capture, from_s: float, to_s: float) -> Capture:
    """The part of a capture between two times, which begins at 0 s."""
    kept = (capture.times >= from_s) & (capture.times <= to_s)
    if kept.all():
        return capture
    if kept.sum() < 2:
        raise CaparError(
            f"nothing of {capture.name!r} is between {from_s:g} and {to_s:g} s; it lasts "
            f"{capture.times[-1]:.2f} s"
        )

    def cut(body: Body) -> Body:
        stream, times = body.stream, body.stream.times[kept]
        part = Stream(times - times[0], stream.positions[kept], stream.orientations[kept])
        return replace(body, stream=part)

    return replace(
        capture, sensors=tuple(map(cut, capture.sensors)), objects=tuple(map(cut, capture.objects))
    )


def _head(capture: Capture, completion: Completion) -> Sensor:
    """A head without a sensor: above where the performer stands, still, looking level ahead."""
    assert completion.place is not None
    human = Human.of(measures_of(capture.agent))
    turn = Rotation.from_euler("z", completion.heading_deg, degrees=True)
    eyes = np.array([*completion.place, completion.floor_m]) + turn.apply(
        eyes_between(human.measures)
    )
    frames = len(capture.times)
    quaternion = turn.as_quat(scalar_first=True)
    spots, turns = (np.tile(row, (frames, 1)) for row in (eyes, quaternion))
    stream = Stream(np.array(capture.times), spots, turns)
    return Sensor("head", "head", "none", "neck", stream, role=Role.ATTENDS)


def _mirrored_hand(capture: Capture, hand: str, thing: str, heading_deg: float) -> Sensor:
    """The other hand's mirror image in the middle plane of an object, which moves with it."""
    side = hand.partition("_")[0]
    seen = OTHER.get(side, "")
    known = [s for s in capture.acting if s.end_effector == "hand" and s.side == seen]
    if not known or any(sensor.name == hand for sensor in capture.sensors):
        raise CaparError(
            f"{hand!r} cannot be mirrored: it is left_hand or right_hand, has no sensor itself, "
            f"and the other hand has one; there are {[s.name for s in capture.sensors]}"
        )
    (sensor, *_), body = known, capture.tag_object(thing)
    if body.shape is None:
        raise CaparError(f"object {thing!r} has no shape whose middle plane is known")
    stream, frames = body.stream, np.arange(len(body.stream.times))
    known_frames = np.flatnonzero(~stream.lost)
    spots, quaternions = (  # the lost ones between known ones
        np.stack([np.interp(frames, known_frames, c[known_frames]) for c in rows.T], axis=1)
        for rows in (stream.positions, stream.orientations)
    )
    turns = Rotation.from_quat(quaternions, scalar_first=True)
    middle = spots + turns.apply(body.shape.bounds.mean(axis=0))
    heading = np.radians(heading_deg)
    local = turns[0].inv().apply([-np.sin(heading), np.cos(heading), 0.0])
    normal = turns.apply(np.eye(3)[int(np.argmax(np.abs(local)))])
    link = sensor.link.replace(seen, side)
    return replace(_reflected(sensor, middle, normal), name=hand, side=side, link=link)


def _table(path: Path, table: Mapping[str, Any], name: str) -> dict[str, Any]:
    found = table.get(name, {})
    if not isinstance(found, dict):
        raise FileError(path, f"{name} is no table.", f"Write [{name}].")
    return found


def joint_capture_of(made: JointMotion, *, name: str) -> Capture:
    """What a tracker would have recorded, its sensors called as in the recording."""
    captures = {
        who: capture_of(motion, name=name, agent=who) for who, motion in made.motions.items()
    }
    return joined(captures, {who: _names(one) for who, one in made.source.sources.items()})


def _names(source: Source) -> dict[str, str]:
    """What a performer's sensors were called in the recording."""
    names = {f"{side}_hand": hand.sensor for side, hand in source.hands.items()}
    ends = {sensor.end_effector: sensor.name for sensor in reversed(source.capture.sensors)}
    return {**names, "head": ends["head"], "eyes": ends.get("eyes", f"{ends['head']}_eyes")}


def write_joint_motion(made: JointMotion, capture: Capture, folder: Path) -> None:
    """Write the motions' capture as a bundle, with what was planned as the truth beside it."""
    truths = []
    for who, motion in made.motions.items():
        names, truth = _names(made.source.sources[who]), truth_of_motion(motion)
        rows = [(names.get(a, a), names.get(b, b), t, u) for a, b, t, u in truth.contacts]
        truths.append(replace(truth, contacts=tuple(rows)))
    contacts = tuple(sorted({row for truth in truths for row in truth.contacts}))
    first = truths[0]
    write_bundle(capture, Truth(contacts, first.motions, first.phases, first.looks), folder)


FLOOR_M = (6.0, 6.0, 0.02)
"""How long, wide and thick the floor is of which a capture of steps consists besides [m]."""

AHEAD_M = 3.0  # How far ahead it is looked at [m].


def capture_of_steps(made: Stepping, *, name: str, agent: str) -> Capture:
    """What a tracker would have recorded of steps; the floor is an object of it."""
    human, scene, count = made.human, made.scene, len(made.times)
    ground = Thing(
        "floor", box(*FLOOR_M), (*scene.place, scene.floor_m - FLOOR_M[2]), tag=TagType.FIXED
    )
    there = virtual_scenes.Scene({**scene.things, ground.name: ground})
    paths = {n: RigidTransform.concatenate([t.pose] * count) for n, t in there.things.items()}
    ahead = AHEAD_M * np.array([np.cos(scene.heading), np.sin(scene.heading)])
    looks = np.column_stack([made.postures[:, :2] + ahead, np.full(count, scene.floor_m)])
    moved = Performance(
        human=human, scene=there, script=(), times=made.times, motion=made.postures, things=paths,
        phases=(), gazes=looks, looks=(), slip_m={},
    )  # fmt: skip
    worn = tuple(f"{side}_{part}" for part in ("hand", "foot") for side in SIDES)
    capture = record(
        moved, name=name, seed=0, tracker=PERFECT, sensors=(*worn, "head"), eye_tracker=False,
        agent=agent,
    )  # fmt: skip
    sensors = []
    for sensor in capture.sensors:
        if sensor.end_effector == "foot":  # with the surface of the foot, in the sensor's frame
            names = (f"{sensor.side}_foot", f"{sensor.side}_toes")
            surface = segment_surface(human.measures, names, names[0])
            vertices = np.array(surface.vertices) - human.model.site(f"sensor_{names[0]}").pos
            shape = Shape(vertices, np.array(surface.faces), description="foot")
            sensors.append(replace(sensor, shape=shape))
        else:
            sensors.append(sensor)
    return replace(capture, sensors=tuple(sensors))


def write_steps(made: Stepping, capture: Capture, folder: Path) -> None:
    """Write a capture of steps as a bundle, with when feet stand as the truth beside it."""
    contacts = [
        (f"{side}_foot", "floor", float(made.times[first]), float(made.times[last]))
        for side, bears in made.bears.items()
        for first, last in runs(bears)
    ]
    write_bundle(capture, Truth(tuple(sorted(contacts)), (), (), ()), folder)
