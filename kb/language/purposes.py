"""What deeds were done for: said as verbs of their own, or after the last one that serves them."""

from collections.abc import Sequence
from dataclasses import replace

from capar.model.observation import Segment
from kb.language.clause import Clause
from kb.lexicon.english import words_of
from kb.lexicon.links import motion_senses
from kb.lexicon.wordnet import wordnet


def purposeful(segment: Segment, before: Segment | None, cases: set[str], names: set[str]) -> str:
    """The purpose itself, where a thing that was brought to its place for it is moved there.

    At the agent's own body that needs no object (``drank``); else only verbs of two words, which
    take up what is moved (``picked it up``), are certain to have it as their object.
    """
    stays = segment.features.rel_start == segment.features.rel_end
    moves = "1" in segment.features.change_loc and segment.features.count > 1
    prepared = (
        before is not None
        and before.purpose == segment.purpose
        and before.objects == segment.objects
    )
    verb = _purpose_verb(segment.purpose, names)
    if not (verb and stays and moves and prepared):
        return ""
    if "self" in cases:
        return verb
    head, _, particle = verb.partition(" ")
    return f"{head} {{1}} {particle}" if particle else ""


def _purpose_verb(purpose: str, names: set[str]) -> str:
    """A user's purpose as a verb that WordNet knows; empty for any other.

    A purpose that is the name of another step only says what comes next.
    """
    if not purpose or purpose in names:
        return ""
    words = words_of(purpose)
    return words if wordnet().of_lemma(words) else ""


def with_purposes(found: Sequence[tuple[Segment, Clause]], names: set[str]) -> tuple[Clause, ...]:
    """The clauses, with those purposes stated that no later clause of the link fulfils."""
    out = []
    for index, (segment, clause) in enumerate(found):
        verb = _purpose_verb(segment.purpose, names)
        after = [later for _, later in found[index:]]
        follows = found[index + 1][0].purpose if index + 1 < len(found) else ""
        manipulates = segment.features.rel_start.startswith("1") and clause.changes
        unsaid = verb and manipulates and follows != segment.purpose and not _told(verb, after)
        out.append(replace(clause, purpose=verb) if unsaid else clause)
    return tuple(out)


def _told(verb: str, after: Sequence[Clause]) -> bool:
    """Whether one of the clauses says what the verb says."""
    meant = _lemmas(verb)
    return any(
        each.pattern.startswith(lemma + " ") or each.pattern == lemma
        for each in after
        for lemma in meant
    )


def _lemmas(verb: str) -> set[str]:
    """The verb, its first word, and the verbs that share its senses as a motion."""
    same = {verb, verb.split(maxsplit=1)[0]}
    for key in motion_senses(verb):
        same.update(wordnet().of_key(key).lemmas)
    return same
