"""The skeleton in its standing posture: ends and inertias of all segments, from measures."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from capar.body.anthropometry import Measures, is_right, mirrored, table

SPINE = {
    "lumbar_lower": (0.0, 0.15),
    "lumbar_upper": (0.15, 0.38),
    "thorax_lower": (0.38, 0.70),
    "thorax_upper": (0.70, 1.0),
}
"""Where the spine bends, from the sacrum (0) to cervicale (1): L5/S1, L3/4, T12/L1, T6/7."""

SACRUM_ABOVE_HIPS = 0.045
"""Height of L5/S1 above the hip joints [share of stature] (estimate)."""

SHOULDER_BELOW_ACROMION = 0.0265
"""Depth of the shoulder's centre below the acromion [share of stature]."""

SHOULDER_BREADTH = 0.92
"""Distance of the shoulders' centres as a share of the biacromial breadth [1] (estimate)."""

HIP_OF_SPINES = 0.36
"""Distance of a hip joint from the midline, of the breadth between the spines (Bell 1990) [1]."""

HEAD_BELOW_EYES = 0.013
"""Depth of the head's joint below the eyes [share of stature] (estimate)."""


HEEL = 0.26
"""How far the heel lies behind the ankle [share of the foot's length] (estimate)."""

BALL = 0.47
"""How far the ball of the foot lies before the ankle [share of the foot's length] (estimate)."""


@dataclass(frozen=True, eq=False)
class Segment:
    """One rigid part of the body, in the world's axes, standing with the arms down."""

    name: str
    parent: str
    """Name of the segment that it hangs on; empty for the pelvis."""

    origin: Float[np.ndarray, "3"]
    """Its joint with the parent [m]."""

    tip: Float[np.ndarray, "3"]
    """Its far end: the next joint, or where it ends [m]."""

    @property
    def length(self) -> float:
        """From joint to far end [m]."""
        return float(np.linalg.norm(self.tip - self.origin))


def skeleton(measures: Measures) -> Mapping[str, Segment]:
    """Every segment by name, each after its parent; x forward, y left, z up, feet on z = 0."""
    right = [*_arm(measures), *_leg(measures), _eye(measures)]
    segments = [*_trunk(measures), *right, *(_mirror(each) for each in right)]
    return {each.name: each for each in segments}


def _trunk(m: Measures) -> list[Segment]:
    tall, hip, neck = m["stature"], m.hip_height, m["cervicale_height"]
    sacrum = hip + SACRUM_ABOVE_HIPS * tall
    out = [_upright("pelvis", "", hip, sacrum)]
    for name, (low, high) in SPINE.items():
        span = neck - sacrum
        out.append(_upright(name, out[-1].name, sacrum + low * span, sacrum + high * span))
    skull = m["eye_height"] - HEAD_BELOW_EYES * tall
    at = np.array([0.008 * tall, 0.0, skull])
    out.append(Segment("neck", "thorax_upper", np.array([0.0, 0.0, neck]), at))
    out.append(Segment("head", "neck", at, np.array([0.008 * tall, 0.0, tall])))
    return out


def _upright(name: str, parent: str, low: float, high: float) -> Segment:
    return Segment(name, parent, np.array([0.0, 0.0, low]), np.array([0.0, 0.0, high]))


def eyes_between(m: Measures) -> Float[np.ndarray, "3"]:
    """The point between the eyes, standing [m]."""
    forward = 0.008 * m["stature"] + 0.40 * m["head_length"]
    return np.array([forward, 0.0, m["eye_height"]])


def _eye(m: Measures) -> Segment:
    at = eyes_between(m) - [0.0, 0.5 * m["pupil_distance"], 0.0]
    return Segment("right_eye", "head", at, at + np.array([0.012, 0.0, 0.0]))


def _arm(m: Measures) -> list[Segment]:
    tall, down = m["stature"], np.array([0.0, 0.0, -1.0])
    aside = -0.5 * SHOULDER_BREADTH * m["shoulder_breadth"]
    shoulder = np.array([0.0, aside, m["acromial_height"] - SHOULDER_BELOW_ACROMION * tall])
    sternum = np.array([0.03 * tall, -0.012 * tall, m["suprasternale_height"] - 0.005 * tall])
    elbow = shoulder + m["upper_arm"] * down
    wrist = elbow + m["forearm"] * down
    hand = m["hand_length"]
    knuckle, middle = wrist + 0.52 * hand * down, wrist + 0.78 * hand * down
    base = wrist + 0.22 * hand * down + [0.16 * hand, 0.04 * hand, 0.0]
    thumb = base + 0.36 * hand * np.array([0.45, 0.15, -0.88])
    return [
        Segment("right_clavicle", "thorax_upper", sternum, shoulder),
        Segment("right_upper_arm", "right_clavicle", shoulder, elbow),
        Segment("right_forearm", "right_upper_arm", elbow, wrist),
        Segment("right_hand", "right_forearm", wrist, knuckle),
        Segment("right_fingers", "right_hand", knuckle, middle),
        Segment("right_fingertips", "right_fingers", middle, wrist + hand * down),
        Segment("right_thumb", "right_hand", base, thumb),
    ]


def _leg(m: Measures) -> list[Segment]:
    aside, foot = -HIP_OF_SPINES * m["spine_breadth"], m["foot_length"]
    hip = np.array([0.0, aside, m.hip_height])
    knee = hip - [0.0, 0.0, m["thigh"]]
    ankle = knee - [0.0, 0.0, m["shank"]]
    ball = np.array([BALL * foot, aside, 0.35 * m["ankle_height"]])
    toe = ball + np.array([(1.0 - HEEL - BALL) * foot, 0.0, 0.0])
    return [
        Segment("right_thigh", "pelvis", hip, knee),
        Segment("right_shank", "right_thigh", knee, ankle),
        Segment("right_foot", "right_shank", ankle, ball),
        Segment("right_toes", "right_foot", ball, toe),
    ]


def _mirror(each: Segment) -> Segment:
    parent = mirrored(each.parent) if is_right(each.parent) else each.parent
    flip = np.array([1.0, -1.0, 1.0])
    return Segment(mirrored(each.name), parent, each.origin * flip, each.tip * flip)


LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
TRUNK = ("lower_trunk", "middle_trunk", "upper_trunk")
"""From the hips upwards."""

HOLDERS = {
    "upper_trunk": "thorax_upper",
    "head": "head",
    "hand": "right_hand",
    "foot": "right_foot",
}
"""The segment that a small part's mass is taken from."""

LEAST_MOMENT = 1e-7
"""Smallest moment of inertia about any axis [kg m2], for eyes and finger tips."""

_Rows = dict[str, dict[str, Any]]
_Vector = Float[np.ndarray, "3"]


@dataclass(frozen=True, eq=False)
class Inertia:
    """What a segment weighs and where."""

    mass: float
    """[kg]."""

    centre: Float[np.ndarray, "3"]
    """Centre of mass in the segment's frame [m]."""

    moments: Float[np.ndarray, "3"]
    """Moments about the forward, leftward and upward axes through it, standing [kg m2]."""


def inertias(measures: Measures, segments: Mapping[str, Segment]) -> Mapping[str, Inertia]:
    """The inertia of every segment; the masses add up to the body's."""
    rows = _rows(measures)
    out = {**_column(measures, rows, segments), **_limbs(measures, rows, segments)}
    for part, row in table("inertia")["parts"].items():
        mass = row["share"] * float(rows[row["of"]]["mass"])
        _part_off(out, segments, part, row | {"mass": mass})
    left = {mirrored(n): _mirror_inertia(each) for n, each in out.items() if is_right(n)}
    return _weighing({**out, **left}, measures["mass"])


def _rows(m: Measures) -> _Rows:
    """The rows of the tables, blended between child and adult by age."""
    tables, share = table("inertia"), m.adult_share
    young, grown = tables["child"], tables[m.adult]
    return {
        part: {
            key: (1.0 - share) * np.asarray(young[part][key]) + share * np.asarray(value)
            for key, value in row.items()
        }
        for part, row in grown.items()
    }


def _limbs(m: Measures, rows: _Rows, segments: Mapping[str, Segment]) -> dict[str, Inertia]:
    out = {}
    for part in LIMBS:
        segment, row = segments[f"right_{part}"], rows[part]
        length, start, along = _span(part, m, segment)
        moments = row["mass"] * (row["radii"] * length) ** 2
        centre = start + row["centre"] * length * along
        out[segment.name] = Inertia(float(row["mass"]), centre, moments)
    return out


def _span(part: str, m: Measures, segment: Segment) -> tuple[float, _Vector, _Vector]:
    """The length [m] that a limb's row is of, where it starts in the segment, and its direction."""
    down = np.array([0.0, 0.0, -1.0])
    if part == "hand":
        return table("inertia")["lengths"]["hand"] * m["hand_length"], np.zeros(3), down
    if part == "foot":
        heel = np.array([-HEEL * m["foot_length"], 0.0, -0.6 * m["ankle_height"]])
        return m["foot_length"], heel, np.array([1.0, 0.0, 0.0])
    return segment.length, np.zeros(3), down


def _column(m: Measures, rows: _Rows, segments: Mapping[str, Segment]) -> dict[str, Inertia]:
    """Pelvis, spine, neck and head: slices of the tables' parts by height."""
    low, neck = m.hip_height, m["cervicale_height"]
    span = (neck - low) / sum(float(rows[each]["share"]) for each in TRUNK)
    pieces = []
    for part in TRUNK:
        high = low + span * float(rows[part]["share"])
        upwards = rows[part] | {"centre": 1.0 - rows[part]["centre"]}
        pieces.append((upwards, low, high))
        low = high
    pieces.append((rows["head"] | {"centre": 1.0 - rows["head"]["centre"]}, neck, m["stature"]))
    return {n: _slices(segments[n], pieces) for n in ("pelvis", *SPINE, "neck", "head")}


def _slices(segment: Segment, pieces: list[tuple[dict[str, Any], float, float]]) -> Inertia:
    """What of the pieces lies between a segment's ends; their density is linear in height."""
    mass, moment, moments = 0.0, 0.0, np.zeros(3)
    for row, start, end in pieces:
        ends = [(z - start) / (end - start) for z in (segment.origin[2], segment.tip[2])]
        low, high = np.clip(ends, 0.0, 1.0)
        if high <= low:
            continue
        share, middle = _linear(float(row["centre"]), float(low), float(high))
        mass += float(row["mass"]) * share
        moment += float(row["mass"]) * share * (start + middle * (end - start))
        squares = _sliced(np.asarray(row["radii"]) ** 2, float(high - low))
        moments += float(row["mass"]) * share * squares * (end - start) ** 2
    aside = 0.5 * (segment.tip - segment.origin) * [1.0, 1.0, 0.0]
    return Inertia(mass, aside + np.array([0.0, 0.0, moment / mass - segment.origin[2]]), moments)


def _linear(centre: float, low: float, high: float) -> tuple[float, float]:
    """Mass and its middle, between two places of a rod of length and mass one.

    The rod's density is ``1 + 12 (centre - 1/2) (x - 1/2)``, so its centre of mass is ``centre``.
    """
    tilt = 12.0 * (centre - 0.5)
    even, odd, third = high - low, (high**2 - low**2) / 2.0, (high**3 - low**3) / 3.0
    mass = even + tilt * (odd - even / 2.0)
    return mass, (odd + tilt * (third - odd / 2.0)) / mass


def _sliced(squares: _Vector, height: float) -> _Vector:
    """Squared radii of gyration of a slice of a part whose own are given [of its length]."""
    upright = np.array([1.0, 1.0, 0.0]) / 12.0
    return np.maximum(squares - upright, 0.2 * squares) + upright * height**2


def _part_off(
    out: dict[str, Inertia], segments: Mapping[str, Segment], part: str, row: dict[str, Any]
) -> None:
    """Give a small part its share of its holder, keeping their common centre of mass."""
    name, small = HOLDERS[row["of"]], segments[f"right_{part}"]
    holder, mass = out[name], row["mass"]
    sides = np.array([1.0] if is_right(name) else [1.0, -1.0])
    size = max(small.length, 0.01)
    moment = max(mass * size**2 / 12.0, LEAST_MOMENT)
    centre = 0.5 * (small.tip - small.origin)
    out[small.name] = Inertia(mass, centre, np.full(3, moment))
    place = small.origin + centre - segments[name].origin
    places = [place * [1.0, side, 1.0] for side in sides]
    left = holder.mass - mass * len(sides)
    moved = (holder.mass * holder.centre - mass * np.sum(places, axis=0)) / left
    out[name] = Inertia(left, moved, holder.moments * left / holder.mass)


def _mirror_inertia(each: Inertia) -> Inertia:
    return Inertia(each.mass, each.centre * [1.0, -1.0, 1.0], each.moments)


def _weighing(shares: Mapping[str, Inertia], mass: float) -> Mapping[str, Inertia]:
    """The same with masses that add up to the body's mass [kg]."""
    scale = mass / sum(each.mass for each in shares.values())
    return {
        name: Inertia(each.mass * scale, each.centre, _possible(each.moments * scale))
        for name, each in shares.items()
    }


def _possible(moments: _Vector) -> _Vector:
    """The moments that a solid can have: none exceeds the sum of the others."""
    out = np.maximum(moments, LEAST_MOMENT)
    largest = int(np.argmax(out))
    out[largest] = min(out[largest], 0.999 * (out.sum() - out[largest]))
    return out
