"""How well segments agree with labels that people gave."""

from enum import StrEnum


class Kind(StrEnum):
    """What labels are about."""

    ACTIONS = "actions"
    """What each link does, from when to when; one action at a time."""

    CONTACTS = "contacts"
    """When two bodies touch."""

    CARRIES = "carries"
    """From when to when an object is carried."""

    CONTAINERS = "containers"
    """What goes into a container; the capture itself tells, by first and last poses."""

    EVENTS = "events"
    """What a hand does at about a time; a label is a window in which it must be found."""


class Contradictions(StrEnum):
    """What to do about marks that end before they start, and marks that overlap."""

    REFUSE = "refuse"
    LEAVE_OUT = "leave-out"
