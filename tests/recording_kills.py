"""Kill a process at random moments while it records, and see what is left.

Run by hand: ``python tests/recording_kills.py 50``. The child records frames of a generated
motion and says after each one, with its time, that it is written. After the kill the file must
hold every frame that was said to be written, or lack none older than ``MOST_LOST_S``.
"""

import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from extractors.devices.recording import RecordingWriter, read_live_recording
from extractors.devices.simulator import SmoothMotion
from extractors.devices.tracker import Description, Frame

SENSORS = ("right_hand", "head", "mug")
RATE_HZ = 200.0
MOST_LOST_S = 0.2
LONGEST_S = 0.5
"""Latest moment of a kill after the first frame [s]."""


def frame(index: int, host_s: float) -> Frame:
    """A frame that its number makes."""
    return Frame(host_s, None, *SmoothMotion(len(SENSORS)).poses(index / RATE_HZ), index)


def record_for_ever(path: str) -> None:
    """Record until killed, and say what is written."""
    writer = RecordingWriter(path, Description("flock", "", SENSORS, RATE_HZ), "flock:/dev/x")
    index = 0
    while True:
        now = time.monotonic()
        writer.write(frame(index, now))
        sys.stdout.write(f"{index} {now}\n")
        sys.stdout.flush()
        index += 1
        time.sleep(1.0 / RATE_HZ)


def kill_once(folder: Path, source: random.Random) -> tuple[int, int]:
    """Frames that were said to be written, and those that the file holds.

    Raises:
        AssertionError: Too much is lost, or a frame is not what was written.
    """
    path = folder / f"{source.getrandbits(64):x}.live"
    command = [sys.executable, __file__, "--record", str(path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        lines = [child.stdout.readline()]
        time.sleep(source.uniform(0.0, LONGEST_S))
        child.send_signal(signal.SIGKILL)
        killed_s = time.monotonic()
        lines += child.stdout.readlines()
    said = [each.split() for each in lines if each.endswith("\n")]
    recording = read_live_recording(path)
    assert recording.counts is None
    old = [int(index) for index, stamp in said if float(stamp) < killed_s - MOST_LOST_S]
    held = recording.cycles.tolist()
    assert held == list(range(len(held)))
    assert len(held) > max(old, default=-1), "a frame older than what may be lost is missing"
    for index in (0, len(held) - 1):
        made = frame(index, 0.0)
        np.testing.assert_array_equal(recording.positions[index], made.positions)
        np.testing.assert_array_equal(recording.orientations[index], made.orientations)
    return len(said), len(held)


def kill(times: int, *, seed: int = 1) -> list[tuple[int, int]]:
    """Kill so often; frames said to be written and frames held, for each time."""
    source = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        return [kill_once(Path(folder), source) for _ in range(times)]


if __name__ == "__main__":
    if sys.argv[1] == "--record":
        record_for_ever(sys.argv[2])
    done = kill(int(sys.argv[1]))
    missing = sum(max(0, said - held) for said, held in done)
    sys.stdout.write(
        f"{len(done)} kills: {sum(held for _, held in done)} frames held, "
        f"{missing} of those said to be written are missing\n"
    )
