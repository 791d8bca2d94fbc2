"""A demonstration in HDF5, made with MuJoCo alone: a gripper of two fingers carries a cube.

Fingers slide along x from where they are 9 cm apart; the palm moves freely along x, y and z; a lid
turns on a box that is fixed.
"""

import json
from itertools import pairwise
from pathlib import Path

import h5py
import numpy as np

MODEL = """
<mujoco model="tiny">
  <asset>
    <texture name="wood" type="2d" file="/nowhere/wood.png"/>
    <material name="wood" texture="wood"/>
    {asset}
  </asset>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 0.1" material="wood"/>
    <geom name="wall_visual" type="box" size="1 0.01 1" pos="0 2 1" contype="0" conaffinity="0"/>
    <body name="table" pos="0 0 0.2"><geom type="box" size="0.4 0.4 0.2"/></body>
    <body name="chest" pos="0.25 0.25 0.45">
      <geom type="box" size="0.05 0.05 0.05"/>
      <body name="lid" pos="0 0.05 0.055">
        <joint name="lid_hinge" type="hinge" axis="1 0 0" range="-1.5 0" limited="true"/>
        <geom type="box" size="0.05 0.05 0.004" pos="0 -0.05 0"/>
      </body>
    </body>
    <body name="cube_main" pos="0 0 0.42"><freejoint/>
      <geom type="box" size="0.02 0.02 0.02"/>{cube}
    </body>
    <body name="carriage_base" pos="0 0 0">
      <body name="carriage">
        <joint name="x" type="slide" axis="1 0 0"/>
        <joint name="y" type="slide" axis="0 1 0"/>
        <joint name="z" type="slide" axis="0 0 1"/>
        <inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/>
        <body name="left_palm">
          <geom type="box" size="0.08 0.02 0.02" pos="0 0 0.08"/>
          <body name="finger_a" pos="-0.045 0 0">
            <joint name="finger_a" type="slide" axis="1 0 0"/>
            <geom type="box" size="0.005 0.01 0.04" pos="-0.005 0 0.035"/>
          </body>
          <body name="finger_b" pos="0.045 0 0">
            <joint name="finger_b" type="slide" axis="-1 0 0"/>
            <geom type="capsule" size="0.005 0.035" pos="0.005 0 0.035"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator><position joint="x"/><position joint="finger_a"/><position joint="finger_b"/></actuator>
</mujoco>
"""
HZ = 20.0
GRASP_S, RELEASE_S = 1.5, 4.5
"""When both fingers are at the cube, and when they are off again."""


def states(*, early_s: float = 0.0, dropped: bool = False) -> np.ndarray:
    """The time, and positions: lid, cube, carriage, fingers; then 12 velocities of nothing.

    ``early_s``: by how much one finger comes to the cube earlier, and leaves it later [s].
    ``dropped``: whether the gripper opens while it rests in the air, from which the cube falls.
    """
    times = np.arange(0.0, 6.5, 1.0 / HZ)

    def course(*stops: tuple[float, float]) -> np.ndarray:
        """Smooth from stop to stop (time, value), at rest at each."""
        out = np.full(len(times), stops[0][1])
        for (start, here), (end, there) in pairwise(stops):
            share = np.clip((times - start) / (end - start), 0.0, 1.0)
            out += (there - here) * (10 * share**3 - 15 * share**4 + 6 * share**5)
        return out

    x = course((2.5, 0.0), (3.2, 0.25))
    z = course((0.0, 0.6), (1.0, 0.42), (1.7, 0.42), (2.5, 0.6), (3.2, 0.6), (4.2, 0.42),
               (4.7, 0.42), (5.7, 0.6))  # fmt: skip
    if dropped:
        z = course((0.0, 0.6), (1.0, 0.42), (1.7, 0.42), (2.5, 0.6), (5.2, 0.6), (6.2, 0.9))

    def shut(more_s: float) -> np.ndarray:
        first, last = GRASP_S - more_s, RELEASE_S + more_s
        return course((first - 0.4, 0.0), (first, 0.025), (last, 0.025), (last + 0.3, 0.0))

    held = (times >= GRASP_S) & (times <= RELEASE_S)
    fallen = np.maximum(z - 0.5 * 9.81 * (times - RELEASE_S) ** 2, 0.42) if dropped else 0.42
    lifted = np.where(times < GRASP_S, 0.42, np.where(held, z, fallen))
    zero, one = np.zeros_like(times), np.ones_like(times)
    cube = [np.where(times < GRASP_S, 0.0, x), zero, lifted, one, zero, zero, zero]
    rest = [zero] * (1 + 6 + 3 + 2)
    return np.stack([times, zero, *cube, x, zero, z, shut(early_s), shut(0.0), *rest], axis=1)


def write(
    path: Path, *, demos: int = 3, asset: str = "", cube: str = "", model: str | None = MODEL,
    table: np.ndarray | None = None,
) -> Path:  # fmt: skip
    """Demonstrations ``demo_0``, ``demo_1`` ... that are all alike."""
    with h5py.File(path, "w") as file:
        data = file.create_group("data")
        data.attrs["env_args"] = json.dumps({"env_kwargs": {"control_freq": HZ}})
        for number in range(demos):
            demo = data.create_group(f"demo_{number}")
            if model is not None:
                demo.attrs["model_file"] = model.format(asset=asset, cube=cube)
            demo["states"] = states() if table is None else table
            demo["actions"] = np.zeros((len(demo["states"]), 7))
    return path
