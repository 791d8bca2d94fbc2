"""The lexicon as facts of the lexical rules: classes, members, senses, needs, evidence."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from kb.lexicon.english import words_of
from kb.lexicon.evidence import Case, Seen
from kb.lexicon.levin import levin_classes
from kb.lexicon.links import (
    PrimitiveWords,
    motion_senses,
    own_links,
    sense_links,
    thesis_claims,
)
from kb.lexicon.tables import table
from kb.lexicon.verbnet import VerbClass
from kb.lexicon.wordnet import Synset, wordnet

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
        classes: Whether classes and their members are told; else only those verbs are.
    """
    asked = set(verbs) | (_every_verb(words, members) if classes else set())
    lines = {
        *_primitives(words),
        *(_classes() if classes else ()),
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


def _classes() -> Iterator[str]:
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
