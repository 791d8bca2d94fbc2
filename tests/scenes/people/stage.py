"""A scene of people while it is written: who is there, and the capture of all their limbs."""

from dataclasses import dataclass, replace

from scenes.hands import shapes
from scenes.hands.expectation import Step
from scenes.hands.paths import Vector
from scenes.hands.stage import Stage, other_names
from scenes.hands.things import Thing
from scenes.people.limbs import Limb

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
