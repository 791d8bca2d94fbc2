"""Several things in one hand: the hand is led by one of them, and the others go along with it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import RigidTransform

from capar.regeneration.bearing import MOVES_M, Ride
from capar.regeneration.errors import PlanError
from capar.regeneration.holding import LOOSER, SETTLED_M, SETTLED_RAD, Hold


@dataclass(frozen=True)
class Companion:
    """A thing that lies in a hand beside another one, by which the hand is led."""

    hold: Hold
    lead: Hold

    @property
    def ride(self) -> Ride:
        """From when to when it goes along with the other one."""
        first, last = max(self.hold.first, self.lead.first), min(self.hold.last, self.lead.last)
        return Ride(self.hold.thing, self.lead.thing, first, last)


def companions_of(
    holds: tuple[Hold, ...], paths: Mapping[str, RigidTransform]
) -> tuple[Companion, ...]:
    """What is taken and moved in one hand together with another thing.

    The hand is led by the thing that it takes first; of several by the one that it holds longest,
    then by name.

    Args:
        holds: Of all hands.
        paths: ``T_world_thing`` by name at every frame.

    Raises:
        PlanError: One of two things that a hand moves together is moved without the other, too.
    """
    out: list[Companion] = []
    for hold in sorted(holds, key=lambda one: (one.first, one.first - one.last, one.thing)):
        known = {companion.hold for companion in out}
        for lead in holds:
            before = (lead.first, lead.first - lead.last, lead.thing)
            same = lead.side == hold.side and lead.thing != hold.thing and lead not in known
            if same and before < (hold.first, hold.first - hold.last, hold.thing):
                found = Companion(hold, lead)
                if _goes_along(found.ride, paths):
                    _check_together(found, paths)
                    out.append(found)
                    break
    return tuple(out)


def _goes_along(ride: Ride, paths: Mapping[str, RigidTransform]) -> bool:
    """Whether two things are moved and rigidly together meanwhile."""
    if ride.last <= ride.first:
        return False
    part = slice(ride.first, ride.last + 1)
    thing, lead = paths[ride.thing][part], paths[ride.bearer][part]
    gone = np.linalg.norm(thing.translation - thing.translation[0], axis=1)
    relative = lead.inv() * thing
    off = np.linalg.norm(relative.translation - relative.translation[0], axis=1)
    turned = (relative.rotation * relative.rotation[0].inv()).magnitude()
    steady = off.max() < LOOSER[-1] * SETTLED_M and turned.max() < LOOSER[-1] * SETTLED_RAD
    return bool(steady and gone.max() >= MOVES_M)


def _check_together(found: Companion, paths: Mapping[str, RigidTransform]) -> None:
    ride = found.ride
    for hold in (found.hold, found.lead):
        path = paths[hold.thing].translation
        for first, last in ((hold.first, ride.first), (ride.last, hold.last)):
            gone = np.linalg.norm(path[first : last + 1] - path[first], axis=1).max(initial=0.0)
            if gone >= MOVES_M:
                raise PlanError(
                    f"the {hold.side} hand moves {found.hold.thing!r} and {found.lead.thing!r} "
                    f"together, and {hold.thing!r} by {1e3 * gone:.0f} mm without the other; one "
                    "after the other is not regenerated. A part of the recording in which both "
                    "are moved would do: from_s and to_s with --assume FILE"
                )


def led_holds(holds: tuple[Hold, ...], companions: tuple[Companion, ...]) -> tuple[Hold, ...]:
    """The holds by which hands are led."""
    beside = {companion.hold for companion in companions}
    return tuple(hold for hold in holds if hold not in beside)


def hand_spans(
    holds: list[Hold], companions: tuple[Companion, ...]
) -> Iterator[tuple[Hold, frozenset[str]]]:
    """From when to when a hand has things, and which ones.

    Args:
        holds: Of one hand, in order of time.
        companions: Of all hands.
    """
    for lead in led_holds(tuple(holds), companions):
        own = [lead, *(companion.hold for companion in companions if companion.lead == lead)]
        first, last = min(hold.first for hold in own), max(hold.last for hold in own)
        things = frozenset(hold.thing for hold in own)
        yield Hold(lead.side, lead.thing, first, last), things
