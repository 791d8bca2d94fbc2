"""Short trials of hands and feet that meet things and bodies fast, softly or in flight."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Unpack

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.model.capture import TagType
from motions import figure, shapes
from motions.paths import Move, Moves, Path, Riding, Still, Vector, aimed, pose
from motions.performers import Performer
from motions.trials import Body, Options, Sampling, Script, Trial, Truth, record

GRAVITY = 9.81
BALL = 0.04
"""Radius [m]."""

FOOT = (0.26, 0.10, 0.08)
LEFT, RIGHT = "left_hand", "right_hand"
UP = (0.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Flight:
    """Constant acceleration from rest to a speed, free fall from then on, and rest where it ends.

    Played backwards it is what is caught: it falls, is slowed down at an even rate, and rests.
    """

    begin: RigidTransform
    velocity: Vector
    """When it is let go [m/s]."""

    start_s: float
    let_go_s: float
    lands_s: float
    gravity: float = GRAVITY

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        swing = self.let_go_s - self.start_s
        velocity = np.asarray(self.velocity)
        t = np.clip(times - self.start_s, 0.0, swing)[:, None]
        fallen = np.clip(times, self.let_go_s, self.lands_s)[:, None] - self.let_go_s
        way = velocity * t**2 / (2.0 * swing) + velocity * fallen
        way[:, 2] -= 0.5 * self.gravity * fallen[:, 0] ** 2
        turn = np.tile(self.begin.rotation.as_quat(), (len(times), 1))
        rotation = type(self.begin.rotation).from_quat(turn)
        return RigidTransform.from_components(self.begin.translation + way, rotation)


@dataclass(frozen=True, eq=False)
class Backwards:
    """A path played from its end to its beginning."""

    own: Path
    duration_s: float

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        return self.own.at(self.duration_s - times)


def throw(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A ball in the hand is thrown forward and up, and lands on the ground."""
    start, let_go, end = 0.8, 1.1, 3.4
    begin = pose((0.35, -0.2, 0.65 * performer.stature_m))
    ball, stopped = _thrown(performer, begin, start, let_go, end)
    last = stopped.at(np.array([end]))[0]
    home = Move(let_go + 0.15, let_go + 1.25, last, figure.hanging(performer, RIGHT))
    hand = Riding(stopped, Moves((home,)), pose((0.0, 0.0, 0.0)), home.start_s)
    bodies = (
        figure.hand_body(performer, RIGHT, hand),
        Body("ball", ball, shapes.ball(BALL), TagType.MOBILE, mass_kg=0.1),
        _ground(),
    )
    return _trial("throw", performer, bodies, end, {RIGHT: ("Touch", "Throw", "Withdraw")}, options)


def catch(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A ball flies to a hand that waits for it, gives way, and holds it."""
    start, let_go, end = 0.8, 1.1, 1.6
    begin = pose((0.35, -0.2, 0.65 * performer.stature_m))
    ball, hand = _thrown(performer, begin, start, let_go, end)
    bodies = (
        figure.hand_body(performer, RIGHT, Backwards(hand, end)),
        Body("ball", Backwards(ball, end), shapes.ball(BALL), TagType.MOBILE, mass_kg=0.1),
        _ground(),
    )
    return _trial("catch", performer, bodies, end, {RIGHT: ("Catch", "Lower", "Touch")}, options)


def _thrown(
    performer: Performer, begin: RigidTransform, start: float, let_go: float, end: float
) -> tuple[Path, Path]:
    """A ball and the palm that throws it, which stops as soon as it can and stays there."""
    velocity = (1.2, 0.0, 2.4)
    height = float(begin.translation[2]) + velocity[2] * (let_go - start) / 2.0 - BALL
    flight = (velocity[2] + np.sqrt(velocity[2] ** 2 + 2.0 * GRAVITY * height)) / GRAVITY
    ball = Flight(begin, velocity, start, let_go, min(let_go + float(flight), end))
    below = pose(
        begin.translation - np.array([0.0, 0.0, BALL - figure.GRIP_DEPTH]),
        aimed(x=(1.0, 0.0, 0.0), z=(0.0, 0.0, -1.0)),
    )
    there = Flight(below, velocity, start, let_go, let_go).at(np.array([let_go]))[0]
    stop = 0.12
    slower = Moves(
        (
            Move(0.0, let_go, below, there),
            Move(let_go, let_go + stop, there, there),
        )
    )
    hand = Riding(
        _Stopping(slower, there, velocity, let_go, stop),
        Flight(below, velocity, start, let_go, let_go),
        pose((0.0, 0.0, 0.0)),
        0.0,
        let_go,
    )
    return ball, hand


@dataclass(frozen=True, eq=False)
class _Stopping:
    """From a speed to rest at an even rate."""

    own: Path
    place: RigidTransform
    velocity: Vector
    start_s: float
    seconds: float

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        t = np.clip(times - self.start_s, 0.0, self.seconds)[:, None]
        way = np.asarray(self.velocity) * (t - t**2 / (2.0 * self.seconds))
        turn = np.tile(self.place.rotation.as_quat(), (len(times), 1))
        rotation = type(self.place.rotation).from_quat(turn)
        return RigidTransform.from_components(self.place.translation + way, rotation)


def clap(performer: Performer, **options: Unpack[Options]) -> Trial:
    """Two hands are raised, meet palm to palm, and part."""
    met, end = 1.2 * performer.pace, 3.2 * performer.pace
    paths = {}
    for name in (RIGHT, LEFT):
        out = figure.side(name)
        apart = out * (figure.thickness(performer) - 0.003)
        goal = pose(
            (0.35, apart, 0.7 * performer.stature_m), aimed(x=(1.0, 0.0, 0.0), z=(0.0, out, 0.0))
        )
        paths[name] = Moves(
            (
                figure.reach(performer, name, goal=goal, arrive=(0.05, -0.2 * out, 0.02),
                             start_s=0.1, end_s=met),
                figure.withdraw(performer, name, begin=goal, depart=(-0.05, 0.2 * out, 0.0),
                                start_s=met, end_s=end - 0.8),
            )
        )  # fmt: skip
    bodies = tuple(
        Body(name, path, shapes.hand(performer.size), TagType.SELF, f"{name.split('_')[0]}_arm")
        for name, path in paths.items()
    )
    steps = ("Clap", "ResumePosture")
    return _trial("clap", performer, bodies, end, {RIGHT: steps, LEFT: steps}, options)


def salute(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A hand is raised to the brow, stays there, and goes back.

    The tall man's head is higher than it is when he stands (POSSIBLE.md).
    """
    met = 1.2 * performer.pace
    leaves, home = met + 0.9, met + 0.9 + 1.2 * performer.pace
    head = Still(pose((0.06, 0.0, performer.stature_m - shapes.HEAD[2])))
    place = np.array([0.06, 0.0, performer.stature_m - shapes.HEAD[2]])
    aside = -(shapes.HEAD[1] + figure.thickness(performer) - figure.GRIP_DEPTH)
    goal = pose(place + np.array([0.0, aside, 0.0]), aimed(x=UP, z=(0.0, -1.0, 0.0)))
    hand = Moves(
        (
            figure.reach(performer, RIGHT, goal=goal, arrive=(0.0, 0.25, 0.05), start_s=0.1,
                         end_s=met),
            figure.withdraw(performer, RIGHT, begin=goal, depart=(0.0, -0.25, -0.05),
                            start_s=leaves, end_s=home),
        )
    )  # fmt: skip
    bodies = (
        figure.hand_body(performer, RIGHT, hand),
        figure.head_body(head, tag=TagType.SELF),
    )
    steps = {RIGHT: ("Salute", "TouchOneself", "ResumePosture")}
    return _trial("salute", performer, bodies, home + 0.8, steps, options)


@dataclass(frozen=True, eq=False)
class Kicked:
    """A ball that lies, is taken along by a foot for a moment, and rolls off faster."""

    foot: Path
    begin: Vector
    start_s: float
    free_s: float
    speed_mps: float

    def at(self, times: Float[np.ndarray, "frames"]) -> RigidTransform:
        """``T_world_body`` at each time [s]."""
        inside = np.clip(times, self.start_s, self.free_s)
        came = float(self.foot.at(np.array([self.start_s])).translation[0, 0])
        way = self.foot.at(inside).translation[:, 0] - came
        way = way + self.speed_mps * np.clip(times - self.free_s, 0.0, None)
        place = np.asarray(self.begin) + way[:, None] * np.array([1.0, 0.0, 0.0])
        return RigidTransform.from_translation(place)


def kick(performer: Performer, *, pushes_s: float = 0.08, **options: Unpack[Options]) -> Trial:
    """A foot is swung against a ball on the ground, pushes it for a moment, and it rolls off."""
    begin, struck, end = 0.4, 0.72, 2.4
    swing = Move(begin, 2 * struck - begin, pose((-0.35, -0.1, 0.03)), pose((0.55, -0.1, 0.03)))
    path = Moves((swing,))
    there = (0.1 + FOOT[0] / 2.0 + BALL - 0.001, -0.1, BALL)
    ball = Kicked(path, there, struck, struck + pushes_s, 4.0)
    bodies = (
        Body("right_foot", path, shapes.box(*FOOT), link="right_leg"),
        Body("ball", ball, shapes.ball(BALL), TagType.MOBILE, mass_kg=0.4),
        _ground(),
    )
    return _trial("kick", performer, bodies, end, {"right_foot": ("Kick", "Withdraw")}, options)


def step(performer: Performer, **options: Unpack[Options]) -> Trial:
    """A foot that stands on the ground is lifted, set down further on, and stands there."""
    leaves, lands = 0.8, 0.8 + 0.7 * performer.pace
    there = pose((0.6, -0.1, 0.0))
    move = Move(
        leaves, lands, pose((0.0, -0.1, 0.0)), there, depart=(0.1, 0.0, 0.25),
        arrive=(0.1, 0.0, -0.2), launch_mps2=figure.FIRM_MPS2, halt_mps2=figure.FIRM_MPS2,
    )  # fmt: skip
    foot = Body("right_foot", Moves((move,)), shapes.box(*FOOT), link="right_leg")
    steps = {"right_foot": ("Stand", "Step", "Stand")}
    return _trial("step", performer, (foot, _ground()), lands + 0.8, steps, options)


def _ground() -> Body:
    where = pose((0.5, 0.0, 0.0))
    return Body("ground", Still(where), shapes.table(6.0, 4.0), TagType.FIXED, noisy=False)


def _trial(
    name: str,
    performer: Performer,
    bodies: tuple[Body, ...],
    end_s: float,
    steps: Mapping[str, tuple[str, ...]],
    options: Options,
) -> Trial:
    truth = Truth(end_s, (), {"extended": steps}, {})
    return record(Script(name, performer, truth, bodies), Sampling(**options))


ENCOUNTERS: tuple[Callable[..., Trial], ...] = (throw, catch, clap, salute, kick, step)
