"""A virtual performer's capture bundle: tables, meshes, capture.toml and the truth beside it."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from capar.body.recording import Truth
from capar.model.capture import Capture, Role, Sensor, Shape, TagObject, TagType


def write_bundle(capture: Capture, truth: Truth, folder: Path) -> None:
    """Write a capture bundle with its truth beside it; the same capture gives the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    tracked = {n: b for n, b in sorted(capture.bodies.items()) if not _fixed(b)}
    parts = ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")
    header = ["t_s", *(f"{name}_{part}" for name in tracked for part in parts)]
    rows = [_row(capture, list(tracked.values()), frame) for frame in range(len(capture.times))]
    _write(folder / "motion.csv", [",".join(header), *rows])
    bodies: list[Sensor | TagObject] = [*capture.objects, *capture.sensors]
    shapes = {body.name: body.shape for body in bodies}
    for name, shape in sorted(shapes.items()):
        if shape is not None:
            _write(folder / f"{name}.obj", _obj(shape))
    _write(folder / "capture.toml", _toml(capture))
    _write(folder / "truth.toml", _truth_toml(truth))


def _fixed(body: Sensor | TagObject) -> bool:
    return isinstance(body, TagObject) and body.tag is TagType.FIXED


def _row(capture: Capture, bodies: list[Sensor | TagObject], frame: int) -> str:
    cells = [f"{capture.times[frame]:.9f}"]
    for body in bodies:
        cells += [f"{value:.7f}" for value in body.stream.positions[frame]]
        cells += [f"{value:.8f}" for value in np.roll(body.stream.orientations[frame], -1)]
        cells.append("0" if body.stream.lost[frame] else "1")
    return ",".join(cells)


def _obj(shape: Shape) -> list[str]:
    corners = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in shape.vertices]
    faces = [f"f {a} {b} {c}" for a, b, c in shape.faces + 1]
    return [f"# {shape.description} [m]", *corners, *faces]


def _toml(capture: Capture) -> list[str]:
    out = [
        "# A virtual performer's trial; truth.toml beside it says what is so.",
        f'name = "{capture.name}"', 'unit = "m"', 'up = "z"', "",
        "[files]", 'motion = "motion.csv"', "",
    ]  # fmt: skip
    for agent in capture.agents:
        measures = ", ".join(f"{k} = {v}" for k, v in sorted(agent.measures.items()))
        out += [""] * (agent is not capture.agent) + ["[[agent]]" if capture.others else "[agent]"]
        out += [f'name = "{agent.name}"', f'kind = "{agent.kind}"', f"measures = {{ {measures} }}"]
    for sensor in capture.sensors:
        out += [
            "",
            "[[sensor]]",
            f'name = "{sensor.name}"',
            f'end_effector = "{sensor.end_effector}"',
        ]
        out += [f'agent = "{sensor.agent}"'] * bool(sensor.agent)
        out += [f'side = "{sensor.side}"'] * (sensor.side != "none")
        out += [f'link = "{sensor.link}"', f'role = "{sensor.role}"', f'body = "{sensor.name}"']
        if sensor.role is Role.ATTENDS:
            out += [f"eye = {_list(sensor.eye)}", f"gaze = {_list(sensor.gaze)}"]
        out += _mesh_line(sensor)
    for thing in capture.objects:
        out += ["", "[[object]]", f'name = "{thing.name}"', f'tag = "{thing.tag}"']
        out += [f'agent = "{thing.agent}"'] * bool(thing.agent)
        out += [f'kind = "{thing.kind}"'] * bool(thing.kind) + _where(thing) + _mesh_line(thing)
        out += [f"mass_kg = {thing.mass_kg}"] if thing.mass_kg is not None else []
    return out


def _where(thing: TagObject) -> list[str]:
    if not _fixed(thing):
        return [f'body = "{thing.name}"']
    turn = np.roll(thing.stream.orientations[0], -1)
    lines = [f"position = {_list(thing.stream.positions[0])}"]
    return lines if abs(turn[3]) > 1 - 1e-12 else [*lines, f"orientation = {_list(turn)}"]


def _mesh_line(body: Sensor | TagObject) -> list[str]:
    return [f'shape = {{ mesh = "{body.name}.obj" }}'] if body.shape is not None else []


def _list(values: Iterable[float]) -> str:
    return "[" + ", ".join(f"{float(each):.7f}" for each in values) + "]"


def _truth_toml(truth: Truth) -> list[str]:
    out = ["# Exact, by the script; times in seconds from the first frame."]
    for first, second, a, b in truth.contacts:
        out += ["", "[[contact]]", f'bodies = ["{first}", "{second}"]', f"span_s = {_list((a, b))}"]
    for kind, rows in (("motion", truth.motions), ("phase", truth.phases), ("look", truth.looks)):
        for name, a, b in rows:
            out += ["", f"[[{kind}]]", f'name = "{name}"', f"span_s = {_list((a, b))}"]
    return out


def _write(path: Path, lines: list[str]) -> None:
    path.write_bytes(("\n".join(lines) + "\n").encode())
