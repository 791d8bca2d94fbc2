"""Statements read back from a store, indexed by subject and property."""

from collections.abc import Iterable

from pyoxigraph import Literal, NamedNode, Quad, Triple

from kb.store.answers import Plain, plain
from kb.store.statements import TYPE


class StatementIndex:
    """Statements by subject and property."""

    def __init__(self, statements: Iterable[Quad | Triple]) -> None:
        self._said: dict[object, dict[NamedNode, list[NamedNode | Literal]]] = {}
        for statement in statements:
            if isinstance(statement.object, NamedNode | Literal):
                said = self._said.setdefault(statement.subject, {})
                said.setdefault(statement.predicate, []).append(statement.object)

    def __contains__(self, node: NamedNode) -> bool:
        """Whether anything is said of a thing."""
        return node in self._said

    def things(self, kind: NamedNode) -> list[NamedNode]:
        """Everything of a class, by IRI."""
        found = [
            node
            for node, said in self._said.items()
            if isinstance(node, NamedNode) and kind in said.get(TYPE, ())
        ]
        return sorted(found, key=lambda node: node.value)

    def all(self, node: NamedNode, predicate: NamedNode) -> list[NamedNode]:
        """Things that are said of a thing, by IRI."""
        values = self._said.get(node, {}).get(predicate, [])
        return sorted((v for v in values if isinstance(v, NamedNode)), key=lambda v: v.value)

    def one(self, node: NamedNode, predicate: NamedNode) -> NamedNode | None:
        """The thing that is said of a thing, if one is."""
        return next(iter(self.all(node, predicate)), None)

    def value(self, node: NamedNode, predicate: NamedNode) -> Plain:
        """The value that is said of a thing, if one is."""
        values = self._said.get(node, {}).get(predicate, [])
        return plain(values[0]) if values and isinstance(values[0], Literal) else None

    def text(self, node: NamedNode, predicate: NamedNode) -> str:
        """The text that is said of a thing; empty if none is."""
        value = self.value(node, predicate)
        return "" if value is None else str(value)

    def words(self, node: NamedNode, predicate: NamedNode) -> tuple[str, ...]:
        """The words of the text that is said of a thing."""
        return tuple(self.text(node, predicate).split())

    def number(self, node: NamedNode, predicate: NamedNode) -> float:
        """The number that is said of a thing; zero if none is."""
        value = self.value(node, predicate)
        return float(value) if value is not None else 0.0

    def count(self, node: NamedNode, predicate: NamedNode) -> int:
        """The whole number that is said of a thing; zero if none is."""
        return int(self.number(node, predicate))

    def ordered(self, node: NamedNode, predicate: NamedNode, *, by: NamedNode) -> list[NamedNode]:
        """Things that are said of a thing, in the order of their numbers."""
        return sorted(self.all(node, predicate), key=lambda each: self.count(each, by))
