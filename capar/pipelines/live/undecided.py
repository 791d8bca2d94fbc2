"""From which frame on later frames may yet decide what an end-effector does."""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

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

    lost: Mapping[str, int] = field(default_factory=dict)
    """Of each body that is not seen now, the last frame in which it was."""

    @property
    def sure(self) -> int:
        """The last frame before which no contact ends, and no motion, for not being seen."""
        oldest = self.last - self.longest
        return min((since - 1 for since in self.lost.values() if since > oldest), default=self.last)

    def with_margin(self, since: Mapping[str, int]) -> dict[str, int]:
        """Frames so much earlier that no event of those at them is before."""
        return {ee: frame - self.margin for ee, frame in since.items()}


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
    for body, since in out_of_sight(handling).items():
        out[body] = min(since, out.get(body, since))
    return out


def awaited(handling: Handling) -> dict[str, int]:
    """The things whose first motion decides, and the frame at which each is touched first."""
    out: dict[str, int] = {}
    for own in _going(handling):
        if _besides(handling, own):
            out[own.other] = min(own.first, out.get(own.other, own.first))
    return out


def out_of_sight(handling: Handling) -> dict[str, int]:
    """End-effectors in contact with what was lost since, and the frame in which it was last seen.

    If they touch when it is seen again, they have touched all the time.
    """
    out: dict[str, int] = {}
    for touch in handling.touching:
        for body in (touch.body, touch.other):
            since = handling.lost.get(body, -1)
            if touch.last >= since >= max(touch.first, handling.last - handling.longest):
                out[touch.body] = min(since, out.get(touch.body, since))
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
