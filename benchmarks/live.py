"""Work, delay and agreement of live observation.

``python benchmarks/live.py [--events 500] [--minutes 0.2] [--memory 60] [--json]``; growth shows
over ``--events 10000``.

Three figures. *Work per event*: two bodies that meet again and again, for as many events as asked
for; the processor time of each tenth of them, and what is held in memory. *Memory*: the same two
bodies with other noise in every frame, the result kept, for as many minutes of recording as asked
for, as fast as it can be computed; what this process, and the worker that it asks, hold meanwhile.
*A heavy scene*: twelve sensors and eight objects with meshes at 103.3 Hz; seconds of recording per
second of processor time on one core, how late segments are settled, and how many of them the
offline run tells otherwise.
"""

import argparse
import json
import os
import resource
import time
from multiprocessing import active_children
from pathlib import Path
from typing import Any

import numpy as np
import scene

from capar.model.capture import Capture, Sensor, Stream
from capar.pipelines.live.frames import Poses, body_names, replayed
from capar.pipelines.live.ledgers import Status
from capar.pipelines.live.observer import LiveObserver
from capar.pipelines.observation import observe_measured
from extractors.calibration import calibrate
from extractors.measure import measure

RATE_HZ = 103.3
TENTHS = 10


def heavy_figures(minutes: float, *, faces: int) -> dict[str, Any]:
    """Real-time factor, delay and agreement in the heavy scene."""
    capture = scene.with_trunk(scene.capture(minutes, rate_hz=RATE_HZ, faces=faces))
    known = calibrate(capture)
    observer = LiveObserver(capture, known)
    frames = replayed(capture)
    events, start = [], time.process_time()
    for frame in frames:
        events += observer.push([frame])
    at_the_end, result = observer.finish()
    spent = time.process_time() - start + sum(os.times()[2:4])
    late = [event.late_s for event in events if event.status is Status.SETTLED]
    offline = observe_measured(capture, measure(capture, known))
    told = {(each.ee, each.first, each.last, each.name, each.objects) for each in result.segments}
    whole = {(each.ee, each.first, each.last, each.name, each.objects) for each in offline.segments}
    ours, theirs = set(result.facts), set(offline.facts)
    kinds: dict[str, int] = {}
    for fact in ours ^ theirs:
        kinds[type(fact).__name__] = kinds.get(type(fact).__name__, 0) + 1
    return {
        "sensors": len(capture.sensors),
        "objects": len(capture.objects),
        "faces": faces,
        "recording [s]": float(capture.times[-1]),
        "processor time [s]": spent,
        "times real time": float(capture.times[-1]) / spent,
        "events": len(events) + len(at_the_end),
        "processor time per event [ms]": 1000.0 * spent / max(len(events) + len(at_the_end), 1),
        "settled late, median [s]": float(np.median(late)),
        "settled late, p99 [s]": float(np.percentile(late, 99)),
        "segments": len(told),
        "segments told otherwise than offline": len(told - whole),
        "facts": len(theirs),
        "facts that differ, by kind": dict(sorted(kinds.items())),
        "peak memory [MB]": _memory_mb(),
    }


def work_figures(events: int) -> dict[str, Any]:
    """Processor time per event over very many events, without a result that grows."""
    period_s = 1.0
    short = _meeting(60.0, period_s)
    observer = LiveObserver(short, calibrate(short))
    names = body_names(short)
    frames = replayed(short)
    length, done, tenths, sizes = len(frames), 0, [], []
    start, number = time.process_time(), 0
    while done < events:
        source = frames[number % length]
        told = observer.push([Poses(number / 100.0, source.positions, source.orientations)])
        done += len(told)
        number += 1
        if done >= (len(tenths) + 1) * events / TENTHS:
            now = time.process_time()
            tenths.append(now - start)
            sizes.append(_memory_mb())
            start = now
    each = events / TENTHS
    return {
        "bodies": len(names),
        "events": done,
        "recording [s]": number / 100.0,
        "processor time per event, by tenths [ms]": [1000.0 * spent / each for spent in tenths],
        "last tenth / first": tenths[-1] / tenths[0],
        "times real time": number / 100.0 / sum(tenths),
        "peak memory by tenths [MB]": sizes,
    }


def memory_figures(minutes: float) -> dict[str, Any]:
    """What is held in memory as a recording goes on, its result kept."""
    short = _meeting(60.0, 2.0)
    observer = LiveObserver(short, calibrate(short))
    frames = replayed(short)
    random = np.random.default_rng(1)
    own, workers, start = {}, {}, time.process_time()
    total = round(6000 * minutes)
    for number in range(total):
        source = frames[number % len(frames)]
        places = source.positions + random.normal(0.0, 0.0001, source.positions.shape)
        places[1:] = source.positions[1:]
        observer.push([Poses(number / 100.0, places, source.orientations)])
        if (number + 1) % 30000 == 0:
            minute = (number + 1) // 6000
            own[minute] = _resident_mb("self")
            workers[minute] = sum(_resident_mb(str(each.pid)) for each in active_children())
            print(f"  {minute} min: {own[minute]:.0f} + {workers[minute]:.0f} MB", flush=True)
    observer.rules_process.close()
    spent = time.process_time() - start + sum(os.times()[2:4])
    begin = time.process_time()
    _, result = observer.finish()
    return {
        "recording [min]": minutes,
        "times real time": 60.0 * minutes / spent,
        "segments": len(result.segments),
        "resident by minutes [MB]": own,
        "worker by minutes [MB]": workers,
        "processor time of the end [s]": time.process_time() - begin,
        "peak, with the end [MB]": _memory_mb(),
    }


def _resident_mb(process: str) -> float:
    status = Path(f"/proc/{process}/statm").read_text(encoding="ascii")
    return int(status.split()[1]) * resource.getpagesize() / 2**20


def _meeting(seconds: float, period_s: float) -> Capture:
    """A hand without a mesh of many faces that touches a box once a period."""
    count = round(seconds * 100.0)
    times = np.arange(count) / 100.0
    random = np.random.default_rng(0)
    down = 0.5 - 0.5 * np.cos(2.0 * np.pi * times / period_s)
    hand = np.stack([0.0 * times, 0.0 * times, 0.30 - 0.215 * down], axis=1)
    hand += random.normal(0.0, 0.0002, hand.shape)
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    small = scene.shape(scene.trimesh.creation.box((0.08, 0.08, 0.08)))
    table = scene.shape(scene.trimesh.creation.box((0.4, 0.4, 0.1)))
    still = Stream(times, np.zeros((count, 3)), turns)
    return Capture(
        "meeting",
        (Sensor("right_hand", "hand", "right", "arm", Stream(times, hand, turns), small),),
        (scene.TagObject("table", scene.TagType.FIXED, still, table),),
        contact_tolerance_m=0.005,
    )


def _memory_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--events", type=int, default=500)
    parser.add_argument("--minutes", type=float, default=0.2)
    parser.add_argument("--memory", type=float, default=0.0, help="minutes of recording")
    parser.add_argument("--faces", type=int, default=10_000)
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    found = {}
    if options.events:
        found["work per event"] = work_figures(options.events)
    if options.memory:
        found["memory"] = memory_figures(options.memory)
    if options.minutes:
        found["a heavy scene"] = heavy_figures(options.minutes, faces=options.faces)
    if options.json:
        print(json.dumps(found, indent=2))
        return
    for title, figures in found.items():
        print(title)
        for name, value in figures.items():
            shown = f"{value:.4g}" if isinstance(value, float) else value
            print(f"  {name:42}{shown}")


if __name__ == "__main__":
    main()
