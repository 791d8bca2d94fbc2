"""A verb with all that follows it: objects, places, hands, purposes, times and manners."""

from dataclasses import dataclass, field, replace

from kb.language.instruction import GAP
from kb.language.reading.adjuncts import Adjuncts, adjunct, around
from kb.language.reading.function_words import is_next, of_class, prepositions
from kb.language.reading.noun_phrases import Noun, begins_noun, noun_phrase
from kb.language.reading.reader import CONNECTIVES, RELATIVES, Reader
from kb.language.tokens import ARTICLES
from kb.lexicon.english import Form, name_of

FOR, TO, WITH = "for", "to", "with"


@dataclass
class VerbPhrase:
    """A verb and what stands with it, before it is known which primitive it says."""

    verbs: tuple[str, ...]
    """The verbs that its form may be of."""

    at: int
    form: frozenset[Form] = frozenset()
    particles: list[str] = field(default_factory=list)
    objects: list[Noun] = field(default_factory=list)
    places: list[tuple[str, Noun]] = field(default_factory=list)
    adjuncts: Adjuncts = field(default_factory=Adjuncts)
    purpose: str = ""
    negated: bool = False
    passive: bool = False


def begin(reader: Reader) -> VerbPhrase | None:
    """Read a verb if one comes next, with what it does to another verb: ``stop pouring``."""
    cursor = reader.cursor
    start, manner = cursor.at, list[str]()
    adverbs = Adjuncts()
    while not reader.verb_ahead() and adjunct(cursor, adverbs):
        pass
    while (aspect := _aspect(reader)) is not None:
        manner += [aspect] if aspect else []
    at = cursor.at
    found = reader.verbs.lemmas(cursor.peek())
    if not found or cursor.done:
        cursor.at = start
        return None
    cursor.take()
    verbs = tuple(dict.fromkeys(verb for verb, _ in found))
    adverbs.manner[:0] = manner
    return VerbPhrase(verbs, at, frozenset(form for _, form in found), adjuncts=adverbs)


def _aspect(reader: Reader) -> str | None:
    cursor = reader.cursor
    start = cursor.at
    words = cursor.peek()
    forms = reader.verbs.lemmas(words)
    for lemma, _ in forms:
        for phrase, value in sorted(of_class("aspect").items(), key=lambda each: -len(each[0])):
            size = len(phrase)
            rest = tuple(cursor.peek(each) for each in range(1, size))
            if phrase[0] == lemma and phrase[1:] == rest:
                cursor.at = start + size
                wanted = Form.BASE if phrase[-1] == TO else Form.GERUND
                if wanted in reader.verb_forms():
                    return "" if value == " ".join(phrase) and phrase[-1] == TO else value
                cursor.at = start
    return None


def complete(reader: Reader, phrase: VerbPhrase) -> VerbPhrase:
    """Read what follows a verb, up to where another clause may begin."""
    reader.literals = frozenset(
        word
        for verb in phrase.verbs
        for way in reader.verbs.ways.get(verb, ())
        for word in way.particles
    )
    while not reader.cursor.done and _complement(reader, phrase):
        pass
    reader.literals = frozenset()
    if not phrase.objects and not phrase.places and not _stands_alone(reader, phrase):
        _share(reader, phrase)
    return phrase


def _stands_alone(reader: Reader, phrase: VerbPhrase) -> bool:
    """Whether one of its verbs is said without an object."""
    ways = [way for verb in phrase.verbs for way in reader.verbs.ways.get(verb, ())]
    said = {*phrase.particles, *phrase.adjuncts.manner}
    return any(not way.slots and way.particles <= said for way in ways)


def _share(reader: Reader, phrase: VerbPhrase) -> None:
    """Take over the object and the hand of the verbs that follow: ``turned and lowered it``."""
    cursor = reader.cursor
    start, known = cursor.at, (reader.thing, reader.several)
    if any([cursor.accept(","), cursor.accept("and"), cursor.accept("then")]):
        following = begin(reader)
        if following is not None:
            complete(reader, following)
            phrase.objects += following.objects[:1]
            phrase.places += [(word, noun) for word, noun in following.places if noun.limb]
            phrase.adjuncts.count = phrase.adjuncts.count or following.adjuncts.count
    cursor.at = start
    reader.thing, reader.several = known


def _complement(reader: Reader, phrase: VerbPhrase) -> bool:
    """Read one of the things that may follow a verb."""
    cursor = reader.cursor
    if _literal(reader, phrase):
        return True
    if _hand_without_noun(reader, phrase) or _named_place(reader, phrase):
        return True
    if adjunct(cursor, phrase.adjuncts):
        return True
    return (
        _particle(reader, phrase)
        or _purpose(reader, phrase)
        or _place(reader, phrase)
        or _object(reader, phrase)
    )


def _literal(reader: Reader, phrase: VerbPhrase) -> bool:
    """A word that belongs to the verb and is no particle: ``go``, ``a sip``."""
    cursor = reader.cursor
    ahead = 1 if cursor.peek() in ARTICLES else 0
    word = cursor.peek(ahead)
    particle = (word,) in of_class("particle") or (word,) in of_class("manner")
    if word not in reader.literals or particle or word in phrase.particles:
        return False
    cursor.at += ahead + 1
    phrase.particles.append(word)
    return True


def _named_place(reader: Reader, phrase: VerbPhrase) -> bool:
    """``there``, where a place was named before."""
    if reader.place and reader.cursor.peek() == "there":
        reader.cursor.take()
        phrase.places.append(("at", Noun((reader.place,), at=reader.cursor.at - 1)))
        return True
    return False


def _hand_without_noun(reader: Reader, phrase: VerbPhrase) -> bool:
    """A hand of a body where objects have their own names is read before adverbs are."""
    cursor = reader.cursor
    start = cursor.at
    if reader.words.nouns is None or cursor.peek() in CONNECTIVES:
        return False
    if cursor.longest(reader.words.nouns) is None:
        return False
    cursor.at = start
    return _object(reader, phrase)


def _particle(reader: Reader, phrase: VerbPhrase) -> bool:
    cursor = reader.cursor
    word = cursor.peek()
    if (word,) not in of_class("particle"):
        return False
    longer = cursor.at
    found = cursor.longest(prepositions())
    spoken = found is not None and cursor.at - longer > 1
    cursor.at = longer
    alone = not begins_noun(reader, 1) or is_next(cursor, "preposition", 1)
    own = not phrase.objects and word in reader.literals and word not in phrase.particles
    stranded = reader.gap and bool(phrase.objects) and (word,) in prepositions()
    if spoken or stranded or not (alone or own):
        return False
    cursor.take()
    phrase.particles.append(word)
    return True


def _purpose(reader: Reader, phrase: VerbPhrase) -> bool:
    """``to drink``, ``in order to drink``, ``for "Drink"``."""
    cursor = reader.cursor
    start = cursor.at
    if cursor.accept(FOR):
        if cursor.peek().startswith('"'):
            phrase.purpose = cursor.quoted()
            return True
        if begins_noun(reader) and cursor.peek() not in ARTICLES and reader.words.nouns is not None:
            raise cursor.error("a purpose after 'for' stands in quotation marks", ('"Drink"',))
        cursor.at = start
        return False
    if cursor.accept("in", "order") and cursor.peek() != TO:
        cursor.at = start
        return False
    if not cursor.accept(TO) or _is_goal(reader):
        cursor.at = start
        return False
    parts: list[str] = []
    while not cursor.done and cursor.peek() not in {WITH, ",", ".", "and", "then", "(", "while"}:
        word = cursor.take().text.lower()
        parts += [] if word in {"it", "them"} else [word]
    if not parts:
        raise cursor.error("a place or a purpose is missing after 'to'", ())
    phrase.purpose = name_of(" ".join(parts))
    return True


def _is_goal(reader: Reader) -> bool:
    """Whether a thing, a limb or a person stands after ``to``, and not a verb."""
    cursor = reader.cursor
    start = cursor.at
    for words in (reader.words.limbs, reader.words.nouns or {}, of_class("limb")):
        if cursor.longest(words) is not None:
            cursor.at = start
            return True
    classes = ("determiner", "pronoun", "person")
    agents = {each.lower() for each in reader.words.agents}
    return any(is_next(cursor, each) for each in classes) or cursor.peek() in agents


def _place(reader: Reader, phrase: VerbPhrase) -> bool:
    """A preposition with a noun phrase."""
    cursor = reader.cursor
    start = cursor.at
    preposition = cursor.longest(prepositions())
    if preposition is None:
        return False
    noun = noun_phrase(reader)
    if noun is None and reader.gap:
        phrase.places.append((preposition, Noun((GAP,), at=start)))
        reader.gap = False
        return True
    if noun is None:
        if cursor.done:
            raise cursor.error(f"no object after {preposition!r}", _names(reader))
        cursor.at = start
        return False
    preposition = WITH if preposition == "using" else preposition
    phrase.places.append((preposition, replace(noun, at=start)))
    _skip_relative_clause(reader)
    return True


def _names(reader: Reader) -> list[str]:
    return sorted(reader.words.objects or ()) or ["the name of an object"]


def _object(reader: Reader, phrase: VerbPhrase) -> bool:
    cursor = reader.cursor
    if cursor.peek() in CONNECTIVES or not begins_noun(reader) or len(phrase.objects) == 2:
        return False
    noun = noun_phrase(reader)
    if noun is None:
        return False
    phrase.objects.append(noun)
    phrase.adjuncts.window = around(phrase.adjuncts.window, noun.window)
    _skip_relative_clause(reader)
    return True


def _skip_relative_clause(reader: Reader) -> None:
    """``the mug (that) you want``: whose thing it is, no tracker tells."""
    cursor = reader.cursor
    start = cursor.at
    cursor.accept("that") or cursor.accept("which")
    verb = cursor.peek(1)
    subject = is_next(cursor, "person") and cursor.peek() not in RELATIVES
    if subject and any(
        lemma in {"want", "need", "like", "choose", "have"}
        for lemma, _ in reader.verbs.lemmas(verb)
    ):
        cursor.at += 2
    else:
        cursor.at = start
