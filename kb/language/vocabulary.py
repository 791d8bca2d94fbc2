"""What controlled English can express: verbs with their places, objects and end-effectors."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from kb.language.phrases import USUAL_PREPOSITION, built
from kb.lexicon.english import noun, past
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.wordnet import table

SIDES = ("right", "left")
PARTS = ("hand", "forearm", "elbow", "foot", "knee")
EFFECTORS = (*(f"{side}_{part}" for part in PARTS for side in SIDES), "head", "all")
"""End-effectors that sentences may name beside those that are given."""

EVERYTHING = "everything"
"""How the end-effector of a step common to all links is said."""

PREPOSITIONS = frozenset(row["preposition"] for row in table("prepositions"))
"""Words that may stand before a place or a thing."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A way to say a primitive: a verb, and the place of each object after it."""

    action: str
    verb: str
    """What stands before the first object: ``let go of``."""

    slots: tuple[tuple[str, int], ...]
    """Preposition, or an empty text, and the number of the object, as they follow."""

    pattern: str

    @property
    def shape(self) -> tuple[str, tuple[str, ...]]:
        """What a sentence shows of it."""
        return self.verb, tuple(preposition for preposition, _ in self.slots)


@dataclass(frozen=True)
class Vocabulary:
    """The words that can be read, and said."""

    words: tuple[PrimitiveWords, ...] = ()
    objects: frozenset[str] | None = None
    """The objects that there are; None takes any noun."""

    effectors: frozenset[str] = frozenset(EFFECTORS)
    agents: frozenset[str] = field(default_factory=frozenset)

    @cached_property
    def entries(self) -> tuple[Entry, ...]:
        """Every way to say a primitive; no two have the same shape."""
        rows = [entry(row["primitive"], row["pattern"]) for row in table("canonical")]
        claimed = {each.shape for each in rows}
        known = {each.action for each in rows}
        for words in sorted(self.words):
            if words.name in known or not words.verbs:
                continue
            for pattern in _patterns(words):
                own = entry(words.name, pattern)
                if own.shape not in claimed:
                    claimed.add(own.shape)
                    rows.append(own)
        return tuple(rows)

    @cached_property
    def canonical(self) -> Mapping[tuple[str, int], Entry]:
        """The usual way to say a primitive over so many objects."""
        usual: dict[tuple[str, int], Entry] = {}
        for each in self.entries:
            usual.setdefault((each.action, len(each.slots)), each)
        return usual

    @cached_property
    def verbs(self) -> Mapping[tuple[str, ...], str]:
        """Verbs by the words that say them, in the present and the past."""
        found: dict[tuple[str, ...], str] = {}
        for each in self.entries:
            found[tuple(each.verb.split())] = each.verb
            found[tuple(past(each.verb).split())] = each.verb
        return found

    @cached_property
    def nouns(self) -> Mapping[tuple[str, ...], str] | None:
        """Objects by the words that name them; None where any noun will do.

        A part of the body that is no object stands for the whole: the mouth for the head.
        """
        if self.objects is None:
            return None
        rows = [row for row in table("body_parts") if row["whole"] in self.objects]
        return {**{(row["part"],): row["whole"] for row in rows}, **_spoken(self.objects)}

    @cached_property
    def limbs(self) -> Mapping[tuple[str, ...], str]:
        """End-effectors by the words that name them."""
        return {**_spoken(self.effectors - {"all"}), (EVERYTHING,): "all"}


def entry(action: str, pattern: str) -> Entry:
    """A pattern as an entry: ``move {1} to {2}``."""
    verb, _, rest = pattern.partition(" {")
    slots: list[tuple[str, int]] = []
    preposition: list[str] = []
    for word in f"{{{rest}".split() if rest else ():
        if word.startswith("{"):
            slots.append((" ".join(preposition), int(word.strip("{}"))))
            preposition = []
        else:
            preposition.append(word)
    return Entry(action, verb, tuple(slots), pattern)


def _patterns(words: PrimitiveWords) -> Iterable[str]:
    stated = words.prepositions or (USUAL_PREPOSITION,)
    for verb in words.verbs:
        yield built(verb, 1, "")
        for preposition in stated:
            yield built(verb, 2, preposition)


def _spoken(names: Iterable[str]) -> dict[tuple[str, ...], str]:
    return {tuple(noun(name).split()): name for name in sorted(names)}
