"""A first capture.toml from what files hold, for a person to edit."""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from extractors.readers.drafting.contents import Contents, Others, contents, others, world_points
from extractors.readers.drafting.floor import Floor, floor
from extractors.readers.drafting.frame_lines import EDIT as EDIT
from extractors.readers.drafting.frame_lines import Frame, frame_lines, frame_of
from extractors.readers.drafting.limb_sensors import LimbSensor, limb_sensors, mean_forward
from extractors.readers.drafting.stance import forwards, rightwards
from extractors.readers.drafting.tables import (
    FOOT_RADIUS_M,
    account_lines,
    agent_lines,
    floor_lines,
    limb_lines,
    nothing_lines,
    object_lines,
    quoted,
    sensor_lines,
)
from extractors.readers.name_guesses import end_effectors, limbs, side_of
from extractors.readers.recording import Recording
from extractors.readers.schema.names import constant_name


@dataclass(frozen=True)
class _Found:
    """A body or marker set, and where it is."""

    name: str
    file: str
    key: str
    """The line of TOML that names it."""

    shape: str = ""
    gaze: tuple[float, float, float] | None = None
    fixed: bool = False
    side: str = "none"


@dataclass(frozen=True, eq=False)
class _File:
    """One file with everything that is drafted of it."""

    key: str
    contents: Contents
    points: Mapping[str, Float[np.ndarray, "frames 3"]]
    """In the world: metres, z up."""

    sensors: Sequence[LimbSensor]
    others: Others


def draft(recordings: Sequence[Recording], folder: Path, name: str) -> str:
    """A commented capture.toml for files, with paths relative to a folder."""
    paths = _files(recordings, folder)
    held = [contents(each) for each in recordings]
    frame = frame_of(held)
    files = [_file(key, each, frame) for key, each in zip(paths, held, strict=True)]
    found = [body for each in files for body in _found(each)]
    of_limbs = limbs(each.name for each in found if not each.fixed)
    sensors = [each for each in found if each.name in of_limbs]
    ground = _floor(files, [each.name for each in sensors if of_limbs[each.name] == "foot"])
    lines = [f"name = {quoted(constant_name(name))}", *frame_lines(held, frame)]
    lines += [*_parts_lines(of_limbs), *_contact_lines(ground), "", "[files]"]
    lines += [f"{key} = {quoted(path)}" for key, path in paths.items()]
    subjects = [each for file in files for each in _subjects(file)]
    lines += agent_lines(subjects)
    for file in files:
        lines += account_lines(file.contents, file.sensors, file.others)
    used: set[str] = set()
    for file in files:
        for sensor in file.sensors:
            lines += limb_lines(sensor, file.key, file.contents.body, subjects, used)
    if not sensors and found and not any(file.sensors for file in files):
        lines += ["", f"{EDIT} no name tells of a hand, head or foot; the first body is taken."]
        sensors = found[:1]
    plain = [_plain(body, of_limbs) for body in sensors]
    for body, usual in zip(sensors, plain, strict=True):
        limb = of_limbs.get(body.name, "hand")
        own = usual if plain.count(usual) == 1 else body.name
        lines += sensor_lines(
            own, limb, body.side, body.file, body.key, body.shape, body.gaze, used
        )
    for body in [other for other in found if other not in sensors]:
        lines += object_lines(body.name, body.file, body.key, body.shape, used, fixed=body.fixed)
    if ground is not None:
        lines += floor_lines(ground, used)
    if not found and not any(file.sensors for file in files):
        lines += nothing_lines(recordings)
    return "\n".join(lines) + "\n"


def _plain(body: _Found, of_limbs: Mapping[str, str]) -> str:
    """``left_foot``, where side and limb are known; else the file's own name."""
    limb = of_limbs.get(body.name, "")
    if body.side != "none" and limb in {"hand", "foot"}:
        return f"{body.side}_{limb}"
    return limb if limb == "head" else body.name


def _files(recordings: Sequence[Recording], folder: Path) -> dict[str, str]:
    out: dict[str, str] = {}
    for recording in recordings:
        path = Path(recording.source.path)
        key = constant_name(path.name.split(".")[0])
        while key in out:
            key += "_2"
        out[key] = Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    return out


def _file(key: str, held: Contents, frame: Frame) -> _File:
    recording = held.recording
    points = world_points(recording, recording.unit_m or frame.unit_m, recording.up or frame.up)
    markers = {name: points[name] for name in recording.markers}
    body = {name: each for name, each in held.body.items() if name in markers}
    sensors = tuple(limb_sensors(markers, body))
    return _File(key, held, points, sensors, others(markers, body if sensors else {}))


def _subjects(file: _File) -> list[str]:
    named = list(dict.fromkeys(each.subject for each in file.sensors))
    return named if len(named) > 1 else []


def _parts_lines(of_limbs: Mapping[str, str]) -> list[str]:
    """What is done with several sensors on one hand or foot, where there are some."""
    ends = [(limb, side_of(name)) for name, limb in of_limbs.items()]
    if len(set(ends)) == len(ends):
        return []
    return ['parts = "together"              # each hand and foot is one; "apart" tells its parts']


def _contact_lines(ground: Floor | None) -> list[str]:
    """The tolerance that the floor needs; it comes before the tables."""
    if ground is None:
        return []
    spread = f"# feet stand at heights that differ by {ground.spread_m * 1e3:.0f} mm"
    return [spread, f"contact.tolerance_m = {ground.tolerance_m:g}"]


def _found(file: _File) -> list[_Found]:
    """Bodies and marker sets; of a skeleton only its end-effectors, for joints are no objects."""
    recording = file.contents.recording
    kinds = end_effectors(recording) if recording.parents else {}
    names = list(kinds or ({} if recording.parents else recording.bodies))
    names = names or list(recording.bodies)[:1]
    bodies = [
        _Found(
            name,
            file.key,
            f"body = {quoted(name)}",
            _shape(kinds.get(name, ""), recording, name),
            _gaze(file, name) if kinds.get(name) == "head" else None,
            side=_side(file, name),
        )
        for name in names
    ]
    return bodies + [
        _Found(
            name,
            file.key,
            f"markers = [{', '.join(map(quoted, members))}]",
            'shape = { box = "markers" }     # a stand-in: the box that the markers span',
            fixed=name in file.others.fixed,
            side=side_of(name),
        )
        for name, members in file.others.sets.items()
    ]


def _side(file: _File, name: str) -> str:
    """A body's side by its place on a skeleton, or by its name."""
    known = file.contents.body.get(name)
    return known.side if known is not None and known.side != "none" else side_of(name)


def _shape(limb: str, recording: Recording, name: str) -> str:
    """A stand-in for the feet of a skeleton: capsules to its next joints."""
    if limb != "foot" or name not in recording.parents.values():
        return ""
    return f'shape = {{ capsules = "children", radius_m = {FOOT_RADIUS_M:g} }}   # a stand-in'


def _gaze(file: _File, name: str) -> tuple[float, float, float] | None:
    """Forwards in the frame of a skeleton's head, whose axes are the file's own."""
    recording = file.contents.recording
    if not file.contents.body or recording.up is not None:
        return None
    ways = forwards(rightwards(file.points, file.contents.body))
    stream = recording.bodies[name]
    return mean_forward(stream.orientations, _in_file(file, ways))


def _in_file(file: _File, ways: Float[np.ndarray, "frames 3"]) -> Float[np.ndarray, "frames 3"]:
    """Directions of the world along the file's axes."""
    own, world = (
        np.stack([each[n] for n in file.contents.recording.bodies])
        for each in (
            {n: s.positions for n, s in file.contents.recording.bodies.items()},
            file.points,
        )
    )
    turn, *_ = np.linalg.lstsq(
        (world - world.mean(axis=(0, 1))).reshape(-1, 3),
        (own - own.mean(axis=(0, 1))).reshape(-1, 3),
        rcond=None,
    )
    out = ways @ turn
    return np.asarray(out / np.linalg.norm(out, axis=1, keepdims=True))


def _floor(files: Iterable[_File], feet_bodies: Sequence[str]) -> Floor | None:
    """The floor under the feet of all people in the first file that has feet."""
    for file in files:
        recording = file.contents.recording
        feet = {
            f"{each.subject}{each.side}": list(each.markers)
            for each in file.sensors
            if each.limb == "foot"
        }
        for name in feet_bodies:
            if name in recording.bodies:
                children = [n for n, parent in recording.parents.items() if parent == name]
                feet[name] = [name, *children]
        if feet and len(recording.times) > 1:
            rate_hz = 1.0 / float(np.median(np.diff(recording.times)))
            return floor(file.points, feet, rate_hz, FOOT_RADIUS_M)
    return None
