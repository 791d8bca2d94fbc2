"""Where names go in a picture: inside a bar, above it, or in the legend."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

POINTS_PER_INCH = 72.0
GAP_IN = 0.06
"""Least room beside a name [inches]."""


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of time with a name."""

    start_s: float
    end_s: float
    label: str
    kind: str = ""
    """What kind of action the name is: the most general one that it specialises."""


@dataclass(frozen=True, slots=True)
class Placed:
    """Where a span's name stands."""

    span: Span
    row: int
    """0: inside the bar; 1: just above it; 2: higher, with a line down to it; -1: nowhere."""

    centre_s: float
    half_s: float
    """Half the name's width, as time."""

    @property
    def middle_s(self) -> float:
        """The middle of the bar, where a line meets it."""
        return (self.span.start_s + self.span.end_s) / 2

    def covers(self, time_s: float) -> bool:
        """Whether the name stands over that time."""
        return abs(time_s - self.centre_s) < self.half_s


@lru_cache(maxsize=4096)
def width_in(text: str, *, points: float) -> float:
    """How wide a text is when set in the pictures' letters of that size [inches]."""
    from matplotlib.textpath import TextPath

    if not text.strip():
        return 0.0
    return float(TextPath((0.0, 0.0), text, size=points).get_extents().width) / POINTS_PER_INCH


def shortened(text: str, *, points: float, widest_in: float) -> str:
    """The text, cut to a width [inches] where it is wider."""
    if width_in(text, points=points) <= widest_in:
        return text

    def width_until(end: int) -> float:
        return width_in(f"{text[:end]}…", points=points)

    first_too_wide = bisect_right(range(len(text)), widest_in, key=width_until)
    return f"{text[: max(first_too_wide - 1, 0)].rstrip()}…"


def place(
    spans: Sequence[Span],
    *,
    seconds_per_inch: float,
    range_s: tuple[float, float],
    points: float,
    rows_above: int,
) -> tuple[Placed, ...]:
    """Put each name inside its bar, else above where it is plain which bar it belongs to.

    Args:
        spans: Bars in order of time.
        seconds_per_inch: Scale of the time axis.
        range_s: Where the axis begins and ends; a name does not leave it.
        points: Size of the letters.
        rows_above: How many rows for names there are above the bars, at most 2.
    """
    gap = GAP_IN * seconds_per_inch
    halves = [width_in(each.label, points=points) * seconds_per_inch / 2 for each in spans]
    inside = [
        2 * half + gap <= each.end_s - each.start_s
        for half, each in zip(halves, spans, strict=True)
    ]
    out: list[Placed] = []
    for index, (span, half) in enumerate(zip(spans, halves, strict=True)):
        middle = (span.start_s + span.end_s) / 2
        centre = min(max(middle, range_s[0] + half), range_s[1] - half)
        others = [
            (each.start_s + each.end_s) / 2
            for other, each in enumerate(spans)
            if other != index and not inside[other]
        ]
        rows = [0] if inside[index] else range(1, rows_above + 1)
        tries = [Placed(span, row, middle if row == 0 else centre, half + gap) for row in rows]
        good = [each for each in tries if each.row == 0 or _is_plain(each, out, others)]
        out.append(good[0] if good else Placed(span, -1, middle, half))
    return tuple(out)


def _is_plain(wanted: Placed, placed: Sequence[Placed], others: Sequence[float]) -> bool:
    """Whether a name above the bars meets no other, and shows which bar is its own.

    Args:
        wanted: The name with its row.
        placed: The names before it.
        others: Middles of the other bars that do not hold their own names.
    """
    for letter in placed:
        apart = abs(letter.centre_s - wanted.centre_s) >= letter.half_s + wanted.half_s
        if letter.row == wanted.row and not apart:
            return False
        if wanted.row == 1 and letter.row == 2 and wanted.covers(letter.middle_s):
            return False
        if wanted.row == 2 and letter.row == 1 and letter.covers(wanted.middle_s):
            return False
    return wanted.row == 2 or not any(wanted.covers(each) for each in others)
