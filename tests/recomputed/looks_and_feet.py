"""Sentences about looks and about the weight on feet, recomputed from rays and positions."""

import numpy as np

from capar.model.capture import Sensor
from capar.model.facts import LookingAt, Touching
from recomputed.known import NAME, TIME, Known, covers, name, near

BORNE = 0.8
"""Share of the weight from which on a foot bears the whole [1]; the rest is none."""

SOLE_M = 0.03
"""A foot that is higher than the lower one by more than this is not down [m]."""


def sees(known: Known, who: str, what: str, frame: int) -> bool:
    """The line of sight meets the object's box, which is taken two centimetres larger."""
    (head,) = [each for each in known.capture.sensors if each.name == name(who)]
    turn, place = known.turn(who, frame), known.stream(who).positions[frame]
    back = known.turn(what, frame).inv()
    start = back.apply(place + turn.apply(head.eye) - known.stream(what).positions[frame])
    along = back.apply(turn.apply(head.gaze))
    low, high = known.shape(what).bounds + np.array([[-0.02], [0.02]])
    with np.errstate(divide="ignore"):
        enters, leaves = (low - start) / along, (high - start) / along
    entry, exit_ = np.minimum(enters, leaves).max(), np.maximum(enters, leaves).min()
    return bool(exit_ >= max(entry, 0.0))


def measured_look(known: Known, who: str, what: str, first: str, last: str) -> bool:
    found = any(
        each.sensor == name(who)
        and near(each.first, known.at(first))
        and near(each.last, known.at(last))
        for each in known.looking(what)
    )
    begin, end = known.frame(first), known.frame(last)
    return found and all(sees(known, who, what, each) for each in (begin, (begin + end) // 2, end))


def looked(known: Known, what: str, when: str) -> bool:
    """By the lines of sight at the segment's borders and in it."""
    whole = range(known.segment.first, known.segment.last + 1)
    start, end = (_seen(known, what, each) for each in (whole[0], whole[-1]))
    if when == "throughout":
        return bool(start) and all(_seen(known, what, each) for each in whole[::5])
    if when == "in between":
        return not start and not end and any(_seen(known, what, each) for each in whole)
    if when.startswith("in the segment before"):
        mine = [each for each in known.seen.observation.segments if each.ee == known.segment.ee]
        earlier = mine[known.segment.index - 1]
        return not start and any(
            _seen(known, what, each) for each in range(earlier.first, earlier.last)
        )
    return bool(start if when == "when the segment began" else end)


def _seen(known: Known, what: str, frame: int) -> list[LookingAt]:
    """The looks that cover a frame, if the line of sight does so too."""
    return [
        each
        for each in known.looking(what)
        if each.first <= frame <= each.last and sees(known, each.sensor, what, frame)
    ]


def gazed(known: Known, what: str) -> bool:
    """The end-effector itself looks at it, but for what lies in a merged border."""
    whole = range(known.segment.first, known.segment.last + 1)
    edge = min(round(known.reach), (len(whole) - 1) // 2)
    seen = [_seen(known, what, each) for each in whole[edge : len(whole) - edge]]
    return all(known.segment.ee in {each.sensor for each in looks} for looks in seen)


def began_to_look(known: Known, who: str, what: str, at: str) -> bool:
    return any(each.sensor == name(who) and near(each.first, known.at(at))
               for each in known.looking(what))  # fmt: skip


def looked_until(known: Known, who: str, what: str, at: str) -> bool:
    return any(each.sensor == name(who) and near(each.last, known.at(at))
               for each in known.looking(what))  # fmt: skip


def _feet(known: Known) -> list[Sensor]:
    return [each for each in known.capture.sensors if each.end_effector == "foot"]


def share(known: Known, foot: str, frame: int) -> float:
    """Of the weight, by where the pelvis is between the feet, and which of them is lifted [1]."""
    (other,) = [each.name for each in _feet(known) if each.name != name(foot)]
    own, others = (known.middle(each, frame) for each in (foot, other))
    if abs(own[2] - others[2]) > SOLE_M:
        return float(own[2] < others[2])
    line = (others - own)[:2]
    pelvis = (known.middle("pelvis", frame) - own)[:2]
    return 1.0 - float(np.clip(pelvis @ line / (line @ line), 0.0, 1.0))


def _bears(known: Known, foot: str, how: str, first: int, last: int) -> bool:
    shares = np.array([share(known, foot, each) for each in range(first, last + 1, 3)])
    if how == "whole":
        return bool((shares >= BORNE - 0.02).all())
    return bool((shares <= 1.0 - BORNE + 0.02).all())


def bore_whole(known: Known) -> bool:
    return _bears(known, known.segment.ee, "whole", known.segment.first, known.segment.last)


def bore_none(known: Known) -> bool:
    return _bears(known, known.segment.ee, "none", known.segment.first, known.segment.last)


def of_a_foot(known: Known, what: str) -> bool:
    """The capture says that it is a foot, or a part of one."""
    kinds = [each.ee for each in known.seen.observation.links if each.kind == "foot"]
    return known.segment.ee in kinds and name(what) == known.segment.ee


def nothing_says(known: Known, foot: str) -> bool:
    """With one foot tracked nothing can be said, and with two it was lifted or bore something."""
    spans = [each for each in known.of(Touching) if each.body == known.segment.ee]
    ends = (known.segment.first, known.segment.last)
    down = all(any(covers(each, frame) for each in spans) for frame in ends)
    return name(foot) == known.segment.ee and (
        len(_feet(known)) < 2 or not down or not bore_none(known)
    )


def measured_whole(known: Known, foot: str, first: str, last: str) -> bool:
    return _bears(known, foot, "whole", known.frame(first), known.frame(last))


def measured_none(known: Known, foot: str, first: str, last: str) -> bool:
    return _bears(known, foot, "none", known.frame(first), known.frame(last))


def shifted(known: Known, foot: str, at: str) -> bool:
    """Shortly before the instant it bore less, or more, than shortly after."""
    frame, side = known.frame(at), round(0.06 * known.rate)
    return abs(share(known, foot, frame + side) - share(known, foot, frame - side)) > 0.05


FORMS = (
    (rf"the {NAME} looked at the {NAME} from {TIME} to {TIME}", measured_look),
    (
        rf"the {NAME} was looked at (throughout|when the segment (?:began|ended)|in between|"
        r"in the segment before this one, and no longer when this one began)",
        looked,
    ),
    (rf"the {NAME} was looked at", gazed),
    (rf"the {NAME} began to look at the {NAME} at {TIME}", began_to_look),
    (rf"the {NAME} still looked at the {NAME} at {TIME}", looked_until),
    (r"the foot bore the whole weight of the body", bore_whole),
    (r"the foot bore no weight", bore_none),
    (rf"no measured weight shows that the {NAME} bore none", nothing_says),
    (rf"the {NAME} counts as the foot", of_a_foot),
    (
        rf"the {NAME} bore the whole weight, as far as feet tell, from {TIME} to {TIME}",
        measured_whole,
    ),
    (
        rf"the {NAME} was down and bore no weight, as far as feet tell, from {TIME} to {TIME}",
        measured_none,
    ),
    (rf"the weight on the {NAME} shifted at {TIME}", shifted),
)
