"""The mannequin: capsules, ellipsoids and boxes about the segments, and their surfaces."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import trimesh
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures, is_right, mirrored, table
from capar.body.skeleton import BALL, HEEL, Segment, eyes_between, skeleton
from capar.model.capture import Shape

CHIN_BELOW_EYES = 0.063  # [share of stature]; Drillis & Contini 1966 have the chin at 0.870

#: Half the breadth and half the thickness of the palm [share of the hand's length]
PALM = (0.22, 0.075)
#: Distance of the middle of the palm from the wrist [share of the hand's length]
PALM_FROM_WRIST = 0.42
USUAL_MASS = 27.0  # mass over squared stature of the body whose girths the data file gives [kg/m2]

#: Breadth between the acromia of the same body [share of stature]; Gordon et al. 2014
USUAL_BREADTH = 0.2368


@dataclass(frozen=True, eq=False)
class Form:
    """One primitive in a segment's frame."""

    body: str
    kind: str  #: ``capsule``, ``ellipsoid`` or ``box``
    centre: Float[np.ndarray, "3"]  #: [m]
    #: Half sizes [m]; of a capsule its radius, then half the length of its axis, then 0
    half: Float[np.ndarray, "3"]
    colour: str
    #: Direction of a capsule's axis [1]; other forms lie along the world's axes, standing
    axis: Float[np.ndarray, "3"] = field(default_factory=lambda: np.zeros(3))


def forms(measures: Measures, segments: Mapping[str, Segment]) -> list[Form]:
    """Every primitive of the mannequin."""
    middle = [_row_form(row, measures, segments) for row in table("shapes")["shape"]]
    middle += [*_head(measures, segments), *_hand(measures, segments), *_foot(measures, segments)]
    flip = np.array([1.0, -1.0, 1.0])
    return middle + [
        replace(e, body=mirrored(e.body), centre=e.centre * flip, axis=e.axis * flip)
        for e in middle
        if is_right(e.body)
    ]


def _row_form(row: dict[str, Any], m: Measures, segments: Mapping[str, Segment]) -> Form:
    tall, segment = m["stature"], segments[row["body"]]
    wide = (m["mass"] / tall**2 / USUAL_MASS) ** 0.5 if row.get("girth") else 1.0
    along, offset = segment.tip - segment.origin, np.array(row.get("offset", [0, 0, 0])) * tall
    if row["type"] == "capsule":
        ends = [row[key] * along + offset for key in ("from", "to")]
        half = np.array([row["size"] * tall * wide, 0.5 * np.linalg.norm(ends[1] - ends[0]), 0.0])
        return Form(row["body"], "capsule", sum(ends) / 2, half, row["colour"], ends[1] - ends[0])
    broad = m["shoulder_breadth"] / tall / USUAL_BREADTH if row.get("broad") else 1.0
    half = np.array(row["half"]) * tall * np.array([wide, max(wide * broad, wide), 1.0])
    return Form(row["body"], row["type"], row["at"] * along + offset, half, row["colour"])


def _head(m: Measures, segments: Mapping[str, Segment]) -> Iterator[Form]:
    tall, long = m["stature"], m["head_length"]
    origin, eyes = segments["head"].origin, eyes_between(m)
    chin = m["eye_height"] - CHIN_BELOW_EYES * tall
    half = np.array([0.5 * long, 0.5 * m["head_breadth"], 0.5 * (0.82 * (tall - chin))])
    jaw = np.array([0.34, 0.40, 0.30]) * [long, m["head_breadth"], tall - chin]
    hair = half * [1.02, 1.05, 0.72]
    nose = np.array([0.010, 0.007, 0.013]) * tall
    for centre, sizes, colour in (
        (np.array([origin[0], 0.0, tall - half[2]]), half, "skin"),
        (np.array([origin[0] + 0.12 * long, 0.0, chin + jaw[2]]), jaw, "skin"),
        (np.array([origin[0] - 0.06 * long, 0.0, tall - hair[2]]), hair, "hair"),
        (eyes + np.array([0.04 * long, 0.0, -0.022 * tall]), nose, "skin"),
    ):
        yield Form("head", "ellipsoid", centre - origin, sizes, colour)
    ball, ahead = 0.062 * long, np.array([0.75 * (0.062 * long), 0, 0])
    yield Form("right_eye", "ellipsoid", np.zeros(3), np.full(3, ball), "white")
    yield Form("right_eye", "ellipsoid", ahead, np.full(3, 0.5 * ball), "pupil")


def _hand(m: Measures, segments: Mapping[str, Segment]) -> Iterator[Form]:
    """A palm, and what there is: fingers that bend as one, and a thumb; or five fingers."""
    long = m["hand_length"]
    for name, kind, wide, thick in (
        ("right_hand", "box", *PALM),
        ("right_fingers", "box", 0.205, 0.052),
        ("right_fingertips", "ellipsoid", 0.175, 0.045),
    ):
        if "right_fingers" not in segments:
            break
        along = segments[name].tip - segments[name].origin
        sizes = np.array([wide * long, thick * long, 0.5 * abs(along[2]) + 0.02 * long])
        yield Form(name, kind, 0.5 * along, sizes, "skin")
    for finger, row in (
        table("fingers")["finger"].items() if "right_fingers" not in segments else ()
    ):
        knuckle = row["base"]
        if finger != "thumb":  # its part of the palm
            along = np.array([0.0, 0.0, knuckle[2]]) * long
            half = np.array([PALM[1] * long, 0.5 * abs(along[2]), 0.0])
            at = np.array([knuckle[0], 0.0, 0.0]) * long
            yield Form("right_hand", "capsule", at + 0.5 * along, half, "skin", along)
        for number, share in enumerate(row["radii"], 1):
            if (bone := segments.get(f"right_{finger}_{number}")) is not None:
                radius = share * long
                cut = radius / bone.length if number == len(row["radii"]) else 0.0
                along = (1.0 - cut) * (bone.tip - bone.origin)
                half = np.array([radius, 0.5 * float(np.linalg.norm(along)), 0.0])
                yield Form(bone.name, "capsule", 0.5 * along, half, "skin", along)
    if "right_thumb" not in segments:
        return
    along = segments["right_thumb"].tip - segments["right_thumb"].origin
    half = np.array([0.055 * long, 0.5 * float(np.linalg.norm(along)), 0.0])
    yield Form("right_thumb", "capsule", 0.5 * along, half, "skin", along)


def palm_centre(m: Measures) -> Float[np.ndarray, "3"]:
    """The middle of the right palm's surface in the hand's frame [m]."""
    return np.array([0.0, PALM[1], -PALM_FROM_WRIST]) * m["hand_length"]


def _foot(m: Measures, segments: Mapping[str, Segment]) -> Iterator[Form]:
    long, wide, high = m["foot_length"], m["foot_breadth"], m["ankle_height"]
    sole = np.array([0.5 * (HEEL + BALL) * long, 0.42 * wide, 0.12 * high])
    centre = np.array([0.5 * (BALL - HEEL) * long, 0.0, sole[2] - high])
    yield Form("right_foot", "box", centre, sole, "shoe")
    heel = np.array([0.55 * HEEL * long, 0.36 * wide, 0.45 * high])
    centre = np.array([-HEEL * long + heel[0], 0.0, heel[2] - high])
    yield Form("right_foot", "ellipsoid", centre, heel, "shoe")
    instep = np.array([0.22 * long, 0.36 * wide, 0.55 * high])
    centre = np.array([0.06 * long, 0.0, -0.45 * high])
    yield Form("right_foot", "ellipsoid", centre, instep, "shoe")
    toes = segments["right_toes"]
    half = np.array([1.05 * (toes.tip - toes.origin)[0], 0.42 * wide, 0.30 * high])
    centre = np.array([0.0, 0.0, half[2] - toes.origin[2]])
    yield Form("right_toes", "ellipsoid", centre, half, "shoe")


def form_mesh(form: Form) -> trimesh.Trimesh:
    """A primitive's surface in its segment's frame [m]."""
    if form.kind == "box":
        mesh: trimesh.Trimesh = trimesh.creation.box(extents=2.0 * form.half)
    elif form.kind == "ellipsoid":
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=1.0)
        mesh.vertices = np.array(mesh.vertices) * form.half
    else:
        radius, half = form.half[:2]
        mesh = trimesh.creation.capsule(height=2.0 * half, radius=radius, count=[16, 12])
        mesh.apply_translation(-mesh.bounds.mean(axis=0))
        turn, _ = Rotation.align_vectors([form.axis / np.linalg.norm(form.axis)], [[0.0, 0.0, 1.0]])
        mesh.vertices = turn.apply(np.array(mesh.vertices))
    mesh.apply_translation(form.centre)
    return mesh


def joined(group: list[trimesh.Trimesh]) -> trimesh.Trimesh:
    """Several surfaces as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in group)])
    faces = [np.array(each.faces) + start for each, start in zip(group, starts, strict=False)]
    vertices = np.concatenate([np.array(mesh.vertices) for mesh in group])
    return trimesh.Trimesh(vertices, np.concatenate(faces), process=False)


def segment_surface(measures: Measures, segments: tuple[str, ...], frame: str) -> Shape:
    """The surface of some segments of the standing body, in the frame of one of them."""
    bones = skeleton(measures)
    parts = []
    for form in forms(measures, bones):
        if form.body in segments:
            mesh = form_mesh(form)
            mesh.apply_translation(bones[form.body].origin - bones[frame].origin)
            parts.append(mesh)
    mesh = sum(parts[1:], parts[0])
    return Shape(np.array(mesh.vertices), np.array(mesh.faces), description=" and ".join(segments))


def moved(shape: Shape, pose: RigidTransform) -> Shape:
    """The same surface in another frame."""
    return Shape(pose.apply(shape.vertices), np.array(shape.faces), description=shape.description)
