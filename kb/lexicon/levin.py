"""Levin's verb classes: numbers, titles, what they are part of, and VerbNet's classes of them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

from capar.model.errors import UnknownNameError
from kb.lexicon.tables import table


@dataclass(frozen=True, slots=True)
class LevinClass:
    """A class of Levin's book (English Verb Classes and Alternations, 1993)."""

    number: str
    """``40.3.1``: its section of the book's second part."""

    broader: str
    """The class that it is part of, or empty."""

    title: str
    size: int
    """The number of verbs that the book lists; zero where it lists them by subclass."""

    verbnet: tuple[str, ...]
    """VerbNet 3.4's classes of the same verbs: ``wink-40.3.1``."""


@cache
def levin_classes() -> Mapping[str, LevinClass]:
    """Every class by its number, in the book's order."""
    rows = (
        LevinClass(
            row["number"],
            row["broader"],
            row["title"],
            int(row["members"] or 0),
            tuple(row["verbnet"].split()),
        )
        for row in table("levin")
    )
    return MappingProxyType({each.number: each for each in rows})


def levin_class(number: str) -> LevinClass:
    """The class of a number.

    Raises:
        UnknownNameError: The book has no such class.
    """
    known = levin_classes()
    if number not in known:
        raise UnknownNameError("Levin class", number, known)
    return known[number]


def above(number: str) -> Iterator[str]:
    """Numbers of the classes that a class is part of, nearest first."""
    broader = levin_class(number).broader
    while broader:
        yield broader
        broader = levin_class(broader).broader


def book_order(number: str) -> tuple[int, ...]:
    """A key that sorts 9.10 after 9.9."""
    return tuple(int(part) for part in number.split(".") if part)
