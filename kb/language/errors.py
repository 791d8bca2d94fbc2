"""A sentence that cannot be read: where, and what could have stood there."""

from collections.abc import Iterable
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
