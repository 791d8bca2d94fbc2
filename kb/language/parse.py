"""English in: an instruction to be done, several of them, or a question to be asked."""

from dataclasses import dataclass, field, replace

from kb.language.clauses import conditions, helpers, predicate, subject
from kb.language.instruction import Condition, Instruction, Plan, Window
from kb.language.noun_phrases import Noun, noun_phrase
from kb.language.question import Question
from kb.language.question_forms import question
from kb.language.reader import Adjuncts, Reader, attempt
from kb.language.verb_phrases import AFTER, complete, matched, performed, require
from kb.language.vocabulary import Vocabulary
from kb.lexicon.english import Form

BETWEEN = (",", ";", ":", "and", "but", "then", "or")
"""What may stand between two clauses."""

NAMING = ("determiner", "person", "pronoun", "limb")
"""Classes of words with which a noun phrase begins."""


@dataclass
class _Text:
    """What was read so far."""

    parts: list[list[list[Instruction]]] = field(default_factory=list)
    about: Noun | None = None
    """The subject that further clauses of the sentence share."""

    hand: str = ""
    """The hand of what somebody did last; an instruction leaves it open."""


def parse(text: str, vocabulary: Vocabulary | None = None) -> Instruction | Plan | Question:
    """Read a text.

    Raises:
        SentenceError: A word that cannot be read; it says where, and what could stand there.
    """
    reader = Reader(text, vocabulary or Vocabulary())
    if reader.done:
        raise reader.error("an empty sentence", reader.words.beginnings)
    asked = question(reader)
    if asked is not None:
        return asked
    read = _Text()
    while not reader.done:
        read.parts.append([[]])
        read.about = None
        _sentence(reader, read)
    parts = tuple(
        tuple(tuple(stream) for stream in part if stream) for part in read.parts if any(part)
    )
    steps = Plan(parts).steps
    return steps[0] if len(steps) == 1 else Plan(parts)


def _sentence(reader: Reader, read: _Text) -> None:
    part = read.parts[-1]
    part[-1].append(_clause(reader, read))
    while not reader.done and not reader.accept("."):
        stream = part[-1]
        if _trailing(reader, stream):
            continue
        start = reader.at
        if reader.accept("while", "whilst", ", while", ", whilst"):
            read.about = None
            part.append([_clause(reader, read)])
        elif [each for each in (*BETWEEN, *BETWEEN) if reader.accept(each)]:
            if reader.done:
                raise reader.error("the sentence ends here", (), at=start)
            if (taker := _taker(reader, stream[-1])) is not None:
                read.about = taker
                stream.append(replace(predicate(reader, taker), agent=stream[-1].agent))
            else:
                stream.append(_in_turn(reader, stream[-1]) or _clause(reader, read))
        else:
            raise reader.error(f"nothing is known that {reader.peek()!r} could begin", AFTER)


@attempt
def _in_turn(reader: Reader, last: Instruction) -> Instruction | None:
    """What was said last, with the hand that does it next: ``then with the left hand``."""
    noun = noun_phrase(reader) if reader.accept("with") else None
    return replace(last, ee=noun.limb) if noun is not None and noun.limb else None


def _taker(reader: Reader, last: Instruction) -> Noun | None:
    """The hand that took an object, of which more is said: ``which turned it about``."""
    limbs = {f"to the {' '.join(words)}": limb for words, limb in reader.words.limbs.items()}
    taken = [limbs[said] for said in last.circumstances.manner if said in limbs]
    return Noun(limb=taken[-1]) if taken and reader.accept("which") else None


@attempt
def _trailing(reader: Reader, stream: list[Instruction]) -> bool:
    """Times and manners after a comma, and conditions: they belong to what was said last."""
    start, last = reader.at, stream[-1]
    found = Adjuncts()
    reader.accept(", but", ", and", ",", "but", "and")
    after = reader.at
    while reader.adjunct(found) or reader.accept("and", "then"):
        pass
    if reader.at > after and (reader.done or reader.peek() in {",", ".", "and", "while"}):
        stream[-1] = found.of(last)
        return True
    reader.at = start
    if reader.peek(int(reader.peek() == ",")) in {"while", "whilst"}:
        return False
    more = conditions(reader)
    stream[-1] = last.under(*more)
    return bool(more)


def _clause(reader: Reader, read: _Text) -> Instruction:
    """One clause, with what stands before it; in a description a hand goes on until another."""
    before, window = _opened(reader)
    first: tuple[Condition, ...] = ()
    if reader.is_next("relation"):
        first = conditions(reader)
        if first:
            reader.accept(", then", ",", "then")
    negative = reader.of("negation") is not None
    reader.accept("always")
    value = _main(reader, read, negative=negative)
    if read.about is not None and read.about.is_person and len(read.parts[-1]) == 1:
        kind = read.hand.rpartition("_")[2]
        value = replace(value, ee=read.hand if value.ee in {"", kind} else value.ee)
        read.hand = value.ee
        reader.taken = reader.taken[0], value.ee
    own = value.circumstances
    manner = (before, *own.manner) if before else own.manner
    return value.having(manner=manner, window=own.window or window).under(*first)


def _opened(reader: Reader) -> tuple[str, Window | None]:
    """What may open a clause: ``please``, ``then``, ``after 5 seconds``."""
    before, window = "", None
    while True:
        start = reader.at
        word = reader.of("opening")
        if word is not None:
            before = "again" if word == "again" else before
        else:
            found = reader.window()
            if found is None and not reader.match("later"):
                return before, window
            window = found or window
        reader.accept(",")
        if reader.done:
            reader.at = start
            return before, window


def _main(reader: Reader, read: _Text, *, negative: bool) -> Instruction:
    about = _vocative(reader)
    if about is not None:
        negative = negative or reader.of("negation") is not None
    elif not _is_imperative(reader):
        about = _name(reader) or subject(reader)
        if about is not None:
            read.about = about
            return predicate(reader, about)
    read.about = about or read.about
    if (allowed := _let(reader)) is not None:
        return allowed
    if reader.accept("perform"):
        return performed(reader, about.person if about is not None else "")
    tool = None
    if reader.accept("use"):
        tool = noun_phrase(reader)
        if tool is None or not reader.accept("to"):
            raise reader.error("what is it used for", ("to",))
    elif reader.is_next("auxiliary") and read.about is not None:
        return predicate(reader, read.about)
    help_ = helpers(reader)
    phrase = require(reader)
    phrase.negated = negative or help_.negated
    phrase.adjuncts.manner[:0] = help_.adjuncts.manner
    complete(reader, phrase)
    phrase.places += [("with", tool)] if tool is not None else []
    shared = read.about or Noun()
    return matched(reader, phrase, agent=shared.person, ee=shared.limb)


def _name(reader: Reader) -> Noun | None:
    """A performer that is not known, by a name before a verb: ``Subject0 moved``."""
    if reader.is_next(*NAMING):
        return None
    known = {*(reader.words.nouns or {}), *reader.words.limbs}
    for size in (1, 2):
        words = tuple(reader.peek(each) for each in range(size))
        if any(map(reader.stops, range(size))) or words in known:
            return None
        if reader.verb_forms(size) & {Form.PAST, Form.THIRD}:
            name = "_".join(reader.take() for _ in range(size))
            agents = {each.lower(): each for each in reader.words.agents}
            return Noun(person=agents.get(name.lower(), name))
    return None


def _is_imperative(reader: Reader) -> bool:
    """Whether the clause begins with its verb."""
    named = reader.peek().split("_")[0] in {each.lower() for each in reader.words.agents}
    return not (named or reader.is_next(*NAMING)) and (
        bool(reader.verb_forms())
        or reader.peek() in {"let", "use"}
        or reader.look(lambda r: r.adjunct(Adjuncts()))
    )


@attempt
def _vocative(reader: Reader) -> Noun | None:
    """Who is addressed: ``the agent, reach for the mug``."""
    reader.accept("the", "a", "an")
    names = {tuple(each.lower().split("_")): each for each in (*reader.words.agents, "agent")}
    name = reader.longest(names)
    if name is None and not reader.stops() and reader.peek(1) == ",":
        name = reader.take() if not reader.verb_forms() else None
    return Noun(person=name) if name is not None and reader.accept(",") else None


@attempt
def _let(reader: Reader) -> Instruction | None:
    """``let both hands rest``: what something is let do."""
    if not reader.accept("let") or reader.peek() == "go":
        return None
    about = subject(reader)
    if about is None or reader.peek() == "go" or Form.BASE not in reader.verb_forms():
        return None
    return predicate(reader, about)
