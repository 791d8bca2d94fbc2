"""What readers of a fitted body's pictures ask about objects: hands at them, and what they cut."""

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
import trimesh
from jaxtyping import Bool, Float
from scipy.spatial import cKDTree

from capar.body.fit_remarks import listed, segment_words
from capar.body.fitting import Fit
from capar.model import geometry
from capar.model.capture import Capture, TagObject, TagType
from extractors.readers.body_names.body_names import SIDES, without_side

FLOOR_M, THICK_M = 1.5, 0.3
"""A fixed thing that is as wide as this both ways, and no thicker, is a floor [m]."""

AT_M = 0.02
"""A hand that is no farther from an object is at it [m]."""

CLOSE_M = 0.1
"""A hand that never comes so near to an object has nothing to do with it [m]."""

INSIDE_M, NEAR_M = 0.01, 0.03
"""An object that is deeper in the body than the one, or as near as the other, is reported [m];
beside forearms, whose hands take things, only where it is in them."""

APART_M, HEAD_APART_M = 0.2, 0.5
"""Limbs, and the head, to which a mobile object comes nearer than these, but not near, are named
[m]."""

ROUGH = 32
"""So many points of an object tell how far it is beyond ``CLOSE_M``."""

MOST_CUTS, MOST_SPANS = 5, 3
"""So many parts of the body that objects are in or near, and so many spans, are named at most."""

GAP_S = 0.3
"""Spans that are so far apart or less are told as one [s]."""

FRAMES = 100
"""Frames in which objects and the body are compared."""

SPACING_M, MOST_POINTS = 0.01, 30_000
"""Objects are points of their surfaces, about so far apart [m], and no more than so many."""

LIMBS = {
    "toes": "foot", "foot": "foot", "shank": "leg", "thigh": "leg", "upper_arm": "upper arm",
    "clavicle": "shoulder", "pelvis": "trunk", "neck": "head",
}  # fmt: skip
"""What segments are told as where an object is not near."""

HAND = ("hand", "fingers", "fingertips", "thumb")


@dataclass(frozen=True, eq=False)
class _Near:
    """How near an object comes to a part of the body."""

    times: Float[np.ndarray, "frames"]
    metres: Float[np.ndarray, "frames"]
    """Distances; negative inside, rough beyond ``CLOSE_M`` [m]."""

    @property
    def least(self) -> float:
        return float(self.metres.min())

    @property
    def at_s(self) -> float:
        return float(self.times[int(self.metres.argmin())])

    def spans(self, within_m: float) -> str:
        """In words, when it is within a distance [m]."""
        found = _joined(self.times, self.metres <= within_m)
        told = [f"from {a:.2f} to {b:.2f} s" if b > a else f"at {a:.2f} s" for a, b in found]
        more = len(told) - MOST_SPANS
        last = [f"{more} more times"] if more > 0 else []
        return listed([*told[:MOST_SPANS], *last])


def object_remarks(made: Fit, capture: Capture) -> list[str]:
    """When hands are at objects, and where objects cut the body or nearly do, the deepest first.

    Args:
        made: The body fitted to the capture.
        capture: What it was fitted to.
    """
    things = [thing for thing in capture.objects if _is_thing(thing)]
    if not things:
        return []
    frames = np.unique(np.linspace(0, len(made.times) - 1, FRAMES).round().astype(int))
    nears = {thing.name: _nears(made, capture, thing, frames) for thing in things}
    hands = [
        line
        for thing in things
        if thing.tag is TagType.MOBILE
        for line in _at_hands(made, thing.name, nears[thing.name])
    ]
    cuts = _cuts(made, nears, {thing.name for thing in things if thing.assumed})
    mobile = [thing.name for thing in things if thing.tag is TagType.MOBILE]
    return [*hands, *cuts, *(line for name in mobile for line in _clear(made, name, nears[name]))]


def is_floor(thing: TagObject, corners: Float[np.ndarray, "corners 3"]) -> bool:
    """Whether a thing with its corners at these places in the world is a level floor."""
    wide = np.ptp(corners[:, :2], axis=0).min() > FLOOR_M
    return bool(thing.tag is TagType.FIXED and wide and np.ptp(corners[:, 2]) < THICK_M)


def corners_of(thing: TagObject) -> Float[np.ndarray, "corners 3"]:
    """A thing's corners in the world at its first frame [m]; none if it has no shape."""
    if thing.shape is None:
        return np.zeros((0, 3))
    turn, place = thing.stream.orientations[0], thing.stream.positions[0]
    return np.asarray(geometry.transforms(place, turn).apply(np.array(thing.shape.vertices)))


def _is_thing(thing: TagObject) -> bool:
    """Whether a thing has a surface and is neither the body's own nor a floor."""
    if thing.shape is None or thing.tag is TagType.SELF:
        return False
    return not is_floor(thing, corners_of(thing))


def _nears(made: Fit, capture: Capture, thing: TagObject, frames: np.ndarray) -> dict[str, _Near]:
    """By segment, how near an object comes to it in some frames."""
    tree = cKDTree(_surface_points(thing))
    model, data = made.human.model, mujoco.MjData(made.human.model)
    owners = [model.body(model.geom_bodyid[number]).name for number in range(model.ngeom)]
    times = made.times[frames]
    nearest = np.abs(capture.times[None] - times[:, None]).argmin(axis=1)
    out = {name: np.full(len(frames), np.inf) for name in dict.fromkeys(owners)}
    for row, (frame, seen) in enumerate(zip(frames, nearest, strict=True)):
        place, turn = thing.stream.positions[seen], thing.stream.orientations[seen]
        if not (np.isfinite(place).all() and np.isfinite(turn).all()):
            continue
        pose = geometry.transforms(place, turn)
        data.qpos[:] = made.motion[frame]
        mujoco.mj_kinematics(model, data)
        middles = pose.inv().apply(data.geom_xpos)
        for number, name in enumerate(owners):
            known = tree.query_ball_point(middles[number], model.geom_rbound[number] + CLOSE_M)
            known = known or tree.query(middles[number], min(ROUGH, tree.n))[1]
            apart = from_form(model, data, number, pose.apply(tree.data[known]))
            out[name][row] = min(out[name][row], float(apart.min()))
    return {name: _Near(times, metres) for name, metres in out.items()}


def _surface_points(thing: TagObject) -> Float[np.ndarray, "points 3"]:
    """Points all over an object's surface, and its corners, in its own frame [m]."""
    assert thing.shape is not None
    vertices, faces = np.array(thing.shape.vertices), np.array(thing.shape.faces)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    count = int(min(mesh.area / SPACING_M**2, MOST_POINTS)) + 1
    points, _ = trimesh.sample.sample_surface(mesh, count, seed=0)
    return np.concatenate([np.asarray(points), vertices])


def from_form(
    model: mujoco.MjModel, data: mujoco.MjData, form: int, points: Float[np.ndarray, "points 3"]
) -> Float[np.ndarray, "points"]:
    """Distances of points in the world from one of a body's surfaces, negative inside [m].

    Args:
        model: The body's.
        data: A posture of it.
        form: Number of the surface.
        points: In the world [m].
    """
    local = (points - data.geom_xpos[form]) @ data.geom_xmat[form].reshape(3, 3)
    return _apart(model.geom_type[form], model.geom_size[form], local)


def _apart(
    kind: int, size: Float[np.ndarray, "3"], points: Float[np.ndarray, "points 3"]
) -> Float[np.ndarray, "points"]:
    """Distances of points from a form in its own frame, negative inside [m].

    Those from ellipsoids are estimated by the slope at the point. Outside they are no larger than
    the true ones; inside no larger than the nearest way out along an axis.
    """
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        along = np.clip(points[:, 2], -size[1], size[1])
        off = points - np.column_stack([0.0 * along, 0.0 * along, along])
        return np.asarray(np.linalg.norm(off, axis=1) - size[0])
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        beyond = np.abs(points) - size
        outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
        return np.asarray(outside + np.minimum(beyond.max(axis=1), 0.0))
    scaled = np.linalg.norm(points / size, axis=1)
    slope = np.maximum(np.linalg.norm(points / size**2, axis=1), 1e-9)
    sloping = scaled * (scaled - 1.0) / slope
    shares = (points / size) ** 2
    rest = np.maximum(1.0 - shares.sum(axis=1, keepdims=True) + shares, 0.0)
    out = (size * np.sqrt(rest) - np.abs(points)).min(axis=1)
    return np.where(scaled < 1.0, np.maximum(sloping, -out), sloping)


def _at_hands(made: Fit, thing: str, nears: Mapping[str, _Near]) -> Iterator[str]:
    """When the hands are at an object, or how near they come."""
    for side in SIDES:
        if f"{side}_hand" in made.unrecorded:
            continue
        parts = [nears[f"{side}_{part}"] for part in HAND if f"{side}_{part}" in nears]
        near = _Near(parts[0].times, np.min([part.metres for part in parts], axis=0))
        there = near.metres <= AT_M
        if there.any():
            middle = 1e3 * float(np.median(near.metres[there]))
            told = f"{middle:.0f} mm apart" if middle > 0.0 else f"overlapping by {-middle:.0f} mm"
            deep = (
                f", overlapping by {-1e3 * near.least:.0f} mm at most" if near.least < 0.0 else ""
            )
            yield (
                f"the {side} hand is at {thing}, within {1e3 * AT_M:.0f} mm of it, "
                f"{near.spans(AT_M)} ({told} in the median{deep}); else it is off it, as recorded"
            )
        elif near.least < CLOSE_M:
            yield (
                f"the {side} hand is never at {thing}: it comes no nearer than "
                f"{1e3 * near.least:.0f} mm, at {near.at_s:.2f} s, as recorded"
            )


def _cuts(
    made: Fit, nears: Mapping[str, Mapping[str, _Near]], assumed: Collection[str]
) -> Iterator[str]:
    """Where objects are in the body, or nearly, the deepest first; hands are told of otherwise."""
    found = {
        (thing, part): near
        for thing, segments in nears.items()
        for part, near in _by_part(made, segments, segment_words).items()
        if near.least < (0.0 if part.endswith("forearm") else NEAR_M)
    }
    for (thing, part), near in sorted(found.items(), key=lambda one: one[1].least)[:MOST_CUTS]:
        if near.least < -INSIDE_M:
            why = f"{thing} is assumed" if thing in assumed else "so are both recorded"
            yield (
                f"{thing} is up to {-1e3 * near.least:.0f} mm inside the {part}, at "
                f"{near.at_s:.2f} s; deeper than {1e3 * INSIDE_M:.0f} mm {near.spans(-INSIDE_M)}: "
                f"{why}, and limbs of this body are as thick as usual"
            )
        else:
            yield (
                f"{thing} comes as near as {max(1e3 * near.least, 0.0):.0f} mm to the {part}, at "
                f"{near.at_s:.2f} s, and is not inside of it"
            )


def _clear(made: Fit, thing: str, nears: Mapping[str, _Near]) -> Iterator[str]:
    """From which parts of the body an object stays away, though pictures may show it over them."""
    parts = _by_part(made, nears, limb_words)
    known = {
        part: near
        for part, near in parts.items()
        if NEAR_M <= near.least < (HEAD_APART_M if part == "head" else APART_M)
    }
    if known:
        told = [
            f"{100 * near.least:.0f} cm from the {part} ({near.at_s:.2f} s)"
            for part, near in sorted(known.items(), key=lambda one: one[1].least)
        ]
        yield (
            f"{thing} stays at least {listed(told)}; where a picture shows it over them it is "
            "before or behind"
        )


def _by_part(
    made: Fit, segments: Mapping[str, _Near], words: Callable[[str], str]
) -> dict[str, _Near]:
    """The nearest of each part that was recorded, without hands, which are told of otherwise."""
    out: dict[str, _Near] = {}
    for segment, near in segments.items():
        part = words(segment)
        if without_side(segment) in (*HAND, "eye") or segment in made.unrecorded:
            continue
        if part not in out or near.least < out[part].least:
            out[part] = near
    return out


def limb_words(segment: str) -> str:
    """The limb that a segment is of, the trunk or the head."""
    joint = without_side(segment)
    side = segment.removesuffix(joint)
    return f"{side}{LIMBS[joint]}".replace("_", " ") if joint in LIMBS else segment_words(segment)


def _joined(
    times: Float[np.ndarray, "frames"], there: Bool[np.ndarray, "frames"]
) -> list[tuple[float, float]]:
    """When something holds, short gaps closed."""
    out: list[tuple[float, float]] = []
    for first, last in geometry.runs(there):
        begin, end = float(times[first]), float(times[last])
        if out and begin - out[-1][1] <= GAP_S:
            out[-1] = (out[-1][0], end)
        else:
            out.append((begin, end))
    return out
