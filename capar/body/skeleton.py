"""The skeleton in its standing posture: ends and inertias of all segments, from measures."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.body.anthropometry import Measures, is_right, mirrored, table

#: Where the spine bends, from the sacrum (0) to cervicale (1): L5/S1, L3/4, T12/L1, T6/7
SPINE = {
    "lumbar_lower": (0.0, 0.15),
    "lumbar_upper": (0.15, 0.38),
    "thorax_lower": (0.38, 0.70),
    "thorax_upper": (0.70, 1.0),
}
SACRUM_ABOVE_HIPS = 0.045  # height of L5/S1 above the hip joints [share of stature] (estimate)

#: Depth of the shoulder's centre below the acromion [share of stature]
SHOULDER_BELOW_ACROMION = 0.0265
#: Distance of the shoulders' centres as a share of the biacromial breadth [1] (estimate)
SHOULDER_BREADTH = 0.92
#: Distance of a hip joint from the midline, of the breadth between the spines (Bell 1990) [1]
HIP_OF_SPINES = 0.36
HEAD_BELOW_EYES = 0.013  # depth of the head's joint below the eyes [share of stature] (estimate)

DOWN = np.array([0.0, 0.0, -1.0])

HEEL = 0.26  # how far the heel lies behind the ankle [share of the foot's length] (estimate)

#: Segments of the right hand whose fingers bend as one, which five fingers take the place of
MITTEN = ("right_fingers", "right_fingertips", "right_thumb")

#: How far the ball of the foot lies before the ankle [share of the foot's length] (estimate)
BALL = 0.47


@dataclass(frozen=True, eq=False)
class Segment:
    """One rigid part of the body, in the world's axes, standing with the arms down."""

    name: str
    parent: str  #: Name of the segment that it hangs on; empty for the pelvis
    origin: Float[np.ndarray, "3"]  #: Its joint with the parent [m]
    tip: Float[np.ndarray, "3"]  #: Its far end: the next joint, or where it ends [m]

    @property
    def length(self) -> float:
        """From joint to far end [m]."""
        return float(np.linalg.norm(self.tip - self.origin))


def skeleton(measures: Measures, *, fingers: bool = False) -> Mapping[str, Segment]:
    """Every segment by name, each after its parent; x forward, y left, z up, feet on z = 0.

    With ``fingers``, hands have five of three bones each, ``right_index_1`` to ``right_index_3``.
    """
    right, flip = _right_side(measures), np.array([1.0, -1.0, 1.0])
    if fingers:
        wrist = next(each.origin for each in right if each.name == "right_hand")
        bones = _fingers(measures["hand_length"], wrist)
        right = [*(each for each in right if each.name not in MITTEN), *bones]
    left = (
        Segment(mirrored(s.name), mirrored(s.parent), s.origin * flip, s.tip * flip) for s in right
    )
    return {each.name: each for each in (*_trunk(measures), *right, *left)}


def _trunk(m: Measures) -> list[Segment]:
    tall, hip, neck = m["stature"], m.hip_height, m["cervicale_height"]
    sacrum = hip + SACRUM_ABOVE_HIPS * tall
    heights = {"pelvis": (hip, sacrum)}
    for name, ends in SPINE.items():
        heights[name] = (sacrum + ends[0] * (neck - sacrum), sacrum + ends[1] * (neck - sacrum))
    parents = ("", *heights)
    out = [
        Segment(name, parent, np.array([0.0, 0.0, low]), np.array([0.0, 0.0, high]))
        for parent, (name, (low, high)) in zip(parents, heights.items(), strict=False)
    ]
    at = np.array([0.008 * tall, 0.0, m["eye_height"] - HEAD_BELOW_EYES * tall])
    out.append(Segment("neck", "thorax_upper", np.array([0.0, 0.0, neck]), at))
    out.append(Segment("head", "neck", at, np.array([0.008 * tall, 0.0, tall])))
    return out


def eyes_between(m: Measures) -> Float[np.ndarray, "3"]:
    """The point between the eyes, standing [m]."""
    forward = 0.008 * m["stature"] + 0.40 * m["head_length"]
    return np.array([forward, 0.0, m["eye_height"]])


def _right_side(m: Measures) -> list[Segment]:
    """Arm, leg and eye."""
    tall, down, hand, foot = m["stature"], DOWN, m["hand_length"], m["foot_length"]
    aside = -0.5 * SHOULDER_BREADTH * m["shoulder_breadth"]
    shoulder = np.array([0.0, aside, m["acromial_height"] - SHOULDER_BELOW_ACROMION * tall])
    sternum = np.array([0.03 * tall, -0.012 * tall, m["suprasternale_height"] - 0.005 * tall])
    elbow = shoulder + m["upper_arm"] * down
    wrist = elbow + m["forearm"] * down
    knuckle, middle = wrist + 0.52 * hand * down, wrist + 0.78 * hand * down
    base = wrist + 0.22 * hand * down + [0.16 * hand, 0.04 * hand, 0.0]
    thumb = base + 0.36 * hand * np.array([0.45, 0.15, -0.88])
    hip = np.array([0.0, -HIP_OF_SPINES * m["spine_breadth"], m.hip_height])
    knee = hip + m["thigh"] * down
    ankle = knee + m["shank"] * down
    ball = np.array([BALL * foot, hip[1], 0.35 * m["ankle_height"]])
    toe = ball + np.array([(1.0 - HEEL - BALL) * foot, 0.0, 0.0])
    eye = eyes_between(m) - [0.0, 0.5 * m["pupil_distance"], 0.0]
    return [
        Segment("right_clavicle", "thorax_upper", sternum, shoulder),
        Segment("right_upper_arm", "right_clavicle", shoulder, elbow),
        Segment("right_forearm", "right_upper_arm", elbow, wrist),
        Segment("right_hand", "right_forearm", wrist, knuckle),
        Segment("right_fingers", "right_hand", knuckle, middle),
        Segment("right_fingertips", "right_fingers", middle, wrist + hand * down),
        Segment("right_thumb", "right_hand", base, thumb),
        Segment("right_thigh", "pelvis", hip, knee),
        Segment("right_shank", "right_thigh", knee, ankle),
        Segment("right_foot", "right_shank", ankle, ball),
        Segment("right_toes", "right_foot", ball, toe),
        Segment("right_eye", "head", eye, eye + np.array([0.012, 0.0, 0.0])),
    ]


def _fingers(hand_m: float, wrist: Float[np.ndarray, "3"]) -> list[Segment]:
    """The bones of the right hand's fingers, open."""
    out, bones = [], table("fingers")
    for finger, row in bones["finger"].items():
        at, parent = wrist + hand_m * np.array(row["base"]), "right_hand"
        turns = np.radians(row["outwards_deg"])
        for number, (bone_mm, turn) in enumerate(zip(row["bones_mm"], turns, strict=True), 1):
            way = np.array([np.sin(turn), 0.0, -np.cos(turn)])
            tip = at + hand_m * bone_mm / bones["hand_mm"] * way
            out.append(Segment(f"right_{finger}_{number}", parent, at, tip))
            at, parent = tip, out[-1].name
    return out


LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
TRUNK = ("lower_trunk", "middle_trunk", "upper_trunk")  # from the hips upwards

#: The segment that a small part's mass is taken from
HOLDERS = {
    "upper_trunk": "thorax_upper",
    "head": "head",
    "hand": "right_hand",
    "foot": "right_foot",
}
LEAST_MOMENT = 1e-7  # smallest moment of inertia about any axis [kg m2], for eyes and finger tips

_Rows = dict[str, dict[str, Any]]
_Vector = Float[np.ndarray, "3"]


#: Mass [kg], its centre in the segment's frame [m], and its moments about the forward, leftward and
#: upward axes through it, standing [kg m2]
Inertia = tuple[float, _Vector, _Vector]


def inertias(measures: Measures, segments: Mapping[str, Segment]) -> Mapping[str, Inertia]:
    """The inertia of every segment; the masses add up to the body's."""
    rows = _rows(measures)
    out = {n: _slices(segments[n], rows, measures) for n in ("pelvis", *SPINE, "neck", "head")}
    for part in LIMBS:
        segment, row = segments[f"right_{part}"], rows[part]
        length, start, along = _extent(part, measures, segment)
        moments = row["mass"] * (row["radii"] * length) ** 2
        out[segment.name] = float(row["mass"]), start + row["centre"] * length * along, moments
    parts = {f"right_{part}": row for part, row in table("inertia")["parts"].items()}
    if "right_fingers" not in segments:  # the same mass, evenly on the bones of five fingers
        share = sum(parts.pop(name)["share"] for name in MITTEN)
        bones = [name for name in segments if is_right(name) and name[-1].isdigit()]
        parts |= {name: {"of": "hand", "share": share / len(bones)} for name in bones}
    for part, row in parts.items():
        mass = row["share"] * float(rows[row["of"]]["mass"])
        _part_off(out, segments, part, HOLDERS[row["of"]], mass)
    for name, (mass, centre, moments) in list(out.items()):
        if is_right(name):
            out[mirrored(name)] = mass, centre * [1.0, -1.0, 1.0], moments
    scale = measures["mass"] / sum(mass for mass, _, _ in out.values())
    return {n: (mass * scale, at, _possible(each * scale)) for n, (mass, at, each) in out.items()}


def _rows(m: Measures) -> _Rows:
    """The rows of the tables, blended between child and adult by age."""
    young, share = table("inertia")["child"], m.adult_share
    return {
        part: {
            key: (1.0 - share) * np.asarray(young[part][key]) + share * np.asarray(value)
            for key, value in row.items()
        }
        for part, row in table("inertia")[m.adult].items()
    }


def _extent(part: str, m: Measures, segment: Segment) -> tuple[float, _Vector, _Vector]:
    """The length [m] that a limb's row is of, where it starts in the segment, and its direction."""
    if part == "hand":
        return table("inertia")["lengths"]["hand"] * m["hand_length"], np.zeros(3), DOWN
    if part == "foot":
        heel = np.array([-HEEL * m["foot_length"], 0.0, -0.6 * m["ankle_height"]])
        return m["foot_length"], heel, np.array([1.0, 0.0, 0.0])
    return segment.length, np.zeros(3), DOWN


def _slices(segment: Segment, rows: _Rows, m: Measures) -> Inertia:
    """What of the trunk's and head's rows lies between a segment's ends, by height.

    The density of a row's part, of length and mass one, is ``1 + 12 (c - 1/2) (x - 1/2)``, so that
    its centre of mass is ``c``; radii of gyration of a slice are estimated from the whole part's.
    """
    low_m, neck = m.hip_height, m["cervicale_height"]
    shares = [float(rows[each]["share"]) for each in TRUNK]
    bounds, extent = [low_m], (neck - low_m) / sum(shares)
    for each in shares:
        bounds.append(bounds[-1] + extent * each)
    mass, moment, moments = 0.0, 0.0, np.zeros(3)
    for part, start, end in zip(
        (*TRUNK, "head"), (*bounds[:-1], neck), (*bounds[1:], m["stature"]), strict=True
    ):
        row, long = rows[part], end - start
        ends = [(z - start) / long for z in (segment.origin[2], segment.tip[2])]
        low, high = np.clip(ends, 0.0, 1.0)
        if high <= low:
            continue
        tilt = 12.0 * ((1.0 - float(row["centre"])) - 0.5)
        even, odd, third = high - low, (high**2 - low**2) / 2.0, (high**3 - low**3) / 3.0
        share = even + tilt * (odd - even / 2.0)
        middle = (odd + tilt * (third - odd / 2.0)) / share
        weight = float(row["mass"]) * share
        mass += weight
        moment += weight * (start + middle * long)
        upright, squares = np.array([1.0, 1.0, 0.0]) / 12.0, np.asarray(row["radii"]) ** 2
        squares = np.maximum(squares - upright, 0.2 * squares) + upright * (high - low) ** 2
        moments += weight * squares * long**2
    aside = 0.5 * (segment.tip - segment.origin) * [1.0, 1.0, 0.0]
    return mass, aside + np.array([0.0, 0.0, moment / mass - segment.origin[2]]), moments


def _part_off(
    out: dict[str, Inertia], segments: Mapping[str, Segment], part: str, name: str, mass: float
) -> None:
    """Give a small part its mass from its holder's, keeping their common centre of mass."""
    small, (whole, middle, moments) = segments[part], out[name]
    centre, size = 0.5 * (small.tip - small.origin), max(small.length, 0.01)
    out[part] = mass, centre, np.full(3, max(mass * size**2 / 12.0, LEAST_MOMENT))
    sides = [1.0] if is_right(name) else [1.0, -1.0]
    place = small.origin + centre - segments[name].origin
    left = whole - mass * len(sides)
    moved = (whole * middle - mass * np.sum([place * [1.0, s, 1.0] for s in sides], axis=0)) / left
    out[name] = left, moved, moments * left / whole


def _possible(moments: _Vector) -> _Vector:
    """The moments that a solid can have: none exceeds the sum of the others."""
    out = np.maximum(moments, LEAST_MOMENT)
    largest = int(np.argmax(out))
    out[largest] = min(out[largest], 0.999 * (out.sum() - out[largest]))
    return out
