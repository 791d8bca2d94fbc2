"""What is known of a verb: senses, classes, roles, primitives, and what stands near it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from capar.model.errors import UnknownNameError
from kb.lexicon.claims import nearest_verbs, the_nearest
from kb.lexicon.evidence import Seen
from kb.lexicon.levin import LevinClass, book_order, levin_classes
from kb.lexicon.links import (
    PrimitiveWords,
    ThesisClaim,
    motion_classes,
    motion_senses,
    sense_links,
    thesis_claims,
)
from kb.lexicon.verbnet import Frame, VerbClass
from kb.lexicon.wordnet import Sense, Synset, wordnet


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
