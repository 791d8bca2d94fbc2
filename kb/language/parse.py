"""Controlled English in: an instruction to be done, or a question to be asked."""

from collections.abc import Sequence
from dataclasses import dataclass

from capar.model.par import Call
from kb.language.question import QUESTION_WORDS, Ask, Question
from kb.language.sentence import Instruction
from kb.language.tokens import ARTICLES, Cursor
from kb.language.vocabulary import PREPOSITIONS, Entry, Vocabulary
from kb.lexicon.english import name_of

WITH, FROM, TO, FOR = "with", "from", "to", "for"
AFTER = (WITH, FROM, TO, FOR)
"""What may follow a verb's objects: a hand, a source, a purpose."""


@dataclass(frozen=True)
class _Phrase:
    """A noun phrase as it stands: its preposition, and what it may name."""

    preposition: str
    thing: str | None
    """The object, if one is meant."""

    limb: str | None
    """The end-effector, if one is meant."""

    at: int
    """Where it begins."""


def parse(text: str, vocabulary: Vocabulary | None = None) -> Instruction | Question:
    """Read a sentence.

    Raises:
        SentenceError: A word that cannot be read; it says where, and what could stand there.
    """
    words = vocabulary or Vocabulary()
    cursor = Cursor(text)
    if cursor.done:
        raise cursor.error("an empty sentence", _beginnings(words))
    for asked, ask in QUESTION_WORDS.items():
        if cursor.accept(*asked):
            return _question(cursor, words, ask)
    agent = _agent(cursor, words)
    instruction = _instruction(cursor, words, agent)
    if not cursor.done:
        raise cursor.error(f"nothing is known that {cursor.peek()!r} could begin", AFTER)
    return instruction


def _beginnings(words: Vocabulary) -> list[str]:
    verbs = sorted({" ".join(verb) for verb in words.verbs})
    return [*verbs, *(" ".join(each) for each in QUESTION_WORDS)]


def _agent(cursor: Cursor, words: Vocabulary) -> str:
    """Who is told, or told of: ``the agent,`` or ``the agent`` before a verb."""
    start = cursor.at
    article = cursor.skip_article()
    names = {tuple(each.split("_")): each for each in (*words.agents, "agent")}
    found = cursor.longest(names)
    if found is None and article and cursor.peek(1) == ",":
        found = cursor.take().text
    if found is None and cursor.peek(1) == ",":
        found = cursor.take().text
    if found is None:
        cursor.at = start
        return ""
    cursor.accept(",")
    return found


def _instruction(cursor: Cursor, words: Vocabulary, agent: str) -> Instruction:
    if cursor.accept("perform"):
        return _performed(cursor, words, agent)
    start = cursor.at
    verb = cursor.longest(words.verbs)
    if verb is None:
        raise cursor.error(f"no verb {cursor.peek()!r}", _beginnings(words))
    entries = [each for each in words.entries if each.verb == verb]
    expected = {preposition for each in entries for preposition, _ in each.slots}
    phrases: list[_Phrase] = []
    while (phrase := _phrase(cursor, words, expected, first=not phrases)) is not None:
        phrases.append(phrase)
    purpose = _purpose(cursor)
    entry, objects, rest = _best(cursor, entries, phrases, start)
    ee, source = _rest(cursor, rest, words)
    ee = ee or _late_limb(cursor, words)
    return Instruction(Call(entry.action, objects, purpose), ee, agent, source)


def _phrase(
    cursor: Cursor, words: Vocabulary, expected: set[str], *, first: bool
) -> _Phrase | None:
    """The next noun phrase with its preposition, if one comes next."""
    start = cursor.at
    known = {tuple(each.split()): each for each in (*expected, *PREPOSITIONS) if each}
    preposition = cursor.longest(known) or ""
    if not preposition and not first:
        return None
    article = cursor.skip_article()
    at = cursor.at
    limb = cursor.longest(words.limbs)
    after_limb, cursor.at = cursor.at, at
    strict = limb is not None or (preposition == TO and not article)
    thing = _noun(cursor, words, strict=strict)
    if words.nouns is None and limb is not None:
        thing, cursor.at = limb, after_limb
    if thing is None and limb is None:
        if preposition == TO and not article:
            cursor.at = start
            return None
        if cursor.done and not preposition:
            return None
        raise cursor.error(f"no object {cursor.peek()!r}", _names(words))
    if thing is None or (limb is not None and after_limb >= cursor.at):
        cursor.at = after_limb
    return _Phrase(preposition, thing, limb, start)


def _names(words: Vocabulary) -> list[str]:
    return sorted(words.objects or ()) or ["the name of an object"]


def _noun(cursor: Cursor, words: Vocabulary, *, strict: bool) -> str | None:
    """An object; where any noun will do, the words up to a preposition, unless ``strict``."""
    if words.nouns is not None:
        return cursor.longest(words.nouns)
    if strict:
        return None
    parts: list[str] = []
    stops = PREPOSITIONS | ARTICLES | {"", ",", "and", FOR}
    while cursor.peek() not in stops and not cursor.peek().startswith('"'):
        parts.append(cursor.take().text)
    return "_".join(parts) or None


def _purpose(cursor: Cursor) -> str:
    if cursor.accept(FOR):
        if not cursor.peek().startswith('"'):
            raise cursor.error("a purpose after 'for' stands in quotation marks", ('"Drink"',))
        return cursor.quoted()
    if not cursor.accept(TO):
        return ""
    parts: list[str] = []
    while not cursor.done and cursor.peek() != WITH:
        parts.append(cursor.take().text.lower())
    if not parts:
        raise cursor.error("a place or a purpose is missing after 'to'", ())
    return name_of(" ".join(parts))


def _best(
    cursor: Cursor, entries: Sequence[Entry], phrases: Sequence[_Phrase], start: int
) -> tuple[Entry, tuple[str, ...], list[_Phrase]]:
    """The way to say it that leaves only what may stand beside it, and takes up the most."""
    found = []
    for entry in entries:
        match = _match(entry, phrases)
        if match is not None and all(map(_may_stay, match[1])):
            found.append((entry, *match))
    if found:
        return max(found, key=lambda each: len(each[1]))
    wanted = sorted({each.pattern for each in entries})
    shown = [each.replace("{1}", "A").replace("{2}", "B") for each in wanted]
    stray = next((each.at for each in phrases if not _fits_any(each, entries)), None)
    raise cursor.error(
        "the verb cannot be followed like this", shown, at=start if stray is None else stray
    )


def _fits_any(phrase: _Phrase, entries: Sequence[Entry]) -> bool:
    return _may_stay(phrase) or any(
        phrase.preposition == preposition for each in entries for preposition, _ in each.slots
    )


def _match(
    entry: Entry, phrases: Sequence[_Phrase]
) -> tuple[tuple[str, ...], list[_Phrase]] | None:
    """The objects of an entry in their order, and the phrases that it leaves."""
    rest = list(phrases)
    objects: dict[int, str] = {}
    for preposition, number in entry.slots:
        fitting = (each for each in rest if each.preposition == preposition)
        phrase = next((each for each in fitting if each.thing is not None), None)
        if phrase is None:
            return None
        objects[number] = str(phrase.thing)
        rest.remove(phrase)
    return tuple(objects[number] for number in sorted(objects)), rest


def _may_stay(phrase: _Phrase) -> bool:
    return (phrase.preposition == WITH and phrase.limb is not None) or phrase.preposition == FROM


def _rest(cursor: Cursor, rest: Sequence[_Phrase], words: Vocabulary) -> tuple[str, str]:
    """The end-effector and the source that phrases name."""
    limbs = [each for each in rest if each.preposition == WITH]
    sources = [each for each in rest if each.preposition == FROM]
    for several in (limbs, sources):
        if len(several) > 1:
            raise cursor.error("said twice", (), at=several[1].at)
    source = sources[0].thing if sources else ""
    if source is None:
        raise cursor.error("no object", _names(words), at=sources[0].at)
    return str(limbs[0].limb) if limbs else "", source


def _late_limb(cursor: Cursor, words: Vocabulary) -> str:
    """The end-effector after the purpose: ``to drink with the right hand``."""
    if not cursor.accept(WITH):
        return ""
    cursor.skip_article()
    limb = cursor.longest(words.limbs)
    if limb is None:
        raise cursor.error(f"no end-effector {cursor.peek()!r}", words.effectors)
    return limb


def _performed(cursor: Cursor, words: Vocabulary, agent: str) -> Instruction:
    """The form for what has no verb: ``perform Name on A and B``."""
    if cursor.done:
        raise cursor.error("the name of an action is missing", {e.action for e in words.entries})
    name = cursor.quoted() if cursor.peek().startswith('"') else cursor.take().text
    objects: list[str] = []
    while cursor.accept("and") if objects else cursor.accept("on"):
        cursor.skip_article()
        thing = _noun(cursor, words, strict=False)
        if thing is None:
            raise cursor.error(f"no object {cursor.peek()!r}", _names(words))
        objects.append(thing)
    phrases = []
    while (phrase := _phrase(cursor, words, set(), first=False)) is not None:
        phrases.append(phrase)
    ee, source = _rest(cursor, [each for each in phrases if _may_stay(each)], words)
    return Instruction(Call(name, tuple(objects), _purpose(cursor)), ee, agent, source)


def _question(cursor: Cursor, words: Vocabulary, ask: Ask) -> Question:
    """What follows a question word: a verb with what is said of it."""
    if ask.needs_did:
        for helper in ("did", "was", "is", "does"):
            if cursor.accept(helper):
                break
        else:
            raise cursor.error(f"{cursor.peek()!r} cannot follow", ("did",))
        agent = "" if cursor.accept("anybody") else _agent(cursor, words)
    else:
        agent = ""
    verb_at = cursor.at
    if cursor.longest(words.verbs) is None:
        raise cursor.error(f"no verb {cursor.peek()!r}", _beginnings(words))
    cursor.at = verb_at
    asked = _instruction(cursor, words, agent)
    if not cursor.done:
        raise cursor.error(f"nothing is known that {cursor.peek()!r} could begin", AFTER)
    return Question(ask, asked)
