"""A first capture.toml from what files hold, for a person to edit."""

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from extractors.readers.drafting.contents import RADIUS_M as FOOT_RADIUS_M
from extractors.readers.drafting.contents import (
    THICK_M,
    Contents,
    Floor,
    LimbSensor,
    Others,
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


@dataclass(frozen=True)
class Frame:
    """What files are taken to be in that do not say it."""

    unit_m: float
    unit: str
    """As the capture.toml states it: ``"mm"`` in quotes, or metres per unit."""

    up: str
    unit_why: tuple[str, ...]
    """Comments with the evidence."""

    unit_edit: str
    """What a person must look at; empty where the evidence is clear."""

    up_why: str
    up_edit: str


def frame_of(held: Sequence[Contents]) -> Frame:
    """The unit and axis that make people of the bodies in some files."""
    first = next((each for each in held if each.standing), None)
    unit_m, unit, unit_why, unit_edit = _unit(first)
    beside = next((each.beside for each in held if each.beside), None)
    stands = first.standing if first else None
    if stands is not None and stands.clear:
        up, up_why, up_edit = stands.up, _how_up(first), ""
    elif beside is not None:
        (up, up_why), up_edit = beside, ""
    else:
        up, up_why = (stands.up if stands else "z"), ""
        up_edit = "the axis that points up: x, y or z"
    return Frame(unit_m, unit, up, unit_why, unit_edit, up_why, up_edit)


def _how_up(first: Contents | None) -> str:
    whole = first is not None and first.standing is not None and first.standing.whole
    return "from the body's lower parts to its upper ones" if whole else "from the feet to the head"


def _unit(held: Contents | None) -> tuple[float, str, tuple[str, ...], str]:
    """Metres per unit, as it is written, the evidence, and what to look at."""
    person = held.standing if held else None
    if held is None or person is None:
        return 1.0, '"m"', (), f"{', '.join(UNITS)}, or metres per unit"
    evidence = f"# {person.evidence}"
    if person.unit:
        metres = UNITS[person.unit]
        why = f"{evidence}: {person.height * metres:.2f} m if the unit is {person.unit}"
        return metres, f'"{person.unit}"', (why,), ""
    for metres in held.usual_units_m:
        if person.is_persons(metres):
            why = f"{evidence}: {person.height * metres:.2f} m in the unit that files with"
            return metres, f"{metres:g}", (why, "# such names are usually in"), ""
    low, high = person.range_m
    why = f"{evidence}, which is {low:g} to {high:g} m in no usual unit"
    return person.scale_m, f"{person.scale_m:.4g}", (why,), "metres per unit, for an adult"


def frame_lines(held: Sequence[Contents], frame: Frame) -> list[str]:
    """The lines of unit, axis, handedness and rate."""
    lines = _doubts(held)
    if any(each.recording.unit_m is None for each in held):
        edit = f"{EDIT} {frame.unit_edit}" if frame.unit_edit else ""
        lines += [*frame.unit_why, f"unit = {frame.unit:25}{edit}".rstrip()]
    if any(each.recording.up is None for each in held):
        said = f"{EDIT} {frame.up_edit}" if frame.up_edit else f"# {frame.up_why}"
        lines.append(f'up = "{frame.up}"                        {said}')
    lines.append('handedness = "right"            # "left" if the world is mirrored')
    if len(held) > 1:
        steps = [each.recording.times[:2] for each in held]
        rate = 1.0 / min(float(second - first) for first, second in steps)
        lines.append(f"rate_hz = {rate:.4g}                 # every stream is brought to this")
    return lines


def _doubts(held: Sequence[Contents]) -> list[str]:
    """Files whose own unit makes no person of the body in them."""
    out = []
    for file in held:
        unit_m, person = file.recording.unit_m, file.standing
        if unit_m is not None and person is not None and not person.is_persons(unit_m):
            likely = f"; {person.unit} would make it {person.height * UNITS[person.unit]:.2f} m"
            out.append(
                f"{EDIT} by the unit that {file.recording.source.path.rsplit('/', 1)[-1]} states, "
                f"{person.what} is {person.height * unit_m:.3g} m" + (likely if person.unit else "")
            )
    return out


__all__ = ["FOOT_RADIUS_M"]

HAND_RADIUS_M = 0.04
WIDTH = 96
"""Comments are no longer than this."""


def quoted(text: str) -> str:
    """A string as TOML writes it; JSON's escapes are TOML's."""
    return json.dumps(text, ensure_ascii=False)


def free_name(text: str, used: set[str]) -> str:
    """A name made of a text that nothing else has."""
    name = constant_name(text)
    while name in used:
        name += "_2"
    used.add(name)
    return name


def agent_lines(subjects: Sequence[str]) -> list[str]:
    """The people, where there are several."""
    out = []
    for subject in subjects:
        out += ["", "[[agent]]", f"name = {quoted(constant_name(subject or 'agent'))}"]
    return out


def account_lines(held: Contents, sensors: Sequence[LimbSensor], rest: Others) -> list[str]:
    """Comments that say of every joint and marker what became of it."""
    if not held.body and not (rest.unseen or rest.computed or rest.loose):
        return []
    carried = {name for each in sensors for name in each.markers}
    by = dict.fromkeys(each.by for each in held.body.values())
    lines = ["", *_wrapped(f"names are known by {', '.join(by)}", [])] if by else [""]
    groups: dict[str, list[str]] = {}
    for name, each in held.body.items():
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
    if not names:
        return [f"# {title}"] if title.startswith("names") else []
    lines = [f"# {title}:"]
    for name in names:
        if len(lines[-1]) + len(name) + 2 > WIDTH:
            lines.append("#   ")
        lines[-1] += f" {name},"
    lines[-1] = lines[-1].rstrip(",")
    return lines


def limb_lines(
    sensor: LimbSensor,
    file: str,
    body: Mapping[str, BodyName],
    subjects: Sequence[str],
    used: set[str],
) -> list[str]:
    """The table of a sensor that a body's markers carry."""
    plain = f"{sensor.side}_{sensor.limb}".removeprefix("none_")
    name = free_name(f"{sensor.subject}_{plain}" if subjects else plain, used)
    lines = ["", "[[sensor]]", f"name = {quoted(name)}", f"end_effector = {quoted(sensor.limb)}"]
    lines += [f"side = {quoted(sensor.side)}"]
    if sensor.side == "none" and sensor.limb != "head":
        lines[-1] += f'                   {EDIT} no name tells the side: "right" or "left"'
    if subjects:
        lines.append(f"agent = {quoted(constant_name(sensor.subject or 'agent'))}")
    lines += [f"file = {quoted(file)}", _markers_line(sensor.markers)]
    if sensor.borrowed:
        lines += [f"origin = {_listed(sensor.own)}    # the others are on what it is joined to"]
    if sensor.residual_m is not None:
        lines.append(f"residual_m = {sensor.residual_m:g}              # skin and joints give way")
    if sensor.gaze is not None:
        lines.append(f"gaze = {list(sensor.gaze)}      # forwards, by left and right")
    return [*lines, _limb_shape(sensor, body)]


def _markers_line(markers: Sequence[str]) -> str:
    line = f"markers = {_listed(markers)}"
    if len(line) <= WIDTH:
        return line
    return "markers = [\n" + "".join(f"    {quoted(each)},\n" for each in markers) + "]"


def _listed(names: Sequence[str]) -> str:
    return f"[{', '.join(map(quoted, names))}]"


def _limb_shape(sensor: LimbSensor, body: Mapping[str, BodyName]) -> str:
    """A stand-in along a hand's or foot's markers; heads touch nothing."""
    if sensor.limb == "head":
        return "# shape = { sphere = 0.1 }      # a stand-in: contact needs one"
    radius_m = HAND_RADIUS_M if sensor.limb == "hand" else FOOT_RADIUS_M
    if len(sensor.own) < 2:
        return f"shape = {{ sphere = {radius_m:g} }}     # a stand-in"
    start = next((n for n in sensor.own if without_side(body[n].place) == "heel"), sensor.own[0])
    pairs = [[start, each] for each in sensor.own if each != start]
    return (
        f"shape = {{ capsules = [{', '.join(map(_listed, pairs))}], "
        f"radius_m = {radius_m:g} }}   # a stand-in"
    )


def sensor_lines(
    name: str,
    limb: str,
    side: str,
    file: str,
    key: str,
    shape: str,
    gaze: tuple[float, float, float] | None,
    used: set[str],
) -> list[str]:
    """The table of a sensor that is a body or marker set of a file."""
    lines = [
        "",
        "[[sensor]]",
        f"name = {quoted(free_name(name, used))}",
        f"end_effector = {quoted(limb)}",
        f"side = {quoted(side)}",
        f"file = {quoted(file)}",
        key,
    ]
    if gaze is not None:
        lines.append(f"gaze = {list(gaze)}      # forwards, by left and right")
    default = '# shape = { sphere = 0.05 }     # a stand-in, or { mesh = "..." }: contact needs one'
    return [*lines, shape or default]


def object_lines(
    name: str, file: str, key: str, shape: str, used: set[str], *, fixed: bool
) -> list[str]:
    """The table of an object."""
    own = free_name(name, used)
    tag = (
        'tag = "fixed"                   # it never moves'
        if fixed
        else f'tag = "mobile"                  {EDIT} self, fixed or mobile'
    )
    default = '# shape = { box = [0.1, 0.1, 0.1] }   # or { mesh = "mug.stl", unit = "mm" }'
    return [
        "",
        "[[object]]",
        f"name = {quoted(own)}",
        f"kind = {quoted(own)}         # its noun",
        tag,
        f"file = {quoted(file)}",
        key,
        shape or default,
    ]


def floor_lines(ground: Floor, used: set[str]) -> list[str]:
    """The table of the floor that feet stand on."""
    x, y = ground.middle
    long, wide = ground.size
    where = "where the feet stand lowest" if ground.rests else "under the lowest point of the feet"
    return [
        "",
        "[[object]]",
        f"name = {quoted(free_name('floor', used))}",
        'kind = "floor"',
        'tag = "fixed"',
        f'assumed = "no floor is recorded; a level one is put {where}"',
        f"position = [{x:.2f}, {y:.2f}, {ground.top_m - THICK_M / 2:.3f}]",
        f"shape = {{ box = [{long:.1f}, {wide:.1f}, {THICK_M:g}] }}",
    ]


def nothing_lines(recordings: Sequence[Recording]) -> list[str]:
    """What is said where no body is found."""
    names = ", ".join(name for each in recordings for name in each.names)
    return [
        "",
        f"{EDIT} no three markers keep their distances. Say which are one body:",
        f"# the files hold: {names}",
        "# [[sensor]]",
        '# name = "right_hand"',
        '# end_effector = "hand"',
        '# markers = ["...", "...", "..."]',
    ]


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
