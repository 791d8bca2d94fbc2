"""Lab Streaming Layer: what is sent is received, on loopback alone."""

import time
from collections.abc import Iterator

import numpy as np
import pytest
import tracked
from lsl_loopback import LOOPBACK, LslOutlet

from capar.model.errors import DeviceError
from extractors.devices.lsl import LslTracker
from extractors.devices.simulator import SmoothMotion
from extractors.devices.tracker import Frame, parse_address

SENSORS = ("right_hand", "head", "mug")


@pytest.fixture(scope="module", autouse=True)
def _loopback(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The library reads its settings once, when it is loaded."""
    path = tmp_path_factory.mktemp("lsl") / "lsl_api.cfg"
    path.write_text(LOOPBACK)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("LSLAPICFG", str(path))
        pytest.importorskip("pylsl")
        yield


def frames(count: int, start_s: float) -> list[Frame]:
    motion = SmoothMotion(len(SENSORS))
    return [
        Frame(start_s + 0.01 * index, None, *motion.poses(0.01 * index)) for index in range(count)
    ]


def sent(name: str, made: list[Frame]) -> tuple[LslTracker, list[Frame]]:
    """What arrives of some frames that are sent once the tracker listens."""
    outlet = LslOutlet(name, SENSORS, 100.0)
    with LslTracker(parse_address(f"lsl:{name}?timeout=10")) as tracker:
        for each in made:
            outlet.push(each)
        got = tracked.take(tracker, len(made))
        description = tracker.describe()
    outlet.close()
    assert description.sensors == SENSORS
    assert description.rate_hz == 100.0
    return tracker, got


def test_every_frame_arrives_with_its_time() -> None:
    made = frames(100, 50.0)
    tracker, got = sent("capar_test_poses", made)
    assert len(got) == len(made)
    assert tracker.counts.records == 300
    for one, other in zip(made, got, strict=True):
        np.testing.assert_allclose(other.positions, one.positions)
        np.testing.assert_allclose(other.orientations, one.orientations)
    steps = np.diff([each.host_s for each in got])
    np.testing.assert_allclose(steps, 0.01, atol=1e-3)


def test_a_stream_that_nobody_sends_is_an_error_with_its_remedy() -> None:
    with pytest.raises(DeviceError, match=r"no stream of that name within 0.5 s"):
        LslTracker(parse_address("lsl:capar_test_nobody?timeout=0.5")).open()


def test_a_stream_that_ends_is_said_and_is_no_fault_of_the_program() -> None:
    outlet = LslOutlet("capar_test_ends", SENSORS, 100.0)
    with LslTracker(parse_address("lsl:capar_test_ends?timeout=10")) as tracker:
        outlet.push(frames(1, 50.0)[0])
        tracked.take(tracker, 1)
        outlet.close()
        end_s = time.monotonic() + 10.0
        while not tracker.events and time.monotonic() < end_s:
            tracker.poll(0.1)
        assert "ended" in tracker.events[0].message
