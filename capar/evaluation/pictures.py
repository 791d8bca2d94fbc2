"""Pictures of an evaluation: labels drawn beside what was found, one file a capture."""

from collections.abc import Iterable
from pathlib import Path

from capar.evaluation.metrics import Channel, Evaluation, Interval, Scored, differences, merged
from capar.model.errors import FileError
from capar.views.lettering import Span
from capar.views.picture import Lane, draw_comparison

CAPTURE = "{capture}"
"""What stands in a picture's name for the capture."""


def picture_paths(path: Path, captures: Iterable[str]) -> dict[str, Path]:
    """The picture of each capture.

    Raises:
        FileError: There are several captures, and the name has no place for theirs.
    """
    names = list(captures)
    if CAPTURE not in str(path):
        if len(names) > 1:
            raise FileError(
                path,
                f"is one picture for {len(names)} captures.",
                f"Write {CAPTURE} in its name, or evaluate one take: --takes {names[0]}",
            )
        return dict.fromkeys(names, path)
    return {name: Path(str(path).replace(CAPTURE, name)) for name in names}


def draw_evaluation(evaluation: Evaluation, capture: Scored, *, path: Path) -> None:
    """Draw one capture: for each channel its segments, what was found, labels and differences.

    Raises:
        FileError: The suffix is no picture's, or the file cannot be written.
    """
    lanes = [_lane(capture, each) for each in capture.channels]
    subtitle = f"{evaluation.kind} by labels · {float(capture.times[-1]):.2f} s"
    draw_comparison(
        capture.name, subtitle, lanes, float(capture.times[-1] - capture.times[0]), path=path
    )


def _lane(capture: Scored, channel: Channel) -> Lane:
    wrong = differences(capture.name, [channel], capture.times)
    return Lane(
        name=channel.name,
        segments=tuple(
            Span(each.start_s, each.end_s, each.name, (each.general or (each.name,))[-1])
            for each in channel.segments
        ),
        found=_spans(channel.found, capture),
        true=_spans(channel.true, capture),
        wrong=tuple(Span(each.start_s, each.end_s, "") for each in wrong),
    )


def _spans(intervals: Iterable[Interval], capture: Scored) -> tuple[Span, ...]:
    last = float(capture.times[-1])
    return tuple(
        Span(each.start_s, min(each.end_s, last), each.label) for each in merged(intervals)
    )
