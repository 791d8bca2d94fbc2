"""Noun phrases: objects, hands and persons as they stand in a sentence."""

from dataclasses import dataclass, replace

from kb.language.phrases import PACKS
from kb.language.reader import Reader, attempt
from kb.language.vocabulary import SIDES, of_class
from kb.lexicon.english import PEOPLE, ordinal

ARTICLES = ("the", "a", "an")

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
    """Which part of the object is meant: ``left side``."""

    none: bool = False
    """Whether nobody is meant."""

    unknown: bool = False
    """Whether objects are known, and this is none of them."""

    @property
    def is_person(self) -> bool:
        """Whether it is about somebody."""
        return bool(self.person) or self.any_person

    @property
    def is_thing(self) -> bool:
        """Whether it is about an object."""
        return not self.is_person and not self.limb


def noun_phrase(reader: Reader, *, coordinate: bool = True) -> Noun | None:
    """Read a noun phrase if one comes next, with those that ``and`` joins to it."""
    found = _single(reader)
    while coordinate and found and found.things and (more := _another(reader)) is not None:
        found = Noun((*found.things, *more.things), at=found.at)
    if found and len(found.things) > 1:
        reader.several = found.things
    return found


@attempt
def _another(reader: Reader) -> Noun | None:
    """What is joined with a noun phrase, where no new clause begins there."""
    comma = reader.accept(",")
    joined = reader.accept("and", "or")
    item = reader.peek() in ARTICLES or reader.look(_numbered)
    if not item and (not joined or reader.verb_forms()):
        return None
    found = _single(reader)
    if not (joined or comma) or found is None or not found.things or reader.finite_ahead():
        return None
    return found if joined or reader.peek() in {",", "and"} else None


def _numbered(reader: Reader) -> bool:
    """Whether an object with a number comes next: ``mug 2``."""
    start = reader.at
    known = reader.longest(reader.words.nouns or {}) is not None
    return known and reader.at > start + 1 and reader.tokens[reader.at - 1].isdigit()


@attempt
def _single(reader: Reader) -> Noun | None:
    at = reader.at
    found = _known(reader, at) or _pronoun(reader, at)
    if found is None:
        article = reader.of("determiner")
        if article is not None:
            reader.accept("other")
        if article in {"one", "the other"} and reader.stops():
            return None
        for read in (_known, _one_of, _limb, _person, _open):
            found = found or read(reader, at)
    return found


def _known(reader: Reader, at: int) -> Noun | None:
    """An object that there is, or a limb of the capture, by its full name."""
    words, start = reader.words, reader.at
    limb = reader.longest(words.limbs)
    after_limb, reader.at = reader.at, start
    name = reader.longest(words.nouns or {})
    if limb is not None and after_limb > reader.at:
        name, reader.at = None, after_limb
    if limb is not None and words.nouns is None:
        name = limb
    if name is None and limb is None:
        return None
    return Noun((name,) if name else (), limb or "", at=at)


@attempt
def _pronoun(reader: Reader, at: int) -> Noun | None:
    first = reader.peek()
    kind = reader.of("pronoun")
    if kind is not None and (first in {"it", "them"} or kind == "any" or reader.stops()):
        things = {"one": (reader.thing,), "several": reader.several or (reader.thing,)}
        return Noun(things.get(kind, ("",)), at=at)
    reader.at = at
    if reader.of("person") is None:
        return None
    last = reader.tokens[reader.at - 1].lower()
    if last in {"other", "one"} and reader.limb and first != "each":
        return Noun(limb=_other(reader.limb, f"other_{reader.limb.rpartition('_')[2]}"), at=at)
    owned = reader.peek() in {*SIDES, "own"} or reader.is_next("limb") or not reader.stops()
    if first == "her" and owned and not reader.done:
        return None
    return Noun(any_person=True, at=at, none=first in {"nobody", "no"})


@attempt
def _limb(reader: Reader, at: int) -> Noun | None:
    """A hand or a foot by a word that is not its name: ``fist``, ``the right``."""
    limb = reader.of("limb")
    if limb is None and reader.peek() in SIDES:
        side = reader.take().lower()
        reader.accept("one")
        limb = f"{side}_hand" if reader.stops() else None
    return Noun(limb=_other(reader.limb, limb), at=at) if limb else None


def _other(limb: str, said: str) -> str:
    """Which hand or foot ``the other`` one is beside what was spoken of."""
    kind = said.removeprefix("other_")
    if said == kind or limb not in {f"{side}_{kind}" for side in SIDES}:
        return said
    return f"left_{kind}" if limb.startswith("right") else f"right_{kind}"


@attempt
def _person(reader: Reader, at: int) -> Noun | None:
    """A performer by name, or somebody by kind: ``the tall man``."""
    names = {tuple(each.lower().split("_")): each for each in (*reader.words.agents, "agent")}
    found = reader.longest(names)
    if found is None:
        ahead = 0
        while ahead < 3 and not reader.stops(ahead) and reader.peek(ahead) not in PEOPLE:
            ahead += 1
        if reader.peek(ahead) in PEOPLE:
            found = "_".join(reader.take().lower() for _ in range(ahead + 1))
    return None if found is None else Noun(person=found, at=at)


@attempt
def _one_of(reader: Reader, at: int) -> Noun | None:
    """An object by what packs it, or one of several: ``can of tuna``, ``second coffee can``."""
    known = reader.words.nouns or {}
    first = reader.peek()
    count = next((each for each in range(1, MOST_ALIKE) if ordinal(each) == first), 0)
    reader.at += bool(count)
    packed = reader.peek() in PACKS and reader.peek(1) == "of"
    reader.at += 2 * packed
    name = reader.longest(known) if count or packed else None
    if name is None:
        return None
    numbered = f"{name}_{count}"
    return Noun((numbered if numbered in known.values() else name,), at=at)


def _open(reader: Reader, at: int) -> Noun | None:
    """Any name; where objects are known, one of them after adjectives."""
    known, start = reader.words.nouns, reader.at
    while not reader.stops() and reader.peek() not in reader.literals:
        if known is not None and (name := reader.longest(known)) is not None:
            return Noun((name,), at=at)
        reader.take()
    if reader.at == start and reader.of("part") is None:
        return None
    words = reader.tokens[start : reader.at]
    after = reader.at
    if reader.accept("of"):
        whole = _single(reader)
        if whole is not None and whole.things:
            part = tuple(map(str.lower, words)) in of_class("part")
            if part or known is not None:
                return replace(whole, at=at, part=" ".join(words))
            return Noun(("_".join([*words, "of", *whole.things[0].split("_")]),), at=at)
        reader.at = after
    return Noun(("_".join(words),), at=at, unknown=known is not None)
