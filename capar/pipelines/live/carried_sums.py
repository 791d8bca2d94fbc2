"""Ways and turns that are summed up from the first frame, handed on from window to window."""

from dataclasses import replace

from capar.model.capture import Capture, TagType
from capar.pipelines.live.frames import Window
from extractors.measure import Measurements
from extractors.relations.places import FROM_THE_BEGINNING, Sums, sums_at


class CarriedSums:
    """The sums at the last frame that is settled, for the window that comes next."""

    def __init__(self) -> None:
        self._known = FROM_THE_BEGINNING
        self.frame = 0
        """The frame of the recording at which they are known."""

    def since(self, window: Window) -> Sums:
        """The sums for a window that holds the frame at which they are known."""
        return replace(self._known, anchor=self.frame - window.first)

    def advance(self, window: Window, measurements: Measurements, frame: int) -> None:
        """Take from a measured window the sums at a later frame of the recording."""
        if frame <= self.frame:
            return
        capture: Capture = window.capture
        bodies = measurements.bodies
        hands = {each.name: bodies.sensors[each.name] for each in capture.acting}
        mobile = {
            each.name: bodies.objects[each.name]
            for each in capture.objects
            if each.tag is TagType.MOBILE
        }
        self._known = sums_at(
            (mobile | hands).values(),
            bodies.objects.values(),
            frame - window.first,
            self.since(window),
        )
        self.frame = frame
