"""Facts that number the borders of a link: ticks, and what lies between them."""

from dataclasses import dataclass

from capar.model.facts import Fact


@dataclass(frozen=True, slots=True, order=True)
class Tick(Fact):
    """A frame of a link at which something may change."""

    predicate = "tick"
    ee: str
    tick: int
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class LastTick(Fact):
    """The number of a link's last tick."""

    predicate = "last_tick"
    ee: str
    tick: int


@dataclass(frozen=True, slots=True, order=True)
class Within(Fact):
    """The ticks of a link that lie inside a contact."""

    predicate = "within"
    ee: str
    body: str
    other: str
    since: int
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class MovesBetween(Fact):
    """An object moves between a tick of a link and the next one."""

    predicate = "moves_between"
    ee: str
    object: str
    tick: int


@dataclass(frozen=True, slots=True, order=True)
class MovesDuring(Fact):
    """An object moves at some time in a contact with an end-effector."""

    predicate = "moves_during"
    ee: str
    object: str
    since: int


@dataclass(frozen=True, slots=True, order=True)
class FreeBetween(Fact):
    """Two ticks of a link, the end of a contact and the next begin of one, with none between."""

    predicate = "free_between"
    ee: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Shares(Fact):
    """Another end-effector touched the object before this one did, or does so after it."""

    predicate = "shares"
    ee: str
    object: str
    since: int
    other: str
    when: str


@dataclass(frozen=True, slots=True, order=True)
class Meanwhile(Fact):
    """While this end-effector touches an object, another one's contact with it begins or ends.

    Between this tick and the next; the other's contact is named by its first frame.
    """

    predicate = "meanwhile"
    ee: str
    tick: int
    kind: str
    other: str
    object: str
    since: int


@dataclass(frozen=True, slots=True, order=True)
class Undisturbed(Fact):
    """The ticks of a stretch in which an end-effector rests and touches nothing."""

    predicate = "undisturbed"
    ee: str
    first: int
    last: int
