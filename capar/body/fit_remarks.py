"""What readers of a fitted body's pictures ask about, said from the fit itself."""

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np
from jaxtyping import Float, Int
from scipy.signal import find_peaks
from scipy.spatial.transform import Rotation

from capar.body.fitting import Fit
from capar.model.capture import Capture, Shape
from extractors.readers.body_names.body_names import SIDES, without_side

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
