"""A picture of an observation over time: its rows, how they are painted, and the files."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from io import BytesIO
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, TypeAlias
from zlib import crc32

import numpy as np
from jaxtyping import Bool, Float

from capar.model.errors import FileError
from capar.model.facts import LookingAt, Moving, Touching, ZeroCrossing
from capar.model.geometry import runs
from capar.model.observation import Observation, ObservedLink, Segment
from capar.model.par import UNKNOWN
from capar.views.lettering import Placed, Span, place, shortened, width_in
from capar.views.tables import performers

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


Speeds = Mapping[str, tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]]
"""Of each end-effector: times [s] and speeds [m/s]."""

Clock = Callable[[int], float]
"""The time of a frame [s]."""

Lost = Mapping[str, Bool[np.ndarray, "frames"]]
"""Of each body: whether tracking had lost it."""

ASSUMED, STAND_IN = "*", "†"
"""Marks of an object that is assumed, and of a shape that stands in for the true one."""

MOST_NAMED = 4
"""So many who take part in one action are named one by one."""

MOST_DETAILED = 8
"""With more links than these speeds and zero crossings are left out, and those that handle objects
stand first: a whole body with its fingers is looked at as a whole."""


class Kind(Enum):
    """How a row is drawn."""

    HEADING = auto()
    SEGMENTS = auto()
    TICKS = auto()
    BARS = auto()
    MOTION = auto()
    NAMES = auto()
    CURVE = auto()


@dataclass(frozen=True)
class Row:
    """One row: what stands at its left, and what along time."""

    kind: Kind
    label: str
    spans: tuple[Span, ...] = ()
    ticks: tuple[float, ...] = ()
    curve: tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]] | None = None
    borders: tuple[float, ...] = ()
    """Times at which a fine line crosses the row: the borders of its link's segments."""

    lost: tuple[Span, ...] = ()
    """When tracking had lost a body that the row is about."""

    about: tuple[str, ...] = ()
    """The bodies whose contact or motion its bars show."""


def rows(observation: Observation, speeds: Speeds, lost: Lost | None = None) -> tuple[Row, ...]:
    """Every row, from the top: each link, what several do as one action, objects, and gaze."""
    clock = frame_clock(observation, speeds)
    links = list(observation.links)
    if not is_detailed(observation):
        links.sort(key=lambda link: not any(each.objects for each in link.segments))
    out: list[Row] = []
    for link in links:
        out += _link_rows(observation, link, speeds, clock)
    out += _joint_rows(observation, clock)
    out += _object_rows(observation, clock)
    for index, row in enumerate(out):
        found = [lost[name] for name in row.about if name in lost] if lost else []
        missing = runs(np.logical_or.reduce(found)) if found else []
        spans = tuple(Span(clock(first), clock(last), "") for first, last in missing)
        out[index] = replace(row, lost=spans)
    return (*out, *_gaze_rows(observation, clock))


def is_detailed(observation: Observation) -> bool:
    """Whether there are so few links that each has its speed and its zero crossings."""
    return len(observation.links) <= MOST_DETAILED


def frame_clock(observation: Observation, speeds: Speeds) -> Clock:
    """The time of a frame [s].

    It is exact where a speed is given for every frame; else it is interpolated between the
    segments' borders, whose times are known.
    """
    for times, _ in speeds.values():
        if len(times) == observation.frames:
            exact = np.asarray(times, dtype=float)
            return lambda frame: float(exact[min(max(frame, 0), len(exact) - 1)])
    known = {0: 0.0, observation.frames - 1: observation.duration_s}
    known |= {each.first: each.start_s for each in observation.segments}
    known |= {each.last: each.end_s for each in observation.segments}
    frames = sorted(known)
    seconds = [known[frame] for frame in frames]
    return lambda frame: float(np.interp(frame, frames, seconds))


def spoken(name: str) -> str:
    """A name as people write it."""
    return name.replace("_", " ")


def marked(observation: Observation, name: str) -> str:
    """An object's name with the marks that the footnote explains."""
    assumed = any(each.assumed for each in observation.objects if each.name == name)
    stand_in = STAND_IN if name in stand_ins(observation) else ""
    return spoken(name) + (ASSUMED if assumed else "") + stand_in


def stand_ins(observation: Observation) -> dict[str, str]:
    """What stands in for the true shape of a body, by the body's name, as its notice says."""
    return {
        each.bodies[0]: str(each["shape"])
        for each in observation.notices
        if each.code == "stand-in-shape"
    }


def _spans(
    found: Iterable[Any], clock: Clock, label: Callable[[Any], str] = lambda _: "", kind: Any = None
) -> tuple[Span, ...]:
    """Segments, joint actions or facts of intervals as spans of time."""
    return tuple(
        Span(clock(each.first), clock(each.last), label(each), kind(each) if kind else "")
        for each in found
    )


def _link_rows(
    observation: Observation, link: ObservedLink, speeds: Speeds, clock: Clock
) -> list[Row]:
    spans = _spans(link.segments, clock, lambda each: str(each.name), kind_of)
    borders = tuple(sorted({each.start_s for each in spans} | {each.end_s for each in spans}))
    ticks = sorted(
        clock(each.frame)
        for each in observation.facts
        if isinstance(each, ZeroCrossing) and each.ee == link.ee
    )
    out = [Row(Kind.SEGMENTS, marked(observation, link.ee), spans, borders=borders)]
    if ticks and is_detailed(observation):
        out.append(Row(Kind.TICKS, "zero crossings", ticks=tuple(ticks), borders=borders))
    touched = [each for each in _touching(observation) if each.body == link.ee]
    for name in dict.fromkeys(each.other for each in touched):
        bars = _spans((each for each in touched if each.other == name), clock)
        label = f"touches {marked(observation, name)}"
        out.append(Row(Kind.BARS, label, bars, borders=borders, about=(link.ee, name)))
    if link.ee in speeds and is_detailed(observation):
        out.append(Row(Kind.CURVE, "speed", curve=speeds[link.ee], borders=borders))
    return out


def _joint_rows(observation: Observation, clock: Clock) -> list[Row]:
    """For those who act together: what they do as one action; of many two are named."""
    kinds = {
        name: kind_of(each) for each in observation.segments for name in (*each.general, each.name)
    }
    rows = []
    for ees in dict.fromkeys(each.who for each in observation.joint):
        joint = [each for each in observation.joint if each.who == ees]
        who = observation.who(joint[0])
        if len(ees) > MOST_NAMED:
            who = f"{spoken(ees[0])}, {spoken(ees[1])} and {len(ees) - 2} more"
        spans = _spans(joint, clock, lambda e: str(e.name), lambda e: kinds.get(e.name, e.name))
        rows.append(Row(Kind.SEGMENTS, who, spans))
    return rows


def kind_of(segment: Segment) -> str:
    """What kind of action a segment is: the most general name that it specialises, or its own."""
    return segment.general[-1] if segment.general else segment.name


def _object_rows(observation: Observation, clock: Clock) -> list[Row]:
    acting = {each.ee for each in observation.links}
    pairs: dict[frozenset[str], list[Touching]] = {}
    for each in _touching(observation):
        if each.body not in acting:
            pairs.setdefault(frozenset((each.body, each.other)), []).append(each)
    out = []
    for found in pairs.values():
        names = (found[0].body, found[0].other)
        label = " touches ".join(marked(observation, each) for each in names)
        bars = tuple(dict.fromkeys(_spans(found, clock)))
        out.append(Row(Kind.BARS, label, bars, about=names))
    moves = sorted(each for each in observation.facts if isinstance(each, Moving))
    for name in dict.fromkeys(each.object for each in moves):
        bars = _spans((each for each in moves if each.object == name), clock)
        out.append(Row(Kind.MOTION, f"{marked(observation, name)} moves", bars, about=(name,)))
    return [Row(Kind.HEADING, "objects"), *out] if out else []


def _gaze_rows(observation: Observation, clock: Clock) -> list[Row]:
    looks = [each for each in observation.facts if isinstance(each, LookingAt)]
    looks.sort(key=lambda each: (each.first, each.last, each.object))
    out = []
    for sensor in dict.fromkeys(each.sensor for each in looks):
        own = (each for each in looks if each.sensor == sensor)
        spans = _spans(own, clock, lambda each: marked(observation, each.object))
        out.append(Row(Kind.NAMES, f"{spoken(sensor)} looks at", spans))
    return [Row(Kind.HEADING, "attention"), *out] if out else []


def _touching(observation: Observation) -> list[Touching]:
    found = [each for each in observation.facts if isinstance(each, Touching)]
    return sorted(found, key=lambda each: (each.first, each.last, each.body, each.other))


INK, QUIET, FAINT = "#1a1a1a", "#5c5c5c", "#d9d9d9"
CONTACT, MOTION, SPEED = "#4477AA", "#CCBB44", "#333333"
COLOURS = {
    "LookAt": "#FFAABB",
    "MoveObj": "#EE8866",
    "MoveObjTo": "#EEDD88",
    "PostureChange": "#C9A6DE",
    "Reach": "#77AADD",
    "Rest": "#DDDDDD",
    "ResumePosture": "#BBCC33",
    "Touch": "#44BB99",
}
"""The colour of each most general kind of action: light, under dark letters, and such that people
who are colour-blind can tell them apart (P. Tol)."""

OTHERS = ("#99DDFF", "#AAAA00", "#D9B99B", "#B7C9A6")
"""Colours of kinds that only a user's rules have, by their names."""

PALE = ("#BBCCEE", "#CCDDAA", "#FFCCCC", "#EEEEBB", "#CCEEFF", "#DDDDDD")
"""Paler ones, for what is looked at, by its place in the alphabet (P. Tol)."""

UNNAMED: dict[str, Any] = {"facecolor": "white", "edgecolor": QUIET, "linestyle": "--"}
"""How a segment looks that no rule names."""

HEIGHTS_IN = {
    Kind.HEADING: 0.34,
    Kind.SEGMENTS: 0.36,
    Kind.TICKS: 0.2,
    Kind.BARS: 0.2,
    Kind.MOTION: 0.2,
    Kind.NAMES: 0.24,
    Kind.CURVE: 0.8,
}
LOST: dict[str, Any] = {"facecolor": "none", "edgecolor": QUIET, "hatch": "/////", "linewidth": 0}
"""How frames look in which tracking had lost a body."""

LABEL_ROW_IN = 0.17
LINK_GAP_IN = 0.2
FOOT_IN = 0.06
"""Room between the last row and the time axis [inches]."""
POINTS = {Kind.SEGMENTS: 9.0, Kind.NAMES: 8.0}
ROWS_ABOVE = {Kind.SEGMENTS: 2, Kind.NAMES: 0}
THINNEST_IN = 0.02
"""A shorter bar is drawn this wide, so that it can be seen."""


class Painter:
    """The rows with their places and colours, ready to be painted.

    Attributes:
        width: Of the axes [inches].
        height: Of the axes [inches].
        legend: What each colour means, with its look; what is looked at where some of it found
            no room.
    """

    def __init__(self, rows: Sequence[Row], duration_s: float, width_in: float) -> None:
        self.width = width_in
        self.duration_s = duration_s
        self._seconds_per_inch = duration_s / width_in
        self._rows = tuple(rows)
        self._seen = sorted({e.label for row in rows if row.kind is Kind.NAMES for e in row.spans})
        self._placed = {
            index: place(
                row.spans,
                seconds_per_inch=self._seconds_per_inch,
                range_s=(0.0, duration_s),
                points=POINTS[row.kind],
                rows_above=ROWS_ABOVE[row.kind],
            )
            for index, row in enumerate(rows)
            if row.kind in POINTS
        }
        self._tops = [0.0]
        """Upper edge of each row, and the lower edge of the last."""
        for index, row in enumerate(rows):
            above = max((each.row for each in self._placed.get(index, ())), default=0)
            gap = LINK_GAP_IN if row.kind is Kind.SEGMENTS and index else 0.0
            height = gap + HEIGHTS_IN[row.kind] + LABEL_ROW_IN * max(above, 0)
            self._tops.append(self._tops[-1] + height)
        self.height = self._tops[-1] + FOOT_IN
        self.legend = self._legend()
        speeds = [each.curve[1] for each in rows if each.curve is not None]
        finite = [each[np.isfinite(each)] for each in map(np.asarray, speeds)]
        self._fastest = max((float(each.max()) for each in finite if each.size), default=0.0)

    def look(self, span: Span, kind: Kind) -> dict[str, Any]:
        """The colours of a bar in a row of that kind; hatching means lost tracking alone."""
        if kind is Kind.NAMES:
            colour = PALE[self._seen.index(span.label) % len(PALE)]
        elif span.label == UNKNOWN:
            return {**UNNAMED, "linewidth": 0.8}
        else:
            kind_name = span.kind or span.label
            colour = COLOURS.get(kind_name) or OTHERS[crc32(kind_name.encode()) % len(OTHERS)]
        return {"facecolor": colour, "edgecolor": "white", "linewidth": 0.8}

    def paint(self, axes: "Axes") -> None:
        """Put everything on the axes."""
        axes.set_xlim(0.0, self.duration_s)
        axes.set_ylim(self.height, 0.0)
        for side in ("top", "left", "right"):
            axes.spines[side].set_visible(False)
        axes.spines["bottom"].set_color(QUIET)
        axes.set_yticks([])
        axes.tick_params(axis="x", colors=QUIET, labelsize=9, length=3)
        axes.set_xlabel("time [s]", fontsize=9, color=QUIET, labelpad=2)
        axes.grid(axis="x", color=FAINT, linewidth=0.5)
        axes.set_axisbelow(True)
        for index, row in enumerate(self._rows):
            top, low = self._tops[index], self._tops[index + 1]
            if row.kind is not Kind.SEGMENTS:
                axes.vlines(row.borders, top, low, colors="#a6a6a6", linewidth=0.6, zorder=0.9)
            {
                Kind.HEADING: self._heading,
                Kind.SEGMENTS: self._segments,
                Kind.TICKS: self._ticks,
                Kind.BARS: self._bars,
                Kind.MOTION: self._bars,
                Kind.NAMES: self._looks,
                Kind.CURVE: self._curve,
            }[row.kind](axes, index, low)

    def _legend(self) -> tuple[tuple[str, dict[str, Any]], ...]:
        kinds: dict[str, set[str]] = {}
        for row in self._rows:
            for span in row.spans if row.kind is Kind.SEGMENTS else ():
                kinds.setdefault(span.kind or span.label, set()).add(span.label)
        out = []
        for kind in sorted(kinds, key=lambda each: (each == UNKNOWN, each)):
            others = ", ".join(sorted(kinds[kind] - {kind}))
            text = f"{kind} ({others})" if others else kind
            out.append((text, self.look(Span(0.0, 0.0, kind, kind), Kind.SEGMENTS)))
        if any(
            each.row < 0
            for index, placed in self._placed.items()
            for each in placed
            if self._rows[index].kind is Kind.NAMES
        ):
            for name in self._seen:
                out.append((f"looks at {name}", self.look(Span(0.0, 0.0, name), Kind.NAMES)))
        return tuple(out)

    def _name(self, axes: "Axes", text: str, y: float, **style: Any) -> None:
        axes.annotate(
            text,
            (0.0, y),
            xytext=(-8, 0),
            textcoords="offset points",
            ha="right",
            va="center",
            annotation_clip=False,
            **{"fontsize": 8.5, "color": QUIET, **style},
        )

    def _box(self, axes: "Axes", span: Span, y: float, tall: float, **look: Any) -> None:
        from matplotlib.patches import Rectangle

        wide = max(span.end_s - span.start_s, THINNEST_IN * self._seconds_per_inch)
        axes.add_patch(Rectangle((span.start_s, y), wide, tall, **look))

    def _heading(self, axes: "Axes", index: int, low: float) -> None:
        self._name(axes, self._rows[index].label, low - 0.1, fontsize=9.5, color=INK, weight="bold")

    def _segments(self, axes: "Axes", index: int, low: float) -> None:
        tall = HEIGHTS_IN[Kind.SEGMENTS] - 0.04
        bar = low - tall - 0.02
        self._name(
            axes, self._rows[index].label, bar + tall / 2, fontsize=9.5, color=INK, weight="bold"
        )
        for placed in self._placed[index]:
            look = self.look(placed.span, Kind.SEGMENTS)
            self._box(axes, placed.span, bar, tall, **look, zorder=2)
            self._letter(axes, placed, bar, tall, Kind.SEGMENTS)

    def _letter(self, axes: "Axes", each: Placed, bar: float, tall: float, kind: Kind) -> None:
        if each.row < 0:
            return
        y = bar + tall / 2 if each.row == 0 else bar - 0.09 - LABEL_ROW_IN * (each.row - 1)
        style: dict[str, Any] = {
            "fontsize": POINTS[kind],
            "color": INK,
            "ha": "center",
            "va": "center",
        }
        axes.text(each.centre_s, y, each.span.label, zorder=4, **style)
        if each.row > 1:
            axes.vlines(each.middle_s, y + 0.07, bar, colors=QUIET, linewidth=0.6, zorder=1)

    def _ticks(self, axes: "Axes", index: int, low: float) -> None:
        row = self._rows[index]
        self._name(axes, row.label, low - 0.1, fontsize=8)
        axes.vlines(row.ticks, low - 0.17, low - 0.05, colors=INK, linewidth=0.8, zorder=3)

    def _bars(self, axes: "Axes", index: int, low: float) -> None:
        row = self._rows[index]
        self._name(axes, row.label, low - 0.1)
        colour = MOTION if row.kind is Kind.MOTION else CONTACT
        for span in row.spans:
            self._box(axes, span, low - 0.16, 0.12, facecolor=colour, zorder=2)
        for span in row.lost:
            self._box(axes, span, low - 0.16, 0.12, **LOST, zorder=2.5)

    def _looks(self, axes: "Axes", index: int, low: float) -> None:
        self._name(axes, self._rows[index].label, low - 0.12)
        for placed in self._placed[index]:
            look = self.look(placed.span, Kind.NAMES)
            self._box(axes, placed.span, low - 0.21, 0.18, **look, zorder=2)
            self._letter(axes, placed, low - 0.21, 0.18, Kind.NAMES)

    def _curve(self, axes: "Axes", index: int, low: float) -> None:
        curve = self._rows[index].curve
        assert curve is not None, "a row of this kind is made with its curve"
        tall = HEIGHTS_IN[Kind.CURVE] - 0.12
        times, speeds = curve
        heights = low - 0.02 - np.asarray(speeds) / (self._fastest or 1.0) * tall
        axes.plot(times, heights, color=SPEED, linewidth=1.0, zorder=3)
        axes.hlines(low - 0.02, 0.0, self.duration_s, colors=FAINT, linewidth=0.6, zorder=1)
        self._name(axes, f"{self._fastest:.2g} m/s", low - 0.02 - tall, fontsize=7.5)
        self._name(axes, self._rows[index].label, low - 0.02 - tall / 2)
        self._name(axes, "0", low - 0.03, fontsize=7.5)


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
    save(lambda: _figure(observation, rows(observation, speeds, lost)), path)


def svg(observation: Observation) -> str:
    """The picture as the text of an SVG, without the speeds, which an observation does not hold."""
    return _drawn(lambda: _figure(observation, rows(observation, {})), ".svg").decode("utf-8")


def save(figure: "Callable[[], Figure]", path: Path) -> None:
    """Make a figure with the settings of every picture, and write it in the format of the suffix.

    Raises:
        FileError: The suffix is no picture's, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise FileError(
            path, f"no picture format {path.suffix!r};", f"there are: {', '.join(SUFFIXES)}."
        )
    data = _drawn(figure, suffix)
    try:
        path.write_bytes(data)
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}.") from None


def _drawn(figure: "Callable[[], Figure]", suffix: str) -> bytes:
    import matplotlib as mpl

    settings: dict[Any, Any] = {
        "svg.hashsalt": "capar",
        "font.family": "DejaVu Sans",
        "hatch.linewidth": 0.6,
        "text.parse_math": False,
    }
    out = BytesIO()
    with mpl.rc_context(rc={**dict(mpl.rcParamsDefault), **settings, "backend": "agg"}):
        figure().savefig(out, dpi=DPI, metadata=SUFFIXES[suffix], format=suffix[1:])
    return out.getvalue()


def _figure(observation: Observation, content: Sequence[Row]) -> "Figure":
    """Lay the rows out, then the time axis, the legend and the footnote under them."""
    name = observation.complex_par.name or observation.capture
    capture = "" if name == observation.capture else f"{observation.capture} · "
    subtitle = (
        f"{capture}{' and '.join(map(spoken, performers(observation)))} · "
        f"{observation.duration_s:.2f} s at {observation.rate_hz:.4g} Hz · "
        f"{observation.profile} rules"
    )
    most = max((len(each.segments) for each in observation.links), default=0)
    return _laid_out((name, subtitle), content, observation.duration_s, most=most, seen=observation)


def _laid_out(
    titles: tuple[str, str],
    content: Sequence[Row],
    duration_s: float,
    *,
    most: int,
    seen: Observation | None = None,
) -> "Figure":
    """Rows under a title and a subtitle, wider where a row has many spans.

    Args:
        titles: Title and subtitle.
        content: The rows.
        duration_s: The time that is shown [s].
        most: How many spans stand in a row at most.
        seen: Whose legend and notes stand below; None for none.
    """
    from matplotlib.figure import Figure

    content = [
        replace(row, label=shortened(row.label, points=9.5, widest_in=LABEL_IN)) for row in content
    ]
    left = EDGE_IN + 0.15 + max(width_in(each.label, points=9.5) for each in content)
    width = min(max(WIDTH_IN, left + 0.3 * most), WIDEST_IN)
    painter = Painter(content, duration_s, width - left - EDGE_IN - 0.1)
    room = width - 2 * EDGE_IN
    legend: list[list[Entry]] = []
    notes: list[str] = []
    foot = 0.62
    if seen is not None:
        cut = [
            (shortened(e, points=9.0, widest_in=room - 0.55), look) for e, look in painter.legend
        ]
        legend, notes = _flowed(cut, room), _notes(seen, content, room)
        foot += 0.24 * len(legend) + NOTE_LINE_IN * len(notes) + (0.24 if notes else 0.12)
    height = TITLE_IN + painter.height + foot
    figure = Figure(figsize=(width, height), facecolor="white")
    axes = figure.add_axes(
        (left / width, foot / height, painter.width / width, painter.height / height)
    )
    painter.paint(axes)
    heading: dict[str, Any] = {"fontsize": 14, "weight": "bold", "color": INK}
    figure.text(left / width, 1 - 0.2 / height, titles[0], va="top", **heading)
    figure.text(left / width, 1 - 0.47 / height, titles[1], va="top", fontsize=9, color=QUIET)
    _legend(figure, legend, top=foot - 0.62)
    for index, line in enumerate(reversed(notes)):
        place = (EDGE_IN / width, (0.12 + index * NOTE_LINE_IN) / height)
        figure.text(*place, line, fontsize=NOTE_POINTS, color=QUIET, va="bottom")
    return figure


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
    content: list[Row] = []
    for lane in lanes:
        head = Kind.SEGMENTS if lane.segments else Kind.HEADING
        content += [
            Row(head, lane.name, lane.segments),
            Row(Kind.NAMES, "found", lane.found),
            Row(Kind.NAMES, "labelled", lane.true),
            Row(Kind.BARS, "differs", lane.wrong),
        ]
    most = max((len(each.spans) for each in content), default=0)
    save(lambda: _laid_out((title, subtitle), content, duration_s, most=most), path)
