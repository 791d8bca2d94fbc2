"""A recording holds what was written to it, survives a kill, and becomes a capture."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
import recording_kills
import tracked
from hypothesis import given
from hypothesis import strategies as st

from capar.model.capture import Role, TagType, recorded_at
from capar.model.errors import CaparError, FileError, UnknownNameError
from extractors.devices.flock import FlockRig, FlockSimulator, FlockTracker
from extractors.devices.recording import (
    Mount,
    RecordingWriter,
    frame_times,
    read_live_recording,
    write_bundle,
)
from extractors.devices.simulator import CapturedMotion, SmoothMotion
from extractors.devices.tracker import Counts, Description, Event, Frame, parse_address
from extractors.readers.bundle.capture_toml import read_capture

SENSORS = ("right_hand", "head", "mug")
DESCRIPTION = Description("flock", "6DFOB", SENSORS, 100.0, details={"firmware": "3.47"})


def frames(count: int, *, device: bool = False, cycles: bool = True) -> list[Frame]:
    """Frames a hundredth of a second apart that arrive with up to 4 ms of delay."""
    random, motion = np.random.default_rng(1), SmoothMotion(len(SENSORS))
    out = []
    for index in range(count):
        at_s = 0.01 * index
        arrival_s = 70.0 + at_s + random.uniform(0.0, 0.004)
        stamp_s = 5.0 + at_s if device else None
        out.append(Frame(arrival_s, stamp_s, *motion.poses(at_s), index if cycles else None))
    return out


def recorded(path: Path, made: list[Frame], *, end: bool = True) -> Path:
    writer = RecordingWriter(path, DESCRIPTION, "flock:/dev/x")
    for each in made:
        writer.write(each)
    writer.tell(Event(71.0, "connection lost: gone"))
    if end:
        writer.close(Counts(frames=len(made)))
    return path


def test_a_recording_holds_what_was_written(tmp_path: Path) -> None:
    made = frames(50)
    got = read_live_recording(recorded(tmp_path / "a.live", made))
    assert got.description == DESCRIPTION
    assert got.address == "flock:/dev/x"
    assert got.counts == Counts(frames=50)
    assert [each.message for each in got.events] == ["connection lost: gone"]
    assert got.dropped_bytes == 0
    np.testing.assert_array_equal(got.host_s, [each.host_s for each in made])
    np.testing.assert_array_equal(got.positions, [each.positions for each in made])
    np.testing.assert_array_equal(got.orientations, [each.orientations for each in made])


@given(share=st.floats(0.0, 1.0))
def test_a_recording_cut_off_anywhere_holds_every_whole_frame(
    share: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("cut")
    data = recorded(folder / "a.live", frames(20)).read_bytes()
    path = folder / "cut.live"
    path.write_bytes(data[: int(share * len(data))])
    try:
        got = read_live_recording(path)
    except FileError:
        assert int(share * len(data)) < 400
        return
    whole = read_live_recording(folder / "a.live")
    count = len(got.host_s)
    np.testing.assert_array_equal(got.positions, whole.positions[:count])
    assert count == 20 or got.dropped_bytes < 250


@given(at=st.floats(0.0, 1.0, exclude_max=True), byte=st.integers(1, 255))
def test_a_damaged_recording_gives_true_frames_or_our_own_error(
    at: float, byte: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("damaged")
    data = bytearray(recorded(folder / "a.live", frames(10)).read_bytes())
    data[int(at * len(data))] ^= byte
    path = folder / "damaged.live"
    path.write_bytes(data)
    try:
        got = read_live_recording(path)
    except CaparError:
        return
    whole = read_live_recording(folder / "a.live")
    np.testing.assert_array_equal(got.positions, whole.positions[: len(got.host_s)])


def test_a_kill_at_any_moment_loses_no_frame_older_than_a_fifth_of_a_second() -> None:
    done = recording_kills.kill(5)
    assert all(held > 0 for _, held in done)


@pytest.mark.parametrize(("device", "cycles"), [(True, False), (False, True)])
def test_the_times_of_a_bundle_are_free_of_the_delays_on_the_way(
    device: bool, cycles: bool, tmp_path: Path
) -> None:
    made = frames(300, device=device, cycles=cycles)
    got = read_live_recording(recorded(tmp_path / "a.live", made))
    np.testing.assert_allclose(np.diff(frame_times(got)), 0.01, atol=2e-5)


def test_a_bundle_reads_as_the_capture_that_was_recorded(tmp_path: Path) -> None:
    made = frames(200)
    made[50].positions[2] = np.nan
    made[50].orientations[2] = np.nan
    write_bundle(read_live_recording(recorded(tmp_path / "a.live", made)), tmp_path / "trial")
    capture = read_capture(tmp_path / "trial")
    hand, head = capture.sensors
    assert (hand.name, hand.end_effector, hand.side) == ("right_hand", "hand", "right")
    assert (head.name, head.end_effector) == ("head", "head")
    assert (hand.role, head.role) == (Role.ACTS, Role.ATTENDS)
    assert [(each.name, each.tag) for each in capture.objects] == [("mug", TagType.MOBILE)]
    assert capture.objects[0].stream.lost.nonzero()[0].tolist() == [50]
    wanted = [each.positions[0] for each in made]
    np.testing.assert_allclose(hand.stream.positions, wanted, atol=1e-6)
    assert capture.rate_hz == pytest.approx(100.0, rel=1e-3)
    age = datetime.now(UTC) - datetime.fromisoformat(recorded_at(capture.sources))
    assert abs(age.total_seconds()) < 3600.0


def test_sensors_whose_names_say_nothing_are_left_for_the_user_to_name(tmp_path: Path) -> None:
    got = read_live_recording(recorded(tmp_path / "a.live", frames(30)))
    mounts = {"right_hand": Mount("elbow", "left"), "head": Mount()}
    write_bundle(got, tmp_path / "trial", mounts)
    capture = read_capture(tmp_path / "trial")
    assert [(each.end_effector, each.side) for each in capture.sensors] == [("elbow", "left")]
    assert [each.name for each in capture.objects] == ["head", "mug"]


def test_a_bundle_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    got = read_live_recording(recorded(tmp_path / "a.live", frames(30)))
    (tmp_path / "there").mkdir()
    with pytest.raises(FileError, match="exists already"):
        write_bundle(got, tmp_path / "there")
    with pytest.raises(UnknownNameError, match="no sensor 'haed'"):
        write_bundle(got, tmp_path / "new", {"haed": Mount()})
    short = read_live_recording(recorded(tmp_path / "b.live", frames(1)))
    with pytest.raises(FileError, match="has 1 frames"):
        write_bundle(short, tmp_path / "new")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a.live", "b.live", "there"]


def test_a_capture_played_to_a_driver_and_recorded_is_that_capture_again(tmp_path: Path) -> None:
    write_bundle(
        read_live_recording(recorded(tmp_path / "a.live", frames(200))), tmp_path / "played"
    )
    played = read_capture(tmp_path / "played")
    motion = CapturedMotion(played, SENSORS)
    with FlockSimulator(motion, FlockRig(quiet_s=0.05)) as simulator:
        names = f"names={','.join(SENSORS)}"
        place = f"flock:{simulator.place}?birds=3&rate=100&settle=0.2&range=72&{names}"
        with FlockTracker(parse_address(place)) as flock:
            writer = RecordingWriter(tmp_path / "b.live", flock.describe(), place)
            for each in tracked.take(flock, 150):
                writer.write(each)
        writer.close(flock.counts)
    write_bundle(read_live_recording(tmp_path / "b.live"), tmp_path / "again")
    again = read_capture(tmp_path / "again").sensor("right_hand").stream.positions
    there = played.sensor("right_hand").stream.positions
    distances = np.linalg.norm(again[:, None] - there[None], axis=2).min(axis=1)
    assert distances.max() < 0.001
