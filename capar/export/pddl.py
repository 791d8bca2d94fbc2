"""PDDL: a complex action as a planning domain, and what was observed as a problem in it.

An object's contacts with other objects are contacts at a place: ``(at EE OBJECT PLACE)`` says how
far an end-effector has moved an object, ``(meets PLACE OTHER)`` what the object touches there.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from capar.export.pddl_domain import (
    action_constant,
    effector_type,
    kind_type,
    pddl_domain,
    thing_word,
    word,
)
from capar.export.plan_sources import HOLDER, PlanSource, PlanStep, bound_condition
from capar.model.par import Upar


@dataclass(frozen=True, slots=True)
class PddlStep:
    """A step as the action of the domain, with its arguments."""

    action: str
    arguments: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PddlPlan:
    """A domain and a problem, and the observed sequence in their terms."""

    domain: str
    problem: str
    observed: tuple[PddlStep, ...]
    """Link by link."""


@dataclass
class _World:
    """What the problem says, as the observed steps are gone through."""

    objects: dict[str, str] = field(default_factory=dict)
    initially: list[str] = field(default_factory=list)
    goal: list[str] = field(default_factory=list)
    observed: list[PddlStep] = field(default_factory=list)


def pddl(source: PlanSource) -> PddlPlan:
    """A complex action as PDDL with typing and negative conditions.

    The goal is what the action comes to: contacts, places and postures at its end, and that every
    step that ends by its time, and moves nothing, has lasted.

    Args:
        source: The complex action.

    Raises:
        PlanExportError: A condition of a kind that has no place in the domain.
    """
    domain, names = pddl_domain(source)
    world = _observed_world(source, names)
    return PddlPlan(domain, _problem(source, world), tuple(world.observed))


def _observed_world(source: PlanSource, names: dict[Upar, str]) -> _World:
    world = _World()
    agent = word(f"agent_{source.agent}")
    world.objects[agent] = "agent"
    for name, chain in source.kinds.items():
        world.objects[thing_word(name)] = kind_type(chain[0])
    for ee, steps in source.links.items():
        _observed_link(world, ee, steps, names, agent)
    return world


def _observed_link(
    world: _World, ee: str, steps: Iterable[PlanStep], names: dict[Upar, str], agent: str
) -> None:
    """One link's steps: the places and postures that it goes through, and what it ends in."""
    steps = tuple(steps)
    if not steps:
        return
    holder = word(f"{ee}_ee")
    world.objects[holder] = effector_type(steps[0].upar.core.constraint.features.end_effector)
    world.initially.append(f"(of {holder} {agent})")
    first = steps[0]
    posture = _new(world, f"{ee}_start", "posture")
    if not any(needed.condition.kind == "contact" for needed in first.upar.preparation):
        world.initially.append(f"(in_posture {holder} {posture})")
    places: dict[str, str] = {}
    counts: dict[str, int] = {}
    touched: dict[str, bool] = {}
    for planned in steps:
        name, what = names[planned.upar], planned.ipar.objects
        arguments = [holder, agent, *map(thing_word, what)]
        _state_capable(world, planned, name, agent)
        after = posture
        if planned.rests:
            after = _new(world, f"{ee}_{planned.ipar.posture or 'end'}", "posture")
            _state(world.initially, f"(ends_in {action_constant(name)} {holder} {after})")
        if what:
            arguments += _at_places(world, (ee, holder, name), planned, places, counts)
            _state_contacts(world, (holder, planned), touched)
            if any(p.condition.kind == "posture" for p in planned.upar.preparation):
                arguments.append(posture)
            if planned.rests:
                arguments.append(after)
            if planned.lasts and not planned.moves:
                _state(world.goal, f"(lasted {action_constant(name)} {holder} {places[what[0]]})")
        else:
            arguments += [posture, after]
            _state(world.goal, f"(rested {action_constant(name)} {holder} {after})")
        posture = after
        world.observed.append(PddlStep(name, tuple(arguments)))
    _finally(world, holder, steps[-1], touched, places, posture)


def _state_capable(world: _World, planned: PlanStep, name: str, agent: str) -> None:
    """Who did it is capable of it, and so is what it was done with (thesis 4.6.1.4)."""
    for condition in planned.upar.applicability:
        who = bound_condition(planned.upar, planned.ipar, condition)[0]
        known = agent if who == planned.ipar.agent else thing_word(who)
        _state(world.initially, f"(capable {known} {action_constant(name)})")


def _at_places(
    world: _World,
    who: tuple[str, str, str],
    planned: PlanStep,
    places: dict[str, str],
    counts: dict[str, int],
) -> list[str]:
    """From where to where a step moves its dominant object, and what that touches there."""
    ee, holder, name = who
    thing = planned.ipar.objects[0]
    if thing not in places:
        places[thing] = _new(world, f"{ee}_{thing}_0", "place")
        world.initially.append(f"(at {holder} {thing_word(thing)} {places[thing]})")
    here = there = places[thing]
    if planned.moves:
        counts[thing] = counts.get(thing, 0) + 1
        there = places[thing] = _new(world, f"{ee}_{thing}_{counts[thing]}", "place")
        world.initially.append(f"(leads {action_constant(name)} {holder} {here} {there})")
    needed = [preparation.condition for preparation in planned.upar.preparation]
    for place, conditions in ((here, needed), (there, planned.upar.post_assertions)):
        for condition in conditions:
            if condition.kind == "contact" and condition.arguments[0] != HOLDER and condition.holds:
                other = thing_word(bound_condition(planned.upar, planned.ipar, condition)[1])
                _state(world.initially, f"(meets {place} {other})")
    return [here, there] if planned.moves else [here]


def _state_contacts(world: _World, at: tuple[str, PlanStep], touched: dict[str, bool]) -> None:
    """A contact that a first step needs is there from the start; the last word on each counts."""
    holder, planned = at
    for preparation in planned.upar.preparation:
        condition = preparation.condition
        if condition.kind == "contact" and condition.arguments[0] == HOLDER:
            other = bound_condition(planned.upar, planned.ipar, condition)[1]
            if other not in touched:
                world.initially.append(f"(contact {holder} {thing_word(other)})")
                touched[other] = True
    for condition in planned.upar.post_assertions:
        if condition.arguments[0] == HOLDER:
            touched[bound_condition(planned.upar, planned.ipar, condition)[1]] = condition.holds


def _finally(
    world: _World,
    holder: str,
    last: PlanStep,
    touched: dict[str, bool],
    places: dict[str, str],
    posture: str,
) -> None:
    for other, holds in touched.items():
        atom = f"(contact {holder} {thing_word(other)})"
        world.goal.append(atom if holds else f"(not {atom})")
    world.goal += [f"(at {holder} {thing_word(thing)} {place})" for thing, place in places.items()]
    if last.rests:
        world.goal.append(f"(in_posture {holder} {posture})")


def _new(world: _World, name: str, kind: str) -> str:
    made = word(name)
    world.objects[made] = kind
    return made


def _state(atoms: list[str], atom: str) -> None:
    if atom not in atoms:
        atoms.append(atom)


def _problem(source: PlanSource, world: _World) -> str:
    return "\n".join(_problem_lines(source, world)) + "\n"


def _problem_lines(source: PlanSource, world: _World) -> Iterator[str]:
    name = word(source.name)
    yield f"(define (problem {name}_observed)"
    yield f"  (:domain {name})"
    yield "  (:objects"
    yield from (f"    {name} - {kind}" for name, kind in world.objects.items())
    yield "  )"
    yield "  (:init"
    yield from (f"    {atom}" for atom in world.initially)
    yield "  )"
    yield "  (:goal (and"
    yield from (f"    {atom}" for atom in world.goal)
    yield "  ))"
    yield ")"
