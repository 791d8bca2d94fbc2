"""Segments as clauses: what each says, of which objects, with which hand, to which end."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import zip_longest

from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import Ipar, Motion
from kb.language.clause import Clause
from kb.language.contacts import Scene
from kb.language.holding import Handled, Holding
from kb.language.lexicalisation import (
    GIVEN,
    GOALS,
    HELPS,
    MOMENTARY,
    PUT_IN,
    QUIET,
    SOMEONE,
    TO_A_SIDE,
    Phrasebook,
)
from kb.language.purposes import purposeful, with_purposes
from kb.language.turning import Turning
from kb.lexicon.english import joined


def clauses(
    observation: Observation,
    link: ObservedLink,
    book: Phrasebook,
    scene: Scene,
    turning: Turning,
    holding: Holding | None,
) -> tuple[Clause, ...]:
    """What one link did, in order; free motion that touches nothing is left out.

    Args:
        observation: What was understood of a capture.
        link: One of its links.
        book: How primitives are said.
        scene: Its measured contacts.
        turning: How its objects are turned.
        holding: What its hands move, and when things change hands; None to tell segments alone.
    """
    ipars = {(each.ee, each.start_s): each for each in observation.ipars}
    names = {each.name for each in observation.segments}
    carried = scene.carried_on(link)
    found: list[Handled] = []
    held = False
    before: Segment | None = None
    for segment in link.segments:
        held = segment.possessed or (held and _same_dominant(before, segment))
        untold = segment.name == "Receive" and _given(segment, holding)
        if segment.objects and not untold:
            last = found[-1].segment if found else None
            ipar = ipars.get((segment.ee, segment.start_s))
            cases = _cases(segment, last, scene, ipar, turning, held=held)
            clause = _clause(segment, before, book, cases, names)
            if SOMEONE in clause.pattern:
                named = clause.pattern.replace(SOMEONE, scene.taker(segment) or SOMEONE)
                clause = replace(clause, pattern=named)
            if holding is not None:
                clause = _when_it_was(segment, clause, holding)
            found.append(Handled(segment, clause))
        before = segment
    if holding is not None:
        found = holding.kept(link, found)
    found = [each for each in found if each.clause.possessed or each.segment.index not in carried]
    found = [
        Handled(segment, _to_the_mouth(clause, later))
        for (segment, clause), later in zip_longest(found, (clause for _, clause in found[1:]))
    ]
    return with_purposes(found, names)


def _given(segment: Segment, holding: Holding | None) -> bool:
    """Whether it is told as the other hand's giving."""
    return holding is not None and holding.received(segment)


def _when_it_was(segment: Segment, clause: Clause, holding: Holding) -> Clause:
    """The clause at the moment at which the thing leaves the hand, or while it changes hands."""
    if clause.pattern not in MOMENTARY:
        return clause
    passed = holding.passed(segment) if clause.pattern == GIVEN else None
    if passed is not None:
        span, side = passed
        pattern = TO_A_SIDE.get(side, TO_A_SIDE["other"])
        return replace(clause, pattern=pattern, start_s=span.start_s, end_s=span.end_s)
    left_s = holding.released_s(segment)
    return replace(clause, start_s=left_s, end_s=left_s)


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
    segment: Segment,
    before: Segment | None,
    scene: Scene,
    ipar: Ipar | None,
    turning: Turning,
    *,
    held: bool,
) -> set[str]:
    motion = ipar.core.motion if ipar else Motion.NONE
    cases = {"held"} if held else set()
    if _stays(segment) and held and scene.runs_over(segment):
        cases = {"running"}
    elif _stays(segment) and scene.steadies_since_s(segment) is not None:
        cases.add("steadies")
    if motion in {Motion.ROTATION, Motion.BOTH}:
        cases.add("tilts" if motion is Motion.BOTH else "turns")
    if segment.possessed and turning.this_way_and_that(segment):
        cases.add("wrung")
    if len(segment.objects) < 2:
        return cases | {"alone"}
    thing, other = segment.objects[:2]
    hold = {
        "tool": ("with", other, thing) in segment.prepositions,
        "there": before is not None and before.objects[:2] == (thing, other),
        "self": scene.is_self(other),
        "rises": scene.rises(segment),
        "on": scene.rests_on(thing, other) and _stands_on(segment, thing, other),
        "movable": scene.is_movable(other),
        "off": scene.goes_off(segment, thing, other),
        "back": scene.was_there(segment, thing, other),
        "in": ("in", thing, other) in segment.prepositions and scene.is_open(other),
    }
    return cases | {name for name, holds in hold.items() if holds}


def _stays(segment: Segment) -> bool:
    """Whether the end-effector only stays at what it touches."""
    features = segment.features
    touches = features.rel_start.startswith("1") and features.rel_start == features.rel_end
    return touches and not features.change_loc.startswith("1") and "1" not in features.force


def _stands_on(segment: Segment, thing: str, other: str) -> bool:
    """Whether the thing is on the other where the rules tell prepositions; else it may be.

    What is beside it as well leans on it at most.
    """
    said = {word for word, body, place in segment.prepositions if (body, place) == (thing, other)}
    return not said or (bool(said & {"on", "onto"}) and "beside" not in said)


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
    pattern = PUT_IN if "in" in cases and pattern.startswith(GOALS) else pattern
    pattern = purposeful(segment, before, cases, names) or pattern
    objects = segment.objects
    if _touches_several(segment) and "{2}" not in pattern:
        objects = tuple(sorted(objects))
        places = [f"{{{number}}}" for number in range(1, len(objects) + 1)]
        pattern = pattern.replace("{1}", joined(places))
    loads = _loads(segment)
    if loads and "{1}" in pattern and not pattern.startswith("put "):
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
