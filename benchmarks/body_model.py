"""The model's exactness and the gaze's, in figures: what tests of the body hold to limits.

Run as ``PYTHONPATH=.:tests python benchmarks/body_model.py [SIZES]``.
"""

import sys

import numpy as np
from virtual_bodies.sizes import LIMBS, PEOPLE, READY

from capar.body.anthropometry import Measures, ready_made, table
from capar.body.gaze import look_at
from capar.body.human import Human

ENDS = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shank", "shank": "foot"}


def worst(measures: Measures) -> tuple[float, float]:
    """Error of the mass [kg] and the largest of a limb's length [m]."""
    human = Human.of(measures)
    mass = abs(float(human.model.body_subtreemass[0]) - measures["mass"])
    names = [f"right_{part}" for limb in LIMBS for part in (limb, ENDS[limb])]
    at = human.sites(human.posture()[None], names)
    lengths = (
        abs(
            float(np.linalg.norm(at[f"right_{limb}"][0] - at[f"right_{ENDS[limb]}"][0]))
            - measures[limb]
        )
        for limb in LIMBS
    )
    return mass, max(lengths)


def gaze(who: str) -> float:
    """Worst miss of either eye over a grid of points at 0.8 m [rad]."""
    human = Human.of(ready_made(who))
    eyes = human.sites(human.posture()[None], ["between_eyes"])["between_eyes"][0][0]
    missed = 0.0
    for azimuth in np.radians([-80.0, -45.0, 0.0, 20.0, 60.0, 90.0]):
        for height in np.radians([-50.0, 0.0, 30.0]):
            flat = np.cos(height) * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
            point = eyes + 0.8 * np.array([*flat[:2], np.sin(height)])
            missed = max(missed, float(look_at(human, human.posture(), point).missed_rad.max()))
    return missed


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else len(PEOPLE)
    found = np.array([worst(measures) for measures in list(PEOPLE.values())[:count]])
    mass, length = found.max(axis=0)
    print(f"{count} sizes: mass to {mass:.1e} kg, limbs to {1e3 * length:.1e} mm")
    for who in READY:
        human = Human.of(ready_made(who))
        high = float(human.centre_of_mass(human.posture())[2]) / human.measures["stature"]
        published = table("anthropometry")["standing_centre_of_mass"][who]["of_stature"]
        print(
            f"{who}: centre of mass at {high:.4f} of stature, published {published:.4f}, "
            f"off by {100 * abs(high - published):.2f} %; "
            f"gaze missed by {np.degrees(gaze(who)):.2f} degrees at most"
        )


if __name__ == "__main__":
    main()
