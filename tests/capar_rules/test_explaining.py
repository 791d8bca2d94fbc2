"""Each sentence of an explanation is true: recomputed from the capture's facts, not its rules."""

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

import motions
import numpy as np
import pytest
from motions.rolling import CAN

from capar.explanation import Explained, explained
from capar.model.facts import (
    Fact,
    Frames,
    LookingAt,
    Moving,
    Place,
    Posture,
    Resting,
    Reverses,
    Rolls,
    Tag,
    Touching,
    ZeroCrossing,
)
from capar.model.observation import Segment
from capar_rules.explaining import Explainer
from capar_rules.profiles import profile
from capar_rules.reasoning import infer
from extractors.facts import extract

MERGE_S = 0.15
"""Contacts that end within this are one border (spec 5.1)."""

CAPTURES = {
    f"{motion.__name__}_{performer.name}": (motion, performer)
    for motion in (
        motions.drink_from_mug,
        motions.pick_up_with_both_hands,
        motions.roll_object,
        motions.slide_object,
        motions.touch_cycle,
        motions.touch_from_rest,
    )
    for performer in (motions.TALL_MAN, motions.CHILD)
}


@dataclass(frozen=True)
class Known:
    """What sentences are held against."""

    seen: Explained
    facts: tuple[Fact, ...]
    segment: Segment
    capture: object

    def at(self, text: str) -> float:
        return float(text) * self.seen.observation.rate_hz

    def touching(self, one: str, other: str) -> list[Touching]:
        pair = (name(one), name(other))
        return [
            each
            for each in self.facts
            if isinstance(each, Touching) and (each.body, each.other) == pair
        ]

    def moving(self, what: str) -> list[Moving]:
        return [
            each for each in self.facts if isinstance(each, Moving) and each.object == name(what)
        ]


def name(text: str) -> str:
    return text.replace(" ", "_")


def near(frame: float, other: float) -> bool:
    """Within the two decimals of a second that a sentence has."""
    return abs(frame - other) <= 0.8


def touched(known: Known, one: str, other: str, at: str) -> bool:
    frame = known.at(at)
    return any(each.first - 0.8 <= frame <= each.last + 0.8 for each in known.touching(one, other))


def not_touched(known: Known, one: str, other: str, at: str) -> bool:
    """No contact covers the instant, but for one that ends in the same border."""
    frame, reach = known.at(at), MERGE_S * known.seen.observation.rate_hz
    return not any(
        each.first + 0.8 < frame < each.last - 0.8 and each.last - frame > reach
        for each in known.touching(one, other)
    )


def moved(known: Known, what: str, distance: str, first: str, last: str) -> bool:
    begin, end = known.at(first), known.at(last)
    overlapping = any(each.first < end and each.last > begin for each in known.moving(what))
    if not distance:
        return overlapping
    track = known.capture.tag_object(name(what)).stream.positions
    way = np.linalg.norm(track[round(end)] - track[round(begin)])
    return overlapping and abs(way - float(distance)) < 0.02


def stayed(known: Known, what: str, first: str, last: str) -> bool:
    """What motion there is lies in a merged border."""
    begin, end = known.at(first), known.at(last)
    reach = MERGE_S * known.seen.observation.rate_hz
    return all(min(each.last, end) - max(each.first, begin) <= reach for each in known.moving(what))


def measured_contact(known: Known, one: str, other: str, first: str, last: str) -> bool:
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.touching(one, other)
    )


def measured_motion(known: Known, what: str, first: str, last: str) -> bool:
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.moving(what)
    )


def possessed(known: Known, one: str, other: str, since: str) -> bool:
    return any(
        near(each.first, known.at(since))
        and any(
            motion.first <= each.last and motion.last >= each.first
            for motion in known.moving(other)
        )
        for each in known.touching(one, other)
    )


def begins(known: Known, one: str, other: str, at: str) -> bool:
    return any(near(each.first, known.at(at)) for each in known.touching(one, other))


def ends(known: Known, one: str, other: str, at: str) -> bool:
    return any(near(each.last, known.at(at)) for each in known.touching(one, other))


def starts(known: Known, what: str, at: str) -> bool:
    return any(near(each.first, known.at(at)) for each in known.moving(what))


def stops(known: Known, what: str, at: str) -> bool:
    return any(near(each.last, known.at(at)) for each in known.moving(what))


def tagged(known: Known, what: str, kind: str) -> bool:
    return Tag(name(what), kind) in known.facts


def rested(known: Known, what: str, first: str, last: str) -> bool:
    begin, end = known.at(first), known.at(last)
    rests = [each for each in known.facts if isinstance(each, Resting) and each.ee == name(what)]
    hand = [each for each in known.facts if isinstance(each, Touching) and each.body == name(what)]
    free = all(each.last < begin + 0.8 or each.first > end - 0.8 for each in hand)
    return free and any(each.first <= begin + 0.8 and each.last >= end - 0.8 for each in rests)


def turned_from_rest(known: Known, what: str, at: str) -> bool:
    rests = [each for each in known.facts if isinstance(each, Resting) and each.ee == name(what)]
    return any(near(frame, known.at(at)) for each in rests for frame in (each.first, each.last))


def turned_back(known: Known, what: str, at: str) -> bool:
    turns = [each for each in known.facts if isinstance(each, Reverses)]
    return any(each.object == name(what) and near(each.frame, known.at(at)) for each in turns)


def rose(known: Known, what: str) -> bool:
    return way(known, what)[2] >= 45 and way(known, what)[2] >= np.hypot(*way(known, what)[:2]) - 5


def sank(known: Known, what: str) -> bool:
    return way(known, what)[2] <= -45


def way(known: Known, what: str) -> tuple[int, int, int]:
    """Displacement within the segment [mm]."""
    where = {
        each.frame: np.array([each.x, each.y, each.z])
        for each in known.facts
        if isinstance(each, Place) and each.body == name(what)
    }
    return tuple(where[known.segment.last] - where[known.segment.first])


def at_end(known: Known, what: str, other: str, side: str) -> bool:
    at = known.segment.start_s if side == "start" else known.segment.end_s
    return touched(known, what, other, f"{at:.3f}")


def high(known: Known, what: str, height: str, at: str) -> bool:
    return any(
        isinstance(each, Place)
        and each.body == name(what)
        and near(each.frame, known.at(at))
        and each.z == int(height)
        for each in known.facts
    )


def went_away(known: Known) -> bool:
    """The horizontal way of the object points from the hand to it."""
    start = {
        each.body: np.array([each.x, each.y])
        for each in known.facts
        if isinstance(each, Place) and each.frame == known.segment.first
    }
    what = known.segment.objects[0]
    ahead = start[what] - start[known.segment.ee]
    return float(ahead @ np.array(way(known, what)[:2])) > 0


def leant(known: Known, what: str) -> bool:
    stands = {
        each.frame: each.lean
        for each in known.facts
        if isinstance(each, Posture) and each.body == name(what)
    }
    change = stands[known.segment.last] - stands[known.segment.first]
    return abs(change) >= np.radians(19.0) * 1000.0


def borders(known: Known, first: str, last: str) -> bool:
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.seen.observation.segments
    )


def features(known: Known, start: str, end: str, change: str, force: str) -> bool:
    found = known.segment.features
    return (found.rel_start, found.rel_end, found.change_loc, found.force) == (
        start, end, change, force,
    )  # fmt: skip


def named(known: Known, what: str) -> bool:
    return what == known.segment.name or what in known.segment.general


def listed(known: Known, what: str, place: str) -> bool:
    return known.segment.objects.index(name(what)) == (0 if place == "dominant" else 1)


def row(known: Known, what: str, start: str, end: str, change: str, force: str) -> bool:
    return named(known, what) and features(known, start, end, change, force)


def rested_on(known: Known, other: str) -> bool:
    return any(touched(known, known.segment.objects[0], other, f"{time:.2f}")
               for time in (known.segment.start_s, known.segment.end_s))  # fmt: skip


def no_support(known: Known, other: str) -> bool:
    """It moves on it, or came to it only after the hand came."""
    dominant = known.segment.objects[0]
    contacts = known.touching(dominant, other)
    own = known.touching(known.segment.ee, dominant)
    started_later = any(each.first >= min(one.first for one in own) for each in contacts)
    return started_later or "1" in known.segment.features.change_loc


def held_by(known: Known, one: str) -> bool:
    """The other end-effector touches the object for a while within the segment."""
    return any(
        min(each.last, known.segment.last) > max(each.first, known.segment.first)
        for each in known.touching(one, known.segment.objects[0])
    )


def changes(known: Known, side: str) -> bool:
    """The object's motion begins, ends or turns, or a contact of it does, near the border."""
    border = known.segment.first if side == "begin" else known.segment.last
    what, reach = known.segment.objects[0], MERGE_S * known.seen.observation.rate_hz
    frames = {frame for each in known.moving(what) for frame in (each.first, each.last)}
    frames |= {
        frame
        for each in known.facts
        if isinstance(each, Touching) and each.body == what
        for frame in (each.first, each.last)
    }
    frames |= {
        each.frame for each in known.facts if isinstance(each, Reverses) and each.object == what
    }
    return any(abs(each - border) <= reach for each in frames)


def measured_look(known: Known, who: str, what: str, first: str, last: str) -> bool:
    return any(
        (each.sensor, each.object) == (name(who), name(what))
        and near(each.first, known.at(first))
        and near(each.last, known.at(last))
        for each in known.facts
        if isinstance(each, LookingAt)
    )


def looked(known: Known, what: str, when: str) -> bool:
    spans = [
        (each.first, each.last)
        for each in known.facts
        if isinstance(each, LookingAt) and each.object == name(what)
    ]
    one = known.segment
    start, end = (
        [each for each in spans if each[0] <= frame <= each[1]] for frame in (one.first, one.last)
    )
    if when == "throughout":
        return bool(set(start) & set(end))
    if when == "in between":
        return any(one.first < each[0] and each[1] < one.last for each in spans)
    if when == "before the segment":
        mine = [each for each in known.seen.observation.segments if each.ee == one.ee]
        earlier = mine[one.index - 1]
        return not start and any(each[0] < one.first and each[1] >= earlier.first for each in spans)
    return bool(start if when == "when the segment began" else end)


def rolled(known: Known, what: str) -> bool:
    """The can's turn about its axis is its way over its radius."""
    stream = known.capture.tag_object(name(what)).stream
    ends = [known.segment.first, known.segment.last]
    way = np.linalg.norm(np.diff(stream.positions[ends], axis=0))
    turn = 2.0 * np.arccos(abs(float(np.prod(stream.orientations[ends], axis=0).sum())))
    return abs(turn - way / CAN[0]) < 0.05


def measured_rolling(known: Known, what: str, first: str, last: str) -> bool:
    return any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.facts
        if isinstance(each, Rolls) and each.object == name(what)
    )


S, N = r"(\d+\.\d\d) s", r"([\w ]+?)"
SENTENCES: tuple[tuple[str, Callable[..., bool]], ...] = (
    (rf"the {N} touched the {N} for the last time at {S}", ends),
    (rf"the {N} touched the {N} at {S}", touched),
    (rf"no contact of the {N} with the {N} counted at {S}", not_touched),
    (rf"the {N} moved(?: (\d+\.\d\d) m)? between {S} and {S}", moved),
    (rf"the {N} stayed where it was between {S} and {S}", stayed),
    (rf"contact of the {N} with the {N} was measured from {S} to {S}", measured_contact),
    (rf"motion of the {N} was measured from {S} to {S}", measured_motion),
    (rf"rolling of the {N} was measured from {S} to {S}", measured_rolling),
    (rf"the {N} turned as it went, without slipping", rolled),
    (rf"the {N} looked at the {N} from {S} to {S}", measured_look),
    (rf"the {N} was looked at (throughout|when the segment (?:began|ended)|in between|"
     r"before the segment)", looked),
    (rf"the {N} possessed the {N}, as it moved in the contact that began at {S}", possessed),
    (rf"the {N} began to touch the {N} at {S}", begins),
    (rf"the {N} started to move at {S}", starts),
    (rf"the {N} stopped at {S}", stops),
    (r"the ([\w ]+) is (mobile|fixed|self)", tagged),
    (rf"the {N} rested and touched nothing from {S} to {S}", rested),
    (rf"the {N} rested from {S} to {S}", rested),
    (rf"the {N} (?:came to rest|began to move) at {S}", turned_from_rest),
    (rf"the {N} turned back at {S}", turned_back),
    (rf"the {N} went up, more than aside", rose),
    (rf"the {N} came down", sank),
    (rf"the {N} was (\d+) mm high at {S}", high),
    (r"the object went away from the end-effector", went_away),
    (rf"the {N} (?:lay on|leant against) the {N} at the segment's (start|end)", at_end),
    (rf"the {N} leant otherwise at the end", leant),
    (rf"the segment lies between {S} and {S}", borders),
    (r"the relations are ?(\d*) at the start and ?(\d*) at the end, change of location is ?(\d*), "
     r"force is ?(\d*)", features),
    (r"it is one action with what the ([\w ]+) does to the same object", held_by),
    (r"both segments (begin|end) with the same change of the object", changes),
    (r"it is (\w+)", named),
    (r"its features are those of (\w+)", named),
    (r"nothing that fits is more specific than (\w+)", named),
    (rf"the {N} is its (dominant|subordinate) object", listed),
    (r"(\w+) is known by the features (\d+), (\d+), (\d+) and (\d+)", row),
    (r"the possessed object rested on the ([\w ]+), which it did before the hand came", rested_on),
    (r"the ([\w ]+) was no mere support", no_support),
    (rf"the {N} moved while the {N} touched it, from {S} on",
     lambda known, what, one, since: possessed(known, one, what, since)),
)  # fmt: skip
"""Each form of sentence, and how it is recomputed from facts, segments and the capture."""


@pytest.fixture(scope="module", params=sorted(CAPTURES))
def trial(request):
    motion, performer = CAPTURES[request.param]
    capture = motion(performer).capture
    return capture, explained(capture, rules=profile()), extract(capture).facts


def test_every_sentence_of_every_segment_is_true(trial):
    capture, seen, facts = trial
    told = 0
    for segment in seen.observation.segments:
        known = Known(seen, facts, segment, capture)
        for reason in seen.explainer.explain(segment).reason.told().walk():
            check, arguments = form(reason.sentence)
            assert check(known, *arguments), f"{segment.ee}/{segment.index}: {reason.sentence}"
            told += 1
    assert told > 10 * len(seen.observation.segments)


def form(sentence: str) -> tuple[Callable[..., bool], tuple[str, ...]]:
    for pattern, check in SENTENCES:
        found = re.fullmatch(pattern, sentence)
        if found:
            return check, found.groups(default="")
    raise AssertionError(f"no recomputation of the sentence {sentence!r}")


def test_every_leaf_with_a_time_is_linked_to_its_frames(trial):
    _, seen, facts = trial
    stretches = Touching | Moving | Rolls
    frames = {(each.first, each.last) for each in facts if isinstance(each, stretches)}
    for segment in seen.observation.segments:
        for reason in seen.explainer.explain(segment).reason.told().walk():
            if "was measured from" in reason.sentence:
                assert reason.frames in frames


def test_the_summary_names_the_segment_and_its_reasons(trial):
    _, seen, _ = trial
    for segment in seen.observation.segments:
        found = seen.explainer.explain(segment)
        assert found.summary.startswith(
            f"{segment.name}, because the "
        ) or found.summary.startswith(f"{segment.name}, because no ")
        assert found.summary.endswith(".")


def test_what_is_asked_of_the_solver_does_not_grow_with_the_capture():
    capture = motions.touch_cycle(motions.TALL_MAN).capture
    facts = extract(capture).facts
    sizes = []
    for copies in (1, 40):
        longer = repeated(facts, copies)
        rules = profile()
        explainer = Explainer(longer, profile=rules)
        segments = infer(longer, profile=rules).links[0].segments
        touch = next(each for each in segments if each.name == "Touch")
        assert explainer.explain(touch).name == "Touch"
        sizes.append(len(next(iter(explainer.windows_of(touch.ee, explainer.ticks(touch))))))
    assert sizes[1] <= sizes[0] + 20


def repeated(facts: tuple[Fact, ...], copies: int) -> tuple[Fact, ...]:
    """The same trial again and again, one after the other."""
    length = next(each.last for each in facts if isinstance(each, Frames)) + 1
    out: set[Fact] = {Frames(0, copies * length - 1)}
    for fact in facts:
        if isinstance(fact, Frames):
            continue
        keys = [key for key in ("first", "last", "frame") if hasattr(fact, key)]
        shifts = range(copies) if keys else (0,)
        out |= {
            replace(fact, **{key: getattr(fact, key) + copy * length for key in keys})
            for copy in shifts
            if not (isinstance(fact, Touching) and fact.body == "box" and copy)
        }
    box = next(each for each in facts if isinstance(each, Touching) and each.body == "box")
    out.discard(box)
    out.add(replace(box, last=copies * length - 1))
    return tuple(sorted(out, key=lambda each: (type(each).predicate, each)))


def test_an_unknown_segment_is_told_how_far_it_agreed():
    capture = motions.slide_object(motions.TALL_MAN).capture
    seen = explained(capture, rules=profile("thesis"))
    facts = [each for each in extract(capture).facts if not isinstance(each, ZeroCrossing)]
    crossings = [ZeroCrossing("right_hand", frame) for frame in (0, 227)]
    rules = profile("thesis")
    links = infer((*facts, *crossings), profile=rules).links
    unknown = [each for each in links[0].segments if not each.known]
    explainer = Explainer((*facts, *crossings), profile=rules)
    assert seen.observation.segments
    for segment in unknown:
        assert explainer.explain(segment).summary.startswith("Unknown, because")
