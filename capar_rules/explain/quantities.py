"""The quantities by which rules name segments: what each is called, and its unit for people."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Quantity:
    """Something that is measured of bodies."""

    label: str
    """What it is; {0} is the first body."""

    unit: str
    """The unit in which people read it."""

    scale: float = 1.0
    """How much of that unit the unit of rules is: millimetres, thousandths of a radian ...; zero
    for frames, which are seconds for people."""

    digits: int = 0
    """So many decimals are printed."""


_DEGREES_OF_MILLIRADIAN = 0.0572957795

QUANTITIES: Mapping[str, Quantity] = {
    "height": Quantity("height of the {0} above its start", "cm", 0.1, 1),
    "depth": Quantity("depth of the {0} below its start", "cm", 0.1, 1),
    "vertical": Quantity("vertical distance of the {0} from its start", "cm", 0.1, 1),
    "aside": Quantity("distance of the {0} to the side of its start", "cm", 0.1, 1),
    "far_height": Quantity("height of the {0} above its start", "m"),
    "far_aside": Quantity("distance of the {0} to the side of its start", "m"),
    "way": Quantity("distance of the {0} from its start", "cm", 0.1, 1),
    "path": Quantity("length of the path of the {0}", "cm", 0.1, 1),
    "leaning": Quantity("change of the lean of the {0}", "°", _DEGREES_OF_MILLIRADIAN),
    "lean": Quantity("lean of the {0}", "°", _DEGREES_OF_MILLIRADIAN),
    "turn": Quantity("turn of the {0} about the vertical", "°", _DEGREES_OF_MILLIRADIAN),
    "turned": Quantity("angle by which the {0} turned in all", "°", _DEGREES_OF_MILLIRADIAN),
    "push": Quantity("upward part of the contact normal of the {0} on the {1}", "", 0.001, 2),
    "closing": Quantity("relative speed of the {0} and the {1}", "mm/s"),
    "speed": Quantity("speed of the {0} on release", "mm/s"),
    "strokes": Quantity("turns back of the {0} in ten seconds", ""),
    "opening": Quantity("change of the opening of the {0}", "mm or mrad"),
    "duration": Quantity("duration", "s", 0.0, 2),
    "distance": Quantity("distance of the {0} from the {1}", "mm", 1.0, 1),
    "motion": Quantity("distance of the {0} from the middle of its places", "cm", 0.1, 1),
    "swing": Quantity("turns back of the {0}", ""),
    "inside": Quantity("part of the {0} inside the {1}", "%", 0.1),
    "above": Quantity("height of the {0} above the top of the {1}", "cm", 0.1, 1),
    "turning": Quantity("angle of the {0} to its mean orientation", "°", _DEGREES_OF_MILLIRADIAN),
    "bearing": Quantity(
        "angle of the path of the {1} to the line from the {0}", "°", _DEGREES_OF_MILLIRADIAN
    ),
}
"""By the names that rule files use."""
