"""Hand-overs: several bodies perform together what several were recorded to do."""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human, body_spec
from capar.model.capture import Capture, TagType
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.regeneration.body_frames import body_frames
from capar.regeneration.goals import Goal, object_goals, support_at
from capar.regeneration.holds import loads_of
from capar.regeneration.motion import Motion
from capar.regeneration.paths import ObjectPaths, object_paths
from capar.regeneration.planning import MOST_TURNS, TALLER_M, Draft, beside, check_stance
from capar.regeneration.quality import Gate, Quality, performed_hands
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.search import best_motion
from capar.regeneration.sources import Hold, Source, check_source, moves, source_of
from capar.regeneration.styles import Kind, Style, own_style


@dataclass(frozen=True, eq=False)
class HandOver:
    """An object that passes from one performer's hand to another's."""

    thing: str
    giver: str
    """Name of the agent."""

    taker: str
    first: int
    """Frame from which both hold it."""

    last: int
    """Last frame in which both hold it."""


@dataclass(frozen=True, eq=False)
class JointSource:
    """What several performers did together."""

    capture: Capture
    observation: Observation
    sources: Mapping[str, Source]
    """By the agent's name, the first one first; the objects are the same in all."""

    hand_overs: tuple[HandOver, ...]
    """In order of time."""


def joint_source(capture: Capture, observation: Observation) -> JointSource:
    """What a capture of several performers and its observation say of the performance.

    Raises:
        PlanError: As for one performer; or an object passes between hands that never both hold it,
            or two objects do at once.
    """
    alone = {
        agent.name: source_of(
            _of(capture, agent.name), _done_by(capture, observation, agent.name), checked=False
        )
        for agent in capture.agents
    }
    sources = {}
    touching = [fact for fact in observation.facts if isinstance(fact, Touching)]
    for name, source in alone.items():
        holds = tuple(hold for other in alone.values() for hold in other.holds)
        others = [hold for other, s in alone.items() if other != name for hold in s.holds]
        sources[name] = replace(
            source,
            others=tuple(sorted(others, key=lambda hold: hold.first)),
            loads=loads_of(source.paths, holds, touching),
        )
        check_source(sources[name])
    return JointSource(capture, observation, sources, _hand_overs(sources))


def _of(capture: Capture, name: str) -> Capture:
    """What was recorded of one performer, and all objects."""
    agent = next(agent for agent in capture.agents if agent.name == name)
    sensors = [sensor for sensor in capture.sensors if capture.agent_of(sensor) == name]
    if not sensors:
        raise PlanError(f"{name!r} wears no sensor; leave the agent out, or name whose sensors are")
    objects = [
        thing
        for thing in capture.objects
        if thing.tag is not TagType.SELF or capture.agent_of(thing) == name
    ]
    return replace(
        capture, agent=agent, others=(), sensors=tuple(sensors), objects=tuple(objects),
        pivot_contacts=(),
    )  # fmt: skip


def _done_by(capture: Capture, observation: Observation, name: str) -> Observation:
    """The observation with the forces of one performer alone."""
    own = {sensor.name for sensor in capture.sensors if capture.agent_of(sensor) == name}
    return replace(
        observation, forces=tuple(force for force in observation.forces if force.ee in own)
    )


def _hand_overs(sources: Mapping[str, Source]) -> tuple[HandOver, ...]:
    out = []
    owned = [(hold, name) for name, source in sources.items() for hold in source.holds]
    owned.sort(key=lambda pair: pair[0].first)
    for number, (hold, giver) in enumerate(owned):
        for later, taker in owned[number + 1 :]:
            if giver == taker or hold.thing != later.thing:
                continue
            if later.first <= hold.last < later.last:
                out.append(HandOver(hold.thing, giver, taker, later.first, hold.last))
            elif later.last <= hold.last:
                raise PlanError(
                    f"{taker!r} holds {hold.thing!r} only while {giver!r} does; what two hold "
                    "together and neither takes over is not regenerated"
                )
    return tuple(sorted(out, key=lambda found: found.first))


def all_holds(source: JointSource) -> tuple[Hold, ...]:
    """Of all performers, in order of time."""
    holds = [hold for one in source.sources.values() for hold in one.holds]
    return tuple(sorted(holds, key=lambda hold: (hold.first, hold.side)))


Place = tuple[float, float]
"""Where something is handed over, from the usual place towards the taker and upwards [m]."""

PLACES: tuple[Place, ...] = ((0.0, 0.0), (0.1, 0.0), (-0.1, 0.0), (0.0, 0.1), (0.0, -0.1))
"""The places that are tried, the usual one first [m]."""


@dataclass(frozen=True, eq=False)
class Cast:
    """Who performs together, and where each one stands among the same objects."""

    humans: Mapping[str, Human]
    """By the agent's name."""

    scenes: Mapping[str, Scene]
    """Likewise."""


def joint_paths(source: JointSource, cast: Cast, style: Style, place: Place) -> ObjectPaths:
    """The paths of all objects, through the hands of all performers.

    Raises:
        PlanError: Something would be put down where nothing supports it, or meets the head of
            one who was given it.
    """
    first = next(iter(source.sources))
    one = replace(source.sources[first], holds=all_holds(source))
    _check_meetings(source, first)
    scene, human = cast.scenes[first], cast.humans[first]
    goals = object_goals(one, scene, body_frames(one.human, one.scene), body_frames(human, scene))
    told = []
    for passed in source.hand_overs:
        before, after = one.paths[passed.thing][passed.first], offer(source, cast, passed, place)
        goals[passed.thing] = _through(one, scene, goals[passed.thing], passed, before, after)
        x, y, z = after.translation
        told.append(
            f"{passed.giver} hands {passed.thing!r} to {passed.taker} at "
            f"{one.times[passed.first]:.2f} s at ({x:.2f}, {y:.2f}, {z:.2f}) m, between them as "
            f"their statures are, {place[0]:+.1f} m to the taker, {place[1]:+.1f} m upwards"
        )
    ways = object_paths(one, scene, goals, human, style)
    return replace(ways, told=(*told, *ways.told))


def _check_meetings(source: JointSource, first: str) -> None:
    for name, one in source.sources.items():
        if name != first and one.meetings:
            meeting = one.meetings[0]
            raise PlanError(
                f"{meeting.thing!r} comes to the {meeting.part} of {name!r}, and among several "
                f"performers only the first one, {first!r}, may bring a thing to the head; end "
                "the recording before, or name that agent first"
            )


def offer(source: JointSource, cast: Cast, passed: HandOver, place: Place) -> RigidTransform:
    """Where an object is handed over.

    Along the line from one performer to the other where the recorded place divides it, each side
    in proportion to that one's stature; as far above where it was at first as it was recorded.
    """
    pair = (passed.giver, passed.taker)
    olds, news = [source.sources[name] for name in pair], [cast.scenes[name] for name in pair]
    before = olds[0].paths[passed.thing][passed.first]
    ratios = [
        cast.humans[name].measures["stature"] / source.sources[name].human.measures["stature"]
        for name in pair
    ]
    (start, way), (new_start, new_way) = (
        (np.asarray(giver.place), np.subtract(taker.place, giver.place))
        for giver, taker in ([old.scene for old in olds], news)
    )
    length, new_length = np.linalg.norm(way), np.linalg.norm(new_way)
    local = before.translation[:2] - start
    share = float(local @ way) / length**2
    aside = float(local @ _left(way)) / length
    shares = np.array([share * ratios[0], (1.0 - share) * ratios[1]])
    divided = float(shares[0] / shares.sum()) + place[0] / new_length
    flat = new_start + divided * new_way + aside * np.mean(ratios) * _left(new_way) / new_length
    old_scene, new_scene = olds[0].scene, news[0]
    gone = before.translation[2] - old_scene.thing(passed.thing).place[2]
    high = new_scene.thing(passed.thing).place[2] + gone
    turn = _heading(new_way) - _heading(way)
    own = Rotation.from_euler("z", turn) * before.rotation
    return RigidTransform.from_components([*flat, high + place[1]], own)


def _left(way: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    return np.array([-way[1], way[0]])


def _heading(way: Float[np.ndarray, "2"]) -> float:
    return float(np.arctan2(way[1], way[0]))


def _through(
    one: Source,
    scene: Scene,
    goals: list[Goal],
    passed: HandOver,
    before: RigidTransform,
    after: RigidTransform,
) -> list[Goal]:
    """The goals of an object with those of its being handed over between them.

    What nothing bears afterwards goes as far in metres from there as it did.
    """
    reason = "handed over between both, in proportion to their statures"
    frames = dict.fromkeys((passed.first, passed.last))
    through = [Goal(passed.thing, frame, after, reason) for frame in frames]
    path, kept = one.paths[passed.thing], []
    turn = after.rotation * before.rotation.inv()
    for goal in goals:
        if goal.frame < passed.first:
            arrived = not moves(path[goal.frame : passed.first + 1])
            if not (arrived and goal is not goals[0]):
                kept.append(goal)
        elif goal.frame > passed.last:
            gone = path[goal.frame].translation - before.translation
            if not support_at(one.scene, passed.thing, path[goal.frame]):
                pose = RigidTransform.from_components(
                    after.translation + turn.apply(gone), turn * path[goal.frame].rotation
                )
                reason = "as far from where it was handed over as it was [m]"
                kept.append(replace(goal, pose=pose, reason=reason))
            else:
                kept.append(goal)
    return sorted([*kept, *through], key=lambda goal: goal.frame)


FAR_M = 0.1
"""Larger distances between two bodies are not measured [m]."""


class TwoBodies:
    """Two bodies, to be posed and measured."""

    def __init__(self, first: Human, second: Human) -> None:
        spec = body_spec(first.measures)
        spec.worldbody.add_frame().attach_body(
            body_spec(second.measures).worldbody.first_body(), "other_", ""
        )
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        names = [
            self.model.body(int(self.model.geom_bodyid[geom])).name
            for geom in range(self.model.ngeom)
        ]
        own = [geom for geom, name in enumerate(names) if not name.startswith("other_")]
        others = [geom for geom, name in enumerate(names) if name.startswith("other_")]
        self.pairs = np.array(list(itertools.product(own, others)))
        self.names = [name.removeprefix("other_") for name in names]
        self.reach = self.model.geom_rbound[self.pairs].sum(axis=1)

    def nearest(
        self, first: Float[np.ndarray, "posture"], second: Float[np.ndarray, "posture"]
    ) -> tuple[float, str, str]:
        """How far two bodies are apart in some postures, negative inside [m], and which parts."""
        self.data.qpos[:] = np.concatenate([first, second])
        mujoco.mj_kinematics(self.model, self.data)
        middles = self.data.geom_xpos[self.pairs]
        apart = np.linalg.norm(middles[:, 0] - middles[:, 1], axis=1) - self.reach
        worst = (FAR_M, "", "")
        for row in np.flatnonzero(apart < FAR_M):
            one, two = (int(geom) for geom in self.pairs[row])
            found = mujoco.mj_geomDistance(self.model, self.data, one, two, FAR_M, None)
            worst = min(worst, (float(found), self.names[one], self.names[two]))
        return worst


def joint_gates(source: JointSource, motions: Mapping[str, Motion]) -> tuple[Gate, ...]:
    """Gates between all bodies, at every frame."""
    return (*_between(motions), *_coupled(source, motions))


def _between(motions: Mapping[str, Motion]) -> Iterator[Gate]:
    for (one, first), (two, second) in itertools.combinations(motions.items(), 2):
        both = TwoBodies(first.plan.human, second.plan.human)
        rows = zip(first.postures, second.postures, strict=True)
        found = [(*both.nearest(*postures), frame) for frame, postures in enumerate(rows)]
        gap_m, part, other, frame = min(found)
        bodies = f"{one}'s {part}, {two}'s {other}" if part else ""
        yield Gate("bodies apart", 1e3 * gap_m, -1.0, "mm", True, frame, bodies)


def _coupled(source: JointSource, motions: Mapping[str, Motion]) -> Iterator[Gate]:
    """Both hands are where they hold the object as long as both were recorded to hold it."""
    for passed in source.hand_overs:
        worst = max(_missed(motions[name], passed, name) for name in (passed.giver, passed.taker))
        missed_m, frame, bodies = worst
        yield Gate("hand-over", 1e3 * missed_m, 1.0, "mm", False, frame, bodies)


def _missed(motion: Motion, passed: HandOver, name: str) -> tuple[float, int, str]:
    """How far a performer's hands are from their grips while an object is handed over [m]."""
    plan, part = motion.plan, slice(passed.first, passed.last + 1)
    hands, worst = performed_hands(motion), (0.0, passed.first, name)
    for grip in plan.grips:
        hold = grip.hold
        if hold.thing == passed.thing and hold.first <= passed.first <= passed.last <= hold.last:
            wanted: RigidTransform = plan.things[hold.thing][part] * grip.pose
            off = np.linalg.norm(hands[hold.side][part].translation - wanted.translation, axis=1)
            row = int(off.argmax())
            found = (float(off[row]), passed.first + row, f"{name}'s {hold.side} hand")
            worst = max(worst, found)
    return worst


NEARER_M = (0.1, 0.3, 0.5, 0.8, 1.2)
"""How much nearer somebody is placed where something is out of reach [m]."""


@dataclass(frozen=True, eq=False)
class JointMotion:
    """The motions of several bodies that handle the same objects."""

    source: JointSource
    motions: Mapping[str, Motion]
    """By the agent's name."""

    qualities: Mapping[str, Quality]
    """Likewise."""

    gates: tuple[Gate, ...]
    """Between the bodies."""

    @property
    def passed(self) -> bool:
        """Whether every gate of every body is, and those between them."""
        alone = all(quality.passed for quality in self.qualities.values())
        return alone and all(gate.passed for gate in self.gates)

    @property
    def failed(self) -> tuple[str, ...]:
        """Gates that are not, with whose they are."""
        own = [f"{who}: {name}" for who, one in self.qualities.items() for name in one.failed]
        return (*own, *(gate.name for gate in self.gates if not gate.passed))


def regenerate_together(
    source: JointSource,
    humans: Mapping[str, Human],
    scenes: Mapping[str, Scene] | None = None,
    kind: Kind = Kind.PATH,
) -> JointMotion:
    """Let bodies do together in a scene what was recorded of others; verified at every frame.

    The objects' paths are decided first and are the same for all; then every body is led along its
    own hands' paths.

    Raises:
        PlanError: It is out of reach or impossible; the message says what would help.
    """
    cast = Cast(humans, scenes or {name: one.scene for name, one in source.sources.items()})
    drafts = _reachable(source, cast, kind)
    made = {name: best_motion(draft) for name, draft in drafts.items()}
    motions = {name: motion for name, (motion, _) in made.items()}
    qualities = {name: quality for name, (_, quality) in made.items()}
    return JointMotion(source, motions, qualities, joint_gates(source, motions))


def _reachable(source: JointSource, cast: Cast, kind: Kind) -> dict[str, Draft]:
    """Where objects are handed over, and everybody's grips.

    The first place that all reach with the recorded grips, else the usual one with turned grips.
    """
    for name, human in cast.humans.items():
        check_stance(cast.scenes[name], human)
    usual, *others = PLACES if source.hand_overs else PLACES[:1]
    why = ""
    for place, most in [*((place, 1) for place in (usual, *others)), (usual, MOST_TURNS)]:
        try:
            return _drafts(source, cast, kind, place, most)
        except PlanError as error:
            why = why or str(error)
    raise PlanError(f"{why}; {_remedy(source, cast, kind)}")


def _drafts(
    source: JointSource, cast: Cast, kind: Kind, place: Place, most: int
) -> dict[str, Draft]:
    """Everybody's grips, with so many turns tried."""
    first = next(iter(source.sources))
    ways = joint_paths(source, cast, own_style(source.sources[first], kind), place)
    out = {}
    for name, one in source.sources.items():
        scene = cast.scenes[name]
        draft = Draft(one, scene, cast.humans[name], own_style(one, kind), ways)
        if beyond := draft.beyond():
            raise PlanError(f"{name}: {beyond}")
        grips, missed = draft.reachable_grips(most)
        if missed is not None:
            raise PlanError(f"{name}: {missed}")
        draft.grips = tuple(grips)
        draft.told += [f"whatever the grip, {told}" for told in draft.pressed]
        out[name] = draft
    return out


def _remedy(source: JointSource, cast: Cast, kind: Kind) -> str:
    """What would make it possible."""
    for words, changed in _remedies(source, cast):
        try:
            for name, human in changed.humans.items():
                check_stance(changed.scenes[name], human)
            _drafts(source, changed, kind, PLACES[0], 1)
        except PlanError:
            continue
        return f"{words} would do"
    return "no nearer place or recorded body that was tried would do"


def _remedies(source: JointSource, cast: Cast) -> Iterator[tuple[str, Cast]]:
    """What may help, in words, and the cast with it."""
    middle = np.mean([scene.place for scene in cast.scenes.values()], axis=0)
    for by_m in NEARER_M:
        for name in cast.scenes:
            scenes = {**cast.scenes, name: beside(cast.scenes[name], by_m, 0.0)}
            yield f"{name} standing {by_m:.2f} m further ahead", Cast(cast.humans, scenes)
        scenes = {name: _towards(scene, middle, by_m) for name, scene in cast.scenes.items()}
        yield f"everybody standing {by_m:.2f} m nearer", Cast(cast.humans, scenes)
    for name, human in cast.humans.items():
        recorded = source.sources[name].human
        recorded_m, own_m = recorded.measures["stature"], human.measures["stature"]
        if recorded_m > own_m + TALLER_M:
            words = f"{name} being as tall as recorded, {recorded_m:.2f} m,"
            yield words, Cast({**cast.humans, name: recorded}, cast.scenes)


def _towards(scene: Scene, middle: np.ndarray, by_m: float) -> Scene:
    way = middle - np.asarray(scene.place)
    x, y = np.asarray(scene.place) + by_m * way / max(float(np.linalg.norm(way)), 1e-9)
    return replace(scene, place=(float(x), float(y)))
