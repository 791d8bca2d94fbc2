"""Words that a sentence is held together by, by class: determiners, pronouns, relations, units."""

from collections.abc import Mapping
from functools import cache

from kb.language.tokens import Cursor
from kb.language.vocabulary import PREPOSITIONS
from kb.lexicon.wordnet import table

Phrases = Mapping[tuple[str, ...], str]
"""Values by the words that stand for them."""

SUBORDINATORS = ("while", "when", "before", "after", "until", "without")


@cache
def of_class(name: str) -> Phrases:
    """The words of a class with their values; a word without one has itself."""
    rows = [row for row in table("function_words") if row["class"] == name]
    return {tuple(row["word"].split()): row["value"] or row["word"] for row in rows}


@cache
def silent(name: str) -> frozenset[tuple[str, ...]]:
    """Those words of a class that say nothing that is kept: ``in all``."""
    rows = table("function_words")
    return frozenset(
        tuple(row["word"].split()) for row in rows if row["class"] == name and not row["value"]
    )


@cache
def prepositions() -> Phrases:
    """Every preposition."""
    stated = {tuple(each.split()): each for each in PREPOSITIONS}
    return {**stated, **of_class("preposition")}


@cache
def first_words(*classes: str) -> frozenset[str]:
    """The first words of the phrases of classes."""
    return frozenset(words[0] for name in classes for words in of_class(name))


def is_next(cursor: Cursor, name: str, ahead: int = 0) -> bool:
    """Whether a phrase of a class comes next, or after so many words."""
    start = cursor.at
    cursor.at = start + ahead
    found = cursor.longest(of_class(name)) is not None
    cursor.at = start
    return found


def is_manner(word: str) -> bool:
    """Whether a word looks like an adverb of manner that no table holds: ``gently``."""
    return len(word) > 4 and word.endswith("ly") and word not in {"only", "family", "supply"}


def number_at(cursor: Cursor) -> float | None:
    """Read a number, in figures or in words, after a word that makes it approximate."""
    start = cursor.at
    while cursor.longest(of_class("approximate")) is not None:
        pass
    word = cursor.peek()
    if word.replace(".", "", 1).isdigit():
        cursor.take()
        return float(word)
    tens, _, ones = word.partition("-")
    if ones and (tens,) in of_class("number") and (ones,) in of_class("number"):
        cursor.take()
        return float(of_class("number")[(tens,)]) + float(of_class("number")[(ones,)])
    found = cursor.longest(of_class("number"))
    if found is None:
        cursor.at = start
        return None
    return float(found)
