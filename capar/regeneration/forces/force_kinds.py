"""What of a recorded force is kept (thesis 3.4.3)."""

from enum import StrEnum

from capar.model.errors import UnknownNameError


class ForceKind(StrEnum):
    """What is the same on another body."""

    SIMILAR = "similar"
    """The force, in proportion to the arm and its speed; the thing goes as far as that takes it."""

    SAME = "same"
    """The thing's motion; the hand strikes as fast as that takes."""


def force_kind(name: str) -> ForceKind:
    """The kind of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in set(ForceKind):
        raise UnknownNameError("force", name, list(ForceKind))
    return ForceKind(name)
