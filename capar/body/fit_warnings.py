"""What a user can act on in a fitted body."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import mujoco
import numpy as np
import trimesh
from jaxtyping import Bool, Float, Int
from scipy.signal import find_peaks
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from capar.body.fingers import Closing
from capar.body.sensor_fitting import Fit
from capar.model import geometry
from capar.model.capture import Capture, Sensor, Shape, TagObject, TagType
from extractors.readers.names import SIDES, BodyName, without_side

FAR_M = 0.03
"""Residuals larger than this are reported [m]."""

MOST_PLACES = 10
"""So many places with such residuals are named at most."""

BENT = np.radians(15.0)
"""A knee that is never straighter than this is reported [rad]."""

SPLAYED = np.radians(40.0)
"""Feet that point farther apart than this in the median are reported [rad]."""

RAISED, MOST_PEAKS = np.radians(15.0), 6
"""Toes that point up by more than this [rad] are reported, with so many times at most."""

FLOATING_M = 0.03
"""A lower sole that is higher above the floor than this in the median is reported [m]."""

ARCHED, BOWED = np.radians(-20.0), np.radians(60.0)
"""A back that is bent backwards or forwards by more than this is reported [rad]."""

TWISTED = np.radians(15.0)
"""A back that is bent sideways or turned by more than this is reported [rad]."""

LEANING = np.radians(20.0)
"""A chest that leans farther from upright than this is reported [rad]."""

NECK_FAR = np.radians(25.0)
"""A neck that, with the head on it, is bent or turned by more than this is reported [rad]."""

POINT_M = 0.06
"""A head's shape that is smaller than this says no more of the head than a point [m]."""

INSIDE_M, NEAR_M = 0.01, 0.02
"""A hand that is deeper in the thigh or trunk than the one, or as near as the other, is reported
[m]."""

SAMPLES = 60
"""Frames in which hands are looked for in the body."""

LIMBS = {"arm": "upper_arm", "forearm": "forearm", "hand": "hand", "leg": "thigh", "foot": "foot"}
"""Parts that may be unrecorded, by their segment; a part of one that is named is not named."""

WAYS = {"flexion": "bent forwards or backwards", "bend": "bent sideways", "turn": "turned"}
"""How hinges of back and neck turn."""

NECK = ("neck", "head")
SPINE = ("lumbar_lower", "lumbar_upper", "thorax_lower", "thorax_upper")
BODY = ("right_thigh", "left_thigh", "pelvis", *SPINE, "neck", "head")


def remarks(made: Fit, capture: Capture, floor_m: float | None = None) -> list[str]:
    """Sentences on what is far from its place, assumed, not recorded or of unusual posture.

    Args:
        made: The body fitted to the capture.
        capture: What it was fitted to.
        floor_m: Height of its floor [m]; None without one.
    """
    parts = (
        _far(made), _unrecorded(made), _assumed(made, capture, floor_m), _legs(made, floor_m),
        _back(made), _head(made, capture), _inside(made),
    )  # fmt: skip
    return [line for part in parts for line in part]


def _far(made: Fit) -> Iterator[str]:
    """Places whose distance from what is followed is large, the worst first."""
    known = {n: metres for n, metres in made.residuals_m.items() if np.isfinite(metres).any()}
    peaks = {name: float(np.nanmax(metres)) for name, metres in known.items()}
    worst = sorted((name for name in peaks if peaks[name] > FAR_M), key=lambda name: -peaks[name])
    told = [
        f"{name} by up to {1e3 * peaks[name]:.0f} mm, at "
        f"{made.times[int(np.nanargmax(known[name]))]:.2f} s "
        f"({float(np.mean(known[name] > FAR_M)):.0%} of the time)"
        for name in worst[:MOST_PLACES]
    ]
    more = len(worst) - MOST_PLACES
    if told:
        yield (
            f"farther than {1e3 * FAR_M:.0f} mm from their places on the body: {'; '.join(told)}"
            f"{f'; {more} more sometimes' if more > 0 else ''}"
        )


def _unrecorded(made: Fit) -> Iterator[str]:
    """Limbs of which nothing is followed."""
    unseen, named = set(made.unrecorded), []
    for side in SIDES:
        above = ""
        for part, segment in LIMBS.items():
            if f"{side}_{segment}" in unseen and not (above and part != "leg"):
                named.append(f"{side} {part}")
                above = part
            if part == "hand":
                above = ""
            if part == "leg":
                above = part if f"{side}_{segment}" in unseen else ""
    named += [name for name in ("head", "pelvis") if name in unseen]
    if named:
        yield (
            f"not recorded, and drawn faint: {', '.join(named)} (arms hang, legs stand, heads are "
            "upright)"
        )


def _assumed(made: Fit, capture: Capture, floor_m: float | None) -> Iterator[str]:
    """Things that no recording shows."""
    for thing in capture.objects:
        if thing.assumed:
            yield f"{thing.name} is assumed: {thing.assumed}"
    if floor_m is None:
        soles = made.human.sites(made.motion, [f"{side}_sole" for side in SIDES])
        lowest = min(float(np.quantile(where[:, 2], 0.05)) for where, _ in soles.values())
        yield (
            "the recording has no floor; views draw one under the lowest soles, as assumed, which "
            f"are at {lowest:.2f} m; stated heights are the recording's own, and not over it"
        )


def _legs(made: Fit, floor_m: float | None) -> Iterator[str]:
    """Knees that never straighten, feet that point apart, soles that float."""
    unseen = set(made.unrecorded)
    bent = {
        side: float(made.motion[:, made.human.index(f"{side}_knee_flexion")].min())
        for side in SIDES
        if f"{side}_shank" not in unseen
    }
    knees = [
        f"the {side} knee is never straighter than {np.degrees(angle):.0f} degrees"
        for side, angle in bent.items()
        if angle > BENT
    ]
    if knees:
        yield f"{listed(knees)}, as hip, knee and ankle are recorded"
    feet = [f"{side}_foot" for side in SIDES]
    if unseen & set(feet):
        return
    where = made.human.sites(made.motion, [*feet, *(f"{side}_sole" for side in SIDES)])
    raised = [_raised(made, foot, where[foot][1]) for foot in feet]
    if any(raised):
        yield f"{' and '.join(filter(None, raised))}, on the heel or in the air, as recorded"
    ahead = [_ahead(where[name][1]) for name in feet]
    between = np.abs(np.angle(np.exp(1j * (ahead[0] - ahead[1]))))
    if np.median(between) > SPLAYED:
        counts = [sum(on.startswith(foot) for on in made.segments.values()) for foot in feet]
        toed = min(counts) > 1
        yield (
            f"the feet point {np.degrees(np.median(between)):.0f} degrees apart in the median"
            f"{', as ankles and toes are recorded' if toed else ''}"
        )
    lower = np.minimum(*(where[f"{side}_sole"][0][:, 2] for side in SIDES))
    if floor_m is not None and np.median(lower) - floor_m > FLOATING_M:
        yield (
            f"the lower sole is {1e3 * (np.median(lower) - floor_m):.0f} mm above the floor in the"
            " median: so high are the recorded ankles"
        )


def _raised(made: Fit, foot: str, turns: Float[np.ndarray, "frames 4"]) -> str:
    """How far up the toes point from the ankle, and the most, if that is far."""
    axes = Rotation.from_quat(turns, scalar_first=True).apply([1.0, 0.0, 0.0])
    pitch = np.arcsin(np.clip(axes[:, 2], -1.0, 1.0))
    peaks, _ = find_peaks(np.r_[-np.pi, pitch, -np.pi], height=RAISED, prominence=RAISED)
    if not len(peaks):
        return ""
    times = [f"{made.times[frame - 1]:.2f}" for frame in peaks[:MOST_PEAKS]]
    return (
        f"the {segment_words(foot)}'s toes point up by up to "
        f"{np.degrees(pitch[peaks - 1].max()):.0f} degrees, at {listed(times)} s"
    )


def _ahead(turns: Float[np.ndarray, "frames 4"]) -> Float[np.ndarray, "frames"]:
    """Where a segment's x axis points in the horizontal plane [rad]."""
    axes = Rotation.from_quat(turns, scalar_first=True).apply([1.0, 0.0, 0.0])
    return np.asarray(np.arctan2(axes[:, 1], axes[:, 0]))


def _back(made: Fit) -> Iterator[str]:
    """How far the chest leans and the back is bent and turned, where that is far."""
    turns = made.human.sites(made.motion, ["thorax_upper"])["thorax_upper"][1]
    upwards = Rotation.from_quat(turns, scalar_first=True).apply([0.0, 0.0, 1.0])[:, 2]
    lean = np.arccos(np.clip(upwards, -1.0, 1.0))
    if lean.max() > LEANING:
        yield f"the chest, and the neck with it, {_most(made, lean, 'leans from upright')}"
    bend, told = _summed(made, SPINE, "flexion"), []
    if bend.min() < ARCHED:
        told.append(_most(made, -bend, "arched backwards"))
    if bend.max() > BOWED:
        told.append(_most(made, bend, "bent forwards"))
    for way in ("bend", "turn"):
        angle = np.abs(_summed(made, SPINE, way))
        if angle.max() > TWISTED:
            told.append(_most(made, angle, WAYS[way]))
    if told:
        yield f"the back is {listed(told)}"


def _most(made: Fit, angle: Float[np.ndarray, "frames"], done: str) -> str:
    at = made.times[int(np.argmax(angle))]
    return f"{done} by up to {np.degrees(angle.max()):.0f} degrees, at {at:.2f} s"


def _head(made: Fit, capture: Capture) -> Iterator[str]:
    """Where on the head the tracked point is that views draw, and how far the neck is bent."""
    if "head" in made.unrecorded:
        return
    tracked = [
        sensor
        for sensor in capture.sensors
        if sensor.end_effector == "head" and _small(sensor.shape)
    ]
    ways = {way: np.abs(_summed(made, NECK, way)) for way in WAYS}
    far = [_most(made, angle, WAYS[way]) for way, angle in ways.items() if angle.max() > NECK_FAR]
    if far and not tracked:
        yield f"the neck, with the head on it, is {listed(far)}, as they are recorded"
    eyes, turns = made.human.sites(made.motion, ["between_eyes"])["between_eyes"]
    for sensor in tracked:
        nearest = np.abs(capture.times[None] - made.times[:, None]).argmin(axis=1)
        away = sensor.stream.positions[nearest] - eyes
        back = Rotation.from_quat(turns, scalar_first=True).inv()
        ahead, _, up = 1e3 * np.nanmedian(back.apply(away), axis=0)
        yield (
            f"{sensor.name} is drawn as a point where it is tracked, {abs(ahead):.0f} mm "
            f"{'before' if ahead > 0.0 else 'behind'} and {abs(up):.0f} mm "
            f"{'above' if up > 0.0 else 'below'} the middle between this body's eyes; its neck is "
            f"{1e3 * np.linalg.norm(made.human.model.body('head').pos):.0f} mm long and, with the "
            f"head on it, bent forwards by {_range(made, NECK, 'flexion')} degrees, sideways by "
            f"{_range(made, NECK, 'bend')} and turned by {_range(made, NECK, 'turn')}"
        )


def _small(shape: Shape | None) -> bool:
    """Whether a shape is drawn as a point, or nearly."""
    return shape is None or float(np.ptp(shape.vertices, axis=0).max()) < POINT_M


def _range(made: Fit, parts: tuple[str, ...], way: str) -> str:
    angle = np.degrees(_summed(made, parts, way))
    most = int(np.argmax(np.abs(angle)))
    angle = np.round(angle) + 0.0  # no negative zero
    return f"{angle.min():.0f} to {angle.max():.0f} ({angle[most]:.0f} at {made.times[most]:.2f} s)"


def _summed(made: Fit, parts: tuple[str, ...], way: str) -> Float[np.ndarray, "frames"]:
    """The sum of some joints' angles [rad]."""
    return np.asarray(
        made.motion[:, [made.human.index(f"{part}_{way}") for part in parts]].sum(axis=1)
    )


def _inside(made: Fit) -> Iterator[str]:
    """Hands that are in the thigh or trunk, or nearly."""
    model, data = made.human.model, mujoco.MjData(made.human.model)
    frames = np.unique(np.linspace(0, len(made.times) - 1, SAMPLES).round().astype(int))
    unseen = set(made.unrecorded)
    for side in SIDES:
        if f"{side}_hand" in unseen:
            continue
        if "head" in unseen:
            yield _beside_unseen(made, side, frames)
        hand, deepest = forms_of(made, (f"{side}_hand", f"{side}_fingers")), (NEAR_M, 0.0, "")
        for frame in frames:
            data.qpos[:] = made.motion[frame]
            mujoco.mj_kinematics(model, data)
            for form in forms_of(made, BODY):
                for own in hand:
                    apart = mujoco.mj_geomDistance(model, data, own, form, 0.05, None)
                    segment = model.body(model.geom_bodyid[form]).name
                    deepest = min(deepest, (apart, float(made.times[frame]), segment))
        depth, at, segment = deepest
        if depth < -INSIDE_M:
            yield (
                f"the {side} hand is up to {-1e3 * depth:.0f} mm inside the "
                f"{segment_words(segment)}, at {at:.2f} s: limbs of this body are as thick as "
                "usual, the recording's are points"
            )
        elif segment:
            yield (
                f"the {side} hand comes as near as {max(1e3 * depth, 0.0):.0f} mm to the "
                f"{segment_words(segment)}, at {at:.2f} s, and is not inside of it"
            )


def _beside_unseen(made: Fit, side: str, frames: Int[np.ndarray, "some"]) -> str:
    """How near a recorded hand comes to a head and neck that are not recorded."""
    model, data = made.human.model, mujoco.MjData(made.human.model)
    least, at = np.inf, 0.0
    for frame in frames:
        data.qpos[:] = made.motion[frame]
        mujoco.mj_kinematics(model, data)
        for form in forms_of(made, NECK):
            for own in forms_of(made, (f"{side}_hand", f"{side}_fingers", f"{side}_fingertips")):
                apart = mujoco.mj_geomDistance(model, data, own, form, 2.0, None)
                least, at = min((least, at), (apart, float(made.times[frame])))
    where = f"{1e3 * least:.0f} mm from" if least > 0.0 else f"{-1e3 * least:.0f} mm inside"
    return (
        f"the {side} hand comes no nearer to the head and neck than {where} them, at {at:.2f} s; "
        "they are not recorded, and pictures show through them what is before or behind"
    )


def forms_of(made: Fit, segments: tuple[str, ...]) -> list[int]:
    """Numbers of the surfaces of segments in the body's model."""
    model = made.human.model
    return [
        number
        for number in range(model.ngeom)
        if model.body(model.geom_bodyid[number]).name in segments
    ]


def listed(words: Sequence[str]) -> str:
    """Words with commas and an ``and``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def segment_words(segment: str) -> str:
    """A segment as people call it; those of the spine are the trunk."""
    trunk = without_side(segment) in SPINE
    return "trunk" if trunk else segment.replace("_", " ")


FLOOR_M, THICK_M = 1.5, 0.3
"""A fixed thing that is as wide as this both ways, and no thicker, is a floor [m]."""

AT_M = 0.02
"""A hand that is no farther from an object is at it [m]."""

CLOSE_M = 0.1
"""A hand that never comes so near to an object has nothing to do with it [m]."""

INSIDE_M_OBJECT_REMARKS, NEAR_M_OBJECT_REMARKS = 0.01, 0.03
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

LIMBS_OBJECT_REMARKS = {
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
        if near.least < (0.0 if part.endswith("forearm") else NEAR_M_OBJECT_REMARKS)
    }
    for (thing, part), near in sorted(found.items(), key=lambda one: one[1].least)[:MOST_CUTS]:
        if near.least < -INSIDE_M_OBJECT_REMARKS:
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
        if NEAR_M_OBJECT_REMARKS <= near.least < (HEAD_APART_M if part == "head" else APART_M)
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
    return (
        f"{side}{LIMBS[joint]}".replace("_", " ")
        if joint in LIMBS_OBJECT_REMARKS
        else segment_words(segment)
    )


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


RAISED_POSTURE_REMARKS, BEHIND = np.radians(45.0), np.radians(25.0)
"""An upper arm that is farther from hanging, or behind the chest's plane, is reported [rad]."""

FEET_NEAR_M = 0.06
"""Feet that come nearer to each other than this are reported [m]."""

OUT_M = 0.025
"""A recorded shape that stands farther out of the body's own than this is reported [m]."""

MOST_CORNERS = 400
"""So many corners of such a shape are looked at."""

PARTS = {
    "hand": ("hand", "fingers", "fingertips", "thumb", "forearm"),
    "foot": ("foot", "toes", "shank"),
}
"""Segments that a recorded hand or foot may be in."""

WAYS_POSTURE_REMARKS = {
    "hand": (("the thumb's side", "the fifth finger's side"), ("the palm", "the back of the hand"),
             ("the elbow", "beyond the fingertips")),
    "foot": (("before it", "behind it"), ("inside of it", "outside of it"),
             ("above it", "below it")),
}  # fmt: skip
"""By part, what lies in and against the direction of each axis, of the right side."""


def posture_remarks(made: Fit, capture: Capture) -> list[str]:
    """Sentences on arms behind the trunk, feet at each other and shapes that stand off the body.

    Args:
        made: The body fitted to the capture.
        capture: What it was fitted to.
    """
    return [*_arms(made), *_feet(made), *_shapes(made, capture)]


def _arms(made: Fit) -> Iterator[str]:
    """How far upper arms are raised, and behind the trunk."""
    told = []
    for side in SIDES:
        if f"{side}_forearm" in made.unrecorded:
            continue
        names = ["thorax_upper", f"{side}_upper_arm"]
        where = made.human.sites(made.motion, names)
        chest, arm = (Rotation.from_quat(where[name][1], scalar_first=True) for name in names)
        down = arm.apply([0.0, 0.0, -1.0])
        raised = np.arccos(np.clip(-down[:, 2], -1.0, 1.0))
        behind = np.arcsin(np.clip(-chest.inv().apply(down)[:, 0], -1.0, 1.0))
        parts = [
            f"up to {np.degrees(angle.max()):.0f} degrees {how}, at "
            f"{made.times[int(np.argmax(angle))]:.2f} s"
            for angle, least, how in (
                (raised, RAISED_POSTURE_REMARKS, "from hanging straight down"),
                (behind, BEHIND, "behind the plane of the chest"),
            )
            if angle.max() > least
        ]
        if parts:
            told.append(f"the {side} upper arm is {' and '.join(parts)}")
    if told:
        yield f"{'; '.join(told)}: as shoulders and elbows are recorded"


def _feet(made: Fit) -> Iterator[str]:
    """Feet that touch or overlap."""
    if {f"{side}_foot" for side in SIDES} & set(made.unrecorded):
        return
    model, data = made.human.model, mujoco.MjData(made.human.model)
    frames = np.unique(np.linspace(0, len(made.times) - 1, SAMPLES).round().astype(int))
    first, second = (forms_of(made, (f"{side}_foot", f"{side}_toes")) for side in SIDES)
    near = []
    for frame in frames:
        data.qpos[:] = made.motion[frame]
        mujoco.mj_kinematics(model, data)
        near.append(
            min(mujoco.mj_geomDistance(model, data, a, b, 0.5, None) for a in first for b in second)
        )
    least = int(np.argmin(near))
    if near[least] < FEET_NEAR_M:
        apart = f"overlap by up to {-1e3 * near[least]:.0f} mm"
        if near[least] > 0.0:
            apart = f"come no nearer to each other than {1e3 * near[least]:.0f} mm"
        yield (
            f"the drawn feet {apart}, at {made.times[frames[least]]:.2f} s, as broad as usual "
            "about the recorded ankles; in a picture the one may hide a part of the other"
        )


def _shapes(made: Fit, capture: Capture) -> Iterator[str]:
    """Recorded shapes of hands and feet that stand out of the body's."""
    told = []
    for sensor in capture.acting:
        known = sensor.end_effector in PARTS and sensor.side in SIDES and sensor.shape is not None
        own = capture.agent_of(sensor) == capture.agent.name
        if known and own and f"{sensor.side}_{sensor.end_effector}" not in made.unrecorded:
            metres, way = _standing_out(made, capture, sensor)
            if metres > OUT_M:
                told.append(f"{sensor.name} by up to {1e3 * metres:.0f} mm ({way})")
    if told:
        yield (
            "shapes that the capture gives to sensors, about the recorded points, stand out of "
            f"this body's own hands and feet, which have their usual form: {', '.join(told)}, in "
            "the median"
        )


def _standing_out(made: Fit, capture: Capture, sensor: Sensor) -> tuple[float, str]:
    """How far a sensor's shape stands out of the body in the median [m], and in which direction."""
    assert sensor.shape is not None
    model, data = made.human.model, mujoco.MjData(made.human.model)
    part = f"{sensor.side}_{sensor.end_effector}"
    segments = tuple(f"{sensor.side}_{name}" for name in PARTS[sensor.end_effector])
    corners = np.array(sensor.shape.vertices)
    corners = corners[np.unique(np.linspace(0, len(corners) - 1, MOST_CORNERS).astype(int))]
    out, local = [], []
    for frame in np.unique(np.linspace(0, len(made.times) - 1, SAMPLES).round().astype(int)):
        seen = int(np.abs(capture.times - made.times[frame]).argmin())
        place, turn = sensor.stream.positions[seen], sensor.stream.orientations[seen]
        if not (np.isfinite(place).all() and np.isfinite(turn).all()):
            continue
        data.qpos[:] = made.motion[frame]
        mujoco.mj_kinematics(model, data)
        points = geometry.transforms(place, turn).apply(corners)
        forms = forms_of(made, segments)
        out.append(np.min([from_form(model, data, form, points) for form in forms], axis=0))
        body = data.body(part)
        local.append((points - body.xpos) @ body.xmat.reshape(3, 3))
    if not out:
        return 0.0, ""
    median = np.median(out, axis=0)
    worst = int(np.argmax(median))
    return float(median[worst]), _way(made, sensor, np.median(local, axis=0)[worst])


def _way(made: Fit, sensor: Sensor, place: Float[np.ndarray, "3"]) -> str:
    """Where a place is, in words, against the box of a hand or foot in whose frame it is [m]."""
    own = PARTS[sensor.end_effector][:-1]
    segments = tuple(f"{sensor.side}_{name}" for name in own)
    model, data = made.human.model, mujoco.MjData(made.human.model)
    data.qpos[:] = made.human.posture()
    mujoco.mj_kinematics(model, data)
    start = data.body(f"{sensor.side}_{sensor.end_effector}").xpos
    boxes = [
        data.geom_xpos[form]
        - start
        + np.abs(data.geom_xmat[form].reshape(3, 3)) @ model.geom_aabb[form, 3:] * sign
        for form in forms_of(made, segments)
        for sign in (-1.0, 1.0)
    ]
    low, high = np.min(boxes, axis=0), np.max(boxes, axis=0)
    beyond = np.stack([place - high, low - place], axis=1)
    beyond[1] = beyond[1] if sensor.side == "right" else beyond[1][::-1]
    axis, sign = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
    word = WAYS_POSTURE_REMARKS[sensor.end_effector][axis][sign]
    return word if sensor.end_effector == "foot" or "beyond" in word else f"towards {word}"


TILTED = 8.0
"""A line between recorded points of a foot that lies steeper than this to its sole is reported
[degrees]."""

STEP_M, LEAST_STEPS, MOST_STEPS = 0.15, 2, 8
"""Legs pass each other where one foot is so far ahead [m] before, and the other after; fewer such
times are no walk, and no more of them are named."""

Points = Mapping[str, Float[np.ndarray, "frames 3"]]


def recorded_spine(made: Fit, points: Points) -> list[str]:
    """What is said of a recorded spine that bends more than this body's can.

    Args:
        made: The body fitted to it.
        points: What was followed, in the world [m]; NaN where lost.
    """
    order = ("pelvis", *SPINE, "neck")
    on = {part: [name for name, own in made.segments.items() if own == part] for part in order}
    chain = [names[0] for names in on.values() if names]
    if len(chain) < 3 or max(map(len, on.values())) > 1:  # several on a segment: markers
        return []
    links = [points[below] - points[above] for above, below in pairwise(chain)]
    own = max(np.degrees(made.human.ranges[made.human.index(f"{n}_flexion") - 7, 1]) for n in SPINE)
    out = []
    for name, (first, second) in zip(chain[1:], pairwise(links), strict=False):
        turn = np.degrees(_angle(first, second))
        if np.nanmax(turn) > 2.0 * own:
            at = made.times[int(np.nanargmax(turn))]
            out.append(
                f"the recorded spine bends by up to {np.nanmax(turn):.0f} degrees at {name}, at "
                f"{at:.2f} s; no joint of this body's spine bends by more than {own:.0f}"
            )
    return out


def recorded_feet(made: Fit, points: Points) -> list[str]:
    """At what angles to the soles the lines between the recorded points of feet lie.

    Views draw such lines as bars, and they are not the soles.

    Args:
        made: The body fitted to them.
        points: What was followed, in the world [m]; NaN where lost.
    """
    out = []
    for side in SIDES:
        on = (f"{side}_foot", f"{side}_toes")
        names = [name for name, segment in made.segments.items() if segment in on]
        if len(names) < 2:
            continue
        turns = made.human.sites(made.motion, on[:1])[on[0]][1]
        back = Rotation.from_quat(turns, scalar_first=True).inv()
        tilts = {}
        for first, second in combinations(names, 2):
            way = back.apply(points[second] - points[first])
            tilts[first, second] = np.degrees(np.arctan2(way[:, 2], np.hypot(*way[:, :2].T)))
        pair = max(tilts, key=lambda one: abs(np.nanmedian(tilts[one])))
        up = np.sign(np.nanmedian(tilts[pair]))
        low, middle, high = np.nanquantile(up * tilts[pair], [0.05, 0.5, 0.95])
        if middle > TILTED:
            out.append(
                f"the line from {pair[0]} to {pair[1]} is not the {side} sole: it lies at "
                f"{middle:.0f} degrees to it in the median ({low:.0f} to {high:.0f} "
                "in nine of ten frames)"
            )
    return [f"{listed(out)}, so that one end stands off the drawn foot"] if out else []


def stand_off(made: Fit, names: Mapping[str, BodyName]) -> list[str]:
    """Markers that ride far from the landmarks that they are named after, the worst of each part.

    Args:
        made: The body fitted to them, with a site for each.
        names: What their names mean.
    """
    model = made.human.model
    sites = {model.site(number).name: number for number in range(model.nsite)}
    apart: dict[str, tuple[float, str]] = {}
    for name, segment in made.segments.items():
        own = sites.get(f"marker_{name}")
        usual = sites.get(names[name].place) if name in names and names[name].exact else None
        if own is not None and usual is not None:
            metres = float(np.linalg.norm(model.site_pos[own] - model.site_pos[usual]))
            same = model.site_bodyid[own] == model.site_bodyid[usual]
            if same and metres > FAR_M:
                apart[segment] = max(apart.get(segment, (0.0, "")), (metres, name))
    told = [
        f"{name} by {1e3 * metres:.0f} mm ({segment.replace('_', ' ')})"
        for segment, (metres, name) in sorted(apart.items(), key=lambda one: -one[1][0])
    ]
    if not told:
        return []
    return [
        "markers or joints that ride aside from where this body has the landmarks of their names, "
        f"the worst of each part: {', '.join(told)}; distances from their places on the body do "
        "not contain that"
    ]


def passing_legs(made: Fit) -> list[str]:
    """When the legs of somebody who walks pass each other, and how near the ankles are then.

    Args:
        made: The body, both of whose feet were followed.
    """
    feet = [f"{side}_foot" for side in SIDES]
    if set(feet) & set(made.unrecorded):
        return []
    where = made.human.sites(made.motion, [*feet, "pelvis"])
    ahead = Rotation.from_quat(where["pelvis"][1], scalar_first=True).apply([1.0, 0.0, 0.0])
    apart = where[feet[0]][0] - where[feet[1]][0]
    along = (apart * ahead)[:, :2].sum(axis=1)
    crossings = np.flatnonzero(np.diff(np.sign(along)) != 0)
    between = np.split(np.abs(along), crossings + 1)
    steps = [
        frame
        for frame, before, after in zip(crossings, between, between[1:], strict=False)
        if before.max() > STEP_M and after.max() > STEP_M
    ]
    if len(steps) < LEAST_STEPS:
        return []
    metres = np.linalg.norm(apart[steps], axis=1)
    knees = np.degrees(
        [made.motion[steps, made.human.index(f"{side}_knee_flexion")] for side in SIDES]
    )
    times = [f"{made.times[frame]:.2f}" for frame in steps]
    more = [f"{len(times) - MOST_STEPS} more times"] if len(times) > MOST_STEPS else []
    return [
        f"the legs pass each other at {listed([*times[:MOST_STEPS], *more])} s: the ankles are "
        f"then {1e3 * metres.min():.0f} to {1e3 * metres.max():.0f} mm apart, as recorded, one "
        f"knee bent by {knees.min(axis=0).min():.0f} to {knees.min(axis=0).max():.0f} degrees and "
        f"the other by {knees.max(axis=0).min():.0f} to {knees.max(axis=0).max():.0f}; from "
        "aside one leg hides the other"
    ]


def closed_hands(made: Fit, hands: Mapping[str, Closing]) -> list[str]:
    """How far hands are closed by their recorded fingers, or that these are not recorded.

    Args:
        made: The body.
        hands: What is known of them, by the side.
    """
    seen = [side for side in SIDES if f"{side}_hand" not in made.unrecorded]
    told, out = [], []
    for side in (side for side in seen if side in hands):
        bent = [
            float(np.degrees(np.median(made.motion[:, made.human.index(f"{side}_{hinge}")])))
            for hinge in ("knuckle_flexion", "finger_flexion")
        ]
        names = hands[side].names
        told.append(
            f"of the {side} hand by {bent[0]:.0f} degrees at the knuckles and {bent[1]:.0f} beyond "
            f"in the median ({names[0]} to {names[-1]})"
        )
    if told:
        out.append(f"fingers, which bend as one, are bent as recorded: {listed(told)}")
    without = [f"{side} hand" for side in seen if side not in hands]
    if without:
        out.append(
            f"no fingers are recorded of the {listed(without)}: they are drawn straight, whatever "
            "they hold"
        )
    return out


def _angle(
    first: Float[np.ndarray, "frames 3"], second: Float[np.ndarray, "frames 3"]
) -> Float[np.ndarray, "frames"]:
    """The angle between two directions [rad]."""
    lengths = np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    return np.asarray(np.arccos(np.clip((first * second).sum(axis=1) / lengths, -1.0, 1.0)))
