"""Forms of verbs, read back: which verb ``stirred``, ``given`` or ``putting`` is of."""

from collections.abc import Callable, Iterator
from enum import StrEnum
from functools import cache

from kb.lexicon.tables import table


class Form(StrEnum):
    """A form of a verb."""

    BASE = "base"
    THIRD = "third person"
    PAST = "past"
    PARTICIPLE = "participle"
    GERUND = "gerund"


def lemmas(word: str, known: Callable[[str], bool]) -> tuple[tuple[str, Form], ...]:
    """The verbs that a word may be a form of, each with the form.

    Args:
        word: In lower case.
        known: Whether there is a verb.
    """
    found = dict.fromkeys(each for each in _candidates(word) if known(each[0]))
    return tuple(found)


def _candidates(word: str) -> Iterator[tuple[str, Form]]:
    yield word, Form.BASE
    yield from _irregular().get(word, ())
    if word.endswith("ing"):
        yield from ((each, Form.GERUND) for each in _stems(word[:-3]))
    if word.endswith("ed"):
        for form in (Form.PAST, Form.PARTICIPLE):
            yield from ((each, form) for each in _stems(word[:-2]))
    if word.endswith("s"):
        stems = (word[:-1], word[:-2] if word.endswith("es") else "")
        yield from ((each, Form.THIRD) for each in stems if each)
        if word.endswith("ies"):
            yield f"{word[:-3]}y", Form.THIRD


def _stems(stem: str) -> Iterator[str]:
    yield stem
    yield f"{stem}e"
    if stem[-1:] == stem[-2:-1]:
        yield stem[:-1]
    if stem.endswith("i"):
        yield f"{stem[:-1]}y"


@cache
def _irregular() -> dict[str, tuple[tuple[str, Form], ...]]:
    found: dict[str, list[tuple[str, Form]]] = {}
    for row in table("past_forms"):
        found.setdefault(row["past"], []).append((row["verb"], Form.PAST))
        found.setdefault(row["participle"], []).append((row["verb"], Form.PARTICIPLE))
    return {word: tuple(each) for word, each in found.items()}
