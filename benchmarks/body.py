"""Accuracy and speed of fitting a body to eleven noisy sensors at 103.3 Hz.

A line has the first fit, what ``capar fit`` gives (refined where residuals ask for it), and the
first fit's speed.

Run as ``PYTHONPATH=.:tests python benchmarks/body.py``.
"""

import time

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


def show(label: str, *, who: str, seed: int, marks: bool, arms: float, taped: bool) -> None:
    trial = virtual_trial(who, seed=seed, seconds=8.0)
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


if __name__ == "__main__":
    for seed in (1, 2, 3):
        for who in ("man", "woman", "child"):
            show("true body, on its marks", who=who, seed=seed, marks=True, arms=1.0, taped=True)
        show("true body, anywhere", who="man", seed=seed, marks=False, arms=1.0, taped=True)
        show("arms measured 3 % long", who="man", seed=seed, marks=False, arms=1.03, taped=True)
        show("arms guessed 3 % long", who="man", seed=seed, marks=False, arms=1.03, taped=False)
        show("arms guessed 3 % short", who="man", seed=seed, marks=False, arms=0.97, taped=False)
