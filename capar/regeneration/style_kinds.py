"""What of a recorded way may be kept."""

from enum import StrEnum

from capar.model.errors import UnknownNameError


class Kind(StrEnum):
    """What of a recorded way is kept."""

    PATH = "path"
    """Its shape in metres beside the straight way, and its timing."""

    FRAME = "frame"
    """Its shape, turned and enlarged with the way as a whole, and its timing."""

    VEL = "vel"
    """Its timing only: the straight way (VelStyle alone)."""

    EVEN = "even"
    """Nothing: the straight way with minimum jerk."""


def style_kind(name: str) -> Kind:
    """The kind of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in set(Kind):
        raise UnknownNameError("style", name, list(Kind))
    return Kind(name)
