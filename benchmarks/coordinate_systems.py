"""Fig. 2 of Ben Amor et al. 2007: one recorded reach replayed for four new goals in two frames.

Run as ``PYTHONPATH=.:tests python benchmarks/coordinate_systems.py PICTURE.png``.
"""

import sys

import matplotlib as mpl
import mujoco
import numpy as np

from capar.body.scripted_actions import performed
from capar.regeneration.styles import Replay, replays

mpl.use("Agg")
from matplotlib import pyplot as plt

GOALS_M = np.array([[0.10, 0.05, 0.0], [0.0, 0.2, 0.05], [-0.08, -0.12, 0.12], [0.05, -0.15, -0.1]])
"""The four new places of the object, from the recorded one [m]."""


def recorded() -> tuple[np.ndarray, np.ndarray]:
    """The way of a virtual man's palm to a mug, and where his shoulder is before that [m]."""
    made = performed("drink", rate_hz=60.0)
    _, start, end = next(phase for phase in made.phases if phase[0] == "reach")
    rows = np.flatnonzero((made.times >= start) & (made.times <= end))
    palm = made.human.sites(made.motion, ["right_palm"])["right_palm"][0][rows]
    # The chain's first link is the upper arm, whose origin is the shoulder.
    model = made.human.model

    data = mujoco.MjData(model)
    data.qpos[:] = made.motion[rows[0]]
    mujoco.mj_kinematics(model, data)
    return palm, np.array(data.body("right_upper_arm").xpos)


def plot(path: np.ndarray, shoulder: np.ndarray, made: list[Replay], file: str) -> None:
    figure = plt.figure(figsize=(11, 5))
    for number, name in enumerate(("object-shoulder", "object-hand"), start=1):
        axes = figure.add_subplot(1, 2, number, projection="3d")
        axes.set_title(name)
        axes.plot(*path.T, color="black", linewidth=2.5, label="recorded")
        axes.scatter(*shoulder, color="black", marker="^", label="shoulder")
        for replay in made:
            way = replay.by_shoulder if number == 1 else replay.by_hand
            (line,) = axes.plot(*way.T)
            axes.scatter(*way[0], color=line.get_color(), marker=".")
            axes.scatter(*replay.goal, color=line.get_color(), marker="s")
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        axes.set_zlabel("z [m]")
        axes.set_aspect("equal")
        axes.legend()
    figure.savefig(file, dpi=90)


def main(file: str) -> None:
    path, shoulder = recorded()
    made = replays(path, shoulder, path[-1] + GOALS_M)
    print("goal   gap in object-hand   gap in object-shoulder")
    for number, replay in enumerate(made, start=1):
        hand_m, shoulder_m = replay.gaps(path[0])
        print(f"{number:4}   {1e3 * hand_m:15.3f} mm   {1e3 * shoulder_m:19.1f} mm")
    hand, chained = path[0], []
    for goal in path[-1] + GOALS_M:
        (replay,) = replays(path, shoulder, goal[None], hand=hand)
        chained.append(replay.gaps(hand))
        hand = replay.by_hand[-1]
    worst = 1e3 * np.max(chained, axis=0)
    print(
        f"chained: gap at most {worst[0]:.3f} mm in object-hand, {worst[1]:.1f} in object-shoulder"
    )
    plot(path, shoulder, made, file)


if __name__ == "__main__":
    main(sys.argv[1])
