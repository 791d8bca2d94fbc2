"""Questions: what is asked for, and of which action."""

from dataclasses import replace
from itertools import pairwise

from kb.language.instruction import Condition, Instruction
from kb.language.question import Ask, Question
from kb.language.reading.adjuncts import Adjuncts, adjunct, window_at
from kb.language.reading.clauses import conditions
from kb.language.reading.function_words import is_next, of_class, prepositions
from kb.language.reading.inverted_clauses import inverted
from kb.language.reading.matching import AFTER, matched
from kb.language.reading.noun_phrases import noun_phrase
from kb.language.reading.question_forms import FORMS
from kb.language.reading.reader import Reader
from kb.language.reading.verb_phrases import begin, complete


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
