"""The planning domain of a complex action: its types, and its PARs as action schemas."""

import re
from dataclasses import dataclass, field

from capar.export.plan_sources import GENERAL_KIND, HOLDER, PlanExportError, PlanSource
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
