"""Noun phrases, and times, counts and manners, as they stand in a sentence."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from kb.language.cursor import ARTICLES, Cursor
from kb.language.instruction import Window
from kb.language.phrases import PACKS
from kb.language.vocabulary import (
    SIDES,
    VerbEntries,
    Vocabulary,
    first_words,
    is_manner,
    is_next,
    number_at,
    of_class,
    prepositions,
    silent,
)
from kb.lexicon.english import PEOPLE, Form, ordinal

STOPS = (
    *("determiner", "person", "pronoun", "auxiliary", "negation", "particle", "manner"),
    *("relation", "count", "preposition"),
)
"""Classes of words that no name of an object goes on with."""

CONNECTIVES = frozenset({",", ".", ";", ":", "(", ")", "and", "or", "but", "then", "to", ""})
RELATIVES = frozenset({"who", "that", "which", "what", "where", "whose", "whom"})


@dataclass
class Reader:
    """What is read, by what, and what was spoken of before."""

    cursor: Cursor
    words: Vocabulary
    verbs: VerbEntries
    thing: str = ""
    """What ``it`` is."""

    several: tuple[str, ...] = ()
    """What ``them`` are."""

    taken: tuple[str, str] = ("", "")
    """What was handled last, and with which hand."""

    place: str = ""
    """Where ``there`` is."""

    limb: str = ""
    gap: bool = False
    """Whether a preposition may stand without its object: ``what did she look at``."""

    limit: int = 1_000_000
    """The word at which a name ends at the latest."""

    literals: frozenset[str] = frozenset()
    """Words that belong to the verb that is being read: ``go`` of ``let go``."""

    def stops(self, ahead: int = 0) -> bool:
        """Whether the next word cannot be a part of a name."""
        cursor = self.cursor
        word = cursor.peek(ahead)
        if cursor.at + ahead >= self.limit:
            return True
        if word in CONNECTIVES or word in RELATIVES or word.startswith('"') or is_manner(word):
            return True
        start = cursor.at
        cursor.at += ahead
        found = any(cursor.longest(of_class(each)) is not None for each in STOPS)
        cursor.at = start + ahead
        found = found or cursor.longest(prepositions()) is not None
        cursor.at = start
        return found

    def verb_forms(self, ahead: int = 0) -> frozenset[Form]:
        """The forms of verbs that the next word may be."""
        return frozenset(form for _, form in self.verbs.lemmas(self.cursor.peek(ahead)))

    def verb_ahead(self) -> bool:
        """Whether the next word is a form of a verb that primitives are said with."""
        found = self.verbs.lemmas(self.cursor.peek())
        return any(lemma in self.verbs.ways for lemma, _ in found)

    def finite_ahead(self) -> bool:
        """Whether a verb of a sentence with a subject comes next, after adverbs."""
        ahead = 0
        while is_manner(self.cursor.peek(ahead)) or self.cursor.peek(ahead) in {"then", "never"}:
            ahead += 1
        if self.cursor.peek(ahead) in {word[0] for word in of_class("auxiliary")}:
            return True
        return bool(self.verb_forms(ahead) & {Form.BASE, Form.PAST, Form.THIRD})


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
        return _in_brackets(cursor)
    start = cursor.at
    for word, between in _BETWEEN.items():
        if cursor.accept(word):
            found = _span(cursor, *between)
            if found is not None or word == "between":
                return found
            cursor.at = start
    for words, read in _WINDOWS:
        if cursor.accept(*words) and (found := read(cursor)) is not None:
            return found
        cursor.at = start
    return None


def _in_brackets(cursor: Cursor) -> Window | None:
    """``(1–2 s)``, ``(1 s)``, or several times of one action: ``(1–2 s and 3–4 s)``."""
    start = cursor.at
    span = _span(cursor, "–", "-")
    if span is None:
        cursor.at = start
        span = _moment(cursor)
    while span and (cursor.accept(",", "and") or cursor.accept(",") or cursor.accept("and")):
        more = _span(cursor, "–", "-")
        if more is None:
            break
        span = (span[0], more[1])
    return span if span and cursor.accept(")") else None


def _edge(cursor: Cursor) -> Window | None:
    """``the first four seconds``, and the last ones, counted from the end."""
    cursor.accept("the")
    first = cursor.accept("first")
    if not first and not cursor.accept("last"):
        return None
    seconds = _seconds(cursor)
    if seconds is None and (unit := cursor.longest(of_class("unit"))) is not None:
        seconds = float(unit)
    if seconds is None:
        return None
    return (0.0, seconds) if first else (-seconds, math.inf)


def _since(cursor: Cursor) -> Window | None:
    first = _seconds(cursor)
    if first is None:
        return None
    cursor.accept("on") or cursor.accept("onwards")
    return first, math.inf


def _until(cursor: Cursor) -> Window | None:
    last = _seconds(cursor)
    return None if last is None else (0.0, last)


def _moment(cursor: Cursor) -> Window | None:
    cursor.accept("second")
    moment = _seconds(cursor)
    return None if moment is None else (moment, moment)


_BETWEEN = {"between": ("and",), "from": ("to", "until", "till")}
"""What begins a time from one moment to another, and what stands between the two."""

_WINDOWS: tuple[tuple[tuple[str, ...], Callable[[Cursor], Window | None]], ...] = (
    *(((word,), _edge) for word in ("in", "within", "during", "for")),
    ((), _edge),
    *((tuple(words.split()), _since) for words in ("after", "from", "since", "later than")),
    *(
        (tuple(words.split()), _until)
        for words in ("before", "until", "within", "by", "up to", "in")
    ),
    (("at",), _moment),
)
"""What begins any other time, and how it is read after that."""


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


MOST_ALIKE = 20
"""Of more things alike, none is read by its ordinal."""


@dataclass(frozen=True)
class Noun:
    """A noun phrase as it stands."""

    things: tuple[str, ...] = ()
    """The objects that it may name; an empty text is any object."""

    limb: str = ""
    """The end-effector that it may name."""

    person: str = ""
    """Who it may name: an agent, or a kind of person."""

    any_person: bool = False
    at: int = 0
    part: str = ""
    """Which part of the thing is meant: ``left side``."""

    none: bool = False
    """Whether nobody is meant."""

    unknown: bool = False
    """Whether objects are known, and this is none of them."""

    window: Window | None = None
    """In which time those of several things were handled that stand before the last [s]."""

    @property
    def is_person(self) -> bool:
        """Whether it is about somebody."""
        return bool(self.person) or self.any_person


def noun_phrase(reader: Reader, *, coordinate: bool = True) -> Noun | None:
    """Read a noun phrase if one comes next."""
    start = reader.cursor.at
    found = _single(reader)
    if found is None:
        reader.cursor.at = start
        return None
    while coordinate and found.things and (more := _another(reader)) is not None:
        window = around(found.window, more.window)
        found = Noun((*found.things, *more.things), at=found.at, window=window)
    if len(found.things) > 1:
        reader.several = found.things
    return found


def _another(reader: Reader) -> Noun | None:
    """What is joined with a noun phrase by ``and``, where no new clause begins there.

    It has the time that stands before that.
    """
    cursor = reader.cursor
    start = cursor.at
    window = window_at(cursor) if cursor.peek() == "(" else None
    comma = cursor.accept(",")
    joined = cursor.accept("and") or cursor.accept("or")
    if joined and reader.verb_forms() and not _begins_item(reader):
        cursor.at = start
        return None
    if joined or (comma and _begins_item(reader)):
        found = _single(reader)
        if found is not None and found.things and not reader.finite_ahead():
            end = cursor.at
            _skip_time(reader)
            more_to_come = joined or cursor.peek() in {",", "and"}
            goes_on = more_to_come and (not comma or joined or _list_goes_on(reader))
            cursor.at = end
            if goes_on:
                return replace(found, window=window)
    cursor.at = start
    return None


def _list_goes_on(reader: Reader) -> bool:
    """Whether a list of things, however long, ends with ``and`` before a thing."""
    cursor = reader.cursor
    start = cursor.at
    comma = cursor.accept(",")
    if cursor.accept("and"):
        ends = _begins_item(reader)
    else:
        found = _single(reader) if comma and _begins_item(reader) else None
        _skip_time(reader)
        goes_on = found is not None and bool(found.things) and not reader.finite_ahead()
        ends = goes_on and _list_goes_on(reader)
    cursor.at = start
    return ends


def _begins_item(reader: Reader) -> bool:
    """Whether one of several things comes next, with an article or with a number: ``mug 2``."""
    cursor = reader.cursor
    if cursor.peek() in ARTICLES:
        return True
    known = reader.words.nouns
    start = cursor.at
    named = known is not None and cursor.longest(known) is not None
    last, cursor.at = cursor.at, start
    if named and cursor.tokens[last - 1].text.isdigit():
        return True
    counted = cursor.peek(2) in {"times", "time", *(words[0] for words in of_class("unit"))}
    return cursor.peek(1).isdigit() and not counted


def _skip_time(reader: Reader) -> None:
    """Read past the time of one of several things: ``the mug (1.2–3.5 s)``."""
    if reader.cursor.peek() == "(":
        window_at(reader.cursor)


def _single(reader: Reader) -> Noun | None:  # noqa: PLR0911 (each is one kind of noun phrase)
    cursor = reader.cursor
    at = cursor.at
    if (known := _known(reader, at)) is not None:
        return known
    if (counted := _counted(reader, at)) is not None:
        return counted
    pronoun = _pronoun(reader, at)
    if pronoun is not None:
        return pronoun
    article = cursor.longest(of_class("determiner"))
    if article is not None:
        cursor.accept("other")
    if article in {"one", "the other"} and reader.stops():
        cursor.at = at
        return None
    if (known := _known(reader, at)) is not None:
        return known
    if (one := _one_of(reader, at)) is not None:
        return one
    if (limb := _limb(reader, at)) is not None:
        return limb
    if (person := _person(reader, at)) is not None:
        return person
    return _open(reader, at)


def _known(reader: Reader, at: int) -> Noun | None:
    """An object that there is, or a limb of the capture, by its full name."""
    cursor, words = reader.cursor, reader.words
    start = cursor.at
    limb = cursor.longest(words.limbs)
    after_limb, cursor.at = cursor.at, start
    thing = cursor.longest(words.nouns) if words.nouns is not None else None
    if limb is not None and after_limb > cursor.at:
        thing, cursor.at = None, after_limb
    if limb is not None and words.nouns is None:
        thing = limb
    if thing is None and limb is None:
        return None
    return Noun((thing,) if thing else (), limb or "", at=at)


def _counted(reader: Reader, at: int) -> Noun | None:
    """Things of which only the number is said: ``sixteen things``, ``all sixteen things``."""
    cursor = reader.cursor
    start = cursor.at
    cursor.accept("all")
    if number_at(cursor) is not None and cursor.accept("things"):
        return Noun(("",), at=at)
    cursor.at = start
    return None


def _pronoun(reader: Reader, at: int) -> Noun | None:
    cursor = reader.cursor
    kind = cursor.longest(of_class("pronoun"))
    bare = cursor.tokens[at].text.lower() in {"it", "them"} if kind is not None else False
    if kind is not None and (bare or kind == "any" or reader.stops() or cursor.done):
        things = {"one": (reader.thing,), "several": reader.several or (reader.thing,)}
        return Noun(things.get(kind, ("",)), at=at)
    cursor.at = at
    if cursor.longest(of_class("person")) is None:
        return None
    last = cursor.tokens[cursor.at - 1].text.lower()
    if last in {"other", "one"} and reader.limb and cursor.tokens[at].text.lower() != "each":
        kind = reader.limb.rpartition("_")[2]
        return Noun(limb=_other(reader.limb, f"other_{kind}"), at=at)
    owned = cursor.peek() in {*SIDES, "own"} or is_next(cursor, "limb") or not reader.stops()
    if cursor.tokens[at].text.lower() == "her" and owned and not cursor.done:
        cursor.at = at
        return None
    none = cursor.tokens[at].text.lower() in {"nobody", "no"}
    return Noun(any_person=True, at=at, none=none)


def _limb(reader: Reader, at: int) -> Noun | None:
    """A hand or a foot by a word that is not its name: ``fist``, ``the right``."""
    cursor = reader.cursor
    limb = cursor.longest(of_class("limb"))
    if limb is None and cursor.peek() in SIDES:
        before = cursor.at
        side = cursor.take().text.lower()
        cursor.accept("one")
        limb = f"{side}_hand" if reader.stops() else None
        cursor.at = cursor.at if limb else before
    if limb is None:
        return None
    return Noun(limb=_other(reader.limb, limb), at=at)


def _other(limb: str, said: str) -> str:
    """Which hand or foot ``the other`` one is beside what was spoken of."""
    kind = said.removeprefix("other_")
    if said == kind or limb not in {f"{side}_{kind}" for side in SIDES}:
        return said
    return f"left_{kind}" if limb.startswith("right") else f"right_{kind}"


def _person(reader: Reader, at: int) -> Noun | None:
    """A performer by name, or somebody by kind: ``the tall man``."""
    cursor = reader.cursor
    start = cursor.at
    names = {tuple(each.lower().split("_")): each for each in (*reader.words.agents, "agent")}
    found = cursor.longest(names)
    if found is None:
        ahead = 0
        while ahead < 3 and not reader.stops(ahead) and cursor.peek(ahead) not in PEOPLE:
            ahead += 1
        if cursor.peek(ahead) in PEOPLE:
            words = [cursor.take().text.lower() for _ in range(ahead + 1)]
            found = "_".join(words)
    if found is None:
        cursor.at = start
        return None
    return Noun(person=found, at=at)


def _open(reader: Reader, at: int) -> Noun | None:
    """Any name; where objects are known, one of them after adjectives."""
    cursor, words = reader.cursor, reader.words
    start = cursor.at
    while not reader.stops() and cursor.peek() not in reader.literals:
        if words.nouns is not None and (noun := cursor.longest(words.nouns)) is not None:
            return Noun((noun,), at=at)
        cursor.take()
    name = [each.text for each in cursor.tokens[start : cursor.at]]
    if not name and cursor.longest(of_class("part")) is None:
        return None
    return _with_part(reader, at, start)


def _one_of(reader: Reader, at: int) -> Noun | None:
    """A thing by what packs it, or one of several alike: ``can of tuna``, ``second coffee can``."""
    cursor, known = reader.cursor, reader.words.nouns
    start = cursor.at
    first = cursor.peek()
    count = next((each for each in range(1, MOST_ALIKE) if ordinal(each) == first), 0)
    if count:
        cursor.take()
    packed = cursor.peek() in PACKS and cursor.peek(1) == "of"
    if packed:
        cursor.take()
        cursor.take()
    name = cursor.longest(known) if known and (count or packed) else None
    if name is None:
        cursor.at = start
        return None
    numbered = f"{name}_{count}"
    return Noun((numbered if numbered in (known or {}).values() else name,), at=at)


def _with_part(reader: Reader, at: int, start: int) -> Noun | None:
    """A name, with what follows ``of``: a part of it, or the part alone."""
    cursor, words = reader.cursor, reader.words
    name = [each.text for each in cursor.tokens[start : cursor.at]]
    if cursor.peek() == "of":
        part = tuple(each.lower() for each in name) in of_class("part")
        before = cursor.at
        cursor.take()
        whole = _single(reader)
        if whole is not None and whole.things:
            if part or words.nouns is not None:
                return replace(whole, at=at, part=" ".join(name))
            return Noun(("_".join([*name, "of", *whole.things[0].split("_")]),), at=at)
        cursor.at = before
    return Noun(("_".join(name),), at=at, unknown=words.nouns is not None)


def begins_noun(reader: Reader, ahead: int = 0) -> bool:
    """Whether a noun phrase may begin at a word to come."""
    word = reader.cursor.peek(ahead)
    if word in RELATIVES - {"whom"}:
        return False
    if word in first_words("determiner", "pronoun", "person", "limb"):
        return True
    return not reader.stops(ahead)
