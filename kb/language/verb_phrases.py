"""A verb with all that follows it, and which primitive that says of which objects."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from capar.model.par import Call
from kb.language.cursor import ARTICLES
from kb.language.instruction import GAP, Circumstances, Instruction
from kb.language.noun_phrases import (
    CONNECTIVES,
    RELATIVES,
    Adjuncts,
    Noun,
    Reader,
    adjunct,
    around,
    begins_noun,
    noun_phrase,
)
from kb.language.vocabulary import EE, OTHER, Way, is_next, of_class, prepositions
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


ANY_VERB = "do"
GOALS = frozenset({"to", "onto", "on", "into"})
CONTACT_GOALS = frozenset({*GOALS, "in", "inside", "against", "on top of", "at"})
"""What may stand for each other before the place that a thing is brought to."""

SOURCES = frozenset({"from", "off", "out of", "away from", "from under", "out from under"})
AFTER = (WITH, "from", TO, FOR)
"""What may follow a verb's objects: a hand, a source, a purpose."""


@dataclass(frozen=True)
class _Match:
    way: Way
    objects: tuple[str, ...]
    others: tuple[str, ...]
    ee: str
    places: tuple[tuple[str, Noun], ...]
    manner: tuple[str, ...]
    exact: int

    @property
    def order(self) -> tuple[int, int, int, int, int]:
        """The better match is the greater."""
        way = self.way
        return (len(way.particles), len(way.slots), self.exact, -len(self.places), -way.rank)


def matched(reader: Reader, phrase: VerbPhrase, *, agent: str = "", ee: str = "") -> Instruction:
    """The instruction that a verb with its complements gives.

    Raises:
        SentenceError: The verb cannot be followed like this, or an object is not known.
    """
    places, own_ee, doer = _hands(reader, phrase)
    ee, agent = own_ee or ee, agent or doer
    ways = [way for verb in phrase.verbs for way in reader.verbs.ways.get(verb, ())]
    said = "" if ways else phrase.verbs[0]
    ways = ways or list(reader.verbs.related(said))
    best = max(_matches(reader, phrase, places, ways), key=lambda each: each.order, default=None)
    if best is None and (said or ANY_VERB in phrase.verbs):
        return _bare(reader, phrase, places, agent, ee, ways)
    if best is None:
        raise _refusal(reader, phrase, places, ways)
    _check_known(reader, best.places)
    held = next((each for word, each in best.places if word == "in" and each.limb), None)
    kept = [each for each in best.places if each[1] is not held]
    ee = ee or (held.limb if held is not None else "")
    source, rest = _source(kept)
    call = Call(best.way.action, best.objects, phrase.purpose)
    told = _circumstances(phrase, best.manner, rest, best.others)
    return _noted(reader, Instruction(call, best.ee or ee, agent, source, told, said))


def _hands(reader: Reader, phrase: VerbPhrase) -> tuple[list[tuple[str, Noun]], str, str]:
    """The places that name no hand that acts and no performer; the hand; the performer."""
    rest, ee, agent = list[tuple[str, Noun]](), "", ""
    for preposition, noun in phrase.places:
        if noun.limb and not (noun.things and preposition != WITH) and preposition in {WITH, "in"}:
            if ee:
                raise reader.cursor.error("said twice", (), at=noun.at)
            ee = noun.limb
        elif preposition == "by" and phrase.passive and (noun.is_person or noun.limb):
            ee, agent = ee or noun.limb, noun.person
        else:
            rest.append((preposition, noun))
    return rest, ee, agent


def hands_and_source(reader: Reader, phrase: VerbPhrase) -> tuple[str, str]:
    """The end-effector and the source that stand beside an action.

    Raises:
        SentenceError: Something else stands there.
    """
    places, ee, _ = _hands(reader, phrase)
    source, rest = _source(places)
    for at in (*(each.at for each in phrase.objects), *(each.at for _, each in rest)):
        raise reader.cursor.error("nothing is known that could begin here", AFTER, at=at)
    return ee, source


def _matches(
    reader: Reader, phrase: VerbPhrase, places: Sequence[tuple[str, Noun]], ways: Sequence[Way]
) -> Iterator[_Match]:
    for way in ways:
        found = _match(reader, phrase, list(places), way)
        if found is not None:
            yield found


def _match(
    reader: Reader, phrase: VerbPhrase, places: list[tuple[str, Noun]], way: Way
) -> _Match | None:
    """What a way to say it binds; None if something is missing, or an object is left over."""
    objects, manner = list(phrase.objects), list(phrase.adjuncts.manner)
    particles = list(phrase.particles)
    for word in way.particles:
        literal = next((each for each in objects if each.things == (word,)), None)
        if word in particles:
            particles.remove(word)
        elif word in manner:
            manner.remove(word)
        elif literal is not None:
            objects.remove(literal)
        else:
            return None
    bound: dict[int, tuple[str, ...]] = {}
    others: tuple[str, ...] = ()
    ee, exact, changed = "", 0, list[tuple[str, Noun]]()
    transitive = any(not preposition for preposition, _ in way.slots)
    for preposition, number in way.slots:
        found = _take(objects, places, preposition, number, goal=transitive)
        if found is None:
            return None
        spoken, noun = found
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
    people = [each for each in objects if each.is_person]
    if len(people) < len(objects) or len(people) > 1:
        return None
    given = [*places, *((TO, each) for each in people), *changed]
    return _Match(way, _in_order(bound), others, ee, tuple(given), (*manner, *particles), exact)


def _take(
    objects: list[Noun],
    places: list[tuple[str, Noun]],
    preposition: str,
    number: int,
    *,
    goal: bool,
) -> tuple[str, Noun] | None:
    """The first noun phrase that a slot takes, removed from those that are left."""
    fits = (lambda each: bool(each.limb)) if number == EE else _is_thing
    if not preposition:
        noun = next((each for each in objects if fits(each)), None)
        if noun is None:
            return None
        objects.remove(noun)
        return "", noun
    alike = CONTACT_GOALS if goal and preposition in GOALS else frozenset({preposition})
    choices = [each for each in places if each[0] in {preposition, *alike} and fits(each[1])]
    choices.sort(key=lambda each: each[0] != preposition)
    if not choices:
        return None
    places.remove(choices[0])
    return choices[0]


def _is_thing(noun: Noun) -> bool:
    return bool(noun.things) or (bool(noun.limb) and not noun.is_person)


def _in_order(bound: dict[int, tuple[str, ...]]) -> tuple[str, ...]:
    """Objects by number; one that is not named between others is empty."""
    if not bound:
        return ()
    return tuple(name for number in range(1, max(bound) + 1) for name in bound.get(number, ("",)))


def _source(places: Sequence[tuple[str, Noun]]) -> tuple[str, list[tuple[str, Noun]]]:
    """What the thing is taken from, and the places that are left."""
    for index, (preposition, noun) in enumerate(places):
        if preposition in SOURCES and noun.things and not noun.part:
            rest = [each for each in places if each is not places[index]]
            plain = preposition == "from"
            return noun.things[0], rest if plain else [(preposition, noun), *rest]
    return "", list(places)


def _circumstances(
    phrase: VerbPhrase,
    manner: Sequence[str],
    places: Sequence[tuple[str, Noun]],
    others: Sequence[str],
) -> Circumstances:
    said = phrase.adjuncts
    return Circumstances(
        negated=phrase.negated,
        manner=tuple(dict.fromkeys(manner)),
        places=tuple((preposition, _name(noun)) for preposition, noun in places),
        others=tuple(others),
        count=said.count,
        duration_s=said.duration_s,
        window=said.window,
    )


def _name(noun: Noun) -> str:
    name = noun.person or ", ".join(noun.things) or noun.limb or "someone"
    return f"{noun.part} of {name}" if noun.part else name


def _bare(
    reader: Reader,
    phrase: VerbPhrase,
    places: Sequence[tuple[str, Noun]],
    agent: str,
    ee: str,
    ways: Sequence[Way],
) -> Instruction:
    """A verb that no primitive has, or any: its objects as they stand."""
    _check_known(reader, [*places, *(("", each) for each in phrase.objects)])
    things = [name for each in phrase.objects for name in each.things if name]
    rest = list(places)
    if not things and rest and rest[0][1].things:
        things = list(rest.pop(0)[1].things)
    done = ANY_VERB in phrase.verbs
    said = "" if done else " ".join([phrase.verbs[0], *phrase.particles])
    action = "" if done else (ways[0].action if ways else name_of(said))
    source, rest = _source(rest)
    told = _circumstances(phrase, phrase.adjuncts.manner, rest, ())
    call = Call(action, tuple(things), phrase.purpose)
    return _noted(reader, Instruction(call, ee, agent, source, told, said, done or bool(ways)))


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


def _check_known(reader: Reader, places: Sequence[tuple[str, Noun]]) -> None:
    for _, noun in places:
        if noun.unknown:
            raise _unknown(reader, noun)


def _unknown(reader: Reader, noun: Noun) -> Exception:
    cursor = reader.cursor
    start = cursor.at
    cursor.at = noun.at
    while (
        cursor.peek() not in {each.lower().split("_")[0] for each in noun.things}
        and cursor.at < start
    ):
        cursor.at += 1
    at, cursor.at = cursor.at, start
    word = cursor.tokens[at].text
    return cursor.error(f"no object {word!r}", {*(reader.words.objects or ()), *AFTER}, at=at)


def _refusal(
    reader: Reader, phrase: VerbPhrase, places: Sequence[tuple[str, Noun]], ways: Sequence[Way]
) -> Exception:
    """Why nothing fits: an object that is not known, or a verb that is followed otherwise."""
    for noun in (*phrase.objects, *(each for _, each in places)):
        if noun.unknown:
            return _unknown(reader, noun)
    shown = {each.pattern for each in ways if "{x}" not in each.pattern}
    patterns = [each.replace("{1}", "A").replace("{2}", "B") for each in shown]
    patterns = [each.replace("{ee}", "the hand") for each in patterns]
    stray = next((each.at for each in phrase.objects[1:]), phrase.at)
    return reader.cursor.error("the verb cannot be followed like this", patterns, at=stray)


def performed(reader: Reader, agent: str) -> Instruction:
    """Read the name of an action and its objects.

    Raises:
        SentenceError: There is no name, or no object where one should stand.
    """
    cursor = reader.cursor
    if cursor.done:
        known = {each.action for each in reader.words.entries}
        raise cursor.error("the name of an action is missing", known)
    name = cursor.quoted() if cursor.peek().startswith('"') else cursor.take().text
    objects: list[str] = []
    while cursor.accept("and") if objects else cursor.accept("on"):
        at = cursor.at
        noun = noun_phrase(reader, coordinate=False)
        if noun is None or noun.unknown or not (noun.things or noun.limb):
            raise cursor.error("no object", sorted(reader.words.objects or ()), at=at)
        objects.append(noun.things[0] if noun.things else noun.limb)
    phrase = complete(reader, VerbPhrase((), cursor.at))
    ee, source = hands_and_source(reader, phrase)
    return Instruction(Call(name, tuple(objects), phrase.purpose), ee, agent, source)
