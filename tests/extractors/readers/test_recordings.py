"""The shipped descriptions of real recordings, against what is known of them."""

from pathlib import Path

import numpy as np
import pytest
from motion_files import recordings_folder

from capar.model.capture import Capture, ShapeSource
from extractors.readers.bundle.capture_toml import frame_times, read_capture, takes
from extractors.readers.registry import read_recording

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


@pytest.fixture(autouse=True)
def _data(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))


def example(name: str) -> Capture:
    return read_capture(f"{EXAMPLES}/{name}")


def lowest(capture: Capture, name: str, frame: int) -> float:
    """Height of an object's lowest corner [m]."""
    thing = capture.tag_object(name)
    assert thing.shape is not None
    return float(thing.stream.pose(frame).apply(np.array(thing.shape.vertices))[:, 2].min())


def test_the_lifted_box_rests_on_the_table_and_then_on_the_shelf() -> None:
    capture = example("pyomeca_box_lift")
    assert len(capture.times) == 580
    heights = [lowest(capture, "box", frame) for frame in (50, 500)]
    tops = [capture.tag_object(name).stream.positions[0, 2] + 0.01 for name in ("table", "shelf")]
    assert np.allclose(heights, tops, atol=1e-4)
    assert heights[1] - heights[0] == pytest.approx(0.228, abs=0.005)
    assert "rest at 0.50 s" in capture.tag_object("table").assumed
    start = np.linalg.norm(
        capture.tag_object("box").stream.positions - [0.052, -0.031, 0.7], axis=1
    )
    assert capture.times[np.argmax(start > 0.02)] == pytest.approx(1.7, abs=0.1)


def test_the_pillow_lies_under_the_hand_at_every_descent() -> None:
    capture = example("hand_embodiment_pillow")
    pillow = capture.tag_object("pillow")
    assert pillow.shape is not None
    assert pillow.shape.source is ShapeSource.MESH
    assert pillow.deformable
    assert lowest(capture, "pillow", 0) == pytest.approx(0.0, abs=0.02)
    height = capture.sensor("right_hand").stream.positions[:, 2]
    assert np.nanmin(height) < 0.26
    assert np.nanmax(height) > 0.44


def test_the_fifty_two_bodies_have_one_radius_and_the_box_stands_on_the_floor() -> None:
    capture = example("omomo_intermimic/largebox.toml:sub3_largebox_003")
    assert len(capture.sensors) == 52
    assert all(each.shape and "radius 0.02 m" in each.shape.description for each in capture.sensors)
    assert lowest(capture, "largebox", 0) == pytest.approx(-0.001, abs=0.002)


def test_the_table_of_a_take_is_the_bag_it_was_made_from() -> None:
    folder = recordings_folder() / "bimacs_optitrack"
    table = read_recording(folder / "csv" / "subject0_take0.csv.gz")
    bag = read_recording(folder / "raw_bags" / "subject0" / "2024-09-12-13-42-51.bag")
    for name, body in table.bodies.items():
        other = bag.bodies[name]
        assert np.allclose(body.times, other.times, atol=1e-5)
        assert np.array_equal(body.lost, other.lost)
        assert np.allclose(body.positions, other.positions, atol=1e-5, equal_nan=True)


def test_every_take_of_the_two_hands_reads_and_its_labels_keep_their_seconds() -> None:
    place = EXAMPLES / "bimacs_optitrack"
    for take in takes(place):
        capture = read_capture(f"{place}:{take}")
        times = frame_times(f"{place}:{take}")
        assert {each.name for each in capture.acting} == {"right_hand", "left_hand"}
        assert abs(times[-1] - capture.times[-1]) < 1.0 / 60.0
        assert capture.rate_hz == pytest.approx(60.0)


def test_decimetres_and_y_up_become_a_mug_in_a_hand() -> None:
    capture = example("manipnet:mug1")
    mug, hand = capture.tag_object("mug"), capture.sensor("right_hand")
    assert mug.shape is not None
    assert 0.05 < mug.shape.size.max() < 0.2
    apart = np.linalg.norm(mug.stream.positions - hand.stream.positions, axis=1)
    assert apart.min() < 0.15
    assert mug.stream.positions[:, 2].min() > 0.3


def test_the_mirrored_groceries_stand_on_the_table_and_end_in_the_box() -> None:
    capture = example("boxed_vr")
    for name in ("bleach", "mug", "apple", "banana"):
        assert lowest(capture, name, 0) == pytest.approx(0.70, abs=0.005)
        assert 0.715 < lowest(capture, name, len(capture.times) - 1) < 0.85
