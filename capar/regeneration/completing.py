"""What a recording leaves open and a user states: a span, the stance, a hand that has no sensor."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import measures_of
from capar.body.human import Human
from capar.model.capture import Capture, Role, Sensor, Stream
from capar.model.errors import CaparError, FileError
from capar.model.geometry import transforms
from capar.regeneration.hand_frames import HandAxes
from capar.regeneration.mirroring import LOCAL, OTHER, mirrored_shape
from capar.regeneration.sources import eyes_in_body

KEYS = {"from_s", "to_s", "performer", "mirrored", "assumed_size", "hand"}
PERFORMER_KEYS = {"kind", "stature_m", "place", "heading_deg", "floor_m"}
HAND_KEYS = {"fingers", "palm"}


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
    """Other lengths along x and y of things whose size the capture only assumes [m]."""

    axes: Mapping[str, HandAxes] = field(default_factory=dict)
    """Which way the hands with a sensor point and face in its frame, by side."""

    @property
    def stance(self) -> tuple[tuple[float, float], float] | None:
        """Where the performer stands [m] and faces [rad]; None where the head says it."""
        return None if self.place is None else (self.place, float(np.radians(self.heading_deg)))

    @property
    def notes(self) -> tuple[str, ...]:
        """What is assumed, in sentences."""
        out = []
        if self.from_s > 0.0 or np.isfinite(self.to_s):
            out.append(f"assumed: only {self.from_s:g} to {self.to_s:g} s of the recording")
        if self.stature_m is not None:
            out.append(f"assumed: a {self.kind or 'person'} of {self.stature_m:.2f} m was recorded")
        if self.floor_m:
            out.append(f"assumed: the floor is at {self.floor_m:.2f} m")
        if self.place is not None:
            x, y = self.place
            out.append(
                f"assumed: the performer stands at ({x:.2f}, {y:.2f}) m, facing "
                f"{self.heading_deg:.0f} degrees"
            )
        for hand, thing in self.mirrored.items():
            out.append(
                f"assumed: {hand!r} has no sensor and is the other hand's mirror image in the "
                f"middle plane of {thing!r}"
            )
        for thing, (x, y) in self.sizes.items():
            out.append(f"assumed: {thing!r} is {x:.2f} x {y:.2f} m")
        for side, axes in self.axes.items():
            out.append(
                f"assumed: in its sensor's frame the {side} hand's fingers point to "
                f"{_told(axes.fingers)} and its palm faces {_told(axes.palm)}"
            )
        return tuple(out)


def read_completion(path: Path) -> Completion:
    """What a TOML file states of a recording.

    ``from_s`` and ``to_s``; ``[performer]`` with ``kind``, ``stature_m``, ``place``,
    ``heading_deg`` and ``floor_m``; ``[mirrored]`` with ``left_hand = "OBJECT"``;
    ``[assumed_size]`` with ``OBJECT = [X, Y]`` of things whose size is assumed in the capture [m];
    ``[hand.right]`` and ``[hand.left]`` with ``fingers`` and ``palm``, directions [X, Y, Z] in the
    frame of the hand's sensor.

    Raises:
        FileError: The file cannot be read, or says something else.
    """
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileError(path, f"is no TOML: {error}.", "See `capar regenerate --help`.") from None
    performer = _table(path, table, "performer")
    mirrored, sizes = (_table(path, table, name) for name in ("mirrored", "assumed_size"))
    _check_keys(path, "the file", table, KEYS)
    _check_keys(path, "[performer]", performer, PERFORMER_KEYS)
    hands = {
        side: _table(path, _table(path, table, "hand"), side) for side in table.get("hand", {})
    }
    _check_keys(path, "[hand]", hands, set(OTHER))
    for side, row in hands.items():
        _check_keys(path, f"[hand.{side}]", row, HAND_KEYS)
    try:
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
            axes={side: _axes(row) for side, row in hands.items()},
        )
    except KeyError as error:
        raise FileError(path, f"[hand] lacks {error}.", "State both fingers and palm.") from None
    except (TypeError, ValueError, IndexError) as error:
        raise FileError(path, f"{error}.", "Numbers are needed, and place = [x, y].") from None


def _axes(row: Mapping[str, Any]) -> HandAxes:
    fingers, palm = (np.array([float(x) for x in row[name]]) for name in ("fingers", "palm"))
    for direction in (fingers, palm):
        if direction.shape != (3,) or not np.linalg.norm(direction) > 0.0:
            raise ValueError(f"{direction.tolist()} is no direction [x, y, z]")
    return HandAxes(fingers, palm)


def _told(direction: Float[np.ndarray, "3"]) -> str:
    return "(" + ", ".join(f"{x:g}" for x in direction) + ")"


def completed(capture: Capture, completion: Completion) -> Capture:
    """The capture with what is assumed of it.

    Raises:
        CaparError: It contradicts the capture, or leaves nothing of it.
    """
    made = _cut(capture, completion.from_s, completion.to_s)
    agent = made.agent
    if completion.kind:
        agent = replace(agent, kind=completion.kind)
    if completion.stature_m is not None:
        agent = replace(agent, measures={**agent.measures, "stature": completion.stature_m})
    made = replace(made, agent=agent)
    for name, size in completion.sizes.items():
        made = _sized(made, name, size)
    sensors = list(made.sensors)
    if completion.place is not None and not any(s.end_effector == "head" for s in sensors):
        sensors.append(_head(made, completion))
    for hand, thing in completion.mirrored.items():
        sensors.append(_mirrored_hand(made, hand, thing, completion.heading_deg))
    return replace(made, sensors=tuple(sensors))


def _sized(capture: Capture, name: str, size: tuple[float, float]) -> Capture:
    thing = capture.tag_object(name)
    if not thing.assumed or thing.shape is None:
        raise CaparError(
            f"the size of {name!r} is recorded; [assumed_size] is for {_assumed(capture)}"
        )
    middle = thing.shape.bounds.mean(axis=0)
    factors = np.array([*size, thing.shape.size[2]]) / thing.shape.size
    vertices = (np.array(thing.shape.vertices) - middle) * factors + middle
    shape = replace(thing.shape, vertices=vertices)
    objects = (replace(o, shape=shape) if o.name == name else o for o in capture.objects)
    return replace(capture, objects=tuple(objects))


def _assumed(capture: Capture) -> str:
    return ", ".join(o.name for o in capture.objects if o.assumed) or "nothing in this capture"


def _cut(capture: Capture, from_s: float, to_s: float) -> Capture:
    kept = (capture.times >= from_s) & (capture.times <= to_s)
    if kept.all():
        return capture
    if kept.sum() < 2:
        raise CaparError(
            f"nothing of {capture.name!r} is between {from_s:g} and {to_s:g} s; it lasts "
            f"{capture.times[-1]:.2f} s"
        )
    return replace(
        capture,
        sensors=tuple(replace(s, stream=_cut_stream(s.stream, kept)) for s in capture.sensors),
        objects=tuple(replace(o, stream=_cut_stream(o.stream, kept)) for o in capture.objects),
    )


def _cut_stream(stream: Stream, kept: np.ndarray) -> Stream:
    times = stream.times[kept]
    return Stream(times - times[0], stream.positions[kept], stream.orientations[kept])


def _head(capture: Capture, completion: Completion) -> Sensor:
    """A head without a sensor: above where the performer stands, still, looking level ahead."""
    assert completion.place is not None
    human = Human.of(measures_of(capture.agent))
    turn = Rotation.from_euler("z", completion.heading_deg, degrees=True)
    eyes = np.array([*completion.place, completion.floor_m]) + turn.apply(eyes_in_body(human))
    frames = len(capture.times)
    quaternion = turn.as_quat(scalar_first=True)
    spots, turns = (np.tile(row, (frames, 1)) for row in (eyes, quaternion))
    stream = Stream(np.array(capture.times), spots, turns)
    return Sensor("head", "head", "none", "neck", stream, role=Role.ATTENDS)


def _mirrored_hand(capture: Capture, hand: str, thing: str, heading_deg: float) -> Sensor:
    """The other hand's mirror image in the middle plane of a thing, which moves with it."""
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
    turns = Rotation.from_quat(_filled(body.stream.orientations), scalar_first=True)
    middle = _filled(body.stream.positions) + turns.apply(body.shape.bounds.mean(axis=0))
    heading = np.radians(heading_deg)
    left = np.array([-np.sin(heading), np.cos(heading), 0.0])
    local = turns[0].inv().apply(left)
    normal = turns.apply(np.eye(3)[int(np.argmax(np.abs(local)))])
    return replace(
        sensor,
        name=hand,
        side=side,
        link=sensor.link.replace(seen, side),
        stream=_reflected(sensor.stream, middle, normal),
        shape=mirrored_shape(sensor.shape),
    )


def _reflected(
    stream: Stream, origins: Float[np.ndarray, "frames 3"], normals: Float[np.ndarray, "frames 3"]
) -> Stream:
    """A stream as a mirror shows it that may be elsewhere at every frame."""
    planes = np.eye(3) - 2.0 * np.einsum("fi,fj->fij", normals, normals)
    spots = np.einsum("fij,fj->fi", planes, stream.positions - origins) + origins
    turns = np.full_like(stream.orientations, np.nan)
    known = ~stream.lost
    poses = transforms(np.zeros((int(known.sum()), 3)), stream.orientations[known])
    turned = Rotation.from_matrix(planes[known] @ poses.rotation.as_matrix() @ LOCAL)
    turns[known] = turned.as_quat(scalar_first=True)
    return Stream(np.array(stream.times), spots, turns)


def _filled(rows: Float[np.ndarray, "frames columns"]) -> Float[np.ndarray, "frames columns"]:
    """The rows with the lost ones between known ones."""
    frames = np.arange(len(rows))
    known = np.flatnonzero(~np.isnan(rows[:, 0]))
    return np.stack([np.interp(frames, known, column[known]) for column in rows.T], axis=1)


def _table(path: Path, table: Mapping[str, Any], name: str) -> dict[str, Any]:
    found = table.get(name, {})
    if not isinstance(found, dict):
        raise FileError(path, f"{name} is no table.", f"Write [{name}].")
    return found


def _check_keys(path: Path, where: str, row: Mapping[str, Any], known: set[str]) -> None:
    for key in row:
        if key not in known:
            raise FileError(
                path, f"unknown key {key!r} in {where}.", f"There are: {', '.join(sorted(known))}."
            )
