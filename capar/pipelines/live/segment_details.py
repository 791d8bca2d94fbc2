"""What is measured of a settled segment of a live recording: motion, place, style."""

from dataclasses import dataclass, replace

from capar.model.locations import ConstraintLocation
from capar.model.par import Style
from capar.pipelines.live.frames import Window
from capar.pipelines.live.segment_ledger import SettledSegment
from capar_rules.pars.pars import Measured
from extractors.calibration import thresholds_of
from extractors.measure import Measurements
from extractors.segments import constraint_location, moved_path, style


@dataclass(frozen=True, slots=True)
class SegmentDetails:
    """What is measured of a settled segment, once its zero crossings are settled too."""

    measured: Measured
    location: ConstraintLocation | None
    style: Style

    def for_purpose(self, purpose: str) -> "SegmentDetails":
        """The same with the segment's purpose, which may be known later."""
        location = replace(self.location, purpose=purpose) if self.location else None
        return SegmentDetails(self.measured, location, replace(self.style, purpose=purpose))


def segment_details(
    window: Window, measurements: Measurements, settled: SettledSegment
) -> SegmentDetails:
    """Motion, place and style of a settled segment, from a window in which it lies.

    Args:
        window: The last frames; what began before them is measured from their first.
        measurements: What was measured in them.
        settled: The segment, by frames of the recording.
    """
    segment, limits = settled.segment, thresholds_of(measurements.calibration)
    first = max(segment.first - window.first, 0)
    part = replace(segment, first=first, last=segment.last - window.first)
    motion, path = moved_path(window.capture, measurements, part, limits)
    first_object, second = settled.conditions.colliding
    location = None
    if second >= 0 and "1" in segment.features.rel_end:
        location = constraint_location(
            window.capture,
            measurements.bodies,
            measurements.attention,
            part,
            dominant=segment.objects[first_object] if first_object >= 0 else "",
            goal=segment.objects[second],
        )
        location = replace(location, frame=segment.last)
    track = measurements.tracks[segment.ee]
    shown = style(part, track, window.capture.times, limits)
    return SegmentDetails(Measured(motion, path), location, shown)
