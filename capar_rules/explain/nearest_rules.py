"""Which rule for another name comes nearest to holding, and which of its conditions do not hold."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from capar.model.errors import RuleError
from capar.model.facts import Fact, program
from capar.model.observation import Segment
from capar_rules.engine.solver import worlds
from capar_rules.engine.syntax import (
    FITS,
    Literal,
    Statement,
    named_node,
    nodes_read,
    split_arguments,
    towards,
)
from capar_rules.explain.clock import Clock
from capar_rules.explain.counterfactuals import SCENE, measured
from capar_rules.explain.explanation import Explainer
from capar_rules.explain.rule_forms import TOKEN, Form, forms_of, rules_of
from capar_rules.explain.sentences import Sentences

MOST_FAILING = 4
"""Greatest weight of conditions that may fail; a rule with more is not near."""

MOST_RELAXED = 2000
"""Greatest number of relaxed rules of one form that are tried with as many conditions left out."""

ANYTHING = "something"
"""What a sentence says of a variable that the conditions that hold give no value."""


@dataclass(frozen=True)
class NearRule:
    """A rule that would give a segment a name, and what keeps it from holding."""

    name: str
    rule: str
    """File and line of the rule."""

    failing: tuple[str, ...]
    """What would have to be otherwise, a clause each; empty if all conditions hold."""

    @property
    def sentence(self) -> str:
        """How many conditions it lacks, and what they ask for."""
        if not self.failing:
            return f"{self.rule} holds, but a name that comes before {self.name} fits too."
        count = f"{len(self.failing)} condition{'s' * (len(self.failing) > 1)}"
        return f"{self.rule} lacks {count}: it would hold {' and '.join(self.failing)}."


def nearest_rules(explainer: Explainer, segment: Segment, name: str) -> tuple[NearRule, ...]:
    """The rules that could give a segment a name, the one with fewest failing conditions first.

    What things are (a foot, a fixed body) counts as two conditions.

    Each rule is matched with the objects, contacts and borders of which fewest conditions fail.

    Args:
        explainer: The explainer of the segment's capture.
        segment: A segment of it.
        name: A name that it does not have.

    Returns:
        One for each rule of which conditions of at most the weight ``MOST_FAILING`` fail.

    Raises:
        RuleError: The segment does not follow from these facts and rules.
    """
    base, ticks = explainer.base, explainer.ticks(segment)
    term = f"seg({segment.ee},{ticks[0]})"
    forms = {
        rule: forms_of(rule, base.statements, base.sentences)
        for rule in rules_of(base.statements, name)
    }
    every = [form for found in forms.values() for form in found]
    for facts in explainer.windows_of(segment.ee, ticks):
        holding = _holding(base.statements, every, segment.name, facts)
        if not segment.known or f'fits({term},"{segment.name}")' in holding:
            break
    atoms = {*holding, *measured(base.statements, facts, segment, ticks)}
    about = sorted(each for each in atoms if each.startswith(f"dominant({term},"))
    objects = [split_arguments(each)[1] for each in about] or segment.objects[:1]
    clock = Clock(
        explainer.windows.rate,
        explainer.windows.frames,
        {(segment.ee, ticks[0]): ticks[1]},
        objects={term: objects[0]} if objects else {},
    )
    nearest = []
    for rule, unfolded in forms.items():
        failing = _failing(unfolded, sorted(atoms), term)
        if failing is not None:
            clauses = [_clause(each, failing[1], base.sentences, clock) for each in failing[0]]
            place = f"{Path(rule.place.file).name}:{rule.place.line}"
            nearest.append(NearRule(name, place, tuple(dict.fromkeys(clauses))))
    return tuple(sorted(nearest, key=lambda each: (len(each.failing), each.rule)))


def _holding(
    statements: Sequence[Statement], forms: Iterable[Form], own: str, facts: Sequence[Fact]
) -> tuple[str, ...]:
    """All atoms on which the forms and the segment's own name depend, in a window of facts."""
    asked = {
        node
        for form in forms
        for each in form.body
        for atom in each.atoms
        for node in nodes_read(atom, set())
    }
    targets = {*asked, named_node(own), FITS, ("dominant", 2)}
    text = "\n".join(each.text for each in towards(statements, targets))
    return worlds(f"{text}\n{program(tuple(facts))}")[0]


def _failing(
    forms: Sequence[Form], atoms: Sequence[str], term: str
) -> tuple[tuple[Literal, ...], dict[str, str]] | None:
    """The fewest conditions to leave out of one of the forms so that it holds of the segment."""
    read = {atom.signature[0] for form in forms for each in form.body for atom in each.atoms}
    facts = [f"{each}." for each in atoms if each.partition("(")[0] in read]
    tried = []
    for form in forms:
        segment = split_arguments(form.rule.heads[0].text)[0]
        joins = (f"{segment}={term}", *form.joins)
        tried.append((form, joins, _unmet(form, joins, facts)))
    for weight in range(MOST_FAILING + 1):
        for form, joins, unmet in tried:
            found = _relaxed(form, joins, unmet, weight, facts)
            if found is not None:
                return found
    return None


def _unmet(form: Form, joins: Sequence[str], facts: Sequence[str]) -> frozenset[Literal]:
    """The conditions that hold of nothing in the segment, each by itself: they always fail."""
    positive = [each for each in form.body if _binds(each)]
    lines = []
    for number, literal in enumerate(positive):
        bound = _bound([literal], joins)
        equal = [each for each in joins if _variables(each) <= bound]
        lines.append(f"met({number}) :- {'; '.join([*equal, literal.text])}.")
    try:
        found = worlds("\n".join([*facts, *lines, "#show met/1."]))
    except RuleError:
        return frozenset()
    met = {int(split_arguments(each)[0]) for each in (found[0] if found else ())}
    return frozenset(each for number, each in enumerate(positive) if number not in met)


def _relaxed(
    form: Form,
    joins: Sequence[str],
    unmet: frozenset[Literal],
    weight: int,
    facts: Sequence[str],
) -> tuple[tuple[Literal, ...], dict[str, str]] | None:
    """Conditions of one weight to leave out for the form to hold, and what its variables are."""
    tried: list[tuple[tuple[Literal, ...], tuple[str, ...]]] = []
    lines: list[str] = []
    for left_out in _left_out(form.body, unmet, weight):
        kept = [each for each in form.body if each not in left_out]
        bound = _bound(kept, joins)
        if any(not _free(each) <= bound for each in kept if not _binds(each)):
            continue
        equal = [each for each in joins if _variables(each) <= bound]
        body = "; ".join([*equal, *(each.text for each in kept)])
        names = tuple(sorted(bound))
        lines.append(f"near({len(tried)},({','.join(names)},)) :- {body}.")
        tried.append((left_out, names))
        if len(tried) == MOST_RELAXED:
            break
    if not tried:
        return None
    try:
        found = worlds("\n".join([*facts, *lines, "#show near/2."]))
    except RuleError:
        return None  # a variable that only arithmetic would bind
    ways = [split_arguments(each) for each in (found[0] if found else ())]
    if not ways:
        return None
    number, values = min(ways, key=lambda each: (int(each[0]), each[1]))
    left_out, names = tried[int(number)]
    told = dict(zip(names, split_arguments(f"v{values}"), strict=False))
    return tuple(reversed(left_out)), told


def _left_out(
    body: Sequence[Literal], unmet: frozenset[Literal], weight: int
) -> Iterator[tuple[Literal, ...]]:
    """Every choice of conditions of one weight, the unmet ones in each; the scene's last.

    A condition weighs one, and two if it says what a thing is: that could not be otherwise.
    """
    scene = {each for each in body if {atom.signature for atom in each.atoms} & {*SCENE}}
    open_ = [each for each in reversed(body) if each not in unmet]
    for among in range(weight // 2 + 1):
        further = weight - among - len(unmet)
        for more in combinations(open_, further) if further >= 0 else ():
            left_out = tuple(each for each in reversed(body) if each in unmet or each in more)
            if len(scene & {*left_out}) == among:
                yield left_out


def _binds(literal: Literal) -> bool:
    return literal.kind == "atom" and literal.sign == 0


def _bound(kept: Iterable[Literal], joins: Iterable[str]) -> set[str]:
    """The variables that the kept conditions and the equalities give values to."""
    bound: set[str] = set()
    for each in kept:
        if _binds(each):
            bound |= _variables(each.text)
    pairs = [each.split("=", 1) for each in joins]
    pairs += [
        each.text.split("=", 1)
        for each in kept
        if each.kind in ("comparison", "aggregate") and re.fullmatch(r"\w+\s*=[^=]+", each.text)
    ]
    grown = True
    while grown:
        before = len(bound)
        for one, other in pairs:
            if _variables(other) <= bound or "{" in other:
                bound |= _variables(one)
            if _variables(one) <= bound and "{" not in other:
                bound |= _variables(other)
        grown = len(bound) > before
    return bound


def _free(literal: Literal) -> set[str]:
    return set() if literal.kind in ("aggregate", "conditional") else _variables(literal.text)


def _variables(text: str) -> set[str]:
    return {each for each in TOKEN.findall(text) if not each.startswith('"')}


def _clause(literal: Literal, values: dict[str, str], sentences: Sentences, clock: Clock) -> str:
    """What would have to be otherwise for a condition to hold, after ``it would``."""

    def valued(text: str) -> str:
        return TOKEN.sub(lambda one: values.get(one[0], one[0]), text)

    if literal.kind != "atom":
        return f"had {valued(literal.text)} held"
    atom = valued(literal.atoms[0].text)
    predicate = literal.atoms[0].signature[0]
    arguments = [_named(each) for each in split_arguments(atom)] if "(" in atom else []
    for mood, before in (
        ("had not" if literal.sign else "had", ""),
        ("not" if literal.sign else "", "had it been so that "),
    ):
        try:
            told = sentences.tell(predicate, arguments, clock, mood=mood)
        except (ValueError, KeyError, IndexError):
            continue  # a time of a tick that is not known
        if told:
            return before + told.replace(f"the {ANYTHING}", ANYTHING)
    others = ", ".join(each for each in arguments if not each.startswith("seg("))
    return f"had the condition {predicate}({others}) {'not ' * bool(literal.sign)}held"


def _named(argument: str) -> str:
    """An argument as a sentence has it: without quotes, and one of several as alternatives."""
    if argument.startswith("(") and ";" in argument:
        return " or ".join(_named(each) for each in argument[1:-1].split(";"))
    return ANYTHING if re.fullmatch(r"_*[A-Z]\w*|_", argument) else argument.strip('"')
