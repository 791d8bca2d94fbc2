"""Checks of a rule file by its text: how it is read, which statements it has, and cycles."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from capar.model.errors import RuleError
from capar.model.facts import LARGEST
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import (
    LARGEST_BYTES,
    Atom,
    Literal,
    Place,
    Signature,
    Statement,
    heads_of,
    nodes,
    nodes_read,
    parse_text,
    split_arguments,
    stated,
)
from capar_rules.lint.findings import NOTE, Finding, solver_findings

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

PRIMITIVE = ("primitive", 1)
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
        {name: each.place.file for each in rules for (name,) in stated([each], PRIMITIVE)},
        frozenset(rule.defines for rule in rules if isinstance(rule.defines, str)),
    )


def static_findings(own: Sequence[Statement], base: Known, *, file: str) -> Iterator[Finding]:
    """Every finding that needs no solver."""
    yield from _statements(own, base)
    yield from _predicates(own, base)
    yield from _primitives(own, base, file)
    if own and not (own[0].kind == "comment" and re.match(r"%\*\s*\w+:\s+\S", own[0].text)):
        yield Finding(
            own[0].place, "no-definition", "the file does not open with its definition in words.",
            "Begin it with a line such as %* Lift: a possessed object goes up. *%", NOTE,
        )  # fmt: skip


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


def _predicates(own: Sequence[Statement], base: Known) -> Iterator[Finding]:
    """Predicates that a file may not define, or that nothing defines."""
    names = introduced_names(own)
    copies = {file for name, file in base.primitives.items() if name in names and not _ships(file)}
    taken = (base.heads | base.inputs) - heads_of(
        each for each in base.rules if each.place.file in copies
    )
    arities = dict(AUTHORED.keys())
    words = base.heads | base.inputs | heads_of(own) | set(AUTHORED)
    words -= {("because", 3), ("because_part", 3)}
    for statement in own:
        for head in statement.heads:
            name, arity = head.signature
            if head.signature in taken and head.signature not in AUTHORED:
                listed = ", ".join(f"{word}/{count}" for word, count in AUTHORED)
                yield Finding(
                    head.place, "redefined-predicate",
                    f"{name}/{arity} is the rule base's own; a file may not add to it.",
                    f"Give yours another name, or state one of {listed}.",
                )  # fmt: skip
            elif arities.get(name, arity) != arity:
                yield Finding(
                    head.place, "wrong-arity",
                    f"{name} has {arities[name]} arguments, not {arity}.",
                    f"Write it like {AUTHORED[name, arities[name]]}.",
                )  # fmt: skip
        for literal in statement.body:
            yield from (_unknown(each, words) for each in literal.atoms
                        if each.signature not in words)  # fmt: skip


def _ships(file: str) -> bool:
    return Path(file).is_relative_to(rule_file("inputs.lp").parent)


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
    return {name for (name,) in stated(own, PRIMITIVE)}


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
                there = mine | set(base.primitives)
                for argument in {each.strip('"') for each in arguments} - there:
                    close = get_close_matches(argument, sorted(there), n=1)
                    yield Finding(
                        head.place, "unknown-primitive", f'there is no primitive "{argument}".',
                        f"Did you mean {close[0]}?" if close
                        else f"There are {', '.join(sorted(there))}.",
                    )  # fmt: skip
                if circle := _circle(head, [*base.rules, *own]):
                    yield Finding(
                        head.place, "circular", f"{head.text} closes a circle ({circle}): a "
                        "segment that fits them all would get no name.",
                        "State one order: take this line out, or another one of the circle.",
                    )  # fmt: skip
            if name == "feature_row":
                strings = [each.strip('"') for each in arguments[2:]]
                count = len(strings[2])
                right = (max(2 * count - 1, 0), max(2 * count - 1, 0), count, count)
                if tuple(map(len, strings)) != right or set("".join(strings)) - {"0", "1"}:
                    yield Finding(
                        head.place, "wrong-bits", f"{head.text} is no feature set.",
                        f"Over {count} objects the strings have {', '.join(map(str, right))} bits, "
                        "0 or 1.",
                    )  # fmt: skip
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


DEEPEST = 100
"""Greatest depth of nested brackets: deeper ones overflow the parser's stack."""

_INCLUDE = re.compile(r"#include\s*(\"([^\"\n]*)\"|<([^>\n]*)>|\S*)[^.\n]*\.?")
_STRING_OR_COMMENT = re.compile(r'"(?:[^"\\\n]|\\.)*"|%\*.*?\*%|%[^\n]*', re.DOTALL)


@dataclass(frozen=True)
class Reading:
    """A rule file's statements, or the findings that prevent parsing it."""

    file: str
    text: str
    statements: tuple[Statement, ...]
    findings: tuple[Finding, ...]
    included: tuple[Path, ...] = ()
    """Rule files that it includes."""


def read_rules(path: Path, *, folders: Iterable[Path] = ()) -> Reading:
    """Read a rule file; nothing in it is executed."""
    text, findings = _text(path)
    if not findings:
        findings = list(_tokens(text, path, tuple(folders)))
    if findings:
        return Reading(str(path), text, (), tuple(findings))
    included = []
    for found in _includes(text):
        included.append(path.parent / found[2])
        text = text[: found.start()] + _blank(found) + text[found.end() :]
    try:
        statements = parse_text(text)
    except RuleError as error:
        return Reading(str(path), text, (), tuple(solver_findings(str(error), str(path))))
    placed = tuple(_placed(each, str(path)) for each in statements)
    return Reading(str(path), text, placed, (), tuple(included))


def _text(path: Path) -> tuple[str, list[Finding]]:
    start = Place(str(path), 1, 1)
    if not path.is_file():
        return "", [Finding(start, "no-file", "there is no such file.", "Name a rule file, *.lp.")]
    if path.stat().st_size > LARGEST_BYTES:
        return "", [
            Finding(
                start, "too-large", f"it has more than {LARGEST_BYTES // 1024} kB.",
                "Split it: one primitive a file.",
            )
        ]  # fmt: skip
    try:
        content = path.read_bytes()
    except OSError as error:
        message = f"it cannot be read: {error.strerror}."
        return "", [
            Finding(start, "no-file", message, "Grant yourself read permission, or move it.")
        ]
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        place = Place(str(path), line, error.start - content.rfind(b"\n", 0, error.start))
        return "", [Finding(place, "encoding", "this is no UTF-8 text.", "Save it as UTF-8.")]
    return text, []


def _tokens(text: str, path: Path, folders: tuple[Path, ...]) -> Iterator[Finding]:
    """What is refused before anything is parsed: it could harm the parser or read other files."""
    bare = _STRING_OR_COMMENT.sub(_blank, text)
    if "\0" in text:
        yield _at(text, text.index("\0"), path, "encoding", "there is a zero byte.", "Remove it.")
    if text.startswith("\ufeff"):
        yield _at(text, 0, path, "encoding", "there is a byte-order mark.", "Save it without one.")
    for found in list(re.finditer(r"(?!\A)[^\x00-\x7f]|\A[^\x00-\x7f\ufeff]", bare))[:1]:
        yield _at(
            text, found.start(), path, "syntax", f"{found[0]!r} is not allowed in rules.",
            "Outside quoted texts and comments, write ASCII letters and digits.",
        )  # fmt: skip
    for found in re.finditer(r"\b\d{10,}\b", bare):
        if int(found[0][:20]) > LARGEST:
            yield _at(
                text, found.start(), path, "number", f"{found[0][:20]} is too large for the rules.",
                f"Stay within {LARGEST}: millimetres, frames and milliseconds do.",
            )  # fmt: skip
    for found in re.finditer(r"#(program|script)\b", bare):
        code = "script" if found[1] == "script" else "refused-statement"
        why = "#script runs code and is refused." if found[1] == "script" else (
            "#program is refused: rules stand in one program."
        )  # fmt: skip
        yield _at(text, found.start(), path, code, why, "Remove it; rules are logic alone.")
    for found in _includes(text):
        name = found[2] or found[3] or ""
        target = (path.parent / name).resolve()
        inside = any(target.parent == each.resolve() for each in folders) and name.endswith(".lp")
        if found[2] is None or not inside or not target.is_file():
            yield _at(
                text, found.start(), path, "include",
                f"#include of {name!r} reaches outside the rule folders and is refused.",
                "The rule base is there already; include only rule files beside this one.",
            )  # fmt: skip
    depth = deepest = 0
    for sign in bare:
        depth += (sign in "([{") - (sign in ")]}")
        deepest = max(deepest, depth)
    if deepest > DEEPEST:
        yield Finding(
            Place(str(path), 1, 1), "too-deep", f"brackets nest {deepest} deep.",
            f"Nest them at most {DEEPEST} deep.",
        )  # fmt: skip


def _includes(text: str) -> list[re.Match[str]]:
    """Every #include outside comments; a % in a quoted text begins no comment."""

    def shown(found: re.Match[str]) -> str:
        return found[0] if found[0].startswith('"') else _blank(found)

    return list(_INCLUDE.finditer(_STRING_OR_COMMENT.sub(shown, text)))


def _blank(found: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", found[0])


def _at(text: str, at: int, path: Path, code: str, message: str, remedy: str) -> Finding:
    line = text.count("\n", 0, at) + 1
    return Finding(Place(str(path), line, at - text.rfind("\n", 0, at)), code, message, remedy)


def _placed(value: Any, file: str) -> Any:
    """A statement with its file's name in all its places."""
    if isinstance(value, Place):
        return replace(value, file=file)
    if isinstance(value, tuple):
        return tuple(_placed(each, file) for each in value)
    if not isinstance(value, Statement | Literal | Atom):
        return value
    content = {each.name: _placed(getattr(value, each.name), file) for each in fields(value)}
    return replace(value, **content)


def cycle_findings(own: Sequence[Statement], base: Sequence[Statement]) -> Iterator[Finding]:
    """Each rule of a file through which a predicate depends on its own negation."""
    edges = list(_edges([*base, *own]))
    component = components(edges)
    negative = {component[head] for head, below, sign in edges
                if sign and component[head] == component[below]}  # fmt: skip
    for rule in own:
        for head, below, _ in _edges([rule]):
            if component.get(head, -1) == component.get(below) and component[head] in negative:
                circle = sorted({name for (name, _), at in component.items()
                                 if at == component[head]})  # fmt: skip
                yield Finding(
                    rule.place, "negative-cycle",
                    f"{head[0]} depends on its own negation, through {', '.join(circle)}; there "
                    "would be several answers, or none.",
                    "Make it depend on measurements and features, which names do not change.",
                )  # fmt: skip
                break


Edge = tuple[Signature, Signature, bool]
"""An edge of the dependency graph: head, predicate of the body, whether it is negated."""


def _edges(rules: Iterable[Statement]) -> Iterator[Edge]:
    rules = list(rules)
    named = {node for rule in rules for head in rule.heads for node in nodes(head)}
    for rule in rules:
        for head in rule.heads:
            for literal in rule.body:
                for atom in literal.atoms:
                    closed = literal.kind == "atom" and atom.sign == 0
                    for node in nodes(head):
                        for below in nodes_read(atom, named):
                            yield node, below, not closed


def components(edges: Sequence[Edge]) -> dict[Signature, int]:
    """The number of the strongly connected component of each predicate."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    every = sorted({node for head, below, _ in edges for node in (head, below)})
    number = {node: at for at, node in enumerate(every)}
    pairs = [(number[head], number[below]) for head, below, _ in edges]
    rows, columns = zip(*pairs, strict=True) if pairs else ((), ())
    graph = coo_array(([1] * len(pairs), (rows, columns)), shape=(len(every), len(every)))
    found = connected_components(graph, connection="strong")[1] if every else ()
    return dict(zip(every, map(int, found), strict=True))


WIDEST = 100_000
"""Greatest length of a range between two literal numbers."""

_RANGE = re.compile(r"(-?\d+)\.\.(-?\d+)")
_TEXT = re.compile(r'"(?:[^"\\\n]|\\.)*"')
_VARIABLE = re.compile(r"\b_*[A-Z]\w*")
_PLAIN = re.compile(r"_*[A-Z]\w*")


def growth_findings(own: Sequence[Statement]) -> Iterator[Finding]:
    """Ranges that are too wide, and recursions that keep making new values."""
    component = components(list(_edges(own)))
    for rule in own:
        if rule.kind != "rule":
            continue
        for low, high in _RANGE.findall(_TEXT.sub("", rule.text)):
            if int(high) - int(low) > WIDEST:
                yield Finding(
                    rule.place, "unbounded", f"the range {low}..{high} is too wide.",
                    f"Hold at most {WIDEST} numbers, or take them from a measurement, such as "
                    "tick(Hand, Tick, Frame).",
                )  # fmt: skip
        for name in _growing(rule, component):
            yield Finding(
                rule.place, "unbounded", f"this rule keeps making new values of {name} from "
                "its own.",
                f"Bind {name} by a measurement that does not depend on this rule, such as "
                "tick(Hand, Tick, Frame).",
            )  # fmt: skip


def _growing(rule: Statement, component: dict[Signature, int]) -> list[str]:
    """Variables of the head that the recursion changes and nothing outside it binds."""
    mine = {component[node] for head in rule.heads for node in nodes(head) if node in component}
    positive = [each for each in rule.body if each.kind == "atom" and each.sign == 0]
    again = [
        each
        for each in positive
        if any(component.get(node) in mine for atom in each.atoms for node in nodes(atom))
    ]
    if not again:
        return []
    bound = {
        name
        for each in positive
        if each not in again
        for name in _VARIABLE.findall(_TEXT.sub("", each.text))
    }
    passed = {
        argument
        for each in again
        for argument in split_arguments(each.text)
        if _PLAIN.fullmatch(argument)
    }
    growing: list[str] = []
    for head in rule.heads:
        for argument in split_arguments(head.text):
            kept = bound | (passed if _PLAIN.fullmatch(argument) else set())
            names = _VARIABLE.findall(_TEXT.sub("", argument))
            growing += [name for name in names if name not in kept]
    return list(dict.fromkeys(growing))
