"""Names stand where it is plain which bar they belong to."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from capar.views.lettering import GAP_IN, Placed, Span, place, width_in

WORDS = ["Reach", "MoveObjTo", "ResumePosture", "HandOverWithBothHands", "Lift"]
lengths = st.lists(st.tuples(st.floats(0.05, 20.0), st.sampled_from(WORDS)), max_size=40)


def placed(parts: list[tuple[float, str]], rows_above: int = 2) -> tuple[Placed, ...]:
    spans, now = [], 0.0
    for length, name in parts:
        spans.append(Span(now, now + length, name))
        now += length
    return place(
        spans,
        seconds_per_inch=max(now, 60.0) / 10.0,
        range_s=(0.0, max(now, 60.0)),
        points=9.0,
        rows_above=rows_above,
    )


@given(lengths)
def test_names_in_one_row_never_overlap(parts: list[tuple[float, str]]) -> None:
    out = placed(parts)
    for row in (1, 2):
        names = [each for each in out if each.row == row]
        for one, other in pairwise(names):
            assert one.centre_s + one.half_s <= other.centre_s - other.half_s + 1e-9


@given(lengths)
def test_a_name_is_inside_exactly_where_its_bar_is_wide_enough(
    parts: list[tuple[float, str]],
) -> None:
    out = placed(parts)
    seconds_per_inch = max(sum(length for length, _ in parts), 60.0) / 10.0
    for each in out:
        text = (width_in(each.span.label, points=9.0) + GAP_IN) * seconds_per_inch
        assert (each.row == 0) == (text <= each.span.end_s - each.span.start_s)


@given(lengths)
def test_a_line_from_a_high_name_crosses_no_lower_one(parts: list[tuple[float, str]]) -> None:
    out = placed(parts)
    for high in (each for each in out if each.row == 2):
        assert not any(each.covers(high.middle_s) for each in out if each.row == 1)


@given(lengths)
def test_a_low_name_covers_no_other_bar_that_lacks_its_name(parts: list[tuple[float, str]]) -> None:
    out = placed(parts)
    for low in (each for each in out if each.row == 1):
        others = [each for each in out if each is not low and each.row != 0]
        assert not any(low.covers(each.middle_s) for each in others)


def test_a_wide_bar_holds_its_name_and_a_narrow_one_between_wide_ones_bears_it_above() -> None:
    out = placed([(20.0, "Reach"), (1.0, "Lift"), (20.0, "Reach")])
    assert [each.row for each in out] == [0, 1, 0]
