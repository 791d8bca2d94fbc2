"""A verb with all that follows it, and which primitive that says of which objects."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from json import loads

from capar.model.par import Call
from kb.language.instruction import GAP, Circumstances, Instruction
from kb.language.noun_phrases import ARTICLES, Noun, noun_phrase
from kb.language.reader import CONNECTIVES, RELATIVES, Adjuncts, Reader, attempt
from kb.language.vocabulary import EE, OTHER, Way, of_class
from kb.lexicon.english import Form, name_of

ANY_VERB = "do"
GOALS = frozenset({"to", "onto", "on", "into"})
CONTACT_GOALS = frozenset({*GOALS, "in", "inside", "against", "on top of", "at"})
"""What may stand for each other before the place that an object is brought to."""

SOURCES = frozenset({"from", "off", "out of", "away from", "from under", "out from under"})
AFTER = ("with", "from", "to", "for")
"""What may follow a verb's objects: a hand, a source, a purpose."""

Place = tuple[str, Noun]
"""A preposition with what stands after it."""


@dataclass
class VerbPhrase:
    """A verb and what stands with it, before it is known which primitive it says."""

    verbs: tuple[str, ...]
    """The verbs that its form may be of."""

    at: int
    form: frozenset[Form] = frozenset()
    particles: list[str] = field(default_factory=list)
    objects: list[Noun] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)
    adjuncts: Adjuncts = field(default_factory=Adjuncts)
    purpose: str = ""
    negated: bool = False
    passive: bool = False


@attempt
def begin(reader: Reader) -> VerbPhrase | None:
    """Read a verb if one comes next, with what it does to another verb: ``stop pouring``."""
    manner = list[str]()
    adverbs = Adjuncts()
    while not reader.verb_ahead() and reader.adjunct(adverbs):
        pass
    while (aspect := _aspect(reader)) is not None:
        manner += [aspect] if aspect else []
    found = reader.words.lemmas(reader.peek())
    if not found:
        return None
    reader.take()
    verbs = tuple(dict.fromkeys(verb for verb, _ in found))
    adverbs.manner[:0] = manner
    return VerbPhrase(verbs, reader.at - 1, frozenset(form for _, form in found), adjuncts=adverbs)


def require(reader: Reader) -> VerbPhrase:
    """Read a verb.

    Raises:
        SentenceError: None comes next.
    """
    phrase = begin(reader)
    if phrase is None:
        raise reader.error(f"no verb {reader.peek()!r}", reader.words.beginnings)
    return phrase


@attempt
def _aspect(reader: Reader) -> str | None:
    start = reader.at
    for lemma, _ in reader.words.lemmas(reader.peek()):
        for phrase, value in sorted(of_class("aspect").items(), key=lambda each: -len(each[0])):
            rest = [reader.peek(each) for each in range(1, len(phrase))]
            if phrase == (lemma, *rest):
                reader.at = start + len(phrase)
                bare = phrase[-1] == "to"
                if (Form.BASE if bare else Form.GERUND) in reader.verb_forms():
                    return "" if bare and value == " ".join(phrase) else value
                reader.at = start
    return None


def complete(reader: Reader, phrase: VerbPhrase) -> VerbPhrase:
    """Read what follows a verb, up to where another clause may begin."""
    ways = [way for verb in phrase.verbs for way in reader.words.ways.get(verb, ())]
    reader.literals = frozenset(word for way in ways for word in way.particles)
    parts = (_literal, _hand, _there, _adjunct, _particle, _purpose, _place, _object)
    while not reader.done and any(read(reader, phrase) for read in parts):
        pass
    reader.literals = frozenset()
    said = {*phrase.particles, *phrase.adjuncts.manner}
    alone = any(not way.slots and way.particles <= said for way in ways)
    if not phrase.objects and not phrase.places and not alone:
        _share(reader, phrase)
    return phrase


def _share(reader: Reader, phrase: VerbPhrase) -> None:
    """Take over the object and the hand of the verbs that follow: ``turned and lowered it``."""
    start, known = reader.at, (reader.thing, reader.several)
    if reader.accept(", and then", ", and", ", then", ",", "and then", "and", "then"):
        following = begin(reader)
        if following is not None:
            complete(reader, following)
            phrase.objects += following.objects[:1]
            phrase.places += [(word, noun) for word, noun in following.places if noun.limb]
            phrase.adjuncts.count = phrase.adjuncts.count or following.adjuncts.count
    reader.at = start
    reader.thing, reader.several = known


def _literal(reader: Reader, phrase: VerbPhrase) -> bool:
    """A word that belongs to the verb and is no particle: ``go``, ``a sip``."""
    ahead = 1 if reader.peek() in ARTICLES else 0
    word = reader.peek(ahead)
    particle = (word,) in of_class("particle") or (word,) in of_class("manner")
    if word not in reader.literals or particle or word in phrase.particles:
        return False
    reader.at += ahead + 1
    phrase.particles.append(word)
    return True


def _there(reader: Reader, phrase: VerbPhrase) -> bool:
    """``there``, where a place was named before."""
    if not reader.place or not reader.accept("there"):
        return False
    phrase.places.append(("at", Noun((reader.place,), at=reader.at - 1)))
    return True


def _hand(reader: Reader, phrase: VerbPhrase) -> bool:
    """An object by its name, which is read before adverbs are."""
    names = reader.words.nouns or {}
    return reader.look(lambda r: r.longest(names)) is not None and _object(reader, phrase)


def _adjunct(reader: Reader, phrase: VerbPhrase) -> bool:
    return reader.adjunct(phrase.adjuncts)


def _particle(reader: Reader, phrase: VerbPhrase) -> bool:
    word = reader.peek()
    if (word,) not in of_class("particle"):
        return False
    spoken = reader.look(lambda r: (r.of("preposition"), r.at)[1]) > reader.at + 1
    alone = not reader.begins_noun(1) or reader.is_next("preposition", ahead=1)
    own = not phrase.objects and word in reader.literals and word not in phrase.particles
    stranded = reader.gap and bool(phrase.objects) and (word,) in of_class("preposition")
    if spoken or stranded or not (alone or own):
        return False
    phrase.particles.append(reader.take().lower())
    return True


@attempt
def _purpose(reader: Reader, phrase: VerbPhrase) -> bool:
    """``to drink``, ``in order to drink``, ``for "Drink"``."""
    if reader.accept("for"):
        if reader.peek().startswith('"'):
            phrase.purpose = quoted(reader)
            return True
        named = reader.words.nouns is not None and reader.peek() not in ARTICLES
        if named and reader.begins_noun():
            raise reader.error("a purpose after 'for' stands in quotation marks", ('"Drink"',))
        return False
    if not reader.accept("in order to", "to") or reader.look(_is_goal):
        return False
    parts: list[str] = []
    while not reader.done and reader.peek() not in {"with", ",", ".", "and", "then", "(", "while"}:
        word = reader.take().lower()
        parts += [] if word in {"it", "them"} else [word]
    if not parts:
        raise reader.error("a place or a purpose is missing after 'to'", ())
    phrase.purpose = name_of(" ".join(parts))
    return True


def quoted(reader: Reader) -> str:
    """Read a text in quotation marks."""
    try:
        return str(loads(reader.take()))
    except ValueError:
        raise reader.error("no text in quotation marks", (), at=reader.at - 1) from None


def _is_goal(reader: Reader) -> bool:
    """Whether an object, a limb or a person stands after ``to``, and not a verb."""
    return (
        reader.longest({**reader.words.limbs, **(reader.words.nouns or {})}) is not None
        or reader.is_next("limb", "determiner", "pronoun", "person")
        or reader.peek() in {each.lower() for each in reader.words.agents}
    )


@attempt
def _place(reader: Reader, phrase: VerbPhrase) -> bool:
    """A preposition with a noun phrase."""
    start = reader.at
    preposition = reader.of("preposition")
    if preposition is None:
        return False
    noun = noun_phrase(reader)
    if noun is None and reader.gap:
        noun, reader.gap = Noun((GAP,)), False
    elif noun is None:
        if reader.done:
            known = sorted(reader.words.objects or ()) or ["the name of an object"]
            raise reader.error(f"no object after {preposition!r}", known)
        return False
    preposition = "with" if preposition == "using" else preposition
    phrase.places.append((preposition, replace(noun, at=start)))
    _relative_clause(reader)
    return True


def _object(reader: Reader, phrase: VerbPhrase) -> bool:
    if reader.peek() in CONNECTIVES or not reader.begins_noun() or len(phrase.objects) == 2:
        return False
    noun = noun_phrase(reader)
    if noun is None:
        return False
    phrase.objects.append(noun)
    _relative_clause(reader)
    return True


@attempt
def _relative_clause(reader: Reader) -> bool:
    """Read past ``(that) you want``: no tracker says whose object it is."""
    reader.accept("that", "which")
    subject = reader.is_next("person") and reader.peek() not in RELATIVES
    verbs = {lemma for lemma, _ in reader.words.lemmas(reader.peek(1))}
    if not subject or not verbs & {"want", "need", "like", "choose", "have"}:
        return False
    reader.at += 2
    return True


@dataclass(frozen=True)
class _Match:
    way: Way
    objects: tuple[str, ...]
    others: tuple[str, ...]
    ee: str
    places: tuple[Place, ...]
    manner: tuple[str, ...]
    exact: int

    @property
    def order(self) -> tuple[int, int, int, int, int]:
        """The better match is the greater."""
        way = self.way
        return (len(way.particles), len(way.slots), self.exact, -len(self.places), -way.rank)


def matched(reader: Reader, phrase: VerbPhrase, *, agent: str = "", ee: str = "") -> Instruction:
    """The instruction that a verb with its complements gives; pronouns mean its object from here.

    A verb that no primitive has, or any, has its objects as they stand.

    Raises:
        SentenceError: The verb cannot be followed like this, or an object is not known.
    """
    places, own_ee, doer = _hands(reader, phrase)
    ee, agent = own_ee or ee, agent or doer
    ways = [way for verb in phrase.verbs for way in reader.words.ways.get(verb, ())]
    said = "" if ways else phrase.verbs[0]
    ways = ways or list(reader.words.related(said))
    matches = (_match(reader, phrase, places, way) for way in ways)
    best = max((each for each in matches if each), key=lambda each: each.order, default=None)
    known = True
    if best is not None:
        held = next((each for word, each in best.places if word == "in" and each.limb), None)
        rest = [each for each in best.places if each[1] is not held]
        ee = best.ee or ee or (held.limb if held is not None else "")
        action, objects, manner, others = best.way.action, best.objects, best.manner, best.others
    elif said or ANY_VERB in phrase.verbs:
        names = [name for each in phrase.objects for name in each.things if name]
        rest = list(places)
        if not names and rest and rest[0][1].things:
            names = list(rest.pop(0)[1].things)
        done = ANY_VERB in phrase.verbs
        said = "" if done else " ".join([phrase.verbs[0], *phrase.particles])
        known = done or bool(ways)
        action = "" if done else (ways[0].action if ways else name_of(said))
        objects, manner, others = tuple(names), tuple(phrase.adjuncts.manner), ()
    unknown = [noun for _, noun in (best.places if best else places) if noun.unknown]
    if best is None:
        unknown = [*(each for each in phrase.objects if each.unknown), *unknown]
    if unknown:
        raise _unknown(reader, unknown[0])
    if best is None and not said and ANY_VERB not in phrase.verbs:
        shown = {each.pattern for each in ways if "{x}" not in each.pattern}
        examples = [
            each.replace("{1}", "A").replace("{2}", "B").replace("{ee}", "the hand")
            for each in shown
        ]
        stray = next((each.at for each in phrase.objects[1:]), phrase.at)
        raise reader.error("the verb cannot be followed like this", examples, at=stray)
    source, rest = _source(rest)
    adjuncts = phrase.adjuncts
    circumstances = Circumstances(
        negated=phrase.negated,
        manner=tuple(dict.fromkeys(manner)),
        places=tuple((preposition, _name(noun)) for preposition, noun in rest),
        others=others,
        count=adjuncts.count,
        duration_s=adjuncts.duration_s,
        window=adjuncts.window,
    )
    call = Call(action, objects, phrase.purpose)
    return _noted(reader, Instruction(call, ee, agent, source, circumstances, said, known))


def _hands(reader: Reader, phrase: VerbPhrase) -> tuple[list[Place], str, str]:
    """The places that name no hand that acts and no performer; the hand; the performer."""
    rest, ee, agent = list[Place](), "", ""
    for preposition, noun in phrase.places:
        if noun.limb and (preposition == "with" or (preposition == "in" and not noun.things)):
            if ee:
                raise reader.error("said twice", (), at=noun.at)
            ee = noun.limb
        elif preposition == "by" and phrase.passive and not noun.is_thing:
            ee, agent = ee or noun.limb, noun.person
        else:
            rest.append((preposition, noun))
    return rest, ee, agent


def _match(reader: Reader, phrase: VerbPhrase, places: list[Place], way: Way) -> _Match | None:
    """What a way to say it binds; None if something is missing, or an object is left over."""
    words = [*phrase.adjuncts.manner, *phrase.particles]
    left = [*(("", each) for each in phrase.objects), *places]
    for word in way.particles:
        literal = next((each for each in left if not each[0] and each[1].things == (word,)), None)
        if word in words:
            words.remove(word)
        elif literal is not None:
            left.remove(literal)
        else:
            return None
    bound: dict[int, tuple[str, ...]] = {}
    others: tuple[str, ...] = ()
    ee, exact, changed = "", 0, list[Place]()
    transitive = any(not preposition for preposition, _ in way.slots)
    for preposition, number in way.slots:
        alike = CONTACT_GOALS if transitive and preposition in GOALS else {preposition}
        fitting = [
            (spoken, each)
            for spoken, each in left
            if spoken in alike and (each.limb or (number != EE and each.things))
        ]
        if not fitting:
            return None
        found = spoken, noun = min(fitting, key=lambda each: each[0] != preposition)
        left.remove(found)
        exact += spoken == preposition
        if number == EE:
            ee = noun.limb
        elif number == OTHER and (noun.unknown or reader.words.objects is None):
            others = noun.things
        elif noun.unknown:
            return None
        else:
            bound[max(number, 1)] = noun.things or (noun.limb,)
            exact -= bool(noun.limb)
            changed += [(spoken, noun)] if spoken != preposition else []
    people = [("to", each) for spoken, each in left if not spoken and each.is_person]
    given = (*(each for each in left if each[0]), *people, *changed)
    if len(given) - len(changed) < len(left) or len(people) > 1:
        return None
    numbers = range(1, max(bound, default=0) + 1)
    names = tuple(name for number in numbers for name in bound.get(number, ("",)))
    return _Match(way, names, others, ee, given, tuple(words), exact)


def _source(places: Sequence[Place]) -> tuple[str, list[Place]]:
    """What the object is taken from, and the places that are left."""
    for preposition, noun in places:
        if preposition in SOURCES and noun.things and not noun.part:
            rest = [each for each in places if each[1] is not noun]
            return noun.things[0], [
                *([] if preposition == "from" else [(preposition, noun)]),
                *rest,
            ]
    return "", list(places)


def _name(noun: Noun) -> str:
    name = noun.person or ", ".join(noun.things) or noun.limb or "someone"
    return f"{noun.part} of {name}" if noun.part else name


def _noted(reader: Reader, value: Instruction) -> Instruction:
    """The instruction; what it is about is what pronouns mean from here on."""
    objects = value.call.objects
    taken, hand = reader.taken
    free = not objects or not objects[0]
    manual = (value.call.action, 1) in reader.words.canonical and not value.said
    same_hand = not value.ee or not hand or value.ee == hand
    if free and manual and taken and taken not in objects and same_hand:
        objects = (taken, *objects[1:])
    value = replace(value, call=replace(value.call, objects=objects))
    named = [each for each in objects if each]
    places = [place for _, place in value.circumstances.places]
    if named and named[0] != GAP:
        reader.thing = named[0]
    elif places and not named:
        reader.thing = places[-1]
    if len(named) > 1 or places:
        reader.place = named[-1] if len(named) > 1 else places[-1]
    if named and not value.circumstances.negated and named[0] != GAP:
        reader.taken = named[0], value.ee
    reader.limb = value.ee or reader.limb
    return value


def _unknown(reader: Reader, noun: Noun) -> Exception:
    first = {each.lower().split("_")[0] for each in noun.things}
    words = range(noun.at, reader.at)
    at = next((each for each in words if reader.tokens[each].lower() in first), reader.at)
    known = {*(reader.words.objects or ()), *AFTER}
    return reader.error(f"no object {reader.tokens[at]!r}", known, at=at)


def performed(reader: Reader, agent: str) -> Instruction:
    """Read the name of an action and its objects.

    Raises:
        SentenceError: There is no name, or no object where one should stand.
    """
    if reader.done:
        known = {action for action, _ in reader.words.entries}
        raise reader.error("the name of an action is missing", known)
    name = quoted(reader) if reader.peek().startswith('"') else reader.take()
    objects: list[str] = []
    while reader.accept("and" if objects else "on"):
        at = reader.at
        noun = noun_phrase(reader, coordinate=False)
        if noun is None or noun.unknown or not (noun.things or noun.limb):
            raise reader.error("no object", sorted(reader.words.objects or ()), at=at)
        objects.append(noun.things[0] if noun.things else noun.limb)
    phrase = complete(reader, VerbPhrase((), reader.at))
    places, ee, _ = _hands(reader, phrase)
    source, rest = _source(places)
    for each in (*phrase.objects, *(noun for _, noun in rest)):
        raise reader.error("nothing is known that could begin here", AFTER, at=each.at)
    return Instruction(Call(name, tuple(objects), phrase.purpose), ee, agent, source)
