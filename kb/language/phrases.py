"""How primitives are said: a verb with places for objects, such as ``put {1} on {2}``."""

from collections.abc import Collection, Mapping, Sequence

from kb.lexicon.english import words_of
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.wordnet import table

USUAL_PREPOSITION = "with"
"""Before the second object of a primitive whose rule file names none."""

PACKS = frozenset({"bag", "bottle", "box", "can", "carton", "jar", "tin", "tube"})
"""Kinds of objects that are named by what is in them: ``can of tuna``."""


def phrase_pattern(
    name: str,
    general: Sequence[str],
    cases: Collection[str],
    count: int,
    words: Mapping[str, PrimitiveWords],
) -> str:
    """How a description says a primitive over so many objects: ``put {1} on {2}``.

    Args:
        name: The primitive.
        general: What it specialises, nearest first.
        cases: What holds of the segment, in the words of ``phrases.tsv``.
        count: How many objects it has.
        words: The words of the rule files, by primitive.
    """
    own = words.get(name)
    above = (*(own.general if own else ()), *general)
    for each in (name, *(above if own is None or not own.verbs else ())):
        for row in table("phrases"):
            if row["primitive"] == each and set(row["cases"].split()) <= set(cases):
                return row["pattern"]
    if own is not None and own.verbs:
        usual = "on" if "on" in cases else USUAL_PREPOSITION
        return built(own.verbs[0], count, (*own.prepositions, usual)[0])
    return built(words_of(name), count, "at" if "self" in cases else USUAL_PREPOSITION)


def built(verb: str, count: int, preposition: str) -> str:
    """A pattern of a verb over so many objects, the second after a preposition."""
    more = [f"and {{{number}}}" for number in range(3, count + 1)]
    parts = ["{1}"] * (count > 0) + [f"{preposition} {{2}}"] * (count > 1) + more
    return " ".join([verb, *parts])
