"""A virtual performer: a body that does what a script says, with the exact truth of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import mink
import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from capar.body.gaze_control import look_tasks, share_costs
from capar.body.human import Human
from capar.body.inverse_kinematics import BalanceLimit, BalanceTask, joint_limits, standing_support
from capar.body.scripts import (
    SIDES,
    Move,
    Phase,
    Script,
    between,
    minimum_jerk,
    tossed,
    turned_about,
)
from capar.body.virtual_scenes import Scene, SceneError, grips

#: Weights of a metre and of a radian at the palms, of a metre and a radian at the feet, and of a
#: metre of the centre of mass from above the feet
PALM_COST, FOOT_COST, BALANCE_COST = (20.0, 4.0), 60.0, 2.0
#: How somebody stands at ease [degrees]
RELAXED = {"elbow_flexion": 12.0, "shoulder_abduction": 6.0, "knee_flexion": 2.0}
#: How long the gaze goes ahead of the hand (Land & Hayhoe 2001: up to half a second), and how long
#: a shift of gaze takes, the head's share included [s]
LEAD_S, SHIFT_S = 0.2, 0.3
#: How far next to and above the straight path a hand comes to an object from outside [m]
STANDOFF_M, RISE_M = 0.07, 0.13
UP, OVER = 0.6, 0.75  # shares of a reach in which the hand rises, and in which it goes forward [1]

#: How long it takes after a drink until the head is free again, in the next phase, and how long a
#: hand swings on that let go of what it throws [s]
RELEASE_S, FOLLOW_S = 0.48, 0.12
#: Of inverse kinematics for a frame, and for a grip that is tried
ITERATIONS, GRIP_ITERATIONS = 3, 20
RATE_HZ = 103.3  # of the thesis's tracker (thesis 3.1) [Hz]

#: A palm further than the one from where it is to be cannot reach it; one nearer than the other to
#: its grip touches the object [m]
REACH_TOLERANCE_M, TOUCH_M = 0.003, 0.003


class PerformanceError(SceneError):
    """Something that this body cannot do in this scene."""


@dataclass(frozen=True, eq=False)
class Performance:
    """What was done, to the last joint."""

    human: Human
    scene: Scene
    script: Script
    times: Float[np.ndarray, "frames"]  #: [s]
    motion: Float[np.ndarray, "frames posture"]
    things: Mapping[str, RigidTransform]  #: ``T_world_thing`` of every object at every frame
    phases: tuple[tuple[str, float, float], ...]  #: Name, start and end of each [s]
    gazes: Float[np.ndarray, "frames 3"]  #: Point looked at [m]
    looks: tuple[str, ...]  #: What is looked at in each phase
    #: By side, distance of a palm from where it is to be [m]
    slip_m: Mapping[str, Float[np.ndarray, "frames"]]


@dataclass(frozen=True, eq=False)
class Role:
    """Who does what, and from where."""

    name: str  #: Of the agent
    human: Human
    script: Script  #: As many phases as everybody else's, of the same lengths
    place: tuple[float, float] = (0.0, 0.0)  #: Where the body stands [m]
    heading: float = 0.0  #: Which way it faces, from x towards y [rad]


#: Posture, poses of objects, point looked at [m], and how far palms miss their goals [m]
Frame = tuple[np.ndarray, dict[str, RigidTransform], np.ndarray, dict[str, float]]


def perform(
    human: Human,
    scene: Scene,
    script: Script,
    *,
    place: tuple[float, float] = (0.0, 0.0),
    heading: float = 0.0,
    rate_hz: float = RATE_HZ,
) -> Performance:
    """Let a body do a script in a scene, standing at a place [m] and facing a heading [rad].

    Raises:
        PerformanceError: A hand cannot come where it is to be; the message says by how much.
        UnknownNameError: The script names an object that is not there.
    """
    role = Role("performer", human, script, place, heading)
    return perform_together(scene, [role], rate_hz=rate_hz)[role.name]


def perform_together(
    scene: Scene, roles: Sequence[Role], *, rate_hz: float
) -> dict[str, Performance]:
    """Let bodies do their scripts in one scene; in a phase only one of them moves an object.

    Raises:
        PerformanceError: A hand cannot come where it is to be; the message says by how much.
        UnknownNameError: A script names an object that is not there.
    """
    actors = [Actor(role.human, scene, role.place, role.heading) for role in roles]
    _choose_grips(actors, [role.script for role in roles])
    things = dict(actors[0].things)
    for actor in actors:
        actor.things = things
    frames: list[list[Frame]] = [[] for _ in roles]
    phases, start = [], 0.0
    for number, row in enumerate(zip(*(role.script for role in roles), strict=True)):
        for actor, phase in zip(actors, row, strict=True):
            actor.begin(phase)
        count = max(round(row[0].seconds * rate_hz), 2)
        for frame in range(count):
            share = (frame + 1) / count
            left = (1.0 - share) * row[0].seconds
            # Whoever moves something comes first: the others' hands are where it goes.
            for index in sorted(range(len(row)), key=lambda index: not row[index].moves):
                later = roles[index].script[number + 1 : number + 2]
                ahead = later[0] if later and left < LEAD_S and later[0].look else row[index]
                frames[index].append(actors[index].frame(row[index], share, ahead, 1.0 / rate_hz))
        phases.append((row[0].name, start, start + count / rate_hz))
        start += count / rate_hz
    return {
        role.name: _performance(role, scene, found, phases, rate_hz)
        for role, found in zip(roles, frames, strict=True)
    }


def _choose_grips(actors: Sequence["Actor"], scripts: Sequence[Script]) -> None:
    """Choose everybody's grips, on objects as they are when that one comes to take them."""
    for actor, script in zip(actors, scripts, strict=True):
        at_first = dict(actor.things)
        first = next((at for at, phase in enumerate(script) if phase.hands), len(script))
        for row in list(zip(*scripts, strict=True))[:first]:
            for phase in row:
                for name, move in phase.moves.items():
                    actor.things[name] = actor.goal(name, move, actor.things[name])
        actor.choose_grips(script)
        actor.things = at_first


def _performance(
    role: Role,
    scene: Scene,
    frames: Sequence[Frame],
    phases: Sequence[tuple[str, float, float]],
    rate_hz: float,
) -> Performance:
    """The performance that consists of these frames, in which hands hold what they are to hold."""
    postures, things, gazes, slips = zip(*frames, strict=True)
    made = Performance(
        human=role.human,
        scene=scene,
        script=role.script,
        times=np.arange(len(frames)) / rate_hz,
        motion=np.array(postures),
        things={
            name: RigidTransform.concatenate([each[name] for each in things])
            for name in scene.things
        },
        phases=tuple(phases),
        gazes=np.array(gazes),
        looks=tuple(phase.look for phase in role.script),
        slip_m={side: np.array([each[side] for each in slips]) for side in SIDES},
    )
    for phase, (name, start, end) in zip(role.script, phases, strict=True):
        now = (made.times >= start) & (made.times < end)
        for side, hand in phase.hands.items():
            worst = float(made.slip_m[side][now].max())
            if hand.does == "holds" and worst > REACH_TOLERANCE_M:
                raise PerformanceError(
                    f"the {side} hand misses {hand.thing!r} by {worst * 1000:.0f} mm in {name!r}; "
                    "put the thing or the performer nearer, or use another grip"
                )
    return made


class Actor:
    """The inverse kinematics of a performance, and where everything is."""

    def __init__(
        self, human: Human, scene: Scene, place: tuple[float, float], heading: float
    ) -> None:
        self.human, self.scene, self.heading = human, scene, heading
        relaxed = {f"{s}_{n}": float(np.radians(a)) for n, a in RELAXED.items() for s in SIDES}
        self.rest = human.posture(relaxed, place=(*place, 0.0), heading=heading)
        self.configuration = mink.Configuration(human.model)
        self.configuration.update(self.rest)
        self.base = standing_support(human, self.rest)
        self.things = {name: thing.pose for name, thing in scene.things.items()}
        self.grips: dict[tuple[str, str, str], RigidTransform] = {}
        self.palms = {s: mink.FrameTask(f"{s}_palm", "site", *PALM_COST) for s in SIDES}
        self.looks = look_tasks()
        self.tasks = [*self.palms.values(), *self.looks.values(), *self._stance()]
        self.limits = [*joint_limits(human, 0.15), BalanceLimit(self.base)]
        self.home = {side: self.palm(side) for side in SIDES}
        self.mouth = mink.FrameTask("mouth", "site", PALM_COST[0], 0.0)
        self.mouth.set_target_from_configuration(self.configuration)
        self.mouth_at = self._site("mouth").translation
        self.drinks = self.drank = 0.0
        """How firmly the mouth is kept where it is when standing, now and when the phase began."""
        self.phase: Phase | None = None
        self.tilts: dict[str, float] = {}
        """How far things that were at the mouth when the phase began were tilted [rad]."""
        self.look, self.look_at, self.since = "ahead", ("ahead", ""), np.inf
        self.point = self.look_from = self._looked_at("ahead")
        self.starts: dict[str, RigidTransform] = dict(self.home)
        self.thing_starts = dict(self.things)

    def _stance(self) -> list[mink.Task]:
        """Feet stay, the weight stays above them, the posture stays easy."""
        feet = [mink.FrameTask(f"{s}_foot", "body", FOOT_COST, FOOT_COST) for s in SIDES]
        for foot in feet:
            foot.set_target_from_configuration(self.configuration)
        balance = mink.ComTask(cost=[BALANCE_COST, BALANCE_COST, 0.0])
        balance.set_target_from_configuration(self.configuration)
        self.ease = mink.PostureTask(self.human.model, cost=share_costs(self.human, 0.15))
        self.ease.set_target(self.rest)
        edge = BalanceTask(self.base)
        return [*feet, balance, edge, self.ease, mink.DampingTask(self.human.model, cost=0.1)]

    def palm(self, side: str) -> RigidTransform:
        """Where a palm is."""
        return self._site(f"{side}_palm")

    def _site(self, name: str) -> RigidTransform:
        pose = self.configuration.get_transform_frame_to_world(name, "site")
        turn = Rotation.from_quat(pose.rotation().wxyz, scalar_first=True)
        return RigidTransform.from_components(pose.translation(), turn)

    def choose_grips(self, script: Script) -> None:
        """For every hand and thing the grip with which all that the script asks is easiest."""
        wanted = {
            (side, hand.thing, hand.grip)
            for phase in script
            for side, hand in phase.hands.items()
            if hand.thing
        }
        for side, name, kind in sorted(wanted):
            thing = self.scene.thing(name)
            found = grips(thing, side, kind, self.human.measures)
            if thing.round:  # it is taken as seen from where the performer faces
                turn = Rotation.from_euler("z", self.heading - thing.heading)
                found = [RigidTransform.from_rotation(turn) * grip for grip in found]
            moves = [phase.moves[name] for phase in script if name in phase.moves]
            ends = [(self.things[name], False)]
            ends += [(self.goal(name, each, self.things[name]), each.to_mouth) for each in moves]
            least = np.inf
            for grip in found:
                effort = self._effort(side, grip, ends, least)
                if effort < least:
                    least, self.grips[side, name, kind] = effort, grip

    def _effort(
        self, side: str, grip: RigidTransform, ends: list[tuple[RigidTransform, bool]], least: float
    ) -> float:
        """How far the body is from ease with a grip, at worst, or more than another's."""
        worst = 0.0
        for end, drinks in ends:
            self.configuration.update(self.rest)
            self.drinks = float(drinks)
            self.point = self._looked_at("ahead") if drinks else end.translation
            for arm in SIDES:
                self._aim(arm, end * grip if arm == side else self.home[arm])
            for _ in range(GRIP_ITERATIONS):
                self._step()
            palm, goal = self.palm(side), end * grip
            missed = np.linalg.norm(palm.translation - goal.translation) / 0.01
            turned = (palm.rotation.inv() * goal.rotation).magnitude() / 0.1
            bent = self.ease.compute_error(self.configuration)[6:] * self.ease.cost[6:]
            worst = max(worst, float(missed**2 + turned**2 + bent @ bent))
            if worst >= least:
                break
        self.configuration.update(self.rest)
        self.point, self.drinks = self._looked_at("ahead"), 0.0
        return worst

    def begin(self, phase: Phase) -> None:
        """Remember where everything is when a phase begins."""
        self.starts = {side: self.palm(side) for side in SIDES}
        self.thing_starts = dict(self.things)
        self.drank = self.drinks
        moves = self.phase.moves if self.phase else {}
        self.tilts = {name: move.tilt for name, move in moves.items() if move.to_mouth}
        self.phase = phase

    def frame(self, phase: Phase, share: float, looks: Phase, step_s: float) -> Frame:
        """Go on to one frame of a phase, the gaze being in that one or already in the next."""
        way = minimum_jerk(share)
        for name, move in phase.moves.items():
            self.things[name] = self._moved(name, move, way)
            if move.toss is not None:
                by = tossed(move.toss, move.by, phase.seconds, share)
                self.things[name] = RigidTransform.from_translation(by) * self.thing_starts[name]
        drinks = any(move.to_mouth for move in phase.moves.values())
        held = way if drinks else minimum_jerk(share * max(phase.seconds / RELEASE_S, 1.0))
        self.drinks = self.drank + held * (float(drinks) - self.drank)
        goals = {side: self._hand_goal(side, phase, share) for side in SIDES}
        self._gaze(looks, step_s)
        for side, goal in goals.items():
            self._aim(side, goal)
        for _ in range(ITERATIONS):
            self._step()
        slip = {
            s: float(np.linalg.norm(self.palm(s).translation - goal.translation))
            for s, goal in goals.items()
        }
        return np.array(self.configuration.q), dict(self.things), self.point, slip

    def _moved(self, name: str, move: Move, way: float) -> RigidTransform:
        """Where an object is part of the way; one that is at the mouth turns about its rim."""
        start = self.thing_starts[name]
        if move.to_mouth and name in self.tilts:
            tilt = self.tilts[name] + way * (move.tilt - self.tilts[name])
            return self.goal(name, replace(move, tilt=tilt), start)
        if any(move.about):
            part = Rotation.from_rotvec(way * np.array(move.turn))
            return turned_about(start, move.about, part)
        arc = [0.0, 0.0, move.lift * 4.0 * way * (1.0 - way)]
        pose = between(start, self.goal(name, move, start), way)
        return RigidTransform.from_translation(arc) * pose

    def goal(self, name: str, move: Move, start: RigidTransform) -> RigidTransform:
        """Where an object goes; to the mouth as it is when standing, at which the head is held."""
        if move.home:
            return self.scene.thing(name).pose
        if any(move.about):
            return turned_about(start, move.about, Rotation.from_rotvec(move.turn))
        if not move.to_mouth:
            turned = Rotation.from_rotvec(move.turn) * start.rotation
            return RigidTransform.from_components(start.translation + np.array(move.by), turned)
        thing = self.scene.thing(name)
        ahead = Rotation.from_euler("z", self.heading)
        turn = ahead * Rotation.from_euler("y", -move.tilt) * ahead.inv() * thing.pose.rotation
        rim = np.array([thing.shape.bounds[0, 0], 0.0, thing.shape.bounds[1, 2]])
        local = thing.pose.rotation.inv() * ahead
        spot = self.mouth_at - turn.apply(local.apply(rim))
        return RigidTransform.from_components(spot, turn)

    def _hand_goal(self, side: str, phase: Phase, share: float) -> RigidTransform:
        """Where a palm is to be: first up, then forward; on the way back the other way round."""
        hand, start = phase.hand(side), self.starts[side]
        if hand.does == "lets_go":
            past = min(share * phase.seconds, FOLLOW_S)  # it slows down evenly until it stops
            by = np.array(hand.velocity) * (past - 0.5 * past**2 / FOLLOW_S)
            return RigidTransform.from_translation(by) * start
        if hand.does == "rests":
            goal = self.home[side]
            outside = -start.rotation.apply([0.0, 0.0, 1.0])
            over, way = minimum_jerk(share / OVER), minimum_jerk((share - 1.0 + UP) / UP)
            back = 1.0 - over
        else:
            thing = self.things[hand.thing]
            if hand.does == "awaits":
                spot = np.array(self.scene.thing(hand.thing).place) + hand.awaited
                thing = RigidTransform.from_components(spot, thing.rotation)
            goal = thing * self.grips[side, hand.thing, hand.grip]
            if hand.does == "holds":
                return goal
            outside = -goal.rotation.apply([0.0, 0.0, 1.0])
            over, way = minimum_jerk((share - 1.0 + OVER) / OVER), minimum_jerk(share / UP)
            back = over
        far = min(float(np.linalg.norm(goal.translation - start.translation)) / 0.3, 1.0)
        bump = 6.75 * back * back * (1.0 - back) * STANDOFF_M * outside
        bump = bump + np.array([0.0, 0.0, 4.0 * over * (1.0 - over) * RISE_M])
        spot = between(start, goal, over)
        lag = [0.0, 0.0, (way - over) * float((goal.translation - start.translation)[2])]
        return RigidTransform.from_translation(far * bump + lag) * spot

    def _looked_at(self, look: str) -> np.ndarray:
        if look in self.things:
            thing = self.scene.thing(look)
            return self.things[look].apply([0.0, 0.0, 0.5 * thing.size[2]])
        ahead = Rotation.from_euler("z", self.heading).apply([3.0, 0.0, 0.0])
        height = self.human.measures["eye_height"] - 0.25
        return np.array([*self.rest[:2], 0.0]) + ahead + [0.0, 0.0, height]

    def _gaze(self, phase: Phase, step_s: float) -> None:
        """Shift the point looked at quickly, then keep it; of a moved thing, where it goes to."""
        if self.drinks > 0.02:  # with a cup at the mouth the head does not bend to what is below
            return
        goal = self._looked_at(phase.look or self.look)
        move = phase.moves.get(phase.look)
        if move is not None:
            start = self.thing_starts[phase.look]
            goal = goal - self.things[phase.look].translation
            goal = goal + self.goal(phase.look, move, start).translation
        if (phase.look or self.look, phase.name) != self.look_at:
            self.look, self.look_at = phase.look or self.look, (phase.look or self.look, phase.name)
            self.since, self.look_from = 0.0, self.point
        self.since += step_s
        self.point = self.look_from + minimum_jerk(self.since / SHIFT_S) * (goal - self.look_from)

    def _aim(self, side: str, goal: RigidTransform) -> None:
        turn = goal.rotation.as_quat(scalar_first=True)
        self.palms[side].set_target(mink.SE3(np.concatenate([turn, goal.translation])))

    def _step(self) -> None:
        for task in self.looks.values():
            task.set_target(self.point)
        self.mouth.set_position_cost(PALM_COST[0] * self.drinks)
        tasks = [*self.tasks, self.mouth] if self.drinks > 0.0 else self.tasks
        velocity = mink.solve_ik(self.configuration, tasks, 1.0, "daqp", limits=self.limits)
        self.configuration.integrate_inplace(velocity, 1.0)
