"""Scenes in which a ball is kicked."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from scenes.hands import shapes
from scenes.hands.expectation import Step
from scenes.hands.paths import Poses, Times, about, quintic
from scenes.hands.scene import performer
from scenes.hands.things import Thing
from scenes.people.body import Person
from scenes.people.limbs import Limb
from scenes.people.person import person
from scenes.people.registry import scene
from scenes.people.scenes_steps import quiet_end
from scenes.people.stage import PeopleStage


def kick(s: PeopleStage, p: Person, side: str, *, lift: float, speed: float) -> None:
    """A foot swings at a ball that lies before it, and is set down where it stood."""
    s.contact_minimum_s = 0.0
    foot, radius, duration, contact = p.feet[side], 0.11, 0.5, 0.02
    first = foot.body.first.copy()
    rise, way = 0.05, 0.38 * p.size
    toe, high = 0.17 * p.size, rise + 0.045 * p.size
    reach = float(np.sqrt(radius**2 - max(radius - high, 0.0) ** 2))
    spot = first[:3, 3] + p.heading @ np.array([way + toe + reach - 0.001, 0.0, 0.0])
    ball = s.put("ball", shapes.ball(radius), (spot[0], spot[1], radius))
    foot.clock = lift
    foot.let_go()
    foot.step("Stand", s.floor)

    def swing(since: Times) -> Poses:
        out = np.tile(first, (len(since), 1, 1))
        share = since / duration
        done = quintic(share, 0.0, speed * duration / way)
        out[:, :3, 3] += np.outer(way * done, p.heading[:, 0])
        out[:, 2, 3] += rise * quintic(np.clip(share / 0.7, 0.0, 1.0), 0.0, 0.0)
        return out

    foot.body.play(lift, lift + duration, swing)
    foot.clock = lift + duration
    foot.step("Kick", ball, s.floor)
    roll_off(p, ball, foot.clock, contact, speed, radius)
    foot.meet(ball)
    foot.join(ball)
    foot.held[-1].law = straight(foot, p, foot.clock, contact, speed)
    foot.clock += contact
    foot.let_go()
    come_back(p, foot, first, speed, 0.9)
    foot.step("Step", s.floor, ball)
    p.clock = foot.clock


def straight(
    foot: Limb, p: Person, start: float, contact: float, speed: float
) -> Callable[[Times], Poses]:
    """The foot's way while it pushes the ball."""
    base = foot.body.poses(np.array([start - 1e-9]))[0]

    def law(times: Times) -> Poses:
        since = np.clip(times - start, 0.0, contact)
        out = np.tile(base, (len(times), 1, 1))
        out[:, :3, 3] += np.outer(speed * since, p.heading[:, 0])
        return out

    return law


def roll_off(
    p: Person, ball: Thing, start: float, contact: float, speed: float, radius: float
) -> None:
    """The ball is pushed for a moment and rolls on, slower and slower."""
    base, brake = ball.body.at(start), 0.8
    ahead, aside = p.heading[:, 0], p.heading[:, 1]

    def law(since: Times) -> Poses:
        late = np.clip(since, 0.0, speed / brake)
        way = speed * late - brake * late**2 / 2.0
        out = about(base[:3, 3], aside, way / radius) @ base
        out[:, :3, 3] += np.outer(way, ahead)
        return np.asarray(out)

    ball.body.play(start, start + speed / brake, law)
    ball.free.append((start, start + speed / brake))


def come_back(p: Person, foot: Limb, first: np.ndarray, speed: float, duration: float) -> None:
    """The foot swings on a little and returns to where it stood."""
    start, begin = foot.now, foot.clock
    way = float((start - first)[:3, 3] @ p.heading[:, 0])

    def law(since: Times) -> Poses:
        share = since / duration
        out = np.tile(first, (len(since), 1, 1))
        slope = -speed * duration / way
        done = quintic(share, slope, 0.0)
        out[:, :3, 3] += np.outer(way * (1.0 - done), p.heading[:, 0])
        late = quintic(np.clip((share - 0.4) / 0.6, 0.0, 1.0), 0.0, 0.0)
        out[:, 2, 3] += (start - first)[2, 3] * (1.0 - late)
        return out

    foot.body.play(begin, begin + duration, law)
    foot.clock += duration
    foot.meet(p.stage.floor)


def stand_while_kicking(p: Person, side: str, lift: float) -> None:
    """The other foot bears all while one is off the floor."""
    other = p.feet["left" if side == "right" else "right"]
    other.clock = lift
    other.step("Stand", p.stage.floor)
    other.clock = p.clock
    other.step("StandOnOneLeg", p.stage.floor)
    other.alternative = (Step("Stand", ("floor",), 0.0, p.clock + 0.9),)
    foot = p.feet[side]
    alone = [replace(each, objects=each.objects[:1]) for each in foot.steps]
    foot.alternative = (*alone, Step("Stand", ("floor",), foot.clock, foot.clock + 0.9))


@scene
def kick_a_ball(s: PeopleStage) -> None:
    """The right foot kicks a ball, which rolls away, and is set down again."""
    performer(s, yaw_deg=-60)
    p = person(s, hang=True)
    kick(s, p, "right", lift=0.8, speed=1.8)
    stand_while_kicking(p, "right", 0.8)
    quiet_end(p, 0.9)


@scene
def kick_a_ball_gently(s: PeopleStage) -> None:
    """A child kicks a ball with the left foot, at no more than a metre a second."""
    performer(s, yaw_deg=145)
    p = person(s, hang=True, size=0.8)
    kick(s, p, "left", lift=1.0, speed=1.3)
    stand_while_kicking(p, "left", 1.0)
    quiet_end(p, 0.9)
