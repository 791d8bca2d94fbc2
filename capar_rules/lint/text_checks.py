"""Checks of a rule file by its statements: which are allowed, and which predicates they use."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from capar_rules.engine.slicing import heads_of
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Atom, Place, Signature, Statement, split_arguments
from capar_rules.lint.findings import NOTE, Finding

AUTHORED: dict[Signature, str] = {
    ("primitive", 1): 'primitive("Lift")',
    ("specialises", 2): 'specialises("Lift", "MoveObj")',
    ("precedes", 2): 'precedes("Lift", "Catch")',
    ("verb", 2): 'verb("Lift", "lift")',
    ("sense", 2): 'sense("Lift", 1)',
    ("levin", 2): 'levin("Lift", "9.4")',
    ("purpose_of", 2): 'purpose_of("Lift", "Carry")',
    ("feature_row", 6): 'feature_row("Lift", any, "1", "1", "1", "0")',
    ("fits", 2): 'fits(Segment, "Lift") :- ...',
    ("also", 2): "also(Atom, Other) :- ...",
}
"""Predicates of the rule base that a user's file may define, each with an example."""

HARMLESS = {"rule", "comment", "defined", "definition"}
REFUSED = {
    "script": "scripts run code; rules are logic alone",
    "external": "what is external could be set from outside",
    "theoryatom": "theories are not known here",
    "theorydefinition": "theories are not known here",
    "minimize": "rules derive and do not optimise",
    "showsignature": "what is shown is for the rule base to say",
    "showterm": "what is shown is for the rule base to say",
    "projectatom": "what is shown is for the rule base to say",
    "projectsignature": "what is shown is for the rule base to say",
    "heuristic": "rules derive and do not steer the solver",
    "edge": "rules derive and do not steer the solver",
    "program": "rules stand in one program, base",
}
HEADS = {
    "choice": ("a rule that chooses makes several answers", "State what follows, without braces."),
    "disjunction": ("alternatives make several answers", "State one head; write a rule for each."),
    "theory": ("theories are not known here", "State an atom."),
    "constraint": (
        "a rule without a head would forbid what was observed",
        "Derive the cases that fit instead.",
    ),
}


@dataclass(frozen=True)
class Known:
    """The vocabulary of a rule base."""

    rules: tuple[Statement, ...]
    heads: frozenset[Signature]
    inputs: frozenset[Signature]
    """Predicates that may have no rule: measurements, and those of other profiles."""

    measured: frozenset[Signature]
    """Predicates of measurements (``inputs.lp``)."""

    primitives: Mapping[str, str]
    """Names of primitives, each with the file that introduces it."""

    constants: frozenset[str]


def known(rules: Sequence[Statement]) -> Known:
    """The vocabulary of the rules."""
    return Known(
        tuple(rules),
        heads_of(rules),
        frozenset(rule.defines for rule in rules if isinstance(rule.defines, tuple)),
        frozenset(
            rule.defines
            for rule in rules
            if isinstance(rule.defines, tuple) and rule.place.file.endswith("inputs.lp")
        ),
        dict(_named(rules, "primitive")),
        frozenset(rule.defines for rule in rules if isinstance(rule.defines, str)),
    )


def static_findings(own: Sequence[Statement], base: Known, *, file: str) -> Iterator[Finding]:
    """Every finding that needs no solver."""
    yield from _statements(own, base)
    yield from _heads(own, base)
    yield from _bodies(own, base)
    yield from _primitives(own, base, file)
    yield from _documentation(own)


def _statements(own: Iterable[Statement], base: Known) -> Iterator[Finding]:
    for statement in own:
        if statement.kind not in HARMLESS:
            why = REFUSED.get(statement.kind, "a rule file holds rules and facts alone")
            yield Finding(
                statement.place, "refused-statement", f"#{statement.kind} is refused: {why}.",
                "Remove it; write rules as head :- body.",
            )  # fmt: skip
        for place in statement.external:
            yield Finding(
                place, "external-function", "an @function calls code; rules are logic alone.",
                "Compute with + - * / and comparisons, or take a measurement of the extractors.",
            )  # fmt: skip
        if statement.kind == "definition" and statement.defines in base.constants:
            yield Finding(
                statement.place, "taken-constant",
                f"constant {statement.defines} is set by the rule base.",
                "Give yours another name.",
            )  # fmt: skip
        if statement.head_kind in HEADS:
            message, remedy = HEADS[statement.head_kind]
            yield Finding(statement.place, f"{statement.head_kind}-head", f"{message}.", remedy)
        for literal in statement.body:
            if literal.kind == "theory":
                yield Finding(
                    literal.place, "refused-statement", "theories are not known here.",
                    "Compare numbers with < <= = != >= >.",
                )  # fmt: skip


def _heads(own: Sequence[Statement], base: Known) -> Iterator[Finding]:
    taken = (base.heads | base.inputs) - _beside(own, base)
    arities = dict(AUTHORED.keys())
    for statement in own:
        for head in statement.heads:
            if head.signature in AUTHORED:
                continue
            name, arity = head.signature
            if head.signature in taken:
                yield Finding(
                    head.place, "redefined-predicate",
                    f"{name}/{arity} is the rule base's own; a file may not add to it.",
                    f"Give yours another name, or state one of {_listed(AUTHORED)}.",
                )  # fmt: skip
            elif name in arities:
                yield Finding(
                    head.place, "wrong-arity",
                    f"{name} has {arities[name]} arguments, not {arity}.",
                    f"Write it like {AUTHORED[name, arities[name]]}.",
                )  # fmt: skip


def _beside(own: Iterable[Statement], base: Known) -> frozenset[Signature]:
    """What files of the user define that introduce a primitive of this one, as its copy does."""
    names = introduced_names(own)
    files = {file for name, file in base.primitives.items() if name in names and not _ships(file)}
    return heads_of(each for each in base.rules if each.place.file in files)


def _ships(file: str) -> bool:
    return Path(file).is_relative_to(rule_file("inputs.lp").parent)


def _bodies(own: Sequence[Statement], base: Known) -> Iterator[Finding]:
    words = base.heads | base.inputs | heads_of(own) | set(AUTHORED)
    words -= {("because", 3), ("because_part", 3)}
    for statement in own:
        for literal in statement.body:
            for atom in literal.atoms:
                if atom.signature not in words:
                    yield _unknown(atom, words)


def _unknown(atom: Atom, words: Iterable[Signature]) -> Finding:
    name, arity = atom.signature
    arities = sorted(count for word, count in words if word == name)
    if arities:
        allowed = " or ".join(map(str, arities))
        return Finding(
            atom.place, "wrong-arity", f"{name} has {allowed} arguments, not {arity}.",
            "`capar rules show` of a primitive that uses it shows their order.",
        )  # fmt: skip
    near = get_close_matches(name, sorted({word for word, _ in words}), n=3, cutoff=0.5)
    hint = (
        f"The nearest are {', '.join(near)}."
        if near
        else (f"There are {', '.join(sorted({word for word, _ in words})[:12])} and more.")
    )
    return Finding(atom.place, "unknown-predicate", f"there is no predicate {name}/{arity}.", hint)


def introduced_names(own: Iterable[Statement]) -> set[str]:
    """The primitives that rules introduce."""
    return {name for name, _ in _named(own, "primitive")}


def _primitives(own: Sequence[Statement], base: Known, file: str) -> Iterator[Finding]:
    mine = introduced_names(own)
    for statement in own:
        for head in statement.heads:
            arguments = split_arguments(head.text)
            name = head.signature[0]
            taken = base.primitives.get(arguments[0].strip('"')) if name == "primitive" else None
            if taken:
                yield Finding(
                    head.place, "taken-name",
                    f"there is a primitive {arguments[0]} already, in {taken}.",
                    "Choose another name, or take one of the two files away."
                    if _ships(taken)
                    else "Remove that one first: capar rules remove "
                    f"{arguments[0].strip(chr(34))}. Or choose another name.",
                )  # fmt: skip
            at = {"fits": 1, "feature_row": 0, "specialises": 0, "precedes": 0, "verb": 0}.get(name)
            if at is None or (name, len(arguments)) not in AUTHORED:
                continue
            subjects = arguments if name in _ORDERING else [arguments[at]]
            quoted = all(each.startswith('"') for each in subjects)
            if name == "fits" and not quoted:
                continue  # word_checks.py reports missing quotes
            if not quoted or not {each.strip('"') for each in subjects} & mine:
                yield Finding(
                    head.place, "foreign-name",
                    f"{name} is stated of {arguments[at]}, which this file does not introduce.",
                    f'It may name {", ".join(sorted(mine)) or "what it introduces"}; '
                    f'state primitive("Name") first.',
                )  # fmt: skip
            if name in _ORDERING:
                yield from _ordered(head, arguments, mine | set(base.primitives))
                circle = _circle(head, [*base.rules, *own])
                if circle:
                    yield Finding(
                        head.place, "circular", f"{head.text} closes a circle ({circle}): a "
                        "segment that fits them all would get no name.",
                        "State one order: take this line out, or another one of the circle.",
                    )  # fmt: skip
            if name == "feature_row":
                yield from _row(head, arguments)
    if not mine:
        yield Finding(
            Place(file, 1, 1), "no-primitive", "the file introduces no primitive.",
            'State one, such as primitive("Lift").',
        )  # fmt: skip


_ORDERING = ("specialises", "precedes")
"""Predicates that say which of two primitives a segment that fits both is called."""


def _circle(stated: Atom, rules: Iterable[Statement]) -> str:
    """Who comes before whom in the circle that an ordering closes; empty if it closes none."""
    first, second = split_arguments(stated.text)
    after: dict[str, list[tuple[str, str]]] = {}
    for rule in rules:
        for head in rule.heads:
            if head.signature[0] in _ORDERING and head.signature[1] == 2:
                name, other = split_arguments(head.text)
                after.setdefault(name, []).append((other, f"{name} {head.signature[0]} {other}"))
    ways = {second: [f"{first} {stated.signature[0]} {second}"]}
    waiting = [second]
    while waiting and first not in ways:
        name = waiting.pop(0)
        for other, told in sorted(after.get(name, ())):
            if other not in ways:
                ways[other] = [*ways[name], told]
                waiting.append(other)
    return ", ".join(ways.get(first, ())).replace('"', "")


def _ordered(head: Atom, arguments: Sequence[str], names: set[str]) -> Iterator[Finding]:
    for argument in arguments:
        if argument.strip('"') not in names:
            close = get_close_matches(argument.strip('"'), sorted(names), n=1)
            yield Finding(
                head.place, "unknown-primitive", f"there is no primitive {argument}.",
                f"Did you mean {close[0]}?" if close else f"There are {', '.join(sorted(names))}.",
            )  # fmt: skip


def _row(head: Atom, arguments: Sequence[str]) -> Iterator[Finding]:
    strings = [each.strip('"') for each in arguments[2:]]
    count = len(strings[2])
    right = (max(2 * count - 1, 0), max(2 * count - 1, 0), count, count)
    if tuple(map(len, strings)) != right or set("".join(strings)) - {"0", "1"}:
        yield Finding(
            head.place, "wrong-bits", f"{head.text} is no feature set.",
            f"Over {count} objects the strings have {', '.join(map(str, right))} bits, 0 or 1.",
        )  # fmt: skip


def _documentation(own: Sequence[Statement]) -> Iterator[Finding]:
    if own and not (own[0].kind == "comment" and re.match(r"%\*\s*\w+:\s+\S", own[0].text)):
        yield Finding(
            own[0].place, "no-definition", "the file does not open with its definition in words.",
            "Begin it with a line such as %* Lift: a possessed object goes up. *%", NOTE,
        )  # fmt: skip


def _named(rules: Iterable[Statement], predicate: str) -> Iterator[tuple[str, str]]:
    """The arguments of a unary predicate's facts, each with its file."""
    for rule in rules:
        for head in rule.heads:
            if head.signature == (predicate, 1):
                yield split_arguments(head.text)[0].strip('"'), rule.place.file


def _listed(signatures: Iterable[Signature]) -> str:
    return ", ".join(f"{name}/{arity}" for name, arity in signatures)
