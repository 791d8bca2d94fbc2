"""Segments as clauses: what each says, of which objects, with which hand, to which end."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import Ipar, Motion
from kb.language.contacts import Scene
from kb.language.lexicalisation import HELPS, MOMENTARY, QUIET, SOMEONE, STAYING, Phrasebook
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

    pauses: int = 0
    """How often it was interrupted for so long that people notice it."""

    name: str = ""
    """The primitive that it says."""

    general: tuple[str, ...] = ()
    """What the primitive specialises, nearest first."""

    goes_on: bool = False
    """Whether the end-effector touches the same at its end as at its beginning."""

    possessed: bool = False
    """Whether the end-effector possesses the first object."""

    grip: int = 0
    """How often the end-effector had come to a thing, or left one, when it was done."""

    rights: bool = False
    """Whether it ends as the first object is turned upright again."""

    @property
    def quiet(self) -> bool:
        """Whether it describes the hand alone."""
        return self.pattern in QUIET

    @property
    def comes(self) -> bool:
        """Whether the end-effector comes to the first object in it."""
        return not self.goes_on and not self.possessed and not self.frees

    @property
    def frees(self) -> bool:
        """Whether the end-effector leaves the first object in it."""
        return self.pattern in MOMENTARY or self.pattern.startswith("take {ee}")

    @property
    def holds(self) -> bool:
        """Whether the end-effector only stays at the first object in it."""
        stays = not STAYING.isdisjoint((self.name, *self.general))
        return stays and self.goes_on and not (self.changes or self.purpose or self.quiet)

    @property
    def helps(self) -> bool:
        """Whether it moves nothing and yet is a part of what was done."""
        return self.pattern in HELPS

    @property
    def signature(self) -> tuple[object, ...]:
        """What makes two clauses say the same but for hands and times."""
        return self.pattern, self.objects, self.purpose, self.count, self.often, self.pauses

    def overlap_s(self, other: "Clause") -> float:
        """For how long both go on [s]."""
        return min(self.end_s, other.end_s) - max(self.start_s, other.start_s)


def in_time(clause: Clause) -> tuple[float, float, tuple[str, ...]]:
    """The key by which clauses are sorted."""
    return clause.start_s, clause.end_s, clause.ees


def clauses(
    observation: Observation, link: ObservedLink, book: Phrasebook, scene: Scene
) -> tuple[Clause, ...]:
    """What one link did, in order; free motion that touches nothing is left out."""
    ipars = {(each.ee, each.start_s): each for each in observation.ipars}
    names = {each.name for each in observation.segments}
    carried = scene.carried_on(link)
    found: list[tuple[Segment, Clause]] = []
    held = False
    before: Segment | None = None
    for segment in link.segments:
        held = segment.possessed or (held and _same_dominant(before, segment))
        if segment.objects and segment.index not in carried:
            last = found[-1][0] if found else None
            ipar = ipars.get((segment.ee, segment.start_s))
            cases = _cases(segment, last, scene, ipar, held=held)
            clause = _clause(segment, before, book, cases, names)
            if SOMEONE in clause.pattern:
                named = clause.pattern.replace(SOMEONE, scene.taker(segment) or SOMEONE)
                clause = replace(clause, pattern=named)
            found.append((segment, clause))
        before = segment
    found = [
        (segment, _to_the_mouth(clause, later))
        for (segment, clause), later in zip_longest(found, (clause for _, clause in found[1:]))
    ]
    return _with_purposes(found, names)


def _to_the_mouth(clause: Clause, later: Clause | None) -> Clause:
    """The clause, with the mouth for the head to which a thing is brought that is drunk from."""
    drinks = later is not None and later.pattern.split()[0] == "drink"
    if not drinks or clause.objects[1:2] != ("head",) or "{2}" not in clause.pattern:
        return clause
    return replace(clause, pattern=clause.pattern.replace("{2}", "the mouth"))


def main_things(told: Sequence[Clause]) -> tuple[Clause, ...]:
    """Of clauses that change nothing, those that say what the first did that is of a thing."""
    manual = [each for each in told if not each.quiet] or list(told)
    return tuple(each for each in manual if _alike(each, manual[0]))


def _alike(one: Clause, other: Clause) -> bool:
    """Whether the same is done to the same things."""
    return (one.name, one.objects) == (other.name, other.objects)


def _changes(segment: Segment, pattern: str) -> bool:
    """Whether it moves or strikes something; coming and going do not, whatever moves meanwhile."""
    return "1" in segment.features.change_loc + segment.features.force and pattern not in QUIET


def _same_dominant(before: Segment | None, segment: Segment) -> bool:
    return before is not None and before.objects[:1] == segment.objects[:1]


def _cases(
    segment: Segment, before: Segment | None, scene: Scene, ipar: Ipar | None, *, held: bool
) -> set[str]:
    motion = ipar.core.motion if ipar else Motion.NONE
    cases = {"held"} if held else set()
    if _stays(segment) and held and scene.runs_over(segment):
        cases = {"running"}
    elif _stays(segment) and scene.steadies(segment):
        cases.add("steadies")
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
    if scene.rises(segment):
        cases.add("rises")
    if scene.rests_on(thing, other) and _stands_on(segment, thing, other):
        cases.add("on")
    if scene.was_there(segment, thing, other):
        cases.add("back")
    return cases


def _stays(segment: Segment) -> bool:
    """Whether the end-effector only stays at what it touches."""
    features = segment.features
    touches = features.rel_start.startswith("1") and features.rel_start == features.rel_end
    return touches and not features.change_loc.startswith("1") and "1" not in features.force


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
    usual = book.pattern(segment.name, segment.general, (), 1)
    return Clause(
        pattern=pattern,
        objects=objects,
        ees=(segment.ee,),
        start_s=segment.start_s,
        end_s=segment.start_s if pattern in MOMENTARY else segment.end_s,
        changes=_changes(segment, usual) and pattern not in HELPS,
        name=segment.name,
        general=segment.general,
        goes_on=segment.features.rel_start == segment.features.rel_end,
        possessed=segment.possessed,
        rights=any(each.kind == "rights" for each in segment.ends),
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
