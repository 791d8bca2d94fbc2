"""The MuJoCo model of a body: segments, hinges, inertias, sites and mannequin, from measures."""

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.anthropometry import Measures
from capar.body.body_shapes import Form, forms, palm_centre
from capar.body.data_files import is_right, mirrored, table
from capar.body.inertia import Inertia, inertias
from capar.body.skeleton import Segment, eyes_between, skeleton

ROOT = "root"
"""Name of the free joint."""

ARMATURE = 0.01
"""Added inertia of a hinge [kg m2], for simulations that step the model."""

_KINDS = {
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    "box": mujoco.mjtGeom.mjGEOM_BOX,
}


def body_spec(measures: Measures, *, prefix: str = "") -> mujoco.MjSpec:
    """The specification of a body standing on z = 0, looking along x, its arms down.

    Args:
        measures: Of whom.
        prefix: Put before every name, so that several bodies share a scene.
    """
    spec = mujoco.MjSpec()
    spec.modelname = f"{prefix}body"
    spec.compiler.degree = False
    segments = skeleton(measures)
    weights = inertias(measures, segments)
    bodies: dict[str, Any] = {}
    for name, segment in segments.items():
        bodies[name] = _add_segment(spec, bodies, segment, segments, weights[name], prefix)
    for row in joint_rows(measures):
        _add_hinge(bodies[row["body"]], row, prefix)
    for row in site_rows():
        _add_site(bodies[row["body"]], row, measures, segments[row["body"]], prefix)
    for number, form in enumerate(forms(measures, segments)):
        _add_form(bodies[form.body], form, f"{prefix}{form.body}_{number}")
    return spec


def joint_rows(measures: Measures) -> list[dict[str, Any]]:
    """Every hinge with its axis, and its range [rad] between a child's and an adult's by age."""
    out = []
    for row in table("joints")["joint"]:
        young = np.radians(row.get("child", row["range"]))
        grown, share = np.radians(row["range"]), measures.adult_share
        one = {**row, "range": (1.0 - share) * young + share * grown}
        out.append(one)
        if is_right(row["body"]):
            out.append(_mirror_hinge(one))
    return out


def site_rows() -> list[dict[str, Any]]:
    """Every site, those of the left side mirrored."""
    right = [*table("sites")["site"], *table("landmarks")["site"]]
    return [*right, *(_mirror_site(row) for row in right if is_right(row["name"]))]


def sensor_sites() -> tuple[str, ...]:
    """The sites of the thesis's eleven body sensors (thesis 5.1)."""
    return tuple(row["name"] for row in site_rows() if row.get("sensor"))


def _mirror_hinge(row: Mapping[str, Any]) -> dict[str, Any]:
    x, y, z = row["axis"]
    names = {key: mirrored(row[key]) for key in ("body", "name")}
    return {**row, **names, "axis": [-x, y, -z]}


def _mirror_site(row: Mapping[str, Any]) -> dict[str, Any]:
    flip = np.array([1.0, -1.0, 1.0])
    axes = {key: np.array(axis) * flip for key, axis in row.get("axes", {}).items()}
    names = {"name": mirrored(row["name"]), "body": mirrored(row["body"])}
    return {**row, **names, "offset": np.array(row["offset"]) * flip, "axes": axes}


def _add_segment(
    spec: mujoco.MjSpec,
    bodies: Mapping[str, Any],
    segment: Segment,
    segments: Mapping[str, Segment],
    weight: Inertia,
    prefix: str,
) -> Any:
    parent = bodies[segment.parent] if segment.parent else spec.worldbody
    start = segments[segment.parent].origin if segment.parent else np.zeros(3)
    body = parent.add_body(name=prefix + segment.name, pos=segment.origin - start)
    body.explicitinertial = True
    body.mass, body.ipos, body.inertia = weight.mass, weight.centre, weight.moments
    if not segment.parent:
        body.add_freejoint(name=prefix + ROOT)
    return body


def _add_hinge(body: Any, row: Mapping[str, Any], prefix: str) -> None:
    body.add_joint(
        name=prefix + row["name"],
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=np.array(row["axis"], dtype=float),
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
        range=row["range"],
        armature=ARMATURE,
    )


def _add_site(
    body: Any, row: Mapping[str, Any], m: Measures, segment: Segment, prefix: str
) -> None:
    place = _site_base(row, m, segment) + np.array(row["offset"]) * m["stature"]
    body.add_site(
        name=prefix + row["name"],
        pos=place,
        quat=_turn(row.get("axes")).as_quat(scalar_first=True),
        size=[0.008, 0.0, 0.0],
        group=4,
    )


def _site_base(row: Mapping[str, Any], m: Measures, segment: Segment) -> Float[np.ndarray, "3"]:
    if row.get("of") == "eyes":
        return eyes_between(m) - segment.origin
    if row.get("of") == "palm":
        return np.array(palm_centre(m) * [1.0, 1.0 if is_right(segment.name) else -1.0, 1.0])
    if row.get("of") == "sole":
        return np.array([0.1 * m["foot_length"], 0.0, -m["ankle_height"]])
    return np.asarray(row["along"] * (segment.tip - segment.origin))


def _turn(axes: Mapping[str, Any] | None) -> Rotation:
    if not axes:
        return Rotation.identity()
    x, z = np.array(axes["x"], dtype=float), np.array(axes["z"], dtype=float)
    return Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=1))


def _add_form(body: Any, form: Form, name: str) -> None:
    upwards = np.array([0.0, 0.0, 1.0])
    turn = Rotation.identity()
    if form.kind == "capsule":
        turn, _ = Rotation.align_vectors(form.axis / np.linalg.norm(form.axis), upwards)
    body.add_geom(
        name=name,
        type=_KINDS[form.kind],
        pos=form.centre,
        quat=turn.as_quat(scalar_first=True),
        size=form.half,
        rgba=table("shapes")["colours"][form.colour],
        mass=0.0,
        contype=0,
        conaffinity=0,
    )
