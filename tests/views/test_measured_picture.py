"""In pictures of explanations every name and number can be read: none on another, none cut off."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from capar.pipelines.measured.recording import told_beside
from capar.views import measured_picture
from capar.views.captions import caption_lines
from capar.views.lettering import Span
from capar.views.measured_panel import LIMIT, MARK
from capar.views.measured_picture import MeasuredPicture
from capar.views.panels import Curve, Limit, Mark, Panel, Row

TIMES = np.linspace(0.0, 6.0, 301)
NEIGHBOURS = (
    Span(1.0, 3.0, "Transport"),
    Span(3.0, 3.1, "MoveObjTo"),
    Span(3.1, 5.0, "ResumePosture"),
)


def panel(
    limits: tuple[float, ...] = (), marks: tuple[tuple[float, float], ...] = (), **more: object
) -> Panel:
    """A rising line, with limits at those values and numbers at those times and values."""
    return Panel(
        "the second joint of the left little finger to the large wooden table: distance of their "
        "surfaces (shape of the second joint of the left little finger: a stand-in)",
        "mm",
        (Curve(TIMES, 5.0 * TIMES),),
        tuple(Limit(value, f"counts as contact within {value:.0f} mm") for value in limits),
        tuple(Mark(time, value, f"{value:.0f} mm (a change of 18 mm)") for time, value in marks),
        **more,  # type: ignore[arg-type]
    )


def drawn(*panels: Panel) -> Figure:
    picture = MeasuredPicture(
        "left_hand/2  MoveObjTo",
        "MoveObjTo, because it is told here in 12 mm.",
        NEIGHBOURS,
        NEIGHBOURS[1],
        panels,
        (2.0, 5.0),
        (Row("hand: counts as at rest", (Span(2.5, 3.0, ""),)),),
    )
    figure = measured_picture._figure(picture)
    FigureCanvasAgg(figure).draw()
    return figure


def letters(figure: Figure, *colours: str) -> list[tuple[str, Bbox]]:
    """What is written in some colours, or at all, and where."""
    texts = [text for axes in figure.axes for text in axes.texts] + list(figure.texts)
    wanted = [text for text in texts if not colours or text.get_color() in colours]
    return [(text.get_text(), Text.get_window_extent(text)) for text in wanted]


@pytest.mark.parametrize("limits", [(16.0,), (16.0, 16.4), (15.0, 15.2, 15.4), (1.0, 29.0)])
def test_names_of_limits_stand_on_nothing_else(limits: tuple[float, ...]) -> None:
    figure = drawn(panel(limits, marks=((3.0, 15.0), (3.1, 15.5))), panel((2.0,)))
    named = letters(figure, LIMIT)
    assert len(named) == len(limits) + 1
    for (one, box), (other, beside) in combinations(named, 2):
        assert not box.overlaps(beside), (one, other)
    for axes in figure.axes:
        assert not any(axes.get_window_extent().overlaps(box) for _, box in named)


@pytest.mark.parametrize(
    "marks",
    [
        ((3.0, 15.0), (3.1, 15.5)),
        ((3.0, 24.0), (3.0, 20.0)),
        ((3.1, 12.0), (3.1, 15.5), (3.2, 16.0)),
        ((4.9, 24.5), (4.95, 24.7)),
    ],
)
def test_numbers_beside_each_other_stand_apart(marks: tuple[tuple[float, float], ...]) -> None:
    numbers = letters(drawn(panel(marks=marks)), MARK)
    assert len(numbers) == len(marks)
    for (_, one), (_, other) in combinations(numbers, 2):
        assert not one.overlaps(other)


def test_a_number_that_is_told_twice_at_one_place_is_written_once() -> None:
    assert len(letters(drawn(panel(marks=((3.0, 15.0), (3.0, 15.0)))), MARK)) == 1


def test_nothing_is_cut_off_at_the_edges() -> None:
    figure = drawn(panel((16.0, 16.3), marks=((3.0, 15.0), (4.95, 24.7)), bars=NEIGHBOURS[:1]))
    page = figure.bbox
    for text, box in letters(figure):
        assert page.x0 <= box.x0 and box.x1 <= page.x1, text
        assert page.y0 <= box.y0 and box.y1 <= page.y1, text


def test_a_name_that_reaches_over_its_neighbours_covers_no_other_name() -> None:
    figure = drawn(panel())
    names = [(text, box) for text, box in letters(figure) if text[:4] in ("Tran", "Move", "Resu")]
    strip = [(text, box) for text, box in names if "because" not in text]
    assert len(strip) == 3
    for (one, box), (other, beside) in combinations(strip, 2):
        assert not box.overlaps(beside), (one, other)


def caption(shown: Panel) -> str:
    return " ".join(caption_lines(shown, NEIGHBOURS[1], (2.0, 5.0), 8.0)).replace("\u00a0", " ")


def test_a_caption_tells_what_is_cut_off_and_another_axis_of_time() -> None:
    told = caption(panel(highest=20.0, beyond="what is faster", span_s=(0.0, 5.0)))
    assert "what is faster is cut off" in told
    assert "its own axis of time, from 0.00 to 5.00 s" in told
    assert "cut off outside of the segment" in caption(panel(marks=((3.0, 15.0),)))
    level = Panel("height", "cm", (Curve(TIMES, np.ones(301)),))
    assert caption(level) == "height [cm]"


def captions(figure: Figure) -> list[Text]:
    texts = [text for axes in figure.axes for text in axes.texts]
    return [text for text in texts if text.get_text().startswith("the second joint")]


def test_every_line_of_a_caption_fits_and_none_is_a_word_alone() -> None:
    (written,) = captions(drawn(panel(limits=(16.0,))))
    lines = written.get_text().split("\n")
    assert len(lines) > 1
    assert len(lines[-1]) > 0.5 * len(lines[0])


def crosses(box: Bbox, axes: Axes) -> bool:
    """Whether a curve or a dashed line of a panel goes through a box."""
    for line in axes.lines:
        if line.get_marker() == "o":
            continue
        x, y = (np.asarray(values, dtype=float) for values in line.get_data())
        share = np.linspace(0.0, len(x) - 1.0, 4001)
        at = np.column_stack([np.interp(share, np.arange(len(x)), one) for one in (x, y)])
        at = line.get_transform().transform(at)
        inside = (at > [box.x0, box.y0]) & (at < [box.x1, box.y1])
        if inside.all(axis=1).any():
            return True
    return False


@pytest.mark.parametrize("value", [0.5, 5.0, 15.0, 29.0])
@pytest.mark.parametrize("limits", [(), (15.2,), (4.0, 28.0)])
def test_no_number_stands_on_a_curve_or_a_dashed_line(
    value: float, limits: tuple[float, ...]
) -> None:
    figure = drawn(panel(limits, marks=((3.0, 15.0), (value / 5.0, value))))
    for axes in figure.axes:
        for text in axes.texts:
            if text.get_color() == MARK:
                assert not crosses(Text.get_window_extent(text), axes), text.get_text()


def test_the_name_of_a_narrow_segment_stands_above_the_strip() -> None:
    figure = drawn(panel())
    strip = figure.axes[0]
    (name,) = (text for text in strip.texts if text.get_text() == "MoveObjTo")
    bars = [patch.get_window_extent() for patch in strip.patches]
    assert not any(Text.get_window_extent(name).overlaps(bar) for bar in bars)


def test_what_is_near_a_limit_is_told_apart_from_it() -> None:
    limits = (Limit(20.0, "within 20 mm"),)

    def form(value: float) -> str:
        return f"{value:.0f} mm"

    told = [told_beside(value, limits, form, " mm") for value in (12.3, 19.7, 19.98, 20.0)]
    assert told == ["12 mm", "19.7 mm", "19.98 mm", "20 mm"]
