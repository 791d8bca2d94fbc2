"""Fig. 2 of Ben Amor et al. 2007: one recorded reach replayed for four new goals in two frames.

Run as ``PYTHONPATH=.:tests python benchmarks/coordinate_systems.py [PICTURE.png]``.
"""

import sys

import matplotlib as mpl
import mujoco
import numpy as np

from capar.body.scripted_actions import performed
from capar.regeneration.styles import frame_between, replayed

mpl.use("Agg")
from matplotlib import pyplot as plt

GOALS_M = np.array([[0.10, 0.05, 0.0], [0.0, 0.2, 0.05], [-0.08, -0.12, 0.12], [0.05, -0.15, -0.1]])
"""The four new places of the object, from the recorded one [m]."""


def recorded() -> tuple[np.ndarray, np.ndarray]:
    """The path of a virtual man's palm to a mug, and where his shoulder is before that [m]."""
    made = performed("drink", rate_hz=60.0)
    _, start, end = next(phase for phase in made.phases if phase[0] == "reach")
    rows = np.flatnonzero((made.times >= start) & (made.times <= end))
    palm = made.human.sites(made.motion, ["right_palm"])["right_palm"][0][rows]
    data = mujoco.MjData(made.human.model)
    data.qpos[:] = made.motion[rows[0]]
    mujoco.mj_kinematics(made.human.model, data)
    # The chain's first link is the upper arm, whose origin is the shoulder.
    return palm, np.array(data.body("right_upper_arm").xpos)


def main(file: str) -> None:
    """Print the gaps at the start, and draw both."""
    path, shoulder = recorded()
    figure = plt.figure(figsize=(11, 5))
    for number, (name, base) in enumerate(
        (("object-hand", path[0]), ("object-shoulder", shoulder)), start=1
    ):
        axes = figure.add_subplot(1, 2, number, projection="3d", title=name, aspect="equal")
        axes.plot(*path.T, color="black", linewidth=2.5, label="recorded")
        before = frame_between(path[-1], base)
        for goal in path[-1] + GOALS_M:
            made = replayed(path, before, frame_between(goal, base))
            axes.plot(*made.T)
            gap_m, miss_m = (np.linalg.norm(made[k] - end) for k, end in ((0, path[0]), (-1, goal)))
            print(f"{name:15} starts {1e3 * gap_m:6.1f} mm off, ends {1e3 * miss_m:.3f} mm off")
    figure.savefig(file, dpi=90)
    print(f"drawn to {file}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "coordinate_systems.png")
