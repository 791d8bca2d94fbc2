"""Writes a bundle of a closed form: the tall man drinks, with a good tracker's noise.

Run as ``python tests/write_demo.py`` to rewrite it.
"""

from pathlib import Path

import numpy as np
from bundles import DRINKING
from motions import TALL_MAN, drink_from_mug

from capar.model.capture import Capture, Sensor, Shape, TagObject

NOISE_M = 0.0003
NOISE_RAD = float(np.radians(0.1))
PARTS = ("x", "y", "z", "qx", "qy", "qz", "qw", "valid")


def demo_capture() -> Capture:
    """The trial that the bundle holds."""
    trial = drink_from_mug(TALL_MAN, noise_m=NOISE_M, noise_rad=NOISE_RAD, seed=5)
    return trial.capture


def write_tables(capture: Capture, folder: Path) -> None:
    """The poses of what was tracked as ``motion.csv``, and each body's mesh as an OBJ file."""
    folder.mkdir(parents=True, exist_ok=True)
    tracked = [each for name, each in sorted(capture.bodies.items()) if name != "table"]
    header = ["t_s", *(f"{each.name}_{part}" for each in tracked for part in PARTS)]
    rows = [_row(capture, tracked, frame) for frame in range(len(capture.times))]
    _write(folder / "motion.csv", [",".join(header), *rows])
    for name, body in sorted(capture.bodies.items()):
        if body.shape is not None:
            _write(folder / f"{name}.obj", _obj(body.shape))


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


def _write(path: Path, lines: list[str]) -> None:
    path.write_bytes(("\n".join(lines) + "\n").encode())


if __name__ == "__main__":
    write_tables(demo_capture(), DRINKING)
