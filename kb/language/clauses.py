"""Clauses: a subject, what helps the verb, and the verb phrase; also passive, and states."""

from dataclasses import dataclass, field, replace

from capar.model.par import Call
from kb.language.instruction import GAP, Circumstances, Condition, Instruction, Relation
from kb.language.noun_phrases import Noun, noun_phrase
from kb.language.reader import Adjuncts, Reader, attempt
from kb.language.verb_phrases import VerbPhrase, begin, complete, matched, require
from kb.language.vocabulary import of_class
from kb.lexicon.english import Form

MAIN_VERBS = frozenset({"do", "doing", "done", "have", "having"})
"""Words of helping verbs that are verbs by themselves where no other follows."""

HELPERS = ("did", "was", "were", "is", "does", "has", "had")
GAP_THING, GAP_PERSON = Noun((GAP,)), Noun(any_person=True)


@dataclass
class Helpers:
    """What stands before a verb: ``had not been``."""

    kinds: list[str] = field(default_factory=list)
    negated: bool = False
    adjuncts: Adjuncts = field(default_factory=Adjuncts)


def helpers(reader: Reader) -> Helpers:
    """Read helping verbs, negations and adverbs, if any come next."""
    found = Helpers()
    while not reader.done:
        kind = of_class("auxiliary").get((reader.peek(),))
        if reader.of("negation") is not None:
            found.negated = True
            found.kinds += [kind] if kind else []
        elif kind is None:
            if reader.verb_ahead() or not reader.adjunct(found.adjuncts):
                break
        elif reader.peek() in MAIN_VERBS and not _verb_follows(reader):
            break
        else:
            found.kinds.append(kind)
            reader.take()
    return found


def _verb_follows(reader: Reader) -> bool:
    ahead = 1
    while (reader.peek(ahead),) in {*of_class("negation"), *of_class("auxiliary")}:
        ahead += 1
    wanted = {Form.BASE} if reader.peek() == "do" else {Form.PARTICIPLE, Form.PAST}
    return ahead > 1 or bool(reader.verb_forms(ahead) & wanted)


def subject(reader: Reader) -> Noun | None:
    """Read who or what a clause is about: a noun phrase before a verb or what helps it."""
    start, known = reader.at, (reader.thing, reader.several)
    outer = reader.limit
    reader.limit = len(reader.tokens)
    found = None
    while found is None and reader.limit > start:
        reader.at = start
        reader.thing, reader.several = known
        noun = noun_phrase(reader, coordinate=False)
        if noun is None:
            break
        noun = _several(reader, noun)
        if reader.look(_is_predicate) and not (noun.unknown and reader.at - start > 3):
            found = noun
        else:
            reader.limit = min(reader.limit, reader.at) - 1
    reader.limit = outer
    if found is None:
        reader.at = start
        reader.thing, reader.several = known
    return found


def _several(reader: Reader, first: Noun) -> Noun:
    """Several subjects of one verb: ``the mug and the bowl were moved``."""
    start, outer = reader.at, reader.limit
    if first.things and reader.accept("and"):
        begun = reader.at
        for limit in range(len(reader.tokens), begun, -1):
            reader.limit, reader.at = limit, begun
            second = noun_phrase(reader, coordinate=False)
            if second is not None and second.things and reader.look(_is_predicate):
                reader.limit = outer
                return Noun((*first.things, *second.things), at=first.at)
    reader.limit, reader.at = outer, start
    return first


def _is_predicate(reader: Reader) -> bool:
    if reader.is_next("auxiliary", "negation"):
        return True
    while reader.adjunct(Adjuncts()):
        pass
    return bool(reader.verb_forms())


def predicate(reader: Reader, about: Noun, before: Helpers | None = None) -> Instruction:
    """Read what is said of a subject, after the helping verbs that stood before it."""
    more, earlier = helpers(reader), before or Helpers()
    negated = more.negated or earlier.negated
    is_be = [*earlier.kinds, *more.kinds][-1:] == ["be"]
    start = reader.at
    phrase = begin(reader) if is_be else require(reader)
    if phrase is None or (is_be and not phrase.form & {Form.PARTICIPLE, Form.GERUND}):
        reader.at = phrase.at if phrase else start
        return _state(reader, about, more, negated=negated)
    if is_be and about.is_thing and any((verb,) in of_class("state") for verb in phrase.verbs):
        return _state(reader, about, more, negated=negated)
    phrase.negated = negated or about.none
    phrase.passive = is_be and Form.GERUND not in phrase.form
    for adjuncts in (earlier.adjuncts, more.adjuncts):
        phrase.adjuncts.manner[:0] = adjuncts.manner
        phrase.adjuncts.count = phrase.adjuncts.count or adjuncts.count
        phrase.adjuncts.window = phrase.adjuncts.window or adjuncts.window
    doer = Noun() if phrase.passive else about
    if "use" in phrase.verbs:
        tool = about if phrase.passive else noun_phrase(reader)
        done = begin(reader) if reader.accept("to", "for") else None
        done = done or VerbPhrase(("do",), phrase.at)
        done.negated, done.adjuncts = phrase.negated, phrase.adjuncts
        phrase = complete(reader, done)
        phrase.places += [("with", tool)] if tool is not None else []
    else:
        phrase.objects += [about] if phrase.passive or about.is_thing else []
        complete(reader, phrase)
    return matched(reader, phrase, agent=doer.person, ee=doer.limb)


def _state(reader: Reader, about: Noun, more: Helpers, *, negated: bool) -> Instruction:
    """Where something was, or how: ``was behind the bowl``, ``was empty``."""
    phrase = complete(reader, VerbPhrase(("be",), reader.at, adjuncts=more.adjuncts))
    ee = next((each.limb for word, each in phrase.places if each.limb and word == "in"), "")
    places = [(word, each) for word, each in phrase.places if not (each.limb and word == "in")]
    names = tuple(name for each in phrase.objects for name in each.things)
    circumstances = Circumstances(
        negated=negated,
        manner=(*phrase.adjuncts.manner, *names, *phrase.particles),
        places=tuple((word, ", ".join(each.things) or "someone") for word, each in places),
        window=phrase.adjuncts.window,
        duration_s=phrase.adjuncts.duration_s,
    )
    call = Call("Touch" if ee else "Be", about.things)
    said = "" if ee else "be"
    return Instruction(call, ee, about.person, "", circumstances, said, known=bool(ee))


def conditions(reader: Reader) -> tuple[Condition, ...]:
    """Read what else was when it was done: ``while the bottle was tilted``."""
    found: list[Condition] = []
    while not reader.done and (condition := _condition(reader)) is not None:
        found.append(condition)
    return tuple(found)


@attempt
def _condition(reader: Reader) -> Condition | None:
    reader.accept(",")
    reader.accept("right", "just", "only", "shortly", "exactly")
    without = reader.accept("without", "instead of")
    word = "without" if without else reader.of("relation")
    if word is None:
        return None
    start = reader.at
    if without or Form.GERUND in reader.verb_forms():
        phrase = begin(reader)
        if phrase is not None and Form.GERUND in phrase.form:
            return Condition(Relation(word), matched(reader, complete(reader, phrase)))
        reader.at = start
    about = None if without else subject(reader)
    return None if about is None else Condition(Relation(word), predicate(reader, about))


def inverted(reader: Reader, gap: Noun | None = None) -> Instruction:
    """A helping verb, the subject, and what is said of it; the gap is its object."""
    while not reader.is_next("auxiliary") and reader.adjunct(Adjuncts()):
        pass
    if reader.peek() in {"do", "be"} or not reader.is_next("auxiliary"):
        raise reader.error(f"{reader.peek()!r} cannot follow", HELPERS)
    before = helpers(reader)
    about = subject(reader)
    if about is None and before.kinds[-1:] == ["be"]:
        reader.accept("there")
        about = noun_phrase(reader)
    if about is None:
        raise reader.error(f"{reader.peek()!r} is no subject", HELPERS)
    if gap is not None:
        return relative(reader, about, gap, before)
    found = predicate(reader, about, before)
    if not reader.accept("who", "that"):
        return found
    same = Condition(Relation.SAME_AGENT, predicate(reader, GAP_PERSON))
    return replace(found, agent="").under(same)


def relative(
    reader: Reader, about: Noun, gap: Noun = GAP_THING, before: Helpers | None = None
) -> Instruction:
    """What somebody did to what is asked for, where an object or a preposition lacks it."""
    more, before = helpers(reader), before or Helpers()
    phrase = require(reader)
    phrase.negated = before.negated
    phrase.adjuncts.manner[:0] = [*more.adjuncts.manner, *before.adjuncts.manner]
    reader.gap = True
    complete(reader, phrase)
    reader.gap = False
    asked = [*phrase.objects, *(noun for _, noun in phrase.places)]
    if not any(each.things == (GAP,) for each in asked):
        phrase.objects.insert(0, gap)
    return matched(reader, phrase, agent=about.person, ee=about.limb)
