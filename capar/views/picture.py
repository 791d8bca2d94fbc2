"""A picture of an observation over time: its rows, how they are painted, and the files."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from io import BytesIO
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar
from zlib import crc32

import numpy as np
from jaxtyping import Bool, Float

from capar.model.errors import FileError
from capar.model.facts import LookingAt, Moving, Touching, ZeroCrossing
from capar.model.geometry import runs
from capar.model.observation import JointAction, Observation, ObservedLink, ObservedObject, Segment
from capar.model.par import UNKNOWN
from capar.views.lettering import Placed, Span, place, shortened, width_in
from capar.views.tables import performers

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


Speeds = Mapping[str, tuple[Float[np.ndarray, "frames"], Float[np.ndarray, "frames"]]]
"""Of each end-effector: times [s] and speeds [m/s]."""

Lost = Mapping[str, Bool[np.ndarray, "frames"]]
"""Of each body: whether tracking had lost it."""

ASSUMED, STAND_IN = "*", "†"
"""Marks of an object that is assumed, and of a shape that stands in for the true one."""

MOST_NAMED = 4
"""So many who take part in one action are named one by one."""

MOST_DETAILED = 8
"""With more links than these speeds and zero crossings are left out, and those that handle objects
stand first: a whole body with its fingers is looked at as a whole."""

_Name = TypeVar("_Name", str, tuple[str, ...])


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
    out: list[Row] = []
    for link in _links(observation):
        out += _link_rows(observation, link, speeds, clock)
    out += _joint_rows(observation, clock)
    out += _object_rows(observation, clock)
    out = [replace(each, lost=_lost(each.about, lost or {}, clock)) for each in out]
    return (*out, *_gaze_rows(observation, clock))


def is_detailed(observation: Observation) -> bool:
    """Whether there are so few links that each has its speed and its zero crossings."""
    return len(observation.links) <= MOST_DETAILED


def _links(observation: Observation) -> list[ObservedLink]:
    """The links as they are, or, of many, those first that handle objects."""
    if is_detailed(observation):
        return list(observation.links)
    return sorted(
        observation.links, key=lambda link: not any(each.objects for each in link.segments)
    )


def _lost(about: Sequence[str], lost: Lost, clock: Callable[[int], float]) -> tuple[Span, ...]:
    found = [lost[name] for name in about if name in lost]
    missing = runs(np.logical_or.reduce(found)) if found else []
    return tuple(Span(clock(first), clock(last), "") for first, last in missing)


def frame_clock(observation: Observation, speeds: Speeds) -> Callable[[int], float]:
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
    mark = ASSUMED if any(each.assumed for each in _objects(observation, name)) else ""
    return spoken(name) + mark + (STAND_IN if name in stand_ins(observation) else "")


def stand_ins(observation: Observation) -> dict[str, str]:
    """What stands in for the true shape of a body, by the body's name, as its notice says."""
    return {
        each.bodies[0]: str(each["shape"])
        for each in observation.notices
        if each.code == "stand-in-shape"
    }


def _objects(observation: Observation, name: str) -> list[ObservedObject]:
    return [each for each in observation.objects if each.name == name]


def _link_rows(
    observation: Observation, link: ObservedLink, speeds: Speeds, clock: Callable[[int], float]
) -> list[Row]:
    spans = tuple(
        Span(clock(each.first), clock(each.last), each.name, kind_of(each))
        for each in link.segments
    )
    borders = tuple(sorted({each.start_s for each in spans} | {each.end_s for each in spans}))
    crossings = sorted(
        each.frame
        for each in observation.facts
        if isinstance(each, ZeroCrossing) and each.ee == link.ee
    )
    out = [Row(Kind.SEGMENTS, marked(observation, link.ee), spans, borders=borders)]
    ticks = tuple(clock(each) for each in crossings)
    if ticks and is_detailed(observation):
        out.append(Row(Kind.TICKS, "zero crossings", ticks=ticks, borders=borders))
    touched = [each for each in _touching(observation) if each.body == link.ee]
    for name in _in_order(each.other for each in touched):
        bars = tuple(_span(each, clock) for each in touched if each.other == name)
        label = f"touches {marked(observation, name)}"
        out.append(Row(Kind.BARS, label, bars, borders=borders, about=(link.ee, name)))
    if link.ee in speeds and is_detailed(observation):
        out.append(Row(Kind.CURVE, "speed", curve=speeds[link.ee], borders=borders))
    return out


def _joint_rows(observation: Observation, clock: Callable[[int], float]) -> list[Row]:
    """For those who act together: what they do as one action."""
    rows = []
    kinds = _kinds(observation)
    for ees in _in_order(each.who for each in observation.joint):
        joint = [each for each in observation.joint if each.who == ees]
        spans = tuple(
            Span(clock(each.first), clock(each.last), each.name, kinds.get(each.name, each.name))
            for each in joint
        )
        rows.append(Row(Kind.SEGMENTS, _who(observation, joint[0]), spans))
    return rows


def _who(observation: Observation, joint: JointAction) -> str:
    """Who takes part, in few words: of many the first two are named."""
    if len(joint.who) <= MOST_NAMED:
        return observation.who(joint)
    first, second = (spoken(each) for each in joint.who[:2])
    return f"{first}, {second} and {len(joint.who) - 2} more"


def kind_of(segment: Segment) -> str:
    """What kind of action a segment is: the most general name that it specialises, or its own."""
    return segment.general[-1] if segment.general else segment.name


def _kinds(observation: Observation) -> dict[str, str]:
    """The kind of each name that segments have or specialise."""
    return {
        name: kind_of(each) for each in observation.segments for name in (*each.general, each.name)
    }


def _object_rows(observation: Observation, clock: Callable[[int], float]) -> list[Row]:
    acting = {each.ee for each in observation.links}
    between = [each for each in _touching(observation) if each.body not in acting]
    pairs: dict[frozenset[str], list[Touching]] = {}
    for relation in between:
        pairs.setdefault(frozenset((relation.body, relation.other)), []).append(relation)
    out = []
    for found in pairs.values():
        names = (found[0].body, found[0].other)
        label = " touches ".join(marked(observation, each) for each in names)
        bars = tuple(dict.fromkeys(_span(each, clock) for each in found))
        out.append(Row(Kind.BARS, label, bars, about=names))
    moves = sorted(each for each in observation.facts if isinstance(each, Moving))
    for name in _in_order(each.object for each in moves):
        bars = tuple(_span(each, clock) for each in moves if each.object == name)
        label = f"{marked(observation, name)} moves"
        out.append(Row(Kind.MOTION, label, bars, about=(name,)))
    return [Row(Kind.HEADING, "objects"), *out] if out else []


def _gaze_rows(observation: Observation, clock: Callable[[int], float]) -> list[Row]:
    looks = [each for each in observation.facts if isinstance(each, LookingAt)]
    looks.sort(key=lambda each: (each.first, each.last, each.object))
    out = []
    for sensor in _in_order(each.sensor for each in looks):
        spans = tuple(
            Span(clock(each.first), clock(each.last), marked(observation, each.object))
            for each in looks
            if each.sensor == sensor
        )
        out.append(Row(Kind.NAMES, f"{spoken(sensor)} looks at", spans))
    return [Row(Kind.HEADING, "attention"), *out] if out else []


def _touching(observation: Observation) -> list[Touching]:
    found = [each for each in observation.facts if isinstance(each, Touching)]
    return sorted(found, key=lambda each: (each.first, each.last, each.body, each.other))


def _span(fact: Touching | Moving, clock: Callable[[int], float]) -> Span:
    return Span(clock(fact.first), clock(fact.last), "")


def _in_order(names: Iterable[_Name]) -> list[_Name]:
    """Each once, as first met."""
    return list(dict.fromkeys(names))


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
        self._rows = tuple(rows)
        self._seen = sorted(_labels(rows, Kind.NAMES))
        self._placed = {index: self._place(row) for index, row in enumerate(rows)}
        self._tops = self._stack()
        self.height = self._tops[-1] + FOOT_IN
        self.legend = self._legend()
        self._fastest = max((_peak(each) for each in rows), default=0.0)

    def look(self, span: Span, kind: Kind) -> dict[str, Any]:
        """The colours of a bar in a row of that kind; hatching means lost tracking alone."""
        if kind is Kind.NAMES:
            colour = PALE[self._seen.index(span.label) % len(PALE)]
        elif span.label == UNKNOWN:
            return {**UNNAMED, "linewidth": 0.8}
        else:
            colour = colour_of(span.kind or span.label)
        return {"facecolor": colour, "edgecolor": "white", "linewidth": 0.8}

    def paint(self, axes: "Axes") -> None:
        """Put everything on the axes."""
        axes.set_xlim(0.0, self.duration_s)
        axes.set_ylim(self.height, 0.0)
        self._frame(axes)
        for index, row in enumerate(self._rows):
            top, low = self._tops[index], self._tops[index + 1]
            self._borders(axes, row, top, low)
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
        for span in _spans(self._rows, Kind.SEGMENTS):
            kinds.setdefault(span.kind or span.label, set()).add(span.label)
        ordered = sorted(kinds, key=lambda each: (each == UNKNOWN, each))
        out = [
            (_with_names(kind, kinds[kind] - {kind}), Span(0.0, 0.0, kind, kind), Kind.SEGMENTS)
            for kind in ordered
        ]
        if any(
            row.kind is Kind.NAMES and any(each.row < 0 for each in self._placed[index])
            for index, row in enumerate(self._rows)
        ):
            looked = (Span(0.0, 0.0, name) for name in self._seen)
            out += [(f"looks at {each.label}", each, Kind.NAMES) for each in looked]
        return tuple((text, self.look(span, kind)) for text, span, kind in out)

    @property
    def _seconds_per_inch(self) -> float:
        return self.duration_s / self.width

    def _place(self, row: Row) -> tuple[Placed, ...]:
        if row.kind not in POINTS:
            return ()
        return place(
            row.spans,
            seconds_per_inch=self._seconds_per_inch,
            range_s=(0.0, self.duration_s),
            points=POINTS[row.kind],
            rows_above=ROWS_ABOVE[row.kind],
        )

    def _stack(self) -> list[float]:
        """Upper edge of each row, and the lower edge of the last."""
        tops = [0.0]
        for index, row in enumerate(self._rows):
            above = max((each.row for each in self._placed[index]), default=0)
            gap = LINK_GAP_IN if row.kind is Kind.SEGMENTS and index else 0.0
            tops.append(tops[-1] + gap + HEIGHTS_IN[row.kind] + LABEL_ROW_IN * max(above, 0))
        return tops

    def _frame(self, axes: "Axes") -> None:
        for side in ("top", "left", "right"):
            axes.spines[side].set_visible(False)
        axes.spines["bottom"].set_color(QUIET)
        axes.set_yticks([])
        axes.tick_params(axis="x", colors=QUIET, labelsize=9, length=3)
        axes.set_xlabel("time [s]", fontsize=9, color=QUIET, labelpad=2)
        axes.grid(axis="x", color=FAINT, linewidth=0.5)
        axes.set_axisbelow(True)

    def _borders(self, axes: "Axes", row: Row, top: float, low: float) -> None:
        if row.kind is not Kind.SEGMENTS:
            axes.vlines(row.borders, top, low, colors="#a6a6a6", linewidth=0.6, zorder=0.9)

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


def colour_of(kind: str) -> str:
    """The colour of a kind of action: the same in every picture."""
    return COLOURS.get(kind) or OTHERS[crc32(kind.encode()) % len(OTHERS)]


def _with_names(kind: str, names: Collection[str]) -> str:
    """A kind of action, and what else of that kind there is: ``MoveObj (Carry, Drink)``."""
    return f"{kind} ({', '.join(sorted(names))})" if names else kind


def _spans(rows: Sequence[Row], kind: Kind) -> Iterator[Span]:
    return (each for row in rows if row.kind is kind for each in row.spans)


def _labels(rows: Sequence[Row], kind: Kind) -> set[str]:
    return {each.label for each in _spans(rows, kind)}


def _peak(row: Row) -> float:
    """The highest speed of a row [m/s]; zero where it has none."""
    if row.curve is None or not np.isfinite(row.curve[1]).any():
        return 0.0
    return float(np.nanmax(row.curve[1]))


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


TITLE_IN_COMPARISON = 0.75
FOOT_IN_COMPARISON = 0.62
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
        figure = _figure_comparison(title, subtitle, comparison_rows(lanes), duration_s)
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


def _figure_comparison(
    title: str, subtitle: str, content: Sequence[Row], duration_s: float
) -> "Figure":
    from matplotlib.figure import Figure

    left = EDGE_IN + 0.15 + min(max(width_in(each.label, points=9.5) for each in content), LABEL_IN)
    most = max((len(each.spans) for each in content), default=0)
    width = min(max(WIDTH_IN, left + 0.3 * most), WIDEST_IN)
    painter = Painter(content, duration_s, width - left - EDGE_IN - 0.1)
    height = TITLE_IN_COMPARISON + painter.height + FOOT_IN_COMPARISON
    figure = Figure(figsize=(width, height), facecolor="white")
    axes = figure.add_axes(
        (left / width, FOOT_IN_COMPARISON / height, painter.width / width, painter.height / height)
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
