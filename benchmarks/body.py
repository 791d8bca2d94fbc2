"""Accuracy and speed of fitting a body to eleven noisy sensors at 103.3 Hz.

``python benchmarks/body.py [--seeds 1] [--seconds 8]``; the docs' figures are of three seeds. A
line has the first fit, what ``capar fit`` gives (refined where residuals ask for it), and the first
fit's speed.
"""

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import numpy as np
from virtual_bodies.trials import (
    RATE_HZ,
    guessed,
    joint_errors_rad,
    measured,
    palm_errors_m,
    rms,
    virtual_trial,
)

from capar.body.human import Human
from capar.body.sensor_fitting import fit, fit_refined
from capar.body.sensors import calibrate

ON_THE_MARKS = (np.zeros(3), 0.0)


def show(
    label: str, who: str, seed: int, seconds: float, *, marks: bool, arms: float, taped: bool
) -> None:
    trial = virtual_trial(who, seed=seed, seconds=seconds)
    known = (measured if taped else guessed)(trial.human.measures, arms=arms)
    body = Human.of(known)
    found = calibrate(body, trial.streams, placed=ON_THE_MARKS if marks else None)
    began = time.process_time()
    made = fit(body, trial.streams, found)
    cpu = (time.process_time() - began) / len(made.times)
    given = fit_refined(body, trial.streams, found)
    print(
        f"{label:34} {who:6} {seed}  {1e3 * rms(palm_errors_m(trial, made)):6.1f} mm "
        f"{np.degrees(rms(joint_errors_rad(trial, made))):5.2f} deg   given "
        f"{1e3 * rms(palm_errors_m(trial, given)):5.1f} mm "
        f"{np.degrees(rms(joint_errors_rad(trial, given))):5.2f} deg   "
        f"{1e3 * cpu:.2f} ms a frame, {1.0 / cpu / RATE_HZ:.1f} x real time"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=1, help="how many draws of noise")
    parser.add_argument("--seconds", type=float, default=8.0, help="of motion")
    asked = parser.parse_args()
    for seed in range(1, asked.seeds + 1):
        for who in ("man", "woman", "child"):
            label = "true body, on its marks"
            show(label, who, seed, asked.seconds, marks=True, arms=1.0, taped=True)
        for label, arms, taped in (
            ("true body, anywhere", 1.0, True),
            ("arms measured 3 % long", 1.03, True),
            ("arms guessed 3 % long", 1.03, False),
            ("arms guessed 3 % short", 0.97, False),
        ):
            show(label, "man", seed, asked.seconds, marks=False, arms=arms, taped=taped)


if __name__ == "__main__":
    main()
