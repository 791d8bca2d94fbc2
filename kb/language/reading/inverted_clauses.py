"""Clauses that begin with a helping verb, and those in which what is asked for is missing."""

from dataclasses import replace

from kb.language.instruction import GAP, Instruction
from kb.language.reading.adjuncts import Adjuncts, adjunct
from kb.language.reading.clauses import helpers, predicate, same_agent, subject
from kb.language.reading.function_words import is_next
from kb.language.reading.matching import matched
from kb.language.reading.noun_phrases import Noun, noun_phrase
from kb.language.reading.reader import Reader
from kb.language.reading.verb_phrases import VerbPhrase, begin, complete

HELPERS = ("did", "was", "were", "is", "does", "has", "had")
GAP_THING, GAP_PERSON = Noun((GAP,)), Noun(any_person=True)


def inverted(reader: Reader, gap: Noun | None = None) -> Instruction:
    """A helping verb, the subject, and what is said of it; the gap is its object."""
    cursor = reader.cursor
    while not is_next(cursor, "auxiliary") and adjunct(cursor, Adjuncts()):
        pass
    if cursor.peek() in {"do", "be"} or not is_next(cursor, "auxiliary"):
        raise cursor.error(f"{cursor.peek()!r} cannot follow", HELPERS)
    before = helpers(reader)
    about = subject(reader)
    if about is None and before.kinds[-1:] == ["be"]:
        cursor.accept("there")
        about = noun_phrase(reader)
    if about is None:
        raise cursor.error(f"nobody and nothing {cursor.peek()!r} could be asked about", HELPERS)
    if gap is None:
        return same_agent(reader, predicate(reader, about, before))
    before.adjuncts.manner[:0] = helpers(reader).adjuncts.manner
    phrase = begin(reader)
    if phrase is None:
        raise cursor.error(f"no verb {cursor.peek()!r}", reader.verbs.beginnings)
    phrase.negated = before.negated
    phrase.adjuncts.manner[:0] = before.adjuncts.manner
    reader.gap = True
    complete(reader, phrase)
    return _with_gap(reader, phrase, about, gap)


def _with_gap(reader: Reader, phrase: VerbPhrase, about: Noun, gap: Noun) -> Instruction:
    """The instruction with what is asked for where an object or a preposition lacks it."""
    asked = [*phrase.objects, *(noun for _, noun in phrase.places)]
    reader.gap = False
    objects = (
        phrase.objects if any(each.things == (GAP,) for each in asked) else [gap, *phrase.objects]
    )
    return matched(reader, replace(phrase, objects=objects), agent=about.person, ee=about.limb)


def relative(reader: Reader, about: Noun) -> Instruction:
    """What somebody did to what is asked for."""
    before = helpers(reader)
    phrase = begin(reader)
    if phrase is None:
        raise reader.cursor.error(f"no verb {reader.cursor.peek()!r}", reader.verbs.beginnings)
    phrase.negated = before.negated
    reader.gap = True
    complete(reader, phrase)
    return _with_gap(reader, phrase, about, GAP_THING)
