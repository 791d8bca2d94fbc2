"""How primitives are said: a verb with places for objects, such as ``put {1} on {2}``."""

from collections.abc import Collection, Iterable, Mapping, Sequence

from kb.lexicon.english import past, words_of
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.wordnet import table

USUAL_PREPOSITION = "with"
"""Before the second object of a primitive whose rule file names none."""

QUIET = frozenset({"reach for {1}", "let go of {1}", "take {ee} away"})
"""Patterns of the hand's own way to an object, or back from it."""

MOMENTARY = frozenset({"let go of {1}"})
"""Patterns of what happens as a segment begins: the rest of it is the hand's way back."""

GIVEN, RECEIVED = "hand {1} over", frozenset({"Receive", "Accept"})
"""The pattern of an object that another hand takes, and the names of taking it."""

GOALS = ("put {1} on {2}", "bring {1} to {2}")
"""How patterns begin of an object that gets to another one."""

FREE = "move {ee}"
"""The pattern of what a hand does that is of no object."""

PACKS = frozenset({"bag", "bottle", "box", "can", "carton", "jar", "tin", "tube"})
"""Kinds of objects that are named by what is in them: ``can of tuna``."""


class Phrasebook:
    """Patterns by primitive: shipped ones, and verbs of the rule files for all others."""

    def __init__(self, words: Iterable[PrimitiveWords] = ()) -> None:
        self._words: Mapping[str, PrimitiveWords] = {each.name: each for each in words}

    def pattern(self, name: str, general: Sequence[str], cases: Collection[str], count: int) -> str:
        """How a description says a primitive over so many objects: ``put {1} on {2}``.

        Args:
            name: The primitive.
            general: What it specialises, nearest first.
            cases: What holds of the segment, in the words of ``phrases.tsv``.
            count: How many objects it has.
        """
        shipped = _shipped(name, cases)
        if shipped:
            return shipped
        words = self._words.get(name)
        if words is not None and words.verbs:
            usual = "on" if "on" in cases else USUAL_PREPOSITION
            return built(words.verbs[0], count, (*words.prepositions, usual)[0])
        for above in (*(words.general if words else ()), *general):
            found = _shipped(above, cases)
            if found:
                return found
        return built(words_of(name), count, "at" if "self" in cases else USUAL_PREPOSITION)


def _shipped(name: str, cases: Collection[str]) -> str:
    for row in table("phrases"):
        if row["primitive"] == name and set(row["cases"].split()) <= set(cases):
            return row["pattern"]
    return ""


def built(verb: str, count: int, preposition: str) -> str:
    """A pattern of a verb over so many objects, the second after a preposition."""
    more = [f"and {{{number}}}" for number in range(3, count + 1)]
    parts = ["{1}"] * (count > 0) + [f"{preposition} {{2}}"] * (count > 1) + more
    return " ".join([verb, *parts])


def in_past(pattern: str) -> str:
    """The pattern with its verb in the past: ``reached for {1}``."""
    verb, _, rest = pattern.partition(" ")
    return f"{past(verb)} {rest}".strip()
