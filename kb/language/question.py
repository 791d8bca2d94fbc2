"""Questions about what was done, as SPARQL over an Actionary."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import TypeVar

from kb.language.instruction import Instruction
from kb.language.querying import never_sparql, question_sparql

Row = TypeVar("Row")


class Ask(Enum):
    """What a question asks for; its value is the variable that answers it."""

    WHO = "performer"
    WHICH_HAND = "ee"
    WHEN = "start"
    HOW_LONG = "duration"
    WHERE_SEEN = "observation"
    HOW_OFTEN = "times"
    HOW_MANY = "things"
    HOW_MANY_AGENTS = "performers"
    WHAT = "object"
    ACTION = "action"
    WHERE = "place"
    SOURCE = "source"
    WHETHER = "whether"
    HOW = "how"


_SHOWN = ("observation", "performer", "ee", "start", "end", "duration")
_GROUPS = {
    Ask.HOW_OFTEN: ("(COUNT(DISTINCT ?segment) AS ?times)", "?observation ?performer"),
    Ask.HOW_MANY: ("(COUNT(DISTINCT ?object) AS ?things)", "?observation"),
    Ask.HOW_MANY_AGENTS: ("(COUNT(DISTINCT ?performer) AS ?performers)", "?observation"),
}
_NEVER = {Ask.WHAT: "object", Ask.WHO: "performer", Ask.WHICH_HAND: "ee"}
"""What is asked for where it is asked of what was not done."""

_BESIDE = {
    Ask.ACTION: ("action", "object"),
    Ask.HOW: ("action", "object"),
    Ask.WHAT: ("object",),
    Ask.WHERE: ("place",),
    Ask.SOURCE: ("source",),
    Ask.WHETHER: ("action", "object"),
    Ask.HOW_MANY: ("object",),
}
"""Variables that a question needs beside those of every segment, the answer first."""


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked of every segment that an instruction fits."""

    ask: Ask
    about: Instruction
    """With ``?`` for the object that is asked for."""

    alternatives: tuple[Instruction, ...] = ()
    """What may have been instead: ``or did someone put it down``."""

    also: tuple[Instruction, ...] = ()
    """What is asked for at once: ``and put it down``."""

    rank: str = ""
    """Which of several is asked for: ``first``."""

    @property
    def sparql(self) -> str:
        """The query; its first variable answers the question."""
        return self._query(self.about)

    @property
    def others(self) -> tuple[str, ...]:
        """The queries of what may have been instead, and of what is asked for at once."""
        return tuple(self._query(each) for each in (*self.alternatives, *self.also))

    def chosen(self, rows: Sequence[Row]) -> tuple[Row, ...]:
        """Of answers in the order of time, those that are asked for: all, the first or the last."""
        ends = {"first": slice(0, 1), "last": slice(-1, None)}
        return tuple(rows[ends.get(self.rank, slice(None))])

    def _query(self, about: Instruction) -> str:
        never = _NEVER.get(self.ask)
        if about.circumstances.negated and never is not None:
            return never_sparql(about, never)
        if self.ask is Ask.HOW_MANY and "?" not in about.call.objects:
            about = replace(about, call=replace(about.call, objects=("?",)))
        beside = _BESIDE.get(self.ask, ())
        count, group = _GROUPS.get(self.ask, ("", ""))
        if count:
            answers, order = f"{count} {group}", f"GROUP BY {group}\nORDER BY {group}"
        else:
            first = beside or (self.ask.value,)
            shown = (*first, *(each for each in _SHOWN if each not in first))
            answers = " ".join(f"?{each}" for each in shown)
            order = "ORDER BY ?observation ?start ?ee"
        return question_sparql(
            about,
            answers=answers,
            variables=beside,
            order=order,
            counted=self.ask is Ask.HOW_OFTEN,
        )
