"""Questions about what was done, as SPARQL over an Actionary."""

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from importlib.resources import files
from typing import TypeVar

from kb.language.instruction import GAP, Condition, Instruction, Relation
from kb.lexicon.english import PEOPLE
from kb.lexicon.wordnet import table

SOURCES: tuple[str, ...] = ("off", "out of", "away from")
"""Prepositions of what a thing is taken from, as observations state them."""

LIMBS = {
    "both_hands": ("left_hand", "right_hand"),
    "both_feet": ("left_foot", "right_foot"),
    "hand": ("left_hand", "right_hand"),
    "foot": ("left_foot", "right_foot"),
}
"""End-effectors that a word for several, or for either, may name."""

ALIKE = {"next to": "beside", "close to": "near", "inside": "in", "on top of": "on"}
"""Prepositions of people in the words of the rules."""

TIMES = {
    Relation.WHILE: "?start < ?end@ && ?start@ < ?end",
    Relation.WHEN: "?start < ?end@ && ?start@ < ?end",
    Relation.BEFORE: "?start < ?start@",
    Relation.AFTER: "?start >= ?end@",
    Relation.UNTIL: "?start < ?start@ && ?end >= ?start@",
    Relation.WITHOUT: "?start@ >= ?start && ?performer@ = ?performer",
    Relation.WHERE: "true",
    Relation.SAME_AGENT: "?performer@ = ?performer",
}
"""What each relation demands of two segments."""

_PATHS = {
    "object": "capar:object/capar:name",
    "performer": "capar:segment/capar:ofLink/capar:agent/capar:name",
    "ee": "capar:segment/capar:ee",
}
"""Where an observation has what is asked for where it is asked of what was not done."""


_OTHER, _BODY = "capar:other/capar:name", "capar:body/(capar:name|capar:ee)"


def _fragment(name: str, suffix: str = "") -> str:
    text = (files("kb") / "language" / "sparql" / f"{name}.rq").read_text(encoding="utf-8")
    return text.replace("@", suffix).rstrip()


def _segment(about: Instruction, suffix: str, *, counted: bool) -> Iterator[str]:
    """The patterns of one segment; its variables end with the suffix."""
    yield _fragment("segment", suffix)
    yield from _actions(about, suffix, counted=counted)
    for number, name in enumerate(about.call.objects):
        if name and name != GAP:
            role = ("dominant", "subordinate", "object")[min(number, 2)]
            named = f"(capar:name|(capar:kind/capar:isA/capar:name)) {_text(name)} ."
            it = f"  ?segment{suffix} capar:{role}/{named}"
            goal = _fragment("goal", suffix)
            yield f"  {{ {it} }} UNION {{\n{goal}/{named} }}" if number == 1 else it
    yield from _doer(about, suffix)
    if about.call.purpose:
        yield f"  ?segment{suffix} capar:purpose {_text(about.call.purpose)} ."
    yield from _where(about, suffix)
    yield from _when(about, suffix)


def _actions(about: Instruction, suffix: str, *, counted: bool) -> Iterator[str]:
    """The actions that answer: its own, those that specialise it, and those that entail it."""
    action = about.call.action
    if not action or action == "Be":
        return
    rows = [row for row in table("answered_by") if row["action"] == action]
    instead = [row["answer"] for row in rows if row["ask"] == "times" and counted]
    if instead:
        yield _named(instead, suffix)
        return
    plain = [row["answer"] for row in rows if not row["ask"] and not row["fragment"]]
    blocks = [_named([action, *plain], suffix)]
    for row in rows:
        if row["fragment"]:
            named = _named([row["answer"]], suffix)
            blocks.append(f"{named}\n{_fragment(row['fragment'], suffix)}")
    yield "  {\n" + "\n  } UNION {\n".join(blocks) + "\n  }"


def _named(actions: Iterable[str], suffix: str) -> str:
    names = " ".join(map(_text, actions))
    return (
        f"  VALUES ?asked{suffix} {{ {names} }}\n"
        f"  ?segment{suffix} (capar:action|capar:specialises)/capar:name ?asked{suffix} ."
    )


def _doer(about: Instruction, suffix: str) -> Iterator[str]:
    if about.ee == "other_hand":
        yield f"  FILTER(?ee{suffix} != ?ee)" if suffix else ""
    elif about.ee and about.ee != "any_hand":
        names = " ".join(map(_text, LIMBS.get(about.ee, (about.ee,))))
        yield f"  VALUES ?ee{suffix} {{ {names} }}"
        if about.ee.startswith("both_"):
            yield _fragment("both_hands", suffix)
    if about.agent:
        same = f"?performer{suffix} = {_text(about.agent)}"
        if about.agent.split("_")[-1] in PEOPLE:
            nobody = f"NOT EXISTS {{ ?named{suffix} a capar:Agent ; capar:name "
            yield f"  FILTER({same} || {nobody}{_text(about.agent)} }})"
        else:
            yield f"  FILTER({same})"


def _where(about: Instruction, suffix: str) -> Iterator[str]:
    """Where a body is or goes, as the observation states it."""
    named = {*about.call.objects, about.source, "someone"}
    stated = [(f"source{suffix}", SOURCES, about.source)] if about.source else []
    stated += [
        (f"place{suffix}_{index}", (ALIKE.get(word, word),), place)
        for index, (word, place) in enumerate(about.circumstances.places)
        if place not in named
    ]
    for name, prepositions, place in stated:
        yield f"  VALUES ?preposition_{name} {{ {' '.join(map(_text, prepositions))} }}"
        yield f"  ?segment{suffix} capar:placement ?{name} ."
        yield f"  ?{name} capar:preposition ?preposition_{name} ; {_OTHER} {_text(place)} ."
        if body := _body(about):
            yield f"  ?{name} {_BODY} {body} ."


def _body(about: Instruction) -> str:
    """The body that is somewhere: the object, the one that is asked for, or any."""
    name = about.call.objects[0] if about.call.objects else ""
    return "?object" if name == GAP else _text(name) if name else ""


def _when(about: Instruction, suffix: str) -> Iterator[str]:
    window = about.circumstances.window
    if window is None:
        return
    first, last = window
    if first < 0:
        yield f"  ?seen capar:duration ?whole{suffix} ."
        yield f"  FILTER(?end{suffix} > ?whole{suffix} - {-first!r})"
        return
    yield f"  FILTER(?end{suffix} >= {first!r})"
    if not math.isinf(last):
        yield f"  FILTER(?start{suffix} <= {last!r})"


def _bound(about: Instruction, variables: set[str]) -> Iterator[str]:
    """What binds the variables that are asked for."""
    objects = about.call.objects
    asked = objects.index(GAP) if GAP in objects else 0
    state = about.call.action == "Be"
    if "object" in variables and not (state and about.circumstances.places):
        role = "subordinate" if asked == 1 else "dominant"
        pattern = f"?segment capar:{role}/capar:name ?object ."
        yield f"  {pattern}" if GAP in objects else f"  OPTIONAL {{ {pattern} }}"
    if "action" in variables:
        yield "  ?segment capar:action/capar:name ?action ."
    if "place" in variables and state:
        yield "  ?segment capar:placement ?being ."
        yield f"  ?being {_BODY} {_body(about) or '?body'} ; {_OTHER} ?place ;"
        yield "    capar:preposition ?preposition ."
    elif "place" in variables:
        yield "  ?segment capar:subordinate/capar:name ?place ."
    if "source" in variables:
        yield "  VALUES ?taken { " + " ".join(map(_text, SOURCES)) + " }"
        yield "  ?segment capar:placement ?leaving ; capar:dominant/capar:name ?left ."
        yield f"  ?leaving capar:preposition ?taken ; {_BODY} ?left ; {_OTHER} ?source ."


def _condition(condition: Condition, suffix: str) -> Iterator[str]:
    """Another segment of the same observation, and how the first stands to it."""
    times = TIMES[condition.relation].replace("@", suffix)
    lines = [*_segment(condition.about, suffix, counted=False), f"  FILTER({times})"]
    missing = condition.relation is Relation.WITHOUT
    if missing != condition.about.circumstances.negated:
        yield "  FILTER NOT EXISTS {\n" + "\n".join(lines) + "\n  }"
    else:
        yield from lines


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False)


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
        never = _NEVER.get(self.ask) if about.circumstances.negated else None
        if self.ask is Ask.HOW_MANY and GAP not in about.call.objects:
            about = replace(about, call=replace(about.call, objects=(GAP,)))
        beside = _BESIDE.get(self.ask, ())
        bound = {never} if never else set(beside)
        lines = [*_segment(about, "", counted=self.ask is Ask.HOW_OFTEN), *_bound(about, bound)]
        if never:
            seen = f"  ?seen a capar:Observation ; {_PATHS[never]} ?{never} ."
            lines = [seen, "  MINUS {", *lines, "  }"]
            answers, order = f"?{never} ?observation", f"ORDER BY ?observation ?{never}"
        elif self.ask in _GROUPS:
            count, group = _GROUPS[self.ask]
            answers, order = f"{count} {group}", f"GROUP BY {group}\nORDER BY {group}"
        else:
            shown = dict.fromkeys((*(beside or (self.ask.value,)), *_SHOWN))
            answers = " ".join(f"?{each}" for each in shown)
            order = "ORDER BY ?observation ?start ?ee"
        for index, condition in enumerate(() if never else about.circumstances.conditions, 1):
            lines += _condition(condition, f"_{index}")
        query = _fragment("question")
        parts = {"answers": answers, "segments": "\n".join(lines), "order": order}
        for name, text in parts.items():
            query = query.replace(f"{{{{{name}}}}}", text)
        return query
