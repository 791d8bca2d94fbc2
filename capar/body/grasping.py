"""Five fingers that close onto what a hand holds, and open before and after."""

import itertools
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

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
#: Objects are measured this far from the middle of the hand [share of its length], and distances
#: of bones from them up to this [m]
NEAR_HAND, FAR_M = 0.75, 0.05
#: At how many instants of a hold fingers are kept clear of other things near the hand [1]
INSTANTS = 9
#: How fast the joints of a finger close against each other [1], and steps at most
RATES, STEPS = (1.0, 1.0, 0.7), 200
#: Flexions at the knuckle with which fingers begin to close, those with which a thumb that is not
#: opposed does, and oppositions of the thumb that are tried, in order [rad]
OPEN = tuple(np.radians([-15.0, -20.0, 0.0, 15.0, 30.0, 45.0]))
FLAT = tuple(np.radians([0.0, -15.0, -30.0, -45.0, -55.0]))
OPPOSITIONS = tuple(np.radians([75.0, 60.0, 45.0, 30.0, 15.0, 0.0]))
#: Halvings by which the share is found to which a finger may be closed where the hand is [1]
HALVINGS = 6
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
class Near:
    """Points on the surface of an object near a hand, and where it is seen from the hand."""

    held: bool  #: Whether the hand holds it
    tree: KDTree  #: In the object's frame
    seats: RigidTransform  #: ``T_hand_object`` of the hand's segment, at some frames

    @classmethod
    def of(cls, shape: Shape, seats: RigidTransform, hand_m: float, *, held: bool) -> "Near":
        """Of what of a surface is near a hand of a length [m] at any of some frames."""
        middles = seats.inv().apply([0.0, 0.0, -0.5 * hand_m])
        triangles = np.array(shape.vertices)[np.array(shape.faces)]
        points = _points(triangles, KDTree(middles), NEAR_HAND * hand_m)
        return cls(held, KDTree(points, compact_nodes=False, balanced_tree=False), seats)

    def at(self, seats: RigidTransform) -> "Near":
        """The same, seen elsewhere from the hand."""
        return replace(self, seats=seats)

    def distances(self, points: Float[np.ndarray, "3 points 3"]) -> Float[np.ndarray, "3"]:
        """How far points of each bone, in the hand's frame, are from it at the nearest [m]."""
        turns, spots = self.inverse
        local = np.einsum("sij,bpj->sbpi", turns, points) + spots[:, None, None]
        found, _ = self.tree.query(local, distance_upper_bound=FAR_M)
        return np.minimum(found.min(axis=(0, 2)), FAR_M)

    @cached_property
    def inverse(self) -> tuple[Float[np.ndarray, "seats 3 3"], Float[np.ndarray, "seats 3"]]:
        """Matrix and translation of ``T_object_hand`` at each frame [m]."""
        back = self.seats.inv()
        return back.rotation.as_matrix(), np.asarray(back.translation)


def gaps(
    near: Iterable[Near], finger: Finger, angles: Float[np.ndarray, "hinges"]
) -> tuple[Float[np.ndarray, "3"], Bool[np.ndarray, "3"]]:
    """How far each bone is from the nearest object [m], and whether that one is held."""
    points, known = finger.points(angles), [each for each in near if each.tree.n]
    found = np.array([np.full(3, FAR_M), *(each.distances(points) for each in known)])
    held = np.array([False, *(each.held for each in known)])
    return found.min(axis=0) - finger.radii, held[found.argmin(axis=0)]


def _points(
    triangles: Float[np.ndarray, "triangles 3 3"], middles: KDTree, reach_m: float
) -> Float[np.ndarray, "points 3"]:
    """Points on the part of a surface that is near some middles, at most ``SPACING_M`` apart.

    Corners of triangles, which are divided at the middles of their longest edges.
    """
    kept = [triangles.reshape(-1, 3)]
    while len(triangles):
        edges = triangles - triangles[:, [1, 2, 0]]
        squares = np.einsum("tij,tij->ti", edges, edges)
        longest = np.sqrt(squares.max(axis=1))
        away, _ = middles.query(triangles[:, 0])
        coarse = (away - longest < reach_m) & (longest > SPACING_M)
        left, at = triangles[coarse], squares[coarse].argmax(axis=1)
        rows = np.arange(len(left))
        one, two, three = (left[rows, (at + step) % 3] for step in range(3))
        half = 0.5 * (one + two)
        kept.append(half)
        triangles = np.concatenate(
            [np.stack([one, half, three], axis=1), np.stack([half, two, three], axis=1)]
        )
    points = np.concatenate(kept)
    return points[middles.query(points)[0] < reach_m]


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
    #: How far each finger is closed at every frame: 0 is open, 1 ``opened`` and 2 ``closed``
    shares: Float[np.ndarray, "frames 5"]


def closed_grasp(
    measures: Measures,
    side: str,
    span: tuple[int, int],
    things: Sequence[str],
    near: Iterable[Near],
) -> Grasp:
    """Close each finger of a hand until it touches something.

    Each joint stops when a bone beyond it touches, and those beyond that bone go on. A finger that
    touches nothing that is held stays open, and out of others.

    Args:
        measures: Of the body.
        side: Of the hand.
        span: The first and the last frame of the hold.
        things: What the hand holds.
        near: The surfaces of that, and of others that may be in the fingers' way.
    """
    around, opened, closed = list(near), [], []
    reaching: list[str] = []
    short: list[str] = []
    for finger in fingers_of(measures, side):
        close = _close_thumb if finger.name.endswith(THUMB) else _close_finger
        touches = False
        if things:
            start, end, touches = close(finger, around)
        if not touches:
            start = end = _clear(finger, _opens(finger), around)
        (reaching if touches else short).append(finger.name)
        opened.append(start)
        closed.append(end)
    return Grasp(
        *span,
        tuple(things),
        np.concatenate(opened),
        np.concatenate(closed),
        tuple(reaching),
        tuple(short),
        np.zeros((0, len(FINGERS))),
    )


_Closed = tuple[Float[np.ndarray, "hinges"], Float[np.ndarray, "hinges"], bool]


def _close_finger(finger: Finger, around: list[Near]) -> _Closed:
    """Angles of the open and the closed finger, and whether it touches what is held."""
    start = _clear(finger, _opens(finger)[1:], around)
    end, apart, held = _close(finger, start, np.array(RATES), around)
    return np.zeros(3), end, bool((held & (apart < REACHES_M)).any())


def _close_thumb(finger: Finger, around: list[Near]) -> _Closed:
    """Likewise; first opposed as far as may be and wide open, else swung towards the palm."""
    wide = finger.ranges[1, 0]
    for opposition in OPPOSITIONS:
        start = np.array([opposition, wide, 0.0, 0.0])
        if gaps(around, finger, start)[0].min() > TOUCHES_M:
            end, apart, held = _close(finger, start, np.array([0.0, *RATES]), around)
            if (held & (apart < REACHES_M))[1:].any():
                return start, end, True
    start = _clear(finger, _opens(finger), around)
    end, apart, held = _close(finger, start, np.array([1.0, 0.0, 0.0, 0.0]), around)
    return start, end, bool((held & (apart < REACHES_M)).any())


def _opens(finger: Finger) -> list[Float[np.ndarray, "hinges"]]:
    """Angles of an open finger, the straight one first: bent back, bent, or a thumb opposed."""
    if finger.name.endswith(THUMB):
        flat = [np.array([0.0, first, 0.0, 0.0]) for first in FLAT]
        return flat + [np.array([side, 0.0, 0.0, 0.0]) for side in OPPOSITIONS[-2::-1]]
    return [np.array([first, 0.0, 0.0]) for first in (0.0, *OPEN)]


def _clear(
    finger: Finger, tried: Sequence[Float[np.ndarray, "hinges"]], around: list[Near]
) -> Float[np.ndarray, "hinges"]:
    """The first of some angles in which no bone touches; else those in which none is so deep."""
    found = []
    for angles in tried:
        found.append(float(gaps(around, finger, angles)[0].min()))
        if found[-1] > TOUCHES_M:
            return angles
    return tried[int(np.argmax(found))]


def _close(
    finger: Finger,
    start: Float[np.ndarray, "hinges"],
    rates: Float[np.ndarray, "hinges"],
    around: list[Near],
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
        apart, _ = gaps(around, finger, angles)
        touching = int(np.flatnonzero(apart < TOUCHES_M).max(initial=-1))
        if touching > last:
            last, touched = touching, angles
        rates[bones <= last] = 0.0
        rates[angles >= finger.ranges[:, 1] - 1e-9] = 0.0
        speeds = levers @ rates
        if not speeds.any():
            break
        moving = speeds > 0.0
        step = float(((apart[moving] - NEAR_M) / speeds[moving]).min())
        room = (finger.ranges[:, 1] - angles)[rates > 0.0] / rates[rates > 0.0]
        angles = angles + rates * min(step, float(room.min()))
    angles = touched if last >= 0 else angles
    return angles, *gaps(around, finger, angles)


def hand_grasps(
    measures: Measures,
    side: str,
    hand: RigidTransform,
    things: Mapping[str, tuple[Shape, RigidTransform]],
    spans: Iterable[tuple[int, int, Collection[str]]],
    rate_hz: float,
) -> Iterator[Grasp]:
    """How a hand's fingers close in each interval in which it holds some objects.

    Before and after it they are closed no further than objects let them where the hand is then.

    Args:
        measures: Of the body.
        side: Of the hand.
        hand: ``T_world_hand`` of its segment at every frame.
        things: Shape and ``T_world_thing`` at every frame of every object.
        spans: First and last frame, and what is held meanwhile.
        rate_hz: Frames a second.
    """
    fingers, at_s = fingers_of(measures, side), np.arange(len(hand)) / rate_hz
    edges = np.cumsum([len(finger.axes) for finger in fingers])[:-1]
    for first, last, names in spans:
        away = np.maximum(first / rate_hz - at_s, at_s - last / rate_hz)
        close = [minimum_jerk(1.0 - max(s, 0.0) / CLOSE_S) for s in away]
        oppose = [minimum_jerk(1.0 - max(s - CLOSE_S, 0.0) / OPPOSE_S) for s in away]
        wanted = np.add(close, oppose)
        begins, until = np.flatnonzero(wanted)[[0, -1]] + [0, 1]
        part = slice(begins, until)
        seats = {n: hand[part].inv() * path[part] for n, (_, path) in things.items()}
        near = {
            n: Near.of(things[n][0], seat, measures["hand_length"], held=n in names)
            for n, seat in seats.items()
        }
        own = slice(first - begins, last + 1 - begins)
        some = np.unique(np.linspace(first, last, INSTANTS).round().astype(int)) - begins
        around = [
            near[n].at(
                RigidTransform.concatenate([_usual(seat[own])]) if n in names else seat[some]
            )
            for n, seat in seats.items()
        ]
        grasp = closed_grasp(measures, side, (first, last), sorted(names), around)
        opened, closed = (np.split(angles, edges) for angles in (grasp.opened, grasp.closed))
        shares = np.tile(wanted[:, None], len(fingers))
        for frames in (range(first - 1, begins - 1, -1), range(last + 1, until)):
            for frame in frames:
                now = [each.at(seats[n][[frame - begins]]) for n, each in near.items()]
                most = np.minimum(wanted[frame], shares[frame - frames.step])
                rows = zip(fingers, opened, closed, most, strict=True)
                shares[frame] = [_share(*row, now) for row in rows]
        yield replace(grasp, shares=shares)


def _share(
    finger: Finger,
    opened: Float[np.ndarray, "hinges"],
    closed: Float[np.ndarray, "hinges"],
    most: float,
    near: list[Near],
) -> float:
    """How far a finger may be closed where the hand is, no further than some share."""

    def touches(share: float) -> bool:
        angles = _closed_by(share, opened, closed)
        return float(gaps(near, finger, angles)[0].min()) < 0.0

    low, high = (0.0, most) if touches(most) else (most, most)
    for _ in range(HALVINGS if low < high else 0):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if touches(middle) else (middle, high)
    return low


def _closed_by(
    share: Float[np.ndarray, "*frames"] | float,
    opened: Float[np.ndarray, "hinges"],
    closed: Float[np.ndarray, "hinges"],
) -> Float[np.ndarray, "*frames hinges"]:
    """Angles of fingers that are closed so far, as ``Grasp.shares`` has it [rad]."""
    return np.minimum(share, 1.0) * opened + np.maximum(share - 1.0, 0.0) * (closed - opened)


def _usual(poses: RigidTransform) -> RigidTransform:
    """The median place and the mean turn of poses near each other."""
    middle: Float[np.ndarray, "3"] = np.median(poses.translation, axis=0)
    return RigidTransform.from_components(middle, poses.rotation.mean())


def flexions(frames: int, grasps: Iterable[Grasp]) -> Float[np.ndarray, "frames hinges"]:
    """The angles of all fingers of a hand at every frame [rad]: open between its grasps."""
    out, most = np.zeros((frames, len(hinge_names("right")))), np.zeros(frames)
    counts = [sum(name.startswith(f"right_{f}_") for name in hinge_names("right")) for f in FINGERS]
    for grasp in grasps:
        shares = np.repeat(grasp.shares, counts, axis=1)
        nearer = shares.max(axis=1) > most
        out[nearer] = _closed_by(shares, grasp.opened, grasp.closed)[nearer]
        most = np.maximum(most, shares.max(axis=1))
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
    rate_hz = capture.rate_hz
    grasps = hand_grasps(measures, sensor.side, hand, things, spans, rate_hz)
    return flexions(len(hand), grasps)


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
