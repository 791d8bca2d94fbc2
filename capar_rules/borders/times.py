"""The numbers by which borders are numbered, or awaited, read from ``thresholds.lp``."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache

from capar.model.errors import RuleError
from capar_rules.engine.solver import rule_file

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
