"""A sentence as words with their places, read from left to right, and what was spoken of before."""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache, wraps
from typing import Concatenate, ParamSpec, TypeVar

from capar.model.errors import CaparError
from kb.language.instruction import Instruction, Window
from kb.language.vocabulary import Vocabulary, is_nominal, of_class
from kb.lexicon.english import Form

SHOWN = 12
"""The most alternatives that a message lists."""

STOPS = (
    *("determiner", "person", "pronoun", "auxiliary", "negation", "particle", "manner"),
    *("relation", "count", "preposition"),
)
"""Classes of words that no name of an object goes on with."""

CONNECTIVES = frozenset({",", ".", ";", ":", "(", ")", "and", "or", "but", "then", "to", ""})
RELATIVES = frozenset({"who", "that", "which", "what", "where", "whose", "whom"})
CONTRACTED = frozenset(
    {"what", "who", "where", "when", "how", "he", "she", "it", "that", "there", "here"}
)
"""Words that stand with a short form of ``is``."""

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\d+\.\d+|[\w\'-]+|[^\w\s]')

P = ParamSpec("P")
T = TypeVar("T")


class SentenceError(CaparError):
    """A word that cannot be read.

    Attributes:
        text: The sentence.
        column: Where the word stands, from zero.
        word: The word, or an empty text at the end of the sentence.
        could_be: What could have stood there, sorted.
    """

    def __init__(
        self, text: str, column: int, word: str, problem: str, could_be: Iterable[str]
    ) -> None:
        self.text, self.column, self.word = text, column, word
        self.could_be = sorted(set(could_be))
        close = get_close_matches(word, self.could_be, n=1)
        hint = f" Did you mean {close[0]!r}?" if close else ""
        shown = ", ".join(self.could_be[:SHOWN])
        more = len(self.could_be) - SHOWN
        tail = f", and {more} more" if more > 0 else ""
        choices = f"; it could be: {shown}{tail}." if self.could_be else "."
        mark = " " * column + "^" * max(1, len(word))
        super().__init__(f"{problem}{choices}{hint}\n  {text}\n  {mark}")


@dataclass
class Adjuncts:
    """What was read beside objects; it grows while a clause is read."""

    manner: list[str] = field(default_factory=list)
    count: int = 0
    duration_s: float = 0.0
    window: Window | None = None

    def of(self, value: Instruction) -> Instruction:
        """An instruction with these, too."""
        own = value.circumstances
        return value.having(
            manner=(*own.manner, *self.manner),
            count=self.count or own.count,
            window=self.window or own.window,
            duration_s=self.duration_s or own.duration_s,
        )


class Reader:
    """Reads a sentence from left to right."""

    def __init__(self, text: str, words: Vocabulary) -> None:
        self.text, self.words = text.strip(), words
        self.tokens: list[str] = []
        self.columns: list[int] = []
        for each in _TOKEN.finditer(self.text):
            word, column = each.group(), each.start()
            head, _, tail = word.partition("'")
            if tail.lower() == "s" and head.lower() in CONTRACTED:
                self.tokens += [head, "is"]
                self.columns += [column, column]
            else:
                self.tokens.append(word)
                self.columns.append(column)
        while self.tokens and self.tokens[-1] in {".", "?", "!"}:
            self.tokens.pop()
        self.at = 0
        self.limit = len(self.tokens)
        """The word at which a name ends at the latest."""
        self.thing = self.place = self.limb = ""
        """What ``it`` is, where ``there`` is, and the hand that was spoken of last."""
        self.several: tuple[str, ...] = ()
        """What ``them`` are."""
        self.taken = "", ""
        """What was handled last, and with which hand."""
        self.gap = False
        """Whether a preposition may stand without its object: ``what did she look at``."""
        self.literals: frozenset[str] = frozenset()
        """Words that belong to the verb that is being read: ``go`` of ``let go``."""

    @property
    def done(self) -> bool:
        """Whether every word is read."""
        return self.at >= len(self.tokens)

    def peek(self, ahead: int = 0) -> str:
        """A word to come in lower case; empty beyond the end."""
        index = self.at + ahead
        return self.tokens[index].lower() if index < len(self.tokens) else ""

    def take(self) -> str:
        """Read a word."""
        self.at += 1
        return self.tokens[self.at - 1]

    def accept(self, *choices: str) -> bool:
        """Read the first of the phrases that comes next, if one does."""
        for words in map(str.split, choices):
            if [self.peek(ahead) for ahead in range(len(words))] == words:
                self.at += len(words)
                return True
        return False

    def longest(self, phrases: Mapping[tuple[str, ...], str]) -> str | None:
        """Read the longest of the phrases that comes next; None if none does."""
        for size in range(max(map(len, phrases), default=0), 0, -1):
            words = tuple(self.tokens[self.at : self.at + size])
            for candidate in (words, tuple(map(str.lower, words))):
                if candidate in phrases and len(words) == size:
                    self.at += size
                    return phrases[candidate]
        return None

    def of(self, name: str) -> str | None:
        """Read the longest phrase of a class that comes next: its value."""
        return self.longest(of_class(name))

    def look(self, read: Callable[["Reader"], T], ahead: int = 0) -> T:
        """What would be read next, or after so many words."""
        start = self.at
        self.at += ahead
        found = read(self)
        self.at = start
        return found

    def is_next(self, *classes: str, ahead: int = 0) -> bool:
        """Whether a phrase of one of the classes comes next, or after so many words."""
        return self.look(lambda r: any(r.of(each) is not None for each in classes), ahead)

    def stops(self, ahead: int = 0) -> bool:
        """Whether the next word cannot be a part of a name."""
        word = self.peek(ahead)
        return (
            self.at + ahead >= self.limit
            or word in CONNECTIVES | RELATIVES
            or word.startswith('"')
            or is_manner(word)
            or self.is_next(*STOPS, ahead=ahead)
        )

    def begins_noun(self, ahead: int = 0) -> bool:
        """Whether a noun phrase may begin at a word to come."""
        word = self.peek(ahead)
        relative = word in RELATIVES - {"whom"}
        return not relative and (is_nominal(word) or not self.stops(ahead))

    def verb_forms(self, ahead: int = 0) -> frozenset[Form]:
        """The forms of verbs that the next word may be."""
        return frozenset(form for _, form in self.words.lemmas(self.peek(ahead)))

    def verb_ahead(self) -> bool:
        """Whether the next word is a form of a verb that primitives are said with."""
        return any(lemma in self.words.ways for lemma, _ in self.words.lemmas(self.peek()))

    def finite_ahead(self) -> bool:
        """Whether a verb of a sentence with a subject comes next, after adverbs."""
        ahead = 0
        while is_manner(self.peek(ahead)) or self.peek(ahead) in {"then", "never"}:
            ahead += 1
        finite = self.verb_forms(ahead) & {Form.BASE, Form.PAST, Form.THIRD}
        return bool(finite) or self.is_next("auxiliary", ahead=ahead)

    def error(
        self, problem: str, could_be: Iterable[str], *, at: int | None = None
    ) -> SentenceError:
        """An error at the next word, or at another one."""
        index = self.at if at is None else at
        if index < len(self.tokens):
            column, word = self.columns[index], self.tokens[index]
            return SentenceError(self.text, column, word, problem, could_be)
        return SentenceError(self.text, len(self.text), "", problem, could_be)

    def match(self, kind: str) -> tuple[str | None, ...] | None:
        """Read a time or a count of a kind: what its numbers and units are, in their order."""
        found = _patterns()[kind].match(" ".join(map(str.lower, self.tokens[self.at :])))
        if found is None:
            return None
        self.at += len(found.group().split())
        return found.groups()

    def window(self) -> Window | None:
        """Read a time in which something is, if one comes next: ``between 3 and 8 s``."""
        if found := self.match("bracket"):
            moments = [float(each) for each in re.findall(r"\d+(?:\.\d+)?", found[0] or "")]
            return moments[0], moments[-1]
        if found := self.match("span"):
            first, unit, last, late = found
            return _seconds(first, unit or late), _seconds(last, late)
        if found := self.match("edge"):
            end, number, unit = found
            seconds = _seconds(number, unit)
            return (0.0, seconds) if end == "first" else (-seconds, math.inf)
        for kind in ("since", "until", "moment"):
            if found := self.match(kind):
                seconds = _seconds(*found)
                windows = {"since": (seconds, math.inf), "until": (0.0, seconds)}
                return windows.get(kind, (seconds, seconds))
        return None

    def adjunct(self, found: Adjuncts) -> bool:
        """Read a time, a count or a manner if one comes next."""
        if (window := self.window()) is not None:
            one = found.window or window
            found.window = min(one[0], window[0]), max(one[1], window[1])
        elif duration := self.match("duration"):
            found.duration_s = _seconds(*duration)
        elif count := self.match("count"):
            word, number = count
            found.count = int(of_class("count")[(word,)] if word else _value(number or "1"))
        elif is_manner(self.peek()):
            found.manner.append(self.take().lower())
        else:
            start = self.at
            after_place = self.look(lambda r: (r.of("preposition"), r.at)[1])
            manner = self.of("manner")
            if manner is None or after_place > self.at:
                self.at = start
                return False
            found.manner += [manner] if manner else []
        return True


def attempt(
    read: Callable[Concatenate[Reader, P], T],
) -> Callable[Concatenate[Reader, P], T]:
    """Let a reading that finds nothing go back to where it began."""

    @wraps(read)
    def tried(reader: Reader, /, *args: P.args, **kwargs: P.kwargs) -> T:
        start = reader.at
        found = read(reader, *args, **kwargs)
        if found is None or found is False:
            reader.at = start
        return found

    return tried


def is_manner(word: str) -> bool:
    """Whether a word looks like an adverb of manner that no table holds: ``gently``."""
    return len(word) > 4 and word.endswith("ly") and word not in {"only", "family", "supply"}


@cache
def _patterns() -> dict[str, re.Pattern[str]]:
    """Times and counts by their kind; each number and each unit is a group."""
    count, unit, approximate, ones = (
        "|".join(sorted((" ".join(each) for each in of_class(name)), key=len, reverse=True))
        for name in ("count", "unit", "approximate", "number")
    )
    number = rf"(?:(?:{approximate}) )*(\d+(?:\.\d+)?|(?:{ones})-(?:{ones})|{ones})"
    seconds = rf"{number} ({unit})"
    kinds = {
        "bracket": r"(\((?: \d+(?:\.\d+)?| [s–,-]| and)+ \))",
        "span": rf"(?:between|from) {number}(?: ({unit}))? (?:and|to|until|till) {seconds}",
        "edge": rf"(?:(?:in|within|during|for) )?(?:the )?(first|last) (?:{number} )?({unit})",
        "since": rf"(?:after|from|since|later than) {seconds}(?: on(?:wards)?)?",
        "until": rf"(?:before|until|within|by|up to|in) {seconds}",
        "moment": rf"at {seconds}",
        "duration": rf"for {seconds}",
        "later": rf"{seconds} later",
        "count": rf"(?:({count})(?! more\b)(?: in all)?"
        rf"|{number} (?:more )?times?(?: in (?:all|total))?)",
    }
    return {kind: re.compile(rf"{pattern}(?= |$)") for kind, pattern in kinds.items()}


def _value(number: str) -> float:
    words = of_class("number")
    return sum(
        float(part if part[0].isdigit() else words[tuple(part.split())])
        for part in number.split("-")
    )


def _seconds(number: str | None, unit: str | None) -> float:
    return _value(number or "1") * float(of_class("unit")[(unit or "s",)])
