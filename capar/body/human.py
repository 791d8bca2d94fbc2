"""A body as a MuJoCo model that can be postured and asked where its parts are."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import Measures, is_right, mirrored, table
from capar.body.shapes import forms, palm_centre
from capar.body.skeleton import Segment, eyes_between, inertias, skeleton
from capar.model import geometry
from capar.model.errors import CaparError, UnknownNameError

#: Name of the free joint, and numbers of a posture that place the pelvis: x y z [m] and w x y z
ROOT, ROOT_SIZE = "root", 7
ARMATURE = 0.01  # added inertia of a hinge [kg m2], for simulations that step the model

_KINDS = {
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    "box": mujoco.mjtGeom.mjGEOM_BOX,
}


def body_spec(measures: Measures, *, prefix: str = "", fingers: bool = False) -> mujoco.MjSpec:
    """The specification of a body standing on z = 0, looking along x, its arms down.

    Every name is led by a prefix, so that several bodies share a scene. Hands have fingers that
    bend as one, or five each.
    """
    spec = mujoco.MjSpec()
    spec.modelname = f"{prefix}body"
    spec.compiler.degree = False
    segments = skeleton(measures, fingers=fingers)
    weights = inertias(measures, segments)
    bodies: dict[str, Any] = {"": spec.worldbody}
    for name, segment in segments.items():
        start = segments[segment.parent].origin if segment.parent else np.zeros(3)
        body = bodies[segment.parent].add_body(name=prefix + name, pos=segment.origin - start)
        body.explicitinertial = True
        body.mass, body.ipos, body.inertia = weights[name]
        if not segment.parent:
            body.add_freejoint(name=prefix + ROOT)
        bodies[name] = body
    for row in _with_left([*table("joints")["joint"], *finger_joints()]):
        if row["body"] not in segments:
            continue
        young, share = np.radians(row.get("child", row["range"])), measures.adult_share
        bodies[row["body"]].add_joint(
            name=prefix + row["name"],
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=np.array(row["axis"], dtype=float),
            limited=mujoco.mjtLimited.mjLIMITED_TRUE,
            range=(1.0 - share) * young + share * np.radians(row["range"]),
            armature=ARMATURE,
        )
    for row in site_rows():
        if row["body"] not in segments:
            continue
        base, axes = _site_base(row, measures, segments[row["body"]]), row.get("axes")
        bodies[row["body"]].add_site(
            name=prefix + row["name"],
            pos=base + np.array(row["offset"]) * measures["stature"],
            quat=axes_turn(axes["x"], axes["z"]).as_quat(scalar_first=True) if axes else None,
            size=[0.008, 0.0, 0.0],
            group=4,
        )
    for number, form in enumerate(forms(measures, segments)):
        turn = Rotation.identity()
        if form.kind == "capsule":
            upwards = np.array([0.0, 0.0, 1.0])
            turn, _ = Rotation.align_vectors(form.axis / np.linalg.norm(form.axis), upwards)
        bodies[form.body].add_geom(
            name=f"{prefix}{form.body}_{number}",
            type=_KINDS[form.kind],
            pos=form.centre,
            quat=turn.as_quat(scalar_first=True),
            size=form.half,
            rgba=table("shapes")["colours"][form.colour],
            mass=0.0,
            contype=0,
            conaffinity=0,
        )
    return spec


def _with_left(right: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows, each of the right side followed by its mirror image."""
    out = []
    for row in right:
        out.append(row)
        if is_right(row["body"]):
            x, y, z = row["axis"]
            names = {key: mirrored(row[key]) for key in ("body", "name")}
            out.append({**row, **names, "axis": [-x, y, -z]})
    return out


def finger_joints() -> list[dict[str, Any]]:
    """The hinges of the right hand's five fingers, like rows of the table of joints."""
    out = []
    for finger, row in table("fingers")["finger"].items():
        axis = [0, 1, 0] if finger == "thumb" else [1, 0, 0]
        if "opposition_deg" in row:
            out.append(_finger_joint(finger, 1, "opposition", [0, 0, 1], row["opposition_deg"]))
        for number, limits in enumerate(row["range_deg"], 1):
            out.append(_finger_joint(finger, number, f"flexion_{number}", axis, limits))
    return out


def _finger_joint(
    finger: str, number: int, name: str, axis: list[int], limits: list[float]
) -> dict[str, Any]:
    row = {"body": f"right_{finger}_{number}", "name": f"right_{finger}_{name}"}
    return {**row, "axis": axis, "range": limits}


def site_rows() -> list[dict[str, Any]]:
    """Every site, those of the left side mirrored."""
    right = [*table("sites")["site"], *table("landmarks")["site"]]
    flip, out = np.array([1.0, -1.0, 1.0]), list(right)
    for row in right:
        if is_right(row["name"]):
            axes = {key: np.array(axis) * flip for key, axis in row.get("axes", {}).items()}
            names = {key: mirrored(row[key]) for key in ("name", "body")}
            out.append({**row, **names, "offset": np.array(row["offset"]) * flip, "axes": axes})
    return out


def _site_base(row: Mapping[str, Any], m: Measures, segment: Segment) -> Float[np.ndarray, "3"]:
    if row.get("of") == "eyes":
        return eyes_between(m) - segment.origin
    if row.get("of") == "palm":
        return np.array(palm_centre(m) * [1.0, 1.0 if is_right(segment.name) else -1.0, 1.0])
    if row.get("of") == "sole":
        return np.array([0.1 * m["foot_length"], 0.0, -m["ankle_height"]])
    return np.asarray(row["along"] * (segment.tip - segment.origin))


def axes_turn(x: Iterable[float], z: Iterable[float]) -> Rotation:
    """The rotation that brings x and z axes to directions at a right angle to each other."""
    along, up = np.array([*x], dtype=float), np.array([*z], dtype=float)
    return Rotation.from_matrix(np.stack([along, np.cross(up, along), up], axis=1))


class PostureError(CaparError):
    """A posture that the body's joints do not allow."""


@dataclass(frozen=True, eq=False)
class Human:
    """A body of certain measures. A *posture* is the pelvis's pose, then an angle a hinge [rad]."""

    measures: Measures
    model: mujoco.MjModel
    fingers: bool = False  #: Whether hands have five fingers each, else they bend as one

    @classmethod
    def of(cls, measures: Measures, *, fingers: bool = False) -> "Human":
        """The body with these measures."""
        return cls(measures, body_spec(measures, fingers=fingers).compile(), fingers)

    @property
    def segments(self) -> Mapping[str, Segment]:
        """Its segments, standing."""
        return skeleton(self.measures, fingers=self.fingers)

    @cached_property
    def joints(self) -> tuple[str, ...]:
        """Names of the hinges, in the order of a posture's angles."""
        return tuple(self.model.joint(each).name for each in range(1, self.model.njnt))

    @cached_property
    def ranges(self) -> Float[np.ndarray, "hinges 2"]:
        """Least and greatest angle of each hinge [rad]."""
        return np.array(self.model.jnt_range[1:])

    def index(self, joint: str) -> int:
        """Where a hinge's angle stands in a posture."""
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
        """The standing posture with some hinges turned [rad].

        The feet are at a place [m]; the heading is from x towards y [rad].

        Raises:
            PostureError: An angle is out of its hinge's range.
        """
        out = np.array(self.model.qpos0)
        x, y, z = place
        out[:3] = [x, y, z + self.measures.hip_height]
        out[3:7] = [np.cos(heading / 2), 0.0, 0.0, np.sin(heading / 2)]
        for joint, angle in (angles or {}).items():
            out[self.index(joint)] = angle
        for number in np.flatnonzero(self.outside(out[None])[0]):
            low, high = np.degrees(self.ranges[number])
            raise PostureError(
                f"{self.joints[number]} at {np.degrees(out[ROOT_SIZE + number]):.1f} degrees; "
                f"it goes from {low:.0f} to {high:.0f}"
            )
        return out

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
        """World places [m] and orientations (w x y z) of sites or segments along a motion."""
        getters = {name: self.frame(name) for name in names}
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

    def frame(self, name: str) -> tuple[str, int]:
        """Whether a place on the body is a ``site`` or a segment (``body``), and its number.

        Raises:
            UnknownNameError: The body has no such site or segment.
        """
        for kind, what in (("site", mujoco.mjtObj.mjOBJ_SITE), ("body", mujoco.mjtObj.mjOBJ_BODY)):
            number = mujoco.mj_name2id(self.model, what, name)
            if number >= 0:
                return kind, number
        known = [self.model.site(each).name for each in range(self.model.nsite)]
        known += [self.model.body(each).name for each in range(1, self.model.nbody)]
        raise UnknownNameError("place on the body", name, known)


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of all segments, parents first; the first is the pelvis."""

    names: tuple[str, ...]
    parents: tuple[int, ...]  #: Number of each segment's parent; -1 for the pelvis
    #: Each segment's joint in its parent's frame [m]; the pelvis's in the world, standing
    offsets: Float[np.ndarray, "segments 3"]
    positions: Float[np.ndarray, "frames segments 3"]  #: In the world [m], z up
    #: In the world, w x y z; standing, all are the world's: x forward, y left, z up
    orientations: Float[np.ndarray, "frames segments 4"]
    #: Against the parent, w x y z, without jumps of sign; the pelvis's in the world
    turns: Float[np.ndarray, "frames segments 4"]


def poses_of(human: Human, motion: Float[np.ndarray, "frames posture"]) -> Poses:
    """The poses that a motion brings the segments to."""
    model = human.model
    names = tuple(model.body(body).name for body in range(1, model.nbody))
    where = human.sites(motion, names)
    orientations = np.stack([where[name][1] for name in names], axis=1)
    parents = tuple(int(parent) - 1 for parent in model.body_parentid[1:])
    turns = orientations.copy()
    for number, parent in enumerate(parents[1:], 1):
        base, own = (geometry.rotations(orientations[:, each]) for each in (parent, number))
        turns[:, number] = geometry.quaternions(base.inv() * own)
    smooth = (
        np.stack([geometry.continuous(each[:, n]) for n in range(len(names))], axis=1)
        for each in (orientations, turns)
    )
    positions = np.stack([where[name][0] for name in names], axis=1)
    return Poses(names, parents, np.array(model.body_pos[1:]), positions, *smooth)
