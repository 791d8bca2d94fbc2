"""From which frame on later frames may yet decide what an end-effector does."""

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

from capar.model.facts import Moving, Touching


@dataclass(frozen=True, slots=True)
class Handling:
    """What end-effectors touch and what moves, up to the newest frame."""

    touching: Sequence[Touching]
    """Contacts of end-effectors."""

    moving: Sequence[Moving]
    mobile: AbstractSet[str]
    """Names of the objects that can be moved."""

    last: int
    """The newest frame."""

    margin: int
    """Frames that events of one kind are apart at most."""

    longest: int
    """How many frames a decision is awaited at most."""


def undecided(handling: Handling) -> dict[str, int]:
    """The first frame of each end-effector about which something is still open."""
    out: dict[str, int] = {}
    for own in _going(handling):
        besides = _besides(handling, own)
        if besides or _is_shared(handling, own):
            first = min(
                own.first, *(touch.first for touch in besides), out.get(own.body, own.first)
            )
            out[own.body] = first
    return out


def _going(handling: Handling) -> list[Touching]:
    """The contacts with things that can be moved that go on."""
    return [
        touch
        for touch in handling.touching
        if touch.other in handling.mobile and touch.last >= handling.last - handling.margin
    ]


def _is_shared(handling: Handling, own: Touching) -> bool:
    """Whether somebody else has held the thing before.

    Who takes it over is known once one of the two lets go of it, or is taken not to.
    """
    joined = any(
        touch.other == own.other
        and touch.body != own.body
        and touch.first < own.first - handling.margin
        for touch in _going(handling)
    )
    return joined and handling.last - own.first <= handling.longest


def _besides(handling: Handling, own: Touching) -> list[Touching]:
    """What is touched beside a thing that has not moved yet.

    Once it moves, the hand has possessed it from the first, and its other contacts do not count;
    for some time it is awaited that it does.
    """
    if any(move.object == own.other and move.last >= own.first for move in handling.moving):
        return []
    return [
        touch
        for touch in handling.touching
        if touch.body == own.body
        and touch.other != own.other
        and touch.last >= own.first
        and handling.last - max(own.first, touch.first) <= handling.longest
    ]
