"""What bears whom: feet that bear the body, loads, and seats."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from capar.model import geometry
from capar.model.calibration import Calibration
from capar.model.capture import Capture, Sensor
from capar.model.facts import Bears, Displaced, Fact, Seated, Touching
from capar.model.geometry import Holds, Places, Series
from extractors.bodies.bodies import Bodies, BodyGeometry, trunk_sensor
from extractors.contact.contacts import FOOT
from extractors.contact.normals import contact_normal
from extractors.contact.surfaces import surface
from extractors.contact.touch_distances import touching_part
from extractors.motion.motion_edges import seat
from extractors.motion.object_motion import resting
from extractors.signals.intervals import Interval, intervals, mask
from extractors.thresholds import Thresholds

WHOLE, PART, NONE = "whole", "part", "none"


def bearing(
    capture: Capture,
    bodies: Bodies,
    touches: Iterable[Touching],
    calibration: Calibration,
    thresholds: Thresholds,
) -> Iterator[Bears]:
    """When each foot that is down bears the whole weight, part of it, or none.

    A foot is down while it touches what is below it, and while it rests about as low as feet ever
    do: contact may be missed by millimetres, and no floor be known. A foot that alone is down
    bears the whole weight. Of two, each bears the share that holds a body at rest whose middle
    stands between them where the sensor nearest to it does.

    Nothing is said where the middle is too far off the feet, two feet or a trunk are not tracked.
    """
    known = list(touches)
    for agent in capture.agents:
        own = [each for each in capture.sensors if capture.agent_of(each) == agent.name]
        feet = [each for each in own if each.end_effector == FOOT and not each.part_of]
        if len(feet) == 2:
            level_m = calibration.foot_level(agent.name)
            trunk = trunk_sensor(own)
            middle = bodies.sensors[trunk.name].poses.smooth.positions if trunk else None
            yield from _loads(capture, bodies, feet, middle, known, level_m, thresholds)


def _loads(
    capture: Capture,
    bodies: Bodies,
    feet: Sequence[Sensor],
    middle: Places | None,
    touches: Sequence[Touching],
    level_m: float,
    thresholds: Thresholds,
) -> Iterator[Bears]:
    """What the two feet of one agent bear."""
    feet_geometry = [bodies.sensors[each.name] for each in feet]
    down = _down(bodies, feet_geometry, touches, level_m, thresholds)
    share = share_of_first(
        feet_geometry[0].middles, feet_geometry[1].middles, down[0], down[1], middle, thresholds
    )
    for foot, standing, own in zip(feet, down, (share, 1.0 - share), strict=True):
        with np.errstate(invalid="ignore"):
            whole = standing & (own >= 1.0 - thresholds.touch_load_share)
            none = standing & (own <= thresholds.touch_load_share)
        part = standing & ~np.isnan(own) & ~whole & ~none
        for how, holds in ((WHOLE, whole), (PART, part), (NONE, none)):
            for span in intervals(
                holds,
                capture.times,
                dropout_s=thresholds.dropout_s,
                minimum_s=thresholds.rest_minimum_s,
            ):
                yield Bears(foot.name, how, *span)


def share_of_first(
    first: Places,
    second: Places,
    first_down: Holds,
    second_down: Holds,
    middle: Places | None,
    thresholds: Thresholds,
) -> Series:
    """Share of the weight that the first of two feet bears [1]; NaN where it cannot be known.

    ``first_down``: whether that foot is down. ``second_down``: whether the other one is.
    ``middle``: A place near the middle of the body [m]; None where none is tracked.
    """
    out = np.where(first_down, 1.0, np.where(second_down, 0.0, np.nan))
    line = (second - first)[:, :2]
    apart = geometry.lengths(line)
    both = first_down & second_down
    out[np.isnan(apart)] = np.nan
    if middle is None:
        out[both] = np.nan
        return out
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.einsum("ij,ij->i", (middle - first)[:, :2], line) / apart**2
        between = np.clip(along, 0.0, 1.0)
        out = np.where(both, 1.0 - between, out)
        base = first[:, :2] + np.where(both, between, 1.0 - out)[:, None] * line
        off = geometry.lengths(middle[:, :2] - base)
        unknown = (both & ~(apart >= thresholds.feet_apart_m)) | (off > thresholds.off_feet_m)
    out[unknown | (both & np.isnan(off))] = np.nan
    return np.asarray(out)


def _down(
    bodies: Bodies,
    feet: Sequence[BodyGeometry],
    touches: Sequence[Touching],
    level_m: float,
    thresholds: Thresholds,
) -> list[Holds]:
    """Frames in which each foot is down: something bears it from below, or it rests low."""
    out = []
    for foot in feet:
        spans = []
        for each in touches:
            if each.body == foot.name and each.other in bodies.objects:
                other = bodies.objects[each.other]
                part = touching_part(bodies, foot.name, other, each.first)
                normal = contact_normal(part, other, each.first, thresholds)
                if normal is not None and normal[2] >= thresholds.steep:
                    spans.append((each.first, each.last))
        with np.errstate(invalid="ignore"):
            low = _heights_at_rest(foot, thresholds) <= level_m + thresholds.level_m
        out.append(mask(spans, len(foot.middles)) | low)
    return out


def foot_level(feet: Sequence[BodyGeometry], thresholds: Thresholds) -> float | None:
    """Height of the lowest point of some feet where one rests lowest [m]; None if none rests."""
    if not feet:
        return None
    heights = np.concatenate([_heights_at_rest(foot, thresholds) for foot in feet])
    known = heights[~np.isnan(heights)]
    return float(known.min()) if known.size else None


def _heights_at_rest(foot: BodyGeometry, thresholds: Thresholds) -> Series:
    """Height of a foot's lowest point while it rests [m]; NaN while it does not."""
    low = foot.boxes[0][:, 2]
    return np.where(mask(list(resting(foot.poses, thresholds)), len(low)), low, np.nan)


def rides(
    load: BodyGeometry,
    bearer: BodyGeometry,
    touching: Interval,
    motions: Iterable[Interval],
    thresholds: Thresholds,
) -> bool:
    """Whether a body is borne by another one, in a contact, and goes along when that one moves.

    It lies on it as the motion begins, or in it with its bottom below, and stays at its place on
    the bearer, compared with the bearer's own path, or in the bearer.

    ``touching``: their contact, as a closed interval of frames.
    """
    spans = [(max(begin, touching[0]), min(end, touching[1])) for begin, end in motions]
    return any(a < z and _goes_along(load, bearer, (a, z), thresholds) for a, z in spans)


def _goes_along(
    load: BodyGeometry, bearer: BodyGeometry, span: Interval, thresholds: Thresholds
) -> bool:
    first, last = span
    part = slice(first, last + 1)
    offset = load.middles[part] - bearer.middles[part]
    own = np.swapaxes(bearer.turns_at(part), 1, 2) @ offset[..., None]
    if np.isnan(own).any():
        return False
    contained = [_contains(bearer, load, frame) for frame in span]
    if not contained[0]:
        normal = contact_normal(load, bearer, first, thresholds)
        if normal is None or normal[2] < thresholds.steep:
            return False
    if all(contained):
        return True
    stray = float(geometry.lengths(own - own[0]).max())
    way = float(geometry.lengths(bearer.middles[part] - bearer.middles[first]).max())
    return stray <= max(thresholds.motion_floor_m, thresholds.ride_share * way)


def _contains(bearer: BodyGeometry, load: BodyGeometry, frame: int) -> bool:
    """Whether a load's middle is in the hull of its larger bearer, whose surface is below it."""
    sizes = [float(np.prod(each.shape.size)) if each.shape else 0.0 for each in (load, bearer)]
    if bearer.planes is None or bearer.shape is None or sizes[0] >= sizes[1]:
        return False
    point = (load.middles[frame] - bearer.middles[frame]) @ bearer.turn(frame)
    if (bearer.planes[:, :3] @ point + bearer.planes[:, 3] > 0.0).any():
        return False
    down = np.array([[0.0, 0.0, -1.0]]) @ bearer.turn(frame)
    centre = bearer.shape.bounds.mean(axis=0)
    places, _ = surface(bearer.shape).hits((point + centre)[None], down)
    return bool(len(places))


def seated(
    things: Mapping[str, BodyGeometry],
    hands: Mapping[str, BodyGeometry],
    touches: Iterable[Touching],
    known: Iterable[Fact],
    thresholds: Thresholds,
) -> Iterator[Fact]:
    """When each thing is down on what bears it: it comes and goes while one of the two moves.

    On what has no surface of its own nothing is seen to come down: there a contact is its distance.
    A palm that faces up bears a thing as a table does.

    ``hands``: acting end-effectors by name.
    """
    moves = [fact for fact in known if isinstance(fact, Displaced)]
    for touch in touches:
        if touch.other not in things:
            continue
        if touch.body in things and things[touch.other].shape:
            body, other = things[touch.body], things[touch.other]
        elif touch.body in hands and hands[touch.body].shape:
            body, other = things[touch.other], hands[touch.body]
        else:
            continue
        normal = contact_normal(body, other, touch.first, thresholds)
        if normal is not None and normal[2] >= thresholds.steep:
            spans = [(m.first, m.last) for m in moves if m.object in (touch.body, touch.other)]
            down = seat(body, other, (touch.first, touch.last), spans, thresholds)
            yield Seated(body.name, other.name, *down)
