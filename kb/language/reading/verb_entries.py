"""Ways to say primitives, by the verb's first word: what else belongs to it, in which place."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from kb.language.reading.function_words import of_class, prepositions
from kb.language.vocabulary import Vocabulary
from kb.lexicon.english import Form, lemmas
from kb.lexicon.links import motion_senses, sense_links
from kb.lexicon.wordnet import Synset, table, wordnet

EE, OTHER = -1, 0
"""Places of an end-effector and of what no tracker follows, beside those of objects."""

ALWAYS_PARTICLES = frozenset({"up", "down", "over", "out", "off", "away", "back"})
"""Words that belong to the verb where they stand between it and its object."""


@dataclass(frozen=True, slots=True)
class Way:
    """One way to say a primitive: ``put {1} down on {2}``."""

    action: str
    head: str
    particles: frozenset[str]
    """Words that belong to the verb: ``down``."""

    slots: tuple[tuple[str, int], ...]
    """Preposition, or an empty text, and the number of the object; see `EE` and `OTHER`."""

    pattern: str
    rank: int
    """Lower for what is the usual reading."""


@dataclass(frozen=True)
class VerbEntries:
    """The verbs of a vocabulary."""

    words: Vocabulary

    @cached_property
    def ways(self) -> Mapping[str, tuple[Way, ...]]:
        """Ways to say primitives by the first word of the verb."""
        found: dict[str, dict[tuple[object, ...], Way]] = {}
        for rank, (action, pattern) in enumerate(self._patterns()):
            for entry in _ways(action, pattern, rank):
                shape = (entry.particles, entry.slots)
                found.setdefault(entry.head, {}).setdefault(shape, entry)
        return {head: tuple(each.values()) for head, each in found.items()}

    def _patterns(self) -> Iterator[tuple[str, str]]:
        yield from ((each.action, each.pattern) for each in self.words.entries)
        for name in ("spoken", "phrases"):
            yield from ((row["primitive"], row["pattern"]) for row in table(name))

    @property
    def beginnings(self) -> list[str]:
        """What a sentence may begin with: verbs of primitives, and words of questions."""
        return sorted({*self.ways, "who", "what", "when", "where", "which hand", "how often"})

    def known(self, verb: str) -> bool:
        """Whether a primitive is said with the verb, or WordNet has it."""
        return verb in self.ways or bool(wordnet().of_lemma(verb))

    def lemmas(self, word: str) -> tuple[tuple[str, Form], ...]:
        """The verbs that a word may be a form of; those of primitives first."""
        found = lemmas(word, self.known) if word.replace("-", "").isalpha() else ()
        return tuple(sorted(found, key=lambda each: each[0] not in self.ways))

    def related(self, verb: str) -> tuple[Way, ...]:
        """Ways to say what means the same as a verb that no primitive has, or is more general."""
        for key in motion_senses(verb):
            synset = wordnet().of_key(key)
            near = wordnet().steps_above(synset)
            steps = {synset: 0, **near}
            ranked = sorted((steps[top], head) for top, head in self._meanings if top in steps)
            if ranked:
                return self.ways[ranked[0][1]]
        return ()

    @cached_property
    def _meanings(self) -> tuple[tuple[Synset, str], ...]:
        """Synsets of the primitives that are of objects, with the verb that has them."""
        return tuple(
            (wordnet().of_key(link.key), link.verb)
            for each in self.words.words
            for link in sense_links(each)
            if link.key in wordnet()
            and link.verb in self.ways
            and (each.name, 1) in self.words.canonical
        )


def _ways(action: str, pattern: str, rank: int) -> Iterator[Way]:
    """A pattern as ways to say it; a manner of describing such as ``back`` is no part of it."""
    head, *rest = (word for word in pattern.split() if word not in {"the", "a", "someone"})
    particles: set[str] = set()
    slots: list[tuple[str, int]] = []
    pending: list[str] = []
    for word in rest:
        if not word.startswith("{"):
            pending.append(word)
            continue
        preposition = _preposition(pending, first=not slots and not particles)
        kept = len(pending) - len(preposition.split())
        particles |= _belonging(pending[:kept])
        slots.append((preposition, _number(word)))
        pending = []
    yield Way(action, head, frozenset(particles | _belonging(pending)), tuple(slots), pattern, rank)


def _number(place: str) -> int:
    name = place.strip("{}")
    return int(name) if name.isdigit() else {"ee": EE, "x": OTHER}[name]


def _belonging(pending: list[str]) -> set[str]:
    """The words of a verb; what only tells how it was done is left out."""
    if len(pending) > 1 and tuple(pending) in of_class("manner"):
        return {" ".join(pending)}
    ignored = {words[0] for words in of_class("manner") if len(words) == 1} - {
        "still",
        "away",
        "freely",
        "about",
        "around",
    }
    return {word for word in pending if word not in ignored and word not in {"to", "hands"}}


def _preposition(pending: list[str], *, first: bool) -> str:
    """The preposition at the end of what stands before an object."""
    if first and len(pending) == 1 and pending[0] in ALWAYS_PARTICLES:
        return ""
    for size in range(len(pending), 0, -1):
        if tuple(pending[-size:]) in prepositions():
            return " ".join(pending[-size:])
    return ""
