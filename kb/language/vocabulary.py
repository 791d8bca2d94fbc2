"""What controlled English can express: verbs and their objects, function words, hands."""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property

from capar.model.observation import Segment
from capar.model.par import Step
from kb.language.instruction import Instruction
from kb.language.phrases import USUAL_PREPOSITION, built
from kb.lexicon.english import Form, capital, lemmas, name_of, noun, the, words_of
from kb.lexicon.links import PrimitiveWords, motion_senses, sense_links
from kb.lexicon.wordnet import table, wordnet

SIDES = ("right", "left")
PARTS = ("hand", "forearm", "elbow", "foot", "knee")
EFFECTORS = (*(f"{side}_{part}" for part in PARTS for side in SIDES), "head", "all")
"""End-effectors that sentences may name beside those that are given."""

EVERYTHING = "everything"
"""How the end-effector of a step common to all links is said."""

PREPOSITIONS = frozenset(row["preposition"] for row in table("prepositions"))
"""Words that may stand before a place or a thing."""


@dataclass(frozen=True)
class Vocabulary:
    """The words that can be read, and said."""

    words: tuple[PrimitiveWords, ...] = ()
    objects: frozenset[str] | None = None
    """The objects that there are; None takes any noun."""

    effectors: frozenset[str] = frozenset(EFFECTORS)
    agents: frozenset[str] = field(default_factory=frozenset)

    @cached_property
    def entries(self) -> tuple[tuple[str, str], ...]:
        """Every way to say a primitive, with its pattern; no two have the same words."""
        rows = [(row["primitive"], row["pattern"]) for row in table("canonical")]
        known = {name for name, _ in rows}
        for words in sorted(self.words):
            if words.name not in known:
                usual = words.prepositions or (USUAL_PREPOSITION,)
                for verb in words.verbs:
                    rows.append((words.name, built(verb, 1, "")))
                    rows += [(words.name, built(verb, 2, preposition)) for preposition in usual]
        shapes: dict[str, tuple[str, str]] = {}
        for name, pattern in rows:
            shapes.setdefault(re.sub(r"\{\d+\}", "{}", pattern), (name, pattern))
        return tuple(shapes.values())

    @cached_property
    def canonical(self) -> Mapping[tuple[str, int], str]:
        """The usual pattern of a primitive over so many objects."""
        usual: dict[tuple[str, int], str] = {}
        for action, pattern in self.entries:
            usual.setdefault((action, pattern.count("{")), pattern)
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

    @cached_property
    def ways(self) -> Mapping[str, tuple["Way", ...]]:
        """Ways to say primitives by the first word of the verb."""
        rows = [
            *self.entries,
            *((row["primitive"], row["pattern"]) for row in table("spoken")),
            *((row["primitive"], row["pattern"]) for row in table("phrases")),
        ]
        found: dict[str, dict[tuple[object, ...], Way]] = {}
        for rank, (action, pattern) in enumerate(rows):
            way = _way(action, pattern, rank)
            own = found.setdefault(pattern.split()[0], {})
            own.setdefault((way.particles, way.slots), way)
        return {head: tuple(each.values()) for head, each in found.items()}

    @property
    def beginnings(self) -> list[str]:
        """What a sentence may begin with: verbs of primitives, and words of questions."""
        return sorted({*self.ways, "who", "what", "when", "where", "which hand", "how often"})

    def lemmas(self, word: str) -> tuple[tuple[str, Form], ...]:
        """The verbs that a word may be a form of; those of primitives first."""

        def known(verb: str) -> bool:
            return verb in self.ways or bool(wordnet().of_lemma(verb))

        found = lemmas(word, known) if word.replace("-", "").isalpha() else ()
        return tuple(sorted(found, key=lambda each: each[0] not in self.ways))

    def related(self, verb: str) -> tuple["Way", ...]:
        """Ways to say what means the same as a verb that no primitive has, or is more general."""
        meanings = [
            (wordnet().of_key(link.key), link.verb)
            for each in self.words
            for link in sense_links(each)
            if link.key in wordnet() and link.verb in self.ways and (each.name, 1) in self.canonical
        ]
        for key in motion_senses(verb):
            synset = wordnet().of_key(key)
            steps = {synset: 0, **wordnet().steps_above(synset)}
            ranked = sorted((steps[top], head) for top, head in meanings if top in steps)
            if ranked:
                return self.ways[ranked[0][1]]
        return ()


def _spoken(names: Iterable[str]) -> dict[tuple[str, ...], str]:
    return {tuple(noun(name).split()): name for name in sorted(names)}


@cache
def of_class(name: str) -> Mapping[tuple[str, ...], str]:
    """The words of a class with their values; a word without one has itself, an adverb none."""
    rows = [(word, "") for word in sorted(PREPOSITIONS)] if name == "preposition" else []
    rows += [(row["word"], row["value"]) for row in table("function_words") if row["class"] == name]
    return {
        tuple(word.split()): value or ("" if name == "manner" else word) for word, value in rows
    }


def is_nominal(word: str) -> bool:
    """Whether a noun phrase that is no name of an object may begin with a word: ``the``."""
    classes = ("determiner", "pronoun", "person", "limb")
    return any(word == words[0] for name in classes for words in of_class(name))


EE, OTHER = -1, 0
"""Places of an end-effector and of what no tracker follows, beside those of objects."""

ADVERBS = frozenset({"up", "down", "over", "out", "off", "away", "back"})
"""Words that belong to the verb where they stand between it and its object."""


@dataclass(frozen=True, slots=True)
class Way:
    """One way to say a primitive: ``put {1} down on {2}``."""

    action: str
    particles: frozenset[str]
    """Words that belong to the verb: ``down``."""

    slots: tuple[tuple[str, int], ...]
    """Preposition, or an empty text, and the number of the object; see `EE` and `OTHER`."""

    pattern: str
    rank: int
    """Lower for what is the usual reading."""


def _way(action: str, pattern: str, rank: int) -> Way:
    """A pattern as a way to say it; a manner of describing such as ``back`` is no part of it."""
    particles: set[str] = set()
    slots: list[tuple[str, int]] = []
    pending: list[str] = []
    for word in pattern.split()[1:]:
        if not word.startswith("{"):
            pending += [] if word in {"the", "a", "someone"} else [word]
            continue
        adverb = not slots and not particles and len(pending) == 1 and pending[0] in ADVERBS
        sizes = () if adverb else range(len(pending), 0, -1)
        starts = (len(pending) - size for size in sizes)
        known = (at for at in starts if tuple(pending[at:]) in of_class("preposition"))
        at = next(known, len(pending))
        particles |= _belonging(pending[:at])
        name = word.strip("{}")
        number = int(name) if name.isdigit() else {"ee": EE, "x": OTHER}[name]
        slots.append((" ".join(pending[at:]), number))
        pending = []
    return Way(action, frozenset(particles | _belonging(pending)), tuple(slots), pattern, rank)


def _belonging(pending: list[str]) -> set[str]:
    """The words of a verb; what only says how it was done is left out."""
    if len(pending) > 1 and tuple(pending) in of_class("manner"):
        return {" ".join(pending)}
    own = {"still", "away", "freely", "about", "around"}
    manner = {words[0] for words in of_class("manner") if len(words) == 1} - own
    return set(pending) - manner - {"to", "hands"}


def sentence(value: Instruction | Step | Segment, vocabulary: Vocabulary | None = None) -> str:
    """The sentence that says an instruction, and nothing else does."""
    said = value if isinstance(value, Instruction) else Instruction.of(value)
    call = said.call
    text = (vocabulary or Vocabulary()).canonical.get((call.action, len(call.objects)), "")
    for number, name in enumerate(call.objects, 1):
        text = text.replace(f"{{{number}}}", the(name))
    if not text:
        is_word = re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", call.action)
        text = f"perform {call.action if is_word else json.dumps(call.action)}"
        text += f" on {' and '.join(map(the, call.objects))}" if call.objects else ""
    text += f" from {the(said.source)}" if said.source else ""
    if said.ee:
        text += f" with {EVERYTHING if said.ee == 'all' else the(said.ee)}"
    if call.purpose:
        words = words_of(call.purpose)
        single = words.split() or [""]
        plain = (
            name_of(words) == call.purpose
            and words.replace(" ", "").isalpha()
            and not is_nominal(single[0])
            and not {"it", "them", "with", "and", "then", "while"}.intersection(single)
        )
        text += f" to {words}" if plain else f" for {json.dumps(call.purpose)}"
    return f"{the(said.agent)}, {text}." if said.agent else f"{capital(text)}."
