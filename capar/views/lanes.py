"""The lanes under the scene: segments, contacts, zero crossings, speed and gaze over time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from zlib import crc32

import numpy as np

from capar.model.par import UNKNOWN
from capar.views.lettering import Span
from capar.views.picture import COLOURS, CONTACT, MOTION, OTHERS, PALE, Kind, Row

HEIGHTS_PX = {
    Kind.HEADING: 16,
    Kind.SEGMENTS: 22,
    Kind.TICKS: 8,
    Kind.BARS: 12,
    Kind.MOTION: 12,
    Kind.NAMES: 16,
    Kind.CURVE: 30,
}
LABELS_PX = 128
"""Room for the names of lanes at the left [px]."""

AXIS_PX = 18
LETTER_PX = 6.9
"""Usual width of a letter [px]."""

MOST_POINTS = 400
"""A curve is drawn by so many points at most."""

INK = "var(--mantine-color-text)"
QUIET = "var(--mantine-color-dimmed)"


def colour_of(span: Span) -> str:
    """The colour of a segment: that of the most general action that it is a case of."""
    name = span.kind or span.label
    return COLOURS.get(name) or OTHERS[crc32(name.encode()) % len(OTHERS)]


@dataclass(frozen=True)
class Lanes:
    """Rows over an interval of time, as one drawing."""

    rows: Sequence[Row]
    begin_s: float
    end_s: float
    width_px: int

    @property
    def height_px(self) -> int:
        """Of the drawing [px]."""
        return sum(HEIGHTS_PX[row.kind] for row in self.rows) + AXIS_PX

    def x(self, time_s: float) -> float:
        """Where a time is from the left [px], inside of the drawing."""
        share = (time_s - self.begin_s) / max(self.end_s - self.begin_s, 1e-9)
        return LABELS_PX + min(max(share, 0.0), 1.0) * (self.width_px - LABELS_PX - 8)

    def svg(self, chosen: tuple[str, float, float] | None = None) -> str:
        """The drawing.

        Args:
            chosen: The end-effector, begin and end [s] of the segment that is chosen.
        """
        parts, top = [*self._axis()], 0
        for row in self.rows:
            tall = HEIGHTS_PX[row.kind]
            parts += self._row(row, top, tall, chosen)
            top += tall
        size = f'width="{self.width_px}" height="{self.height_px}"'
        style = "display:block;font:11px sans-serif"
        return f'<svg {size} role="img" aria-label="lanes" style="{style}">{"".join(parts)}</svg>'

    def cursor(self, time_s: float) -> str:
        """A line at a time, to be laid over the drawing."""
        line = f"left:{self.x(time_s):.1f}px;top:0;width:2px;height:{self.height_px}px"
        style = f"position:absolute;{line};background:#e03131;z-index:4;pointer-events:none"
        return f'<div style="position:relative;height:0"><div style="{style}"></div></div>'

    def _row(
        self, row: Row, top: int, tall: int, chosen: tuple[str, float, float] | None
    ) -> Iterator[str]:
        bold = ' font-weight="bold"' if row.kind in (Kind.SEGMENTS, Kind.HEADING) else ""
        most = int(LABELS_PX / LETTER_PX) - 1
        name = row.label if len(row.label) <= most else f"{row.label[: most - 1]}…"
        yield (
            f'<text x="{LABELS_PX - 6}" y="{top + tall / 2 + 4:g}" text-anchor="end" fill="{INK}"'
            f"{bold}>{escape(name)}<title>{escape(row.label)}</title></text>"
        )
        if row.curve is not None:
            yield from self._curve(row, top, tall)
        for tick in row.ticks:
            if self.begin_s <= tick <= self.end_s:
                x = self.x(tick)
                yield f'<path d="M{x:.1f} {top}v{tall}" stroke="{INK}" stroke-width="1"/>'
        labels = sorted({each.label for each in row.spans})
        for span in row.spans:
            if span.end_s < self.begin_s or span.start_s > self.end_s:
                continue
            colour = {Kind.BARS: CONTACT, Kind.MOTION: MOTION}.get(row.kind) or (
                PALE[labels.index(span.label) % len(PALE)]
                if row.kind is Kind.NAMES
                else colour_of(span)
            )
            yield from self._bar(span, top, tall, colour, is_chosen=_is(row, span, chosen))
        for span in row.lost:
            x, wide = self.x(span.start_s), max(self.x(span.end_s) - self.x(span.start_s), 1.0)
            yield (
                f'<rect x="{x:.1f}" y="{top}" width="{wide:.1f}" height="{tall}" fill="{QUIET}" '
                'fill-opacity="0.35"><title>lost by the tracker</title></rect>'
            )

    def _bar(
        self, span: Span, top: int, tall: int, colour: str, *, is_chosen: bool
    ) -> Iterator[str]:
        x, wide = self.x(span.start_s), max(self.x(span.end_s) - self.x(span.start_s) - 0.5, 1.5)
        unknown = span.label == UNKNOWN
        fill = "none" if unknown else colour
        edge = "#e03131" if is_chosen else QUIET if unknown else "none"
        dashes = ' stroke-dasharray="3 2"' if unknown and not is_chosen else ""
        said = f"{span.label} {span.start_s:.2f} to {span.end_s:.2f} s".strip()
        yield (
            f'<rect x="{x:.1f}" y="{top + 1}" width="{wide:.1f}" height="{tall - 3}" rx="2" '
            f'fill="{fill}" stroke="{edge}" stroke-width="{2 if is_chosen else 1}"{dashes}>'
            f"<title>{escape(said)}</title></rect>"
        )
        most = int(wide / LETTER_PX)
        if span.label and most >= 3:
            name = span.label if len(span.label) <= most else f"{span.label[: most - 1]}…"
            ink = INK if unknown else "#1a1a1a"
            yield (
                f'<text x="{x + wide / 2:.1f}" y="{top + tall / 2 + 3:g}" text-anchor="middle" '
                f'fill="{ink}" style="pointer-events:none">{escape(name)}</text>'
            )

    def _curve(self, row: Row, top: int, tall: int) -> Iterator[str]:
        assert row.curve is not None
        times, values = row.curve
        first, last = np.searchsorted(times, (self.begin_s, self.end_s))
        every = max((last - first) // MOST_POINTS, 1)
        fastest = max(float(np.nanmax(values, initial=0.0)), 1e-6)
        shown = ((t, v) for t, v in zip(times[first:last:every], values[first:last:every]))  # noqa: B905
        points = " ".join(
            f"{self.x(t):.1f},{top + tall - 2 - (tall - 4) * v / fastest:.1f}"
            for t, v in shown
            if np.isfinite(v)
        )
        yield f'<polyline points="{points}" fill="none" stroke="{QUIET}" stroke-width="1.2"/>'
        yield (
            f'<text x="{self.width_px - 10}" y="{top + 9}" text-anchor="end" fill="{QUIET}" '
            f'font-size="9">{fastest:.1f} m/s</text>'
        )

    def _axis(self) -> Iterator[str]:
        base = self.height_px - AXIS_PX
        length_s = self.end_s - self.begin_s
        steps = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0)
        step = next((each for each in steps if length_s / each <= 12), 600.0)
        for number in range(int(np.ceil(self.begin_s / step)), int(self.end_s / step) + 1):
            x = self.x(number * step)
            grid = f'stroke="{QUIET}" stroke-opacity="0.25"'
            yield f'<path d="M{x:.1f} 0v{base + 4}" {grid}/>'
            yield (
                f'<text x="{x:.1f}" y="{base + 14}" text-anchor="middle" fill="{QUIET}">'
                f"{number * step:g} s</text>"
            )


def _is(row: Row, span: Span, chosen: tuple[str, float, float] | None) -> bool:
    """Whether a bar is the segment that is chosen."""
    if chosen is None or row.kind is not Kind.SEGMENTS or row.label.rstrip("*†") != chosen[0]:
        return False
    return abs(span.start_s - chosen[1]) < 1e-3 and abs(span.end_s - chosen[2]) < 1e-3
