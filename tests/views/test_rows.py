"""A picture's rows say what the facts say."""

import numpy as np
import pytest
from observations import drink_from_mug

from capar.model.facts import Moving
from capar.views.picture import Kind, frame_clock, rows


def test_a_link_shows_segments_crossings_contacts_and_speed_in_that_order() -> None:
    seen = drink_from_mug()
    speeds = {"right_hand": (np.array([0.0, 1.0]), np.array([0.0, 0.5]))}
    out = rows(seen, speeds)
    assert [each.kind for each in out[:4]] == [Kind.SEGMENTS, Kind.TICKS, Kind.BARS, Kind.CURVE]
    assert [each.label for each in out[:3]] == ["right hand", "zero crossings", "touches mug"]
    assert [each.label for each in out[0].spans] == [each.name for each in seen.segments]


def test_assumed_supports_and_stand_ins_are_marked() -> None:
    labels = [each.label for each in rows(drink_from_mug(), {})]
    assert "mug touches table*" in labels
    assert "mug touches mouth†" in labels


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
