"""What the summary of an explanation claims, as a picture: a panel for each quantity."""

from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

from capar.model.observation import SegmentAddress
from capar.pipelines.explanation import Explained, segment_named
from capar.pipelines.measured.recording import Recording
from capar.pipelines.measured.rests import BESIDE
from capar.pipelines.measured.rows import claimed_rows, mover_rows
from capar.pipelines.measured.series import SERIES
from capar.views.lettering import Span
from capar.views.measured_picture import MeasuredPicture, draw_measured
from capar.views.movers import mover_lines, mover_stretches
from capar.views.panels import Held, Panel, Row
from capar.views.picture import kind_of
from capar_rules.explain.claims import Quantity
from capar_rules.explain.explanation import Explanation

AROUND_S = 1.0
"""So long before and after the segment is shown [s]."""

FURTHEST_S = 20.0
"""What an explanation tells of longer before or after it is not shown [s]."""


def draw_claims(
    seen: Explained, told: Explanation, path: Path, *, staying: Collection[str] = ()
) -> None:
    """Draw what a summary claims, and what moved what, to a PNG, SVG or PDF file.

    Args:
        seen: The capture.
        told: The explanation of one of its segments.
        path: The file, which is overwritten.
        staying: Objects whose motion does not count there; nothing is told of what moves them.
    """
    rate = seen.explainer.windows.rate
    first, last = shown_span(seen, told)
    spans = {
        segment.index: Span(segment.start_s, segment.end_s, segment.name, kind_of(segment))
        for segment in seen.observation.segments
        if segment.ee == told.ee
    }
    address = SegmentAddress(told.ee, told.index)
    about = seen.observation, told.ee, told.index
    panels = measured_panels(seen, told)
    title = f"{address}  {told.name}  {told.start_s:.2f} to {told.end_s:.2f} s"
    picture = MeasuredPicture(
        title,
        "\n".join([told.summary, *mover_lines(*about, staying=staying)]),
        list(spans.values()),
        spans[told.index],
        panels,
        (first / rate, last / rate),
        measured_rows(seen, told, panels, staying=staying),
    )
    draw_measured(picture, path)


def shown_span(seen: Explained, told: Explanation) -> tuple[int, int]:
    """First and last frame that a picture of an explanation shows.

    A second before the segment and after it, and whatever else its summary tells of near it.
    """
    rate, frames = seen.explainer.windows.rate, seen.observation.frames
    segment = _segment_frames(seen, told)
    near = [
        frame
        for claim in told.claims
        for frame in claim.frames
        if segment[0] - FURTHEST_S * rate <= frame <= segment[1] + FURTHEST_S * rate
    ]
    around = round(AROUND_S * rate)
    first, last = min([segment[0], *near]) - around, max([segment[1], *near]) + around
    return max(first, 0), min(last, frames - 1)


def _segment_frames(seen: Explained, told: Explanation) -> tuple[int, int]:
    segment = segment_named(seen.observation, str(SegmentAddress(told.ee, told.index)))
    return segment.first, segment.last


def measured_panels(seen: Explained, told: Explanation) -> tuple[Panel, ...]:
    """A panel for each quantity that the summary speaks of, in its order."""
    span = shown_span(seen, told)
    forms: dict[Quantity, set[str]] = defaultdict(set)
    halts: dict[Quantity, set[int]] = defaultdict(set)
    for claim in told.claims:
        for quantity in claim.quantities:
            shown = replace(quantity, form="", halts=())
            forms[shown].add(quantity.form)
            halts[shown].update(quantity.halts)
    known = Recording(seen, span)
    found = (
        series(known, replace(quantity, halts=tuple(halts[quantity])), frozenset(said))
        for quantity, said in forms.items()
        for series in (SERIES[quantity.measure], *BESIDE.get(quantity.measure, ()))
    )
    return _each_bar_once([panel for panel in found if panel is not None])


def _each_bar_once(panels: Sequence[Panel]) -> tuple[Panel, ...]:
    """The same panels, where those that show what others show have no bars.

    Bars stay where it is told what is said of none, or else where they come first.
    """
    once: dict[Held, Panel] = {}
    for panel in sorted(panels, key=lambda panel: not panel.unheld):
        if panel.bars and panel.held and panel.span_s is None:
            once.setdefault(panel.held, panel)
    return tuple(
        replace(panel, bars=(), unheld="") if once.get(panel.held, panel) is not panel else panel
        for panel in panels
    )


def measured_rows(
    seen: Explained,
    told: Explanation,
    panels: Sequence[Panel] = (),
    *,
    staying: Collection[str] = (),
) -> tuple[Row, ...]:
    """A row for what held when, of what the summary and lines of movers say without a number.

    Args:
        seen: The capture.
        told: The explanation of one of its segments.
        panels: Those above the rows, which do not tell again what these show.
        staying: Objects whose motion does not count there.
    """
    known = Recording(seen, shown_span(seen, told))
    moved = mover_stretches(seen.observation, told.ee, told.index, staying=staying)
    shown = {held for panel in panels for held in panel.shows}
    rows = (row for row in claimed_rows(known, told.claims) if row.held not in shown)
    return (*rows, *mover_rows(known, moved))
