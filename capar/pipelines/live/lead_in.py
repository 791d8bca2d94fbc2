"""The first seconds of a live recording, by which it is calibrated."""

from collections.abc import Sequence

from capar.model.capture import Capture
from capar.model.errors import CaptureError
from capar.pipelines.live.frames import FrameBuffer, Poses, replayed

SHORTEST_S = 1.0
"""A shorter lead-in shows neither noise at rest nor what rests on what [s]."""


def lead_in(capture: Capture, seconds: float) -> Capture:
    """The first seconds of a recorded capture.

    Raises:
        CaptureError: They are fewer than needed.
    """
    frames = [each for each in replayed(capture) if each.time_s <= seconds]
    return capture_of(capture, frames)


def capture_of(rig: Capture, frames: Sequence[Poses]) -> Capture:
    """Frames as a capture of a rig.

    Raises:
        CaptureError: They are fewer than needed.
    """
    lasts_s = frames[-1].time_s - frames[0].time_s if frames else 0.0
    if lasts_s < SHORTEST_S:
        raise CaptureError(
            f"a lead-in of {lasts_s:.2f} s: expected at least {SHORTEST_S:g} s, to tell noise"
        )
    buffer = FrameBuffer(rig, len(frames))
    for frame in frames:
        buffer.push(frame)
    return buffer.window(len(frames)).capture
