"""A live observer of a tracker: calibrated before, or by what the tracker sends at first."""

from collections.abc import Callable, Iterator
from itertools import chain

from capar.model.calibration import Calibration
from capar.model.capture import Capture
from capar.pipelines.live.frames import DeviceFrames, Poses, capture_of
from capar.pipelines.live.observer import LiveObserver
from capar_rules.engine.profiles import Profile
from extractors.calibration import calibrate
from extractors.devices.tracker import LiveTracker


def track(
    tracker: LiveTracker,
    rig: Capture,
    known: Calibration | None,
    lead_in_s: float,
    *,
    rules: Profile,
    say: Callable[[str], None],
) -> tuple[LiveObserver, DeviceFrames, Iterator[list[Poses]]]:
    """An observer, and the frames that it is to be given, those of the lead-in first.

    Args:
        tracker: One that is open.
        rig: Bodies by the names of its sensors; its own name is that of what is recorded.
        known: The calibration; None has it made of the lead-in.
        lead_in_s: How long the lead-in is [s].
        rules: The rules.
        say: Called with what happens to the tracker.

    Raises:
        DeviceError: The tracker does not see what moves in the rig.
        CaptureError: The lead-in is too short to calibrate by.
    """
    frames = DeviceFrames(rig, tracker.describe(), known.step_s if known else None)
    source, first = _batches(tracker, frames, say), list[Poses]()
    if known is None:
        say(f"calibrating by {lead_in_s:g} s: act as usual")
        while len(first) * frames.step_s < lead_in_s:
            first += next(source)
        known = calibrate(capture_of(rig, first))
    observer = LiveObserver(rig, known, rules=rules, name=rig.name, sentences=True)
    return observer, frames, chain([first], source)


def _batches(
    tracker: LiveTracker, frames: DeviceFrames, say: Callable[[str], None]
) -> Iterator[list[Poses]]:
    """What a tracker sends, again and again; what happens to it is said."""
    heard = 0
    while True:
        yield [each for frame in tracker.poll(0.1) for each in frames.poses(frame)]
        for event in tracker.events[heard:]:
            say(event.message)
        heard = len(tracker.events)
