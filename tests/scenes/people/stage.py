"""Hands and feet that belong to somebody, and the stage on which people act."""

from dataclasses import dataclass, field, replace

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import Body, Poses, Times, Vector, about, min_jerk
from scenes.hands.performer import Hand
from scenes.hands.shapes import Form, block
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Step, Thing

RAMP = 0.3
"""Share of a smooth way in which it speeds up, and in which it slows down."""

LONG_S = 0.4
"""Who stays for so long does so in a step of its own (spec 10) [s]."""

SOLE_M = 0.08
"""Height of a foot's sensor over its sole [m]."""


@dataclass
class Limb(Hand):
    """An acting hand or foot of one of several people."""

    beside_s: float = 0.12
    """So long before and after a contact it may be near what it touches [s]."""

    aliases: dict[str, str] = field(default_factory=dict)
    """Names of steps that the alternative has in place of others."""

    others: list[tuple["Limb", float, float]] = field(default_factory=list)
    """Hands that it touched, from when to when [s]."""

    def wait(self, until: float, *held: Thing) -> None:
        """Stay until a time [s]; that is a step of its own if it is long."""
        if until - self.clock >= LONG_S - 1e-9:
            self.clock = until
            names = ("Rest", "Touch", "TouchWith")
            self.step(names[len(held)], *held)
        self.until(until)

    def meet_hand(self, other: "Limb", start: float, end: float) -> None:
        """Write down, for both, that two hands touch [s]."""
        self.others.append((other, start, end))
        other.others.append((self, start, end))


@dataclass
class Rider(Body):
    """A body that keeps its place on another one."""

    carrier: Body = field(default_factory=lambda: Body("nothing", np.eye(4)))

    def poses(self, times: Times) -> Poses:
        """Poses at times [s]."""
        return self.carrier.poses(times) @ self.first


@dataclass
class Chest(Body):
    """The upper body: it goes along with the pelvis and bends about the hips."""

    trunk: Body = field(default_factory=lambda: Body("nothing", np.eye(4)))
    hip_m: float = 0.9
    bends: list[tuple[float, float, float]] = field(default_factory=list)
    """Start, end [s] and angle forward of each bend [rad]."""

    def poses(self, times: Times) -> Poses:
        """Poses at times [s]."""
        angle = np.zeros(len(times))
        for start, end, far in self.bends:
            angle += far * min_jerk((times - start) / (end - start))
        return self.trunk.poses(times) @ about((0.0, 0.0, self.hip_m), (0.0, 1.0, 0.0), angle)


def smooth(share: Times, ramp: float = RAMP) -> Times:
    """Way done from 0 to 1 with an even pace between a share in which it rises and falls."""
    fine = np.linspace(0.0, 1.0, 2001)
    edge = np.clip(np.minimum(fine, 1.0 - fine) / ramp, 0.0, 1.0)
    pace = edge**2 * (3.0 - 2.0 * edge)
    done = np.concatenate([[0.0], np.cumsum(0.5 * (pace[1:] + pace[:-1]))])
    return np.asarray(np.interp(np.clip(share, 0.0, 1.0), fine, done / done[-1]))


def foot_form(size: float) -> Form:
    """A shoe: x ahead, its origin on the instep."""
    heel = block((-0.09, -0.042, -SOLE_M), (0.1, 0.042, -0.01))
    toes = block((0.08, -0.045, -SOLE_M), (0.17, 0.045, -0.035))
    made = Form("foot", (heel, toes))
    return made.scaled(size)


def planted_m(limb: Hand, start: float, end: float) -> float:
    """How far the point of a limb that moves least goes about between two times [m].

    A foot whose heel rises stays where its toes are.
    """
    poses = limb.body.poses(np.linspace(start, end, 20))
    corners = limb.form.vertices
    places = corners @ np.swapaxes(poses[:, :3, :3], 1, 2) + poses[:, None, :3, 3]
    return float(np.ptp(places, axis=0).max(axis=1).min())


LASTING = frozenset({"Rest", "Touch", "TouchWith", "TouchOneself", "Stand", "StandOnOneLeg"})
"""Steps in which nothing moves, so that two in a row are one."""

FLOOR_M = 8.0
"""Length and width of the floor [m]."""


@dataclass
class PeopleStage(Stage):
    """A stage on a floor, for one or several people."""

    def __post_init__(self) -> None:
        """Lay the floor."""
        half = FLOOR_M / 2.0
        form = shapes.Form("floor", (shapes.block((-half, -half, -0.1), (half, half, 0.0)),))
        self.floor = self.put("floor", form, (0.0, 0.0, 0.0), tag="fixed")

    def desk(self, at: Vector, size: Vector = (0.6, 1.2), name: str = "table") -> Thing:
        """A table's top, with its middle at a place whose third number is its height [m]."""
        x, y = size[0] / 2.0, size[1] / 2.0
        form = shapes.Form(name, (shapes.block((-x, -y, -0.04), (x, y, 0.0)),))
        return self.put(name, form, at, tag="fixed")

    def close(self) -> None:
        """Draw out what stands to the end, as steps of their own."""
        end = self.duration_s
        for limb in self.hands:
            if isinstance(limb, Limb) and limb.member == "foot" and limb.touched:
                limb.clock = end
                if limb.clock - limb.border > 0.0:
                    limb.step("Stand", limb.touched)
            limb.steps = joined(limb.steps)
            if isinstance(limb, Limb) and limb.aliases:
                limb.alternative = other_names(limb, **limb.aliases)


def joined(steps: list[Step]) -> list[Step]:
    """Steps of which those that only go on with the one before are one with it."""
    out: list[Step] = []
    for each in steps:
        if out and each.name in LASTING and each.action == out[-1].action:
            out[-1] = replace(out[-1], end_s=each.end_s)
        else:
            out.append(each)
    return out
