"""Nothing is wrong with recordings that others made, nor with scenes of test batteries."""

from pathlib import Path

import pytest
from faulty import found
from motion_files import recordings_folder
from scenes.batteries import SCENES

from capar.model.notices import KINDS
from extractors.bodies.bodies import bodies_of
from extractors.faults.faults import faults
from extractors.readers.bundle.capture_toml import read_capture, takes
from extractors.thresholds import Thresholds

EXAMPLES = Path(__file__).parents[3] / "examples"
RECORDED = sorted(path.parent.name for path in EXAMPLES.glob("*/capture.toml"))


@pytest.mark.parametrize("name", RECORDED)
def test_recordings_have_no_fault_of_axis_unit_rate_order_or_side(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    place = EXAMPLES / name
    limits = Thresholds()
    take = next(iter(takes(place)), "")
    capture = read_capture(f"{place}:{take}" if take else place)
    measured = faults(capture, bodies_of(capture, limits), (), {}, limits)
    read = [each for each in capture.notices if KINDS[each.code].fault]
    assert [*read, *measured] == []


@pytest.mark.parametrize("name", sorted(SCENES)[::25])
def test_scenes_have_no_fault(name: str) -> None:
    capture, _ = SCENES[name](60.0, 0.0005, 0.005, 1)
    assert found(capture) == []
