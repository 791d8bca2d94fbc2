"""Levin's verb classes, and how primitives link to words: by the thesis, or by our rules."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache

from kb.lexicon.wordnet import table, wordnet

MOTION_FILES = (35, 38)
"""WordNet's files of verbs of contact and of motion."""


class Claimant(StrEnum):
    """Who makes a link or states a status."""

    THESIS = "thesis"
    RULES = "rules"
    """The rule file of the primitive itself."""

    LEXICON = "lexicon"
    """Our table of verbs as motions of the body."""


class ThesisStatus(StrEnum):
    """What the thesis says of a verb (thesis 6.1, Fig 6.1)."""

    DIRECT = "direct"
    EXTENSION = "extension"
    NOT = "not"
    UNSTATED = "unstated"


@dataclass(frozen=True, slots=True, order=True)
class PrimitiveWords:
    """What a primitive is called in language, as its rule file states it."""

    name: str
    verbs: tuple[str, ...] = ()
    """Lemmas as people write them, the first the usual one: ``pick up``."""

    general: tuple[str, ...] = ()
    """The primitives that it specialises directly."""

    senses: tuple[str, ...] = ()
    """WordNet sense keys, or numbers of its first verb's senses, that its rule file states."""

    levin: tuple[str, ...] = ()
    """Levin classes that its rule file states."""

    prepositions: tuple[str, ...] = ()
    """What stands before its second object: ``into``; empty for the usual one."""

    file: str = ""
    """The rule file, from the rule base's folder: ``primitives/hit.lp``."""


@dataclass(frozen=True, slots=True)
class SenseLink:
    """A primitive's verb in a WordNet sense."""

    primitive: str
    verb: str
    key: str
    claimed_by: Claimant
    number_1_6: int = 0
    """The sense's number in WordNet 1.6, which the thesis cites; zero if it cites none."""

    remark: str = ""


@dataclass(frozen=True, slots=True)
class ThesisClaim:
    """One claim of the thesis about what the system can address, with its sentence."""

    levin: str
    """Our class of the verbs named; empty for a claim about no class."""

    said: str
    """The number that the thesis itself prints, or empty."""

    verbs: tuple[str, ...]
    status: ThesisStatus
    reason: str
    section: str
    quote: str


@dataclass(frozen=True, slots=True)
class Remark:
    """Where the thesis's words and the verb classes disagree."""

    levin: str
    verb: str
    text: str


@cache
def thesis_senses() -> tuple[SenseLink, ...]:
    """The thesis's table of senses, by sense key (thesis 6.1)."""
    return tuple(
        SenseLink(each, verb, key, Claimant.THESIS, int(number), remark)
        for row in table("thesis_senses")
        for each, verb, key, number, remark in [
            [row[e] for e in ("primitive", "verb", "key", "number_1_6", "remark")]
        ]
    )


@cache
def thesis_claims() -> tuple[ThesisClaim, ...]:
    """Every claim of the thesis about its capability, in its order (thesis 6.1, 6.3)."""
    return tuple(
        ThesisClaim(
            row["class"],
            row["said"],
            tuple(row["verbs"].split("; ")) if row["verbs"] else (),
            ThesisStatus(row["status"]),
            row["reason"],
            row["section"],
            row["quote"],
        )
        for row in table("thesis_claims")
    )


@cache
def remarks() -> tuple[Remark, ...]:
    """What stands beside the thesis's claims as a remark."""
    return tuple(Remark(row["class"], row["verb"], row["remark"]) for row in table("remarks"))


def sense_links(words: PrimitiveWords) -> tuple[SenseLink, ...]:
    """The senses of a primitive that we claim: its rule file's, else its verbs' as motions."""
    verb = words.verbs[0] if words.verbs else ""
    stated = [key for each in words.senses if (key := sense_key(verb, each))]
    if stated:
        return tuple(SenseLink(words.name, verb, key, Claimant.RULES) for key in stated)
    own = own_links(words.name)
    if own is not None:
        return tuple(SenseLink(words.name, verb, key, Claimant.LEXICON) for key in own[0])
    return tuple(
        SenseLink(words.name, verb, key, Claimant.LEXICON)
        for verb in words.verbs
        for key in motion_senses(verb)
    )


def sense_key(verb: str, stated: str) -> str:
    """The sense key that a rule file states, as it stands or by the sense's number.

    It is empty where the verb has no sense of that number in WordNet 3.1.
    """
    if not stated.isdigit():
        return stated
    senses = (sense for sense, _ in wordnet().of_lemma(verb))
    return next((each.key for each in senses if each.number == int(stated)), "")


def class_links(words: PrimitiveWords) -> tuple[tuple[str, ...], Claimant]:
    """The Levin classes of a primitive that we claim: its rule file's, else its verbs'."""
    if words.levin:
        return words.levin, Claimant.RULES
    own = own_links(words.name)
    if own is not None:
        return own[1], Claimant.LEXICON
    found = (number for verb in words.verbs for number in motion_classes(verb))
    return tuple(dict.fromkeys(found)), Claimant.LEXICON


def own_links(name: str) -> tuple[tuple[str, ...], tuple[str, ...]] | None:
    """Senses and classes of a primitive whose verb usually means something else; else None."""
    row = next((row for row in table("primitive_links") if row["primitive"] == name), None)
    return (tuple(row["senses"].split()), tuple(row["classes"].split())) if row else None


def motion_senses(verb: str) -> tuple[str, ...]:
    """Sense keys in which a verb is a motion of the body.

    They are those of our table; for a verb that it lacks, its most frequent sense among those
    of contact or motion, if it has one.
    """
    stated = tuple(row["key"] for row in table("motion_senses") if row["verb"] == verb)
    found = (sense.key for sense, each in wordnet().of_lemma(verb) if each.lexfile in MOTION_FILES)
    return stated or tuple(found)[:1]


def motion_classes(verb: str) -> tuple[str, ...]:
    """Levin classes in which a verb is a motion of the body, none if our table lacks it."""
    return tuple(row["class"] for row in table("motion_classes") if row["verb"] == verb)


@dataclass(frozen=True, slots=True)
class LevinClass:
    """A class of Levin's book (English Verb Classes and Alternations, 1993)."""

    number: str
    """``40.3.1``: its section of the book's second part."""

    broader: str
    """The class that it is part of, or empty."""

    title: str
    size: int
    """The number of verbs that the book lists; zero where it lists them by subclass."""

    verbnet: tuple[str, ...]
    """VerbNet 3.4's classes of the same verbs: ``wink-40.3.1``."""


@cache
def levin_classes() -> Mapping[str, LevinClass]:
    """Every class by its number, in the book's order."""
    return {
        row["number"]: LevinClass(
            row["number"],
            row["broader"],
            row["title"],
            int(row["members"] or 0),
            tuple(row["verbnet"].split()),
        )
        for row in table("levin")
    }


def above(number: str) -> Iterator[str]:
    """Numbers of the classes that a class is part of, nearest first."""
    while number := levin_classes()[number].broader:
        yield number


def book_order(number: str) -> tuple[int, ...]:
    """A key that sorts 9.10 after 9.9."""
    return tuple(int(part) for part in number.split(".") if part)
