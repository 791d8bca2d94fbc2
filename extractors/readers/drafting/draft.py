"""A first capture.toml from what files hold, for a person to edit."""

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from extractors.readers.drafting.contents import (
    Contents,
    Floor,
    LimbSensor,
    Others,
    Points,
    Track,
    contents,
    floor,
    forwards,
    limb_sensors,
    mean_forward,
    others,
    rightwards,
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
FLOOR_M = 0.02  # Thickness of a floor [m].
WIDTH = 96  # Comments are no longer than this.


@dataclass(frozen=True)
class _Body:
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
        key = constant_name(path.name.split(".")[0])
        while key in paths:
            key += "_2"
        paths[key] = Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
        files.append(_file(key, each, unit_m, up))
    found = [body for file in files for body in _bodies(file)]
    of_limbs = limbs(each.name for each in found if not each.fixed)
    feet = [each.name for each in found if of_limbs.get(each.name) == "foot"]
    ground = _floor(files, feet)
    lines = [f"name = {quoted(constant_name(name))}", *frame_lines]
    ends = [(limb, side_of(name)) for name, limb in of_limbs.items()]
    if len(set(ends)) != len(ends):
        each_limb = 'each hand and foot is one; "apart" tells its parts'
        lines.append(f'parts = "together"              # {each_limb}')
    if ground is not None:
        spread_mm = ground.spread_m * 1e3
        lines.append(f"# feet stand at heights that differ by {spread_mm:.0f} mm")
        lines.append(f"contact.tolerance_m = {ground.tolerance_m:g}")
    lines += ["", "[files]", *(f"{key} = {quoted(path)}" for key, path in paths.items())]
    subjects: list[str] = []
    for file in files:
        named = list(dict.fromkeys(each.subject for each in file.sensors))
        subjects += named if len(named) > 1 else []
    for subject in subjects:
        lines += ["", "[[agent]]", f"name = {quoted(constant_name(subject or 'agent'))}"]
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


def _body_tables(
    files: Sequence[_File], found: Sequence[_Body], of_limbs: Mapping[str, str], used: set[str]
) -> Iterator[str]:
    """The tables of sensors and objects that are bodies or marker sets of files."""
    sensors = [each for each in found if each.name in of_limbs]
    if not sensors and found and not any(file.sensors for file in files):
        yield from ("", f"{EDIT} no name tells of a hand, head or foot; the first body is taken.")
        sensors = [*found[:1]]
    plain = [_plain(body, of_limbs) for body in sensors]
    for body, usual in zip(sensors, plain, strict=True):
        own = usual if plain.count(usual) == 1 else body.name
        yield from _sensor_lines(body, own, of_limbs.get(body.name, "hand"), used)
    for body in [other for other in found if other not in sensors]:
        yield from _object_lines(body, used)


def _plain(body: _Body, of_limbs: Mapping[str, str]) -> str:
    """``left_foot``, where side and limb are known; else the file's own name."""
    limb = of_limbs.get(body.name, "")
    if body.side != "none" and limb in {"hand", "foot"}:
        return f"{body.side}_{limb}"
    return limb if limb == "head" else body.name


def _frame(held: Sequence[Contents]) -> tuple[float, str, list[str]]:
    """The unit [m] and axis of files that do not state them, and the lines that say so.

    They are those that make people of the bodies in the files.
    """
    first = next((each for each in held if each.standing), None)
    unit_m, unit, unit_why, unit_edit = _unit(first)
    beside = next((each.beside for each in held if each.beside), None)
    stands = first.standing if first else None
    if stands is not None and stands.clear:
        low, high = "the feet", "the head"
        if stands.whole:
            low, high = "the body's lower parts", "its upper ones"
        up, up_why = stands.up, f"# from {low} to {high}"
    elif beside is not None:
        up, up_why = beside[0], f"# {beside[1]}"
    else:
        up = stands.up if stands else "z"
        up_why = f"{EDIT} the axis that points up: x, y or z"
    lines = list(_doubts(held))
    if any(each.recording.unit_m is None for each in held):
        edit = f"{EDIT} {unit_edit}" if unit_edit else ""
        lines += [*unit_why, f"unit = {unit:25}{edit}".rstrip()]
    if any(each.recording.up is None for each in held):
        lines.append(f'up = "{up}"                        {up_why}')
    lines.append('handedness = "right"            # "left" if the world is mirrored')
    if len(held) > 1:
        steps = [each.recording.times[:2] for each in held]
        rate = 1.0 / min(float(second - first) for first, second in steps)
        lines.append(f"rate_hz = {rate:.4g}                 # every stream is brought to this")
    return unit_m, up, lines


def _unit(held: Contents | None) -> tuple[float, str, list[str], str]:
    """Metres per unit, as it is written, the evidence, and what to look at."""
    person = held.standing if held else None
    if held is None or person is None:
        return 1.0, '"m"', [], f"{', '.join(UNITS)}, or metres per unit"
    evidence = f"# {person.evidence}"
    if person.unit:
        metres = UNITS[person.unit]
        why = f"{evidence}: {person.height * metres:.2f} m if the unit is {person.unit}"
        return metres, f'"{person.unit}"', [why], ""
    for metres in held.usual_units_m:
        if person.is_persons(metres):
            why = f"{evidence}: {person.height * metres:.2f} m in the unit that files with"
            return metres, f"{metres:g}", [why, "# such names are usually in"], ""
    low, high = person.range_m
    why = f"{evidence}, which is {low:g} to {high:g} m in no usual unit"
    return person.scale_m, f"{person.scale_m:.4g}", [why], "metres per unit, for an adult"


def _doubts(held: Sequence[Contents]) -> Iterator[str]:
    """Files whose own unit makes no person of the body in them."""
    for file in held:
        unit_m, person = file.recording.unit_m, file.standing
        if unit_m is not None and person is not None and not person.is_persons(unit_m):
            likely = f"; {person.unit} would make it {person.height * UNITS[person.unit]:.2f} m"
            yield (
                f"{EDIT} by the unit that {file.recording.source.path.rsplit('/', 1)[-1]} states, "
                f"{person.what} is {person.height * unit_m:.3g} m" + (likely if person.unit else "")
            )


def _file(key: str, held: Contents, unit_m: float, up: str) -> _File:
    recording = held.recording
    points = world_points(recording, recording.unit_m or unit_m, recording.up or up)
    markers = {name: points[name] for name in recording.markers}
    body = {name: each for name, each in held.body.items() if name in markers}
    sensors = tuple(limb_sensors(markers, body))
    return _File(key, held, points, sensors, others(markers, body if sensors else {}))


def _bodies(file: _File) -> Iterator[_Body]:
    """Bodies and marker sets; of a skeleton only its end-effectors, for joints are no objects."""
    recording = file.contents.recording
    kinds = end_effectors(recording) if recording.parents else {}
    names = list(kinds or ({} if recording.parents else recording.bodies))
    for name in names or list(recording.bodies)[:1]:
        known = file.contents.body.get(name)
        shape = ""
        if kinds.get(name) == "foot" and name in recording.parents.values():
            capsules = f'capsules = "children", radius_m = {FOOT_RADIUS_M:g}'
            shape = f"shape = {{ {capsules} }}   # a stand-in"
        yield _Body(
            name,
            file.key,
            f"body = {quoted(name)}",
            shape,
            _gaze(file, name) if kinds.get(name) == "head" else None,
            side=known.side if known is not None and known.side != "none" else side_of(name),
        )
    for name, members in file.others.sets.items():
        yield _Body(
            name,
            file.key,
            f"markers = {_listed(members)}",
            'shape = { box = "markers" }     # a stand-in: the box that the markers span',
            fixed=name in file.others.fixed,
            side=side_of(name),
        )


def _gaze(file: _File, name: str) -> tuple[float, float, float] | None:
    """Forwards in the frame of a skeleton's head, whose axes are the file's own."""
    recording = file.contents.recording
    if not file.contents.body or recording.up is not None:
        return None
    ahead = forwards(rightwards(file.points, file.contents.body))
    return mean_forward(recording.bodies[name].orientations, _in_file(file, ahead))


def _in_file(file: _File, directions: Track) -> Track:
    """Directions of the world along the file's axes."""
    bodies = file.contents.recording.bodies
    own = np.stack([each.positions for each in bodies.values()])
    world = np.stack([file.points[name] for name in bodies])
    turn, *_ = np.linalg.lstsq(
        (world - world.mean(axis=(0, 1))).reshape(-1, 3),
        (own - own.mean(axis=(0, 1))).reshape(-1, 3),
        rcond=None,
    )
    out = directions @ turn
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


def quoted(text: str) -> str:
    """A string as TOML writes it; JSON's escapes are TOML's."""
    return json.dumps(text, ensure_ascii=False)


def _listed(names: Sequence[str]) -> str:
    return f"[{', '.join(map(quoted, names))}]"


def _free_name(text: str, used: set[str]) -> str:
    """A name made of a text that nothing else has."""
    name = constant_name(text)
    while name in used:
        name += "_2"
    used.add(name)
    return name


def _account_lines(file: _File) -> list[str]:
    """Comments that say of every joint and marker what became of it."""
    body, rest = file.contents.body, file.others
    if not body and not (rest.unseen or rest.computed or rest.loose):
        return []
    carried = {name for each in file.sensors for name in each.markers}
    by = dict.fromkeys(each.by for each in body.values())
    lines = ["", *([f"# names are known by {', '.join(by)}"] if by else [])]
    groups: dict[str, list[str]] = {}
    for name, each in body.items():
        if name not in carried:
            groups.setdefault(f"{each.side} {each.part}".removeprefix("none "), []).append(name)
    for part, names in groups.items():
        lines += _wrapped(f"the body, {part}", names)
    for name, part in rest.riding.items():
        lines += _wrapped(f"the body, for it keeps its distance to the {part}", [name])
    lines += _wrapped("never seen", rest.unseen)
    lines += _wrapped("computed quantities, no markers", rest.computed)
    lines += _wrapped("left out, for no body and no two others keep their distance", rest.loose)
    return lines


def _wrapped(title: str, names: Sequence[str]) -> list[str]:
    """A comment that lists names, on as many lines as it takes; none where a list is empty."""
    lines = [f"# {title}:"]
    for name in names:
        if len(lines[-1]) + len(name) + 2 > WIDTH:
            lines.append("#   ")
        lines[-1] += f" {name},"
    lines[-1] = lines[-1].rstrip(",")
    return lines if names else []


def _limb_lines(
    sensor: LimbSensor, file: _File, subjects: Sequence[str], used: set[str]
) -> list[str]:
    """The table of a sensor that a body's markers carry."""
    plain = f"{sensor.side}_{sensor.limb}".removeprefix("none_")
    name = _free_name(f"{sensor.subject}_{plain}" if subjects else plain, used)
    lines = ["", "[[sensor]]", f"name = {quoted(name)}", f"end_effector = {quoted(sensor.limb)}"]
    lines += [f"side = {quoted(sensor.side)}"]
    if sensor.side == "none" and sensor.limb != "head":
        lines[-1] += f'                   {EDIT} no name tells the side: "right" or "left"'
    if subjects:
        lines.append(f"agent = {quoted(constant_name(sensor.subject or 'agent'))}")
    markers = f"markers = {_listed(sensor.markers)}"
    if len(markers) > WIDTH:
        each_marker = "".join(f"    {quoted(each)},\n" for each in sensor.markers)
        markers = f"markers = [\n{each_marker}]"
    lines += [f"file = {quoted(file.key)}", markers]
    if len(sensor.own) < len(sensor.markers):
        lines += [f"origin = {_listed(sensor.own)}    # the others are on what it is joined to"]
    if sensor.residual_m is not None:
        lines.append(f"residual_m = {sensor.residual_m:g}              # skin and joints give way")
    if sensor.gaze is not None:
        lines.append(f"gaze = {list(sensor.gaze)}      # forwards, by left and right")
    return [*lines, _limb_shape(sensor, file.contents.body)]


def _limb_shape(sensor: LimbSensor, body: Mapping[str, BodyName]) -> str:
    """A stand-in along a hand's or foot's markers; heads touch nothing."""
    if sensor.limb == "head":
        return "# shape = { sphere = 0.1 }      # a stand-in: contact needs one"
    radius_m = HAND_RADIUS_M if sensor.limb == "hand" else FOOT_RADIUS_M
    if len(sensor.own) < 2:
        return f"shape = {{ sphere = {radius_m:g} }}     # a stand-in"
    start = next((n for n in sensor.own if without_side(body[n].place) == "heel"), sensor.own[0])
    pairs = ", ".join(_listed([start, each]) for each in sensor.own if each != start)
    return f"shape = {{ capsules = [{pairs}], radius_m = {radius_m:g} }}   # a stand-in"


def _sensor_lines(body: _Body, name: str, limb: str, used: set[str]) -> list[str]:
    """The table of a sensor that is a body or marker set of a file."""
    gaze = f"gaze = {list(body.gaze or ())}      # forwards, by left and right"
    default = '# shape = { sphere = 0.05 }     # a stand-in, or { mesh = "..." }: contact needs one'
    return [
        "",
        "[[sensor]]",
        f"name = {quoted(_free_name(name, used))}",
        f"end_effector = {quoted(limb)}",
        f"side = {quoted(body.side)}",
        f"file = {quoted(body.file)}",
        body.key,
        *([gaze] if body.gaze is not None else []),
        body.shape or default,
    ]


def _object_lines(body: _Body, used: set[str]) -> list[str]:
    """The table of an object."""
    own = _free_name(body.name, used)
    tag = f'tag = "mobile"                  {EDIT} self, fixed or mobile'
    if body.fixed:
        tag = 'tag = "fixed"                   # it never moves'
    default = '# shape = { box = [0.1, 0.1, 0.1] }   # or { mesh = "mug.stl", unit = "mm" }'
    return [
        "",
        "[[object]]",
        f"name = {quoted(own)}",
        f"kind = {quoted(own)}         # its noun",
        tag,
        f"file = {quoted(body.file)}",
        body.key,
        body.shape or default,
    ]


def _floor_lines(ground: Floor, used: set[str]) -> list[str]:
    """The table of the floor that feet stand on."""
    x, y = ground.middle
    long, wide = ground.size
    where = "where the feet stand lowest" if ground.rests else "under the lowest point of the feet"
    return [
        "",
        "[[object]]",
        f"name = {quoted(_free_name('floor', used))}",
        'kind = "floor"',
        'tag = "fixed"',
        f'assumed = "no floor is recorded; a level one is put {where}"',
        f"position = [{x:.2f}, {y:.2f}, {ground.top_m - FLOOR_M / 2:.3f}]",
        f"shape = {{ box = [{long:.1f}, {wide:.1f}, {FLOOR_M:g}] }}",
    ]
