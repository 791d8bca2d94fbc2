"""Sampled tracks answer where a body was and how fast it went at any time."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from actionaries import STORES, opened
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from observations import drink_from_mug

from capar.model.errors import CaparError, ParError
from capar.model.locations import UNIT_M, SampledTrack, sampled_track
from kb.actionary import Actionary
from kb.queries.questions import check_known, question
from kb.store.statements import LiteralError, track, track_of

STEP_S = 0.02
CLOCK = np.arange(0.0, 2.001, STEP_S)
CIRCLE = np.stack([np.cos(CLOCK), np.sin(CLOCK), np.full_like(CLOCK, 0.8)], axis=1)
"""A body on a circle of one metre at one radian a second: its speed is 1 m/s."""

LOST_AT = 1.5


def made() -> Actionary:
    lost = np.where((CLOCK > LOST_AT)[:, None], np.nan, CIRCLE + np.array([0.3, 0.4, 0.0]))
    tracks = (
        sampled_track("mug", STEP_S, CIRCLE),
        sampled_track("right_hand", STEP_S, lost),
        sampled_track("table", 0.0, np.array([[0.0, 0.0, 0.8]])),
    )
    actionary = Actionary.in_memory()
    actionary.add(replace(drink_from_mug(), tracks=tracks))
    return actionary


@pytest.fixture(scope="module")
def turning() -> Iterator[Actionary]:
    with made() as actionary:
        yield actionary


def value(actionary: Actionary, expression: str) -> object:
    asked = f"SELECT ({expression} AS ?v) WHERE {{ ?o a capar:Observation }}"
    (row,) = actionary.query(asked).plain()
    return row["v"]


def test_a_place_is_known_at_any_time(turning: Actionary) -> None:
    for time in (0.0, 0.513, 2.0):
        for axis, expected in enumerate((np.cos(time), np.sin(time), 0.8)):
            found = value(turning, f"capar:element(capar:position(?o, 'mug', {time}), {axis})")
            assert found == pytest.approx(expected, abs=1e-4 + STEP_S**2 / 8)


def test_speeds_ways_and_distances_are_those_of_the_circle(turning: Actionary) -> None:
    assert value(turning, "capar:speed(?o, 'mug', 1.003)") == pytest.approx(1.0, abs=0.01)
    assert value(turning, "capar:highestSpeed(?o, 'mug', 0.2, 1.7)") == pytest.approx(1, abs=0.01)
    assert value(turning, "capar:pathLength(?o, 'mug', 0.25, 1.55)") == pytest.approx(1.3, abs=0.01)
    apart = value(turning, "capar:distance(?o, 'mug', 'right_hand', 0.7)")
    assert apart == pytest.approx(0.5, abs=1e-3)
    assert value(turning, "capar:distance(?o, 'mug', 'table', 0.7)") == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize(
    "expression",
    [
        "capar:position(?o, 'right_hand', 1.8)",
        "capar:position(?o, 'mug', 2.5)",
        "capar:position(?o, 'mug', -0.1)",
        "capar:position(?o, 'ladle', 1)",
        "capar:position(?o, 'mug', 'noon')",
        "capar:highestSpeed(?o, 'mug', 1.2, 1.1)",
        "capar:pathLength(?o, 'right_hand', 1, 1.9)",
        "capar:highestSpeed(?o, 'right_hand', 1, 1.9)",
    ],
)
def test_what_is_not_known_has_no_value(turning: Actionary, expression: str) -> None:
    assert value(turning, expression) is None


def test_a_body_may_be_given_by_what_it_is(turning: Actionary) -> None:
    rows = turning.query(
        "SELECT (capar:element(capar:position(?o, ?b, 0), 0) AS ?x) "
        "WHERE { ?o a capar:Observation ; capar:object ?b . ?b capar:name 'mug' }"
    ).plain()
    assert [row["x"] for row in rows] == [pytest.approx(1.0)]


@pytest.mark.parametrize("kind", STORES)
def test_every_store_opens_tracks(
    kind: str, tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> None:
    asked = (
        "SELECT (capar:element(capar:position(?o, 'mug', 1.0), 1) AS ?y) "
        "WHERE { ?o a capar:Observation }"
    )
    with opened(kind, tmp_path_factory.mktemp(kind), request) as actionary:
        actionary.add(replace(drink_from_mug(), tracks=(sampled_track("mug", STEP_S, CIRCLE),)))
        (row,) = actionary.query(asked).plain()
        assert row["y"] == pytest.approx(np.sin(1.0), abs=1e-4)


PLACES = arrays(np.float64, st.tuples(st.integers(1, 30), st.just(3)), elements=st.floats(-99, 99))


@given(PLACES, st.floats(1e-3, 1.0))
def test_places_come_back_to_a_tenth_of_a_millimetre(places: np.ndarray, step: float) -> None:
    kept = sampled_track("mug", step, places)
    again = track_of(track(kept).value)
    assert again.step_s == step
    assert np.abs(again.positions - places).max() <= UNIT_M / 2 + 1e-9


def test_a_loss_comes_back_as_one() -> None:
    places = np.array([[0.0, 1.0, 2.0], [np.nan] * 3])
    assert np.isnan(sampled_track("mug", 0.1, places).positions).tolist() == [
        [False] * 3,
        [True] * 3,
    ]


@pytest.mark.parametrize("samples", ["", "?", "AAAA"])
def test_damaged_samples_are_refused(samples: str) -> None:
    with pytest.raises(ParError, match="'mug' are no Base64"):
        SampledTrack("mug", 0.1, samples)
    with pytest.raises(LiteralError):
        track_of(f"0.1 {samples}")


def test_where_a_body_was_while_it_was_lost_is_told_with_when(turning: Actionary) -> None:
    capture = turning.ask("observations")[0]["observation"]
    asked = {"capture": capture, "body": "right_hand", "time": 1.7}
    assert turning.ask("place", **asked) == []
    with pytest.raises(CaparError, match=r"lost it from 1\.50 to 2\.00 s"):
        check_known(turning.store, question("place"), asked)
