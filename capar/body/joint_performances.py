"""Several bodies that do a script each, in one scene and at the same times."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from capar.body.acting import LEAD_S, Actor, Frame
from capar.body.human import Human
from capar.body.performing import Performance, check_holds, gathered
from capar.body.recording import Truth, record, truth_of
from capar.body.scripts import Script
from capar.body.sensing import PERFECT, Tracker
from capar.body.things import Scene
from capar.model.capture import Agent, Capture, Sensor, TagObject, TagType

Body = TypeVar("Body", Sensor, TagObject)


@dataclass(frozen=True, eq=False)
class Role:
    """Who does what, and from where."""

    name: str
    """Of the agent."""

    human: Human
    script: Script
    """As many phases as everybody else's, of the same lengths."""

    place: tuple[float, float] = (0.0, 0.0)
    """Where the body stands [m]."""

    heading: float = 0.0
    """Which way it faces, from x towards y [rad]."""


def perform_together(
    scene: Scene, roles: Sequence[Role], *, rate_hz: float
) -> dict[str, Performance]:
    """Let bodies do their scripts in one scene, where the things are the same for all.

    Args:
        scene: With what all of them handle.
        roles: Who does what; in a phase only one of them moves a thing.
        rate_hz: Frames a second.

    Returns:
        The performance of each, by the agent's name.

    Raises:
        PerformanceError: A hand cannot come where it is to be; the message says by how much.
        UnknownNameError: A script names a thing that is not there.
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
    made = {
        role.name: gathered(role.human, scene, role.script, found, phases, rate_hz)
        for role, found in zip(roles, frames, strict=True)
    }
    for performance in made.values():
        check_holds(performance)
    return made


def _choose_grips(actors: Sequence[Actor], scripts: Sequence[Script]) -> None:
    """Choose everybody's grips, on things as they are when that one comes to take them."""
    for actor, script in zip(actors, scripts, strict=True):
        at_first, first = dict(actor.things), _first_use(script)
        for row in list(zip(*scripts, strict=True))[:first]:
            for phase in row:
                for name, move in phase.moves.items():
                    actor.things[name] = actor.goal(name, move, actor.things[name])
        actor.choose_grips(script)
        actor.things = at_first


def _first_use(script: Script) -> int:
    return next((number for number, phase in enumerate(script) if phase.hands), len(script))


def record_together(
    made: Mapping[str, Performance], *, name: str, seed: int, tracker: Tracker = PERFECT
) -> Capture:
    """The capture of a performance of several bodies.

    Args:
        made: The performance of each, by the agent's name; the first one's bodies keep their names.
        name: Of the capture.
        seed: Of noise, places of sensors and losses.
        tracker: Its faults; none, unless stated.
    """
    captures = {
        who: record(done, name=name, seed=seed + number, tracker=tracker)
        for number, (who, done) in enumerate(made.items())
    }
    first = next(iter(captures))
    prefixes = {who: "" if who == first else f"{who}_" for who in captures}
    names = {
        who: {sensor.name: prefixes[who] + sensor.name for sensor in capture.sensors}
        for who, capture in captures.items()
    }
    return joined(captures, names)


def joined(captures: Mapping[str, Capture], names: Mapping[str, Mapping[str, str]]) -> Capture:
    """One capture of everybody, from one of each in which the things are the same.

    Args:
        captures: By the agent's name.
        names: What each one's sensors are called in it, by the agent's name; likewise the parts
            of bodies that are the same as sensors.
    """
    sensors: list[Sensor] = []
    parts: list[TagObject] = []
    agents = [Agent(who, c.agent.kind, c.agent.measures) for who, c in captures.items()]
    for who, capture in captures.items():
        sensors += [_named(sensor, names[who], who) for sensor in capture.sensors]
        parts += [_named(p, names[who], who) for p in capture.objects if p.tag is TagType.SELF]
    first = next(iter(captures.values()))
    things = [thing for thing in first.objects if thing.tag is not TagType.SELF]
    return replace(
        first, sensors=tuple(sensors), objects=(*parts, *things), agent=agents[0],
        others=tuple(agents[1:]),
    )  # fmt: skip


def _named(body: Body, names: Mapping[str, str], who: str) -> Body:
    return replace(body, name=names.get(body.name, body.name), agent=who)


def truth_together(made: Mapping[str, Performance]) -> Truth:
    """What is so in a performance of several bodies, with the names of their capture."""
    first, *others = made
    all_truths = [truth_of(made[first])]
    all_truths += [_prefixed(truth_of(made[who]), f"{who}_") for who in others]
    contacts = {contact for truth in all_truths for contact in truth.contacts}
    looks = [look for truth in all_truths for look in truth.looks]
    return Truth(tuple(sorted(contacts)), all_truths[0].motions, all_truths[0].phases, tuple(looks))


def _prefixed(truth: Truth, prefix: str) -> Truth:
    parts = {part: prefix + part for part in ("right_hand", "left_hand", "head")}
    rows = [(parts.get(a, a), parts.get(b, b), start, end) for a, b, start, end in truth.contacts]
    return replace(truth, contacts=tuple(rows))
