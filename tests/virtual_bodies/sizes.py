"""The ready-made people, and two hundred of random size."""

import numpy as np

from capar.body.anthropometry import Measures, estimate_measures, ready_made

READY = ("man", "woman", "child")


def random_person(seed: int) -> Measures:
    """A person of random age, sex and stature, some of whose measures differ from the usual."""
    rng = np.random.default_rng(seed)
    sex = str(rng.choice(["male", "female"]))
    age = float(rng.uniform(6.0, 60.0))
    usual = estimate_measures(sex=sex, age=age, percentile=float(rng.uniform(2.0, 98.0)))
    names = ["upper_arm", "forearm", "thigh", "shank", "mass", "hand_length"]
    some = rng.choice(names, size=int(rng.integers(0, 5)), replace=False)
    given = {str(n): usual[str(n)] * float(rng.uniform(0.95, 1.05)) for n in some}
    return estimate_measures(sex=sex, age=age, given={"stature": usual["stature"]} | given)


PEOPLE = {name: ready_made(name) for name in READY} | {
    f"seed {n}": random_person(n) for n in range(200)
}
