"""Small faults that a program could have: every one of a rule file or of a Python module."""

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import unified_diff
from hashlib import sha256

from clingo import ast as rules_ast

from capar.model.errors import RuleError
from capar_rules.engine.solver import understand


@dataclass(frozen=True, slots=True, order=True)
class Mutation:
    """One place of a text and what stands there instead."""

    start: int
    """Offset of the first byte that is replaced."""

    end: int
    kind: str
    """``comparison``, ``negation`` ..."""

    replacement: str

    def applied(self, text: str) -> str:
        """The text with the fault in it."""
        content = text.encode()
        return (content[: self.start] + self.replacement.encode() + content[self.end :]).decode()

    def name(self, file: str) -> str:
        """A name of the fault in its file, the same in every run."""
        told = f"{file}:{self.start}:{self.end}:{self.replacement}"
        return sha256(told.encode()).hexdigest()[:12]


def difference(file: str, before: str, after: str) -> str:
    """What a fault changes, as a patch."""
    lines = before.splitlines(keepends=True), after.splitlines(keepends=True)
    return "".join(unified_diff(*lines, file, file, n=2))


# Rule files.

_INCLUDE = re.compile(r"^#include .*$", re.MULTILINE)
_COMPARISON = re.compile(r"<=|>=|!=|<|>|=")
_OPPOSITE = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "=": "!=", "!=": "="}
_NEIGHBOURS = {"start": "end", "end": "start", "above": "below", "below": "above"}


def of_rules(text: str) -> Iterator[Mutation]:
    """Every fault of a rule file: of conditions, numbers and words, and of whole rules."""
    starts = _line_starts(text)
    for statement in _parsed(text):
        if statement.ast_type is rules_ast.ASTType.Rule:
            yield Mutation(*_span(statement, starts), "rule", "")
            for literal in statement.body:
                yield from _of_condition(literal, text, starts)
            yield from _of_terms(statement, starts)


def rules_differ(before: str, after: str) -> bool:
    """Whether a changed rule file can be loaded, and says something else."""
    try:
        understand(_INCLUDE.sub(_blank, after))
        return _said(before) != _said(after)
    except (RuleError, RuntimeError):
        return False


def _said(text: str) -> list[str]:
    kept = (str(each).replace("#true; ", "").replace("; #true", "") for each in _parsed(text))
    return sorted(set(kept))


def _parsed(text: str) -> list[rules_ast.AST]:
    found: list[rules_ast.AST] = []
    rules_ast.parse_string(_INCLUDE.sub(_blank, text), found.append, logger=lambda *_: None)
    left_out = rules_ast.ASTType.Comment, rules_ast.ASTType.Program
    return [each for each in found if each.ast_type not in left_out]


def _blank(found: re.Match[str]) -> str:
    return " " * len(found[0].encode())


def _span(node: rules_ast.AST, starts: list[int]) -> tuple[int, int]:
    begin, end = node.location.begin, node.location.end
    return starts[begin.line - 1] + begin.column - 1, starts[end.line - 1] + end.column - 1


def _of_condition(literal: rules_ast.AST, text: str, starts: list[int]) -> Iterator[Mutation]:
    if literal.ast_type is not rules_ast.ASTType.Literal:
        return
    start, end = _span(literal, starts)
    written = text.encode()[start:end].decode()
    yield Mutation(start, end, "condition", "#true")
    if literal.atom.ast_type is rules_ast.ASTType.SymbolicAtom:
        negated = literal.sign != rules_ast.Sign.NoSign
        other = re.sub(r"^(not\s+)+", "", written) if negated else f"not {written}"
        yield Mutation(start, end, "negation", other)
    elif literal.atom.ast_type is rules_ast.ASTType.Comparison:
        other = _COMPARISON.sub(lambda found: _OPPOSITE[found[0]], written, count=1)
        yield Mutation(start, end, "comparison", other)


def _of_terms(node: rules_ast.AST, starts: list[int]) -> Iterator[Mutation]:
    """Numbers that are one larger, and words that stand for their opposite."""
    if node.ast_type is rules_ast.ASTType.SymbolicTerm:
        written = str(node.symbol)
        if re.fullmatch(r"\d+", written):
            yield Mutation(*_span(node, starts), "number", str(int(written) + 1))
        elif written in _NEIGHBOURS:
            yield Mutation(*_span(node, starts), "word", _NEIGHBOURS[written])
    for key in node.child_keys:
        child = getattr(node, key)
        for each in [child] if isinstance(child, rules_ast.AST) else child or ():
            yield from _of_terms(each, starts)


# Python modules.

_COMPARED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
_COMPUTED: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
}  # fmt: skip
_TYPES = {"annotation", "returns", "decorator_list", "type_params", "bases"}
"""Where a module speaks of types: nothing of that is computed."""


def of_python(text: str, *, words: Mapping[str, int]) -> Iterator[Mutation]:
    """Every fault of a module: of comparisons, sums, conditions and numbers.

    Args:
        text: The module.
        words: How often each word stands in the project; a function named once is dead code.
    """
    starts = _line_starts(text)
    once = {name for name in _functions(text) if words.get(name, 0) < 2}
    for node in _live(ast.parse(text), once):
        for kind, replacement in _of_node(node):
            start = starts[node.lineno - 1] + node.col_offset
            end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
            yield Mutation(start, end, kind, replacement)


def python_differs(before: str, after: str) -> bool:
    """Whether a changed module can be compiled, and says something else."""
    try:
        return ast.dump(ast.parse(before)) != ast.dump(ast.parse(after))
    except SyntaxError:
        return False


def _functions(text: str) -> set[str]:
    kinds = ast.FunctionDef | ast.AsyncFunctionDef
    named = {each.name for each in ast.walk(ast.parse(text)) if isinstance(each, kinds)}
    return {name for name in named if not name.startswith("__")}


def _live(node: ast.AST, dead: set[str]) -> Iterator[ast.expr]:
    """Expressions that are computed when the module runs; no texts and no types."""
    if isinstance(node, ast.FunctionDef) and node.name in dead:
        return
    if isinstance(node, ast.JoinedStr | ast.Raise | ast.Import | ast.ImportFrom):
        return
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Tuple | ast.Constant):
        yield from _live(node.value, dead)
        return
    if isinstance(node, ast.expr):
        yield node
    for key, value in ast.iter_fields(node):
        if key not in _TYPES:
            for each in value if isinstance(value, list) else [value]:
                if isinstance(each, ast.AST):
                    yield from _live(each, dead)


def _of_node(node: ast.expr) -> Iterator[tuple[str, str]]:
    match node:
        case ast.Compare(ops=[op, *rest]) if type(op) in _COMPARED:
            other = ast.Compare(node.left, [_COMPARED[type(op)](), *rest], node.comparators)
            yield "comparison", f"({ast.unparse(other)})"
        case ast.BinOp(op=op) if type(op) in _COMPUTED and not _text_in(node):
            other = ast.BinOp(node.left, _COMPUTED[type(op)](), node.right)
            yield "arithmetic", f"({ast.unparse(other)})"
        case ast.BoolOp(op=op):
            swapped = ast.And() if isinstance(op, ast.Or) else ast.Or()
            yield "connective", f"({ast.unparse(ast.BoolOp(swapped, node.values))})"
        case ast.UnaryOp(op=ast.Not()):
            yield "negation", f"({ast.unparse(node.operand)})"
        case ast.IfExp():
            other = ast.IfExp(ast.UnaryOp(ast.Not(), node.test), node.body, node.orelse)
            yield "negation", f"({ast.unparse(other)})"
        case ast.Constant(value=bool() as value):
            yield "truth", str(not value)
        case ast.Constant(value=int() | float() as value):
            yield "number", str(value + 1 if isinstance(value, int) else value * 2.0 + 0.1)


def _text_in(node: ast.BinOp) -> bool:
    return any(
        isinstance(each, ast.JoinedStr) or (isinstance(each, ast.Constant) and _is_text(each))
        for each in (node.left, node.right)
    )


def _is_text(node: ast.Constant) -> bool:
    return isinstance(node.value, str | bytes)


def _line_starts(text: str) -> list[int]:
    """The offset of each line's first byte."""
    starts = [0]
    for line in text.encode().splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    return starts
