"""Agreement and delay of live observation over simulated takes.

Run by hand: ``PYTHONPATH=tests python benchmarks/live_takes.py [TAKE ...]``.

Each take is a simulated recording, played forth and back with other noise each time, observed frame
by frame with its own calibration. The table shows how many segments are settled, how many of them
the offline run tells otherwise, how many provisional ones change their name or move a border by
over 0.1 s until they are settled, and how late segments are settled after their end, by recorded
time: the processor's own time is in the last column, as seconds of recording per second.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import motions
import numpy as np
from windows import repeated

from capar.model.capture import Capture
from capar.model.observation import Segment
from capar.pipelines.live.events import SegmentEvent, Status
from capar.pipelines.live.frames import replayed
from capar.pipelines.live.observer import LiveObserver
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from extractors.calibration import calibrate
from extractors.measure import measure

DEMO = Path(__file__).parents[1] / "capar" / "demo" / "drink_from_mug"
MOVED_S = 0.1
"""A provisional border that moves by more counts [s]."""

Clip = Callable[[], Capture]
CLIPS: dict[str, Clip] = {
    "drink": lambda: trial_of(DEMO),
    "slide": lambda: motions.slide_object(motions.WOMAN).capture,
    "both_hands": lambda: motions.pick_up_with_both_hands(motions.WOMAN).capture,
    "one_leg": lambda: motions.stand_on_one_leg(motions.WOMAN).capture,
}
NOISES_MM = (0.1, 0.2, 0.3, 0.4, 0.5)
TAKES = {f"{name}_{noise:g}mm": (name, noise) for name in CLIPS for noise in NOISES_MM}


@dataclass(frozen=True)
class Agreement:
    """What live observation of a take told beside the offline run."""

    recorded_s: float
    segments: int
    differ: int
    provisional: int
    renamed: int
    moved: int
    late_s: tuple[float, ...]
    spent_s: float


def agreement(capture: Capture) -> Agreement:
    """Observe a take live and offline."""
    known = calibrate(capture)
    whole = observe_measured(capture, measure(capture, known))
    offline = {_told(segment) for segment in whole.segments}
    observer = LiveObserver(capture, known, keep_result=False)
    events: list[SegmentEvent] = []
    start = time.process_time()
    for frame in replayed(capture):
        events += observer.push([frame])
    late_s = tuple(event.late_s for event in events if event.status is Status.SETTLED)
    events += observer.finish()[0]
    spent_s = time.process_time() - start
    first: dict[tuple[str, int], Segment] = {}
    last: dict[tuple[str, int], Segment] = {}
    for event in events:
        key = event.segment.ee, event.segment.index
        if event.status is Status.PROVISIONAL:
            first.setdefault(key, event.segment)
        if event.status is Status.SETTLED:
            last[key] = event.segment
    pairs = [(segment, last[key]) for key, segment in first.items() if key in last]
    return Agreement(
        float(capture.times[-1]),
        len(last),
        sum(_told(segment) not in offline for segment in last.values()),
        len(pairs),
        sum(one.name != other.name for one, other in pairs),
        sum(_moves(one, other) for one, other in pairs),
        late_s,
        spent_s,
    )


def _told(segment: Segment) -> tuple[object, ...]:
    return segment.ee, segment.first, segment.last, segment.name, segment.objects


def _moves(one: Segment, other: Segment) -> bool:
    ends = abs(one.start_s - other.start_s), abs(one.end_s - other.end_s)
    return max(ends) > MOVED_S


def _row(name: str, found: list[Agreement]) -> str:
    late_s = [late for take in found for late in take.late_s]
    recorded_s = sum(take.recorded_s for take in found)
    counts = [
        sum(getattr(take, field) for take in found)
        for field in ("segments", "differ", "provisional", "renamed", "moved")
    ]
    factor = recorded_s / sum(take.spent_s for take in found)
    told = f"{name:18}{recorded_s:9.1f}" + "".join(f"{count:12}" for count in counts)
    return f"{told}{np.percentile(late_s, 99):12.2f}{factor:8.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*", metavar="TAKE", help=", ".join(TAKES))
    takes = parser.parse_args().takes or list(TAKES)
    heads = ("segments", "differ", "provisional", "renamed", "moved", "p99 [s]")
    print(f"{'take':18}{'rec. [s]':>9}" + "".join(f"{head:>12}" for head in heads) + f"{'x RT':>8}")
    found = []
    for take in takes:
        name, noise_mm = TAKES[take]
        capture = repeated(CLIPS[name](), 3, noise_m=noise_mm / 1000.0)
        found.append(agreement(capture))
        print(_row(take, found[-1:]), flush=True)
    print(_row("all", found))


if __name__ == "__main__":
    main()
