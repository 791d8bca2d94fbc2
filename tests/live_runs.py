"""Captures played frame by frame to a live observer, and what it announced and gave."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import motions
import numpy as np
from bundles import DRINKING
from motions.encounters import kick, throw
from windows import repeated

from capar.model.capture import Capture, Stream
from capar.model.observation import Observation
from capar.pipelines.live.frames import Poses, body_names, replayed, with_streams
from capar.pipelines.live.ledgers import SegmentEvent
from capar.pipelines.live.observer import LiveObserver
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from extractors.calibration import calibrate
from extractors.measure import measure

EXAMPLES = Path(__file__).parents[1] / "examples"

CAPTURES: dict[str, Callable[[], Capture]] = {
    "demo": lambda: trial_of(DRINKING),
    "slide": lambda: motions.slide_object(motions.WOMAN).capture,
    "both hands": lambda: motions.pick_up_with_both_hands(motions.WOMAN).capture,
    "one leg": lambda: motions.stand_on_one_leg(motions.WOMAN).capture,
    "thrown": lambda: throw(motions.WOMAN).capture,
    "kicked": lambda: kick(motions.WOMAN).capture,
    "sliding on and on": lambda: repeated(motions.slide_object(motions.WOMAN).capture, 3),
    "whisk and bottle": lambda: trial_of(f"{EXAMPLES}/bimacs_optitrack:take0"),
    "bowl stirred twice": lambda: trial_of(f"{EXAMPLES}/bimacs_optitrack:take5"),
    "box carried": lambda: trial_of(
        f"{EXAMPLES}/omomo_intermimic/largebox_hands.toml:sub3_largebox_003"
    ),
    "drinking on and on": lambda: repeated(trial_of(DRINKING), 3),
}


@dataclass(frozen=True, eq=False)
class LiveRun:
    """What live observation of a capture told, beside what it is observed as offline."""

    capture: Capture
    events: tuple[SegmentEvent, ...]
    """Those that were announced before the recording ended."""

    at_the_end: tuple[SegmentEvent, ...]
    result: Observation
    offline: Observation
    observer: LiveObserver


@cache
def live_run(name: str) -> LiveRun:
    """A capture played to the end; a frame is destroyed as soon as the next one follows."""
    capture = CAPTURES[name]()
    known = calibrate(capture)
    observer = LiveObserver(rig_of(capture), known)
    events: list[SegmentEvent] = []
    for poses in vanishing(capture):
        events += observer.push([poses])
    at_the_end, result = observer.finish()
    offline = observe_measured(capture, measure(capture, known))
    return LiveRun(capture, tuple(events), tuple(at_the_end), result, offline, observer)


def rig_of(capture: Capture) -> Capture:
    """The bodies of a capture without its recording: two frames at the origin."""
    bodies = (*capture.sensors, *capture.objects)
    still: dict[int, Stream] = {}
    for each in bodies:
        times, places = np.array([0.0, 1.0]), np.zeros((2, 3))
        turns = np.tile([1.0, 0.0, 0.0, 0.0], (2, 1))
        still.setdefault(id(each.stream), Stream(times, places, turns))
    streams = {f"sensor {each.name}": still[id(each.stream)] for each in capture.sensors}
    streams |= {f"object {each.name}": still[id(each.stream)] for each in capture.objects}
    return with_streams(capture, streams)


def vanishing(capture: Capture) -> Iterator[Poses]:
    """The frames of a capture, each overwritten once the next one is asked for."""
    names = body_names(capture)
    for poses in replayed(capture):
        own = replace(
            poses, positions=poses.positions.copy(), orientations=poses.orientations.copy()
        )
        assert len(own.positions) == len(names)
        yield own
        own.positions[:], own.orientations[:] = np.nan, np.nan
