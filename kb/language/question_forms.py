"""Questions: what is asked for, by the words with which they begin, and of which action."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

from kb.language.clauses import (
    GAP_PERSON,
    GAP_THING,
    conditions,
    helpers,
    inverted,
    predicate,
    relative,
    subject,
)
from kb.language.instruction import GAP, Condition, Instruction
from kb.language.noun_phrases import Noun, noun_phrase
from kb.language.question import Ask, Question
from kb.language.reader import Adjuncts, Reader, attempt
from kb.language.verb_phrases import AFTER, VerbPhrase, begin, complete, matched, require
from kb.language.vocabulary import of_class
from kb.lexicon.english import PEOPLE, Form

DONE = frozenset({"do", "doing", "done"})
HAPPEN = frozenset({"happened", "happens", "happen", "happening", "done", "going"})
OBSERVATIONS = ("capture", "recording", "observation", "take")


def _who(reader: Reader) -> Question:
    start = reader.at
    if reader.accept("did", "does") and subject(reader) is not None:
        reader.at = start
        return Question(Ask.WHO, inverted(reader, GAP_PERSON))
    reader.at = start
    return Question(Ask.WHO, predicate(reader, GAP_PERSON))


def _what(reader: Reader) -> Question:  # noqa: PLR0911 (each is one form of question)
    if reader.accept("time"):
        return Question(Ask.WHEN, inverted(reader))
    if (asked := _which(reader)) is not None:
        return asked
    start = reader.at
    before = helpers(reader) if reader.is_next("auxiliary") else None
    if reader.peek() in HAPPEN:
        reader.take()
        reader.accept("on")
        if reader.peek() in DONE:
            begin(reader)
        return Question(Ask.ACTION, _anything(reader, Noun()))
    if before is None:
        return Question(Ask.WHAT, predicate(reader, GAP_THING))
    if (ranked := _ranked(reader)) is not None:
        return ranked
    about = subject(reader) if reader.peek() not in DONE else None
    if about is None:
        return Question(Ask.WHAT, predicate(reader, GAP_THING, before))
    if reader.accept(*DONE):
        return Question(Ask.ACTION, _anything(reader, about))
    reader.at = start
    return Question(Ask.WHAT, inverted(reader, GAP_THING))


def _anything(reader: Reader, about: Noun) -> Instruction:
    """Any action of somebody, with what was said of it."""
    phrase = complete(reader, VerbPhrase(("do",), reader.at))
    phrase.objects = [each for each in phrase.objects if each.things != (GAP,)]
    return matched(reader, phrase, agent=about.person, ee=about.limb)


@attempt
def _ranked(reader: Reader) -> Question | None:
    """``the first thing that she picked up``."""
    reader.accept("the")
    rank = reader.take().lower()
    if rank not in {"first", "last", "next", "only"} or reader.of("thing") is None:
        return None
    reader.accept("that", "which")
    about = subject(reader)
    if about is not None and reader.peek() not in {"was", "were"}:
        return Question(Ask.WHAT, relative(reader, about), rank=rank)
    return Question(Ask.WHAT, predicate(reader, GAP_THING), rank=rank)


@attempt
def _which(reader: Reader) -> Question | None:
    """``which hand``, ``which objects``, ``which person``, ``which box``."""
    reader.accept("of the two", "of the")
    if reader.accept("end-effector") or reader.of("limb") is not None:
        return _which_hand(reader)
    if reader.accept(*OBSERVATIONS):
        return Question(Ask.WHERE_SEEN, inverted(reader))
    if reader.accept(*PEOPLE, "people", "one"):
        return _who(reader)
    if reader.of("thing") is not None:
        return Question(Ask.WHAT, _of_things(reader, ()))
    name: list[str] = []
    while not reader.stops() and Form.PAST not in reader.verb_forms():
        name.append(reader.take())
    if name and (reader.is_next("auxiliary") or reader.finite_ahead()):
        return Question(Ask.WHAT, _of_things(reader, ("_".join(name),)))
    return None


def _of_things(reader: Reader, kinds: tuple[str, ...]) -> Instruction:
    asks = reader.peek() in {"did", "does"}
    about = inverted(reader, GAP_THING) if asks else predicate(reader, GAP_THING)
    return about.having(others=(*about.circumstances.others, *kinds))


def _which_hand(reader: Reader) -> Question:
    """``which hand moved the mug``, ``which hand did she use to cut the bread``."""
    reader.limb = "any_hand"
    start = reader.at
    if not reader.accept("did", "does"):
        return Question(Ask.WHICH_HAND, predicate(reader, Noun(limb="any_hand")))
    about = subject(reader)
    if about is not None and reader.accept("use"):
        reader.accept("to", "for")
        phrase = complete(reader, require(reader))
        return Question(Ask.WHICH_HAND, matched(reader, phrase, agent=about.person))
    reader.at = start
    asked = inverted(reader)
    reader.accept("with")
    return Question(Ask.WHICH_HAND, asked)


def _where(reader: Reader) -> Question:
    asked = inverted(reader)
    return Question(Ask.SOURCE if reader.accept("from") else Ask.WHERE, asked)


def _how_long(reader: Reader) -> Question:
    """``how long did she hold it``, ``how long did it take her to carry it``."""
    start = reader.at
    if reader.accept("did it take", "does it take"):
        doer = noun_phrase(reader) if reader.peek() != "to" else None
        if reader.accept("to"):
            doer = doer or Noun()
            phrase = complete(reader, require(reader))
            return Question(Ask.HOW_LONG, matched(reader, phrase, agent=doer.person, ee=doer.limb))
    reader.at = start
    return Question(Ask.HOW_LONG, inverted(reader))


def _how_many(reader: Reader) -> Question:
    if reader.accept(*PEOPLE, "people"):
        return Question(Ask.HOW_MANY_AGENTS, predicate(reader, GAP_PERSON))
    known = reader.of("thing") is not None or reader.of("limb") is not None
    return Question(Ask.HOW_MANY, _of_things(reader, () if known else (reader.take(),)))


def _how(reader: Reader) -> Question:
    if not reader.is_next("auxiliary"):
        known = ("often", "long", "many times", "many", "did")
        raise reader.error(f"no question is known with 'how {reader.peek()}'", known)
    return Question(Ask.HOW, inverted(reader))


FORMS: dict[str, Callable[[Reader], Question | None]] = {
    "who": _who,
    "whom": _who,
    "what else": _what,
    "what": _what,
    "which": _which,
    "where": _where,
    "when": lambda reader: Question(Ask.WHEN, inverted(reader)),
    "how often": lambda reader: Question(Ask.HOW_OFTEN, inverted(reader)),
    "how many times": lambda reader: Question(Ask.HOW_OFTEN, inverted(reader)),
    "how long": _how_long,
    "how many seconds": _how_long,
    "how much time": _how_long,
    "how many": _how_many,
    "how": _how,
}
"""What each beginning of a question reads; longer ones stand first."""


@attempt
def question(reader: Reader) -> Question | None:
    """Read a question if the sentence is one.

    Raises:
        SentenceError: A word that cannot be read.
    """
    window, first = reader.window(), tuple[Condition, ...]()
    words = [each.lower() for each in reader.tokens]
    asking = {each.split()[0] for each in FORMS} | {words[0] for words in of_class("auxiliary")}
    later = any(one == "," and two in asking for one, two in pairwise(words))
    if window is None and later and reader.is_next("relation"):
        first = conditions(reader)
    if window is not None or first:
        reader.accept(",")
    found = _question(reader)
    if found is None:
        return None
    about = found.about.having(window=found.about.circumstances.window or window)
    return replace(found, about=about.under(*first))


def _question(reader: Reader) -> Question | None:
    start = reader.at
    if reader.peek(1) in {"which", "what", "whom", "where", "how"}:
        reader.of("preposition")
    for words, form in FORMS.items():
        if reader.accept(words):
            found = form(reader)
            if found is not None:
                return _finished(reader, found)
            reader.at = start
    word = reader.peek()
    command = (
        reader.is_next("opening")
        or word in {"be", "have", "being", "having"}
        or (word in {"do", "don't"} and not reader.is_next("person", ahead=1))
    )
    if command or not reader.is_next("auxiliary"):
        return None
    return _finished(reader, Question(Ask.WHETHER, inverted(reader)))


def _finished(reader: Reader, value: Question) -> Question:
    """The question with what follows it: times, conditions, other possibilities."""
    while not reader.done:
        start = reader.at
        reader.accept(",")
        found = Adjuncts()
        if reader.adjunct(found):
            value = replace(value, about=found.of(value.about))
            continue
        reader.at = start
        if more := conditions(reader):
            value = replace(value, about=value.about.under(*more))
        elif reader.accept("or"):
            reader.accept("not")
            other = () if reader.done else (_alternative(reader, value.about),)
            value = replace(value, alternatives=(*value.alternatives, *other))
        elif (joined := _joined(reader)) is not None:
            value = replace(value, also=(*value.also, joined))
        else:
            raise reader.error(f"nothing is known that {reader.peek()!r} could begin", AFTER)
    ranks = {"first", "last"} & set(value.about.circumstances.manner)
    return replace(value, rank=value.rank or "".join(sorted(ranks)[:1]))


def _alternative(reader: Reader, about: Instruction) -> Instruction:
    if reader.is_next("auxiliary"):
        return inverted(reader)
    noun = noun_phrase(reader)
    if noun is None:
        raise reader.error("no other possibility", ("did",))
    if noun.limb:
        return replace(about, ee=noun.limb)
    if noun.is_person:
        return replace(about, agent=noun.person)
    objects = (*about.call.objects[:-1], *noun.things)
    return replace(about, call=replace(about.call, objects=objects))


@attempt
def _joined(reader: Reader) -> Instruction | None:
    """What else is asked for at once: ``and put it down``."""
    phrase = begin(reader) if reader.accept("and then", "but then", "and", "but") else None
    return None if phrase is None else matched(reader, complete(reader, phrase))
