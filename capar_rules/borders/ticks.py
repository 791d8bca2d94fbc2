"""Ticks: the frames at which facts begin or end, and frames as seconds."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache

from capar.model.errors import RuleError
from capar.model.facts import Fact
from capar_rules.engine.solver import rule_file


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


_CONSTANT = re.compile(r"^#const (\w+) = (\d+)\.", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Times:
    """Durations [ms] and a speed [mm/s]; what each means stands beside it in ``thresholds.lp``."""

    merge_ms: int
    margin_ms: int
    settled_ms: int
    flicker_ms: int
    flicker_window_ms: int
    rest_ms: int
    one_leg_ms: int
    blow_mm_s: int

    def __post_init__(self) -> None:
        """Check what the numbering relies on.

        Raises:
            RuleError: Borders that may merge would be numbered, or cut, apart.
        """
        if not self.merge_ms <= self.settled_ms <= self.margin_ms:
            raise RuleError("thresholds.lp: expected merge_ms <= settled_ms <= margin_ms")


@cache
def constants() -> Mapping[str, int]:
    """The numbers of ``thresholds.lp`` by name, in the units that are told there."""
    text = rule_file("thresholds.lp").read_text(encoding="utf-8")
    return {name: int(value) for name, value in _CONSTANT.findall(text)}


@cache
def times() -> Times:
    """The times that ship with the rules.

    Raises:
        RuleError: One is not defined.
    """
    found = constants()
    missing = [each.name for each in fields(Times) if each.name not in found]
    if missing:
        raise RuleError(f"thresholds.lp: expected a #const for {', '.join(missing)}")
    return Times(**{each.name: found[each.name] for each in fields(Times)})


def in_frames(duration_ms: int, rate_hz: float) -> float:
    """A duration in frames of a capture."""
    return duration_ms / 1000.0 * rate_hz
