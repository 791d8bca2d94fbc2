"""The forms of questions, by the words with which they begin."""

from collections.abc import Callable
from dataclasses import replace

from kb.language.instruction import GAP, Instruction
from kb.language.question import Ask, Question
from kb.language.reading.clauses import helpers, predicate, subject
from kb.language.reading.function_words import is_next, of_class
from kb.language.reading.inverted_clauses import GAP_PERSON, GAP_THING, inverted, relative
from kb.language.reading.matching import matched
from kb.language.reading.noun_phrases import Noun, noun_phrase
from kb.language.reading.reader import Reader
from kb.language.reading.verb_phrases import VerbPhrase, begin, complete
from kb.lexicon.english import PEOPLE, Form

DONE = frozenset({"do", "doing", "done"})
HAPPEN = frozenset({"happened", "happens", "happen", "happening", "done", "going"})


def _who(reader: Reader) -> Question | None:
    cursor = reader.cursor
    start = cursor.at
    if is_next(cursor, "auxiliary") and cursor.peek() in {"did", "does"}:
        before = cursor.at
        cursor.take()
        if subject(reader) is not None:
            cursor.at = before
            return Question(Ask.WHO, inverted(reader, GAP_PERSON))
        cursor.at = start
    return Question(Ask.WHO, predicate(reader, GAP_PERSON))


def _what(reader: Reader) -> Question | None:  # noqa: PLR0911 (each is one form of question)
    cursor = reader.cursor
    if cursor.peek() == "time":
        cursor.take()
        return _when(reader)
    noun = _asked_noun(reader)
    if noun is not None:
        return noun
    start = cursor.at
    if not is_next(cursor, "auxiliary"):
        if cursor.peek() in HAPPEN:
            return _happened(reader)
        return Question(Ask.WHAT, predicate(reader, GAP_THING))
    before = helpers(reader)
    if cursor.peek() in HAPPEN:
        return _happened(reader)
    ranked = _ranked(reader)
    if ranked is not None:
        return ranked
    about = subject(reader) if cursor.peek() not in DONE else None
    if about is not None:
        if cursor.peek() in DONE:
            return _done_by(reader, about)
        cursor.at = start
        return Question(Ask.WHAT, inverted(reader, GAP_THING))
    return Question(Ask.WHAT, predicate(reader, GAP_THING, before))


def _happened(reader: Reader) -> Question:
    """``what happened``, ``what was done to the mug``."""
    cursor = reader.cursor
    cursor.take()
    cursor.accept("on")
    if cursor.peek() in DONE:
        begin(reader)
    return Question(Ask.ACTION, _anything(reader, Noun()))


def _done_by(reader: Reader, about: Noun) -> Question:
    reader.cursor.take()
    return Question(Ask.ACTION, _anything(reader, about))


def _anything(reader: Reader, about: Noun) -> Instruction:
    """Any action of somebody, with what was said of it."""
    phrase = complete(reader, VerbPhrase(("do",), reader.cursor.at))
    objects = [each for each in phrase.objects if each.things != (GAP,)]
    phrase.objects[:] = objects
    return matched(reader, phrase, agent=about.person, ee=about.limb)


def _ranked(reader: Reader) -> Question | None:
    """``the first thing that she picked up``."""
    cursor = reader.cursor
    start = cursor.at
    cursor.accept("the")
    rank = cursor.peek()
    if rank in {"first", "last", "next", "only"} and is_next(cursor, "thing", 1):
        cursor.at += 2
        cursor.accept("that") or cursor.accept("which")
        about = subject(reader)
        if about is not None and cursor.peek() not in {"was", "were"}:
            told = relative(reader, about)
        else:
            told = predicate(reader, GAP_THING)
        return Question(Ask.WHAT, told, rank=rank)
    cursor.at = start
    return None


def _asked_noun(reader: Reader) -> Question | None:
    """``which hand``, ``which objects``, ``which person``, ``what kind of box``."""
    cursor = reader.cursor
    start = cursor.at
    cursor.longest({("of", "the"): "", ("of", "the", "two"): ""})
    if cursor.longest({("end-effector",): "", **of_class("limb")}) is not None:
        return _which_hand(reader)
    if cursor.peek() in {"capture", "recording", "observation", "take"}:
        cursor.take()
        return Question(Ask.WHERE_SEEN, inverted(reader))
    if cursor.peek() in PEOPLE or cursor.peek() in {"people", "one"}:
        cursor.take()
        return _who(reader)
    if cursor.longest(of_class("thing")) is not None:
        return _of_things(reader, ())
    name: list[str] = []
    while not reader.stops() and not reader.verb_forms() & {Form.PAST}:
        name.append(cursor.take().text)
    if name and (is_next(cursor, "auxiliary") or reader.finite_ahead()):
        return _of_things(reader, ("_".join(name),))
    cursor.at = start
    return None


def _of_things(reader: Reader, kinds: tuple[str, ...]) -> Question:
    cursor = reader.cursor
    if cursor.peek() in {"did", "does"}:
        about = inverted(reader, GAP_THING)
    else:
        about = predicate(reader, GAP_THING)
    own = about.circumstances
    told = replace(about, circumstances=replace(own, others=(*own.others, *kinds)))
    return Question(Ask.WHAT, told)


def _which_hand(reader: Reader) -> Question:
    """``which hand moved the mug``, ``which hand did she use to cut the bread``."""
    cursor = reader.cursor
    reader.limb = "any_hand"
    if cursor.peek() not in {"did", "does"}:
        return Question(Ask.WHICH_HAND, predicate(reader, Noun(limb="any_hand")))
    start = cursor.at
    cursor.take()
    about = subject(reader)
    if about is None or not cursor.accept("use"):
        cursor.at = start
        return Question(Ask.WHICH_HAND, _without_with(reader))
    cursor.accept("to") or cursor.accept("for")
    phrase = begin(reader)
    if phrase is None:
        raise cursor.error(f"no verb {cursor.peek()!r}", reader.verbs.beginnings)
    complete(reader, phrase)
    return Question(Ask.WHICH_HAND, matched(reader, phrase, agent=about.person))


def _without_with(reader: Reader) -> Instruction:
    told = inverted(reader)
    reader.cursor.accept("with")
    return told


def _when(reader: Reader) -> Question:
    return Question(Ask.WHEN, inverted(reader))


def _where(reader: Reader) -> Question:
    told = inverted(reader)
    source = reader.cursor.accept("from")
    return Question(Ask.SOURCE if source else Ask.WHERE, told)


def _how_long(reader: Reader) -> Question:
    """``how long did she hold it``, ``how long did it take her to carry it``."""
    cursor = reader.cursor
    start = cursor.at
    if cursor.accept("did", "it", "take") or cursor.accept("does", "it", "take"):
        about = noun_phrase(reader) if is_next(cursor, "person") or cursor.peek() != "to" else None
        if cursor.accept("to"):
            phrase = begin(reader)
            if phrase is not None:
                complete(reader, phrase)
                doer = about or Noun()
                told = matched(reader, phrase, agent=doer.person, ee=doer.limb)
                return Question(Ask.HOW_LONG, told)
        cursor.at = start
    return Question(Ask.HOW_LONG, inverted(reader))


def _how_often(reader: Reader) -> Question:
    return Question(Ask.HOW_OFTEN, inverted(reader))


def _how_many(reader: Reader) -> Question:
    cursor = reader.cursor
    kinds: tuple[str, ...] = ()
    if cursor.longest(of_class("thing")) is None:
        if cursor.peek() in PEOPLE or cursor.peek() == "people":
            cursor.take()
            return Question(Ask.HOW_MANY_AGENTS, predicate(reader, GAP_PERSON))
        if cursor.longest(of_class("limb")) is None:
            kinds = (cursor.take().text,)
    found = _of_things(reader, kinds)
    return Question(Ask.HOW_MANY, found.about)


def _how(reader: Reader) -> Question:
    cursor = reader.cursor
    if not is_next(cursor, "auxiliary"):
        known = ("often", "long", "many times", "many", "did")
        raise cursor.error(f"no question is known with 'how {cursor.peek()}'", known)
    return Question(Ask.HOW, inverted(reader))


FORMS: dict[tuple[str, ...], Callable[[Reader], Question | None]] = {
    ("who",): _who,
    ("whom",): _who,
    ("what", "else"): _what,
    ("what",): _what,
    ("which",): _asked_noun,
    ("where",): _where,
    ("when",): _when,
    ("how", "long"): _how_long,
    ("how", "often"): _how_often,
    ("how", "many", "times"): _how_often,
    ("how", "many", "seconds"): _how_long,
    ("how", "much", "time"): _how_long,
    ("how", "many"): _how_many,
    ("how",): _how,
}
"""What each beginning of a question reads."""
