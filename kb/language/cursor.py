"""A sentence as words with their places, a cursor that reads them, and what it remembers."""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches

from capar.model.errors import CaparError

SHOWN = 12
"""The most alternatives that a message lists."""


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


_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\d+\.\d+|[\w\'-]+|[^\w\s]')
ARTICLES = frozenset({"the", "a", "an"})
CONTRACTED = frozenset(
    {"what", "who", "where", "when", "how", "he", "she", "it", "that", "there", "here"}
)
"""Words that stand with a short form of ``is``."""


@dataclass(frozen=True, slots=True)
class Token:
    """A word of the sentence."""

    text: str
    column: int


def _parts(token: Token) -> tuple[Token, ...]:
    """A short form as the two words that it is: ``what's``."""
    head, _, tail = token.text.lower().partition("'")
    if tail != "s" or head not in CONTRACTED:
        return (token,)
    return Token(token.text[: len(head)], token.column), Token("is", token.column)


class Cursor:
    """Reads a sentence from left to right."""

    def __init__(self, text: str) -> None:
        self.text = text.strip()
        found = (Token(each.group(), each.start()) for each in _TOKEN.finditer(self.text))
        self.tokens = [part for each in found for part in _parts(each)]
        while self.tokens and self.tokens[-1].text in {".", "?", "!"}:
            self.tokens.pop()
        self.at = 0

    @property
    def done(self) -> bool:
        """Whether every word is read."""
        return self.at >= len(self.tokens)

    def peek(self, ahead: int = 0) -> str:
        """A word to come in lower case; empty beyond the end."""
        index = self.at + ahead
        return self.tokens[index].text.lower() if index < len(self.tokens) else ""

    def take(self) -> Token:
        """Read a word."""
        self.at += 1
        return self.tokens[self.at - 1]

    def accept(self, *words: str) -> bool:
        """Read these words if they come next."""
        if [self.peek(each) for each in range(len(words))] == list(words):
            self.at += len(words)
            return True
        return False

    def skip_article(self) -> bool:
        """Read an article if one comes next."""
        if self.peek() in ARTICLES:
            self.at += 1
            return True
        return False

    def longest(self, phrases: Mapping[tuple[str, ...], str]) -> str | None:
        """Read the longest of the phrases that comes next; None if none does."""
        for size in range(min(len(self.tokens) - self.at, _longest(phrases)), 0, -1):
            words = tuple(each.text for each in self.tokens[self.at : self.at + size])
            lower = tuple(each.lower() for each in words)
            for candidate in (words, lower):
                if candidate in phrases:
                    self.at += size
                    return phrases[candidate]
        return None

    def quoted(self) -> str:
        """Read a text in quotation marks."""
        token = self.take()
        try:
            return str(json.loads(token.text))
        except ValueError:
            raise self.error("no text in quotation marks", (), back=1) from None

    def error(
        self, problem: str, could_be: Iterable[str], *, back: int = 0, at: int | None = None
    ) -> SentenceError:
        """An error at the next word, or at one before it."""
        index = self.at - back if at is None else at
        if index < len(self.tokens):
            token = self.tokens[index]
            return SentenceError(self.text, token.column, token.text, problem, could_be)
        return SentenceError(self.text, len(self.text), "", problem, could_be)


def _longest(phrases: Mapping[tuple[str, ...], str]) -> int:
    return max(map(len, phrases), default=0)
