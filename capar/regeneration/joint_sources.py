"""A recording of several performers: what each did, and what passes between their hands."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from capar.model.capture import Capture, TagType
from capar.model.facts import Touching
from capar.model.observation import Observation
from capar.regeneration.bearing import rides_of
from capar.regeneration.errors import PlanError
from capar.regeneration.sources import Hold, Source, check_source, source_of


@dataclass(frozen=True, eq=False)
class HandOver:
    """A thing that passes from one performer's hand to another's."""

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
    """By the agent's name, the first one first; the things are the same in all."""

    hand_overs: tuple[HandOver, ...]
    """In order of time."""


def joint_source(capture: Capture, observation: Observation) -> JointSource:
    """What a capture of several performers and its observation say of the performance.

    Args:
        capture: What was recorded.
        observation: What was done in it.

    Raises:
        PlanError: As for one performer; or a thing passes between hands that never both hold it,
            or two things do at once.
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
            rides=rides_of(source.paths, holds, touching),
        )
        check_source(sources[name])
    return JointSource(capture, observation, sources, _hand_overs(sources))


def _of(capture: Capture, name: str) -> Capture:
    """What was recorded of one performer, and all things."""
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
