"""Preparation: what an action needs and its scene lacks, planned over recorded steps."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human
from capar.body.virtual_scenes import Thing
from capar.export.plans import PlanExportError, PlanSource, PlanStep, plan_source
from capar.model.capture import Capture, TagType
from capar.model.errors import RuleError
from capar.model.facts import Touching as Touch
from capar.model.observation import Observation
from capar.pipelines.action_binding import Instance
from capar.pipelines.observation import observe
from capar.pipelines.recordings import Performed, Recording
from capar.pipelines.round_trips import by_hand, observed_source
from capar.pipelines.trials import trial_of
from capar.regeneration import quality as gates
from capar.regeneration import roles
from capar.regeneration.captures import OTHER, Completion, completed, scene_after
from capar.regeneration.collisions import Surroundings
from capar.regeneration.goals import put_down_poses
from capar.regeneration.quality import Asserted, Quality
from capar.regeneration.roles import Kinds, kind_of
from capar.regeneration.scenes import PlanError, Scene, mobile, moved
from capar.regeneration.search import is_possible, regenerate
from capar.regeneration.solving import Solver
from capar.regeneration.sources import Source, captured_scene, source_of
from capar_rules.engine.solver import Answer, Term, best, rule_file, text_of

MARGIN_S = 0.3  # So long a contact is kept before a step that ends it, or after one that makes it.
ROOM_M = 0.01  # Objects that are nearer are in each other's path.
ASIDE_M = 0.06  # So far from others an object is put: a hand has room between them.
EDGE_M = 0.02  # How far an object that is put down stays from its support's edge.
STEP_M = 0.06  # Of the grid on which places are sought.
ARM = 0.42  # How far from where it stands a body puts objects, as a share of its stature.
MOST = 8  # Places that are offered on each support.
MOST_STEPS = 16  # A plan has no more steps than this.
MOST_TRIES = 10  # So many stages are found impossible before the action is refused.
PROGRAM = "planning/preparing.lp"


@dataclass(frozen=True, eq=False)
class Procedure:
    """A recording of one hand that handles one object, and else at most what that stands on."""

    recording: Recording
    source: Source
    side: str
    part: str
    """The object that the hand handles."""

    steps: tuple[PlanStep, ...]

    def relations(self, number: int) -> dict[str, tuple[str, str]]:
        """The bits of a step before and after it: of ``touch``, and of ``stand`` if it has any."""
        features = self.steps[number].ipar.core.constraint.features
        rows, count = (features.rel_start, features.rel_end), features.count
        found = {"touch": (rows[0][0], rows[1][0])}
        return found | ({"stand": (rows[0][count], rows[1][count])} if count > 1 else {})

    def stands(self, start: str, end: str) -> bool:
        """Whether a step that moves the object has such bits of ``stand``."""
        return any(
            step.moves and self.relations(number).get("stand") == (start, end)
            for number, step in enumerate(self.steps)
        )

    def part_of(self, first: int, last: int, side: str) -> Source:
        """Some steps of it, one after the other, with a hand.

        Raises:
            PlanError: What is cut out does not determine a performance.
        """
        source, margin = self.source, round(MARGIN_S * self.source.rate_hz)
        final = len(source.times) - 1
        starts = [*(round(step.step.begin * final) for step in self.steps), final]
        lead = margin if first and self.relations(first)["touch"] == ("1", "0") else 0
        tail = margin if self.relations(last)["touch"] == ("0", "1") else 0
        begin = max(starts[first] - lead, 0) if first else 0
        end = min(starts[last + 1] + tail, final)
        if (begin, end) != (0, final):
            # By a performer who stands where the whole was performed.
            times, scene = source.capture.times, source.scene
            part = Completion(from_s=float(times[begin]), to_s=float(times[end]))
            capture = completed(source.capture, part)
            seen = observe(capture, rules=source.observation.profile)
            stance = (scene.place, scene.heading)
            made = source_of(capture, seen, stance=stance, floor_m=scene.floor_m)
            source = replace(made, notes=source.notes)
        return by_hand(source, side) if any(h.side != side for h in source.holds) else source


def procedures_of(
    recordings: Iterable[Recording], open_source: Callable[[Recording], Source] | None = None
) -> tuple[Procedure, ...]:
    """The recordings among some in which one hand handles one object and nothing else is done."""
    found = []
    for recording in recordings:
        acting = {s.ee for s in recording.steps if s.ee.endswith("_hand") and s.objects}
        if len(acting) != 1 or len({step.objects[0] for step in recording.steps}) != 1:
            continue
        try:
            opened = open_source(recording) if open_source else observed_source(recording.capture)
            plan = steps_of(opened.observation)
        except (PlanError, PlanExportError):
            continue
        apart = opened.leanings or opened.meetings or opened.releases or opened.throws
        if apart or not opened.holds:
            continue
        hold = opened.holds[0]
        steps = tuple(s for s in plan.links[opened.hands[hold.side].sensor] if s.ipar.objects)
        if {name for step in steps for name in step.ipar.objects} <= set(opened.scene.things):
            found.append(Procedure(recording, opened, hold.side, hold.thing, steps))
    return tuple(found)


def steps_of(observation: Observation) -> PlanSource:
    """The steps of an observed action with their PARs.

    Raises:
        PlanExportError: It has no steps.
    """
    par = observation.complex_par
    return plan_source(par, observation.ipars, observation.upars, {}, name=par.name)


def asserted(source: Source) -> list[Asserted]:
    """What the steps of a performance assert at their ends, in order of time."""
    names = {name: name for name in source.paths} | {gates.HEAD: gates.HEAD}
    names |= {hand.sensor: side for side, hand in source.hands.items()}
    last = len(source.times) - 1
    found = []
    for steps in steps_of(source.observation).links.values():
        for one in steps:
            frame = round((one.step.begin + one.step.share) * last)
            contacts = gates.contacts_of(one.ipar.post_assertions, names)
            found.append(Asserted(one.step.action, frame, contacts, one.ipar.core.moved))
    return sorted(found, key=lambda step: step.frame)


Spot = tuple[float, float, float]


class Room:
    """Distances between objects of a scene, wherever they are put."""

    def __init__(self, human: Human, scene: Scene) -> None:
        self.human, self.scene = human, scene
        self.around = Surroundings(human, scene)
        self.rest = Solver(human, (*scene.place, scene.floor_m), scene.heading).rest

    def near(self, poses: Mapping[str, RigidTransform], within_m: float) -> set[frozenset[str]]:
        """The objects nearer to each other than so much [m], some being elsewhere."""
        usual = {name: thing.pose for name, thing in self.scene.things.items()}
        self.around.pose(self.rest, {**usual, **poses})
        pairs = self.around.things_near()
        return {frozenset((p.part, p.thing)) for p in pairs if p.distance_m < within_m}

    def places(
        self, name: str, support: str, keep_off: Mapping[str, RigidTransform]
    ) -> tuple[Spot, ...]:
        """Free places for an object on another one within an arm's length, nearest first.

        Other objects will be where ``keep_off`` has them, and need room besides.
        """
        thing, tops = self.scene.thing(name), self.scene.thing(support)
        spots = np.array(thing.shape.vertices)
        low, high = _corners(tops)
        height = float(high[2] - _corners(thing)[0, 2] + thing.place[2])
        reach_m = ARM * self.human.measures["stature"]
        others = {other: keep_off[other] for other in keep_off if other != name}
        grid = [
            (float(x), float(y))
            for x in np.arange(low[0] + 0.5 * STEP_M, high[0], STEP_M)
            for y in np.arange(low[1] + 0.5 * STEP_M, high[1], STEP_M)
            if np.hypot(*np.subtract((x, y), self.scene.place)) <= reach_m
        ]
        grid.sort(key=lambda spot: float(np.hypot(*np.subtract(spot, thing.place[:2]))))
        found: list[Spot] = []
        for x, y in grid:
            pose = RigidTransform.from_components([x, y, height], thing.pose.rotation)
            level = pose.apply(spots)[:, :2]
            within = (level > low[:2] + EDGE_M).all() and (level < high[:2] - EDGE_M).all()
            if within and not any(
                name in pair and support not in pair
                for poses in ({name: pose}, {name: pose, **others})
                for pair in self.near(poses, ASIDE_M)
            ):
                found.append((x, y, height))
            if len(found) == MOST:
                break
        return tuple(found)


def _corners(thing: Thing) -> Float[np.ndarray, "2 3"]:
    spots = thing.pose.apply(np.array(thing.shape.vertices))
    return np.stack([spots.min(axis=0), spots.max(axis=0)])


Condition = tuple[str, ...]
"""``touch`` with a hand and an object, ``free`` with a hand, ``stand`` with an object and its
support, ``clear`` with the object whose goal it is, or ``bare`` with an object."""

Touching = frozenset[tuple[str, str]]
"""Hands, by their sides, with the objects that they touch."""

MEANING = {
    "touch": "contact({} hand, {})",
    "free": "no contact of the {} hand",
    "stand": "contact({}, {})",
    "clear": "nothing else where {!r} is put",
    "bare": "nothing on {!r}",
}


@dataclass(frozen=True)
class World:
    """A scene with who touches what in it, as measured."""

    scene: Scene
    touching: Touching = frozenset()


@dataclass(frozen=True, eq=False)
class Problem:
    """A world, and what is wanted of it."""

    world: World
    wanted: tuple[Condition, ...]
    goals: Mapping[str, RigidTransform]
    """Where the action puts objects in the end, by the scene's names."""

    parts: frozenset[str]
    """The objects of the scene that take part in the action."""

    room: Room
    kinds: Kinds


def told(condition: Condition) -> str:
    """A condition in words."""
    return MEANING[condition[0]].format(*condition[1:])


def problem_of(instance: Instance, world: World, kinds: Kinds) -> Problem:
    """What a bound action needs of a world.

    Hands touch what they touch when the recording begins, and nothing else; objects stand as its
    preparatory specifications say; where objects are put there is room; what is moved bears nothing
    that it did not bear.

    Raises:
        PlanError: Something would be put down where nothing supports it.
    """
    source, where, _ = instance.placed(world.scene)
    parts = instance.parts
    goals = {}
    for role, pose in put_down_poses(source, where).items():
        if role in parts:  # as the frame of the scene's object, of which the part's is moved
            own = world.scene.thing(parts[role])
            goals[own.name] = pose * where.thing(role).pose.inv() * own.pose
    began = {(h.side, parts[h.thing]) for h in source.holds if h.first == 0 and h.thing in parts}
    acting = {side for side, _ in began}
    sides = {*source.hands, *(side for side, _ in world.touching)}
    wanted: list[Condition] = [("touch", side, thing) for side, thing in sorted(began)]
    wanted += [("free", side) for side in sorted(sides - acting)]
    wanted += [
        ("stand", parts[first], parts[second])
        for first, second in _stands(source.observation)
        if first in parts and second in parts and first not in source.scene.fastened
    ]
    wanted += [("clear", name) for name in sorted(goals)]
    bare = (role for role in instance.roles if role.moved and not role.bears)
    wanted += [("bare", parts[role.name]) for role in bare]
    room = Room(instance.asked.human, world.scene)
    return Problem(world, tuple(wanted), goals, frozenset(parts.values()), room, kinds)


def _stands(observation: Observation) -> Iterator[tuple[str, str]]:
    """What stands on what by preparatory specifications that no earlier step makes true."""
    known: set[tuple[str, ...]] = set()
    for step in sorted(steps_of(observation).steps, key=lambda one: one.step.begin):
        for preparation in step.ipar.preparation:
            needed, pair = preparation.condition, preparation.condition.arguments
            if needed.kind == "contact" and pair[0] != step.ipar.ee and pair not in known:
                known.add(pair)
                yield pair[0], pair[1]
        known |= {one.arguments for one in step.ipar.post_assertions if one.holds}


@dataclass(frozen=True, eq=False)
class Place:
    """Where an object may be put."""

    term: Term
    thing: str
    support: str
    pose: RigidTransform
    way: str = ""
    """The only recording that puts it there; empty where any one may."""


def places_of(problem: Problem, ways: Sequence[Procedure]) -> tuple[Place, ...]:
    """Where objects may be put: free places, and as far from where they stand as was recorded."""
    scene, found = problem.world.scene, list[Place]()
    fixed = sorted(n for n, thing in scene.things.items() if thing.tag is TagType.FIXED)
    for name in mobile(scene):
        for support in fixed:
            for number, spot in enumerate(problem.room.places(name, support, problem.goals)):
                pose = RigidTransform.from_components(spot, scene.thing(name).pose.rotation)
                found.append(Place(("spot", name, support, number), name, support, pose))
        for way in ways:
            if way.stands("1", "1"):
                found += _slid(scene, way, scene.thing(name))
    return tuple(found)


def _slid(scene: Scene, way: Procedure, thing: Thing) -> list[Place]:
    """Where an object is that goes as far along its support as the recorded one did."""
    path, recording = way.source.paths[way.part].translation, way.recording.name
    turn = Rotation.from_euler("z", scene.heading - way.source.scene.heading)
    x, y = np.asarray(thing.place)[:2] + turn.apply(path[-1] - path[0])[:2]
    there = moved(scene, thing.name, (x, y, thing.place[2]), thing.heading)
    support = scene.support(thing.name)
    if not support or there.support(thing.name) != support:
        return []
    pose = there.thing(thing.name).pose
    return [Place(("slid", recording, thing.name), thing.name, support, pose, recording)]


def world_facts(problem: Problem, places: Sequence[Place]) -> Iterator[str]:
    """Where everything is, what is wanted, and what has no room beside what."""
    scene = problem.world.scene
    for side, thing in sorted(problem.world.touching):
        yield _fact("touches_first", side, thing)
    held = {thing for _, thing in problem.world.touching}
    for name in sorted(scene.things):
        support = scene.support(name)
        in_air = name in held and not support
        yield _fact("at_first", name, "air" if in_air else ("start", name))
        if support:
            yield _fact("on", ("start", name), support)
    for condition in problem.wanted:
        yield _fact("wanted", condition)
    for place in places:
        yield _fact("on", place.term, place.support)
        far = np.linalg.norm(place.pose.translation - np.asarray(scene.thing(place.thing).place))
        yield _fact("far", place.term, round(1000.0 * float(far)))
    goals = list[Place]()
    for name, pose in problem.goals.items():
        x, y, z = (float(value) for value in pose.translation)
        support = moved(scene, name, (x, y, z), 0.0).support(name)
        goals.append(Place(("goal", name), name, support, pose))
    yield from _meetings(problem, [*goals, *places])


def _meetings(problem: Problem, places: Sequence[Place]) -> Iterator[str]:
    """Which places of objects have no room beside which of others, or beside where these are."""
    room, scene = problem.room, problem.world.scene
    for place in places:
        for pair in room.near({place.thing: place.pose}, ROOM_M):
            for other in pair - {place.thing, place.support}:
                # The recording of an action itself puts its objects beside each other.
                agreed = place.term == ("goal", place.thing) and other in problem.parts
                if place.thing in pair and not agreed:
                    yield _fact("meets", place.thing, place.term, other, ("start", other))
        for there in places:
            sizes = (scene.thing(one.thing).size for one in (place, there))
            far_m = sum(float(np.linalg.norm(size)) for size in sizes) + ROOM_M
            apart_m = np.linalg.norm(place.pose.translation - there.pose.translation)
            both = {place.thing: place.pose, there.thing: there.pose}
            if len(both) == 2 and apart_m < far_m and frozenset(both) in room.near(both, ROOM_M):
                yield _fact("meets", place.thing, place.term, there.thing, there.term)


def way_facts(
    problem: Problem, ways: Sequence[Procedure], places: Sequence[Place]
) -> Iterator[str]:
    """What recordings can do with either hand and anything that can be moved."""
    scene = problem.world.scene
    for way in ways:
        name = way.recording.name
        for number, step in enumerate(way.steps):
            yield _fact("step", name, number, step.step.action)
            for relation, (start, end) in way.relations(number).items():
                yield _fact("before", name, number, relation, int(start))
                yield _fact("after", name, number, relation, int(end))
            if step.moves:
                yield _fact("moves", name, number)
        yield _fact("mirrored", name, OTHER[way.side])
        for thing in mobile(scene):
            for side in sorted(OTHER):
                yield _fact("way", name, side, thing)
            above = problem.kinds(kind_of(way.source.scene.thing(way.part)))
            own = problem.kinds(kind_of(scene.thing(thing)))
            # How many levels up the hierarchy both have a kind in common.
            levels = (level for level, kind in enumerate(above) if kind in own)
            yield _fact("strange", name, thing, next(levels, len(above)))
        for place in places:
            if place.way == name or (not place.way and way.stands("0", "1")):
                yield _fact("room", name, place.thing, place.term)


def _fact(name: str, *arguments: Term) -> str:
    return f"{text_of((name, *arguments))}."


Failed = tuple[str, str, str, Term]
"""A recording, a hand, an object and a place, or ``any``, that were tried and are not possible."""


@dataclass(frozen=True)
class Planned:
    """A step of a plan."""

    action: str
    hand: str
    thing: str
    recording: str
    number: int
    """Of the step in its recording."""

    place: Spot | None
    """Where it puts the object [m]; None where it puts nothing."""

    support: str = ""


@dataclass(frozen=True, eq=False)
class Stage:
    """Steps that one recording does in a row."""

    way: Procedure
    steps: tuple[Planned, ...]
    term: Term
    """The place as the solver calls it, or ``any``."""

    touching: frozenset[tuple[str, str]]
    """Which hands touch what after it, as the plan has it."""

    @property
    def goal(self) -> Planned | None:
        """The last step that puts the object somewhere."""
        return next((step for step in reversed(self.steps) if step.place is not None), None)

    @property
    def failed(self) -> Failed:
        """What is ruled out when it is not possible."""
        return self.way.recording.name, self.steps[0].hand, self.steps[0].thing, self.term


def unmet(problem: Problem) -> tuple[Condition, ...]:
    """What an action needs and its world lacks."""
    return _unmet(_solved([*world_facts(problem, ())], 0))


def shortest(
    problem: Problem, ways: Sequence[Procedure], failed: Iterable[Failed] = ()
) -> tuple[tuple[Stage, ...], tuple[Condition, ...]]:
    """The shortest plan that makes true all that is wanted.

    Returns:
        What recordings do, in order, and what no plan makes true; one of them is empty.
    """
    places = places_of(problem, ways)
    facts = [*world_facts(problem, places), *way_facts(problem, ways, places)]
    facts += [f"{text_of(('failed', *row))}." for row in failed]
    left = unmet(problem)
    for steps in range(1, MOST_STEPS + 1) if left else ():
        try:
            answer = _solved(facts, steps)
        except RuleError:
            continue  # there are no so many steps
        rest = _unmet(answer)
        if not rest:
            return _stages(answer, ways, places), ()
        left = min(left, rest, key=len)
    return (), left


def why_unmet(problem: Problem, conditions: Sequence[Condition], ways: Sequence[Procedure]) -> str:
    """Which conditions do not hold, and what would make them hold."""
    scene, reasons = problem.world.scene, []
    known = ", ".join(sorted({way.recording.name for way in ways})) or "none"
    for condition in conditions:
        said, fixed = f"{told(condition)} does not hold", False
        if condition[0] == "clear":
            name = condition[1]
            near = problem.room.near({name: problem.goals[name]}, ROOM_M)
            there = set().union(*(pair for pair in near if name in pair)) - {name, *problem.parts}
            said += f": {', '.join(map(repr, sorted(there)))} is there"
            fixed = any(scene.thing(other).tag is TagType.FIXED for other in there)
        reasons.append(
            f"{said} and is fixed; another place for {condition[1]!r} would do"
            if fixed
            else f"{said}, and no recording makes it so (tried: {known}); a recording of one hand "
            "that does so with such an object, or a scene in which it holds, would do"
        )
    return "; ".join(reasons)


def _solved(facts: Sequence[str], steps: int) -> Answer:
    return best([rule_file(PROGRAM)], "\n".join([*facts, f"horizon({steps})."]))


def _unmet(answer: Answer) -> tuple[Condition, ...]:
    found = (row[0] for row in answer.of("unmet"))
    return tuple(tuple(map(str, one)) for one in found if isinstance(one, tuple))


def _stages(
    answer: Answer, ways: Sequence[Procedure], places: Sequence[Place]
) -> tuple[Stage, ...]:
    by_name = {way.recording.name: way for way in ways}
    by_term = {place.term: place for place in places}
    brought = {(time, thing): by_term[term] for time, thing, term in answer.of("brings")}
    rows: list[list[tuple[Planned, Term | None, Term]]] = []
    for time, *who, number in answer.of("does"):
        name, hand, thing = map(str, who)
        assert isinstance(number, int)
        place, spot = brought.get((time, thing)), None
        if place:
            x, y, z = place.pose.translation
            spot = (float(x), float(y), float(z))
        action = by_name[name].steps[number].step.action
        support = place.support if place else ""
        step = Planned(action, hand, thing, name, number, spot, support)
        last = rows[-1][-1][0] if rows else None
        follows = (name, hand, thing, number - 1)
        if last is None or (last.recording, last.hand, last.thing, last.number) != follows:
            rows.append([])
        rows[-1].append((step, place.term if place else None, time))
    return tuple(
        Stage(
            by_name[row[0][0].recording],
            tuple(step for step, _, _ in row),
            next((term for _, term, _ in reversed(row) if term is not None), "any"),
            frozenset((str(h), str(t)) for at, h, t in answer.of("touch") if at == row[-1][2]),
        )
        for row in rows
    )


@dataclass(frozen=True, eq=False)
class Done(Performed):
    """A stage of a plan as it was performed."""

    stage: Stage


@dataclass(frozen=True, eq=False)
class Prepared:
    """A world that has what an action needs."""

    wanted: tuple[Condition, ...]
    lacking: tuple[Condition, ...]
    """What it did not have at the start."""

    done: tuple[Done, ...]
    world: World
    tried: tuple[str, ...]
    """What was planned first and found impossible."""


class StageError(PlanError):
    """A stage of a plan that cannot be performed well.

    Attributes:
        failed: What is ruled out by that.
    """

    def __init__(self, stage: Stage, why: str) -> None:
        self.failed = stage.failed
        first, place = stage.steps[0], stage.goal
        where = f" to {place.support!r}" if place else ""
        super().__init__(
            f"{first.thing!r}{where} by the {first.hand} hand as in {first.recording!r}: {why}"
        )


def measured_world(source: Source) -> World:
    """The scene of a recording as it begins, with what its hands touch then."""
    return _world(source.capture, source.observation, source.scene)


def captured_world(place: Capture | Path | str) -> World:
    """The scene of a capture as it begins, with what the hands touch then.

    Raises:
        CaparError: It has a fault, no sensor of the head, or an object without a shape.
    """
    trial = trial_of(place)
    return _world(trial, observe(trial), captured_scene(trial))


def _world(capture: Capture, observation: Observation, scene: Scene) -> World:
    sides = {s.name: s.side for s in capture.acting if s.end_effector == "hand"}
    facts = (fact for fact in observation.facts if isinstance(fact, Touch))
    pairs = ((sides.get(f.body, ""), f.other) for f in facts if f.first == 0)
    held = {(side, other) for side, other in pairs if side and other in scene.things}
    return World(scene, frozenset(held))


def prepare(
    instance: Instance, world: World, kinds: Kinds, ways: Callable[[], tuple[Procedure, ...]]
) -> Prepared:
    """Make true what an action needs, by the shortest plan that can be performed well.

    ``paths`` opens the recordings of which a plan can be made, only if one is needed.

    Raises:
        PlanError: No plan makes it true; the message says what does not hold and what would help.
    """
    problem = problem_of(instance, world, kinds)
    lacking = left = unmet(problem)
    if not lacking:
        return Prepared(problem.wanted, (), (), world, ())
    known, failed, tried = ways(), list[Failed](), list[str]()
    while len(tried) < MOST_TRIES:
        stages, left = shortest(problem, known, failed)
        if left:
            break
        try:
            done, after = _performed(stages, world, instance.asked.human)
        except StageError as error:
            failed.append(error.failed)
            tried.append(str(error))
            left = lacking
            continue
        if still := unmet(problem_of(instance, after, kinds)):
            said = ", ".join(told(condition) for condition in still)
            raise PlanError(f"by the plan {said} holds, and not by geometry, after all its steps")
        return Prepared(problem.wanted, lacking, done, after, tuple(tried))
    why = why_unmet(problem, left, known)
    raise PlanError(f"{why}; not possible were: {'; '.join(tried)}" if tried else why)


def _performed(
    stages: Sequence[Stage], world: World, human: Human
) -> tuple[tuple[Done, ...], World]:
    """All stages in turn; each begins in the world that the one before leaves, as measured."""
    made: list[Done] = []
    for stage in stages:
        step = stage.steps[0]
        now = {
            "touch": (step.hand, step.thing) in world.touching,
            "stand": bool(world.scene.support(step.thing)),
        }
        for relation, (before, _) in stage.way.relations(step.number).items():
            if before != str(int(now[relation])):
                raise StageError(stage, f"by geometry {relation} is {now[relation]} before it")
        made.append(_stage(stage, world, human))
        motion, names = made[-1].motion, made[-1].names
        around = Surroundings(motion.plan.human, motion.plan.scene)
        near = gates.contact_distances(around, motion, len(motion.postures) - 1)
        touching = frozenset(
            (side, names[thing])
            for (side, thing), apart_m in near.items()
            if side in {"right", "left"} and thing in names and apart_m <= gates.TOUCHES_M
        )
        world = World(scene_after(motion, names, world.scene), touching)
    return tuple(made), world


def _stage(stage: Stage, world: World, human: Human) -> Done:
    first, goal, scene = stage.steps[0], stage.goal, world.scene
    try:
        source = stage.way.part_of(first.number, stage.steps[-1].number, first.hand)
        # The object, and what it stands on at both ends, in the parts of the recorded ones.
        parts = {stage.way.part: first.thing}
        begins_on, ends_on = roles.ends_on(source, stage.way.part)
        beneath = scene.support(first.thing)
        for role, support in ((ends_on, goal.support if goal else beneath), (begins_on, beneath)):
            if role and support and role not in parts and support not in parts.values():
                parts[role] = support
        source = roles.with_only(source, parts)
        spots = {first.thing: goal.place} if goal and goal.place else {}
        made, where = roles.cast(source, replace(scene, spots=spots), parts)
        if not is_possible(made, where, human):
            raise PlanError("out of reach")
        motion, quality = regenerate(made, human, where)
    except PlanError as error:
        raise StageError(stage, str(error)) from error
    names = roles.own_names(source, scene, parts)
    own = {name: role for role, name in names.items()}
    held = (first.hand, first.thing) in stage.touching
    contacts: list[tuple[gates.Contact, bool]] = [((first.hand, own[first.thing]), held)]
    contacts += [((own[first.thing], own[goal.support]), True)] if goal else []
    planned = Asserted("the plan's stage", len(made.times) - 1, tuple(contacts), "")
    gate = gates.contact_gate(motion, [*asserted(made), planned])
    quality = Quality((*quality.gates, gate), quality.told)
    if not quality.passed:
        raise StageError(stage, f"it fails {gates.failures(quality)}")
    return Done(motion, quality, names, None, stage)
