"""Sentences about blows, and about other end-effectors and agents."""

import numpy as np

from capar.model.facts import Touching
from recomputed.known import NAME, ROUNDED, Known, covers, name

BLOW_MPS = 1.0
"""Whoever means to touch has slowed down to less than this [m/s]."""


def met_fast(known: Known, what: str) -> bool:
    """The speed at which the bodies close in over the last hundredths of a second before."""
    begin = min(
        each.first
        for each in known.touching(known.segment.ee, what)
        if abs(each.first - known.segment.last) <= known.reach
    )
    before = max(begin - 3, 0)
    own, others = (
        known.middle(each, begin) - known.middle(each, before) for each in (known.segment.ee, what)
    )
    return bool(np.linalg.norm(own - others) * known.rate / (begin - before) >= 0.9 * BLOW_MPS)


def _own(known: Known, what: str) -> list[Touching]:
    return known.touching(known.segment.ee, what)


def _others(known: Known, what: str, frame: float) -> list[str]:
    """Which other end-effectors touch it then."""
    return [
        each.body
        for each in known.of(Touching)
        if each.other == what
        and each.body != known.segment.ee
        and each.body in {sensor.name for sensor in known.capture.sensors}
        and each.first - ROUNDED <= frame <= each.last + ROUNDED
    ]


def _taken_from(known: Known) -> list[str]:
    """Who has the object when this one begins to touch it, and lets go of it first."""
    what = known.segment.objects[0]
    (own,) = [each for each in _own(known, what)
              if abs(each.first - known.segment.last) <= known.reach]  # fmt: skip
    return [other for other in _others(known, what, own.first)
            if all(each.last < own.last for each in known.touching(other, what)
                   if covers(each, own.first))]  # fmt: skip


def _left_to(known: Known) -> list[str]:
    """Who has the object when this one leaves it, and took it later."""
    what = known.segment.objects[0]
    (own,) = [each for each in _own(known, what)
              if abs(each.last - known.segment.first) <= known.reach]  # fmt: skip
    return [other for other in _others(known, what, own.last)
            if all(each.first > own.first for each in known.touching(other, what)
                   if covers(each, own.last))]  # fmt: skip


def agent(known: Known, what: str) -> str:
    (body,) = [each for each in known.capture.sensors if each.name == name(what)]
    return known.capture.agent_of(body)


def another_had(known: Known, other: str) -> bool:
    return name(other) in _taken_from(known)


def another_took(known: Known, other: str) -> bool:
    return name(other) in _left_to(known)


def stranger_had(known: Known) -> bool:
    mine = agent(known, known.segment.ee)
    return any(agent(known, each) != mine for each in _taken_from(known))


def stranger_took(known: Known) -> bool:
    mine = agent(known, known.segment.ee)
    return any(agent(known, each) != mine for each in _left_to(known))


def belongs(known: Known, what: str, who: str) -> bool:
    return agent(known, what) == name(who)


def different(known: Known, one: str, other: str) -> bool:
    return agent(known, one) != agent(known, other)


def joined(known: Known, other: str) -> bool:
    """The other end-effector touches the object for a while within the segment."""
    return any(
        min(each.last, known.segment.last) > max(each.first, known.segment.first)
        for each in known.touching(other, known.segment.objects[0])
    )


def force_passes(known: Known) -> bool:
    return known.capture.force_transfer


def tagged(known: Known, what: str, kind: str) -> bool:
    return known.capture.tag_object(name(what)).tag == kind


FORMS = (
    (rf"the {NAME} was met at a high speed", met_fast),
    (rf"the {NAME} had the object by then", another_had),
    (rf"the {NAME} had taken the object by then", another_took),
    (r"it was another agent who had it", stranger_had),
    (r"it was another agent who had taken it", stranger_took),
    (rf"the {NAME} belongs to {NAME}", belongs),
    (rf"the {NAME} and the {NAME} are of different agents", different),
    (rf"it is one action with what the {NAME} does to the same object", joined),
    (r"force passes to objects in this trial, as its user says", force_passes),
    (rf"the {NAME} is (mobile|fixed|self)", tagged),
)
