"""What was measured of the bodies of a capture, as sentences need it."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from capar.model.body_names import is_plural
from capar_rules.explain.quantities import Over, Turns, Way
from capar_rules.explain.reaches import Reach

HANDS = ("hand", "index", "middle", "ring", "pinky", "thumb", "finger")
"""How kinds of end-effectors begin that are hands or parts of them."""

FEET = ("foot", "toe")
"""Kinds of end-effectors that may stand."""

Ways = Callable[[str, int, int], Way]
"""How a body moved between two frames."""

Leans = Callable[[str, int, int], float]
"""How far a body leant at most between two frames [rad]."""

TurnsBack = Callable[[str, int, int], Turns]
"""How often a body turned back between two frames."""

Heights = Callable[[str, int, int], tuple[float, float]]
"""How low and how high a body was between two frames, from where it was at the first [m]."""

Apart = Callable[[str, str, int, int], tuple[float, float] | None]
"""How far two bodies were apart at least and at most between two frames [m]; None if unmeasured."""

Places = Callable[[str, str, int], Over]
"""Where a body is to another one at a frame."""

Pair = tuple[str, str]
Pressing = tuple[int, int]
Frames = tuple[int, int]
"""First and last frame."""


def fewer_frames(least_s: float, rate_hz: float) -> str:
    """What is shorter than a time, in frames."""
    return f"fewer than {math.ceil(least_s * rate_hz - 1e-9)} frames ({least_s:.2f} s)"


@dataclass(frozen=True)
class Measured:
    """What was measured of bodies, for sentences."""

    ways: Ways | None = None
    """How bodies moved; None where that is not known."""

    moving: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the measured motions, by object."""

    displaced: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames at which objects truly left and reached a place, by object."""

    rests: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the measured rests, by end-effector."""

    places: Mapping[tuple[str, int], tuple[int, int, int]] = field(default_factory=dict)
    """Where bodies were, by name and frame [mm]."""

    postures: Mapping[tuple[str, int], tuple[int, int]] = field(default_factory=dict)
    """How far they leant and had turned about the vertical, by name and frame [1/1000 rad]."""

    names: Mapping[str, str] = field(default_factory=dict)
    """What bodies are called, where it is not their name."""

    reaches: Mapping[tuple[str, str], Reach] = field(default_factory=dict)
    """Up to which distance two bodies count as touching, by their names in either order."""

    turned: Leans | None = None
    """By what angle bodies were turned at most from their mean orientation between two frames."""

    turn_floors: Mapping[str, float] = field(default_factory=dict)
    """From what angle on a body counts as moved, by body [rad]."""

    stand_ins: Mapping[str, str] = field(default_factory=dict)
    """The shapes of bodies that stand in for the true ones, in words, by body."""

    floors: Mapping[str, float] = field(default_factory=dict)
    """From what distance on a body counts as moved, by body [m]."""

    leans: Leans | None = None
    """How far bodies leant; None where that is not known."""

    far_over_rad: float = 0.0
    """From what angle on a body leans far over [rad]; zero where that is not known."""

    turns: TurnsBack | None = None
    """How often bodies turned back; None where that is not known."""

    level: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the level parts of objects' motions, by object."""

    swings: Mapping[str, Sequence[tuple[int, int]]] = field(default_factory=dict)
    """First and last frames of the measured motions to and fro, by object."""

    travelled: Mapping[tuple[str, int], tuple[int, int]] = field(default_factory=dict)
    """How far bodies had gone [mm] and turned in all [1/1000 rad], by name and frame."""

    held: Mapping[str, Sequence[tuple[str, int, int]]] = field(default_factory=dict)
    """Which end-effectors touched an object from when to when, by object."""

    rate_hz: float = 0.0
    """Frames a second [Hz]; zero where that is not known."""

    tracked: bool = True
    """Whether there is an object that could be touched."""

    contacts: Mapping[Pair, Sequence[Frames]] = field(default_factory=dict)
    """First and last frames of the measured contacts, by the two bodies."""

    normals: Mapping[Pair, Mapping[int, int]] = field(default_factory=dict)
    """By two bodies and the first frame of their contact: how far its normal points up, from the
    second to the first [1/1000]."""

    closing: Mapping[Pair, Mapping[int, int]] = field(default_factory=dict)
    """By two bodies and the first frame of their contact: how fast they came together [mm/s]."""

    presses: Mapping[Pair, Mapping[int, Pressing]] = field(default_factory=dict)
    """The same: which way the first presses aside on the second [1/1000]."""

    flickers: Mapping[Pair, Sequence[Frames]] = field(default_factory=dict)
    """First and last frames in which two bodies are taken to touch that were measured apart."""

    lies: Mapping[tuple[str, str, str], Sequence[Frames]] = field(default_factory=dict)
    """First and last frames of how a body lies to another, by that and the two bodies."""

    heights: Heights | None = None
    """How low and how high bodies were; None where that is not known."""

    over: Places | None = None
    """Where a body is to another one; None where that is not known."""

    apart: Apart | None = None
    """How far bodies were apart; None where that is not known."""

    gap_frames: str = ""
    """How long the gaps are that end no contact; empty where that is not known."""

    brief_frames: str = ""
    """How long what is too brief for a contact is; empty where that is not known."""

    movable: frozenset[str] = frozenset()
    """Objects that can be moved."""

    lost: Mapping[str, Sequence[Frames]] = field(default_factory=dict)
    """First and last frames of the gaps in the tracks of bodies that are long enough to matter."""

    unrested: frozenset[str] = frozenset()
    """Objects that never rest; from how others first rest their lean is measured."""

    shapeless: frozenset[str] = frozenset()
    """Objects of which no shape is known."""

    feet: frozenset[str] = frozenset()
    """End-effectors that are feet or toes."""

    hands: frozenset[str] = frozenset()
    """End-effectors that are hands or parts of them."""

    def grasps(self, body: str) -> bool:
        """Whether it is a hand, a foot, or a part of one, which is where it seems to be."""
        return body in self.hands or body in self.feet

    def stands_uncounted(self, body: str) -> bool:
        """Whether it is a foot of which no contact with anything fixed is looked for."""
        pairs = (pair for pair in self.reaches if body in pair)
        return body in self.feet and all({*pair} & self.movable for pair in pairs)

    def upright(self, body: str) -> str:
        """The posture from which a body's lean is measured, in words."""
        several = is_plural(self.names.get(body, body.replace("_", " ")))
        it, was = ("they", "were") if several else ("it", "was")
        if body in self.unrested:
            return f"how {it} {was} first seen"
        moving = min(self.moving.get(body, ()), default=(1, 1))
        later = f" (after {moving[1] / self.rate_hz:.2f} s)" * (
            not moving[0] and bool(self.rate_hz)
        )
        return f"how {it} first rested{later}"

    def contact(self, one: str, other: str, frame: int, slack: float) -> Frames | None:
        """The contact of two bodies at a frame, or the nearest so few frames from it."""
        found = [*self.contacts.get((one, other), ()), *self.contacts.get((other, one), ())]
        near = [
            (max(first - frame, frame - last, 0), first, last)
            for first, last in found
            if first - slack <= frame <= last + slack
        ]
        return min(near)[1:] if near else None

    def upward(self, one: str, other: str, first: int) -> int | None:
        """How far the normal of the contact that begins then points up, to the first [1/1000]."""
        own = self.normals.get((one, other), {}).get(first)
        opposite = self.normals.get((other, one), {}).get(first)
        return -opposite if own is None and opposite is not None else own

    def near(self, one: str, other: str) -> bool:
        """Whether two bodies that count as touching may be apart, so that they are told as near."""
        reach = self.reaches.get((one, other))
        rough = one in self.stand_ins or other in self.stand_ins
        return reach is not None and (rough or not reach.is_touch)
