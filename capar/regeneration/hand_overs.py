"""Hand-overs: several bodies perform together what several were recorded to do."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.human import Human, body_spec
from capar.model.capture import Capture, TagType
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.regeneration.body_frames import body_frames
from capar.regeneration.goals import Goal, object_goals
from capar.regeneration.holds import in_order, loads_of
from capar.regeneration.motion import Motion
from capar.regeneration.paths import ObjectPaths, object_paths
from capar.regeneration.planning import Draft
from capar.regeneration.quality import Gate, Quality, performed_hands, within, worst_of
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.search import MOST_TURNS, best_motion, check_stance, choose_grips
from capar.regeneration.sources import Source, check_source, moves, source_of
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
    alone = {}
    for agent in capture.agents:
        own = _of(capture, agent.name)
        worn = {sensor.name for sensor in own.sensors}
        forces = tuple(force for force in observation.forces if force.ee in worn)
        alone[agent.name] = source_of(own, replace(observation, forces=forces), checked=False)
    touching = [fact for fact in observation.facts if isinstance(fact, Touching)]
    owned = [(hold, name) for name, source in alone.items() for hold in source.holds]
    owned.sort(key=lambda pair: pair[0].first)
    sources = {}
    for name, source in alone.items():
        others = tuple(hold for hold, who in owned if who != name)
        loads = loads_of(source.paths, tuple(hold for hold, _ in owned), touching)
        sources[name] = replace(source, others=others, loads=loads)
        check_source(sources[name])
    passed = []
    for number, (hold, giver) in enumerate(owned):
        for later, taker in owned[number + 1 :]:
            if giver == taker or hold.thing != later.thing or later.first > hold.last:
                continue
            if later.last <= hold.last:
                raise PlanError(
                    f"{taker!r} holds {hold.thing!r} only while {giver!r} does; what two hold "
                    "together and neither takes over is not regenerated"
                )
            passed.append(HandOver(hold.thing, giver, taker, later.first, hold.last))
    return JointSource(
        capture, observation, sources, tuple(sorted(passed, key=lambda found: found.first))
    )


def _of(capture: Capture, name: str) -> Capture:
    """What was recorded of one performer, and all objects."""
    agent = next(agent for agent in capture.agents if agent.name == name)
    sensors = tuple(sensor for sensor in capture.sensors if capture.agent_of(sensor) == name)
    if not sensors:
        raise PlanError(f"{name!r} wears no sensor; leave the agent out, or name whose sensors are")
    objects = tuple(
        thing
        for thing in capture.objects
        if thing.tag is not TagType.SELF or capture.agent_of(thing) == name
    )
    return replace(
        capture, agent=agent, others=(), sensors=sensors, objects=objects, pivot_contacts=()
    )


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
    for name, other in source.sources.items():
        if name != first and other.meetings:
            meeting = other.meetings[0]
            raise PlanError(
                f"{meeting.thing!r} comes to the {meeting.part} of {name!r}, and among several "
                f"performers only the first one, {first!r}, may bring a thing to the head; end "
                "the recording before, or name that agent first"
            )
    holds = in_order(hold for other in source.sources.values() for hold in other.holds)
    one = replace(source.sources[first], holds=holds)
    scene, human = cast.scenes[first], cast.humans[first]
    goals = object_goals(one, scene, body_frames(one.human, one.scene), body_frames(human, scene))
    notes = []
    for passed in source.hand_overs:
        name, at, own = passed.thing, offer(source, cast, passed, place), goals[passed.thing]
        kept = [
            goal
            for goal in own
            if goal.frame > passed.last
            or (
                goal.frame < passed.first
                and (goal is own[0] or moves(one.paths[name][goal.frame : passed.first + 1]))
            )
        ]
        reason = "handed over between both, in proportion to their statures"
        frames = dict.fromkeys((passed.first, passed.last))
        kept += [Goal(name, frame, at, reason) for frame in frames]
        goals[name] = sorted(kept, key=lambda goal: goal.frame)
        x, y, z = at.translation
        notes.append(
            f"{passed.giver} hands {name!r} to {passed.taker} at "
            f"{one.times[passed.first]:.2f} s at ({x:.2f}, {y:.2f}, {z:.2f}) m, between them as "
            f"their statures are, {place[0]:+.1f} m to the taker, {place[1]:+.1f} m upwards"
        )
    paths = object_paths(one, scene, goals, human, style)
    return replace(paths, notes=(*notes, *paths.notes))


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
    left, new_left = (np.array([-y, x]) for x, y in (way, new_way))
    length, new_length = np.linalg.norm(way), np.linalg.norm(new_way)
    local = before.translation[:2] - start
    share, aside = float(local @ way) / length**2, float(local @ left) / length
    shares = np.array([share * ratios[0], (1.0 - share) * ratios[1]])
    divided = float(shares[0] / shares.sum()) + place[0] / new_length
    flat = new_start + divided * new_way + aside * np.mean(ratios) * new_left / new_length
    heights = [scene.thing(passed.thing).place[2] for scene in (news[0], olds[0].scene)]
    high = heights[0] + before.translation[2] - heights[1] + place[1]
    turn = np.arctan2(new_way[1], new_way[0]) - np.arctan2(way[1], way[0])
    own = Rotation.from_euler("z", turn) * before.rotation
    return RigidTransform.from_components([*flat, high], own)


FAR_M = 0.1  # Larger distances between two bodies are not measured [m].


def joint_gates(source: JointSource, motions: Mapping[str, Motion]) -> tuple[Gate, ...]:
    """Gates between all bodies, at every frame."""
    pairs = itertools.combinations(motions.items(), 2)
    apart = (
        _apart_gate(f"{one}'s", first, f"{two}'s", second) for (one, first), (two, second) in pairs
    )
    return (*apart, *(_hand_over_gate(motions, passed) for passed in source.hand_overs))


def _apart_gate(whose: str, first: Motion, other: str, second: Motion) -> Gate:
    """How far two bodies are apart, negative inside."""
    spec = body_spec(first.plan.human.measures)
    spec.worldbody.add_frame().attach_body(
        body_spec(second.plan.human.measures).worldbody.first_body(), "other_", ""
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    names = [model.body(int(body)).name for body in model.geom_bodyid]
    ours, theirs = (
        [geom for geom, name in enumerate(names) if name.startswith("other_") == is_other]
        for is_other in (False, True)
    )
    pairs = np.array(list(itertools.product(ours, theirs)))
    reach = model.geom_rbound[pairs].sum(axis=1)
    worst = (FAR_M, "", "", 0)
    for frame, postures in enumerate(zip(first.postures, second.postures, strict=True)):
        data.qpos[:] = np.concatenate(postures)
        mujoco.mj_kinematics(model, data)
        middles = data.geom_xpos[pairs]
        near = np.linalg.norm(middles[:, 0] - middles[:, 1], axis=1) - reach < FAR_M
        for one, two in pairs[near].tolist():
            gap_m = float(mujoco.mj_geomDistance(model, data, one, two, FAR_M, None))
            worst = min(worst, (gap_m, names[one], names[two].removeprefix("other_"), frame))
    gap_m, part, their, frame = worst
    bodies = f"{whose} {part}, {other} {their}" if part else ""
    return Gate("bodies apart", 1e3 * gap_m, -1.0, "mm", True, frame, bodies)


def _hand_over_gate(motions: Mapping[str, Motion], passed: HandOver) -> Gate:
    """Both hands are where they hold the object as long as both were recorded to hold it."""
    part, worst = slice(passed.first, passed.last + 1), (0.0, passed.first, passed.giver)
    for name in (passed.giver, passed.taker):
        plan, hands = motions[name].plan, performed_hands(motions[name])
        for grip in plan.grips:
            hold = grip.hold
            if (
                hold.thing == passed.thing
                and hold.first <= passed.first <= passed.last <= hold.last
            ):
                wanted: RigidTransform = plan.things[hold.thing][part] * grip.pose
                off = hands[hold.side][part].translation - wanted.translation
                whose = f"{name}'s {hold.side} hand"
                worst = max(worst, worst_of(np.linalg.norm(off, axis=1), whose, passed.first))
    return within("hand-over", worst, 1.0)


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
        PlanError: It is out of reach or impossible.
    """
    cast = Cast(humans, scenes or {name: one.scene for name, one in source.sources.items()})
    # The first place that all reach with the recorded grips, else the usual one with turned grips.
    places = [(place, 1) for place in (PLACES if source.hand_overs else PLACES[:1])]
    refused: list[PlanError] = []
    for place, most in [*places, (PLACES[0], MOST_TURNS)]:
        try:
            drafts = _drafts(source, cast, kind, place, most)
            break
        except PlanError as error:
            refused.append(error)
    else:
        raise refused[0]
    made = {name: best_motion(draft) for name, draft in drafts.items()}
    motions = {name: motion for name, (motion, _) in made.items()}
    qualities = {name: quality for name, (_, quality) in made.items()}
    return JointMotion(source, motions, qualities, joint_gates(source, motions))


def _drafts(
    source: JointSource, cast: Cast, kind: Kind, place: Place, most: int
) -> dict[str, Draft]:
    """Everybody's grips, with so many turns tried."""
    first = next(iter(source.sources))
    for name, human in cast.humans.items():
        check_stance(cast.scenes[name], human)
    paths = joint_paths(source, cast, own_style(source.sources[first], kind), place)
    out = {}
    for name, one in source.sources.items():
        style = own_style(one, kind)
        out[name] = Draft(one, cast.scenes[name], cast.humans[name], style, paths)
        if missed := out[name].beyond() or choose_grips(out[name], most):
            raise PlanError(f"{name}: {missed}")
    return out
