"""What is shown of a capture: each body with its surface and its way, thinned for the eye."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import trimesh
from jaxtyping import Bool, Float, Int
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures
from capar.body.grasping import fingers_of, hand_seat, known_path, seen_flexions
from capar.body.human import Human, poses_of
from capar.body.sensor_fitting import Fit
from capar.body.shapes import form_mesh, forms, joined, moved
from capar.body.skeleton import skeleton
from capar.model.capture import Capture, Role, Sensor, Shape, TagObject, TagType
from capar.model.facts import Fact, LookingAt, Touching
from capar.model.observation import Observation
from capar.views.picture import frame_clock

SMOOTH_HZ = 60.0
"""Frames are thinned to about this rate [Hz]: what screens show."""

GROUND_M = 2.0
"""What is fixed and wider than this both ways is a floor [m]."""

COLOURS = {
    "sensor": "#c98d6b",
    "looks": "#8a6bc9",
    "mobile": "#4477aa",
    "fixed": "#a9a9a9",
    "self": "#c98d6b",
    "finger": "#c98d6b",
    "body": "#e3d3c4",
}
"""The colour of a body by what it is."""


UNNAMED = ("body", "finger")  # Bodies of these kinds bear no names.


@dataclass(frozen=True, eq=False)
class StagedBody:
    """A sensor or an object, in the world: metres, z up."""

    name: str
    kind: str
    """``sensor``, ``looks`` (it attends), the tag of an object, ``finger``: a bone of a hand
    with fingers, or ``body``: of a fitted body."""

    shape: Shape | None
    positions: Float[np.ndarray, "frames 3"]
    """[m]; NaN where it was lost."""

    orientations: Float[np.ndarray, "frames 4"]
    """Unit quaternions, scalar first; NaN where it was lost."""

    faint: bool = False
    """Whether it is drawn translucent: it is assumed, or nothing of it was recorded."""

    @property
    def label(self) -> str:
        """Its name in words, and whether it is assumed."""
        words = self.name.replace("_", " ")
        told = self.faint and self.kind not in UNNAMED and "assumed" not in words
        return f"{words} (assumed)" if told else words

    @property
    def colour(self) -> str:
        """As a hexadecimal number after ``#``."""
        return COLOURS[self.kind]


@dataclass(frozen=True, eq=False)
class Stage:
    """Every body of a capture at the frames that are shown."""

    title: str
    times: Float[np.ndarray, "frames"]
    """[s]."""

    bodies: tuple[StagedBody, ...]

    def nearest(self, time_s: float) -> int:
        """The frame that is nearest to a time."""
        return int(np.argmin(np.abs(self.times - time_s)))


def stage(capture: Capture, *, at_s: float | None = None) -> Stage:
    """A capture as it is shown; bodies of which a bone changes its length are only points.

    Args:
        capture: The capture.
        at_s: The frame nearest to this time is shown, whatever others are left out [s].
    """
    every, last = max(round(capture.rate_hz / SMOOTH_HZ), 1), len(capture.times) - 1
    frames = np.unique([*range(0, last, every), last])
    if at_s is not None:
        frames = np.union1d(frames, np.argmin(np.abs(capture.times - at_s)))
    stretching = {one.bodies[0] for one in capture.notices if one.code == "bone-stretches"}
    bodies = tuple(
        replace(one, shape=None) if one.name in stretching else one
        for one in (_staged(body, frames) for body in capture.bodies.values())
    )
    return Stage(capture.name, capture.times[frames], bodies)


def _staged(body: Sensor | TagObject, frames: Int[np.ndarray, "frames"]) -> StagedBody:
    at = body.stream.positions[frames], body.stream.orientations[frames]
    if isinstance(body, TagObject):
        kind = {TagType.MOBILE: "mobile", TagType.FIXED: "fixed"}.get(body.tag, "self")
        return StagedBody(body.name, kind, body.shape, *at, faint=bool(body.assumed))
    kind = "looks" if body.role is Role.ATTENDS else "sensor"
    return StagedBody(body.name, kind, body.shape, *at)


def world_bounds(shown: Stage) -> Float[np.ndarray, "2 3"]:
    """Lowest and highest place where anything small is [m]: what a picture has to hold."""
    small = [body for body in shown.bodies if not is_ground(body)] or shown.bodies
    places = np.concatenate([each for body in small for each in _extent(body)])
    return np.stack([np.nanmin(places, axis=0), np.nanmax(places, axis=0)])


def is_ground(body: StagedBody) -> bool:
    """Whether it is fixed and as wide as a floor: wherever its middle is, nothing need be there."""
    if body.kind != "fixed" or body.shape is None:
        return False
    return bool(np.sort(np.ptp(body.shape.vertices, axis=0))[1] > GROUND_M)


def _extent(body: StagedBody) -> Iterator[Float[np.ndarray, "places 3"]]:
    yield body.positions
    if body.shape is not None and body.kind != "fixed":
        radius = float(np.linalg.norm(body.shape.vertices, axis=1).max())
        yield body.positions - radius
        yield body.positions + radius


def with_fingers(shown: Stage, capture: Capture, facts: Iterable[Fact]) -> Stage:
    """The same stage, where hands of virtual bodies have fingers that close onto what they touch.

    Recorded hands are shown as they are.
    """
    frames = np.searchsorted(capture.times, shown.times)
    bodies, known = {body.name: body for body in shown.bodies}, tuple(facts)
    for sensor, (measures, seat) in virtual_hands(capture):
        hand, lost = known_path(sensor.stream) * seat, sensor.stream.lost[frames]
        angles = seen_flexions(measures, capture, sensor, hand, known)[frames]
        meshes: dict[str, list[trimesh.Trimesh]] = {}
        for form in forms(measures, skeleton(measures, fingers=True)):
            meshes.setdefault(form.body, []).append(form_mesh(form))
        surfaces = {name: _surface(group) for name, group in meshes.items()}
        palm = moved(surfaces[f"{sensor.side}_hand"], seat)
        bodies[sensor.name] = replace(bodies[sensor.name], shape=palm)
        count = 0
        for finger in fingers_of(measures, sensor.side):
            own = angles[:, count : count + len(finger.axes)]
            count += len(finger.axes)
            places, turns = (np.array(rows) for rows in zip(*map(finger.bones, own), strict=True))
            for bone in range(len(finger.starts)):
                local = RigidTransform.from_components(
                    places[:, bone], Rotation.from_matrix(turns[:, bone])
                )
                pose = hand[frames] * local
                name = f"{finger.name}_{bone + 1}"
                shown_as = f"{sensor.name}_{name}" if sensor.agent else name
                spots = np.where(lost[:, None], np.nan, pose.translation)
                ways = pose.rotation.as_quat(scalar_first=True)
                bodies[shown_as] = StagedBody(shown_as, "finger", surfaces[name], spots, ways)
    return replace(shown, bodies=tuple(bodies.values()))


def virtual_hands(capture: Capture) -> Iterator[tuple[Sensor, tuple[Measures, RigidTransform]]]:
    """Sensors whose surfaces are hands of virtual bodies, with measures and ``T_sensor_hand``."""
    agents = {agent.name: agent for agent in capture.agents}
    for sensor in capture.acting:
        if (found := hand_seat(agents[capture.agent_of(sensor)], sensor)) is not None:
            yield sensor, found


def _surface(group: list[trimesh.Trimesh]) -> Shape:
    mesh = joined(group)
    return Shape(np.array(mesh.vertices), np.array(mesh.faces), description="mannequin")


SEEN_SHARE = 0.3
"""A body is not shown while a smaller share of what it follows is seen than this, against the most
that is seen at once [1]: its posture would be made up."""

GROUND = "assumed_ground"
MARGIN_M = 0.8
"""How far the assumed ground goes beyond where the body is [m]."""

THICK_M = 0.01
LOWEST_SHARE = 0.05
"""Share of the frames in which soles may be below the assumed ground [1]."""


def with_mannequin(shown: Stage, fit: Fit) -> Stage:
    """The same stage with a fitted body on it, at the frames of the fit nearest to those shown.

    Segments of which nothing was recorded are faint. Where the recording has no floor, a ground
    under the lowest soles is added and named as assumed.
    """
    nearest = np.abs(shown.times[:, None] - fit.times[None]).argmin(axis=1)
    known = _known(fit)[nearest]
    unseen = {f"body_{name}" for name in fit.unrecorded}
    bodies = [
        replace(
            one,
            positions=np.where(known[:, None], one.positions, np.nan),
            faint=one.name in unseen,
        )
        for one in body_parts(fit.human, fit.motion[nearest])
    ]
    if not any(is_ground(body) for body in shown.bodies):
        bodies.append(_ground(bodies))
    return replace(shown, bodies=(*shown.bodies, *bodies))


def body_parts(
    human: Human, motion: Float[np.ndarray, "frames coordinates"]
) -> tuple[StagedBody, ...]:
    """The segments of a human body in postures, as bodies to be shown."""
    poses = poses_of(human, motion)
    parts: dict[str, list[trimesh.Trimesh]] = {}
    for form in forms(human.measures, human.segments):
        parts.setdefault(form.body, []).append(form_mesh(form))
    out = []
    for number, name in enumerate(poses.names):
        if name in parts:
            at = poses.positions[:, number], poses.orientations[:, number]
            out.append(StagedBody(f"body_{name}", "body", _surface(parts[name]), *at))
    return tuple(out)


def _known(fit: Fit) -> Bool[np.ndarray, "frames"]:
    """Whether enough of what the body follows is seen to show it."""
    if not fit.bridged:
        return np.ones(len(fit.times), dtype=bool)
    seen = np.sum([~lost for lost in fit.bridged.values()], axis=0)
    return np.asarray(seen > SEEN_SHARE * seen.max())


def _ground(bodies: Sequence[StagedBody]) -> StagedBody:
    """A level plate under the soles."""
    soles = []
    for body in bodies:
        if body.name.endswith("_foot") and body.shape is not None:
            turns = Rotation.from_quat(body.orientations, scalar_first=True).as_matrix()
            heights = turns[:, 2] @ np.array(body.shape.vertices).T
            soles.append(body.positions[:, 2] + heights.min(axis=1))
    top = float(np.nanquantile(np.min(soles, axis=0), LOWEST_SHARE))
    places = np.concatenate([body.positions[:, :2] for body in bodies])
    low, high = np.nanmin(places, axis=0) - MARGIN_M, np.nanmax(places, axis=0) + MARGIN_M
    mesh = trimesh.creation.box([*(high - low), THICK_M])
    shape = Shape(np.array(mesh.vertices), np.array(mesh.faces), description="assumed")
    frames = len(bodies[0].positions)
    middle = np.array([*(low + high) / 2.0, top - THICK_M / 2.0])
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    return StagedBody(GROUND, "fixed", shape, np.tile(middle, (frames, 1)), turns, faint=True)


@dataclass(frozen=True, eq=False)
class Intervals:
    """When pairs of bodies touch, or when one looks at the other."""

    pairs: tuple[tuple[str, str], ...]
    starts_s: Float[np.ndarray, "intervals"]
    ends_s: Float[np.ndarray, "intervals"]

    def at(self, time_s: float) -> list[tuple[str, str]]:
        """The pairs of those at a time."""
        now = np.flatnonzero((self.starts_s <= time_s) & (time_s <= self.ends_s))
        return [self.pairs[number] for number in now]


def intervals(observation: Observation | None, kind: type[Touching] | type[LookingAt]) -> Intervals:
    """The intervals of contacts, or of looks, in an observation; none without one."""
    found = [] if observation is None else [f for f in observation.facts if isinstance(f, kind)]
    if observation is None or not found:
        return Intervals((), np.zeros(0), np.zeros(0))
    clock = frame_clock(observation, {})
    pairs = tuple(
        (each.sensor, each.object) if isinstance(each, LookingAt) else (each.body, each.other)
        for each in found
    )
    starts, ends = np.array([(clock(each.first), clock(each.last)) for each in found]).T
    return Intervals(pairs, starts, ends)


def known_steps(body: StagedBody) -> Bool[np.ndarray, "steps"]:
    """Whether a body is seen at both ends of each step from a frame to the next."""
    known = ~np.isnan(body.positions[:, 0])
    return np.asarray(known[:-1] & known[1:])


def way(
    body: StagedBody, now: Bool[np.ndarray, "frames"] | None = None
) -> Float[np.ndarray, "lines 2 3"]:
    """The steps of a body as lines [m], without those where it was lost; of some frames only."""
    kept = known_steps(body)
    if now is not None:
        kept = kept & now[:-1] & now[1:]
    return np.stack([body.positions[:-1], body.positions[1:]], axis=1)[kept]
