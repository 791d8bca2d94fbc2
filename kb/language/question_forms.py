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
from kb.language.noun_phrases import Adjuncts, Noun, Reader, adjunct, noun_phrase, window_at
from kb.language.question import Ask, Question
from kb.language.verb_phrases import AFTER, VerbPhrase, begin, complete, matched
from kb.language.vocabulary import is_next, of_class, prepositions
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


def question(reader: Reader) -> Question | None:
    """Read a question if the sentence is one.

    Raises:
        SentenceError: A word that cannot be read.
    """
    cursor = reader.cursor
    before = cursor.at
    window, first = window_at(cursor), tuple[Condition, ...]()
    if window is None and is_next(cursor, "relation") and _asks_later(reader):
        first = conditions(reader)
    if window is not None or first:
        cursor.accept(",")
    found = _question(reader)
    if found is None:
        cursor.at = before
        return None
    own = replace(found.about.circumstances, window=found.about.circumstances.window or window)
    return replace(found, about=replace(found.about, circumstances=own).under(*first))


def _asks_later(reader: Reader) -> bool:
    """Whether a question begins after a comma."""
    words = [each.text.lower() for each in reader.cursor.tokens]
    asking = {words[0] for words in (*FORMS, *of_class("auxiliary"))}
    return any(one == "," and two in asking for one, two in pairwise(words))


def _question(reader: Reader) -> Question | None:
    cursor = reader.cursor
    start = cursor.at
    fronted = cursor.peek(1) in {"which", "what", "whom", "where", "how"}
    if fronted and cursor.longest(prepositions()) is None:
        cursor.at = start
    for words, form in FORMS.items():
        if cursor.accept(*words):
            found = form(reader)
            if found is not None:
                return _finished(reader, found)
            cursor.at = start
    if is_next(cursor, "auxiliary") and not _command(reader):
        return _finished(reader, Question(Ask.WHETHER, inverted(reader)))
    return None


def _command(reader: Reader) -> bool:
    """Whether a helping verb begins an instruction: ``don't touch it``, ``could you``."""
    cursor = reader.cursor
    word = cursor.peek()
    if is_next(cursor, "opening") or word in {"be", "have", "being", "having"}:
        return True
    return word in {"do", "don't"} and not is_next(cursor, "person", 1)


def _finished(reader: Reader, value: Question) -> Question:
    """The question with what follows it: times, conditions, other possibilities."""
    cursor = reader.cursor
    while not cursor.done:
        start = cursor.at
        cursor.accept(",")
        found = Adjuncts()
        if adjunct(cursor, found):
            own = value.about.circumstances
            own = replace(
                own,
                manner=(*own.manner, *found.manner),
                window=found.window or own.window,
                count=found.count or own.count,
            )
            value = replace(value, about=replace(value.about, circumstances=own))
            continue
        cursor.at = start
        more = conditions(reader)
        if more:
            value = replace(value, about=value.about.under(*more))
        elif cursor.accept("or"):
            cursor.accept("not")
            other = () if cursor.done else (_alternative(reader, value),)
            value = replace(value, alternatives=(*value.alternatives, *other))
        elif cursor.peek() in {"and", "but"} and (joined := _joined(reader)) is not None:
            value = replace(value, also=(*value.also, joined))
        else:
            problem = f"nothing is known that {cursor.peek()!r} could begin"
            raise cursor.error(problem, AFTER)
    ranks = {"first", "last"} & set(value.about.circumstances.manner)
    return replace(value, rank=value.rank or "".join(sorted(ranks)[:1]))


def _alternative(reader: Reader, value: Question) -> Instruction:
    if is_next(reader.cursor, "auxiliary"):
        return inverted(reader)
    noun = noun_phrase(reader)
    if noun is None:
        raise reader.cursor.error("no other possibility", ("did",))
    about = value.about
    if noun.limb:
        return replace(about, ee=noun.limb)
    if noun.is_person:
        return replace(about, agent=noun.person)
    return replace(
        about, call=replace(about.call, objects=(*about.call.objects[:-1], *noun.things))
    )


def _joined(reader: Reader) -> Instruction | None:
    """What else is asked for at once: ``and put it down``."""
    cursor = reader.cursor
    start = cursor.at
    cursor.take()
    cursor.accept("then")
    phrase = begin(reader)
    if phrase is None:
        cursor.at = start
        return None
    return matched(reader, complete(reader, phrase))
