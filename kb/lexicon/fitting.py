"""Which verbs fit what was observed: VerbNet's semantic predicates against features."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from capar.model.par import FeatureSet
from kb.lexicon.links import PrimitiveWords, class_links, motion_senses
from kb.lexicon.verbnet import Frame, Predicate, VerbClass
from kb.lexicon.wordnet import wordnet

DOERS = frozenset({"Agent", "Instrument", "Co-Agent"})
"""Roles that the end-effector, or what it holds, fills."""

FORCE = frozenset({"forceful"})
MOTIONS = frozenset({"motion", "rotational_motion", "elliptical_motion"})


@dataclass(frozen=True, slots=True, order=True)
class Seen:
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


@dataclass(frozen=True, slots=True)
class _Demand:
    met: bool
    words: str


def fitting(
    seen: Seen, words: Sequence[PrimitiveWords], classes: Iterable[VerbClass] = ()
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


def _by_rules(seen: Seen, named: Mapping[str, PrimitiveWords]) -> Iterable[Fit]:
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


def _linked_classes(seen: Seen, named: Mapping[str, PrimitiveWords]) -> set[str]:
    """Levin classes of the primitive that named the segment, and of those above it."""
    return {
        number
        for name in (seen.name, *seen.general)
        if name in named
        for number in class_links(named[name])[0]
    }


def _by_class(seen: Seen, each: VerbClass, linked: set[str]) -> Iterable[Fit]:
    """The members of a class by that of its frames that fits best."""
    judged = [(frame, _demands(frame, seen.features)) for frame in each.frames]
    judged = [(frame, demands) for frame, demands in judged if demands]
    if not judged:
        return
    frame, demands = max(judged, key=lambda pair: (_share(pair[1]), len(pair[1])))
    share = _share(demands)
    bonus = 0.5 if each.levin in linked else 0.0
    size = min(len(demands), 4) / 20
    reasons = tuple(dict.fromkeys(demand.words for demand in demands if demand.met))
    against = tuple(dict.fromkeys(demand.words for demand in demands if not demand.met))
    for member in each.members:
        verb = member.lemma.replace("_", " ")
        yield Fit(verb, share + bonus + size, reasons, against, f"{each.id}: {frame.pattern}")


def _share(demands: Sequence[_Demand]) -> float:
    return sum(each.met for each in demands) / len(demands)


def _demands(frame: Frame, features: FeatureSet) -> list[_Demand]:
    """What a frame's predicates say of a contact, a motion, a force and a goal."""
    events = list(dict.fromkeys(each.event for each in frame.semantics if each.event))
    last = events[-1] if events else ""
    found: list[_Demand] = []
    for predicate in frame.semantics:
        first_event = predicate.event == events[0] if events else False
        found += _demand(predicate, features, at_start=first_event, at_end=predicate.event == last)
    return found


def _demand(
    predicate: Predicate, features: FeatureSet, *, at_start: bool, at_end: bool
) -> list[_Demand]:
    roles = [each.lstrip("?") for each in predicate.arguments]
    touches = features.rel_start[:1] == "1", features.rel_end[:1] == "1"
    if predicate.name == "contact" and DOERS.intersection(roles):
        before = at_start and not at_end
        met = touches[0 if before else 1] == predicate.holds
        when = "before" if before else "after"
        return [_Demand(met, f"{predicate} wants {_no(predicate)}contact {when}")]
    if predicate.name in MOTIONS and "Theme" in roles:
        return [_Demand("1" in features.change_loc, f"{predicate} wants the object to move")]
    if predicate.name in MOTIONS and "Agent" in roles:
        return [
            _Demand("1" not in features.change_loc, f"{predicate} wants only the agent to move")
        ]
    if predicate.name == "has_location" and "Destination" in roles and predicate.holds:
        met = features.count > 1 and features.rel_end.endswith("1")
        return [_Demand(met, f"{predicate} wants the object at a place afterwards")]
    if predicate.name == "exert_force" or FORCE.intersection(roles):
        return [_Demand("1" in features.force, f"{predicate} wants a force")]
    return []


def _no(predicate: Predicate) -> str:
    return "" if predicate.holds else "no "
