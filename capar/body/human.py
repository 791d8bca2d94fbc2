"""A body that can be postured and asked where its parts are."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from capar.body.anthropometry import Measures
from capar.body.model import body_spec
from capar.model.errors import CaparError, UnknownNameError

ROOT_SIZE = 7
"""Numbers of a posture that place the pelvis: x y z [m] and w x y z."""


class PostureError(CaparError):
    """A posture that the body's joints do not allow."""


@dataclass(frozen=True, eq=False)
class Human:
    """A body of certain measures. A *posture* is the pelvis's pose, then an angle a hinge [rad]."""

    measures: Measures
    model: mujoco.MjModel

    @classmethod
    def of(cls, measures: Measures) -> "Human":
        """The body with these measures."""
        return cls(measures, body_spec(measures).compile())

    @cached_property
    def joints(self) -> tuple[str, ...]:
        """Names of the hinges, in the order of a posture's angles."""
        return tuple(self.model.joint(each).name for each in range(1, self.model.njnt))

    @cached_property
    def ranges(self) -> Float[np.ndarray, "hinges 2"]:
        """Least and greatest angle of each hinge [rad]."""
        return np.array(self.model.jnt_range[1:])

    def index(self, joint: str) -> int:
        """Where a hinge's angle stands in a posture.

        Raises:
            UnknownNameError: There is no such hinge.
        """
        if joint not in self.joints:
            raise UnknownNameError("joint", joint, self.joints)
        return ROOT_SIZE + self.joints.index(joint)

    def posture(
        self,
        angles: Mapping[str, float] | None = None,
        *,
        place: Iterable[float] = (0.0, 0.0, 0.0),
        heading: float = 0.0,
    ) -> Float[np.ndarray, "posture"]:
        """The standing posture with some hinges turned.

        Args:
            angles: By hinge [rad]; the others are zero.
            place: Where the standing body's feet are [m].
            heading: Which way it looks, from x towards y [rad].

        Raises:
            PostureError: An angle is out of its hinge's range.
        """
        out = np.array(self.model.qpos0)
        x, y, z = place
        out[:3] = [x, y, z + self.measures.hip_height]
        out[3:7] = [np.cos(heading / 2), 0.0, 0.0, np.sin(heading / 2)]
        for joint, angle in (angles or {}).items():
            out[self.index(joint)] = angle
        self._check(out)
        return out

    def _check(self, posture: Float[np.ndarray, "posture"]) -> None:
        out = self.outside(posture[None])[0]
        for number in np.flatnonzero(out):
            low, high = np.degrees(self.ranges[number])
            angle = np.degrees(posture[ROOT_SIZE + number])
            raise PostureError(
                f"{self.joints[number]} at {angle:.1f} degrees; "
                f"it goes from {low:.0f} to {high:.0f}"
            )

    def outside(
        self, motion: Float[np.ndarray, "frames posture"], *, margin: float = 1e-6
    ) -> Bool[np.ndarray, "frames hinges"]:
        """Which hinges are out of range, by more than a margin [rad]."""
        angles = motion[:, ROOT_SIZE:]
        low, high = self.ranges.T
        return (angles < low - margin) | (angles > high + margin)

    def sites(
        self, motion: Float[np.ndarray, "frames posture"], names: Iterable[str]
    ) -> dict[str, tuple[Float[np.ndarray, "frames 3"], Float[np.ndarray, "frames 4"]]]:
        """World places [m] and orientations (w x y z) of sites or segments along a motion.

        Raises:
            UnknownNameError: The body has no such site or segment.
        """
        getters = {name: self._getter(name) for name in names}
        data = mujoco.MjData(self.model)
        places = {name: np.empty((len(motion), 3)) for name in getters}
        turns = {name: np.empty((len(motion), 4)) for name in getters}
        spots = {"body": data.xpos, "site": data.site_xpos}
        matrices = {"body": data.xmat, "site": data.site_xmat}
        rows = [
            (places[name], turns[name], spots[kind][number], matrices[kind][number])
            for name, (kind, number) in getters.items()
        ]
        for frame, posture in enumerate(motion):
            data.qpos[:] = posture
            mujoco.mj_kinematics(self.model, data)
            for place, turn, spot, matrix in rows:
                place[frame] = spot
                mujoco.mju_mat2Quat(turn[frame], matrix)
        return {name: (places[name], turns[name]) for name in getters}

    def centre_of_mass(self, posture: Float[np.ndarray, "posture"]) -> Float[np.ndarray, "3"]:
        """Where the centre of mass is in a posture [m]."""
        data = mujoco.MjData(self.model)
        data.qpos[:] = posture
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        return np.array(data.subtree_com[0])

    def _getter(self, name: str) -> tuple[str, int]:
        for kind, what in (("site", mujoco.mjtObj.mjOBJ_SITE), ("body", mujoco.mjtObj.mjOBJ_BODY)):
            number = mujoco.mj_name2id(self.model, what, name)
            if number >= 0:
                return kind, number
        known = [self.model.site(each).name for each in range(self.model.nsite)]
        known += [self.model.body(each).name for each in range(1, self.model.nbody)]
        raise UnknownNameError("place on the body", name, known)
