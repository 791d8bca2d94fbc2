"""Sentences about features and names: relations from contacts, names as authors wrote them."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields
from functools import cache
from importlib import resources
from pathlib import Path

from capar.model.facts import (
    Bears,
    Displaced,
    Fact,
    LookingAt,
    Moving,
    Phase,
    Resting,
    Reverses,
    Seated,
    Touching,
    ZeroCrossing,
)
from capar.model.par import UNKNOWN
from recomputed.known import NAME, TIME, Known, near
from recomputed.others import met_fast

Row = tuple[str, str, str, str]

PUBLISHED: dict[str, tuple[Row, ...]] = {
    "Reach": (("0", "1", "0", "0"),),
    "Hit": (("0", "1", "0", "1"),),
    "Touch": (("1", "1", "0", "0"),),
    "TouchWith": (("101", "101", "00", "00"),),
    "MoveObj": (("101", "101", "10", "00"),),
    "MoveObjTo": (("100", "101", "10", "00"),),
    "ResumePosture": (("1", "0", "0", "0"),),
}
"""The feature table of the thesis (Fig 4.15)."""

FURTHER: dict[str, tuple[Row, ...]] = {
    "Reach": (("0", "1", "1", "0"),),
    "Hit": (("0", "1", "1", "1"),),
    "TouchWith": (("101", "101", "01", "00"),),
    "MoveObj": (("1", "1", "1", "0"), ("101", "101", "11", "00")),
    "MoveObjTo": (("100", "101", "11", "00"),),
    "ResumePosture": (("1", "0", "1", "0"),),
}
"""What the extended profile adds to it: of one object, and of what moves itself."""

CHANGES = (
    *(Touching, Moving, Displaced, Resting, Reverses, LookingAt, Bears, ZeroCrossing),
    *(Phase, Seated),
)
"""Measurements whose begin or end may be a border."""


def table(known: Known) -> dict[str, tuple[Row, ...]]:
    if known.thesis:
        return PUBLISHED
    return {each: PUBLISHED[each] + FURTHER.get(each, ()) for each in PUBLISHED}


def own_borders(known: Known, first: str, last: str) -> bool:
    """The segment lies there, and at either end something changes, or the capture ends."""
    own = near(known.segment.first, known.at(first)) and near(known.segment.last, known.at(last))
    return own and borders(known, known.segment.ee, first, last)


def borders_before(known: Known, first: str, last: str) -> bool:
    """The same of one of the same end-effector that ends where the segment begins."""
    own = near(known.segment.first, known.at(last))
    return own and borders(known, known.segment.ee, first, last)


def borders(known: Known, ee: str, first: str, last: str) -> bool:
    """A segment of that end-effector lies there, between such changes."""
    known_ends = any(
        near(each.first, known.at(first)) and near(each.last, known.at(last))
        for each in known.seen.observation.segments
        if each.ee == ee.replace(" ", "_")
    )
    return known_ends and all(_changes(known, known.at(each)) for each in (first, last))


def _changes(known: Known, frame: float) -> bool:
    ends = (0, len(known.capture.times) - 1)
    return any(near(mark, frame) for mark in (*ends, *_all_marks(known.facts)))


@cache
def _all_marks(facts: tuple[Fact, ...]) -> frozenset[int]:
    return frozenset(mark for fact in facts for mark in _marks(fact))


def _marks(fact: object) -> Iterable[int]:
    if isinstance(fact, CHANGES):
        for field in fields(fact):
            if field.name in ("first", "last", "frame"):
                yield getattr(fact, field.name)


def features(known: Known, *strings: str) -> bool:
    """Each bit of the four strings, from contacts and motions around the borders."""
    return _features_of(known, known.segment.objects, *strings)


def core(known: Known, *strings: str) -> bool:
    """The same of the first object alone, or of it and one other, where the hand has several."""
    first, *others = known.segment.objects
    chosen = [(first,), *((first, other) for other in others)]
    several = sum(_held(known, each) for each in known.segment.objects) > 1
    return several and any(_features_of(known, objects, *strings) for objects in chosen)


def _held(known: Known, what: str) -> bool:
    """The end-effector touches it in the middle of the segment."""
    middle = (known.segment.first + known.segment.last) // 2
    spans = known.touching(known.segment.ee, what)
    return any(each.first <= middle <= each.last for each in spans)


def accompanied(known: Known, hand: str) -> bool:
    """The end-effector is that one, and has several in the middle of the segment."""
    several = sum(_held(known, each) for each in known.segment.objects) > 1
    return several and hand.replace(" ", "_") == known.segment.ee


def _core_of(known: Known, _: str, hand: str, *strings: str) -> bool:
    if not accompanied(known, hand):
        return False
    first, *others = known.segment.objects
    if not any("something else" in each for each in strings):
        return core(known, *_strings(known, (first,), strings))
    named = [[each.replace("something else", one) for each in strings] for one in others]
    return any(
        core(known, *_strings(known, (first, one), each))
        for one, each in zip(others, named, strict=True)
    )


def _features_of(known: Known, objects: tuple[str, ...], *strings: str) -> bool:
    start, end, change, force = strings
    pairs = [(known.segment.ee, each) for each in objects]
    pairs += [(objects[0], each) for each in objects[1:]]
    if [len(each) for each in strings] != [max(len(pairs), 0)] * 2 + [len(objects)] * 2:
        return False
    sides = ((start, known.segment.first), (end, known.segment.last))
    related = all(
        _related(known, pair, frame, bit == "1")
        for bits, frame in sides
        for pair, bit in zip(pairs, bits, strict=True)
    )
    changed = all(_moves(known, each, bit == "1")
                  for each, bit in zip(objects, change, strict=True))  # fmt: skip
    forced = all(_forced(known, each, bit == "1")
                 for each, bit in zip(objects, force, strict=True))  # fmt: skip
    return related and changed and forced


def _related(known: Known, pair: tuple[str, str], frame: int, holds: bool) -> bool:
    """Around the border they touch at some frame, or at some frame do not."""
    first, last = frame - known.reach, frame + known.reach
    spans = known.touching(*pair)
    if holds:
        return any(each.first <= last and each.last >= first for each in spans)
    low, high = max(first, 0.0), min(last, len(known.capture.times) - 1.0)
    return not any(each.first <= low and each.last >= high for each in spans)


def _moves(known: Known, what: str, moves: bool) -> bool:
    """It is mobile and moves in the segment; what else moves lies in a merged border."""
    first, last = known.segment.first, known.segment.last
    shared = [min(each.last, last) - max(each.first, first) for each in known.moving(what)]
    mobile = known.capture.tag_object(what).tag == "mobile"
    if moves:
        return mobile and max(shared, default=0) > 0
    return not mobile or max(shared, default=0) <= known.reach


def _forced(known: Known, what: str, forced: bool) -> bool:
    """Force passes where a contact begins, fast or since the user says so."""
    begins = any(
        abs(each.first - known.segment.last) <= known.reach
        for each in known.touching(known.segment.ee, what)
    )
    if forced:
        return begins and (known.capture.force_transfer or met_fast(known, what))
    return not (begins and known.capture.force_transfer)


LIST = r"([\w ,]+)"


def features_in_words(known: Known, listed: str, *told: str) -> bool:
    """The pairs and things that are listed, and no others, touch, move and are hit."""
    bodies = [each.replace("_", " ") for each in (known.segment.ee, *known.segment.objects)]
    if re.split(r", | and ", listed.replace("the ", "")) != bodies:
        return False
    return features(known, *_strings(known, known.segment.objects, told))


def _strings(known: Known, objects: Sequence[str], told: Sequence[str]) -> list[str]:
    """The four strings of bits that lists of pairs and of things say of these objects.

    Raises:
        ValueError: They list something else.
    """
    names = [each.replace("_", " ") for each in objects]
    hand = known.segment.ee.replace("_", " ")
    pairs = [f"{hand} with {each}" for each in names]
    pairs += [f"{names[0]} with {each}" for each in names[1:]]
    lists = [[] if each == "nothing" else each.split(", ") for each in told]
    if not all({*each} <= {*pairs, *names} for each in lists):
        raise ValueError(told)
    return [
        "".join(str(int(one in each)) for one in every)
        for each, every in zip(lists, (pairs, pairs, names, names), strict=True)
    ]


def defined(known: Known, what: str) -> bool:
    """Contacts and motions are those of a row that the table has of the name."""
    if known.segment.name == UNKNOWN:
        return what in table(known)
    rows = table(known)[what]
    return any(features(known, *each) or core(known, *each) for each in rows)


def written(known: Known, what: str) -> bool:
    """The author of the motion wrote the segment's name, which is that one or a more special one.

    Nobody writes down who rests before or after: rests are left out on both sides.
    """
    plan = [each for each in known.steps[known.segment.ee] if each != "Rest"]
    mine = [each for each in known.seen.observation.segments
            if each.ee == known.segment.ee and each.name != "Rest"]  # fmt: skip
    names = (known.segment.name, *known.segment.general)
    if known.segment.name == "Rest":
        return what in names
    place = [each.index for each in mine].index(known.segment.index)
    return len(plan) == len(mine) and plan[place] == known.segment.name and what in names


def fits(known: Known, what: str) -> bool:
    """It is so written, and where the table has the name, a row of it is the segment's own.

    Of several objects at a time no row speaks: of them what moves and what is touched counts.
    """
    found = known.segment.features
    own = (found.rel_start, found.rel_end, found.change_loc, found.force)
    rows = table(known).get(what)
    if not written(known, what):
        return False
    several = any(core(known, *each) for each in rows or ())
    return rows is None or own in rows or several or _passes_on(known, what)


def _passes_on(known: Known, what: str) -> bool:
    """A reach from one thing to another: it touches one at the start, and another at the end."""
    spans = [each for each in known.of(Touching) if each.body == known.segment.ee]
    ends = [
        {each.other for each in spans if _around(known, each, frame)}
        for frame in (known.segment.first, known.segment.last)
    ]
    return what == "Reach" and bool(ends[1] - ends[0])


def _around(known: Known, each: Touching, frame: int) -> bool:
    return each.first <= frame + known.reach and each.last >= frame - known.reach


def overruled_by_none(known: Known, what: str) -> bool:
    return what == known.segment.name and written(known, what)


def kept_from(known: Known, what: str) -> bool:
    """What the author wrote is more general than the told name, and not that name."""
    own = known.segment.name
    return own != what and own in _generals(what) and written(known, own)


@cache
def _generals(what: str) -> frozenset[str]:
    """The primitives that one specialises, as the files of primitives declare."""
    folder = Path(str(resources.files("capar_rules") / "primitives"))
    text = "\n".join(each.read_text() for each in sorted(folder.glob("*.lp")))
    declared = re.findall(r'^specialises\("(\w+)", "(\w+)"\)\.', text, flags=re.MULTILINE)
    found = {what}
    while wider := {general for one, general in declared if one in found} - found:
        found |= wider
    return frozenset(found - {what})


def listed(known: Known, what: str) -> bool:
    """The end-effector touches it at a border, or looks at it and touches nothing."""
    held = any(
        each.first <= frame + known.reach and each.last >= frame - known.reach
        for each in known.touching(known.segment.ee, what)
        for frame in (known.segment.first, known.segment.last)
    )
    return held or any(each.sensor == known.segment.ee for each in known.looking(what))


def subordinate(known: Known, what: str) -> bool:
    """The object that the end-effector has touches it where the segment ends."""
    return any(
        each.first <= known.segment.last + known.reach
        and each.last >= known.segment.last - known.reach
        for each in known.touching(known.segment.objects[0], what)
    )


def changes_alike(known: Known, side: str) -> bool:
    """The object's motion begins, ends or turns, or a contact of it does, near the border."""
    border = known.segment.first if side == "begin" else known.segment.last
    what = known.segment.objects[0]
    frames = {frame for each in known.moving(what) for frame in (each.first, each.last)}
    frames |= {
        frame
        for each in known.of(Touching)
        if each.body == what
        for frame in (each.first, each.last)
    }
    frames |= {each.frame for each in known.of(Reverses) if each.object == what}
    for kind in (Displaced, Phase):
        for each in known.of(kind):
            frames |= {each.first, each.last} if each.object == what else set()
    return any(abs(each - border) <= known.reach for each in frames)


def _agreeing(known: Known, level: int) -> set[str]:
    """Names with a row whose first so many features are the segment's own."""
    found = known.segment.features
    own = (found.rel_start, found.rel_end, found.change_loc, found.force)
    assert features(known, *own)
    return {
        each
        for each, rows in table(known).items()
        if any(row[:level] == own[:level] for row in rows)
    }


def parted(known: Known, level: str) -> bool:
    """Some row agrees above the level, and none down to it."""
    unknown = known.segment.name == UNKNOWN and not _agreeing(known, 4)
    above = int(level) == 1 or bool(_agreeing(known, int(level) - 1))
    return unknown and above and not _agreeing(known, int(level))


def agrees(known: Known, what: str, level: str) -> bool:
    return what in _agreeing(known, int(level))


def nearest(known: Known, what: str) -> bool:
    deepest = max(level for level in range(4) if level == 0 or _agreeing(known, level))
    return what in _agreeing(known, deepest)


FORMS: tuple[tuple[str, Callable[..., bool]], ...] = (
    (rf"the segment lies between {TIME} and {TIME}", own_borders),
    (rf"the segment before this one lies between {TIME} and {TIME}", borders_before),
    (rf"(?:a|another) segment of the {NAME} lies between {TIME} and {TIME}", borders),
    (
        rf"of (the [\w ,]+), in contact at the start: {LIST}; in contact at the end: {LIST}; "
        rf"what moved: {LIST}; what the [\w ]+ itself struck: {LIST}",
        features_in_words,
    ),
    (
        rf"of (the [\w ,]+), leaving aside what else is in the {NAME}, in contact at the start: "
        rf"{LIST}; in contact at the end: {LIST}; what moved: {LIST}; what the [\w ]+ itself "
        rf"struck: {LIST}",
        _core_of,
    ),
    (rf"more than one thing was in the {NAME}", accompanied),
    (r"by these contacts and motions the rules know a (\w+)", defined),
    (r"it is (\w+)", written),
    (r"it fits (\w+)", fits),
    (r"nothing that fits is more specific than (\w+)", overruled_by_none),
    (r"it would be (\w+) but for this", kept_from),
    (rf"the segment is about the {NAME}", listed),
    (
        rf"(?:the segment before this one|an?(?:other)? segment of the [\w ]+) is about the {NAME}",
        listed,
    ),
    (rf"the {NAME} is the other object of the segment", subordinate),
    (r"both segments (begin|end) with the same change of the object", changes_alike),
    (r"it agrees with no known primitive from level (\d) of the decision tree on", parted),
    (r"up to there it agrees with (\w+)", nearest),
    (r"it agrees with (\w+) down to level (\d)", agrees),
)
