"""Many cases in one grounding: reading and rewriting the rules costs more than a case does.

Every predicate that depends on facts gets the number of a case as its first argument, in each rule
and in the facts, and each rule asks for a case: so cases cannot meet, whatever they are about.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import clingo
from clingo.ast import (
    AST,
    ASTType,
    Function,
    Literal,
    ProgramBuilder,
    Sign,
    SymbolicAtom,
    Transformer,
    Variable,
    parse_files,
)

from capar.model.errors import RuleError
from capar.model.facts import Fact
from capar_rules.engine.solver import as_term, text_of

Signature = tuple[str, int]
CASE = "NumberOfCase"
"""A variable that no rule uses."""


def solve_batch(files: Iterable[Path], cases: Sequence[Sequence[Fact]]) -> list[set[str]]:
    """What the rules answer to each of several sets of facts: the atoms that they show.

    Raises:
        RuleError: There is no answer, or more than one, to one of them.
    """
    statements: list[AST] = []
    parse_files([str(path) for path in files], statements.append, logger=_ignore)
    control = clingo.Control(["--models=2", "--warn=none"], logger=_ignore)
    numbered = _Numbered(statements)
    with ProgramBuilder(control) as builder:
        for statement in statements:
            builder.add(numbered.visit(statement))
    control.add("base", [], "".join(_facts(cases)))
    control.ground([("base", [])])
    return _answers(control, numbered, len(cases))


def _ignore(code: clingo.MessageCode, message: str) -> None:
    """Remarks on the rules are errors where a capture is observed; here they come once a case."""


def _facts(cases: Sequence[Sequence[Fact]]) -> Iterable[str]:
    for number, facts in enumerate(cases):
        yield f"case({number}).\n"
        for fact in facts:
            symbol = fact.symbol()
            arguments = [clingo.Number(number), *symbol.arguments]
            yield f"{clingo.Function(symbol.name, arguments)}.\n"


def _answers(control: clingo.Control, numbered: "_Numbered", cases: int) -> list[set[str]]:
    models: list[Sequence[clingo.Symbol]] = []
    control.solve(on_model=lambda model: models.append(model.symbols(shown=True)))
    if len(models) != 1:
        raise RuleError(f"these cases have {len(models) or 'no'} answers together")
    found: list[set[str]] = [set() for _ in range(cases)]
    for symbol in models[0]:
        if (symbol.name, len(symbol.arguments) - 1) in numbered.dependent:
            number, *arguments = map(as_term, symbol.arguments)
            found[int(str(number))].add(text_of((symbol.name, *arguments)))
        else:
            for answer in found:
                answer.add(text_of(as_term(symbol)))
    return found


class _Numbered(Transformer):
    """Adds the number of the case to the atoms and rules that depend on facts."""

    def __init__(self, statements: Sequence[AST]) -> None:
        self.dependent = _dependent(statements)

    def visit_Rule(self, rule: AST) -> AST:  # noqa: N802 (the name that clingo calls)
        """A rule for each case, where it depends on facts."""
        if not self.dependent & {*_signatures(rule.head), *_body_signatures(rule)}:
            return rule
        changed = rule.update(**self.visit_children(rule))
        place = rule.location
        case = Function(place, "case", [Variable(place, CASE)], 0)
        changed.body.append(Literal(place, Sign.NoSign, SymbolicAtom(case)))
        return changed

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802 (the name that clingo calls)
        """The atom of this case."""
        return SymbolicAtom(self._number(atom.symbol))

    def visit_ShowSignature(self, shown: AST) -> AST:  # noqa: N802 (the name that clingo calls)
        """The atoms of every case."""
        return self._widened(shown)

    def visit_Defined(self, defined: AST) -> AST:  # noqa: N802 (the name that clingo calls)
        """The atoms of every case."""
        return self._widened(defined)

    def _widened(self, named: AST) -> AST:
        numbered = (named.name, named.arity) in self.dependent
        return named.update(arity=named.arity + numbered)

    def _number(self, symbol: AST) -> AST:
        if symbol.ast_type is ASTType.Pool:
            return symbol.update(arguments=[self._number(each) for each in symbol.arguments])
        if (symbol.name, len(symbol.arguments)) not in self.dependent:
            return symbol
        return symbol.update(arguments=[Variable(symbol.location, CASE), *symbol.arguments])


def _dependent(statements: Sequence[AST]) -> set[Signature]:
    """The predicates that are stated as facts of a case, or rest on such."""
    uses: dict[Signature, set[Signature]] = defaultdict(set)
    found: set[Signature] = set()
    heads: set[Signature] = set()
    for statement in statements:
        if statement.ast_type is ASTType.Rule:
            for head in _signatures(statement.head):
                uses[head] |= {*_body_signatures(statement), *_signatures(statement.head)} - {head}
                heads.add(head)
        elif statement.ast_type is ASTType.Defined:
            found.add((statement.name, statement.arity))
    while wider := {head for head in heads - found if uses[head] & found}:
        found |= wider
    return found


def _body_signatures(rule: AST) -> Iterable[Signature]:
    for literal in rule.body:
        yield from _signatures(literal)


def _signatures(node: AST) -> Iterable[Signature]:
    """The predicates of the atoms in a part of a statement."""
    collector = _Collector()
    collector.visit(node)
    return collector.found


class _Collector(Transformer):
    def __init__(self) -> None:
        self.found: set[Signature] = set()

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802 (the name that clingo calls)
        """Note the predicates of an atom."""
        symbols: Any = [atom.symbol]
        if atom.symbol.ast_type is ASTType.Pool:
            symbols = atom.symbol.arguments
        self.found |= {(each.name, len(each.arguments)) for each in symbols}
        return atom
