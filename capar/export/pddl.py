"""PDDL: a complex action as a planning domain, and what was observed as a problem in it.

An object's contacts with other objects are contacts at a place: ``(at EE OBJECT PLACE)`` says how
far an end-effector has moved an object, ``(meets PLACE OTHER)`` what the object touches there.
"""

import re
from collections.abc import Mapping, Sequence
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
    bare = [each.name for each in schemas.values()]
    for upar, schema in schemas.items():
        if bare.count(schema.name) > 1:  # told apart by their features
            bits = upar.core.constraint.features
            schema.name = "-".join(
                (upar.name, bits.rel_start, bits.rel_end, bits.change_loc, bits.force)
            )
    names = {upar: schema.name for upar, schema in schemas.items()}
    for schema in schemas.values():
        own = action_constant(schema.name)
        schema.before = [each.replace("@action", own) for each in schema.before]
        schema.after = [each.replace("@action", own) for each in schema.after]
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
    for at, name in enumerate(upar.objects):  # the nearest kind of all that was observed there
        chains = [
            [kind_type(kind) for kind in source.kinds[each.ipar.objects[at]]]
            for each in source.steps
            if each.upar == upar
        ]
        shared = (kind for kind in chains[0] if all(kind in chain for chain in chains))
        action.parameters[f"?{name}"] = next(shared, "thing")
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
    """Conditions on contacts, the place of the dominant object, and the posture.

    What is touched at the end is no posture; where nothing is, a posture is the end.
    """
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
    for preparation in upar.preparation:  # what must hold before (thesis 4.6.1.1)
        if preparation.condition.kind == "posture":
            action.parameters["?posture"] = "posture"
            action.before.append("(in_posture ?EE ?posture)")
        else:
            action.before.append(_asserted(preparation.condition, "?place"))
    for condition in upar.post_assertions:
        found = _asserted(condition, "?next" if moves else "?place")
        (action.after if condition.arguments[0] == HOLDER else action.before).append(found)
    if "?posture" in action.parameters:
        action.after.append("(not (in_posture ?EE ?posture))")
    if not any(each.holds for each in upar.post_assertions):
        action.parameters["?reached"] = "posture"
        action.before.append("(ends_in @action ?EE ?reached)")
        action.after.append("(in_posture ?EE ?reached)")
    if not moves and any(each.kind == "duration" for each in upar.core.termination):
        action.after.append("(lasted @action ?EE ?place)")


def _asserted(condition: Condition, place: str) -> str:
    if condition.kind != "contact":
        raise PlanExportError(f"a condition of kind {condition.kind!r} has no place in PDDL")
    first, second = condition.arguments
    atom = f"(contact ?{first} ?{second})" if first == HOLDER else f"(meets {place} ?{second})"
    return atom if condition.holds else f"(not {atom})"


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
    world = _World(names, word(f"agent_{source.agent}"))
    world.objects[world.agent] = "agent"
    for name, chain in source.kinds.items():
        world.objects[thing_word(name)] = kind_type(chain[0])
    for ee, steps in source.links.items():
        if steps:
            _Link(world, ee, steps)
    name = word(source.name)
    lines = [
        f"(define (problem {name}_observed)",
        f"  (:domain {name})",
        "  (:objects",
        *(f"    {name} - {kind}" for name, kind in world.objects.items()),
        "  )",
        "  (:init",
        *(f"    {atom}" for atom in world.initially),
        "  )",
        "  (:goal (and",
        *(f"    {atom}" for atom in world.goal),
        "  ))",
        ")",
    ]
    return PddlPlan(domain, "\n".join(lines) + "\n", tuple(world.observed))


@dataclass
class _World:
    """What the problem says, as the observed steps are gone through; atoms keep their order."""

    names: Mapping[Upar, str]
    agent: str
    objects: dict[str, str] = field(default_factory=dict)
    initially: dict[str, None] = field(default_factory=dict)
    goal: dict[str, None] = field(default_factory=dict)
    observed: list[PddlStep] = field(default_factory=list)

    def new(self, name: str, kind: str) -> str:
        """A new object of the problem."""
        made = word(name)
        self.objects[made] = kind
        return made


class _Link:
    """One link's steps: the places and postures that it goes through, and what it ends in."""

    def __init__(self, world: _World, ee: str, steps: Sequence[PlanStep]) -> None:
        self.world, self.ee = world, ee
        self.holder = word(f"{ee}_ee")
        hand = steps[0].upar.core.constraint.features.end_effector
        world.objects[self.holder] = effector_type(hand)
        world.initially[f"(of {self.holder} {world.agent})"] = None
        self.posture = world.new(f"{ee}_start", "posture")
        if not any(p.condition.kind == "contact" for p in steps[0].upar.preparation):
            world.initially[f"(in_posture {self.holder} {self.posture})"] = None
        self.places: dict[str, str] = {}
        self.counts: dict[str, int] = {}
        self.touched: dict[str, bool] = {}
        """Whether the last word on each contact of the end-effector is that there is one."""

        for planned in steps:
            self._step(planned, world.names[planned.upar])
        for other, holds in self.touched.items():
            atom = f"(contact {self.holder} {thing_word(other)})"
            world.goal[atom if holds else f"(not {atom})"] = None
        for thing, place in self.places.items():
            world.goal[f"(at {self.holder} {thing_word(thing)} {place})"] = None
        if steps[-1].rests:
            world.goal[f"(in_posture {self.holder} {self.posture})"] = None

    def _step(self, planned: PlanStep, name: str) -> None:
        world, holder, what = self.world, self.holder, planned.ipar.objects
        constant = action_constant(name)
        arguments = [holder, world.agent, *map(thing_word, what)]
        # Who did it is capable of it, and so is what it was done with (thesis 4.6.1.4).
        for condition in planned.upar.applicability:
            who = bound_condition(planned.upar, planned.ipar, condition)[0]
            known = world.agent if who == planned.ipar.agent else thing_word(who)
            world.initially[f"(capable {known} {constant})"] = None
        after = self.posture
        if planned.rests:
            after = world.new(f"{self.ee}_{planned.ipar.posture or 'end'}", "posture")
            world.initially[f"(ends_in {constant} {holder} {after})"] = None
        if what:
            arguments += self._at_places(planned, constant)
            self._contacts(planned)
            if any(p.condition.kind == "posture" for p in planned.upar.preparation):
                arguments.append(self.posture)
            if planned.rests:
                arguments.append(after)
            if planned.lasts and not planned.moves:
                world.goal[f"(lasted {constant} {holder} {self.places[what[0]]})"] = None
        else:
            arguments += [self.posture, after]
            world.goal[f"(rested {constant} {holder} {after})"] = None
        self.posture = after
        world.observed.append(PddlStep(name, tuple(arguments)))

    def _at_places(self, planned: PlanStep, constant: str) -> list[str]:
        """From where to where a step moves its dominant object, and what that touches there."""
        world, holder, thing = self.world, self.holder, planned.ipar.objects[0]
        if thing not in self.places:
            self.places[thing] = world.new(f"{self.ee}_{thing}_0", "place")
            world.initially[f"(at {holder} {thing_word(thing)} {self.places[thing]})"] = None
        here = there = self.places[thing]
        if planned.moves:
            self.counts[thing] = self.counts.get(thing, 0) + 1
            there = world.new(f"{self.ee}_{thing}_{self.counts[thing]}", "place")
            self.places[thing] = there
            world.initially[f"(leads {constant} {holder} {here} {there})"] = None
        needed = [preparation.condition for preparation in planned.upar.preparation]
        for place, conditions in ((here, needed), (there, planned.upar.post_assertions)):
            for each in conditions:
                if each.kind == "contact" and each.arguments[0] != HOLDER and each.holds:
                    other = thing_word(bound_condition(planned.upar, planned.ipar, each)[1])
                    world.initially[f"(meets {place} {other})"] = None
        return [here, there] if planned.moves else [here]

    def _contacts(self, planned: PlanStep) -> None:
        """A contact that a first step needs is there from the start."""
        for condition in (preparation.condition for preparation in planned.upar.preparation):
            if condition.kind == "contact" and condition.arguments[0] == HOLDER:
                other = bound_condition(planned.upar, planned.ipar, condition)[1]
                if other not in self.touched:
                    self.world.initially[f"(contact {self.holder} {thing_word(other)})"] = None
                    self.touched[other] = True
        for condition in planned.upar.post_assertions:
            if condition.arguments[0] == HOLDER:
                other = bound_condition(planned.upar, planned.ipar, condition)[1]
                self.touched[other] = condition.holds
