"""Segments as clauses: what each says, of which objects, with which hand, to which end."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import Ipar, Motion
from kb.language.contacts import Scene
from kb.language.lexicalisation import QUIET, SOMEONE, Phrasebook
from kb.lexicon.english import joined, words_of
from kb.lexicon.links import motion_senses
from kb.lexicon.wordnet import wordnet


@dataclass(frozen=True)
class Clause:
    """One thing that was done."""

    pattern: str
    """``put {1} on {2}``: places for objects, and ``{ee}`` for the hand."""

    objects: tuple[str, ...]
    ees: tuple[str, ...]
    """The end-effectors that do it, sorted: one, or both hands."""

    start_s: float
    end_s: float
    changes: bool
    """Whether it changes the world: moves something, strikes it, or is the end itself."""

    purpose: str = ""
    """What it was done for, in words, where nothing else says it: ``pour``."""

    known: bool = True
    count: int = 1
    """How often it was done on end."""

    often: str = ""
    """How often in other words: ``again``."""

    @property
    def signature(self) -> tuple[object, ...]:
        """What makes two clauses say the same but for hands and times."""
        return self.pattern, self.objects, self.purpose, self.count, self.often

    def overlap_s(self, other: "Clause") -> float:
        """For how long both go on [s]."""
        return min(self.end_s, other.end_s) - max(self.start_s, other.start_s)


def in_time(clause: Clause) -> tuple[float, float, tuple[str, ...]]:
    """The key by which clauses are sorted."""
    return clause.start_s, clause.end_s, clause.ees


def clauses(
    observation: Observation,
    link: ObservedLink,
    book: Phrasebook,
    scene: Scene,
    *,
    only_changes: bool = False,
) -> tuple[Clause, ...]:
    """What one link did, in order; free motion that touches nothing is left out.

    With ``only_changes``, what changed nothing is left out too, unless nothing else happened.
    """
    ipars = {(each.ee, each.start_s): each for each in observation.ipars}
    told = _told_segments(link, book, only_changes=only_changes)
    names = {each.name for each in observation.segments}
    found: list[tuple[Segment, Clause]] = []
    held = False
    before: Segment | None = None
    for segment in link.segments:
        held = segment.possessed or (held and _same_dominant(before, segment))
        if segment.index in told:
            last = found[-1][0] if found else None
            ipar = ipars.get((segment.ee, segment.start_s))
            cases = _cases(segment, last, scene, ipar, held=held)
            clause = _clause(segment, before, book, cases, names)
            if SOMEONE in clause.pattern:
                named = clause.pattern.replace(SOMEONE, scene.taker(segment) or SOMEONE)
                clause = replace(clause, pattern=named)
            found.append((segment, clause))
        before = segment
    return _with_purposes(found, names)


def _told_segments(link: ObservedLink, book: Phrasebook, *, only_changes: bool) -> set[int]:
    touching = [each for each in link.segments if each.objects]
    if not only_changes:
        return {each.index for each in touching}
    changing = [each for each in touching if not each.known or _changes(each, book)]
    manual = [each for each in touching if not _quiet(each, book)] or touching
    chosen = changing or [each for each in manual if _alike(each, manual[0])]
    return {each.index for each in chosen}


def _quiet(segment: Segment, book: Phrasebook) -> bool:
    """Whether it describes the hand alone."""
    return book.pattern(segment.name, segment.general, (), 1) in QUIET


def _alike(one: Segment, other: Segment) -> bool:
    """Whether the same is done to the same things."""
    return (one.name, one.objects) == (other.name, other.objects)


def _changes(segment: Segment, book: Phrasebook) -> bool:
    """Whether it moves or strikes something; coming and going do not, whatever moves meanwhile."""
    moves = "1" in segment.features.change_loc + segment.features.force
    return moves and not _quiet(segment, book)


def _same_dominant(before: Segment | None, segment: Segment) -> bool:
    return before is not None and before.objects[:1] == segment.objects[:1]


def _cases(
    segment: Segment, before: Segment | None, scene: Scene, ipar: Ipar | None, *, held: bool
) -> set[str]:
    motion = ipar.core.motion if ipar else Motion.NONE
    cases = {"held"} if held else set()
    if motion in {Motion.ROTATION, Motion.BOTH}:
        cases.add("tilts" if motion is Motion.BOTH else "turns")
    if len(segment.objects) < 2:
        return cases | {"alone"}
    thing, other = segment.objects[:2]
    if ("with", other, thing) in segment.prepositions:
        cases.add("tool")
    if before is not None and before.objects[:2] == (thing, other):
        cases.add("there")
    if scene.is_self(other):
        cases.add("self")
    if scene.rests_on(thing, other) and _stands_on(segment, thing, other):
        cases.add("on")
    if scene.was_there(segment, thing, other):
        cases.add("back")
    return cases


def _stands_on(segment: Segment, thing: str, other: str) -> bool:
    """Whether the thing is on the other where the rules tell prepositions; else it may be."""
    said = {word for word, body, place in segment.prepositions if (body, place) == (thing, other)}
    return not said or bool(said & {"on", "onto"})


def _clause(
    segment: Segment,
    before: Segment | None,
    book: Phrasebook,
    cases: set[str],
    names: set[str],
) -> Clause:
    if not segment.known:
        return _unknown(segment)
    pattern = book.pattern(segment.name, segment.general, cases, len(segment.objects))
    pattern = _deed(segment, before, cases, names) or pattern
    objects = segment.objects
    if _touches_several(segment) and "{2}" not in pattern:
        objects = tuple(sorted(objects))
        places = [f"{{{number}}}" for number in range(1, len(objects) + 1)]
        pattern = pattern.replace("{1}", joined(places))
    loads = _loads(segment)
    if loads and "{1}" in pattern:
        places = [f"{{{len(objects) + number}}}" for number in range(1, len(loads) + 1)]
        pattern = pattern.replace("{1}", f"{{1}} with {joined(places)}")
        objects = (*objects, *loads)
    return Clause(
        pattern=pattern,
        objects=objects,
        ees=(segment.ee,),
        start_s=segment.start_s,
        end_s=segment.end_s,
        changes=_changes(segment, book),
    )


def _loads(segment: Segment) -> tuple[str, ...]:
    """What goes along in or on the object that the segment is about."""
    return tuple(
        other
        for word, body, other in segment.prepositions
        if word == "with" and body in segment.objects[:1] and other not in segment.objects
    )


def _touches_several(segment: Segment) -> bool:
    """Whether the end-effector touches all the objects at once, and possesses none."""
    count = segment.features.count
    ends = (segment.features.rel_start[:count], segment.features.rel_end[:count])
    return count > 1 and not segment.possessed and "1" * count in ends


def _unknown(segment: Segment) -> Clause:
    """What can be said of features that no rule covers: whether the hand moved a thing."""
    moves = segment.possessed and segment.features.change_loc.startswith("1")
    places = [f"{{{number}}}" for number in range(1, len(segment.objects) + 1)]
    verb, things = ("move", "{1}") if moves else ("handle", joined(places))
    return Clause(
        pattern=f"{verb} {things} {{with}}in a way that no rule names",
        objects=segment.objects,
        ees=(segment.ee,),
        start_s=segment.start_s,
        end_s=segment.end_s,
        changes=True,
        known=False,
    )


def _deed(segment: Segment, before: Segment | None, cases: set[str], names: set[str]) -> str:
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


def _with_purposes(found: Sequence[tuple[Segment, Clause]], names: set[str]) -> tuple[Clause, ...]:
    """The clauses, with those purposes stated that no later clause of the link fulfils."""
    out = []
    for index, (segment, clause) in enumerate(found):
        verb = _purpose_verb(segment.purpose, names)
        after = [each for other, each in found[index:]]
        follows = found[index + 1][0].purpose if index + 1 < len(found) else ""
        manipulates = segment.features.rel_start.startswith("1") and clause.changes
        if verb and manipulates and follows != segment.purpose and not _told(verb, after):
            clause = replace(clause, purpose=verb)  # noqa: PLW2901 (the same clause, with its end)
        out.append(clause)
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
