"""A first capture.toml from what files hold, for a person to edit."""

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from extractors.readers.drafting.contents import (
    STATURE_M,
    USUAL_STATURE_M,
    Contents,
    Floor,
    LimbSensor,
    Others,
    Points,
    contents,
    floor,
    forwards,
    limb_sensors,
    mean_forward,
    others,
    rightwards,
    usual_units_m,
    world_points,
)
from extractors.readers.names import (
    BodyName,
    constant_name,
    end_effectors,
    limbs,
    side_of,
    without_side,
)
from extractors.readers.recording import UNITS, Recording

EDIT = "# EDIT:"
"""What marks a line that a person must look at."""

FOOT_RADIUS_M = 0.03  # Radius of a foot's stand-in: half the thickness of a foot [m].
HAND_RADIUS_M = 0.04
HEAD_RADIUS_M = 0.1
PALM_SHARE = (
    0.37  # How far ahead of the wrist a palm's middle is [share of the forearm] (Winter 2009).
)
FLOOR_M = 0.02  # Thickness of a floor [m].
WIDTH = 96  # Comments are no longer than this.


@dataclass(frozen=True)
class _Body:
    """A body or marker set, and where it is."""

    name: str
    file: str
    key: str
    """The line of TOML that names it."""

    side: str
    shape: str = ""
    gaze: tuple[float, float, float] | None = None
    fixed: bool = False


@dataclass(frozen=True, eq=False)
class _File:
    """One file with everything that is drafted of it."""

    key: str
    recording: Recording
    body: Mapping[str, BodyName]
    points: Points
    """In the world: metres, z up."""

    sensors: Sequence[LimbSensor]
    others: Others


def draft(recordings: Sequence[Recording], folder: Path, name: str) -> str:
    """A commented capture.toml for files, with paths relative to a folder."""
    held = [contents(each) for each in recordings]
    unit_m, up, frame_lines = _frame(held)
    paths: dict[str, str] = {}
    files: list[_File] = []
    for each in held:
        path = Path(each.recording.source.path)
        key = _free_name(path.name.split(".")[0], paths)
        paths[key] = Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
        recording = each.recording
        points = world_points(recording, recording.unit_m or unit_m, recording.up or up)
        markers = {name: points[name] for name in recording.markers if not _owned(recording, name)}
        body = {name: known for name, known in each.body.items() if name in markers}
        sensors = tuple(limb_sensors(markers, body))
        rest = others(markers, body if sensors else {})
        files.append(_File(key, recording, each.body, points, sensors, rest))
    found = [body for file in files for body in _bodies(file)]
    of_limbs = limbs(each.name for each in found if not each.fixed)
    ground = _floor(files, [name for name, limb in of_limbs.items() if limb == "foot"])
    lines = [f"name = {quoted(constant_name(name))}", *frame_lines]
    if len({(limb, side_of(name)) for name, limb in of_limbs.items()}) != len(of_limbs):
        lines.append('parts = "together"   # each hand and foot is one; "apart" keeps its parts')
    if ground is not None:
        lines.append(f"# feet stand at heights that differ by {ground.spread_m * 1e3:.0f} mm")
        lines.append(f"contact.tolerance_m = {ground.tolerance_m:g}")
    lines += ["", "[files]", *(f"{key} = {quoted(path)}" for key, path in paths.items())]
    subjects: list[str] = []
    for file in files:
        named = list(dict.fromkeys(each.subject for each in file.sensors))
        subjects += named if len(named) > 1 else []
    for subject in subjects:
        lines += _table("agent", name=quoted(constant_name(subject or "agent")))
    for file in files:
        lines += _account_lines(file)
    used: set[str] = set()
    for file in files:
        for sensor in file.sensors:
            lines += _limb_lines(sensor, file, subjects, used)
    lines += _body_tables(files, found, of_limbs, used)
    if ground is not None:
        lines += _floor_lines(ground, used)
    if not found and not any(file.sensors for file in files):
        names = ", ".join(name for each in recordings for name in each.names)
        lines += [
            "",
            f"{EDIT} no three markers keep their distances. Say which are one body:",
            f"# the files hold: {names}",
            "# [[sensor]]",
            '# name = "right_hand"',
            '# end_effector = "hand"',
            '# markers = ["...", "...", "..."]',
        ]
    return "\n".join(lines) + "\n"


def _owned(recording: Recording, marker: str) -> bool:
    """Whether a marker is of a body or skeleton that is in the file too: ``Mug:Marker1``."""
    owner, colon, _ = marker.partition(":")
    return bool(colon) and any(each.partition(":")[0] == owner for each in recording.bodies)


def _frame(held: Sequence[Contents]) -> tuple[float, str, list[str]]:
    """The unit [m] and axis of files that do not state them, and the lines that say so.

    They are those that make people of the bodies in the files.
    """
    first = next((each for each in held if each.standing), None)
    lines, person = [], first.standing if first else None
    unit_m, unit = 1.0, f'"m"   {EDIT} {", ".join(UNITS)}, or metres per unit'
    if first is not None and person is not None:
        parts = " and ".join(person.parts)
        why = f"# by how high {parts} are, the person is {person.height:.4g} tall"
        usual = [metres for metres in usual_units_m(first.body) if person.is_persons(metres)]
        if person.unit:
            unit_m, unit = UNITS[person.unit], quoted(person.unit)
            why += f": {person.height * unit_m:.2f} m if the unit is {person.unit}"
        elif usual:
            unit_m, unit = usual[0], f"{usual[0]:g}"
            why += f": {person.height * unit_m:.2f} m in the usual unit of files with such names"
        else:
            unit_m = USUAL_STATURE_M / person.height
            unit = f"{unit_m:.4g}   {EDIT} metres per unit, for an adult"
            why += f", which is {STATURE_M[0]:g} to {STATURE_M[1]:g} m in no usual unit"
        lines.append(why)
    beside = next((each.beside for each in held if each.beside), None)
    if person is not None and person.clear:
        up, why = person.up, "# from the body's lower parts to its upper ones"
    elif beside is not None:
        up = "z" if beside == "y" else "y"
        why = f"# left and right lie along {beside}, and files have y or z up"
    else:
        up = person.up if person else "z"
        why = f"{EDIT} the axis that points up: x, y or z"
    lines = [*lines, f"unit = {unit}"] if any(e.recording.unit_m is None for e in held) else []
    for each in held:
        stated_m, body = each.recording.unit_m, each.standing
        if stated_m is not None and body is not None and not body.is_persons(stated_m):
            likely = (
                body.unit and f"; {body.unit} would make it {body.height * UNITS[body.unit]:.2f} m"
            )
            lines.append(
                f"{EDIT} by the unit that {Path(each.recording.source.path).name} states, the "
                f"person is {body.height * stated_m:.3g} m tall{likely}"
            )
    if any(each.recording.up is None for each in held):
        lines.append(f'up = "{up}"   {why}')
    lines.append('handedness = "right"   # "left" if the world is mirrored')
    if len(held) > 1:
        step_s = min(float(np.diff(each.recording.times[:2])[0]) for each in held)
        lines.append(f"rate_hz = {1.0 / step_s:.4g}   # every stream is brought to this")
    return unit_m, up, lines


def _bodies(file: _File) -> Iterator[_Body]:
    """Bodies and marker sets; of a skeleton only its end-effectors, for joints are no objects.

    Beside bodies of unknown shape a skeleton's hands have no stand-in: it is shown by how they are
    carried where those touch.
    """
    recording = file.recording
    kinds = end_effectors(recording) if recording.parents else {}
    joints = {*recording.parents, *recording.parents.values()}
    names = [name for name in recording.bodies if name in kinds or name not in joints]
    props = any(name not in kinds for name in names)
    for name in names or list(recording.bodies)[:1]:
        side = file.body[name].side if name in file.body else "none"
        yield _Body(
            name,
            file.key,
            f"body = {quoted(name)}",
            side if side != "none" else side_of(name),
            "" if props else _stand_in(file, name, kinds.get(name, "")),
            _gaze(file, name) if kinds.get(name) == "head" else None,
        )
    for name, members in file.others.sets.items():
        shape = '{ box = "markers" }   # a stand-in: the box that the markers span'
        fixed = name in file.others.fixed
        key = f"markers = {_listed(members)}"
        yield _Body(name, file.key, key, side_of(name), shape, fixed=fixed)


def _stand_in(file: _File, name: str, limb: str) -> str:
    """A rough shape of a skeleton's hand, foot or head, in its joint's frame; empty if unknown.

    It is around the bones that are there; else before the end of the forearm, or above the neck.
    """
    parent = file.recording.parents.get(name, "")
    radius_m = {"foot": FOOT_RADIUS_M, "hand": HAND_RADIUS_M, "head": HEAD_RADIUS_M}.get(limb)
    if radius_m is None or not parent:
        return ""
    if limb != "head" and name in file.recording.parents.values():
        return f'{{ capsules = "children", radius_m = {radius_m:g} }}   # a stand-in'
    bone = file.points[name] - file.points[parent]
    lengths = np.linalg.norm(bone, axis=1)
    ahead_m = PALM_SHARE * float(np.nanmedian(lengths)) if limb == "hand" else radius_m
    where = _in_joint(file, name, bone)
    if where is None or limb == "foot":
        return ""
    place = [round(ahead_m * each, 3) + 0.0 for each in where]
    return f"{{ sphere = {radius_m:g}, position = {place} }}   # a stand-in"


def _gaze(file: _File, name: str) -> tuple[float, float, float] | None:
    """Forwards in the frame of a skeleton's head, whose axes are the file's own."""
    if not file.body or file.recording.up is not None:
        return None
    return _in_joint(file, name, forwards(rightwards(file.points, file.body)))


def _in_joint(
    file: _File, name: str, directions: Float[np.ndarray, "frames 3"]
) -> tuple[float, float, float] | None:
    """The mean of directions in the world as one in the frame of a skeleton's joint."""
    recording = file.recording
    own = np.stack([each.positions for each in recording.bodies.values()])
    world = np.stack([file.points[each] for each in recording.bodies])
    turn, *_ = np.linalg.lstsq(
        (world - world.mean(axis=(0, 1))).reshape(-1, 3),
        (own - own.mean(axis=(0, 1))).reshape(-1, 3),
        rcond=None,
    )
    ahead = directions @ turn
    with np.errstate(invalid="ignore"):
        ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    return mean_forward(recording.bodies[name].orientations, ahead)


def _floor(files: Iterable[_File], feet_bodies: Sequence[str]) -> Floor | None:
    """The floor under the feet of all people in the first file that has feet."""
    for file in files:
        recording = file.recording
        feet = {
            f"{each.subject}{each.side}": list(each.markers)
            for each in file.sensors
            if each.limb == "foot"
        }
        for name in feet_bodies:
            if name in recording.bodies:
                feet[name] = [name, *(n for n, above in recording.parents.items() if above == name)]
        if feet and len(recording.times) > 1:
            rate_hz = 1.0 / float(np.median(np.diff(recording.times)))
            return floor(file.points, feet, rate_hz, FOOT_RADIUS_M)
    return None


def quoted(text: str) -> str:
    """A string as TOML writes it; JSON's escapes are TOML's."""
    return json.dumps(text, ensure_ascii=False)


def _listed(names: Sequence[str]) -> str:
    """A list of names, on a line each where they are many."""
    text = f"[{', '.join(map(quoted, names))}]"
    return (
        text if len(text) < WIDTH else "[\n" + "".join(f"    {quoted(n)},\n" for n in names) + "]"
    )


def _free_name(text: str, used: Iterable[str]) -> str:
    """A name made of a text that nothing else has."""
    name = constant_name(text)
    while name in used:
        name += "_2"
    return name


def _table(table: str, /, *lines: str, **keys: str) -> list[str]:
    """A table of an array: its keys with their values, then lines."""
    given = [f"{key} = {value}" for key, value in keys.items() if value]
    return ["", f"[[{table}]]", *given, *(line for line in lines if line)]


def _account_lines(file: _File) -> list[str]:
    """Comments that say of every joint and marker what became of it."""
    rest = file.others
    if not file.body and not (rest.unseen or rest.computed or rest.loose):
        return []
    carried = {name for each in file.sensors for name in each.markers}
    groups: dict[str, list[str]] = {}
    for each in file.body.values():
        groups.setdefault("names are known by", []).append(each.by)
    for name, each in file.body.items():
        if name not in carried:
            part = f"{each.side} {each.part}".removeprefix("none ")
            groups.setdefault(f"the body, {part}:", []).append(name)
    for name, part in rest.riding.items():
        groups.setdefault(f"the body, keeping its distance to the {part}:", []).append(name)
    owned = [name for name in file.recording.markers if _owned(file.recording, name)]
    groups["of bodies that are in the file too:"] = owned
    groups["never seen:"] = [*rest.unseen]
    groups["computed quantities, no markers:"] = [*rest.computed]
    groups["left out, as no body and no two others keep their distance:"] = [*rest.loose]
    lines = [""]
    for title, names in groups.items():
        lines += [f"# {title}"] if names else []
        for name in dict.fromkeys(names):
            if len(lines[-1]) + len(name) + 2 > WIDTH:
                lines.append("#   ")
            lines[-1] += f" {name},"
        lines[-1] = lines[-1].rstrip(",")
    return lines


def _limb_lines(
    sensor: LimbSensor, file: _File, subjects: Sequence[str], used: set[str]
) -> list[str]:
    """The table of a sensor that a body's markers carry."""
    plain = f"{sensor.side}_{sensor.limb}".removeprefix("none_")
    name = _free_name(f"{sensor.subject}_{plain}" if subjects else plain, used)
    used.add(name)
    unsided = sensor.side == "none" and sensor.limb != "head"
    side_edit = f'   {EDIT} no name tells the side: "right" or "left"' if unsided else ""
    joined = len(sensor.own) < len(sensor.markers)
    origin = f"{_listed(sensor.own)}   # the others are on what it is joined to"
    loose = f"{sensor.residual_m:g}   # skin and joints give way" if sensor.residual_m else ""
    radius_m = HAND_RADIUS_M if sensor.limb == "hand" else FOOT_RADIUS_M
    shape = f"shape = {{ sphere = {radius_m:g} }}   # a stand-in"
    if sensor.limb == "head":
        shape = "# shape = { sphere = 0.1 }   # a stand-in: contact needs one"
    elif len(sensor.own) > 1:
        heels = [n for n in sensor.own if without_side(file.body[n].place) == "heel"]
        start, *ends = dict.fromkeys([*heels[:1], *sensor.own])
        pairs = ", ".join(f"[{quoted(start)}, {quoted(end)}]" for end in ends)
        shape = f"shape = {{ capsules = [{pairs}], radius_m = {radius_m:g} }}   # a stand-in"
    return _table(
        "sensor",
        _gaze_line(sensor.gaze),
        shape,
        name=quoted(name),
        end_effector=quoted(sensor.limb),
        side=quoted(sensor.side) + side_edit,
        agent=quoted(constant_name(sensor.subject or "agent")) if subjects else "",
        file=quoted(file.key),
        markers=_listed(sensor.markers),
        origin=origin if joined else "",
        residual_m=loose,
    )


def _gaze_line(gaze: tuple[float, float, float] | None) -> str:
    return f"gaze = {list(gaze)}   # forwards, by left and right" if gaze else ""


def _body_tables(
    files: Sequence[_File], found: Sequence[_Body], of_limbs: Mapping[str, str], used: set[str]
) -> Iterator[str]:
    """The tables of sensors and objects that are bodies or marker sets of files."""
    sensors = [each for each in found if each.name in of_limbs]
    if not sensors and found and not any(file.sensors for file in files):
        yield from ("", f"{EDIT} no name tells of a hand, head or foot; the first body is taken.")
        sensors = [*found[:1]]
    plain = {}
    for body in sensors:  # ``left_foot``, where side and limb are known
        limb = of_limbs.get(body.name, "")
        sided = body.side != "none" and limb in {"hand", "foot"}
        plain[body.name] = f"{body.side}_{limb}" if sided else limb if limb == "head" else body.name
    usual = list(plain.values())
    for body in [*sensors, *(other for other in found if other not in sensors)]:
        own = plain.get(body.name, body.name)
        name = _free_name(body.name if usual.count(own) > 1 else own, used)
        used.add(name)
        shape, keys = body.shape and f"shape = {body.shape}", {"name": quoted(name)}
        if body in sensors:
            keys["end_effector"] = quoted(of_limbs.get(body.name, "hand"))
            keys["side"] = quoted(body.side)
            shape = (
                shape or '# shape = { sphere = 0.05 }   # or { mesh = "..." }: contact needs one'
            )
        else:
            keys["kind"] = f"{quoted(name)}   # its noun"
            keys["tag"] = f'"mobile"   {EDIT} self, fixed or mobile'
            if body.fixed:
                keys["tag"] = '"fixed"   # it never moves'
            shape = shape or '# shape = { box = [0.1, 0.1, 0.1] }   # or { mesh = "mug.stl" }'
        kind = "sensor" if body in sensors else "object"
        keys["file"] = quoted(body.file)
        yield from _table(kind, body.key, _gaze_line(body.gaze), shape, **keys)
        if body in sensors and body.shape and of_limbs.get(body.name) == "head":
            felt = {"name": keys["name"], "tag": '"self"   # hands may touch it'}
            yield from _table("object", body.key, shape, **felt, file=keys["file"])


def _floor_lines(ground: Floor, used: set[str]) -> list[str]:
    """The table of the floor that feet stand on."""
    (x, y), (long, wide) = ground.middle, ground.size
    where = "where the feet stand lowest" if ground.rests else "under the lowest point of the feet"
    return _table(
        "object",
        name=quoted(_free_name("floor", used)),
        kind='"floor"',
        tag='"fixed"',
        assumed=f'"no floor is recorded; a level one is put {where}"',
        position=f"[{x:.2f}, {y:.2f}, {ground.top_m - FLOOR_M / 2:.3f}]",
        shape=f"{{ box = [{long:.1f}, {wide:.1f}, {FLOOR_M:g}] }}",
    )
