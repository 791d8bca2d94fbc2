"""Five fingers that close onto what a hand holds, and open before and after."""

import itertools
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial import KDTree
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.anthropometry import Measures, measures_of, mirrored, table
from capar.body.human import ROOT_SIZE, Human, finger_joints
from capar.body.recording import HAND_SEGMENTS
from capar.body.scripts import SIDES, minimum_jerk
from capar.body.sensor_fitting import Fit
from capar.body.shapes import segment_surface
from capar.body.skeleton import skeleton
from capar.model import geometry
from capar.model.capture import Agent, Capture, Sensor, Shape, Stream, TagType
from capar.model.facts import Fact, Touching

#: A bone that is no farther from an object touches it, and how near it is brought [m]
TOUCHES_M, NEAR_M = 0.0005, 0.0002
#: Fingers of which no bone comes nearer than this do not reach what the hand holds [m]
REACHES_M = 0.002
#: Distance of neighbouring points on a surface, at most [m]: a finger between them is 0.5 mm off
SPACING_M = 0.005
#: Points on the axis of each bone [share of its length]; the base of the first one is the palm's
ALONG = np.linspace([0.4, 0.0, 0.0], 1.0, 11, axis=1)
#: Objects are measured this far from the middle of the hand [share of its length]
NEAR_HAND = 0.75
#: How fast the joints of a finger close against each other [1], and steps at most
RATES, STEPS = (1.0, 1.0, 0.7), 200
#: Flexions with which fingers begin to close, and oppositions of the thumb that are tried [rad]
OPEN = tuple(np.radians([-15.0, 0.0, 0.0]))
OPPOSITIONS = tuple(np.radians([75.0, 60.0, 45.0, 30.0, 15.0, 0.0]))
#: How long before contact fingers close, and before that the thumb is opposed; likewise after [s]
CLOSE_S, OPPOSE_S = 0.2, 0.3

FINGERS: tuple[str, ...] = tuple(table("fingers")["finger"])
THUMB = "thumb"


@dataclass(frozen=True, eq=False)
class Finger:
    """The bones of one finger in the frame of the hand's segment, in the open hand."""

    name: str  #: ``right_index``
    starts: Float[np.ndarray, "3 3"]  #: Of each bone [m]
    ends: Float[np.ndarray, "3 3"]  #: Of each bone's axis [m]; flesh goes on by its radius
    radii: Float[np.ndarray, "3"]  #: [m]
    axes: tuple[tuple[int, Float[np.ndarray, "3"]], ...]  #: Bone and axis of each hinge
    ranges: Float[np.ndarray, "hinges 2"]  #: [rad]

    def bones(
        self, angles: Float[np.ndarray, "hinges"]
    ) -> tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3 3 3"]]:
        """Where each bone starts [m], and how it is turned."""
        turn, at, places, turns = np.eye(3), self.starts[0], [], []
        for bone, start in enumerate(self.starts):
            at = at + turn @ (start - self.starts[max(bone - 1, 0)])
            for (own, axis), angle in zip(self.axes, angles, strict=True):
                if own == bone:
                    turn = turn @ _turn(angle, axis)
            places.append(at)
            turns.append(turn)
        return np.array(places), np.array(turns)

    def points(self, angles: Float[np.ndarray, "hinges"]) -> Float[np.ndarray, "3 points 3"]:
        """Points on the axis of each bone [m]."""
        places, turns = self.bones(angles)
        along = np.einsum("bij,bj->bi", turns, self.ends - self.starts)
        return places[:, None] + ALONG[..., None] * along[:, None]

    def lever(self, hinge: int, bone: int) -> float:
        """How far from a hinge a bone's flesh is, at most [m]."""
        first = self.axes[hinge][0]
        lengths = np.linalg.norm(self.ends - self.starts, axis=1)[first : bone + 1]
        return float(lengths.sum() + self.radii[first : bone + 1].max())


def _turn(angle: float, axis: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """The matrix of a rotation about an axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def fingers_of(measures: Measures, side: str) -> tuple[Finger, ...]:
    """The fingers of one hand."""
    segments, hand_m = skeleton(measures, fingers=True), measures["hand_length"]
    wrist, out = segments[f"{side}_hand"].origin, []
    for finger, row in table("fingers")["finger"].items():
        bones = [segments[f"{side}_{finger}_{number}"] for number in (1, 2, 3)]
        starts, ends = (np.array([getattr(b, e) for b in bones]) for e in ("origin", "tip"))
        radii = hand_m * np.array(row["radii"])
        last = ends[2] - starts[2]
        ends[2] -= radii[2] * last / np.linalg.norm(last)
        hinges = [r for r in finger_joints() if r["body"].startswith(f"right_{finger}")]
        flip = np.array([1.0, 1.0, 1.0] if side == "right" else [-1.0, 1.0, -1.0])
        axes = tuple((int(r["body"][-1]) - 1, flip * r["axis"]) for r in hinges)
        ranges = np.radians([r["range"] for r in hinges])
        out.append(Finger(f"{side}_{finger}", starts - wrist, ends - wrist, radii, axes, ranges))
    return tuple(out)


@dataclass(frozen=True, eq=False)
class Touchable:
    """Points on the surfaces of the objects near a hand, in the frame of its segment."""

    tree: KDTree
    held: Bool[np.ndarray, "points"]  #: Whether each is of an object that the hand holds

    @classmethod
    def of(
        cls, hand_m: float, held: Iterable[np.ndarray], others: Iterable[np.ndarray]
    ) -> "Touchable":
        """Of triangles [triangles 3 3] of objects that are held, and of others."""
        rows = [(_points(each, hand_m), True) for each in held]
        rows += [(_points(each, hand_m), False) for each in others]
        points = np.concatenate([np.zeros((0, 3)), *(found for found, _ in rows)])
        return cls(
            KDTree(points, compact_nodes=False, balanced_tree=False),
            np.repeat([h for _, h in rows], [len(p) for p, _ in rows]),
        )

    def gaps(
        self, finger: Finger, angles: Float[np.ndarray, "hinges"]
    ) -> tuple[Float[np.ndarray, "3"], Bool[np.ndarray, "3"]]:
        """How far each bone is from the nearest object [m], and whether that one is held."""
        found, which = self.tree.query(finger.points(angles))
        nearest, bones = found.argmin(axis=1), np.arange(3)
        return found[bones, nearest] - finger.radii, self.held[which[bones, nearest]]


def _points(
    triangles: Float[np.ndarray, "triangles 3 3"], hand_m: float
) -> Float[np.ndarray, "points 3"]:
    """Points on the part of a surface that is near a hand, no farther apart than ``SPACING_M``.

    Corners of triangles, which are divided at the middles of their longest edges.
    """
    middle, kept = np.array([0.0, 0.0, -0.5 * hand_m]), [triangles.reshape(-1, 3)]
    while len(triangles):
        edges = triangles - triangles[:, [1, 2, 0]]
        squares = np.einsum("tij,tij->ti", edges, edges)
        longest = np.sqrt(squares.max(axis=1))
        off = triangles[:, 0] - middle
        away = np.sqrt(np.einsum("ti,ti->t", off, off)) - longest
        coarse = (away < NEAR_HAND * hand_m) & (longest > SPACING_M)
        left, at = triangles[coarse], squares[coarse].argmax(axis=1)
        rows = np.arange(len(left))
        one, two, three = (left[rows, (at + step) % 3] for step in range(3))
        half = 0.5 * (one + two)
        kept.append(half)
        triangles = np.concatenate(
            [np.stack([one, half, three], axis=1), np.stack([half, two, three], axis=1)]
        )
    points = np.concatenate(kept)
    off = points - middle
    return points[np.einsum("pi,pi->p", off, off) < (NEAR_HAND * hand_m) ** 2]


@dataclass(frozen=True, eq=False)
class Grasp:
    """How the fingers of one hand lie on what it holds from a frame to another one."""

    first: int
    last: int
    things: tuple[str, ...]  #: What it holds
    opened: Float[np.ndarray, "hinges"]  #: Angles of all fingers before they close [rad]
    closed: Float[np.ndarray, "hinges"]  #: Likewise while it is held
    reaching: tuple[str, ...]  #: Fingers that touch what is held
    short: tuple[str, ...]  #: Those that do not reach it, or meet something else before


def closed_grasp(
    measures: Measures,
    side: str,
    span: tuple[int, int],
    held: Mapping[str, tuple[Shape, RigidTransform]],
    others: Sequence[tuple[Shape, RigidTransform]] = (),
) -> Grasp:
    """Close each finger of a hand until it touches something.

    Each joint stops when a bone beyond it touches, and those beyond that bone go on. A finger that
    touches nothing that is held stays open.

    Args:
        measures: Of the body.
        side: Of the hand.
        span: The first and the last frame of the hold.
        held: By name, objects that the hand holds, with ``T_hand_object`` of the hand's segment.
        others: Those that may be in the fingers' way.
    """
    faces = [
        [pose.apply(np.array(s.vertices))[np.array(s.faces)] for s, pose in several]
        for several in (held.values(), others)
    ]
    around = Touchable.of(measures["hand_length"], *faces)
    opened, closed = [], []
    reaching: list[str] = []
    short: list[str] = []
    for finger in fingers_of(measures, side):
        thumb = finger.name.endswith(THUMB)
        start, end, touches = (_close_thumb if thumb else _close_finger)(finger, around)
        (reaching if touches else short).append(finger.name)
        opened.append(start if touches else np.zeros_like(start))
        closed.append(end if touches else np.zeros_like(end))
    return Grasp(
        *span,
        tuple(held),
        np.concatenate(opened),
        np.concatenate(closed),
        tuple(reaching),
        tuple(short),
    )


_Closed = tuple[Float[np.ndarray, "hinges"], Float[np.ndarray, "hinges"], bool]


def _close_finger(finger: Finger, around: Touchable) -> _Closed:
    """Angles of the open and the closed finger, and whether it touches what is held."""
    end, gaps, held = _close(finger, np.array(OPEN), np.array(RATES), around)
    return np.zeros(3), end, bool((held & (gaps < REACHES_M)).any())


def _close_thumb(finger: Finger, around: Touchable) -> _Closed:
    """Likewise; first opposed as far as may be and wide open, else swung towards the palm."""
    wide = finger.ranges[1, 0]
    for opposition in OPPOSITIONS:
        start = np.array([opposition, wide, 0.0, 0.0])
        gaps, _ = around.gaps(finger, start)
        if gaps.min() > TOUCHES_M:
            end, gaps, held = _close(finger, start, np.array([0.0, *RATES]), around)
            if (held & (gaps < REACHES_M))[1:].any():
                return start, end, True
    end, gaps, held = _close(finger, np.zeros(4), np.array([1.0, 0.0, 0.0, 0.0]), around)
    return np.zeros(4), end, bool((held & (gaps < REACHES_M)).any())


def _close(
    finger: Finger,
    start: Float[np.ndarray, "hinges"],
    rates: Float[np.ndarray, "hinges"],
    around: Touchable,
) -> tuple[Float[np.ndarray, "hinges"], Float[np.ndarray, "3"], Bool[np.ndarray, "3"]]:
    """Turn hinges until the bones beyond them touch; no step is longer than the way that is free.

    Bones beyond the last one that touches stay as they were when it came to touch.

    Returns:
        The angles, and of each bone the gap [m] and whether what is nearest is held.
    """
    angles, rates, touched, last = start.copy(), rates.copy(), start, -1
    bones = np.array([bone for bone, _ in finger.axes])
    levers = np.array(
        [
            [finger.lever(h, b) if b >= bones[h] else 0.0 for h in range(len(bones))]
            for b in range(3)
        ]
    )
    for _ in range(STEPS):
        gaps, _ = around.gaps(finger, angles)
        touching = int(np.flatnonzero(gaps < TOUCHES_M).max(initial=-1))
        if touching > last:
            last, touched = touching, angles
        rates[bones <= last] = 0.0
        rates[angles >= finger.ranges[:, 1] - 1e-9] = 0.0
        speeds = levers @ rates
        if not speeds.any():
            break
        moving = speeds > 0.0
        step = float(((gaps[moving] - NEAR_M) / speeds[moving]).min())
        room = (finger.ranges[:, 1] - angles)[rates > 0.0] / rates[rates > 0.0]
        angles = angles + rates * min(step, float(room.min()))
    angles = touched if last >= 0 else angles
    return angles, *around.gaps(finger, angles)


def hand_grasps(
    measures: Measures,
    side: str,
    hand: RigidTransform,
    things: Mapping[str, tuple[Shape, RigidTransform]],
    spans: Iterable[tuple[int, int, Collection[str]]],
) -> Iterator[Grasp]:
    """How a hand's fingers close in each interval in which it holds some objects.

    Args:
        measures: Of the body.
        side: Of the hand.
        hand: ``T_world_hand`` of its segment at every frame.
        things: Shape and ``T_world_thing`` at every frame of every object.
        spans: First and last frame, and what is held meanwhile.
    """
    for first, last, names in spans:
        part = slice(first, last + 1)
        seats = {n: hand[part].inv() * path[part] for n, (_, path) in things.items()}
        held = {name: (things[name][0], _usual(seats[name])) for name in sorted(names)}
        others = [
            (things[name][0], seat[frame])
            for name, seat in seats.items()
            for frame in (0, -1)
            if name not in names
        ]
        yield closed_grasp(measures, side, (first, last), held, others)


def _usual(poses: RigidTransform) -> RigidTransform:
    """The median place and the mean turn of poses near each other."""
    middle: Float[np.ndarray, "3"] = np.median(poses.translation, axis=0)
    return RigidTransform.from_components(middle, poses.rotation.mean())


def flexions(
    frames: int, rate_hz: float, grasps: Iterable[Grasp]
) -> Float[np.ndarray, "frames hinges"]:
    """The angles of all fingers of a hand at every frame [rad]: open between its grasps."""
    out, most = np.zeros((frames, len(hinge_names("right")))), np.zeros(frames)
    at_s = np.arange(frames) / rate_hz
    for grasp in grasps:
        away = np.maximum(grasp.first / rate_hz - at_s, at_s - grasp.last / rate_hz)
        close = np.array([minimum_jerk(1.0 - max(s, 0.0) / CLOSE_S) for s in away])
        oppose = np.array([minimum_jerk(1.0 - max(s - CLOSE_S, 0.0) / OPPOSE_S) for s in away])
        own = oppose[:, None] * grasp.opened + close[:, None] * (grasp.closed - grasp.opened)
        nearer = oppose + close > most
        out[nearer], most = own[nearer], np.maximum(most, oppose + close)
    return out


#: Hinges of fingers that bend as one, those of five fingers that bend as they do, and how far [1]
AS_ONE = (
    ("knuckle_flexion", "_1", 1.0),
    ("finger_flexion", "_2", 1.0),
    ("finger_flexion", "_3", 0.7),
)


def fingered(
    human: Human,
    motion: Float[np.ndarray, "frames posture"],
    hands: Mapping[str, Float[np.ndarray, "frames hinges"]],
) -> tuple[Human, Float[np.ndarray, "frames posture"]]:
    """The same body and motion with five fingers on each hand, bent so by side [rad].

    Fingers of a side that is not given bend as they did as one.
    """
    body = Human.of(human.measures, fingers=True)
    out = np.zeros((len(motion), ROOT_SIZE + len(body.joints)))
    out[:, :ROOT_SIZE] = motion[:, :ROOT_SIZE]
    for name in set(human.joints).intersection(body.joints):
        out[:, body.index(name)] = motion[:, human.index(name)]
    for side, finger, (hinge, end, share) in itertools.product(SIDES, FINGERS, AS_ONE):
        if finger != THUMB:
            angle = share * motion[:, human.index(f"{side}_{hinge}")]
            out[:, body.index(f"{side}_{finger}_flexion{end}")] = angle
    for side, angles in hands.items():
        for name, column in zip(hinge_names(side), angles.T, strict=True):
            out[:, body.index(name)] = column
    return body, out


def hinge_names(side: str) -> list[str]:
    """Names of the hinges of a hand's fingers, in the order of ``flexions``."""
    names = [row["name"] for row in finger_joints()]
    return names if side == "right" else [mirrored(name) for name in names]


#: A surface that differs no more from that of the performer's own hand is that hand's [m]
SAME_M = 0.001


def hand_seat(agent: Agent, sensor: Sensor) -> tuple[Measures, RigidTransform] | None:
    """An agent's measures and ``T_sensor_hand``, where a sensor has that body's own hand's surface.

    None where it is another one: a recorded hand has fingers of its own.
    """
    hand = sensor.end_effector == "hand" and sensor.side in SIDES
    if not hand or sensor.shape is None or "hand_length" not in agent.measures:
        return None
    measures = measures_of(agent)
    names = tuple(f"{sensor.side}_{each}" for each in HAND_SEGMENTS)
    own = np.array(segment_surface(measures, names, f"{sensor.side}_hand").vertices)
    worn = np.array(sensor.shape.vertices)
    if worn.shape != own.shape:
        return None
    middles = worn.mean(axis=0), own.mean(axis=0)
    turn, _ = Rotation.align_vectors(worn - middles[0], own - middles[1])
    seat = RigidTransform.from_components(middles[0] - turn.apply(middles[1]), turn)
    return (measures, seat) if np.abs(seat.apply(own) - worn).max() < SAME_M else None


def seen_flexions(
    measures: Measures,
    capture: Capture,
    sensor: Sensor,
    hand: RigidTransform,
    facts: Iterable[Fact],
) -> Float[np.ndarray, "frames hinges"]:
    """The angles of a hand's fingers at every frame of a capture [rad].

    They close onto what the hand is observed to touch, the object that it touches longest first.

    Args:
        measures: Of the body.
        capture: With the objects.
        sensor: Of the hand.
        hand: ``T_world_hand`` of its segment at every frame.
        facts: Those of the observation.
    """
    things = {
        each.name: (each.shape, known_path(each.stream))
        for each in capture.objects
        if each.shape is not None and each.tag is not TagType.SELF and not each.stream.lost.all()
    }
    spans: list[tuple[int, int, Collection[str]]] = []
    touched = [f for f in facts if isinstance(f, Touching) and sensor.name == f.body]
    for fact in sorted(touched, key=lambda f: (f.first - f.last, f.first, f.other)):
        apart = all(fact.last < first or last < fact.first for first, last, _ in spans)
        if fact.other in things and apart:
            spans.append((fact.first, fact.last, {fact.other}))
    grasps = hand_grasps(measures, sensor.side, hand, things, spans)
    return flexions(len(capture.times), capture.rate_hz, grasps)


def known_path(stream: Stream) -> RigidTransform:
    """A body's poses, where it was lost that of the nearest frame in which it was seen."""
    seen = np.flatnonzero(~stream.lost)
    nearest = seen[np.abs(np.arange(len(stream.times))[:, None] - seen).argmin(axis=1)]
    return geometry.transforms(stream.positions[nearest], stream.orientations[nearest])


def fingered_fit(made: Fit, capture: Capture, facts: Iterable[Fact]) -> Fit:
    """A fitted body with five fingers on each hand.

    They bend as joints of them were recorded, else close onto what the hand touches.
    """
    nearest = np.abs(made.times[None] - capture.times[:, None]).argmin(axis=1)
    back = np.abs(made.times[:, None] - capture.times[None]).argmin(axis=1)
    hands, known = {}, tuple(facts)
    for sensor in capture.acting:
        side = sensor.side
        own = capture.agent_of(sensor) == capture.agent.name and sensor.end_effector == "hand"
        bent = [made.human.index(f"{side}_{hinge}") for hinge, _, _ in AS_ONE] if own else []
        if own and not sensor.part_of and not made.motion[:, bent].any():
            spots, turns = made.human.sites(made.motion, [f"{side}_hand"])[f"{side}_hand"]
            hand = geometry.transforms(spots[nearest], turns[nearest])
            angles = seen_flexions(made.human.measures, capture, sensor, hand, known)
            hands[side] = angles[back]
    human, motion = fingered(made.human, made.motion, hands)
    return replace(made, human=human, motion=motion)
