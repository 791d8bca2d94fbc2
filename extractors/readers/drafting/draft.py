"""A first capture.toml from what files hold, for a person to edit."""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from extractors.readers.drafting.marker_sets import marker_sets
from extractors.readers.name_guesses import (
    HEIGHT_M,
    Standing,
    end_effectors,
    limbs,
    side_of,
    standing,
)
from extractors.readers.recording import UNITS, Recording
from extractors.readers.schema.names import constant_name

EDIT = "# EDIT:"
"""What marks a line that a person must look at."""


@dataclass(frozen=True)
class _Found:
    """A body or marker set, and where it is."""

    name: str
    file: str
    key: str
    """The line of TOML that names it."""


def draft(recordings: Sequence[Recording], folder: Path, name: str) -> str:
    """A commented capture.toml for files, with paths relative to a folder."""
    files = _files(recordings, folder)
    found = [
        each
        for key, recording in zip(files, recordings, strict=True)
        for each in _found(key, recording)
    ]
    of_limbs = limbs(each.name for each in found)
    sensors = [each for each in found if each.name in of_limbs]
    lines = [f"name = {_quoted(constant_name(name))}", *_frame_lines(recordings)]
    lines += [*_parts_lines(of_limbs), "", "[files]"]
    lines += [f"{key} = {_quoted(path)}" for key, path in files.items()]
    used: set[str] = set()
    if not sensors and found:
        lines += ["", f"{EDIT} no name tells of a hand, head or foot; the first body is taken."]
        sensors = found[:1]
    for each in sensors:
        lines += ["", *_sensor(each, of_limbs.get(each.name, "hand"), used)]
    for each in [other for other in found if other not in sensors]:
        lines += ["", *_object(each, used)]
    if not found:
        lines += ["", *_nothing(recordings)]
    return "\n".join(lines) + "\n"


def _files(recordings: Sequence[Recording], folder: Path) -> dict[str, str]:
    out: dict[str, str] = {}
    for each in recordings:
        path = Path(each.source.path)
        key = constant_name(path.name.split(".")[0])
        while key in out:
            key += "_2"
        out[key] = Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    return out


def _frame_lines(recordings: Sequence[Recording]) -> list[str]:
    lines = []
    person = next(filter(None, map(standing, recordings)), None)
    if any(each.unit_m is None for each in recordings):
        lines += _unit_lines(person)
    if any(each.up is None for each in recordings):
        lines += _up_lines(person)
    lines.append('handedness = "right"            # "left" if the world is mirrored')
    if len(recordings) > 1:
        rate = 1.0 / min(float(each.times[1] - each.times[0]) for each in recordings)
        lines.append(f"rate_hz = {rate:.4g}                 # every stream is brought to this")
    return lines


def _unit_lines(person: Standing | None) -> list[str]:
    """The unit, by the height of the person in the file."""
    if person is None:
        return [f'unit = "m"                      {EDIT} {", ".join(UNITS)}, or metres per unit']
    evidence = f"# the head is {person.height:.4g} above the feet"
    low, high = HEIGHT_M
    if person.unit:
        height = person.height * UNITS[person.unit]
        return [
            f"{evidence}: {height:.2f} m if the unit is {person.unit}",
            f'unit = "{person.unit}"',
        ]
    return [
        f"{evidence}, which is {low:g} to {high:g} m in no usual unit",
        f"unit = {person.scale_m:.4g}                  {EDIT} metres per unit, for an adult",
    ]


def _up_lines(person: Standing | None) -> list[str]:
    """The axis that points up, by where head and feet are."""
    if person is None or not person.clear:
        up = person.up if person else "z"
        return [f'up = "{up}"                        {EDIT} the axis that points up: x, y or z']
    return [f'up = "{person.up}"                        # from the feet to the head']


def _parts_lines(of_limbs: Mapping[str, str]) -> list[str]:
    """What is done with several sensors on one hand or foot, where there are some."""
    ends = [(limb, side_of(name)) for name, limb in of_limbs.items()]
    if len(set(ends)) == len(ends):
        return []
    return ['parts = "together"              # each hand and foot is one; "apart" tells its parts']


def _found(file: str, recording: Recording) -> list[_Found]:
    """Bodies and marker sets; of a skeleton only its end-effectors, for joints are no objects."""
    names = list(end_effectors(recording) if recording.parents else recording.bodies)
    names = names or list(recording.bodies)[:1]
    bodies = [_Found(name, file, f"body = {_quoted(name)}") for name in names]
    unit = recording.unit_m or 1.0
    metres = {name: points * unit for name, points in recording.markers.items()}
    sets = marker_sets(metres)
    return bodies + [
        _Found(name, file, f"markers = [{', '.join(map(_quoted, members))}]")
        for name, members in sets.items()
    ]


def _free_name(text: str, used: set[str]) -> str:
    name = constant_name(text)
    while name in used:
        name += "_2"
    used.add(name)
    return name


def _sensor(found: _Found, limb: str, used: set[str]) -> list[str]:
    side = side_of(found.name)
    return [
        "[[sensor]]",
        f"name = {_quoted(_free_name(found.name, used))}",
        f"end_effector = {_quoted(limb)}",
        f"side = {_quoted(side)}",
        f"file = {_quoted(found.file)}",
        found.key,
        '# shape = { sphere = 0.05 }     # a stand-in, or { mesh = "..." }: contact needs one',
    ]


def _object(found: _Found, used: set[str]) -> list[str]:
    name = _free_name(found.name, used)
    return [
        "[[object]]",
        f"name = {_quoted(name)}",
        f"kind = {_quoted(name)}         # its noun",
        f'tag = "mobile"                  {EDIT} self, fixed or mobile',
        f"file = {_quoted(found.file)}",
        found.key,
        '# shape = { box = [0.1, 0.1, 0.1] }   # or { mesh = "mug.stl", unit = "mm" }',
    ]


def _nothing(recordings: Sequence[Recording]) -> list[str]:
    names = ", ".join(name for each in recordings for name in each.names)
    return [
        f"{EDIT} no three markers keep their distances. Say which are one body:",
        f"# the files hold: {names}",
        "# [[sensor]]",
        '# name = "right_hand"',
        '# end_effector = "hand"',
        '# markers = ["...", "...", "..."]',
    ]


def _quoted(text: str) -> str:
    """A string as TOML writes it; JSON's escapes are TOML's."""
    return json.dumps(text, ensure_ascii=False)
