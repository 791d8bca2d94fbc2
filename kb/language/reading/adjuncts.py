"""Times, counts and manners, wherever they stand in a sentence."""

import math
from dataclasses import dataclass, field

from kb.language.instruction import Window
from kb.language.reading.function_words import is_manner, number_at, of_class, prepositions, silent
from kb.language.tokens import Cursor


@dataclass
class Adjuncts:
    """What was read beside objects; it grows while a clause is read."""

    manner: list[str] = field(default_factory=list)
    count: int = 0
    duration_s: float = 0.0
    window: Window | None = None


def adjunct(cursor: Cursor, found: Adjuncts) -> bool:
    """Read a time, a count or a manner if one comes next."""
    return _window(cursor, found) or _count(cursor, found) or _manner(cursor, found)


def window_at(cursor: Cursor) -> Window | None:
    """Read a time in which something is, if one comes next: ``between 3 and 8 s``."""
    start = cursor.at
    found = _window_at(cursor)
    if found is None:
        cursor.at = start
    return found


def around(one: Window | None, other: Window | None) -> Window | None:
    """The time from the beginning of the first to the end of the last [s]."""
    if one is None or other is None:
        return one or other
    return min(one[0], other[0]), max(one[1], other[1])


def _window(cursor: Cursor, found: Adjuncts) -> bool:
    window = window_at(cursor)
    if window is not None:
        found.window = around(found.window, window)
        return True
    start = cursor.at
    if cursor.accept("for"):
        duration = _seconds(cursor)
        if duration is not None:
            found.duration_s = duration
            return True
    cursor.at = start
    return False


def _window_at(cursor: Cursor) -> Window | None:
    if cursor.accept("("):
        start = cursor.at
        span = _span(cursor, "–", "-")
        if span is None:
            cursor.at = start
            moment = _seconds(cursor)
            span = None if moment is None else (moment, moment)
        while span and _joined(cursor) and (more := _span(cursor, "–", "-")):
            span = (span[0], more[1])
        return span if span and cursor.accept(")") else None
    if cursor.accept("between"):
        return _span(cursor, "and")
    for opening in (("in",), ("within",), ("during",), ("for",), ()):
        start = cursor.at
        if cursor.accept(*opening) and (found := _edge(cursor)) is not None:
            return found
        cursor.at = start
    if cursor.accept("from"):
        return _span(cursor, "to", "until", "till")
    return _one_sided(cursor)


def _joined(cursor: Cursor) -> bool:
    """Whether another time of the same deed follows: ``(1–2 s and 3–4 s)``."""
    return cursor.accept(",", "and") or cursor.accept(",") or cursor.accept("and")


def _one_sided(cursor: Cursor) -> Window | None:
    for words in (("after",), ("from",), ("since",), ("later", "than")):
        start = cursor.at
        if cursor.accept(*words) and (first := _seconds(cursor)) is not None:
            cursor.accept("on") or cursor.accept("onwards")
            return (first, math.inf)
        cursor.at = start
    for words in (("before",), ("until",), ("within",), ("by",), ("up", "to"), ("in",)):
        start = cursor.at
        if cursor.accept(*words) and (last := _seconds(cursor)) is not None:
            return (0.0, last)
        cursor.at = start
    if cursor.accept("at"):
        cursor.accept("second")
        moment = _seconds(cursor)
        return None if moment is None else (moment, moment)
    return None


def _edge(cursor: Cursor) -> Window | None:
    """``the first four seconds``, and the last ones, counted from the end."""
    cursor.accept("the")
    for word in ("first", "last"):
        if cursor.accept(word):
            seconds = _seconds(cursor)
            if seconds is None and (unit := cursor.longest(of_class("unit"))) is not None:
                seconds = float(unit)
            if seconds is not None:
                return (0.0, seconds) if word == "first" else (-seconds, math.inf)
    return None


def _span(cursor: Cursor, *between: str) -> Window | None:
    """Two numbers, of which the second has the unit."""
    first = number_at(cursor)
    if first is None:
        return None
    unit = cursor.longest(of_class("unit"))
    if not any(cursor.accept(each) for each in between):
        return None
    last = number_at(cursor)
    late = cursor.longest(of_class("unit")) or unit
    if last is None or late is None:
        return None
    return (first * float(unit or late), last * float(late))


def _seconds(cursor: Cursor) -> float | None:
    count = number_at(cursor)
    unit = cursor.longest(of_class("unit")) if count is not None else None
    if count is None or unit is None:
        return None
    return count * float(unit)


def _count(cursor: Cursor, found: Adjuncts) -> bool:
    start = cursor.at
    number = cursor.longest(of_class("count"))
    if number is not None and not cursor.accept("more"):
        cursor.accept("in", "all")
        found.count = int(number)
        return True
    cursor.at = start
    times = number_at(cursor)
    if times is not None:
        cursor.accept("more")
        if cursor.accept("times") or cursor.accept("time"):
            cursor.accept("in", "all") or cursor.accept("in", "total")
            found.count = int(times)
            return True
    cursor.at = start
    return False


def _manner(cursor: Cursor, found: Adjuncts) -> bool:
    start = cursor.at
    place = cursor.longest(prepositions())
    after_place, cursor.at = cursor.at, start
    known = cursor.longest(of_class("manner"))
    if known is not None and place is not None and after_place > cursor.at:
        cursor.at = start
        return False
    if known is not None:
        words = tuple(each.text.lower() for each in cursor.tokens[start : cursor.at])
        if words not in silent("manner"):
            found.manner.append(known)
        return True
    if is_manner(cursor.peek()):
        found.manner.append(cursor.take().text.lower())
        return True
    return False
