"""English in: an instruction to be done, several of them, or a question to be asked."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from kb.language.clauses import conditions, helpers, predicate, subject
from kb.language.cursor import Cursor
from kb.language.instruction import Condition, Instruction, Plan, Window
from kb.language.noun_phrases import Adjuncts, Noun, Reader, adjunct, noun_phrase, window_at
from kb.language.question import Question
from kb.language.question_forms import question
from kb.language.verb_phrases import AFTER, begin, complete, matched, performed
from kb.language.vocabulary import VerbEntries, Vocabulary, is_next, number_at, of_class
from kb.lexicon.english import Form

BETWEEN = (",", ";", ":", "and", "but", "then", "or")
"""What may stand between two clauses."""


@dataclass
class _Told:
    """What was read so far."""

    parts: list[list[list[Instruction]]] = field(default_factory=list)
    about: Noun | None = None
    """The subject that further clauses of the sentence share."""

    hand: str = ""
    """The hand of what somebody was told to have done last; an instruction leaves it open."""


def statements(reader: Reader) -> Instruction | Plan:
    """Read instructions, or a telling of what was done, to the end of the text.

    Raises:
        SentenceError: A word that cannot be read.
    """
    told = _Told()
    cursor = reader.cursor
    while not cursor.done:
        told.parts.append([[]])
        told.about = None
        _sentence(reader, told)
    parts = tuple(
        tuple(tuple(stream) for stream in part if stream) for part in told.parts if any(part)
    )
    steps = Plan(parts).steps
    return steps[0] if len(steps) == 1 else Plan(parts)


def _sentence(reader: Reader, told: _Told) -> None:
    cursor = reader.cursor
    told.parts[-1][-1].append(_clause(reader, told))
    while not cursor.done and not cursor.accept("."):
        if _trailing(reader, told) or _beside(reader, told):
            continue
        start = cursor.at
        if _accept_all(reader, (*BETWEEN, *BETWEEN)):
            if cursor.done:
                cursor.at = start
                raise cursor.error("the sentence ends here", ())
            if (taker := _taker(reader, told.parts[-1][-1][-1])) is not None:
                told.about = taker
                value = predicate(reader, taker)
                told.parts[-1][-1].append(replace(value, agent=told.parts[-1][-1][-1].agent))
                continue
            again = _in_turn(reader, told.parts[-1][-1][-1])
            told.parts[-1][-1].append(again or _clause(reader, told))
            continue
        problem = f"nothing is known that {cursor.peek()!r} could begin"
        raise cursor.error(problem, AFTER)


def _in_turn(reader: Reader, last: Instruction) -> Instruction | None:
    """What was said last, with the hand that does it next: ``then with the left hand``."""
    cursor = reader.cursor
    start = cursor.at
    noun = noun_phrase(reader) if cursor.accept("with") else None
    if noun is not None and noun.limb:
        return replace(last, ee=noun.limb)
    cursor.at = start
    return None


def _taker(reader: Reader, last: Instruction) -> Noun | None:
    """The hand to which a thing was handed, of which more is told: ``which turned it about``."""
    limbs = {f"to the {' '.join(words)}": limb for words, limb in reader.words.limbs.items()}
    taken = [limbs[said] for said in last.circumstances.manner if said in limbs]
    return Noun(limb=taken[-1]) if taken and reader.cursor.accept("which") else None


def _accept_all(reader: Reader, words: Sequence[str]) -> bool:
    """Read those of the words that come next, in this order; whether there was one."""
    found = [reader.cursor.accept(each) for each in words]
    return True in found


def _trailing(reader: Reader, told: _Told) -> bool:
    """Times and manners after a comma, and conditions: they belong to what was said last."""
    cursor = reader.cursor
    start = cursor.at
    last = told.parts[-1][-1][-1]
    found = Adjuncts()
    _accept_all(reader, (",", "but", "and"))
    after = cursor.at
    while adjunct(cursor, found) or cursor.accept("and") or cursor.accept("then"):
        pass
    moved = found != Adjuncts() or cursor.at > after
    if moved and (cursor.done or cursor.peek() in {",", ".", "and", "while"}):
        own = last.circumstances
        changed = replace(
            own,
            manner=(*own.manner, *found.manner),
            count=found.count or own.count,
            window=found.window or own.window,
            duration_s=found.duration_s or own.duration_s,
        )
        told.parts[-1][-1][-1] = replace(last, circumstances=changed)
        return True
    cursor.at = start
    if _while(reader):
        return False
    more = conditions(reader)
    told.parts[-1][-1][-1] = last.under(*more)
    return bool(more)


def _while(reader: Reader) -> bool:
    cursor = reader.cursor
    ahead = 1 if cursor.peek() == "," else 0
    return cursor.peek(ahead) in {"while", "whilst"}


def _beside(reader: Reader, told: _Told) -> bool:
    """A stream beside the first: ``while the left hand held the bowl``."""
    cursor = reader.cursor
    start = cursor.at
    cursor.accept(",")
    if cursor.accept("while") or cursor.accept("whilst"):
        told.parts[-1].append([])
        told.about = None
        told.parts[-1][-1].append(_clause(reader, told))
        return True
    cursor.at = start
    return False


def _clause(reader: Reader, told: _Told) -> Instruction:
    """One clause, with what stands before it."""
    cursor = reader.cursor
    before, window = _opened(reader)
    first = _leading_condition(reader)
    negative = cursor.longest(of_class("negation")) is not None
    manner = [before] if before else []
    cursor.accept("always")
    value = _with_hand(reader, told, _main(reader, told, negative=negative))
    own = value.circumstances
    changed = replace(
        own, manner=(*manner, *own.manner), window=own.window or window, negated=own.negated
    )
    return replace(value, circumstances=changed).under(*first)


def _with_hand(reader: Reader, told: _Told, value: Instruction) -> Instruction:
    """In a telling, the hand that was named last goes on until another is named."""
    if told.about is None or not told.about.is_person:
        return value
    if len(told.parts[-1]) == 1:
        kind = told.hand.rpartition("_")[2]
        value = replace(value, ee=told.hand if value.ee in {"", kind} else value.ee)
        told.hand = value.ee
        reader.taken = reader.taken[0], value.ee
    return value


def _opened(reader: Reader) -> tuple[str, Window | None]:
    """What may open a clause: ``please``, ``then``, ``after 5 seconds``."""
    cursor = reader.cursor
    before, window = "", None
    while True:
        start = cursor.at
        word = cursor.longest(of_class("opening"))
        if word is not None:
            before = "again" if word == "again" else before
        else:
            found = window_at(cursor)
            if found is None and not _some_time_later(cursor):
                return before, window
            window = found or window
        cursor.accept(",")
        if cursor.done:
            cursor.at = start
            return before, window


def _some_time_later(cursor: Cursor) -> bool:
    """Read ``about 40 s later``, which tells of no time of its own."""
    start = cursor.at
    known = number_at(cursor) is not None and cursor.longest(of_class("unit")) is not None
    if known and cursor.accept("later"):
        return True
    cursor.at = start
    return False


def _leading_condition(reader: Reader) -> tuple[Condition, ...]:
    """A condition before the clause: ``when the bottle is empty, put it down``."""
    cursor = reader.cursor
    if not is_next(cursor, "relation"):
        return ()
    found = conditions(reader)
    if found:
        cursor.accept(",")
        cursor.accept("then")
    return found


def _main(reader: Reader, told: _Told, *, negative: bool) -> Instruction:
    cursor = reader.cursor
    about = _vocative(reader)
    if about is None and not _imperative(reader):
        about = _name(reader) or subject(reader)
        if about is not None:
            told.about = about
            return predicate(reader, about)
    if about is not None:
        told.about = about
        negative = negative or cursor.longest(of_class("negation")) is not None
    if cursor.peek() == "let" and cursor.peek(1) not in {"go"}:
        found = _let(reader)
        if found is not None:
            return found
    if cursor.accept("perform"):
        return performed(reader, about.person if about is not None else "")
    if cursor.accept("use"):
        return _use(reader)
    if is_next(cursor, "auxiliary") and told.about is not None:
        return predicate(reader, told.about)
    help_ = helpers(reader)
    phrase = begin(reader)
    if phrase is None:
        raise cursor.error(f"no verb {cursor.peek()!r}", reader.verbs.beginnings)
    phrase.negated = negative or help_.negated
    phrase.adjuncts.manner[:0] = help_.adjuncts.manner
    complete(reader, phrase)
    shared = told.about or Noun()
    return matched(reader, phrase, agent=shared.person, ee=shared.limb)


def _name(reader: Reader) -> Noun | None:
    """A performer that is not known, by a name before a verb: ``Subject0 moved``."""
    cursor = reader.cursor
    if any(is_next(cursor, each) for each in ("determiner", "person", "pronoun", "limb")):
        return None
    known = reader.words.nouns or {}
    for size in (1, 2):
        words = [cursor.peek(each) for each in range(size)]
        if any(map(reader.stops, range(size))) or tuple(words) in {**known, **reader.words.limbs}:
            return None
        if reader.verb_forms(size) & {Form.PAST, Form.THIRD}:
            name = "_".join(cursor.take().text for _ in range(size))
            agents = {each.lower(): each for each in reader.words.agents}
            return Noun(person=agents.get(name.lower(), name))
    return None


def _imperative(reader: Reader) -> bool:
    """Whether the clause begins with its verb."""
    cursor = reader.cursor
    if any(is_next(cursor, each) for each in ("determiner", "person", "limb", "pronoun")):
        return False
    if cursor.peek().split("_")[0] in {each.lower() for each in reader.words.agents}:
        return False
    return bool(reader.verb_forms()) or cursor.peek() in {"let", "use"} or _adverb(reader)


def _adverb(reader: Reader) -> bool:
    start = reader.cursor.at
    found = adjunct(reader.cursor, Adjuncts())
    reader.cursor.at = start
    return found


def _vocative(reader: Reader) -> Noun | None:
    """Who is told: ``the agent, reach for the mug``."""
    cursor = reader.cursor
    start = cursor.at
    cursor.skip_article()
    names = {tuple(each.lower().split("_")): each for each in (*reader.words.agents, "agent")}
    name = cursor.longest(names)
    if name is None and not reader.stops() and cursor.peek(1) == ",":
        name = cursor.take().text if not reader.verb_forms() else None
    if name is not None and cursor.accept(","):
        return Noun(person=name)
    cursor.at = start
    return None


def _let(reader: Reader) -> Instruction | None:
    """``let both hands rest``: what something is let do."""
    cursor = reader.cursor
    start = cursor.at
    cursor.take()
    about = subject(reader)
    if about is not None and cursor.peek() != "go" and Form.BASE in reader.verb_forms():
        return predicate(reader, about)
    cursor.at = start
    return None


def _use(reader: Reader) -> Instruction:
    """``use the whisk to stir the soup``: with the whisk."""
    cursor = reader.cursor
    tool = noun_phrase(reader)
    if tool is None or not cursor.accept("to"):
        raise cursor.error("what is it used for", ("to",))
    phrase = begin(reader)
    if phrase is None:
        raise cursor.error(f"no verb {cursor.peek()!r}", reader.verbs.beginnings)
    complete(reader, phrase)
    phrase.places.append(("with", tool))
    return matched(reader, phrase)


def parse(text: str, vocabulary: Vocabulary | None = None) -> Instruction | Plan | Question:
    """Read a text.

    Raises:
        SentenceError: A word that cannot be read; it says where, and what could stand there.
    """
    words = vocabulary or Vocabulary()
    reader = Reader(Cursor(text), words, VerbEntries(words))
    cursor = reader.cursor
    if cursor.done:
        raise cursor.error("an empty sentence", reader.verbs.beginnings)
    return question(reader) or statements(reader)
