"""Verbs: what is known of one, which fit a segment, and the facts of the lexical rules."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TypeAlias

from capar.model.errors import UnknownNameError
from capar.model.par import FeatureSet
from kb.lexicon.english import words_of
from kb.lexicon.links import (
    LevinClass,
    PrimitiveWords,
    ThesisClaim,
    book_order,
    class_links,
    levin_classes,
    motion_classes,
    motion_senses,
    own_links,
    sense_key,
    sense_links,
    thesis_claims,
)
from kb.lexicon.links import levin_classes as known_classes
from kb.lexicon.verbnet import Frame, Predicate, VerbClass
from kb.lexicon.wordnet import Sense, Synset, table, wordnet
from kb.store.sparql import stored
from kb.store.stores import Store


@dataclass(frozen=True, slots=True, order=True)
class Seen:
    """Segments of one observation that have one name and one purpose."""

    primitive: str
    """The most specific name of the segments."""

    observation: str
    count: int
    purpose: str = ""
    """What the user stated that they were for; empty where it only follows from what came next."""


@dataclass(frozen=True, slots=True, order=True)
class Case:
    """A shipped test case that shows a primitive."""

    primitive: str
    name: str


def seen_in(store: Store) -> tuple[Seen, ...]:
    """What every stored observation shows; segments that no rule names have an empty name."""
    rows = store.ask(stored("seen")).plain()
    return tuple(
        sorted(
            Seen(
                str(row["name"] or ""),
                str(row["observation"]),
                int(row["count"] or 0),
                str(row["purpose"] or ""),
            )
            for row in rows
            if row["observation"] is not None
        )
    )


def summed(seen: Iterable[Seen]) -> tuple[Seen, ...]:
    """The same with one count for each primitive and observation, whatever it was done for."""
    counts = Counter[tuple[str, str]]()
    for use in seen:
        counts[use.primitive, use.observation] += use.count
    return tuple(sorted(Seen(*key, count) for key, count in counts.items()))


def often(count: int) -> str:
    """How often, in figures from three on: ``once``, ``twice``, ``32 times``."""
    return {1: "once", 2: "twice"}.get(count, f"{count} times")


def total(seen: Iterable[Seen]) -> int:
    """The number of segments."""
    return sum(each.count for each in seen)


MOST = 5
"""How many names near a wrong one are listed."""


def doubts(verb: str, levin_classes: Sequence[str], senses: Sequence[str]) -> tuple[str, ...]:
    """What is stated of a verb and not known here, in a clause each, with what is near it.

    Args:
        verb: As people write it; may be empty.
        levin_classes: Numbers of Levin's classes.
        senses: Numbers of the verb's senses in WordNet 3.1, or sense keys.
    """
    return tuple(_doubts(verb, levin_classes, senses))


def doubts_of(words: Iterable[PrimitiveWords]) -> tuple[str, ...]:
    """The doubts about what the rule files of primitives state, each with file and primitive."""
    return tuple(
        f"{each.file}: {each.name}: {doubt}"
        for each in words
        for index, verb in enumerate(each.verbs or ("",))
        for doubt in (doubts(verb, (), ()) if index else doubts(verb, each.levin, each.senses))
    )


def nearest_verbs(verb: str) -> tuple[str, ...]:
    """The verbs of WordNet that are written most like one that it lacks."""
    word = verb.strip().lower().replace(" ", "_")
    close = get_close_matches(word, wordnet().lemmas, n=MOST)
    return tuple(each.replace("_", " ") for each in close)


def the_nearest(names: Sequence[str]) -> str:
    """A clause that goes on from a name that there is not, with those near it."""
    if not names:
        return ", nor one near it"
    return f"; the nearest {'are' if len(names) > 1 else 'is'} {', '.join(names)}"


def _doubts(verb: str, classes: Sequence[str], senses: Sequence[str]) -> Iterator[str]:
    known = wordnet().of_lemma(verb)
    if verb and not known:
        yield f"WordNet has no verb {verb!r}{the_nearest(nearest_verbs(verb))}"
    for number in classes:
        if number not in known_classes():
            close = get_close_matches(number, known_classes(), n=MOST)
            yield f"Levin has no class {number!r}{the_nearest(close)}"
    for each in senses:
        if sense_key(verb, each) in wordnet():
            continue
        if each.isdigit():
            has = f"; it has 1 to {len(known)}" if known else ""
            yield f"WordNet has no sense {each} of {verb!r}{has}"
        else:
            close = get_close_matches(each, [sense.key for sense, _ in known], n=MOST)
            yield f"WordNet has no verb sense {each!r}{the_nearest(close)}"


@dataclass(frozen=True, slots=True)
class SenseOfVerb:
    """A sense, and whether it is the one in which we take the verb."""

    sense: Sense
    synset: Synset
    motion: bool


@dataclass(frozen=True, slots=True)
class ClassOfVerb:
    """A class of the verb, with the roles that it gives and one frame as an example."""

    levin: LevinClass | None
    verbnet: str
    """VerbNet's class, or empty where no VerbNet was imported."""

    roles: tuple[str, ...]
    frame: Frame | None


@dataclass(frozen=True, slots=True)
class Standing:
    """How the rule base stands to a verb, as the lexical rules derive it."""

    represented_by: tuple[str, ...] = ()
    """Primitives whose verb it is, or means the same."""

    general_only: tuple[str, ...] = ()
    """The nearest primitives that it is a kind of."""

    @property
    def words(self) -> str:
        """The standing in a sentence."""
        if self.represented_by:
            return f"represented by {', '.join(self.represented_by)}"
        if self.general_only:
            general = ", ".join(self.general_only)
            return f"not represented; only what is more general is: {general}"
        return "not represented: no primitive has the verb, or one that it is a kind of"


@dataclass(frozen=True, slots=True)
class Neighbour:
    """A verb near by in WordNet's hierarchy."""

    relation: str
    """``is a kind of``, ``has the kind`` or ``beside``."""

    verbs: tuple[str, ...]
    definition: str
    primitives: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class VerbAnswer:
    """Everything that is known of a verb."""

    verb: str
    senses: tuple[SenseOfVerb, ...]
    classes: tuple[ClassOfVerb, ...]
    claims: tuple[ThesisClaim, ...]
    standing: Standing
    neighbours: tuple[Neighbour, ...]
    seen: tuple[Seen, ...]
    """What observations show of the primitives that represent it."""

    general_seen: tuple[Seen, ...] = ()
    """What they show of the nearest that it is a kind of; this shows nothing of the verb."""


class UnknownVerbError(UnknownNameError):
    """A verb that there is not; its message lists only the nearest known ones."""

    def __init__(self, verb: str) -> None:
        near = nearest_verbs(verb)
        super().__init__("verb", verb, near)
        self.args = (f"no verb {verb!r} is known{the_nearest(near)}.",)


def about(
    verb: str,
    *,
    standing: Standing,
    keys_of: Mapping[str, Sequence[str]],
    verbnet: Sequence[VerbClass] = (),
    seen: Iterable[Seen] = (),
) -> VerbAnswer:
    """What is known of a verb.

    Args:
        verb: As people write it: ``pick up``.
        standing: How the rule base stands to it.
        keys_of: Sense keys of each primitive.
        verbnet: VerbNet's classes of the verb and those that they refine.
        seen: What observations show.

    Raises:
        UnknownVerbError: WordNet has no such verb, and no primitive uses it.
    """
    word = " ".join(verb.lower().replace("_", " ").split())
    found = wordnet().of_lemma(word)
    if not found and not standing.represented_by:
        raise UnknownVerbError(verb)
    keys = motion_senses(word)
    shown = sorted(seen)
    return VerbAnswer(
        verb=word,
        senses=tuple(SenseOfVerb(sense, synset, sense.key in keys) for sense, synset in found),
        classes=_classes(word, verbnet),
        claims=tuple(each for each in thesis_claims() if word in each.verbs),
        standing=standing,
        neighbours=_neighbours(keys, keys_of),
        seen=tuple(each for each in shown if each.primitive in standing.represented_by),
        general_seen=tuple(each for each in shown if each.primitive in standing.general_only),
    )


def _classes(verb: str, verbnet: Sequence[VerbClass]) -> tuple[ClassOfVerb, ...]:
    by_name = {each.id: each for each in verbnet}
    lemma = verb.replace(" ", "_")
    found = [
        _verbnet_class(each, by_name)
        for each in verbnet
        if any(member.lemma == lemma for member in each.members)
    ]
    known = {each.levin.number for each in found if each.levin}
    extra = sorted(set(motion_classes(verb)) - known, key=book_order)
    return (*found, *(ClassOfVerb(levin_classes()[each], "", (), None) for each in extra))


def _verbnet_class(each: VerbClass, by_name: Mapping[str, VerbClass]) -> ClassOfVerb:
    """A class with the roles and frames that it inherits."""
    line = [each]
    while line[-1].parent in by_name:
        line.append(by_name[line[-1].parent])
    roles: dict[str, None] = {}
    for one in reversed(line):
        roles.update(dict.fromkeys(role.name for role in one.roles))
    frames = [frame for one in line for frame in one.frames]
    levin = levin_classes().get(each.levin)
    return ClassOfVerb(levin, each.id, tuple(roles), frames[0] if frames else None)


def _neighbours(keys: Sequence[str], keys_of: Mapping[str, Sequence[str]]) -> tuple[Neighbour, ...]:
    """What stands one step up and one step down from the verb's senses as a motion."""
    found: list[Neighbour] = []
    for key in keys:
        synset = wordnet().of_key(key)
        steps = wordnet().steps_above(synset)
        up = [each for each, step in steps.items() if step == 1]
        found += [_neighbour("is a kind of", each, keys_of) for each in up]
        down = wordnet().directly_below(synset)
        found += [_neighbour("has the kind", each, keys_of) for each in down]
    with_primitive = [each for each in found if each.primitives or each.relation == "is a kind of"]
    others = [each for each in found if each not in with_primitive]
    return tuple(dict.fromkeys([*with_primitive, *others[: max(0, 6 - len(with_primitive))]]))


def _neighbour(relation: str, synset: Synset, keys_of: Mapping[str, Sequence[str]]) -> Neighbour:
    primitives = sorted(
        name
        for name, keys in keys_of.items()
        if any(wordnet().of_key(key) == synset for key in keys)
    )
    return Neighbour(relation, synset.lemmas, synset.definition, tuple(primitives))


def kinds(verb: str, keys_of: Mapping[str, Sequence[str]]) -> tuple[str, ...]:
    """Primitives whose verb is the verb, or a kind of it: "every kind of move".

    Raises:
        UnknownVerbError: WordNet has no such verb.
    """
    if not wordnet().of_lemma(verb):
        raise UnknownVerbError(verb)
    tops = [wordnet().of_key(key) for key in motion_senses(verb)]
    return tuple(
        sorted(name for name, keys in keys_of.items() if any(_is_kind(key, tops) for key in keys))
    )


def _is_kind(key: str, tops: Sequence[Synset]) -> bool:
    synset = wordnet().of_key(key)
    return synset in tops or any(each in tops for each in wordnet().what_it_is(synset))


def keys_of_primitives(words: Iterable[PrimitiveWords]) -> dict[str, tuple[str, ...]]:
    """The sense keys of each primitive that WordNet 3.1 has, as we claim them."""
    return {
        word.name: tuple(link.key for link in sense_links(word) if link.key in wordnet())
        for word in words
    }


DOERS = frozenset({"Agent", "Instrument", "Co-Agent"})
"""Roles that the end-effector, or what it holds, fills."""

MOTIONS = frozenset({"motion", "rotational_motion", "elliptical_motion"})


@dataclass(frozen=True, slots=True, order=True)
class SegmentFeatures:
    """A segment as this needs it."""

    name: str
    general: tuple[str, ...]
    features: FeatureSet


@dataclass(frozen=True, slots=True)
class Fit:
    """A verb for a segment."""

    verb: str
    score: float
    """1 if nothing speaks against it; the verb of the rule that named the segment is before all."""

    reasons: tuple[str, ...]
    against: tuple[str, ...]
    source: str
    """The primitive or the class of VerbNet that the verb is from."""


_Demand: TypeAlias = tuple[bool, str]
"""Whether a segment meets what a frame's predicate says, and that in words."""


def fitting(
    seen: SegmentFeatures, words: Sequence[PrimitiveWords], classes: Iterable[VerbClass] = ()
) -> tuple[Fit, ...]:
    """Verbs that fit a segment, best first; each verb once, with its best class."""
    named = {each.name: each for each in words}
    found = list(_by_rules(seen, named))
    linked = _linked_classes(seen, named)
    for verb_class in classes:
        found += _by_class(seen, verb_class, linked)
    best: dict[str, Fit] = {}
    for fit in sorted(found, key=lambda each: (-each.score, each.verb, each.source)):
        best.setdefault(fit.verb, fit)
    return tuple(best.values())


def _by_rules(seen: SegmentFeatures, named: Mapping[str, PrimitiveWords]) -> Iterable[Fit]:
    """The verbs of the rule that named the segment, of their synonyms, and of what is above."""
    for steps, name in enumerate((seen.name, *seen.general)):
        if name not in named:
            continue
        for verb in named[name].verbs:
            reason = "the rule that named it" if not steps else f"what {seen.name} specialises"
            yield Fit(verb, 3.0 - 0.1 * steps, (f"{name}: {reason}",), (), name)
            for key in motion_senses(verb):
                synset = wordnet().of_key(key)
                for other in synset.lemmas:
                    same = f"means the same as {verb}: {synset.definition}"
                    yield Fit(other, 2.5 - 0.1 * steps, (same,), (), name)


def _linked_classes(seen: SegmentFeatures, named: Mapping[str, PrimitiveWords]) -> set[str]:
    """Levin classes of the primitive that named the segment, and of those above it."""
    return {
        number
        for name in (seen.name, *seen.general)
        if name in named
        for number in class_links(named[name])[0]
    }


def _by_class(seen: SegmentFeatures, each: VerbClass, linked: set[str]) -> Iterable[Fit]:
    """The members of a class by that of its frames that fits best."""
    judged = [(_demands(frame, seen.features), frame) for frame in each.frames]
    judged = [(demands, frame) for demands, frame in judged if demands]
    if not judged:
        return
    demands, frame = max(judged, key=lambda pair: (_share(pair[0]), len(pair[0])))
    bonus = 0.5 if each.levin in linked else 0.0
    score = _share(demands) + bonus + min(len(demands), 4) / 20
    reasons, against = (
        tuple(dict.fromkeys(words for met, words in demands if met is wanted))
        for wanted in (True, False)
    )
    for member in each.members:
        verb = member.lemma.replace("_", " ")
        yield Fit(verb, score, reasons, against, f"{each.id}: {frame.pattern}")


def _share(demands: Sequence[_Demand]) -> float:
    return sum(met for met, _ in demands) / len(demands)


def _demands(frame: Frame, features: FeatureSet) -> list[_Demand]:
    """What a frame's predicates say of a contact, a motion, a force and a goal."""
    events = list(dict.fromkeys(each.event for each in frame.semantics if each.event))
    found = []
    for each in frame.semantics:
        before = bool(events) and each.event == events[0] and each.event != events[-1]
        if demand := _demand(each, features, before=before):
            found.append(demand)
    return found


def _demand(predicate: Predicate, features: FeatureSet, *, before: bool) -> _Demand | None:
    roles = {each.lstrip("?") for each in predicate.arguments}
    moves = "1" in features.change_loc
    if predicate.name == "contact" and roles & DOERS:
        touches = (features.rel_start if before else features.rel_end)[:1] == "1"
        no, when = "" if predicate.holds else "no ", "before" if before else "after"
        return touches == predicate.holds, f"{predicate} wants {no}contact {when}"
    if predicate.name in MOTIONS and "Theme" in roles:
        return moves, f"{predicate} wants the object to move"
    if predicate.name in MOTIONS and "Agent" in roles:
        return not moves, f"{predicate} wants only the agent to move"
    if predicate.name == "has_location" and "Destination" in roles and predicate.holds:
        met = features.count > 1 and features.rel_end.endswith("1")
        return met, f"{predicate} wants the object at a place afterwards"
    if predicate.name == "exert_force" or "forceful" in roles:
        return "1" in features.force, f"{predicate} wants a force"
    return None


Members = Mapping[str, frozenset[str]]
"""Verbs by the Levin class that lists them."""


def lexical_facts(
    words: Sequence[PrimitiveWords],
    *,
    members: Members,
    rules: Iterable[str] = (),
    seen: Iterable[Seen] = (),
    cases: Iterable[Case] = (),
    verbs: Iterable[str] = (),
    classes: bool = True,
) -> str:
    """A program of facts, one a line, sorted.

    Args:
        words: The primitives' words.
        members: What an imported VerbNet lists; may be empty.
        rules: Stems of the rule base's files.
        seen: What was observed.
        cases: What shipped cases show.
        verbs: Further verbs that are asked about.
        classes: Whether classes and their members are stated; else only those verbs are.
    """
    asked = set(verbs) | (_every_verb(words, members) if classes else set())
    lines = {
        *_primitives(words),
        *(_class_facts() if classes else ()),
        *(_members(members) if classes else ()),
        *_senses(words, asked),
        *(_fact("rule", rule) for rule in rules),
        *(_fact("observed", each.primitive, each.observation) for each in seen if each.primitive),
        *(
            _fact("done_to", words_of(each.purpose), each.primitive, each.observation)
            for each in seen
            if each.purpose and each.primitive
        ),
        *(_fact("tested", case.primitive, case.name) for case in cases),
    }
    return "\n".join(sorted(lines)) + "\n"


def _primitives(words: Sequence[PrimitiveWords]) -> Iterator[str]:
    for word in words:
        yield _fact("primitive", word.name)
        yield from (_fact("specialises", word.name, general) for general in word.general)
        yield from (_fact("verb", word.name, verb) for verb in word.verbs)
        own = own_links(word.name)
        classes = word.levin or (own[1] or ("",) if own else ())
        yield from (_fact("levin", word.name, number) for number in classes)


def _fact(predicate: str, *arguments: str) -> str:
    return f"{predicate}({', '.join(map(_text, arguments))})."


def _text(value: str) -> str:
    """A text of the rules, in which only these three signs are written otherwise."""
    escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def _class_facts() -> Iterator[str]:
    for levin in levin_classes().values():
        yield _fact("class", levin.number)
        if levin.broader:
            yield _fact("within", levin.number, levin.broader)


def _members(members: Members) -> Iterator[str]:
    for number, verb in named_members():
        yield _fact("named_member", number, verb)
    for number, verbs in members.items():
        yield from (_fact("known_member", number, verb) for verb in verbs)
    for row in table("motion_classes"):
        yield _fact("motion_class", row["verb"], row["class"])
    for row in table("needs"):
        yield _fact("needs", row["class"], row["verb"], row["need"], row["rule"])


def named_members() -> list[tuple[str, str]]:
    """Classes and verbs that the thesis names; "touch with" is the verb "touch"."""
    pairs = {
        (claim.levin, verb.removesuffix(" with"))
        for claim in thesis_claims()
        if claim.levin
        for verb in claim.verbs
    }
    return sorted(pairs)


def _every_verb(words: Sequence[PrimitiveWords], members: Members) -> set[str]:
    named = {verb for _, verb in named_members()}
    own = {verb for each in words for verb in each.verbs}
    return named | own | {verb for verbs in members.values() for verb in verbs}


def _senses(words: Sequence[PrimitiveWords], verbs: set[str]) -> Iterator[str]:
    """Which of the verbs mean the same as a primitive's verb, or a kind of it, as motions."""
    for word in words:
        for link in sense_links(word):
            if link.key not in wordnet():
                continue
            synset = wordnet().of_key(link.key)
            for lemma in synset.lemmas:
                if lemma in verbs and lemma != link.verb:
                    yield _fact("same_sense", word.name, lemma)
            for other in verbs:
                steps = _steps_to(synset, other)
                if steps:
                    yield f"kind_of({_text(word.name)}, {_text(other)}, {steps})."


def _steps_to(synset: Synset, verb: str) -> int:
    """How many steps above the verb's nearest sense as a motion a synset stands; zero if none."""
    found = (
        wordnet().steps_above(wordnet().of_key(key)).get(synset, 0) for key in motion_senses(verb)
    )
    return min((each for each in found if each), default=0)


def verbnet_members(classes: Iterable[VerbClass]) -> dict[str, frozenset[str]]:
    """The verbs of each Levin class by the members of VerbNet's classes of it."""
    found: dict[str, set[str]] = {}
    by_name = {name: each.number for each in levin_classes().values() for name in each.verbnet}
    for verb_class in classes:
        number = by_name.get(_top(verb_class.id), verb_class.levin)
        if number in levin_classes():
            verbs = {member.lemma.replace("_", " ") for member in verb_class.members}
            found.setdefault(number, set()).update(verbs)
    return {number: frozenset(verbs) for number, verbs in found.items()}


def _top(name: str) -> str:
    """The name of the class that a subclass belongs to: ``touch-20`` of ``touch-20-1``."""
    return "-".join(name.split("-")[:2])
