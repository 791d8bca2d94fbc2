"""PDDL: a complex action as a planning domain, and what was observed as a problem in it.

An object's contacts with other objects are contacts at a place: ``(at EE OBJECT PLACE)`` says how
far an end-effector has moved an object, ``(meets PLACE OTHER)`` what the object touches there.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from capar.export.plans import (
    GENERAL_KIND,
    HOLDER,
    PlanExportError,
    PlanSource,
    PlanStep,
    bound_condition,
)
from capar.model.par import Condition, Upar

PREDICATES = """\
    (of ?ee - end_effector ?agent - agent)
    (capable ?who - thing ?what - action_name)
    (contact ?ee - end_effector ?object - thing)
    (at ?ee - end_effector ?object - thing ?place - place)
    (meets ?place - place ?object - thing)
    (leads ?what - action_name ?ee - end_effector ?from - place ?to - place)
    (in_posture ?ee - end_effector ?posture - posture)
    (ends_in ?what - action_name ?ee - end_effector ?posture - posture)
    (lasted ?what - action_name ?ee - end_effector ?place - place)
    (rested ?what - action_name ?ee - end_effector ?posture - posture)"""
"""What can be said of the world."""

TYPES = {
    "action_name": "object",
    "place": "object",
    "posture": "object",
    "end_effector": "object",
    "thing": "object",
    "agent": "thing",
}
"""Types that every domain has, each with the one above it."""

_NO_NAME = re.compile(r"[^A-Za-z0-9_-]")


@dataclass
class _Action:
    """A UPAR as an action schema."""

    name: str
    parameters: dict[str, str] = field(default_factory=dict)
    before: list[str] = field(default_factory=list)
    after: list[str] = field(default_factory=list)

    def text(self) -> str:
        listed = " ".join(f"{name} - {kind}" for name, kind in self.parameters.items())
        return (
            f"  (:action {self.name}\n    :parameters ({listed})\n"
            f"    :precondition (and {' '.join(dict.fromkeys(self.before))})\n"
            f"    :effect (and {' '.join(self.after)}))"
        )


def pddl_domain(source: PlanSource) -> tuple[str, dict[Upar, str]]:
    """The text of a domain, and what each action is called in it.

    Args:
        source: The complex action.

    Raises:
        PlanExportError: A condition of a kind that has no place in the domain.
    """
    schemas = {each.upar: _schema(source, each.upar) for each in source.steps}
    names = _unique(schemas)
    kinds = _types(source)
    constants = sorted(map(action_constant, names.values()))
    lines = "\n".join(
        [
            f"; {source.name}: preconditions from applicability and preparatory specifications,",
            "; effects from termination and post-assertions of the observed PARs",
            f"(define (domain {word(source.name)})",
            "  (:requirements :strips :typing :negative-preconditions)",
            "  (:types",
            *(f"    {name} - {above}" for name, above in kinds.items()),
            "  )",
            f"  (:constants {' '.join(constants)} - action_name)",
            f"  (:predicates\n{PREDICATES}\n  )",
            *(schemas[upar].text() for upar in sorted(schemas, key=lambda each: names[each])),
            ")",
        ]
    )
    return lines + "\n", names


def word(name: str) -> str:
    """A name that PDDL takes."""
    word = _NO_NAME.sub("_", name)
    return word if word[:1].isalpha() else f"a_{word}"


def _unique(schemas: dict[Upar, _Action]) -> dict[Upar, str]:
    """A name for every action; where two have the same, with the features that tell them apart."""
    bare = [each.name for each in schemas.values()]
    for upar, schema in schemas.items():
        if bare.count(schema.name) > 1:
            features = upar.core.constraint.features
            bits = (features.rel_start, features.rel_end, features.change_loc, features.force)
            schema.name = "-".join((upar.name, *bits))
    for schema in schemas.values():
        own = action_constant(schema.name)
        schema.before = [each.replace("@action", own) for each in schema.before]
        schema.after = [each.replace("@action", own) for each in schema.after]
    return {upar: schema.name for upar, schema in schemas.items()}


def _types(source: PlanSource) -> dict[str, str]:
    """Every type with the one above it: the Actionary's kinds, and those of the domain."""
    found = dict(TYPES)
    for chain in source.kinds.values():
        words = [kind_type(each) for each in chain]
        for lower, upper in zip(words, (*words[1:], "thing"), strict=True):
            if lower not in found and lower != upper:
                found[lower] = upper
    hands = {each.upar.core.constraint.features.end_effector for each in source.steps}
    return found | {effector_type(each): "end_effector" for each in sorted(hands)}


def action_constant(action: str) -> str:
    """The constant that stands for an action where it is spoken about."""
    return f"{action}_action"


def thing_word(name: str) -> str:
    """An object of the scene, told apart from the kind of that name."""
    return f"the_{word(name)}"


def kind_type(name: str) -> str:
    """A kind as a type; the general one is ``thing``, as PDDL's ``object`` stands above all."""
    return "thing" if name in {GENERAL_KIND, "thing"} else word(name)


def effector_type(general: str) -> str:
    """The type of an end-effector, told apart from a kind of object of that name."""
    return f"acting_{word(general)}"


def _schema(source: PlanSource, upar: Upar) -> _Action:
    action = _Action(word(upar.name))
    features = upar.core.constraint.features
    action.parameters = {"?EE": effector_type(features.end_effector), "?agent": "agent"}
    action.before.append("(of ?EE ?agent)")
    for name in upar.objects:
        action.parameters[f"?{name}"] = _common_kind(source, upar, name)
    for condition in upar.applicability:
        action.before.append(f"(capable ?{condition.arguments[0]} @action)")
    if upar.objects:
        _with_objects(action, upar)
    else:
        action.parameters |= {"?posture": "posture", "?next": "posture"}
        action.before += ["(in_posture ?EE ?posture)", "(ends_in @action ?EE ?next)"]
        action.after += ["(not (in_posture ?EE ?posture))", "(in_posture ?EE ?next)"]
        action.after.append("(rested @action ?EE ?next)")
    return action


def _with_objects(action: _Action, upar: Upar) -> None:
    """Conditions on contacts, the place of the dominant object, and the posture."""
    moves = bool(upar.core.moved)
    action.parameters["?place"] = "place"
    action.before.append(f"(at ?EE ?{upar.objects[0]} ?place)")
    if moves:
        action.parameters["?next"] = "place"
        action.before.append("(leads @action ?EE ?place ?next)")
        action.after += [
            f"(not (at ?EE ?{upar.objects[0]} ?place))",
            f"(at ?EE ?{upar.objects[0]} ?next)",
        ]
    for preparation in upar.preparation:
        action.before.append(_needed(action, preparation.condition))
    for condition in upar.post_assertions:
        found = _asserted(condition, "?next" if moves else "?place")
        (action.after if condition.arguments[0] == HOLDER else action.before).append(found)
    _posture(action, upar)
    if not moves and any(each.kind == "duration" for each in upar.core.termination):
        action.after.append("(lasted @action ?EE ?place)")


def _needed(action: _Action, condition: Condition) -> str:
    """What must hold before (thesis 4.6.1.1)."""
    if condition.kind == "posture":
        action.parameters["?posture"] = "posture"
        return "(in_posture ?EE ?posture)"
    return _asserted(condition, "?place")


def _posture(action: _Action, upar: Upar) -> None:
    """What is touched at the end is no posture; where nothing is, a posture is the end."""
    if "?posture" in action.parameters:
        action.after.append("(not (in_posture ?EE ?posture))")
    if not any(each.holds for each in upar.post_assertions):
        action.parameters["?reached"] = "posture"
        action.before.append("(ends_in @action ?EE ?reached)")
        action.after.append("(in_posture ?EE ?reached)")


def _asserted(condition: Condition, place: str) -> str:
    if condition.kind != "contact":
        raise PlanExportError(f"a condition of kind {condition.kind!r} has no place in PDDL")
    first, second = condition.arguments
    atom = f"(contact ?{first} ?{second})" if first == HOLDER else f"(meets {place} ?{second})"
    return atom if condition.holds else f"(not {atom})"


def _common_kind(source: PlanSource, upar: Upar, parameter: str) -> str:
    """The nearest kind of all that was observed in a place of the action."""
    at = upar.objects.index(parameter)
    chains = [
        [kind_type(kind) for kind in source.kinds[each.ipar.objects[at]]]
        for each in source.steps
        if each.upar == upar
    ]
    shared = [kind for kind in chains[0] if all(kind in chain for chain in chains)]
    return shared[0] if shared else "thing"


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
