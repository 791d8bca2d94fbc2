"""What controlled English can express: verbs and their objects, function words, hands."""

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property

from capar.model.observation import Segment
from capar.model.par import Call, Step
from kb.language.cursor import Cursor
from kb.language.instruction import Instruction
from kb.language.phrases import USUAL_PREPOSITION, built
from kb.lexicon.english import Form, capital, lemmas, name_of, noun, the, words_of
from kb.lexicon.links import PrimitiveWords, motion_senses, sense_links
from kb.lexicon.wordnet import Synset, table, wordnet

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


Phrases = Mapping[tuple[str, ...], str]
"""Values by the words that stand for them."""


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
    own = {"still", "away", "freely", "about", "around"}
    manner = {words[0] for words in of_class("manner") if len(words) == 1} - own
    return set(pending) - manner - {"to", "hands"}


def _preposition(pending: list[str], *, first: bool) -> str:
    """The preposition at the end of what stands before an object."""
    if first and len(pending) == 1 and pending[0] in ALWAYS_PARTICLES:
        return ""
    for size in range(len(pending), 0, -1):
        if tuple(pending[-size:]) in prepositions():
            return " ".join(pending[-size:])
    return ""


_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def sentence(value: Instruction | Step | Segment, vocabulary: Vocabulary | None = None) -> str:
    """The sentence that says an instruction, and nothing else does."""
    words = vocabulary or Vocabulary()
    told = value if isinstance(value, Instruction) else Instruction.of(value)
    parts = [_core(told.call, words)]
    if told.source:
        parts.append(f"from {the(told.source)}")
    if told.ee:
        parts.append(f"with {EVERYTHING if told.ee == 'all' else the(told.ee)}")
    if told.call.purpose:
        parts.append(_purpose(told.call.purpose))
    text = " ".join(parts)
    return f"{the(told.agent)}, {text}." if told.agent else f"{capital(text)}."


def _core(call: Call, words: Vocabulary) -> str:
    usual = words.canonical.get((call.action, len(call.objects)))
    if usual is None:
        name = call.action if _PLAIN.fullmatch(call.action) else json.dumps(call.action)
        things = " and ".join(the(each) for each in call.objects)
        return f"perform {name} on {things}" if things else f"perform {name}"
    text = usual.pattern
    for number, name in enumerate(call.objects, 1):
        text = text.replace(f"{{{number}}}", the(name))
    return text


def _purpose(purpose: str) -> str:
    """The end: ``to pick up`` where the words give the name back, else the name in quotes."""
    words = words_of(purpose)
    plain = words and name_of(words) == purpose and words.replace(" ", "").isalpha()
    return f"to {words}" if plain else f"for {json.dumps(purpose)}"
