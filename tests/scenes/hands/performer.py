"""A hand that performs: each call moves it on in time, and each step is written down as it ends."""

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation, Slerp

from scenes.hands.paths import (
    Body,
    Piece,
    Poses,
    Times,
    Vector,
    bezier,
    facing,
    min_jerk,
    pose,
    quintic,
)
from scenes.hands.shapes import Form
from scenes.hands.things import Step, Thing

PRESS = 0.001
"""How far a palm is pressed into what it touches [m]."""

LEAD = 0.1
"""Length of the straight ways to and from a contact, in units of a curve's control points [m]."""

EASE = 0.12
"""Speed at which a hand meets or leaves what it touches gently [m/s]."""

USUAL_M_S = 1.45
"""A hand that reaches or goes home is no faster [m/s]."""

GRAVITY = 9.81
"""Acceleration of what flies freely [m/s2]."""

SLOWING_S = 0.12
"""How long a hand needs to stop after a throw [s]."""


@dataclass
class Hand:
    """An acting hand: where it is until its clock, and the steps that it has done."""

    body: Body
    side: str
    form: Form
    home: np.ndarray
    clock: float = 0.0
    border: float = 0.0
    """Where the step under way began [s]."""

    steps: list[Step] = field(default_factory=list)
    alternative: tuple[Step, ...] = ()
    contacts: list[tuple[Thing, float, float]] = field(default_factory=list)
    """What it touched, from when to when [s]."""

    touched: Thing | None = None
    since: float = 0.0
    held: list[Piece] = field(default_factory=list)
    member: str = "hand"
    agent: str = ""

    @classmethod
    def at_home(cls, name: str, side: str, form: Form, place: Vector) -> "Hand":
        """A hand at its home posture: palm towards the other hand, fingers forward."""
        inward = (0.0, 1.0, 0.0) if side == "right" else (0.0, -1.0, 0.0)
        home = pose(place, facing(inward, (1.0, 0.0, 0.0)))
        return cls(Body(name, home), side, form, home)

    @property
    def name(self) -> str:
        """Its sensor's name."""
        return self.body.name

    @property
    def now(self) -> np.ndarray:
        """Its pose at its clock."""
        return self.body.at(self.clock)

    @property
    def touches(self) -> list[tuple[Thing, float, float]]:
        """What it touched, from when to when [s], what it still touches included."""
        still = [(self.touched, self.since, self.clock)] if self.touched else []
        return [*self.contacts, *still]

    def step(self, name: str, *objects: "Thing | Hand") -> None:
        """Write down that the step under way, about things or hands, ends now."""
        done = Step(name, tuple(each.name for each in objects), self.border, self.clock)
        self.steps.append(done)
        self.border = self.clock

    def idle(self, duration: float) -> None:
        """Stay, as part of whatever step comes next."""
        self.clock += duration

    def until(self, time: float) -> None:
        """Stay until a time [s]."""
        self.clock = max(self.clock, time)

    def hold(self, duration: float, *objects: Thing) -> None:
        """Stay and touch: Touch of one thing, TouchWith of two."""
        self.clock += duration
        self.step("Touch" if len(objects) == 1 else "TouchWith", *objects)

    def rest(self, duration: float) -> None:
        """Stay in the air, as a step of its own."""
        self.clock += duration
        self.step("Rest")

    def place(
        self,
        thing: Thing,
        side: str,
        *,
        up: float,
        fingers: Vector,
        along: float = 0.0,
        when: float | None = None,
    ) -> np.ndarray:
        """The pose in which it touches a site of a thing, so far along its fingers [m]."""
        point, out = thing.site(side, up, self.clock if when is None else when)
        turned = facing(-out, fingers)
        return pose(point - PRESS * out - along * turned.as_matrix()[:, 1], turned)

    def begin_at(
        self,
        thing: Thing,
        side: str,
        *,
        up: float,
        fingers: Vector,
        aside: Vector = (0.0, 0.0, 0.0),
    ) -> None:
        """Touch a thing at the first frame already."""
        self.body.first = self.place(thing, side, up=up, fingers=fingers)
        self.body.first[:3, 3] += aside
        self.meet(thing)

    def reach(
        self,
        thing: Thing,
        side: str,
        duration: float,
        *,
        up: float = 0.5,
        fingers: Vector = (1.0, 0.0, 0.0),
        speed: float = EASE,
        name: str = "Reach",
        others: tuple[Thing, ...] = (),
        along: float = 0.0,
        aside: Vector = (0.0, 0.0, 0.0),
        when: float | None = None,
        hold: float = 0.0,
    ) -> None:
        """Go and touch a site of a thing, or a point so far beside it [m], where it will be."""
        goal = self.place(thing, side, up=up, fingers=fingers, along=along, when=when)
        goal[:3, 3] += aside
        self.fly(goal, duration, arrive=speed)
        self.meet(thing)
        self.step(name, thing, *others)
        if hold:
            self.hold(hold, thing)

    def leave(
        self,
        duration: float,
        *,
        to: Vector | None = None,
        name: str = "ResumePosture",
        speed: float = EASE,
    ) -> None:
        """Let go of what it touches and go home, or to another place."""
        thing = self.let_go()
        self.fly(self._goal(to), duration, depart=speed)
        self.step(name, thing)

    def leave_to_reach(
        self, thing: Thing, side: str, duration: float, *, up: float = 0.5, fingers: Vector
    ) -> None:
        """Go from what it touches straight to another thing."""
        before = self.let_go()
        goal = self.place(thing, side, up=up, fingers=fingers)
        self.fly(goal, duration, arrive=EASE, depart=EASE)
        self.meet(thing)
        self.step("Reach", thing, before)

    def go_without_step(self, to: Vector, duration: float) -> None:
        """Move through the air from rest to rest, as part of the next step."""
        self.fly(self._goal(to), duration)

    def hold_oneself(self, duration: float, part: Thing) -> None:
        """Stay and touch a part of the own body."""
        self.clock += duration
        self.step("TouchOneself", part)

    def go(self, to: Vector | None, duration: float, *, name: str = "PostureChange") -> None:
        """Move through the air from rest to rest, home or to another place."""
        self.fly(self._goal(to), duration)
        self.step(name)

    def let_go(self) -> Thing:
        """End the contact and whatever rides in it now."""
        if self.touched is None:
            raise ValueError(f"{self.name} touches nothing at {self.clock} s")
        thing, self.touched = self.touched, None
        self.contacts.append((thing, self.since, self.clock))
        self.release()
        return thing

    def meet(self, thing: Thing) -> None:
        """Touch a thing from now on."""
        self.touched, self.since = thing, self.clock

    def _goal(self, to: Vector | None) -> np.ndarray:
        return self.home if to is None else pose(to, Rotation.from_matrix(self.home[:3, :3]))

    def take(self, *things: Thing) -> None:
        """Carry things along from now on; the first is what it touches, others ride on that."""
        carrier = self.body
        for thing in things:
            self.held.append(thing.body.ride(carrier, self.clock))
            carrier = things[0].body

    def take_along(self, carrier: Thing, *things: Thing) -> None:
        """Let what it holds move other things along from now on."""
        self.held.extend(each.body.ride(carrier.body, self.clock) for each in things)

    def release(self) -> None:
        """Carry nothing from now on."""
        for piece in self.held:
            piece.end = self.clock
        self.held = []

    def fly(
        self, goal: np.ndarray, duration: float, *, arrive: float = 0.0, depart: float = 0.0
    ) -> None:
        """Move to a pose along a curve; with a speed [m/s] it leaves or meets a surface.

        It takes longer than told if the hand would be hurried otherwise.
        """
        start = self.now
        first, last = start[:3, 3], goal[:3, 3]
        back, ahead = -start[:3, 0], goal[:3, 0]
        leads_out = [first + LEAD * back, first + 2 * LEAD * back] if depart else []
        leads_in = [last - 2 * LEAD * ahead, last - LEAD * ahead] if arrive else []
        free = 4 - len(leads_out) - len(leads_in)
        ways = np.linspace(0.0, 1.0, max(free, 1) + 1)[1:-1]
        before = (leads_out or [first])[-1]
        after = (leads_in or [last])[0]
        between = [before + way * (after - before) for way in ways]
        controls = np.array([first, *leads_out, *between, *leads_in, last])
        duration = max(duration, 0.0 if arrive > EASE else _unhurried(controls))
        slope = duration / ((len(controls) - 1) * LEAD)
        turns = Slerp([0.0, 1.0], Rotation.from_matrix([start[:3, :3], goal[:3, :3]]))

        def law(since: Times) -> Poses:
            share = since / duration
            out = np.tile(np.eye(4), (len(since), 1, 1))
            way = np.clip(quintic(share, depart * slope, arrive * slope), 0.0, 1.0)
            out[:, :3, 3] = bezier(way, controls)
            late = 0.35 if depart else 0.0
            span = 0.65 if arrive or depart else 1.0
            out[:, :3, :3] = turns(min_jerk((share - late) / span)).as_matrix()
            return out

        self.body.play(self.clock, self.clock + duration, law)
        self.clock += duration

    def move(
        self, by: Vector, duration: float, *, depart: float = 0.0, arrive: float = 0.0
    ) -> None:
        """Move straight by a displacement [m], from and to rest or with a speed [m/s]."""
        way = np.array(by, dtype=float)
        slope = duration / float(np.linalg.norm(way))
        end = self.clock + duration
        self.body.shift(
            self.clock,
            end,
            lambda since: np.outer(quintic(since / duration, depart * slope, arrive * slope), way),
        )
        self.clock = end

    def spin(self, point: Vector, axis: Vector, angle_deg: float, duration: float) -> None:
        """Turn about an axis from rest to rest."""
        angle = np.radians(angle_deg)
        end = self.clock + duration
        self.body.turn(
            self.clock, end, point, axis, lambda since: angle * min_jerk(since / duration)
        )
        self.clock = end

    def dip(self, point: Vector, axis: Vector, angle_deg: float, duration: float) -> None:
        """Turn about an axis and back again, without a halt between."""
        angle = np.radians(angle_deg)
        end = self.clock + duration
        self.body.turn(
            self.clock,
            end,
            point,
            axis,
            lambda since: angle * (1.0 - np.cos(2.0 * np.pi * since / duration)) / 2.0,
        )
        self.clock = end

    def swing(self, by: Vector, rate_hz: float, cycles: int) -> None:
        """Swing to one side and back several times, starting and ending in place."""
        way = np.array(by, dtype=float)
        duration = cycles / rate_hz

        def law(since: Times) -> np.ndarray:
            fade = np.clip(np.minimum(since, duration - since) * 2.0 * rate_hz, 0.0, 1.0)
            return np.outer(min_jerk(fade) * np.sin(2.0 * np.pi * rate_hz * since), way)

        self.body.shift(self.clock, self.clock + duration, law)
        self.clock += duration

    def circle(self, radius: float, rate_hz: float, cycles: int) -> None:
        """Go round a level circle several times, starting and ending in place."""
        duration = cycles / rate_hz

        def law(since: Times) -> np.ndarray:
            angle = 2.0 * np.pi * cycles * min_jerk_flat(since / duration)
            round_ = [np.cos(angle) - 1.0, np.sin(angle), 0.0 * angle]
            return radius * np.stack(round_, axis=1)

        self.body.shift(self.clock, self.clock + duration, law)
        self.clock += duration

    def hop(self, height: float, by: Vector, duration: float) -> float:
        """Move aside by an arc, up and down again; tells when it is highest [s]."""
        way = np.array(by, dtype=float)

        def law(since: Times) -> np.ndarray:
            done = min_jerk(since / duration)
            out = np.outer(done, way)
            out[:, 2] += height * 16.0 * done**2 * (1.0 - done) ** 2
            return out

        self.body.shift(self.clock, self.clock + duration, law)
        highest = self.clock + duration / 2.0
        self.clock += duration
        return highest

    def over(
        self,
        up: float,
        by: Vector,
        down: float,
        *,
        times: tuple[float, float, float] = (0.7, 0.9, 0.7),
        overlap: float = 0.35,
    ) -> tuple[float, float]:
        """Rise, go aside and sink without a halt between.

        Returns:
            When it goes aside as fast as it rises, and when it sinks as fast as it goes aside [s].
        """
        rise, aside, sink = times
        second = rise - overlap * rise
        third = second + aside - overlap * sink
        duration = third + sink
        way = np.array([*by, 0.0])[:3]

        def law(since: Times) -> np.ndarray:
            out = np.outer(min_jerk((since - second) / aside), way)
            out[:, 2] += up * min_jerk(since / rise) - down * min_jerk((since - third) / sink)
            return out

        self.body.shift(self.clock, self.clock + duration, law)
        flatness = float(np.linalg.norm(way))

        def steepness(time: float) -> float:
            rate = [
                abs(up * _speed(time / rise) / rise - down * _speed((time - third) / sink) / sink),
                flatness * _speed((time - second) / aside) / aside,
            ]
            return rate[0] - rate[1]

        first = brentq(steepness, second + 1e-3, rise - 1e-3)
        last = brentq(steepness, third + 1e-3, second + aside - 1e-3)
        start = self.clock
        self.clock += duration
        return start + first, start + last

    def lift_carry_lower(
        self,
        thing: Thing,
        goal: Thing,
        *,
        up: float,
        by: Vector,
        down: float,
        times: tuple[float, float, float] = (0.7, 0.9, 0.7),
    ) -> None:
        """Take what it touches over to a goal in one sweep of three steps."""
        borders = self.over(up, by, down, times=times)
        end = self.clock
        for border, name in zip(borders, ("Lift", "Carry"), strict=True):
            self.clock = border
            self.step(name, thing)
        self.clock = end
        self.step("Lower", thing, goal)

    def throw(self, thing: Thing, velocity: Vector, swing_s: float, flight_s: float) -> None:
        """Throw what lies on it; it flies freely for a while, the hand slows down."""
        goal = np.asarray(velocity, dtype=float)

        def speed_up(since: Times) -> np.ndarray:
            share = since / swing_s
            return np.outer(swing_s * (share**3 - share**4 / 2.0), goal)

        def slow_down(since: Times) -> np.ndarray:
            share = since / SLOWING_S
            return np.outer(SLOWING_S * (1.0 - (1.0 - share) ** 3) / 3.0, goal)

        def fall(since: Times) -> np.ndarray:
            return np.outer(since, goal) - np.outer(since**2, (0.0, 0.0, GRAVITY / 2.0))

        self.body.shift(self.clock, self.clock + swing_s, speed_up)
        self.clock += swing_s
        self.step("Throw", thing)
        self.let_go()
        thing.body.shift(self.clock, self.clock + flight_s, fall)
        thing.free.append((self.clock, self.clock + flight_s))
        self.body.shift(self.clock, self.clock + SLOWING_S, slow_down)
        self.clock += SLOWING_S

    def join(self, thing: Thing) -> None:
        """Stay on a thing that another hand moves, from now on."""
        self.held.append(self.body.ride(thing.body, self.clock))

    def part(self, other: "Hand", since: int) -> None:
        """Stop staying on it, and take over the steps that the other hand did meanwhile."""
        self.clock = other.clock
        self.release()
        self.steps.extend(other.steps[since:])
        self.border = self.clock


def min_jerk_flat(share: Times) -> Times:
    """Way done from 0 to 1 with a short gentle start and end and an even pace between."""
    tau = np.clip(share, 0.0, 1.0)
    ramp = 0.1
    even = 1.0 / (1.0 - ramp)
    start = even * tau**2 / (2.0 * ramp)
    end = 1.0 - even * (1.0 - tau) ** 2 / (2.0 * ramp)
    middle = even * (tau - ramp / 2.0)
    return np.asarray(np.where(tau < ramp, start, np.where(tau > 1.0 - ramp, end, middle)))


def _unhurried(controls: np.ndarray) -> float:
    """How long a curve takes at least if the hand keeps below the usual speed [s]."""
    share = np.linspace(0.0, 1.0, 201)
    places = bezier(min_jerk(share), controls)
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).max() * 200.0 / USUAL_M_S)


def _speed(share: float) -> float:
    tau = min(max(share, 0.0), 1.0)
    return 30.0 * tau**2 * (1.0 - tau) ** 2


def travel(
    hand: Hand,
    name: str,
    by: Vector,
    duration: float,
    *things: Thing,
    depart: float = 0.0,
    arrive: float = 0.0,
    hold: float = 0.0,
) -> None:
    """One step straight from and to rest or with a speed [m/s], and a hold if that has a time."""
    hand.move(by, duration, depart=depart, arrive=arrive)
    hand.step(name, *things)
    if hold:
        hand.hold(hold, *things)
