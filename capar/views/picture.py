"""A picture of an observation: named segments, contacts, crossings and speed over time."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, TypeAlias

from capar.model.errors import FileError
from capar.model.observation import Observation
from capar.views.lettering import shortened, width_in
from capar.views.painter import INK, QUIET, Painter
from capar.views.rows import (
    ASSUMED,
    STAND_IN,
    Lost,
    Row,
    Speeds,
    is_detailed,
    rows,
    spoken,
    stand_ins,
)
from capar.views.tables import performers

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
"""What can be written, each with the metadata that keeps its bytes the same."""

WIDTH_IN = 12.0
WIDEST_IN = 20.0
DPI = 150
EDGE_IN = 0.3
TITLE_IN = 0.75
NOTE_POINTS = 8.0
NOTE_LINE_IN = 0.16

MOST_SHAPES = 12
"""So many stand-ins are listed; ``observe --json`` lists all."""

MANY_NOTE = "of so many end-effectors those that handle objects stand first, without speeds."
LOST_NOTE = "hatched: a body of that row was not tracked; a bar across it is inferred."

LABEL_IN = 3.5
"""A longer label at the left of a row is cut [inches]."""

Entry: TypeAlias = tuple[str, dict[str, Any]]
"""What the legend says of a colour, and how the bars look that have it."""


def draw(observation: Observation, speeds: Speeds, *, path: Path, lost: Lost | None = None) -> None:
    """Draw the observation to a PNG, SVG or PDF file, as the suffix says.

    Args:
        observation: What to draw.
        speeds: Of each end-effector: times [s] and speeds [m/s]; a link without one has no curve.
        path: The file, which is overwritten.
        lost: Of each body whether tracking had lost it, by frame; such frames are hatched.

    Raises:
        FileError: The suffix is another one, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise FileError(
            path, f"no picture format {path.suffix!r};", f"there are: {', '.join(SUFFIXES)}."
        )
    try:
        _save(observation, rows(observation, speeds, lost), path, suffix)
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}.") from None


def svg(observation: Observation) -> str:
    """The picture as the text of an SVG, without the speeds, which an observation does not hold."""
    out = BytesIO()
    _save(observation, rows(observation, {}), out, ".svg")
    return out.getvalue().decode("utf-8")


def _save(
    observation: Observation, content: Sequence[Row], where: Path | BytesIO, suffix: str
) -> None:
    save(lambda: _figure(observation, content), where, suffix)


def save(figure: "Callable[[], Figure]", where: Path | BytesIO, suffix: str) -> None:
    """Make a figure with the settings of every picture, and write it in the format of a suffix."""
    import matplotlib as mpl

    settings: dict[Any, Any] = {
        "svg.hashsalt": "capar",
        "font.family": "DejaVu Sans",
        "hatch.linewidth": 0.6,
        "text.parse_math": False,
    }
    with mpl.rc_context(rc={**dict(mpl.rcParamsDefault), **settings, "backend": "agg"}):
        figure().savefig(where, dpi=DPI, metadata=SUFFIXES[suffix], format=suffix.removeprefix("."))


def _figure(observation: Observation, content: Sequence[Row]) -> "Figure":
    """Lay the rows out, then the time axis, the legend and the footnote under them."""
    from matplotlib.figure import Figure

    content = [_narrow(each) for each in content]
    left = EDGE_IN + 0.15 + max(width_in(each.label, points=9.5) for each in content)
    width = _width(observation, left)
    painter = Painter(content, observation.duration_s, width - left - EDGE_IN - 0.1)
    room = width - 2 * EDGE_IN
    entries = [
        (shortened(text, points=9.0, widest_in=room - 0.55), look) for text, look in painter.legend
    ]
    legend = _flowed(entries, room)
    notes = _notes(observation, content, width - 2 * EDGE_IN)
    foot = 0.62 + 0.24 * len(legend) + NOTE_LINE_IN * len(notes) + (0.24 if notes else 0.12)
    height = TITLE_IN + painter.height + foot
    figure = Figure(figsize=(width, height), facecolor="white")
    axes = figure.add_axes(
        (left / width, foot / height, painter.width / width, painter.height / height)
    )
    painter.paint(axes)
    _title(figure, observation, left)
    _legend(figure, legend, top=foot - 0.62)
    for index, line in enumerate(reversed(notes)):
        place = (EDGE_IN / width, (0.12 + index * NOTE_LINE_IN) / height)
        figure.text(*place, line, fontsize=NOTE_POINTS, color=QUIET, va="bottom")
    return figure


def _narrow(row: Row) -> Row:
    """A row whose label leaves room for what it labels."""
    return replace(row, label=shortened(row.label, points=9.5, widest_in=LABEL_IN))


def _width(observation: Observation, left: float) -> float:
    """Wider where a link has many segments [inches]."""
    most = max((len(each.segments) for each in observation.links), default=0)
    return min(max(WIDTH_IN, left + 0.3 * most), WIDEST_IN)


def _title(figure: "Figure", observation: Observation, left: float) -> None:
    width, height = figure.get_size_inches()
    name = observation.complex_par.name or observation.capture
    figure.text(
        left / width, 1 - 0.2 / height, name, fontsize=14, weight="bold", color=INK, va="top"
    )
    who = " and ".join(map(spoken, performers(observation)))
    capture = "" if name == observation.capture else f"{observation.capture} · "
    text = (
        f"{capture}{who} · {observation.duration_s:.2f} s at "
        f"{observation.rate_hz:.4g} Hz · {observation.profile} rules"
    )
    figure.text(left / width, 1 - 0.47 / height, text, fontsize=9, color=QUIET, va="top")


def _flowed(entries: Sequence[Entry], width: float) -> list[list[Entry]]:
    """Names of the legend, broken into lines of at most that width [inches]."""
    lines: list[list[Entry]] = []
    used = width + 1.0
    for entry in entries:
        need = width_in(entry[0], points=9.0) + 0.55
        if used + need > width:
            lines.append([])
            used = 0.0
        lines[-1].append(entry)
        used += need
    return lines


def _legend(figure: "Figure", lines: Sequence[Sequence[Entry]], *, top: float) -> None:
    from matplotlib.patches import Rectangle

    width, height = figure.get_size_inches()
    for index, line in enumerate(lines):
        x, y = EDGE_IN, top - 0.24 * (index + 1)
        for text, look in line:
            figure.add_artist(
                Rectangle(
                    (x / width, (y + 0.03) / height),
                    0.22 / width,
                    0.13 / height,
                    transform=figure.transFigure,
                    **look,
                )
            )
            figure.text((x + 0.28) / width, (y + 0.04) / height, text, fontsize=9, color=INK)
            x += width_in(text, points=9.0) + 0.55


def _notes(observation: Observation, content: Sequence[Row], width: float) -> list[str]:
    """What is assumed, stands in for something else or was lost, in lines that wide [inches]."""
    notes = [
        f"{ASSUMED} {spoken(each.name)} is assumed: {each.assumed}."
        for each in observation.objects
        if each.assumed
    ]
    shapes = stand_ins(observation)
    if shapes:
        parts = [f"{spoken(name)} ({shape})" for name, shape in shapes.items()]
        more = len(parts) - MOST_SHAPES
        told = ", ".join(parts[:MOST_SHAPES]) + (f" and {more} more" if more > 0 else "")
        notes.append(f"{STAND_IN} stand-ins of stated size, not true shapes: {told}.")
    if any(each.lost for each in content):
        notes.append(LOST_NOTE)
    if not is_detailed(observation):
        notes.append(MANY_NOTE)
    columns = max(int(width / width_in("n", points=NOTE_POINTS)), 40)
    return [line for note in notes for line in wrap(note, columns, subsequent_indent="   ")]
