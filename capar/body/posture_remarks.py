"""What readers of a fitted body's pictures ask about arms and feet, and about recorded shapes."""

from collections.abc import Iterator

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.body.fit_remarks import SAMPLES, forms_of
from capar.body.fitting import Fit
from capar.body.object_remarks import from_form
from capar.model import geometry
from capar.model.capture import Capture, Sensor
from extractors.readers.body_names.body_names import SIDES

RAISED, BEHIND = np.radians(45.0), np.radians(25.0)
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

WAYS = {
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
                (raised, RAISED, "from hanging straight down"),
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
    word = WAYS[sensor.end_effector][axis][sign]
    return word if sensor.end_effector == "foot" or "beyond" in word else f"towards {word}"
