"""Somebody who walks with markers on, written as TRC files."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

RATE_HZ = 100.0
STEP_S = 0.4
STRIDE_M = 1.2
HIP_M = 0.95

MIDDLE = {
    "C7": (-0.05, 0.0, 1.48), "CLAV": (0.08, 0.0, 1.42), "STRN": (0.10, 0.0, 1.25),
    "T10": (-0.08, 0.0, 1.25),
}  # fmt: skip
RIGHT = {
    "RFHD": (0.09, -0.07, 1.68), "RBHD": (-0.09, -0.07, 1.66), "RSHO": (0.0, -0.19, 1.46),
    "RELB": (-0.02, -0.25, 1.15), "RWRA": (0.06, -0.24, 0.92), "RWRB": (-0.01, -0.27, 0.92),
    "RFIN": (0.03, -0.28, 0.84), "RASI": (0.09, -0.12, 1.0), "RPSI": (-0.09, -0.05, 1.03),
}  # fmt: skip
RIGHT_LEG = {
    "RKNE": (0.02, -0.15, 0.50), "RANK": (-0.02, -0.13, 0.09), "RHEE": (-0.08, -0.09, 0.04),
    "RTOE": (0.12, -0.10, 0.05), "RMT5": (0.09, -0.14, 0.035),
}  # fmt: skip
"""Plug-in Gait markers of the right half where somebody of 1.75 m stands, looking along x [m]."""

STEPS = {"right": (1, 3), "left": (0, 2, 4)}
"""In which of the spans of STEP_S each foot swings; the first and last step are half a stride."""


def walker() -> dict[str, np.ndarray]:
    """Markers of somebody who makes five steps, in metres with z up."""
    times = np.arange(round((2.0 + 5 * STEP_S) * RATE_HZ)) / RATE_HZ
    feet = {side: _foot(times, side) for side in STEPS}
    middle = (feet["right"] + feet["left"]) / 2 * [1.0, 1.0, 0.0]
    out = {name: at + middle for name, at in MIDDLE.items()}
    for name, at in RIGHT.items():
        out[name] = at + middle
        out["L" + name[1:]] = np.array(at) * [1.0, -1.0, 1.0] + middle
    for name, at in RIGHT_LEG.items():
        for side, sign in (("right", 1.0), ("left", -1.0)):
            share = 1.0 - at[2] / HIP_M if name.endswith("KNE") else 1.0
            own = share * feet[side] + (1.0 - share) * middle
            out[side[0].upper() + name[1:]] = np.array(at) * [1.0, sign, 1.0] + own
    return out


def _foot(times: np.ndarray, side: str) -> np.ndarray:
    """How far a foot is from where it stood at first."""
    out = np.zeros((len(times), 3))
    for number in STEPS[side]:
        share = np.clip((times - 1.0 - number * STEP_S) / STEP_S, 0.0, 1.0)
        length = STRIDE_M / 2 if number in (0, 4) else STRIDE_M
        out[:, 0] += length * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        out[:, 2] += 0.12 * np.sin(np.pi * share) ** 2
    return out


def write_trc(path: Path, markers: Mapping[str, np.ndarray], unit: str = "mm") -> None:
    """A TRC file of markers that are in that unit; NaN is an empty cell."""
    frames = len(next(iter(markers.values())))
    head = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
        f"{RATE_HZ}\t{RATE_HZ}\t{frames}\t{len(markers)}\t{unit}",
        "Frame#\tTime\t" + "\t\t\t".join(markers),
        "\t\t" + "\t".join(f"X{n}\tY{n}\tZ{n}" for n in range(1, len(markers) + 1)),
    ]
    table = np.concatenate(list(markers.values()), axis=1)
    rows = [
        f"{number + 1}\t{number / RATE_HZ:.3f}\t"
        + "\t".join("" if np.isnan(value) else f"{value:.3f}" for value in row)
        for number, row in enumerate(table)
    ]
    path.write_text("\n".join([*head, *rows]) + "\n")
