"""A picture's rows say what the facts say."""

from dataclasses import replace

import numpy as np
import pytest
from observations import drink_from_mug, pick_up_with_both_hands

from capar.model.facts import Moving, Touching
from capar.views.picture import MOST_DETAILED, Kind, frame_clock, rows


def test_a_link_shows_segments_crossings_contacts_and_speed_in_that_order() -> None:
    seen = drink_from_mug()
    speeds = {"right_hand": (np.array([0.0, 1.0]), np.array([0.0, 0.5]))}
    out = rows(seen, speeds)
    assert [each.kind for each in out[:4]] == [Kind.SEGMENTS, Kind.TICKS, Kind.BARS, Kind.CURVE]
    assert [each.label for each in out[:3]] == ["right hand", "zero crossings", "touches mug"]
    assert [each.label for each in out[0].spans] == [each.name for each in seen.segments]


def test_a_link_without_a_speed_has_no_curve() -> None:
    assert Kind.CURVE not in {each.kind for each in rows(drink_from_mug(), {})}


def test_what_both_hands_do_as_one_action_has_a_row_of_its_own() -> None:
    (row,) = [each for each in rows(pick_up_with_both_hands(), {}) if each.label == "both hands"]
    assert row.kind is Kind.SEGMENTS
    (span,) = row.spans
    assert (span.start_s, span.end_s, span.label) == (
        pytest.approx(1.4),
        pytest.approx(2.6),
        "MoveObj",
    )
    assert "both hands" not in [each.label for each in rows(drink_from_mug(), {})]


def test_assumed_supports_and_stand_ins_are_marked() -> None:
    labels = [each.label for each in rows(drink_from_mug(), {})]
    assert "mug touches table*" in labels
    assert "mug touches mouth†" in labels


def test_a_contact_of_two_objects_stated_both_ways_is_shown_once() -> None:
    seen = pick_up_with_both_hands()
    turned = tuple(
        Touching(each.other, each.body, each.first, each.last)
        for each in seen.facts
        if isinstance(each, Touching) and each.body == "box"
    )
    both = rows(replace(seen, facts=seen.facts + turned), {})
    assert [each.label for each in both] == [each.label for each in rows(seen, {})]
    assert [each.spans for each in both] == [each.spans for each in rows(seen, {})]


def test_what_moves_has_a_bar_from_its_first_to_its_last_frame() -> None:
    seen = drink_from_mug()
    (move,) = [each for each in seen.facts if isinstance(each, Moving)]
    (row,) = [each for each in rows(seen, {}) if each.kind is Kind.MOTION]
    assert row.label == "mug moves"
    assert row.spans[0].start_s == pytest.approx(move.first / seen.rate_hz)
    assert row.spans[0].end_s == pytest.approx(move.last / seen.rate_hz)


def test_bars_are_marked_where_a_body_of_theirs_was_lost() -> None:
    seen = drink_from_mug()
    lost = np.zeros(seen.frames, dtype=bool)
    lost[200:221] = True
    out = rows(seen, {}, {"mug": lost, "table": np.zeros_like(lost)})
    (start, end) = (frame_clock(seen, {})(each) for each in (200, 220))
    marked = [each.label for each in out if each.lost]
    assert marked == ["touches mug", "mug touches table*", "mug touches mouth†", "mug moves"]
    assert {(span.start_s, span.end_s) for each in out for span in each.lost} == {(start, end)}
    assert not any(each.lost for each in rows(seen, {}))


def test_the_clock_of_the_speeds_wins_over_the_rate() -> None:
    seen = drink_from_mug()
    times = np.linspace(0.0, 1.0, seen.frames) ** 2
    clock = frame_clock(seen, {"right_hand": (times, np.zeros(seen.frames))})
    assert clock(200) == times[200]


def test_without_speeds_the_borders_keep_their_times() -> None:
    seen = drink_from_mug()
    clock = frame_clock(seen, {})
    for each in seen.segments:
        assert clock(each.first) == pytest.approx(each.start_s)
        assert clock(each.last) == pytest.approx(each.end_s)


def test_of_many_links_those_that_handle_objects_stand_first_and_none_has_a_curve() -> None:
    seen = drink_from_mug()
    (link,) = seen.links
    idle = [
        replace(
            link,
            ee=f"toe_{number}",
            segments=tuple(replace(each, objects=()) for each in link.segments),
        )
        for number in range(MOST_DETAILED)
    ]
    speeds = {"right_hand": (np.array([0.0, 1.0]), np.array([0.0, 0.5]))}
    out = rows(replace(seen, links=(*idle, link)), speeds)
    kinds = {each.kind for each in out}
    assert out[0].label == "right hand"
    assert not kinds & {Kind.CURVE, Kind.TICKS}
    assert len([each for each in out if each.kind is Kind.SEGMENTS]) == MOST_DETAILED + 1
