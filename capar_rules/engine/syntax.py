"""Rule files as values: rules, their parts, and the slice that an answer needs."""

import re
from collections import defaultdict
from collections.abc import Collection, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar

from clingo import MessageCode, ast

from capar.model.errors import RuleError

_ANONYMOUS = re.compile(r"(?<!\w)_(?!\w)")

ANSWERS = 8
"""Of how many lists of files the statements are kept; those of the whole base take 3 MB."""

Signature = tuple[str, int]
"""A predicate: its name and its number of arguments."""

_Predicate = TypeVar("_Predicate", bound=Hashable)

LARGEST_BYTES = 256 * 1024
"""Greatest size of a rule file, which people are to read [bytes]."""


@dataclass(frozen=True, slots=True, order=True)
class Place:
    """A place in a file; lines and columns from one."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        """The place in the form that editors recognise."""
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True)
class Literal:
    """One condition of a rule's body."""

    kind: str
    """``atom``, ``comparison``, ``aggregate``, ``conditional`` or ``theory``."""

    sign: int
    """Zero, or one for ``not``, or two for ``not not``."""

    text: str
    place: Place
    atoms: tuple["Atom", ...]
    """The atom itself, or those inside an aggregate or a conditional."""

    elements: tuple[tuple["Literal", ...], ...] = ()
    """The conditions of each element of an aggregate."""


@dataclass(frozen=True, slots=True)
class Atom:
    """An atom as it is written, with variables."""

    signature: Signature
    text: str
    sign: int
    place: Place


@dataclass(frozen=True, slots=True)
class Statement:
    """A rule or another statement of a rule file."""

    kind: str
    """``rule``, or clingo's name in lower case: ``script``, ``external`` ..."""

    place: Place
    text: str
    head_kind: str = ""
    """Of a rule: ``atom``, ``constraint``, ``choice``, ``disjunction`` or ``theory``."""

    heads: tuple[Atom, ...] = ()
    body: tuple[Literal, ...] = ()
    external: tuple[Place, ...] = field(default=())
    """Places of calls of external functions (``@name``)."""

    defines: Signature | str = ""
    """What ``#defined`` or ``#const`` names."""

    shows: Signature | None = None
    """What ``#show`` names."""


_LOCK = Lock()
_answers: dict[tuple[str, ...], tuple[dict[str, bytes], tuple[Statement, ...]]] = {}


def parse(files: Iterable[Path]) -> tuple[Statement, ...]:
    """The statements of rule files and of the files that they include, in order.

    The last few answers are kept, and hold as long as none of the files reads otherwise.

    Raises:
        RuleError: A file has a syntax error.
    """
    names = tuple(map(str, files))
    with _LOCK:
        contents, statements = _answers.pop(names, ({}, ()))
    if not contents or contents != _contents(contents):
        contents = _contents(names)
        statements = _parsed(lambda note, log: ast.parse_files(list(names), note, logger=log))
        contents = _contents(statement.place.file for statement in statements) | contents
    with _LOCK:
        _answers[names] = contents, statements
        while len(_answers) > ANSWERS:
            del _answers[next(iter(_answers))]
    return statements


def _contents(files: Iterable[str]) -> dict[str, bytes]:
    """What each file holds; nothing for what cannot be read."""
    paths = {file: Path(file) for file in files}
    return {file: path.read_bytes() if path.is_file() else b"" for file, path in paths.items()}


def parse_text(text: str) -> tuple[Statement, ...]:
    """The statements of a logic program.

    Raises:
        RuleError: The text has syntax errors; the message has one line for each.
    """
    return _parsed(lambda note, log: ast.parse_string(text, note, logger=log))


def split_arguments(text: str) -> list[str]:
    """The arguments of an atom as they are written."""
    inside = text[text.index("(") + 1 : -1] if "(" in text else ""
    parts, depth, quoted, start = [], 0, False, 0
    for at, sign in enumerate(inside):
        quoted ^= sign == '"' and inside[at - 1 : at] != "\\"
        depth += (not quoted) * ((sign in "([") - (sign in ")]"))
        if sign == "," and not depth and not quoted:
            parts.append(inside[start:at].strip())
            start = at + 1
    return [*parts, inside[start:].strip()]


def _parsed(run: Any) -> tuple[Statement, ...]:
    found: list[ast.AST] = []
    messages: list[str] = []

    def log(code: MessageCode, message: str) -> None:
        if code is not MessageCode.FileIncluded:
            messages.append(message.strip())

    try:
        run(found.append, log)
    except RuntimeError as error:
        raise RuleError("\n".join(messages) or str(error)) from None
    return tuple(_statement(each) for each in found if each.ast_type is not ast.ASTType.Program)


def _statement(node: ast.AST) -> Statement:
    place, text = _place(node), str(node)
    external = tuple(_external(node)) if "@" in text else ()
    statement = node.ast_type
    if statement is ast.ASTType.Rule:
        if _ANONYMOUS.search(text):
            node = _Named().visit(node)
            text = str(node)
        kind, heads = _head(node.head)
        body = tuple(_literal(each) for each in node.body)
        return Statement("rule", place, text, kind, heads, body, external)
    word = statement.name.lower()
    defines: Signature | str = ""
    if word == "defined":
        defines = (node.name, node.arity)
    elif word == "definition":
        defines = node.name
    shows = (node.name, node.arity) if word == "showsignature" else None
    return Statement(word, place, text, external=external, defines=defines, shows=shows)


class _Named(ast.Transformer):
    """Names anonymous variables of positive body atoms, so that explanations show their values."""

    def __init__(self) -> None:
        self.count = 0

    def visit_Literal(self, node: ast.AST) -> ast.AST:  # noqa: N802 (the parser's own word)
        """Leave negated atoms as they are: there a named variable would be unsafe."""
        if not _ANONYMOUS.search(str(node)) or node.sign != ast.Sign.NoSign:
            return node
        if node.atom.ast_type is ast.ASTType.Comparison:
            return node
        return node.update(**self.visit_children(node))

    def visit_Variable(self, node: ast.AST) -> ast.AST:  # noqa: N802
        """Name an anonymous variable."""
        if node.name != "_":
            return node
        self.count += 1
        return node.update(name=f"Any{self.count}")


_HEADS = {
    ast.ASTType.Aggregate: "choice",
    ast.ASTType.HeadAggregate: "choice",
    ast.ASTType.Disjunction: "disjunction",
    ast.ASTType.TheoryAtom: "theory",
}


def _head(node: ast.AST) -> tuple[str, tuple[Atom, ...]]:
    kind = _HEADS.get(node.ast_type, "atom")
    if kind != "atom":
        return kind, tuple(_atoms(node, 0))
    atom, sign = node.atom, int(node.sign)
    if atom.ast_type is not ast.ASTType.SymbolicAtom:
        return "constraint", ()
    return kind, tuple(_symbolic(atom, sign))


def _literal(node: ast.AST) -> Literal:
    place, text = _place(node), str(node)
    if node.ast_type is ast.ASTType.ConditionalLiteral:
        return Literal("conditional", 0, text, place, tuple(_atoms(node, 0)))
    atom, sign = node.atom, int(node.sign)
    kind = atom.ast_type
    if kind is ast.ASTType.SymbolicAtom:
        return Literal("atom", sign, text, place, tuple(_symbolic(atom, sign)))
    if kind in (ast.ASTType.BodyAggregate, ast.ASTType.Aggregate):
        elements = tuple(tuple(map(_literal, each.condition)) for each in atom.elements)
        return Literal("aggregate", sign, text, place, tuple(_atoms(atom, sign)), elements)
    if kind is ast.ASTType.TheoryAtom:
        return Literal("theory", sign, text, place, ())
    return Literal("comparison", sign, text, place, ())


_LEAVES = (ast.ASTType.SymbolicTerm, ast.ASTType.Variable, ast.ASTType.BooleanConstant)


def _atoms(node: ast.AST, sign: int) -> Iterator[Atom]:
    """Every atom below a node; the sign is the strongest negation on the way."""
    kind = node.ast_type
    if kind in _LEAVES:
        return
    if kind is ast.ASTType.Literal:
        sign = max(sign, int(node.sign))
    if kind is ast.ASTType.SymbolicAtom:
        yield from _symbolic(node, sign)
        return
    for child in _children(node):
        yield from _atoms(child, sign)


def _symbolic(node: ast.AST, sign: int) -> Iterator[Atom]:
    """An atom, or each of a pool of them."""
    symbol = node.symbol
    place = _place(symbol)
    while (kind := symbol.ast_type) is ast.ASTType.UnaryOperation:
        symbol = symbol.argument
    for each in symbol.arguments if kind is ast.ASTType.Pool else [symbol]:
        yield Atom((each.name, len(each.arguments)), str(node), sign, place)


def _external(node: ast.AST) -> Iterator[Place]:
    if node.ast_type is ast.ASTType.Function and node.external:
        yield _place(node)
    for child in _children(node):
        yield from _external(child)


def _children(node: ast.AST) -> Iterator[ast.AST]:
    for key in node.child_keys:
        child = getattr(node, key)
        if isinstance(child, ast.AST):
            yield child
        elif isinstance(child, Sequence) and not isinstance(child, str):
            yield from (each for each in child if isinstance(each, ast.AST))


def _place(node: ast.AST) -> Place:
    location = getattr(node, "location", None)
    if location is None:
        inner = next(_children(node), None)
        return Place("", 0, 0) if inner is None else _place(inner)
    begin = location.begin
    return Place(begin.filename, begin.line, begin.column)


def towards(
    statements: Sequence[Statement],
    targets: Iterable[Signature],
    *,
    given: Iterable[Signature] = (),
) -> list[Statement]:
    """The rules that targets depend on, and the constants, in order.

    ``statements``: A rule base. ``targets``: predicates to derive. ``given``: predicates that are
    defined elsewhere, whose rules are left out.
    """
    heads: dict[Signature, list[Statement]] = defaultdict(list)
    for each in statements:
        for head in each.heads:
            for node in nodes(head):
                heads[node].append(each)
    stated, named = set(given), set(heads)
    wanted, waiting = set(targets), sorted(targets)
    while waiting:
        for rule in heads[waiting.pop()]:
            below = {
                node
                for literal in rule.body
                for atom in literal.atoms
                if atom.signature not in stated
                for node in nodes_read(atom, named)
            }
            waiting += sorted(below - wanted)
            wanted |= below
    return [
        each
        for each in statements
        if each.kind == "definition"
        or any(node in wanted for head in each.heads for node in nodes(head))
    ]


def firing(statements: Sequence[Statement], measured: Iterable[Signature]) -> list[Statement]:
    """The rules that can fire if only these predicates have facts, and the constants.

    ``statements``: A rule base. ``measured``: predicates that have a fact.
    """
    parts = [(heads_of([each]), needed(each)) for each in statements]
    return [statements[number] for number in fired(parts, measured)]


def needed(statement: Statement) -> frozenset[Signature]:
    """The predicates without which a rule cannot fire."""
    return frozenset(
        literal.atoms[0].signature
        for literal in statement.body
        if literal.kind == "atom" and literal.sign == 0
    )


def fired(
    parts: Sequence[tuple[Collection[_Predicate], Collection[_Predicate]]],
    measured: Iterable[_Predicate],
) -> list[int]:
    """The numbers of the rules that can fire, in order.

    ``parts``: for each rule the predicates that it defines and those that it needs. ``measured``:
    predicates that have a fact.
    """
    known, found, waiting = set(measured), set[int](), list(range(len(parts)))
    while now := [number for number in waiting if known.issuperset(parts[number][1])]:
        found.update(now)
        known.update(*(parts[number][0] for number in now))
        waiting = [number for number in waiting if number not in found]
    return sorted(found)


def asked_for(statements: Sequence[Statement]) -> list[Statement]:
    """The rules that what is shown depends on, and every other statement.

    All of them, where more than the definitions of what is shown decides on the answer: choices,
    constraints, weights, or terms that are shown.

    ``statements``: A rule base.
    """
    shown = {each.shows for each in statements if each.shows is not None}
    if not shown or not all(map(_merely_defines, statements)):
        return list(statements)
    read = {id(each) for each in towards(statements, shown)}
    return [each for each in statements if each.kind != "rule" or id(each) in read]


def _merely_defines(statement: Statement) -> bool:
    if statement.kind == "rule":
        return statement.head_kind == "atom"
    return statement.kind in _SAYING_NOTHING or statement.shows is not None


_SAYING_NOTHING = ("comment", "defined", "definition")


FITS = ("fits", 2)
_NAME = re.compile(r'"(\w+)"')


def named_node(name: str) -> Signature:
    """The node of the dependency graph for fitting one primitive."""
    return f"fits {name}", 2


def nodes(atom: Atom) -> list[Signature]:
    """The predicate; fits has one node for each primitive, as one may depend on another."""
    if atom.signature == FITS:
        names = _NAME.findall(split_arguments(atom.text)[1])
        return [named_node(each) for each in names] or [FITS]
    return [atom.signature]


def nodes_read(atom: Atom, named: set[Signature]) -> list[Signature]:
    """The nodes that an atom of a body reads; fits of a variable reads those of every primitive."""
    found = nodes(atom)
    if FITS in found:
        return sorted({each for each in named if each[0].startswith("fits ")} | {FITS})
    return [*found, FITS] if found[0][0].startswith("fits ") else found


def heads_of(statements: Iterable[Statement]) -> frozenset[Signature]:
    """The predicates that rules define."""
    return frozenset(head.signature for each in statements for head in each.heads)


def stated(statements: Iterable[Statement], predicate: Signature) -> list[tuple[str, ...]]:
    """The arguments of each head of a predicate, in order, without quotation marks."""
    return [
        tuple(each.strip('"') for each in split_arguments(head.text))
        for rule in statements
        for head in rule.heads
        if head.signature == predicate
    ]


def reached(start: str, pairs: Iterable[tuple[str, ...]]) -> set[str]:
    """What pairs lead to from a start, in one step or several."""
    every, found = list(pairs), set[str]()
    while wider := {other for one, other in every if one in {start, *found}} - found:
        found |= wider
    return found


def signatures_below(statements: Iterable[Statement]) -> frozenset[Signature]:
    """The predicates that rules read."""
    return frozenset(
        atom.signature for each in statements for literal in each.body for atom in literal.atoms
    )
