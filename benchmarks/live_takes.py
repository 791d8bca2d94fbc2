"""Agreement and delay of live observation over simulated takes.

``python benchmarks/live_takes.py [TAKE ...] [--rounds 3]``: one of each simulated recording,
``all``, or those that are named.

Each take is observed frame by frame with its own calibration. Simulated recordings are played forth
and back so many times with other noise each time; takes of a cook and of a person who carries
things are played as they were recorded (without the recordings ``all`` leaves them out), the latter
with the twelve sensors of the thesis: trunk, head, neck, hands, elbows, knees, feet, and the thing.

The table shows how many segments are settled, how many of them the offline run tells otherwise, how
many provisional ones change their name or move a border by over 0.1 s until they are settled, how
late segments are settled after their end, by recorded time and with the processor's time for it
added, whether the final observation is the offline one byte for byte, and seconds of recording per
second of processor time.
"""

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from bundles import DRINKING

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import motions
import numpy as np
import scene
from windows import repeated

from capar.model.capture import Capture
from capar.model.json_form import to_json
from capar.model.observation import Segment
from capar.pipelines.live.frames import replayed
from capar.pipelines.live.ledgers import SegmentEvent, Status
from capar.pipelines.live.observer import LiveObserver
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from extractors.calibration import calibrate
from extractors.measure import measure

ROOT = Path(__file__).parents[1]
COOK = ROOT / "examples" / "bimacs_optitrack"
CARRIER = ROOT / "examples" / "omomo_intermimic"
MOVED_S = 0.1
"""A provisional border that moves by more counts [s]."""

Clip = Callable[..., Capture]
CLIPS: dict[str, Clip] = {
    "drink": lambda: trial_of(DRINKING),
    "slide": lambda: motions.slide_object(motions.WOMAN).capture,
    "both_hands": lambda: motions.pick_up_with_both_hands(motions.WOMAN).capture,
    "one_leg": lambda: motions.stand_on_one_leg(motions.WOMAN).capture,
}
NOISES_MM = {
    "drink": (0.1, 0.2, 0.3, 0.4, 0.5),
    "slide": (0.1, 0.5),
    "both_hands": (0.1, 0.2, 0.4, 0.5),
    "one_leg": (0.1, 0.5),
}
COOKED = (0, 3, 5, 7)
CARRIED = ("sub2_largetable_008", "sub2_woodchair_003", "sub3_largebox_003")
BIRDS = ("pelvis", "head", "neck", "wrist", "elbow", "knee", "ankle")
"""What the names of the sensors end with that a rig of the thesis has, left and right."""


def noisy(name: str, noise_mm: float, *, rounds: int) -> Capture:
    """A simulated recording that goes on and on."""
    return repeated(CLIPS[name](), rounds, noise_m=noise_mm / 1000.0)


def whole_body(take: str) -> Capture:
    """A clip of somebody who carries something, by the sensors of the thesis."""
    file = "largebox.toml" if "largebox" in take else "capture.toml"
    clip = trial_of(f"{CARRIER / file}:{take}")
    sensors = tuple(sensor for sensor in clip.sensors if sensor.name.endswith(BIRDS))
    return replace(clip, sensors=sensors)


TAKES: dict[str, Clip] = {
    **{
        f"{name}_{noise_mm:g}mm": partial(noisy, name, noise_mm)
        for name, noises_mm in NOISES_MM.items()
        for noise_mm in noises_mm
    },
    **{f"cook_{take}": partial(trial_of, f"{COOK}:take{take}") for take in COOKED},
    **{take: partial(whole_body, take) for take in CARRIED},
}


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
    done_s: tuple[float, ...]
    """The same with the processor's time for what settled them."""

    same: bool
    """Whether the final observation is that of the offline run, byte for byte."""

    spent_s: float


def agreement(capture: Capture) -> Agreement:
    """Observe a take live, and then offline: what is kept of its shapes would serve live too."""
    known = calibrate(capture)
    observer = LiveObserver(capture, known)
    events: list[SegmentEvent] = []
    late_s: list[float] = []
    done_s: list[float] = []
    start_s = time.process_time()
    for frame in replayed(capture):
        begun_s = time.process_time()
        told = observer.push([frame])
        own_s = [event.late_s for event in told if event.status is Status.SETTLED]
        late_s += own_s
        done_s += [late + time.process_time() - begun_s for late in own_s]
        events += told
    at_the_end, result = observer.finish()
    events += at_the_end
    spent_s = time.process_time() - start_s
    whole = observe_measured(capture, measure(capture, known))
    offline = {_told(segment) for segment in whole.segments}
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
        tuple(late_s),
        tuple(done_s),
        to_json(result) == to_json(whole),
        spent_s,
    )


def _told(segment: Segment) -> tuple[object, ...]:
    return segment.ee, segment.first, segment.last, segment.name, segment.objects


def _moves(one: Segment, other: Segment) -> bool:
    ends = abs(one.start_s - other.start_s), abs(one.end_s - other.end_s)
    return max(ends) > MOVED_S


HEADS = ("segments", "differ", "provis.", "renamed", "moved")


def _row(name: str, found: list[Agreement]) -> str:
    recorded_s = sum(take.recorded_s for take in found)
    counts = [
        sum(getattr(take, field) for take in found)
        for field in ("segments", "differ", "provisional", "renamed", "moved")
    ]
    late_s, done_s = (
        np.percentile([late for take in found for late in getattr(take, field)], 99)
        for field in ("late_s", "done_s")
    )
    factor = recorded_s / sum(take.spent_s for take in found)
    told = f"{name:20}{recorded_s:9.1f}" + "".join(f"{count:9}" for count in counts)
    same = f"{sum(take.same for take in found)}/{len(found)}"
    return f"{told}{late_s:9.2f}{done_s:9.2f}{same:>8}{factor:8.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*", metavar="TAKE", help=", ".join(("all", *TAKES)))
    parser.add_argument("--rounds", type=int, default=3, help="of simulated recordings")
    asked = parser.parse_args()
    takes = asked.takes or [f"{name}_{noises_mm[0]:g}mm" for name, noises_mm in NOISES_MM.items()]
    if takes == ["all"]:
        there = scene.recordings()
        takes = [take for take in TAKES if there or take.endswith("mm")]
    heads = "".join(f"{head:>9}" for head in (*HEADS, "p99 [s]", "+ work"))
    print(f"{'take':20}{'rec. [s]':>9}{heads}{'same':>8}{'x RT':>8}")
    found = []
    for take in takes:
        options = {"rounds": asked.rounds} if take.endswith("mm") else {}
        found.append(agreement(TAKES[take](**options)))
        print(_row(take, found[-1:]), flush=True)
    print(_row("all", found))


if __name__ == "__main__":
    main()
