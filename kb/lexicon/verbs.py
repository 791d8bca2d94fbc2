"""Verbs: what is known of one, which fit a segment, and the facts of the lexical rules."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

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


def _near(word: str, known: Iterable[str]) -> str:
    """A clause that goes on from a name that there is not, with the five nearest ones."""
    near = [each.replace("_", " ") for each in get_close_matches(word, list(known), n=5)]
    if not near:
        return ", nor one near it"
    return f"; the nearest {'are' if len(near) > 1 else 'is'} {', '.join(near)}"


def _near_verbs(verb: str) -> str:
    return _near(verb.strip().lower().replace(" ", "_"), wordnet().lemmas)


def doubts(verb: str, levin: Sequence[str], senses: Sequence[str]) -> tuple[str, ...]:
    """What is stated of a verb and not known here, in a clause each, with what is near it.

    Args:
        verb: As people write it; may be empty.
        levin: Numbers of Levin's classes.
        senses: Numbers of the verb's senses in WordNet 3.1, or sense keys.
    """
    found = []
    known = wordnet().of_lemma(verb)
    if verb and not known:
        found.append(f"WordNet has no verb {verb!r}{_near_verbs(verb)}")
    for number in levin:
        if number not in levin_classes():
            found.append(f"Levin has no class {number!r}{_near(number, levin_classes())}")
    for each in senses:
        if sense_key(verb, each) in wordnet():
            continue
        if each.isdigit():
            has = f"; it has 1 to {len(known)}" if known else ""
            found.append(f"WordNet has no sense {each} of {verb!r}{has}")
        else:
            near = _near(each, [sense.key for sense, _ in known])
            found.append(f"WordNet has no verb sense {each!r}{near}")
    return tuple(found)


def doubts_of(words: Iterable[PrimitiveWords]) -> tuple[str, ...]:
    """The doubts about what the rule files of primitives state, each with file and primitive."""
    return tuple(
        f"{each.file}: {each.name}: {doubt}"
        for each in words
        for index, verb in enumerate(each.verbs or ("",))
        for doubt in (doubts(verb, (), ()) if index else doubts(verb, each.levin, each.senses))
    )


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
        super().__init__("verb", verb, ())
        self.args = (f"no verb {verb!r} is known{_near_verbs(verb)}.",)


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
    """Classes that list the verb, with the roles and frames that each inherits."""
    by_name = {each.id: each for each in verbnet}
    lemma = verb.replace(" ", "_")
    found = []
    for each in verbnet:
        if all(member.lemma != lemma for member in each.members):
            continue
        line = [each]
        while line[-1].parent in by_name:
            line.append(by_name[line[-1].parent])
        roles = dict.fromkeys(role.name for one in reversed(line) for role in one.roles)
        frame = next((frame for one in line for frame in one.frames), None)
        found.append(ClassOfVerb(levin_classes().get(each.levin), each.id, tuple(roles), frame))
    known = {each.levin.number for each in found if each.levin}
    extra = sorted(set(motion_classes(verb)) - known, key=book_order)
    return (*found, *(ClassOfVerb(levin_classes()[each], "", (), None) for each in extra))


def _neighbours(keys: Sequence[str], keys_of: Mapping[str, Sequence[str]]) -> tuple[Neighbour, ...]:
    """What stands one step up and one step down from the verb's senses as a motion."""
    synsets: list[tuple[str, Synset]] = []
    for synset in map(wordnet().of_key, keys):
        steps = wordnet().steps_above(synset)
        synsets += [("is a kind of", each) for each, step in steps.items() if step == 1]
        synsets += [("has the kind", each) for each in wordnet().directly_below(synset)]
    found = []
    for relation, synset in synsets:
        primitives = sorted(
            name for name, own in keys_of.items() if synset in map(wordnet().of_key, own)
        )
        found.append(Neighbour(relation, synset.lemmas, synset.definition, tuple(primitives)))
    with_primitive = [each for each in found if each.primitives or each.relation == "is a kind of"]
    others = [each for each in found if each not in with_primitive]
    return tuple(dict.fromkeys([*with_primitive, *others[: max(0, 6 - len(with_primitive))]]))


def kinds(verb: str, keys_of: Mapping[str, Sequence[str]]) -> tuple[str, ...]:
    """Primitives whose verb is the verb, or a kind of it: "every kind of move".

    Raises:
        UnknownVerbError: WordNet has no such verb.
    """
    if not wordnet().of_lemma(verb):
        raise UnknownVerbError(verb)
    tops = {wordnet().of_key(key) for key in motion_senses(verb)}

    def is_kind(key: str) -> bool:
        synset = wordnet().of_key(key)
        return not tops.isdisjoint([synset, *wordnet().steps_above(synset)])

    return tuple(sorted(name for name, keys in keys_of.items() if any(map(is_kind, keys))))


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


def fitting(
    seen: SegmentFeatures, words: Sequence[PrimitiveWords], classes: Iterable[VerbClass] = ()
) -> tuple[Fit, ...]:
    """Verbs that fit a segment, best first; each verb once, with its best class."""
    named = {each.name: each for each in words}
    found = []
    linked: set[str] = set()
    for steps, name in enumerate((seen.name, *seen.general)):
        if name not in named:
            continue
        linked.update(class_links(named[name])[0])
        for verb in named[name].verbs:
            reason = "the rule that named it" if not steps else f"what {seen.name} specialises"
            found.append(Fit(verb, 3.0 - 0.1 * steps, (f"{name}: {reason}",), (), name))
            for synset in map(wordnet().of_key, motion_senses(verb)):
                same = f"means the same as {verb}: {synset.definition}"
                score = 2.5 - 0.1 * steps
                found += [Fit(other, score, (same,), (), name) for other in synset.lemmas]
    for verb_class in classes:
        found += _by_class(seen, verb_class, linked)
    best: dict[str, Fit] = {}
    for fit in sorted(found, key=lambda each: (-each.score, each.verb, each.source)):
        best.setdefault(fit.verb, fit)
    return tuple(best.values())


def _by_class(seen: SegmentFeatures, each: VerbClass, linked: set[str]) -> Iterable[Fit]:
    """The members of a class by that of its frames that fits best."""
    judged = []
    for frame in each.frames:
        events = list(dict.fromkeys(one.event for one in frame.semantics if one.event))
        demands = [
            demand
            for one in frame.semantics
            if (demand := _demand(one, seen.features, before=one.event in events[:1]
                                  and one.event != events[-1]))
        ]  # fmt: skip
        if demands:
            share = sum(met for met, _ in demands) / len(demands)
            judged.append((share, len(demands), demands, frame))
    if not judged:
        return
    share, count, demands, frame = max(judged, key=lambda one: one[:2])
    score = share + (0.5 if each.levin in linked else 0.0) + min(count, 4) / 20
    reasons = tuple(dict.fromkeys(words for met, words in demands if met))
    against = tuple(dict.fromkeys(words for met, words in demands if not met))
    for member in each.members:
        verb = member.lemma.replace("_", " ")
        yield Fit(verb, score, reasons, against, f"{each.id}: {frame.pattern}")


def _demand(predicate: Predicate, features: FeatureSet, *, before: bool) -> tuple[bool, str] | None:
    """Whether a segment meets what a predicate says of contact, motion, force or goal, in words."""
    roles = {each.lstrip("?") for each in predicate.arguments}
    moves = "1" in features.change_loc
    met, words = None, ""
    if predicate.name == "contact" and roles & DOERS:
        met = ((features.rel_start if before else features.rel_end)[:1] == "1") == predicate.holds
        words = f"{'' if predicate.holds else 'no '}contact {'before' if before else 'after'}"
    elif predicate.name in MOTIONS and "Theme" in roles:
        met, words = moves, "the object to move"
    elif predicate.name in MOTIONS and "Agent" in roles:
        met, words = not moves, "only the agent to move"
    elif predicate.name == "has_location" and "Destination" in roles and predicate.holds:
        met = features.count > 1 and features.rel_end.endswith("1")
        words = "the object at a place afterwards"
    elif predicate.name == "exert_force" or "forceful" in roles:
        met, words = "1" in features.force, "a force"
    return None if met is None else (met, f"{predicate} wants {words}")


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
    asked = set(verbs)
    if classes:
        asked |= {verb for _, verb in _named_members()}
        asked |= {verb for each in words for verb in each.verbs}.union(*members.values())
    shown = [each for each in seen if each.primitive]
    lines = {
        *_primitives(words, asked),
        *(_classes_stated(members) if classes else ()),
        *(_fact("rule", rule) for rule in rules),
        *(_fact("observed", each.primitive, each.observation) for each in shown),
        *(
            _fact("done_to", words_of(each.purpose), each.primitive, each.observation)
            for each in shown
            if each.purpose
        ),
        *(_fact("tested", case.primitive, case.name) for case in cases),
    }
    return "\n".join(sorted(lines)) + "\n"


def _fact(predicate: str, *arguments: str | int) -> str:
    """A fact of the rules, in whose texts only these three signs are written otherwise."""
    signs = str.maketrans({"\\": r"\\", '"': r"\"", "\n": r"\n"})
    words = (str(e) if isinstance(e, int) else f'"{e.translate(signs)}"' for e in arguments)
    return f"{predicate}({', '.join(words)})."


def _primitives(words: Sequence[PrimitiveWords], verbs: set[str]) -> Iterator[str]:
    """What primitives are called, and which of the verbs mean the same, or a kind of it."""
    for word in words:
        yield _fact("primitive", word.name)
        yield from (_fact("specialises", word.name, general) for general in word.general)
        yield from (_fact("verb", word.name, verb) for verb in word.verbs)
        own = own_links(word.name)
        classes = word.levin or (own[1] or ("",) if own else ())
        yield from (_fact("levin", word.name, number) for number in classes)
        for link in sense_links(word):
            if link.key not in wordnet():
                continue
            synset = wordnet().of_key(link.key)
            for lemma in verbs.intersection(synset.lemmas) - {link.verb}:
                yield _fact("same_sense", word.name, lemma)
            for other in verbs:
                up = (wordnet().steps_above(wordnet().of_key(e)) for e in motion_senses(other))
                if steps := min((each[synset] for each in up if synset in each), default=0):
                    yield _fact("kind_of", word.name, other, steps)


def _classes_stated(members: Members) -> Iterator[str]:
    for levin in levin_classes().values():
        yield _fact("class", levin.number)
        if levin.broader:
            yield _fact("within", levin.number, levin.broader)
    yield from (_fact("named_member", number, verb) for number, verb in _named_members())
    for number, verbs in members.items():
        yield from (_fact("known_member", number, verb) for verb in verbs)
    for row in table("motion_classes"):
        yield _fact("motion_class", row["verb"], row["class"])
    for row in table("needs"):
        yield _fact("needs", row["class"], row["verb"], row["need"], row["rule"])


def _named_members() -> set[tuple[str, str]]:
    """Classes and verbs that the thesis names; "touch with" is the verb "touch"."""
    return {
        (claim.levin, verb.removesuffix(" with"))
        for claim in thesis_claims()
        if claim.levin
        for verb in claim.verbs
    }


def verbnet_members(classes: Iterable[VerbClass]) -> dict[str, frozenset[str]]:
    """The verbs of each Levin class by the members of VerbNet's classes of it."""
    found: dict[str, set[str]] = {}
    by_name = {name: each.number for each in levin_classes().values() for name in each.verbnet}
    for verb_class in classes:
        top = "-".join(verb_class.id.split("-")[:2])  # ``touch-20`` of ``touch-20-1``
        number = by_name.get(top, verb_class.levin)
        if number in levin_classes():
            verbs = {member.lemma.replace("_", " ") for member in verb_class.members}
            found.setdefault(number, set()).update(verbs)
    return {number: frozenset(verbs) for number, verbs in found.items()}
