"""Why an atom holds: the rules that derived it, recorded while the solver grounds them.

Several windows of facts are solved at once: each atom has the number of its window as first
argument, so that the rules are read and grounded once and no atom meets one of another window.
"""

import math
import re
from collections import defaultdict
from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache, lru_cache

import clingo

from capar.model.errors import RuleError
from capar.model.facts import ALL_FACT_KINDS, Fact
from capar_rules.engine.solver import ERRORS_ONLY
from capar_rules.engine.syntax import Atom, Literal, Place, Signature, Statement, firing, towards

SIGNS = ("<=", ">=", "<", ">")

ABSENT = "absent"
"""Functor of a negated literal among the children of a derivation."""


WINDOW = "W_"
"""A variable that no rule uses, for the number of a window."""

NUMBERS = "window_number"
"""The predicate of the numbers themselves."""

FACTS = {(each.predicate, len(fields(each))) for each in ALL_FACT_KINDS}
"""Predicates of facts, which a rule file may state too: measured, corrected, what moves what."""

_ATOM = re.compile(r"((?:not )*)(\w+)(?:\((.*)\))?", re.DOTALL)


class Numbering:
    """How statements are written so that the numbers of windows keep their atoms apart."""

    def __init__(self, statements: Iterable[Statement]) -> None:
        rules = [each for each in statements if each.kind == "rule"]
        derived = {head.signature for each in rules if each.body for head in each.heads}
        self.same = {head.signature for each in rules for head in each.heads} - derived - FACTS
        """Predicates that are stated in the rules alone, and are the same in every window."""

    def rule(self, statement: Statement) -> str:
        """A rule with the atoms of one window; other statements as they are."""
        heads = {head.signature for head in statement.heads}
        if statement.kind != "rule" or (heads and heads <= self.same):
            return statement.text
        if statement.head_kind == "constraint":
            return f":- {self.body(statement.body)}."
        head = statement.text.partition(" :- ")[0].removesuffix(".")
        return f"{self._inside(head, statement.heads)} :- {self.body(statement.body)}."

    def body(self, literals: Iterable[Literal], *more: str) -> str:
        """Conditions within one window, and others as they are."""
        return "; ".join((*map(self.literal, literals), *more, f"{NUMBERS}({WINDOW})"))

    def literal(self, literal: Literal) -> str:
        """A condition with the atoms of one window."""
        if literal.kind == "atom":
            return self.atom(literal.text, literal.atoms[0].signature)
        return self._inside(literal.text, literal.atoms)

    def atom(self, text: str, signature: Signature) -> str:
        """An atom, or its negation, of one window; of a pool, each."""
        found = _ATOM.fullmatch(text)
        if signature in self.same or found is None:
            return text
        negation, name, inside = found.groups()
        numbered = (f"{WINDOW},{each}" if each else WINDOW for each in _alternatives(inside or ""))
        return f"{negation}{name}({';'.join(numbered)})"

    def _inside(self, text: str, atoms: Iterable[Atom]) -> str:
        """A text with these of its atoms of one window."""
        known = {each.text: each.signature for each in atoms}
        if not known:
            return text
        every = "|".join(re.escape(each) for each in sorted(known, key=len, reverse=True))
        pattern = rf"(?<!\w)(?:{every})(?!\w)"
        return re.sub(pattern, lambda found: self.atom(found[0], known[found[0]]), text)


def _alternatives(inside: str) -> Iterator[str]:
    """The arguments of an atom, or those of each alternative of a pool."""
    depth, quoted, start = 0, False, 0
    for at, sign in enumerate(inside):
        quoted ^= sign == '"' and inside[at - 1 : at] != "\\"
        depth += (not quoted) * ((sign in "([") - (sign in ")]"))
        if sign == ";" and not depth and not quoted:
            yield inside[start:at]
            start = at + 1
    yield inside[start:]


@dataclass(frozen=True)
class Grounds:
    """A node of a derivation tree: an atom and the literals that its rule instance needed."""

    atom: str
    predicate: str
    arguments: tuple[str, ...]
    """Each as it is written; texts without quotes."""

    rule: Place | None
    """The rule that derived it; None for a fact and for a negated atom."""

    absent: bool
    because: tuple["Grounds", ...]


_SHOWN = ("because/4", "because_part/4", "also/3", "compared/5")
_INEQUALITY = re.compile(r"(.+?)\s*(<=|>=|<|>)\s*(.+)", re.DOTALL)

_SQUARE = re.compile(r"\b(\w+)\s*\*\s*\1\b")

Compared = tuple[float, str, float]
"""The left side of an inequality, its sign and its right side; of squares, their roots."""


class Recorder:
    """A rule base extended by rules that record which instances of its rules fired."""

    def __init__(
        self,
        statements: Iterable[Statement],
        *,
        targets: Iterable[Signature],
        compared: Container[Signature] = (),
    ) -> None:
        """Make rules ready."""
        self.rules = towards(list(statements), targets)
        self.numbering = Numbering(self.rules)
        recorded = [each for each in self.rules if each.body]
        self.recorded = recorded
        self._texts = {rule: [self.numbering.rule(rule)] for rule in self.rules}
        for number, rule in enumerate(recorded):
            self._texts[rule] += _records(number, rule, self.numbering)
            if any(head.signature in compared for head in rule.heads):
                self._texts[rule] += _comparisons(rule, self.numbering)

    @cache  # noqa: B019 - recorders are few and kept
    def text(self, measured: frozenset[Signature]) -> str:
        """The rules that can fire if these predicates have facts, each with its recording rules."""
        rules = firing(self.rules, measured)
        lines = (line for rule in dict.fromkeys(rules) for line in self._texts[rule])
        return "\n".join([*lines, *(f"#show {each}." for each in _SHOWN)])

    def solve(self, windows: Sequence[Sequence[Fact]]) -> list["Derivations"]:
        """For each window of facts, derive what follows from them alone, and record how.

        Raises:
            RuleError: The rules have an error over these facts, or no answer.
        """
        messages: list[str] = []
        control = clingo.Control(
            [ERRORS_ONLY, "--models=1"], logger=lambda _, text: messages.append(text)
        )
        try:
            kinds = {_symbol(fact) for facts in windows for fact in facts}
            measured = frozenset((each.name, len(each.arguments)) for each in kinds)
            control.add("base", [], self.text(measured))
            with control.backend() as backend:
                for each in _numbered(windows):
                    backend.add_rule([backend.add_atom(each)])
            control.ground([("base", [])])
        except RuntimeError as error:
            raise RuleError(f"the rules cannot be explained: {messages or error}") from None
        found = [Derivations(self.recorded, facts) for facts in windows]
        for symbol in _shown(control):
            window, *arguments = symbol.arguments
            found[window.number].note(symbol.name, arguments)
        return found


def _numbered(windows: Sequence[Sequence[Fact]]) -> Iterator[clingo.Symbol]:
    """The facts of each window, and the numbers of the windows."""
    for window, facts in enumerate(windows):
        number = clingo.Number(window)
        yield clingo.Function(NUMBERS, [number])
        for fact in facts:
            symbol = _symbol(fact)
            yield clingo.Function(symbol.name, [number, *symbol.arguments])


class Derivations:
    """The recorded rule instances of one window's answer; trees are built on demand."""

    def __init__(self, recorded: Sequence[Statement], facts: Sequence[Fact] = ()) -> None:
        self.recorded = recorded
        self.facts = facts
        self.instances: dict[clingo.Symbol, list[tuple[int, clingo.Symbol]]] = defaultdict(list)
        self.parts: dict[tuple[int, clingo.Symbol], list[clingo.Symbol]] = defaultdict(list)
        self.more: dict[clingo.Symbol, list[clingo.Symbol]] = defaultdict(list)
        self.compared: dict[str, dict[int, Compared]] = defaultdict(dict)
        """The inequalities in rules for an atom, whether it holds or not."""

        self.named: dict[str, dict[clingo.Symbol, None]] = defaultdict(dict)
        """Every derived atom by its predicate."""

    def note(self, kind: str, arguments: Sequence[clingo.Symbol]) -> None:
        """Keep a record, without its window."""
        if kind == "compared":
            head, place, left, right = arguments
            number, sign = divmod(place.number // 2, len(SIGNS))
            values = [float(one.number) for one in (left, right)]
            if place.number % 2:
                values = [math.sqrt(max(one, 0.0)) for one in values]
            self.compared[str(head)].setdefault(number, (values[0], SIGNS[sign], values[1]))
            return
        if kind == "also":
            head, other = arguments
            self.more[head].append(other)
            return
        number, head, body = arguments[0].number, arguments[1], arguments[2]
        if kind == "because_part":
            self.parts[number, head].append(body)
            return
        self.instances[head].append((number, body))
        self.named[self.recorded[number].heads[0].signature[0]][head] = None

    def holding(self, predicate: str) -> list[tuple[str, ...]]:
        """Arguments of each derived atom of a predicate, sorted."""
        return [
            tuple(map(_plain, each.arguments)) for each in sorted(self.named.get(predicate, ()))
        ]

    def atoms(self, predicates: Iterable[str]) -> Iterator[str]:
        """Every derived atom of some predicates."""
        for name in predicates:
            yield from map(str, self.named.get(name, ()))

    def why(self, atom: str) -> Grounds:
        """The derivation tree of an atom.

        Raises:
            RuleError: It was not derived.
        """
        for symbol in self.named.get(atom.partition("(")[0], ()):
            if str(symbol) == atom:
                return self._grounds(symbol, frozenset(), {})
        raise RuleError(f"{atom} does not hold")

    def _grounds(
        self,
        symbol: clingo.Symbol,
        above: frozenset[clingo.Symbol],
        done: dict[clingo.Symbol, Grounds],
    ) -> Grounds:
        if symbol in done:
            return done[symbol]
        rule, children = self._instance(symbol, above)
        below = above | {symbol}
        because = tuple(
            _missing(each.arguments[0]) if each.name == ABSENT else self._grounds(each, below, done)
            for each in children
        )
        found = Grounds(
            str(symbol), symbol.name, tuple(map(_plain, symbol.arguments)), rule, False, because
        )
        done[symbol] = found
        return found

    def _instance(
        self, symbol: clingo.Symbol, above: frozenset[clingo.Symbol]
    ) -> tuple[Place | None, list[clingo.Symbol]]:
        """The first rule instance that does not depend on an atom above it in the tree."""
        for number, body in sorted(self.instances.get(symbol, ())):
            children = list(body.arguments)
            for part in sorted(self.parts.get((number, symbol), ())):
                children += part.arguments
            if not above & set(children):
                children += sorted(self.more.get(symbol, ()))
                return self.recorded[number].place, list(dict.fromkeys(children))
        told_below = () if symbol in self.instances else self.more.get(symbol, ())
        return None, sorted(told_below)


def _missing(symbol: clingo.Symbol) -> Grounds:
    arguments = tuple(map(_plain, symbol.arguments))
    return Grounds(f"not {symbol}", symbol.name, arguments, None, True, ())


def _shown(control: clingo.Control) -> list[clingo.Symbol]:
    with control.solve(yield_=True) as handle:
        model = handle.model()
        if model is None:
            raise RuleError("the rules contradict each other over these facts")
        return list(model.symbols(shown=True))


@lru_cache(maxsize=1 << 14)
def _symbol(fact: Fact) -> clingo.Symbol:
    """A fact as the solver has it; the windows of neighbouring segments share most facts."""
    return fact.symbol()


def _plain(symbol: clingo.Symbol) -> str:
    return symbol.string if symbol.type is clingo.SymbolType.String else str(symbol)


def _records(number: int, rule: Statement, numbering: Numbering) -> list[str]:
    """Rules that record each instance of a rule, and each element of its aggregates."""
    if rule.head_kind != "atom" or (len(rule.heads) != 1 and ";" not in rule.heads[0].text):
        return []
    head = rule.heads[0].text
    literals, choices = _chosen(rule.body)
    body = numbering.body(literals, *choices)
    lines = [f"because({WINDOW},{number},{head},{_tuple(literals)}) :- {body}."]
    shared = _variables(head).union(
        *(_variables(one.text) for one in rule.body if one.kind in ("atom", "comparison"))
    )
    for literal in rule.body:
        for element in filter(None, literal.elements):
            inside = numbering.body(element)
            part = f"because_part({WINDOW},{number},{head},{_tuple(element)})"
            own = _variables(inside) - shared - {WINDOW}
            lines.append(_renamed(part, own) + f" :- {body}; {_renamed(inside, own)}.")
    return lines


def _comparisons(rule: Statement, numbering: Numbering) -> list[str]:
    """Rules that record both sides of each inequality wherever the atoms of the body hold."""
    if rule.head_kind != "atom" or len(rule.heads) != 1:
        return []
    others = [one for one in rule.body if one.kind == "atom" and not one.sign]
    others += [one for one in rule.body if re.fullmatch(r"\w+ = [^(;]+", one.text)]
    body = numbering.body(others)
    bound = _variables(body) | {WINDOW}
    lines, number = [], 0
    for one in rule.body:
        found = _INEQUALITY.fullmatch(one.text) if one.kind == "comparison" else None
        if found is None or one.sign:
            continue
        left, sign, right = found.groups()
        if _variables(one.text) <= bound:
            squared = bool(_SQUARE.search(left))
            place = 2 * (number * len(SIGNS) + SIGNS.index(sign)) + squared
            head = f"compared({WINDOW},{rule.heads[0].text},{place},{left},{right})"
            lines.append(f"{head} :- {body}.")
        number += 1
    return lines


_POOL = re.compile(r"(?<![\w\"])\([^()]*;[^()]*\)")


def _chosen(body: Sequence[Literal]) -> tuple[list[Literal], list[str]]:
    """The body with a variable for each pool of its atoms, and what those variables may be.

    A pool in the recording rule's head would be expanded separately, and the record would name
    every alternative, not the one that held.
    """
    literals: list[Literal] = []
    choices: list[str] = []
    for literal in body:
        text = literal.text
        while literal.kind == "atom" and literal.sign == 0 and (found := _POOL.search(text)):
            variable = f"Pool{len(choices)}"
            choices.append(f"{variable} = {found[0]}")
            text = text[: found.start()] + variable + text[found.end() :]
        literals.append(replace(literal, text=text))
    return literals, choices


_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')


def _variables(text: str) -> set[str]:
    return {each for each in _TOKEN.findall(text) if not each.startswith('"')}


def _renamed(text: str, names: set[str]) -> str:
    """The text with variables local to an aggregate renamed."""
    return _TOKEN.sub(lambda found: found[0] + "Inner" * (found[0] in names), text)


def _tuple(literals: Iterable[Literal]) -> str:
    """The positive and negated atoms among the literals as one term."""
    terms = []
    for each in literals:
        if each.kind == "atom" and each.sign == 0:
            terms.append(each.text)
        elif each.kind == "atom" and each.sign == 1:
            text = each.atoms[0].text.replace("(_", "(any").replace(",_", ",any")
            terms.append(f"{ABSENT}({text})")
    return f"({','.join(terms)},)" if terms else "()"
