"""The shipped tables of words, and the verbs of WordNet 3.1."""

import csv
import gzip
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from capar.model.errors import UnknownNameError

FOLDER = files("ontology") / "lexicon"
"""Where the words' data files lie."""


@cache
def table(name: str) -> tuple[dict[str, str], ...]:
    """The rows of a shipped ``NAME.tsv``, each by the names of its columns."""
    text = (FOLDER / f"{name}.tsv").read_text(encoding="utf-8")
    rows = csv.DictReader(text.splitlines(), delimiter="\t", quoting=csv.QUOTE_NONE)
    return tuple(rows)


def compressed_lines(name: str) -> list[str]:
    """The lines of a shipped ``NAME.tsv.gz``."""
    packed = (FOLDER / f"{name}.tsv.gz").read_bytes()
    return gzip.decompress(packed).decode("utf-8").splitlines()


@dataclass(frozen=True, slots=True, order=True)
class Sense:
    """A verb in one of its meanings."""

    lemma: str
    """As WordNet writes it, words joined by underscores: ``pick_up``."""

    key: str
    """``hit%2:35:00::``: what stays the same from one WordNet to the next."""

    number: int
    """Its rank among the lemma's senses, from one, by frequency."""


@dataclass(frozen=True, slots=True)
class Synset:
    """A meaning, with every verb that has it."""

    offset: str
    """Eight digits, its place in WordNet 3.1's data file."""

    ili: str
    """``i28723``: its interlingual index, or empty where none is known."""

    lexfile: int
    """The number of its lexicographer file: 35 contact, 38 motion ..."""

    senses: tuple[Sense, ...]
    hypernyms: tuple[str, ...]
    """Offsets of the synsets that it is a kind of."""

    frames: tuple[str, ...]
    """Numbers of the generic sentences, each with ``:word`` where it fits one word only."""

    gloss: str
    """Definition, then examples in quotation marks."""

    @property
    def definition(self) -> str:
        """The gloss without its examples."""
        return self.gloss.partition('; "')[0].rstrip("; ")

    @property
    def lemmas(self) -> tuple[str, ...]:
        """Its verbs, as people write them."""
        return tuple(sense.lemma.replace("_", " ") for sense in self.senses)


class WordNet:
    """Every verb synset; a row becomes a value when it is asked for."""

    def __init__(self, lines: Iterable[str]) -> None:
        self._rows: dict[str, str] = {}
        self._by_key: dict[str, str] = {}
        self._by_lemma: dict[str, list[tuple[int, str]]] = {}
        self._below: dict[str, list[str]] = {}
        for line in lines:
            offset, _, _, words, above, _ = line.split("\t", 5)
            self._rows[offset] = line
            for word in words.split(" "):
                lemma, key, number = word.lower().split(",")
                self._by_key[f"{lemma}%{key}"] = offset
                self._by_lemma.setdefault(lemma, []).append((int(number), offset))
            for hypernym in above.split():
                self._below.setdefault(hypernym, []).append(offset)
        self._synset = cache(self._parse)

    def _parse(self, offset: str) -> Synset:
        _, ili, lexfile, words, above, frames, gloss = self._rows[offset].split("\t")
        fields = (word.split(",") for word in words.split(" "))
        senses = tuple(
            Sense(lemma, f"{lemma.lower()}%{key}", int(number)) for lemma, key, number in fields
        )
        up, sentences = tuple(above.split()), tuple(frames.split())
        return Synset(offset, ili, int(lexfile), senses, up, sentences, gloss)

    def __iter__(self) -> Iterator[Synset]:
        """Every synset, by offset."""
        return map(self._synset, sorted(self._rows))

    @property
    def lemmas(self) -> tuple[str, ...]:
        """Every verb, sorted, words joined by underscores."""
        return tuple(sorted(self._by_lemma))

    def __contains__(self, key: str) -> bool:
        """Whether a sense key is known."""
        return normal_key(key) in self._by_key

    def of_key(self, key: str) -> Synset:
        """The synset of a sense key, complete or without its two last colons.

        Raises:
            UnknownNameError: WordNet 3.1 has no such verb sense; the verb's own keys are listed.
        """
        full = normal_key(key)
        if full not in self._by_key:
            known = [sense.key for sense, _ in self.of_lemma(full.partition("%")[0])]
            raise UnknownNameError("WordNet 3.1 verb sense", key, known)
        return self._synset(self._by_key[full])

    def of_lemma(self, lemma: str) -> tuple[tuple[Sense, Synset], ...]:
        """The senses of a verb in their order, none if WordNet lacks it."""
        word = lemma.strip().lower().replace(" ", "_")
        found = (self._synset(offset) for _, offset in sorted(self._by_lemma.get(word, ())))
        return tuple(
            (sense, synset)
            for synset in found
            for sense in synset.senses
            if sense.lemma.lower() == word
        )

    def directly_below(self, synset: Synset) -> tuple[Synset, ...]:
        """The synsets one step below this one, by offset."""
        return tuple(map(self._synset, sorted(self._below.get(synset.offset, ()))))

    def steps_above(self, synset: Synset) -> dict[Synset, int]:
        """How many steps above this one each synset stands, nearest first."""
        seen, found, level = {synset.offset}, dict[Synset, int](), [synset]
        while level:
            above = sorted({offset for each in level for offset in each.hypernyms} - seen)
            seen.update(above)
            level = [self._synset(offset) for offset in above]
            steps = 1 + max(found.values(), default=0)
            found |= dict.fromkeys(level, steps)
        return found


def normal_key(key: str) -> str:
    """A sense key in WordNet's own form, from that of VerbNet (``?hit%2:35:00``)."""
    bare = key.removeprefix("?").lower()
    return bare if bare.endswith("::") else f"{bare}::"


@cache
def wordnet() -> WordNet:
    """The shipped verbs, read once."""
    return WordNet(compressed_lines("wordnet-3.1-verbs"))


@cache
def frame_sentence(frame: str) -> str:
    """The generic sentence of a frame's number: ``Somebody ----s something``."""
    number = frame.partition(":")[0]
    return next(row["frame"] for row in table("wordnet-frames") if row["number"] == number)
