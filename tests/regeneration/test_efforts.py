"""Efforts reshape timing and paths between events, within limits."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jaxtyping import Float
from recorded_actions import recorded
from scipy.spatial.transform import RigidTransform

from capar.model.errors import CaparError
from capar.pipelines.observation import observe
from capar.regeneration import PlanError, Source, capture_of
from capar.regeneration.efforts import (
    Effort,
    EffortReport,
    adverbs,
    check_effort,
    effort_of_words,
    overshot,
    paused,
    read_effort,
    regenerate_in_manner,
    shaped,
    timed,
    with_effort,
)
from capar.regeneration.motion import Motion
from capar.regeneration.quality import Quality
from capar.regeneration.styles import Kind, own_style, paced

EFFORTS = st.floats(-1.0, 1.0)


def _performed(
    source: Source, effort: Effort, duration_s: float | None = None
) -> tuple[Motion, Quality, EffortReport]:
    motion, found, report = regenerate_in_manner(
        source, source.human, source.scene, own_style(source), effort=effort, duration_s=duration_s
    )
    assert report is not None
    return motion, found, report


@st.composite
def shares_of_ways(draw: st.DrawFn) -> Float[np.ndarray, "frames"]:
    speeds = draw(st.lists(st.floats(0.01, 1.0), min_size=6, max_size=40))
    covered = np.concatenate([[0.0], np.cumsum(speeds)])
    return np.asarray(covered / covered[-1])


@st.composite
def ways(draw: st.DrawFn) -> Float[np.ndarray, "frames 3"]:
    """From left to right with any bends aside, not back."""
    count = draw(st.integers(6, 30))
    bends = st.lists(st.floats(-0.2, 0.2), min_size=count, max_size=count)
    along = np.linspace(0.0, 0.5, count)
    return np.stack([along, draw(bends), draw(bends)], axis=1)


def _peak_over_mean(shares: Float[np.ndarray, "frames"]) -> float:
    speeds = np.diff(shares)
    return float(speeds.max() / speeds.mean())


def _length(spots: Float[np.ndarray, "frames 3"]) -> float:
    return float(np.linalg.norm(np.diff(spots, axis=0), axis=1).sum())


@given(shares_of_ways(), EFFORTS, EFFORTS)
def test_more_sudden_is_a_higher_peak_over_the_mean_speed(
    shares: Float[np.ndarray, "frames"], one: float, two: float
) -> None:
    low, high = sorted([one, two])
    peaks = [_peak_over_mean(timed(shares, time, 0.0)) for time in (low, high)]
    assert peaks[0] <= peaks[1] + 1e-9


@given(shares_of_ways(), EFFORTS, EFFORTS, EFFORTS)
def test_stronger_covers_less_of_the_way_at_every_time_since_it_accelerates_longer(
    shares: Float[np.ndarray, "frames"], one: float, two: float, time: float
) -> None:
    low, high = sorted([one, two])
    assert (timed(shares, time, high) <= timed(shares, time, low) + 1e-9).all()


@given(shares_of_ways(), EFFORTS, EFFORTS)
def test_more_bound_rests_longer_at_the_ends(
    shares: Float[np.ndarray, "frames"], one: float, two: float
) -> None:
    low, high = sorted([one, two])
    rests = [
        np.mean((made <= 0.0) | (made >= 1.0))
        for made in (paused(shares, flow, (True, True)) for flow in (low, high))
    ]
    assert rests[0] <= rests[1]
    assert np.array_equal(paused(shares, high, (False, False)), shares)


@given(EFFORTS, EFFORTS)
def test_freer_goes_further_beyond_a_free_end_and_comes_back(one: float, two: float) -> None:
    low, high = sorted([one, two])
    free, bound = (overshot(101, flow) for flow in (low, high))
    assert free[1].max() >= bound[1].max() - 1e-3
    for gone, beyond in (free, bound):
        np.testing.assert_allclose(
            [gone[0], gone[-1], beyond[0], beyond[-1]], [0, 1, 0, 0], atol=1e-9
        )


@given(ways(), EFFORTS, EFFORTS)
def test_more_indirect_is_a_longer_way(
    spots: Float[np.ndarray, "frames 3"], one: float, two: float
) -> None:
    low, high = sorted([one, two])
    free = np.ones(len(spots))
    indirect, direct = (_length(shaped(spots, space, 0.0, free)) for space in (low, high))
    assert indirect >= direct - 1e-9


@settings(max_examples=10)
@given(EFFORTS, EFFORTS, EFFORTS, EFFORTS)
def test_events_keep_their_frames_and_places(
    time: float, weight: float, space: float, flow: float
) -> None:
    source = recorded("touch")
    made = with_effort(own_style(source), source, Effort(time, weight, space, flow))
    hold = source.holds[0]
    path = source.hands[hold.side].path
    for frame in (0, hold.first, hold.last, len(source.times) - 1):
        off: RigidTransform = path[frame].inv() * made.hands[hold.side][frame]
        assert np.linalg.norm(off.translation) < 1e-6
        assert off.rotation.magnitude() < 1e-6


def test_what_slides_on_a_table_stays_on_it_in_any_manner() -> None:
    source = recorded("slide")
    made = with_effort(own_style(source), source, Effort(weight=-1.0, space=-1.0))
    np.testing.assert_allclose(
        made.things["mug"].translation[:, 2], source.paths["mug"].translation[:, 2], atol=1e-4
    )


@pytest.mark.parametrize(
    ("text", "parameter", "value"), [("time=-0.5", "time", -0.5), ("indirect=0.5", "space", -0.5)]
)
def test_an_effort_is_performed_with_every_gate(text: str, parameter: str, value: float) -> None:
    source = recorded("touch")
    motion, found, report = _performed(source, read_effort(text))
    assert found.passed, found.failed
    assert report.performed.values[parameter] == value
    again = observe(capture_of(motion, name="manner", agent="man"))
    assert again.complex_par.signature == source.observation.complex_par.signature


def test_a_sudden_performance_is_shorter_unless_a_duration_is_stated() -> None:
    source = recorded("touch")
    usual_s, lasts_s = float(source.times[-1]), []
    for duration_s in (None, 5.0):
        motion, _, _ = _performed(source, Effort(time=0.5), duration_s)
        lasts_s.append(float(motion.plan.source.times[-1]))
    assert lasts_s[0] < usual_s
    assert lasts_s[1] == pytest.approx(5.0)


def test_what_limits_do_not_allow_is_scaled_down_and_told_with_by_how_much() -> None:
    source = recorded("touch")
    with pytest.raises(PlanError) as refused:
        paced(source, 0.5)
    least_s = float(str(refused.value).split("at least ")[1].split()[0])
    brief = paced(source, 1.2 * least_s)
    _, found, report = _performed(brief, Effort(time=1.0))
    assert found.passed
    assert 0.0 < report.performed.time < 1.0
    assert "too short to be observed" in report.why
    assert "since with more" in str(report)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("sudden=1.5", "from -1 .sustained. to 1 .sudden."),
        ("sudden", "needs a number"),
        ("sudden=0.5,time=0.2", "states time twice"),
        (",", "states nothing"),
    ],
)
def test_what_is_no_effort_is_refused_with_what_would_be_one(text: str, problem: str) -> None:
    with pytest.raises(CaparError, match=problem):
        read_effort(text)


def test_styles_without_a_shape_or_speeds_of_their_own_have_no_effort() -> None:
    source = recorded("touch")
    with pytest.raises(PlanError, match="path or frame would do"):
        check_effort(source, own_style(source, Kind.EVEN), Effort(time=0.5))
    with pytest.raises(PlanError, match="path or frame would do"):
        check_effort(source, own_style(source, Kind.VEL), Effort(space=0.5))
    check_effort(source, own_style(source, Kind.VEL), Effort(time=0.5))


def test_adverbs_ask_for_efforts_together_and_no_further_than_to_a_pole() -> None:
    assert effort_of_words(["slowly"]) == Effort(time=-0.5)
    both = effort_of_words(["slowly", "leisurely"])
    assert both is not None
    assert both.time == -1.0
    assert effort_of_words(["blue"]) is None
    assert all(any(effort.values.values()) for effort in adverbs().values())
