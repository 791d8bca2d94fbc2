"""Who touches what: measured by geometry, and as PARs assert it (thesis 5.3.2)."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.recording import HAND_SEGMENTS
from capar.model.par import Condition
from capar.regeneration.collisions import NEAR_M, Surroundings
from capar.regeneration.motions import Motion
from capar.regeneration.quality import Gate

TOUCHES_M = 0.005
"""Bodies that are no further apart touch, half of what a free hand keeps clear [m]."""

SIDES = ("right", "left")
"""Hands are called by their side."""

HEAD = "head"
"""The performer's own part that things meet."""

Contact = tuple[str, str]
"""A hand, by its side, or a thing; and what it touches."""


@dataclass(frozen=True)
class Asserted:
    """What a step asserts at its end."""

    action: str
    frame: int
    contacts: tuple[tuple[Contact, bool], ...]
    moved: str
    """The thing that it moves; empty if none."""


@dataclass(frozen=True)
class Disagreement:
    """A contact of which the table and geometry say different things."""

    after: str
    """The action at whose end they do."""

    frame: int
    contact: Contact
    asserted: bool
    apart_m: float

    def __str__(self) -> str:
        """Both said."""
        verb = "touch" if self.asserted else "do not touch"
        far = f"{1e3 * self.apart_m:.0f} mm apart"
        if self.apart_m >= NEAR_M:
            far = f"more than {1e3 * NEAR_M:.0f} mm apart"
        who = " and ".join(self.contact)
        return f"after {self.after} {who} {verb} by the table, and are {far} by geometry"


class Measuring:
    """Distances of a motion's bodies at its frames."""

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        self.around = Surroundings(motion.plan.human, motion.plan.scene)
        self.known: dict[int, dict[Contact, float]] = {}

    def at_first(self) -> dict[Contact, bool]:
        """What touches what at the first frame: hands and things, things and what bears them."""
        scene = self.motion.plan.scene
        pairs = [(side, name) for side in SIDES for name in scene.things]
        pairs += [(name, beneath) for name in scene.things if (beneath := scene.support(name))]
        return {pair: True for pair in pairs if self.holds(pair, 0)[0]}

    def holds(self, contact: Contact, frame: int) -> tuple[bool, bool, float]:
        """Whether two bodies touch, and whether they do not, within a frame of an event.

        An event lies between two frames, so that both may be so.

        Args:
            contact: The two.
            frame: Of the event.

        Returns:
            Both, and how far they are apart at the event; at most ``NEAR_M`` [m].
        """
        last = len(self.motion.postures) - 1
        near = sorted({max(frame - 1, 0), frame, min(frame + 1, last)})
        apart = {at: self.distances(at).get(contact, NEAR_M) for at in near}
        touching = [gap <= TOUCHES_M for gap in apart.values()]
        return any(touching), not all(touching), apart[frame]

    def distances(self, frame: int) -> dict[Contact, float]:
        """Of every two bodies that are near each other, in both orders [m]."""
        if frame not in self.known:
            posture = self.motion.postures[frame]
            poses = {name: path[frame] for name, path in self.motion.plan.things.items()}
            self.known[frame] = distances(self.around, posture, poses)
        return self.known[frame]


def distances(
    around: Surroundings, posture: Float[np.ndarray, "posture"], poses: Mapping[str, RigidTransform]
) -> dict[Contact, float]:
    """How far hands, the head and things near each other are apart, in both orders [m].

    Args:
        around: The body and the things.
        posture: Of the body.
        poses: Of the things.
    """
    around.pose(posture, poses)
    found: dict[Contact, float] = {}
    for pair in [*around.near(), *around.things_near()]:
        side, _, part = pair.part.partition("_")
        first = side if part in HAND_SEGMENTS else pair.part
        for contact in ((first, pair.thing), (pair.thing, first)):
            found[contact] = min(found.get(contact, NEAR_M), pair.distance_m)
    return found


def disagreements(motion: Motion, steps: Iterable[Asserted]) -> Iterator[Disagreement]:
    """Where what steps assert is not what geometry says, at the end of each step.

    The table begins with what is measured at the first frame. A step that moves a thing leaves
    open which other things that one touches, unless it asserts it.

    Args:
        motion: What was performed.
        steps: What is asserted; steps that end at one frame do so at once.
    """
    measuring = Measuring(motion)
    table = measuring.at_first()
    for frame, ending in groupby(sorted(steps, key=_frame), key=_frame):
        for step in (ended := list(ending)):
            stale = [pair for pair in table if step.moved in pair and pair[0] not in SIDES]
            for pair in stale:
                del table[pair]
            table.update(step.contacts)
        for pair, holds in table.items():
            touch, miss, apart_m = measuring.holds(pair, frame)
            if not (touch if holds else miss):
                actions = " and ".join(dict.fromkeys(step.action for step in ended))
                yield Disagreement(actions, frame, pair, holds, apart_m)


def _frame(step: Asserted) -> int:
    return step.frame


def contact_gate(motion: Motion, steps: Iterable[Asserted]) -> Gate:
    """That the contacts that steps assert are those that geometry has."""
    found = list(disagreements(motion, steps))
    said = str(found[0]) if found else ""
    frame = found[0].frame if found else -1
    return Gate("contacts asserted", float(len(found)), 0.0, "wrong", False, frame, said)


def contacts_of(
    conditions: Iterable[Condition], names: Mapping[str, str]
) -> tuple[tuple[Contact, bool], ...]:
    """The contacts among conditions, bodies by the names that they have here.

    Args:
        conditions: Of a PAR.
        names: Of bodies here by those in the conditions; what is not in it is left out.
    """
    found = []
    for condition in conditions:
        if condition.kind == "contact" and set(condition.arguments) <= set(names):
            first, second = (names[argument] for argument in condition.arguments)
            found.append(((first, second), condition.holds))
    return tuple(found)
