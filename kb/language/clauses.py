"""Clauses: a subject, what helps the verb, and the verb phrase; also passive, and states."""

from dataclasses import dataclass, replace

from capar.model.par import Call
from kb.language.instruction import GAP, Circumstances, Condition, Instruction, Relation
from kb.language.noun_phrases import Adjuncts, Noun, Reader, adjunct, noun_phrase
from kb.language.verb_phrases import VerbPhrase, begin, complete
from kb.language.verb_phrases import matched as matched
from kb.language.vocabulary import is_next, of_class
from kb.lexicon.english import Form

BE, DO, HAVE = "be", "do", "have"
MAIN_VERBS = frozenset({"do", "doing", "done", "have", "having"})
"""Words of helping verbs that are verbs by themselves where no other follows."""


@dataclass
class Helpers:
    """What stands before a verb: ``had not been``."""

    kinds: list[str]
    negated: bool
    adjuncts: Adjuncts


def helpers(reader: Reader) -> Helpers:
    """Read helping verbs, negations and adverbs, if any come next."""
    cursor = reader.cursor
    found = Helpers([], False, Adjuncts())
    while not cursor.done:
        if is_next(cursor, "negation"):
            found.negated = True
            kind = of_class("auxiliary").get((cursor.peek(),))
            found.kinds += [kind] if kind else []
            cursor.longest(of_class("negation"))
            continue
        kind = of_class("auxiliary").get((cursor.peek(),))
        if kind is None:
            if reader.verb_ahead() or not adjunct(cursor, found.adjuncts):
                break
            continue
        if cursor.peek() in MAIN_VERBS and not _verb_follows(reader):
            break
        found.kinds.append(kind)
        cursor.take()
    return found


def _verb_follows(reader: Reader) -> bool:
    ahead = 1
    while (reader.cursor.peek(ahead),) in {*of_class("negation"), *of_class("auxiliary")}:
        ahead += 1
    forms = reader.verb_forms(ahead)
    wanted = {Form.BASE} if reader.cursor.peek() == "do" else {Form.PARTICIPLE, Form.PAST}
    return ahead > 1 or bool(forms & wanted)


def subject(reader: Reader) -> Noun | None:
    """Read who or what a clause is about: a noun phrase before a verb or what helps it."""
    cursor = reader.cursor
    start, known = cursor.at, (reader.thing, reader.several)
    reader.limit = len(cursor.tokens)
    try:
        while reader.limit > start:
            cursor.at = start
            reader.thing, reader.several = known
            noun = noun_phrase(reader, coordinate=False)
            if noun is None:
                break
            noun = _several(reader, noun)
            if _predicate_ahead(reader) and not (noun.unknown and cursor.at - start > 3):
                return noun
            reader.limit = min(reader.limit, cursor.at) - 1
    finally:
        reader.limit = 1_000_000
    cursor.at = start
    reader.thing, reader.several = known
    return None


def _several(reader: Reader, first: Noun) -> Noun:
    """Several subjects of one verb: ``the mug and the bowl were moved``."""
    cursor = reader.cursor
    start = cursor.at
    outer = reader.limit
    if first.things and cursor.accept("and"):
        begun = cursor.at
        for limit in range(len(cursor.tokens), begun, -1):
            reader.limit, cursor.at = limit, begun
            second = noun_phrase(reader, coordinate=False)
            if second is not None and second.things and _predicate_ahead(reader):
                reader.limit = outer
                return Noun((*first.things, *second.things), at=first.at)
    reader.limit = outer
    cursor.at = start
    return first


def _predicate_ahead(reader: Reader) -> bool:
    cursor = reader.cursor
    if any(is_next(cursor, each) for each in ("auxiliary", "negation")):
        return True
    start = cursor.at
    while adjunct(cursor, Adjuncts()):
        pass
    found = bool(reader.verb_forms())
    cursor.at = start
    return found


def predicate(reader: Reader, about: Noun | None, before: Helpers | None = None) -> Instruction:
    """Read what is said of a subject, after the helping verbs that stood before it."""
    cursor = reader.cursor
    more = helpers(reader)
    earlier = before or Helpers([], False, Adjuncts())
    kinds = [*earlier.kinds, *more.kinds]
    phrase = begin(reader)
    is_be = kinds[-1:] == [BE]
    if phrase is None or (is_be and not phrase.form & {Form.PARTICIPLE, Form.GERUND}):
        if not is_be:
            raise cursor.error(f"no verb {cursor.peek()!r}", reader.verbs.beginnings)
        cursor.at = phrase.at if phrase else cursor.at
        return _state(reader, about, more, negated=more.negated or earlier.negated)
    thing = about is not None and not about.is_person and not about.limb
    if is_be and thing and "state" in _classes(phrase):
        return _state(reader, about, more, negated=more.negated or earlier.negated)
    nobody = about is not None and about.none
    phrase.negated = more.negated or earlier.negated or nobody
    phrase.passive = is_be and Form.GERUND not in phrase.form
    for adjuncts in (earlier.adjuncts, more.adjuncts):
        phrase.adjuncts.manner[:0] = adjuncts.manner
        phrase.adjuncts.count = phrase.adjuncts.count or adjuncts.count
        phrase.adjuncts.window = phrase.adjuncts.window or adjuncts.window
    return _of_subject(reader, phrase, about)


def _classes(phrase: VerbPhrase) -> set[str]:
    return {"state" for verb in phrase.verbs if (verb,) in of_class("state")}


def _of_subject(reader: Reader, phrase: VerbPhrase, about: Noun | None) -> Instruction:
    if "use" in phrase.verbs:
        return _using(reader, phrase, about)
    thing = about is not None and not about.is_person and not about.limb
    if about is not None and (phrase.passive or thing):
        phrase.objects.append(about)
    complete(reader, phrase)
    person = "" if about is None or phrase.passive else about.person
    limb = "" if about is None or phrase.passive else about.limb
    return matched(reader, phrase, agent=person, ee=limb)


def _using(reader: Reader, phrase: VerbPhrase, about: Noun | None) -> Instruction:
    """``used her left hand to open it``, and ``was used to open it``."""
    cursor = reader.cursor
    tool = about if phrase.passive else noun_phrase(reader)
    doer = Noun() if phrase.passive or about is None else about
    doing = None
    if cursor.accept("to") or cursor.accept("for"):
        doing = begin(reader)
    told = VerbPhrase(("do",), phrase.at) if doing is None else doing
    told.negated, told.adjuncts = phrase.negated, phrase.adjuncts
    complete(reader, told)
    if tool is not None:
        told.places.append(("with", tool))
    return matched(reader, told, agent=doer.person, ee=doer.limb)


def _state(reader: Reader, about: Noun | None, more: Helpers, *, negated: bool) -> Instruction:
    """Where something was, or how: ``was behind the bowl``, ``was empty``."""
    phrase = VerbPhrase(("be",), reader.cursor.at, negated=negated, adjuncts=more.adjuncts)
    complete(reader, phrase)
    objects = about.things if about is not None else ()
    ee = next((each.limb for word, each in phrase.places if each.limb and word == "in"), "")
    places = [(word, each) for word, each in phrase.places if not (each.limb and word == "in")]
    said = tuple(name for each in phrase.objects for name in each.things)
    told = Circumstances(
        negated=negated,
        manner=(*phrase.adjuncts.manner, *said, *phrase.particles),
        places=tuple((word, ", ".join(each.things) or "someone") for word, each in places),
        window=phrase.adjuncts.window,
        duration_s=phrase.adjuncts.duration_s,
    )
    action = "Touch" if ee else "Be"
    person = about.person if about is not None else ""
    return Instruction(Call(action, objects), ee, person, "", told, "" if ee else "be", bool(ee))


_EXACTLY: dict[tuple[str, ...], str] = {
    (word,): word for word in ("right", "just", "only", "shortly", "exactly")
}
"""Words before a relation that say how close in time it is."""


def conditions(reader: Reader) -> tuple[Condition, ...]:
    """Read what else was when it was done: ``while the bottle was tilted``."""
    found: list[Condition] = []
    cursor = reader.cursor
    while not cursor.done:
        start = cursor.at
        cursor.accept(",")
        cursor.longest(_EXACTLY)
        condition = _condition(reader)
        if condition is None:
            cursor.at = start
            break
        found.append(condition)
    return tuple(found)


def _condition(reader: Reader) -> Condition | None:
    cursor = reader.cursor
    start = cursor.at
    if cursor.longest({("without",): "", ("instead", "of"): ""}) is not None:
        return _with_gerund(reader, Relation.WITHOUT, start)
    word = cursor.longest(of_class("relation"))
    if word is None:
        return None
    relation = Relation(word)
    if Form.GERUND in reader.verb_forms() and (found := _with_gerund(reader, relation, start)):
        return found
    about = subject(reader)
    if about is None:
        cursor.at = start
        return None
    return Condition(relation, predicate(reader, about))


def _with_gerund(reader: Reader, relation: Relation, start: int) -> Condition | None:
    cursor = reader.cursor
    phrase = begin(reader)
    if phrase is None or Form.GERUND not in phrase.form:
        cursor.at = start
        return None
    complete(reader, phrase)
    return Condition(relation, matched(reader, phrase))


def same_agent(reader: Reader, value: Instruction) -> Instruction:
    """The instruction, with what else its performer did: ``by the same person who opened it``."""
    if not reader.cursor.accept("who") and not reader.cursor.accept("that"):
        return value
    about = predicate(reader, Noun(any_person=True))
    anybody = replace(value, agent="")
    return anybody.under(Condition(Relation.SAME_AGENT, about))


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
