"""What live observation announces, as values: segments that ended, were revised, or are settled."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from capar.model.observation import Segment


class Status(StrEnum):
    """How sure an announcement is."""

    PROVISIONAL = "provisional"
    """The segment has ended; later frames may still change it."""

    REVISED = "revised"
    """It is told otherwise than it was announced, within the horizon."""

    WITHDRAWN = "withdrawn"
    """What was announced as ended goes on, or is part of another segment."""

    SETTLED = "settled"
    """It is told for good: name, objects, begin and end."""

    PURPOSE = "purpose"
    """What a settled segment was for, now that the next one is settled: where nobody states a
    purpose, it is the action that follows."""


@dataclass(frozen=True, slots=True)
class SegmentEvent:
    """One announcement about one segment."""

    status: Status
    segment: Segment
    """With its number in the link and its times since the first frame."""

    time_s: float
    """Time of the newest frame when it was announced [s]."""

    sentence: str = ""
    """What was done, in plain English; empty where nothing was touched."""

    @property
    def late_s(self) -> float:
        """How long after the end of the segment it was announced [s]."""
        return self.time_s - self.segment.end_s


def event_row(event: SegmentEvent) -> dict[str, Any]:
    """An announcement as one JSON object; times in seconds since the first frame."""
    segment = event.segment
    return {
        "event": event.status.value,
        "segment": f"{segment.ee}/{segment.index}",
        "name": segment.name,
        "objects": list(segment.objects),
        "purpose": segment.purpose,
        "start_s": round(segment.start_s, 6),
        "end_s": round(segment.end_s, 6),
        "time_s": round(event.time_s, 6),
        "late_s": round(event.late_s, 6),
        "sentence": event.sentence,
    }
