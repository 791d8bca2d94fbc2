"""A picture of what was found beside its labels: segments, labels and differences over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from capar.model.errors import FileError
from capar.views.lettering import Span, width_in
from capar.views.painter import INK, QUIET, Painter
from capar.views.picture import DPI, EDGE_IN, LABEL_IN, SUFFIXES, WIDEST_IN, WIDTH_IN
from capar.views.rows import Kind, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE_IN = 0.75
FOOT_IN = 0.62
DIFFERS = "differs"


@dataclass(frozen=True)
class Lane:
    """What one channel shows, each part as spans of time with a name."""

    name: str
    segments: tuple[Span, ...]
    """Printed segments."""

    found: tuple[Span, ...]
    """What they amount to in the words of the labels."""

    true: tuple[Span, ...]
    """The labels."""

    wrong: tuple[Span, ...]
    """Where the two differ."""


def draw_comparison(
    title: str, subtitle: str, lanes: Sequence[Lane], duration_s: float, *, path: Path
) -> None:
    """Draw lanes to a PNG, SVG or PDF file, as the suffix says.

    Raises:
        FileError: The suffix is another one, or the file cannot be written.
    """
    import matplotlib as mpl

    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        known = ", ".join(SUFFIXES)
        raise FileError(path, f"no picture format {path.suffix!r};", f"there are: {known}.")
    settings: dict[Any, Any] = {
        "svg.hashsalt": "capar", "font.family": "DejaVu Sans", "text.parse_math": False,
    }  # fmt: skip
    with mpl.rc_context(rc={**dict(mpl.rcParamsDefault), **settings, "backend": "agg"}):
        figure = _figure(title, subtitle, comparison_rows(lanes), duration_s)
        try:
            figure.savefig(
                path, dpi=DPI, metadata=SUFFIXES[suffix], format=suffix.removeprefix(".")
            )
        except OSError as error:
            raise FileError(path, f"cannot be written: {error.strerror or error}.") from None


def comparison_rows(lanes: Sequence[Lane]) -> tuple[Row, ...]:
    """The rows of each lane: segments where there are some, what was found, labels, differences."""
    out: list[Row] = []
    for lane in lanes:
        head = Kind.SEGMENTS if lane.segments else Kind.HEADING
        out.append(Row(head, lane.name, lane.segments))
        out.append(Row(Kind.NAMES, "found", lane.found))
        out.append(Row(Kind.NAMES, "labelled", lane.true))
        out.append(Row(Kind.BARS, DIFFERS, lane.wrong))
    return tuple(out)


def _figure(title: str, subtitle: str, content: Sequence[Row], duration_s: float) -> "Figure":
    from matplotlib.figure import Figure

    left = EDGE_IN + 0.15 + min(max(width_in(each.label, points=9.5) for each in content), LABEL_IN)
    most = max((len(each.spans) for each in content), default=0)
    width = min(max(WIDTH_IN, left + 0.3 * most), WIDEST_IN)
    painter = Painter(content, duration_s, width - left - EDGE_IN - 0.1)
    height = TITLE_IN + painter.height + FOOT_IN
    figure = Figure(figsize=(width, height), facecolor="white")
    axes = figure.add_axes(
        (left / width, FOOT_IN / height, painter.width / width, painter.height / height)
    )
    painter.paint(axes)
    heading = {"fontsize": 14, "weight": "bold", "color": INK}
    for text, down, style in (
        (title, 0.2, heading),
        (subtitle, 0.47, {"fontsize": 9, "color": QUIET}),
    ):
        look: dict[str, Any] = dict(style)
        figure.text(left / width, 1 - down / height, text, va="top", **look)
    return figure
