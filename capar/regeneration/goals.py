"""Goals: where objects have to be at events, and the hinges, rails and planes that they keep to."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.model.facts import Displaced
from capar.model.geometry import rotations, transforms
from capar.model.locations import restored
from capar.regeneration.body_frames import BodyFrames, head_path, head_ratio
from capar.regeneration.collisions import Surroundings
from capar.regeneration.forces import ForceKind, caught_pose
from capar.regeneration.holds import CoHeld, Hold, Throw, usual_pose
from capar.regeneration.scenes import PlanError, Scene, moved
from capar.regeneration.solving import Solver
from capar.regeneration.sources import (
    MOVES_M,
    STILL_M,
    STILL_RAD,
    Leaning,
    Meeting,
    Source,
    contact_points,
    moves,
)

HINGE, RAIL, PLANE = "hinge", "rail", "plane"

FLAT_M = 0.003
"""What never leaves its height by more than this while it is held slides on its support [m]."""

FLAT_RAD = float(np.radians(3.0))  # Nor leans by more than this [rad].
NOISE_M = 0.0002  # A recorded path that is no farther off the plane is kept as it is [m].


@dataclass(frozen=True, eq=False)
class Constraint:
    """The line or plane that an object keeps to, in the frame of the object at its start."""

    kind: str
    """``hinge``, ``rail`` or ``plane``."""

    thing: str
    other: str
    """What bears the hinge or the rail, or what it slides on."""

    point: Float[np.ndarray, "3"]
    """Of the line or plane [m]."""

    axis: Float[np.ndarray, "3"]
    """Unit direction of the line, or normal of the plane."""

    def strays(
        self,
        start: RigidTransform,
        at: Float[np.ndarray, "3"],
        spots: Float[np.ndarray, "frames 3"],
    ) -> Float[np.ndarray, "frames"]:
        """How far a point of the object, or on it, is from the path that the constraint leaves [m].

        Args:
            start: Where the object is at its start.
            at: The point in the object's frame [m].
            spots: Where it was seen in the world [m].
        """
        point, axis = start.apply(self.point), start.rotation.apply(self.axis)
        usual, seen = start.apply(at) - point, spots - point
        heights, height = seen @ axis, float(usual @ axis)
        if self.kind == PLANE:
            return np.abs(heights - height)
        across = seen - np.outer(heights, axis)
        before = usual - height * axis
        if self.kind == RAIL:
            return np.linalg.norm(across - before, axis=1)
        radius = np.linalg.norm(across, axis=1) - np.linalg.norm(before)
        return np.asarray(np.hypot(radius, heights - height))


def constraints_of(source: Source) -> dict[str, Constraint]:
    """The hinge or rail of each object that was observed on one, by the object's name."""
    out = {}
    for guide in source.observation.guides:
        if guide.object in source.paths:
            shape = source.capture.tag_object(guide.object).shape
            assert shape is not None  # checked when the source was made
            place, turn = restored(guide.object_nlt, shape.size)
            stream = source.capture.tag_object(guide.object).stream
            known = ~np.isnan(stream.positions).any(axis=1)
            captured = rotations(stream.orientations[known])
            # What takes directions of the captured object's frame to the frame of the object.
            path = source.paths[guide.object].rotation[np.flatnonzero(known)]
            upright = (path.inv() * captured).mean()
            axis = upright.apply(rotations(turn).apply([1.0, 0.0, 0.0]))
            point = upright.apply(place)
            out[guide.object] = Constraint(guide.kind, guide.object, guide.base, point, axis)
    return out


def planes_of(source: Source) -> dict[str, Constraint]:
    """The plane of each object that stays level on what bears it while it is held and moves."""
    out, guided = {}, constraints_of(source)
    for name, path in source.paths.items():
        spans = [(hold.first, hold.last) for hold in source.holds if hold.thing == name]
        support = source.scene.support(name)
        launched = any(launch.thing == name for launch in source.releases)
        if not spans or not support or name in guided or launched:
            continue
        part = path[min(first for first, _ in spans) : max(last for _, last in spans) + 1]
        off = np.abs(part.translation[:, 2] - source.scene.thing(name).place[2])
        gone = np.linalg.norm(part.translation - part.translation[0], axis=1)
        up = part.rotation.apply([0.0, 0.0, 1.0])[:, 2]
        level = bool(np.arccos(np.clip(up, -1.0, 1.0)).max() <= FLAT_RAD)
        if off.max() <= FLAT_M and level and gone.max() >= MOVES_M:
            out[name] = Constraint(PLANE, name, support, np.zeros(3), np.array([0.0, 0.0, 1.0]))
    return out


def scene_constraints(source: Source, scene: Scene) -> dict[str, Constraint]:
    """Every constraint at the same place of the objects of a scene, in their own measures."""
    return {
        name: replace(line, point=line.point * _ratio(source, scene, name))
        for name, line in {**planes_of(source), **constraints_of(source)}.items()
    }


def guided_poses(
    source: Source, scene: Scene, name: str, recorded: RigidTransform, spans: list[tuple[int, int]]
) -> RigidTransform:
    """``T_world_thing`` at every frame of an object on a hinge or a rail, on its own line.

    It turns by the recorded angles, or goes as far in its own measures; while nobody holds it, it
    stays.
    """
    line, ratio = scene_constraints(source, scene)[name], _ratio(source, scene, name)
    along, far = np.zeros(len(recorded)), 0.0
    for first, last in spans:
        moved = recorded[first].inv() * recorded[first : last + 1]
        if line.kind == RAIL:
            gone = moved.translation @ line.axis
        else:
            gone = np.unwrap(moved.rotation.as_rotvec() @ line.axis)
        along[first : last + 1] = far + gone
        far += float(gone[-1])
        along[last + 1 :] = far
    start = scene.thing(name).pose
    if line.kind == RAIL:
        longer = float(np.linalg.norm(line.axis * ratio))
        return start * RigidTransform.from_translation(np.outer(longer * along, line.axis))
    there = RigidTransform.from_translation(line.point)
    turned = RigidTransform.from_rotation(Rotation.from_rotvec(np.outer(along, line.axis)))
    return start * there * turned * there.inv()


def flattened(path: RigidTransform) -> RigidTransform:
    """A path in the level plane of its first frame, turning only about the vertical."""
    spots = np.array(path.translation)
    if np.abs(spots[:, 2] - spots[0, 2]).max() <= NOISE_M:
        return path
    spots[:, 2] = spots[0, 2]
    about = (path.rotation * path.rotation[0].inv()).as_quat(scalar_first=True)
    yaw = 2.0 * np.arctan2(about[:, 3], about[:, 0])
    turns = Rotation.from_rotvec(np.outer(yaw, [0.0, 0.0, 1.0])) * path.rotation[0]
    return RigidTransform.from_components(spots, turns)


def _ratio(source: Source, scene: Scene, name: str) -> Float[np.ndarray, "3"]:
    old, new = source.scene.thing(name).size, scene.thing(name).size
    return np.asarray(new / np.maximum(old, 1e-9))


TOUCH_M = 0.0005  # What is left between surfaces that touch [m].
STEP_M = 0.005  # Steps in which the nearest place is sought where it touches [m].
SEARCH_M = 0.03  # How far an object is moved at most so that it touches [m].


@dataclass(frozen=True, eq=False)
class Goal:
    """Where an object has to be at an event, and what decides that."""

    thing: str
    frame: int
    pose: RigidTransform
    reason: str
    on: RigidTransform | None = None
    """Where it has to be from then on, at each frame, if that is known."""


def object_goals(
    source: Source,
    scene: Scene,
    old: BodyFrames,
    new: BodyFrames,
    force: ForceKind = ForceKind.SIMILAR,
) -> dict[str, list[Goal]]:
    """The goals of every object that is held, in order of time.

    Raises:
        PlanError: An object would be put down where nothing supports it.
    """
    out: dict[str, list[Goal]] = {}
    constraints = scene_constraints(source, scene)
    beside = {companion.hold.thing for companion in source.co_held}
    statures = [body.human.measures["stature"] for body in (new, old)]
    ratio = float(statures[0] / statures[1]) if force is ForceKind.SIMILAR else 1.0
    turn = Rotation.from_euler("z", scene.heading - source.scene.heading)
    for name, path in source.paths.items():
        kind = constraints[name].kind if name in constraints else ""
        if kind in {HINGE, RAIL}:
            out[name] = list(_guided_goals(source, scene, name, kind))
        if kind in {HINGE, RAIL} or name in beside:
            continue
        start = 0, scene.thing(name).pose
        for first, last in handled(source, name):
            goals = out.setdefault(name, [])
            pose = goals[-1].pose if goals else scene.thing(name).pose
            came, thrown = throw_of(source, name, last=first), throw_of(source, name, first=last)
            if came:
                as_far = caught_pose(source, scene, came, pose, 1.0)
                pose = caught_pose(source, scene, came, pose, ratio)
                nearer = RigidTransform.from_translation(pose.translation - as_far.translation)
            start = (start[0], nearer * start[1]) if came else (first, pose)
            goals.append(Goal(name, first, pose, "caught there" if came else "stays where it is"))
            goals += _head_goals(source, scene, old, new, Hold("", name, first, last))
            if thrown:  # as far in metres from where the hand took it as it was
                there = _displaced(path, (first, last), pose, turn)
                down = Goal(name, last, there, "thrown there")
            else:
                down = _put_down(source, scene, name, (start[0], last), start[1])
            if kind == PLANE:
                flat = flattened(RigidTransform.concatenate([pose, down.pose]))[1]
                down = replace(down, pose=flat)
            goals += _leaning_goals(source, scene, name, (first, last), (pose, down.pose))
            goals.sort(key=lambda goal: goal.frame)
            if thrown:
                goals.append(down)
                continue
            goals.append(replace(down, frame=_stopped(source, name, goals[-1].frame, last)))
            if goals[-1].frame < last:
                goals.append(replace(down, reason="stays there"))
    for companion in source.co_held:
        out[companion.hold.thing] = _beside_goals(scene, companion, out)
    return out


def _beside_goals(scene: Scene, companion: CoHeld, known: Mapping[str, list[Goal]]) -> list[Goal]:
    """The goals of what lies in a hand beside another object, as that one has them."""
    load, name = companion.load, companion.hold.thing
    own = scene.thing(name).pose
    seat = scene.thing(load.bearer).pose.inv() * own
    led = [goal for goal in known[load.bearer] if load.first <= goal.frame <= load.last]
    there = led[-1].pose * seat
    if support_at(scene, name, own) and not support_at(scene, name, there):
        x, y, z = there.translation
        raise PlanError(
            f"{name!r} would be put down at ({x:.2f}, {y:.2f}, {z:.2f}) m beside {load.bearer!r}, "
            "where nothing supports it; a larger support, or both nearer its middle, would do"
        )
    reason = f"beside {load.bearer!r} in the hand"
    first = Goal(name, companion.hold.first, led[0].pose * seat, "stays where it is")
    return [first, *(Goal(name, goal.frame, goal.pose * seat, reason) for goal in led[1:])]


def put_down_poses(source: Source, scene: Scene) -> dict[str, RigidTransform]:
    """Where everything that is moved is put in the end; that does not depend on the body.

    What is thrown from hand to hand is put down where a body as tall as the recorded one would.

    Raises:
        PlanError: Something would be put down where nothing supports it.
    """
    out: dict[str, RigidTransform] = {}
    for name in source.paths:
        start = 0
        for first, last in handled(source, name):
            if not throw_of(source, name, last=first):
                start = first
            if not throw_of(source, name, first=last):
                pose = out.get(name, scene.thing(name).pose)
                out[name] = _put_down(source, scene, name, (start, last), pose).pose
    return out


def throw_of(source: Source, name: str, *, first: int = -1, last: int = -1) -> Throw | None:
    """The flight of an object that begins, or ends, in a frame; None where none does."""
    own = (one for one in source.throws if one.thing == name)
    return next((one for one in own if first == one.first or last == one.last), None)


def _guided_goals(source: Source, scene: Scene, name: str, kind: str) -> Iterator[Goal]:
    """Where an object on a hinge or a rail is when a hand takes it, stops it, and lets it go."""
    spans = handled(source, name)
    poses = guided_poses(source, scene, name, source.paths[name], spans)
    for first, last in spans:
        yield Goal(name, first, poses[first], "stays where it is")
        stopped = _stopped(source, name, first, last)
        how = "by as much on its hinge" if kind == HINGE else "as far on its rail, in its measures,"
        yield Goal(name, stopped, poses[stopped], f"moved {how} as it was")
        if stopped < last:
            yield Goal(name, last, poses[last], "stays there")


def _stopped(source: Source, name: str, after: int, last: int) -> int:
    """The frame at which an object was seen to stop, after one and not later than another one."""
    own = (fact for fact in source.observation.facts if isinstance(fact, Displaced))
    return max((f.last for f in own if f.object == name and after < f.last <= last), default=last)


def rests(part: RigidTransform, start: RigidTransform, goal: RigidTransform) -> bool:
    """Whether an object is to stay where it rested."""
    apart = np.linalg.norm(part.translation - part.translation[0], axis=1)
    turned = (part.rotation * part.rotation[0].inv()).magnitude()
    near = np.linalg.norm(goal.translation - start.translation) < 1e-9
    return bool(apart.max() < STILL_M and turned.max() < STILL_RAD and near)


def handled(source: Source, name: str) -> list[tuple[int, int]]:
    """From when to when an object is held without a break, if it moves at all."""
    if not moves(source.paths[name]):
        return []
    out: list[tuple[int, int]] = []
    for hold in source.holds:
        if hold.thing == name:
            if out and hold.first <= out[-1][1]:
                out[-1] = (out[-1][0], max(out[-1][1], hold.last))
            else:
                out.append((hold.first, hold.last))
    return out


def _put_down(
    source: Source, scene: Scene, name: str, span: tuple[int, int], pose: RigidTransform
) -> Goal:
    """As far in metres from where it came from as it was; on another object in that one's size."""
    before, after = (source.paths[name][each] for each in span)
    turn = Rotation.from_euler("z", scene.heading - source.scene.heading)
    goal, reason = (
        _displaced(source.paths[name], span, pose, turn),
        "as far from where it came from as it was [m]",
    )
    came, support = (support_at(source.scene, name, each) for each in (before, after))
    onto, spot = scene.goals.get(name, support if support != came else ""), goal.translation
    if support and onto:
        old, new = source.scene.thing(support), scene.thing(onto)
        local = old.pose.inv().apply(after.translation)
        low_old, low_new = (s.thing(name).shape.bounds[0, 2] for s in (source.scene, scene))
        share = (local - old.shape.bounds[0]) / np.maximum(old.size, 1e-9)
        spot = new.pose.apply(new.shape.bounds[0] + share * new.size)
        above = local[2] + low_old - old.shape.bounds[1, 2]
        spot[2] = new.place[2] + new.shape.bounds[1, 2] + above - low_new
        reason = f"at the same place on {onto!r}, in its own measures"
    if name in scene.spots:
        spot, reason = np.asarray(scene.spots[name]), "where it is stated to be put"
    goal = RigidTransform.from_components(spot, goal.rotation)
    if support and not support_at(scene, name, goal):
        x, y, z = spot
        raise PlanError(
            f"{name!r} would be put down at ({x:.2f}, {y:.2f}, {z:.2f}) m, where {support!r} does "
            f"not reach; a larger {support!r}, or {name!r} nearer its middle, would do"
        )
    return Goal(name, span[1], goal, reason)


def _leaning_goals(
    source: Source,
    scene: Scene,
    name: str,
    span: tuple[int, int],
    ends: tuple[RigidTransform, RigidTransform],
) -> list[Goal]:
    """Where it leans over another object, and how it comes there and away.

    While it leans, its edge next to the other object is as high above that one as it was, and
    sideways in that one's measures. Meanwhile it moves as far in metres as it did.
    """
    turn = Rotation.from_euler("z", scene.heading - source.scene.heading)
    recorded, out = source.paths[name], list[Goal]()
    for leaning in source.leanings:
        if leaning.thing == name and span[0] <= leaning.frames[0] <= span[1]:
            spun = _turned(recorded, span[0], leaning.lowest, turn) * ends[0].rotation
            spot = _leant(source, scene, leaning, spun, turn)
            lowest = RigidTransform.from_components(spot, spun)
            over: list[RigidTransform] = []
            for number, frame in enumerate(leaning.frames):
                pose = _displaced(recorded, (leaning.lowest, frame), lowest, turn)
                part = recorded[leaning.frames[max(number - 1, 0)] : frame + 1]
                over.append(over[-1] if over and rests(part, pose, pose) else pose)
                reason = f"over {leaning.other!r}, in its own measures"
                out.append(Goal(name, frame, over[-1], reason))
            out += _beside(source, name, span, leaning, ends, over, turn)
    return out


def _leant(
    source: Source, scene: Scene, leaning: Leaning, spun: Rotation, turn: Rotation
) -> Float[np.ndarray, "3"]:
    """Where an object is when it leans over another one, turned like this."""
    before, after = (each.thing(leaning.thing) for each in (source.scene, scene))
    others = [each.thing(leaning.other) for each in (source.scene, scene)]
    tops = []
    for other in others:
        low, high = other.shape.bounds
        tops.append(other.pose.apply([*(0.5 * (low + high))[:2], high[2]]))
    corners = np.array(before.shape.vertices)
    leant = source.paths[leaning.thing][leaning.lowest].apply(corners) - tops[0]
    nearest = int(np.argmin(np.linalg.norm(leant, axis=1)))
    by = turn.apply(leant[nearest])
    by[:2] *= float(np.mean(others[1].size[:2] / np.maximum(others[0].size[:2], 1e-9)))
    edge = corners[nearest] * after.size / np.maximum(before.size, 1e-9)
    return np.asarray(tops[1] + by - spun.apply(edge))


def _beside(
    source: Source,
    name: str,
    span: tuple[int, int],
    leaning: Leaning,
    ends: tuple[RigidTransform, RigidTransform],
    over: list[RigidTransform],
    turn: Rotation,
) -> list[Goal]:
    """Goals at the nearest borders of steps before and after, if it is on its way there.

    Sideways as far from where it came from or is put down as it was, and as high as it was beside
    where it leans over.
    """
    sensors = {source.hands[hold.side].sensor for hold in source.holds if hold.thing == name}
    borders = sorted({e.last for e in source.observation.segments if e.ee in sensors})
    recorded, frames = source.paths[name], leaning.frames
    path = recorded.translation
    away = [np.linalg.norm(path - path[frame], axis=1) > MOVES_M for frame in span]
    before = [b for b in borders if span[0] < b < frames[0] and away[0][b]][-1:]
    after = [b for b in borders if frames[-1] < b < span[1] and away[1][b]][:1]
    reason = "as far from where it came from or is put down as it was [m]"
    out = []
    for border, side in [(frame, 0) for frame in before] + [(frame, -1) for frame in after]:
        pose = _displaced(recorded, (span[side], border), ends[side], turn)
        spot = np.array(pose.translation)
        spot[2] = over[side].translation[2] + path[border, 2] - path[frames[side], 2]
        goal = RigidTransform.from_components(spot, pose.rotation)
        out.append(Goal(name, border, goal, reason))
    return out


def _displaced(
    path: RigidTransform, frames: tuple[int, int], pose: RigidTransform, turn: Rotation
) -> RigidTransform:
    """Where an object is at the second frame, when it has a pose at the first."""
    first, frame = frames
    gone = turn.apply(path[frame].translation - path[first].translation)
    spun = _turned(path, first, frame, turn) * pose.rotation
    return RigidTransform.from_components(pose.translation + gone, spun)


def _turned(path: RigidTransform, first: int, frame: int, turn: Rotation) -> Rotation:
    """How a recorded object has turned, in a scene that is turned itself."""
    return turn * path[frame].rotation * path[first].rotation.inv() * turn.inv()


def support_at(scene: Scene, name: str, pose: RigidTransform) -> str:
    """What an object would stand on at some pose; empty where nothing is beneath it."""
    x, y, z = (float(each) for each in pose.translation)
    return moved(scene, name, (x, y, z), scene.thing(name).heading).support(name)


def _head_goals(
    source: Source, scene: Scene, old: BodyFrames, new: BodyFrames, held: Hold
) -> Iterator[Goal]:
    """Goals of a held object where it meets the head."""
    for meeting in source.meetings:
        if meeting.thing == held.thing and held.first <= meeting.first <= held.last:
            at = _at_head(source, scene, old, new, meeting)[: held.last + 1 - meeting.first]
            reason = f"at the {meeting.part}, in its own measures"
            for frame in sorted({min(each, held.last) for each in meeting.instants}):
                row = frame - meeting.first
                yield Goal(held.thing, frame, at[row], reason, at[row:])


def _at_head(
    source: Source, scene: Scene, old: BodyFrames, new: BodyFrames, meeting: Meeting
) -> RigidTransform:
    """Where an object meets the new head, at each frame of the meeting.

    The same points touch, in the measures of both. What is rigidly together with the head stays
    where it is in the middle of the meeting.
    """
    span = slice(meeting.first, meeting.last + 1)
    part = source.capture.tag_object(meeting.part)
    if part.shape is None:
        raise PlanError(f"{meeting.part!r} has no shape; give it a mesh")
    before, after = source.scene.thing(meeting.thing), scene.thing(meeting.thing)
    relative = source.eyes[span].inv() * source.paths[meeting.thing][span]
    heads = head_path(source, old, new)[span]
    if meeting.steady:
        relative = RigidTransform.concatenate([usual_pose(relative)])
        heads = heads[[len(heads) // 2]]
    known = np.flatnonzero(~part.stream.lost)
    tracked = transforms(part.stream.positions[known], part.stream.orientations[known])
    seat = usual_pose(source.eyes[known].inv() * tracked)
    around = Surroundings(new.human, scene)
    solver = Solver(new.human, (*scene.place, scene.floor_m), scene.heading)
    standing = solver.site("between_eyes")
    scale = after.size / np.maximum(before.size, 1e-9)
    out = []
    for head, pose in zip(heads, relative, strict=True):
        on_head, on_thing = contact_points(part.shape, before.shape, seat.inv() * pose)
        spot = seat.apply(on_head)
        gap = pose.apply(on_thing) - spot
        place = spot * head_ratio(old, new) + gap - pose.rotation.apply(on_thing * scale)
        local = RigidTransform.from_components(place, pose.rotation)

        def apart(by_m: float, local: RigidTransform = local) -> float:
            moved = standing * RigidTransform.from_translation([by_m, 0.0, 0.0]) * local
            around.pose(solver.posture, {meeting.thing: moved})
            found = (p.distance_m for p in around.near(["head"]) if p.thing == meeting.thing)
            return min(found, default=1.0)

        ahead = RigidTransform.from_translation([touching_shift(apart), 0.0, 0.0])
        out.append(head * ahead * local)
    frames = meeting.last - meeting.first + 1
    return RigidTransform.concatenate(out * frames if meeting.steady else out)


def touching_shift(apart: Callable[[float], float], most_m: float = SEARCH_M) -> float:
    """The least shift so that a distance becomes ``TOUCH_M`` [m].

    Args:
        apart: The distance after a move; moving on, away from the surface next to it.
        most_m: How far it is moved at most [m].
    """
    inside = apart(0.0) <= TOUCH_M
    step = STEP_M if inside else -STEP_M
    near = far = 0.0
    while abs(far) < most_m and (apart(far) <= TOUCH_M) == inside:
        near, far = far, far + step
    low, high = sorted((near, far))
    for _ in range(16):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if apart(middle) > TOUCH_M else (middle, high)
    return 0.5 * (low + high)
