"""Tables of a drafted capture.toml: agents, sensors, objects, the floor, and what is left out."""

import json
from collections.abc import Mapping, Sequence

from extractors.readers.body_names.body_names import BodyName, without_side
from extractors.readers.drafting.contents import Contents, Others
from extractors.readers.drafting.floor import RADIUS_M as FOOT_RADIUS_M
from extractors.readers.drafting.floor import THICK_M, Floor
from extractors.readers.drafting.frame_lines import EDIT
from extractors.readers.drafting.limb_sensors import LimbSensor
from extractors.readers.recording import Recording
from extractors.readers.schema.names import constant_name

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
