"""Direct mapping leads the recorded ways to another body, and repeats them on the recorded one."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from exit_codes import exit_code
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from capar.body.recording import Truth, write_bundle
from capar.body.scripted_actions import action_capture
from capar.pipelines.round_trips import observed_source
from capar.regeneration import Source, map_directly
from capar.regeneration.direct_mapping import axis_mapped, departures

RATE_HZ = 30.0

PLACES = arrays(float, 3, elements=st.floats(-1.0, 1.0))
PATHS = arrays(float, (7, 3), elements=st.floats(-1.0, 1.0))


@cache
def _source(action: str) -> Source:
    return observed_source(action_capture(action, rate_hz=RATE_HZ), cutoff_hz=None)


@given(PATHS, PLACES, PLACES)
def test_a_mapped_path_has_the_ends_that_were_asked_for(
    path: np.ndarray, start: np.ndarray, goal: np.ndarray
) -> None:
    made = axis_mapped(path, start, goal)
    np.testing.assert_allclose(made[[0, -1]], [start, goal], atol=1e-9)


@given(PATHS, PLACES)
def test_a_path_that_is_moved_as_a_whole_keeps_its_shape(path: np.ndarray, by: np.ndarray) -> None:
    made = axis_mapped(path, path[0] + by, path[-1] + by)
    np.testing.assert_allclose(made, path + by, atol=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("action", ["drink", "touch", "pick_up"])
def test_the_recorded_body_repeats_the_recorded_way(action: str) -> None:
    source = _source(action)
    motion, found = map_directly(source, source.human)
    assert len(departures(motion)) == len(source.hands) + len(motion.plan.goals)
    assert max(measure.value for measure in departures(motion)) < 1.0
    for name in ("feet", "joint limits", "joint speed", "speed profile", "things not held"):
        assert found.gate(name).passed


@pytest.mark.long
def test_the_command_prints_gates_and_departures_and_writes_a_capture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded, out = tmp_path / "man", tmp_path / "same"
    write_bundle(action_capture("touch", rate_hz=RATE_HZ), Truth((), (), (), ()), recorded)
    assert exit_code(monkeypatch, "map", str(recorded), "--output", str(out)) == 0
    printed = capsys.readouterr().out
    assert "penetration" in printed
    assert "from the recorded way" in printed
    again = observed_source(out).observation
    assert again.complex_par.signature == _source("touch").observation.complex_par.signature
    assert exit_code(monkeypatch, "map", str(recorded), "--output", str(out)) == 2
    assert "not an empty folder" in capsys.readouterr().err
