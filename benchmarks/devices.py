"""Every driver against its simulator at the highest rate that its line carries.

Run as ``python benchmarks/devices.py [--seconds 20] [--long] [--at-once 3]``. Without ``--long``
every format and mode, one line each; with it one run a driver, all side by side, each a process.
Printed are frames, the records sent and accepted, how many were wrong (no record that was sent, in
order) and lost; the second decoder of the tests says what was sent. The script fails if a record is
wrong, one is lost on a clean line, or under nine tenths of the undamaged are kept on a bad one.

A pseudo-terminal holds a second of a full line, so a process that stands still for longer loses
records that no driver could have read. Printed is how long it stood still at most; where other
programs run, ``chrt -r 10 python benchmarks/devices.py`` keeps them from being the cause. A run
keeps every record, of which the collector of garbage would go through millions: it is off.
"""

import argparse
import gc
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

import numpy as np
import tracked

from extractors.devices.bird_formats import FORMATS
from extractors.devices.drivers import find_tracker
from extractors.devices.fastrak import ITEMS, FastrakSimulator
from extractors.devices.flock import MOST_HZ, FlockLayout, FlockRig, FlockSimulator
from extractors.devices.motionstar import MotionStarSimulator
from extractors.devices.simulator import Faults, SmoothMotion
from extractors.devices.tracker import Frame, LiveTracker
from extractors.devices.vrpn import VrpnSimulator

KEPT = 0.9
TURN_S = 0.01
"""How often it is looked whether the process stands still [s]."""


@dataclass(frozen=True)
class Case:
    """One run."""

    driver: str
    form: str = "pos_quat"
    sensors: int = 12
    mode: str = "stream"
    lost_share: float = 0.0
    unplugged_s: float = 0.0
    """How long the plug is pulled in the middle [s]."""


def short() -> list[Case]:
    """Every format and mode, and bad lines."""
    modes = ("stream", "point")
    flock = [Case("flock", form, n, mode) for form in FORMATS for n in (1, 12) for mode in modes]
    bad = [Case("flock", form, birds, "stream", 0.005) for form in FORMATS for birds in (1, 12)]
    star = [Case("motionstar", form, 12, mode) for form in FORMATS for mode in ("tcp", "udp")]
    fastrak = [
        Case("fastrak", form, stations, mode)
        for form in ITEMS
        for stations in (1, 4)
        for mode in ("binary stream", "ascii stream", "binary point", "ascii point")
    ]
    worse = [
        Case("fastrak", "pos_quat", 4, f"{each} stream", 0.005) for each in ("binary", "ascii")
    ]
    pulled = [
        Case("flock", sensors=12, unplugged_s=3.0),
        Case("motionstar", mode="tcp", unplugged_s=3.0),
        Case("fastrak", sensors=4, mode="binary stream", unplugged_s=3.0),
        Case("vrpn", unplugged_s=3.0),
    ]
    several = [Case("flock", "pos_quat", 12, "lines")]
    net = [Case("motionstar", mode="udp", lost_share=0.005), Case("vrpn"), Case("lsl")]
    return [*flock, *bad, *several, *star, *fastrak, *worse, *net, *pulled]


def long() -> list[Case]:
    """One run a driver, and a bad line."""
    return [
        Case("flock"),
        Case("flock", lost_share=0.005),
        Case("motionstar", mode="udp"),
        Case("fastrak", sensors=4, mode="binary stream"),
        Case("vrpn", sensors=4),
        Case("lsl", sensors=4),
    ]


def run(case: Case, seconds: float) -> dict[str, Any]:
    """The figures of a run, with the longest time in which the process stood still."""
    stalls, ended = [0.0], threading.Event()

    def watch() -> None:
        while not ended.is_set():
            before_s = time.monotonic()
            time.sleep(TURN_S)
            stalls.append(max(stalls.pop(), time.monotonic() - before_s - TURN_S))

    gc.disable()
    watching = threading.Thread(target=watch)
    watching.start()
    try:
        found = RUNS[case.driver](case, seconds)
    finally:
        ended.set()
        watching.join()
    return {**found, "stood_still_s": stalls[0]}


def received(tracker: LiveTracker, simulator: Any, case: Case, seconds: float) -> list[Frame]:
    """The frames of a run, with the plug pulled in the middle if asked for."""
    with tracker:
        frames = tracked.collect(tracker, seconds / 2.0)
        if case.unplugged_s:
            simulator.unplug()
            frames += tracked.collect(tracker, case.unplugged_s)
            simulator.replug()
        frames += tracked.collect(tracker, seconds / 2.0)
        return frames


def figures(tracker: LiveTracker, frames: list[Frame], held: list[tracked.Held]) -> dict[str, Any]:
    counts, span_s = tracker.counts, frames[-1].host_s - frames[0].host_s
    return {
        "hz": (len(frames) - 1) / span_s,
        "frames": len(frames),
        "sent": sum(each.sent for each in held),
        "intact": sum(each.intact for each in held),
        "accepted": sum(each.accepted for each in held),
        "wrong": sum(each.wrong for each in held),
        "counted_lost": counts.lost_records,
        "refused": counts.refused_records,
        "reconnections": counts.reconnections,
    }


def run_flock(case: Case, seconds: float) -> dict[str, Any]:
    log: list[Any] = []
    lines = case.mode == "lines"
    group = case.sensors > 1 and not lines
    limit_hz = FlockLayout(FORMATS[case.form], group).limit_hz(1 if lines else case.sensors, 115200)
    rate_hz = int(10.0 * min(MOST_HZ, limit_hz)) / 10.0
    rig = FlockRig(erc=group, line_a_bird=lines)
    faults = Faults(case.lost_share, seed=1)
    with FlockSimulator(SmoothMotion(case.sensors), rig, faults, log) as simulator:
        options = f"birds={case.sensors}&erc={'yes' if group else 'no'}&format={case.form}"
        mode = "stream" if lines else case.mode
        place = f"flock:{simulator.place}?{options}&mode={mode}&rate={rate_hz}"
        tracker = find_tracker(place)
        frames = received(tracker, simulator, case, seconds)
    inches = 144.0 if group else 36.0
    held = tracked.held_by_flock(frames, log, case.form, group=group, range_inch=inches)
    return {"asked_hz": rate_hz, **figures(tracker, frames, held)}


def run_motionstar(case: Case, seconds: float) -> dict[str, Any]:
    log: list[Any] = []
    faults = Faults(case.lost_share, seed=1)
    with MotionStarSimulator(SmoothMotion(case.sensors), faults, log) as simulator:
        options = f"birds={case.sensors}&format={case.form}&transport={case.mode}"
        tracker = find_tracker(f"motionstar:{simulator.place}?{options}&rate={MOST_HZ:g}")
        frames = received(tracker, simulator, case, seconds)
    held = tracked.held_by_motionstar(frames, log, case.form)
    return {"asked_hz": MOST_HZ, **figures(tracker, frames, held)}


def run_fastrak(case: Case, seconds: float) -> dict[str, Any]:
    log: list[Any] = []
    encoding, mode = case.mode.split()
    faults = Faults(case.lost_share, seed=1)
    with FastrakSimulator(SmoothMotion(case.sensors), faults, log) as simulator:
        options = f"stations={case.sensors}&format={case.form}&encoding={encoding}&mode={mode}"
        tracker = find_tracker(f"fastrak:{simulator.place}?{options}")
        frames = received(tracker, simulator, case, seconds)
    held = tracked.held_by_fastrak(frames, log, case.form, binary=encoding == "binary")
    return {"asked_hz": 120.0 / case.sensors, **figures(tracker, frames, held)}


def run_vrpn(case: Case, seconds: float) -> dict[str, Any]:
    log: list[Any] = []
    with VrpnSimulator(SmoothMotion(case.sensors), MOST_HZ, log) as simulator:
        tracker = find_tracker(f"vrpn:{simulator.place}?sensors={case.sensors}")
        frames = received(tracker, simulator, case, seconds)
    return {
        "asked_hz": MOST_HZ,
        **figures(tracker, frames, tracked.held_by_vrpn(frames, log)),
    }


def run_lsl(case: Case, seconds: float) -> dict[str, Any]:
    """A sender in the same process, at the highest rate of the birds."""
    motion, name = SmoothMotion(case.sensors), f"capar_benchmark_{os.getpid()}"
    with loopback():
        from lsl_loopback import LslOutlet

        outlet = LslOutlet(name, motion.sensors, MOST_HZ)
        tracker = find_tracker(f"lsl:{name}?timeout=20")
        got: list[Frame] = []
        with tracker:
            start = time.monotonic()
            count = int(seconds * MOST_HZ)
            for index in range(count):
                outlet.push(Frame(time.monotonic(), None, *motion.poses(index / MOST_HZ)))
                due_s = start + (index + 1) / MOST_HZ
                while (left_s := due_s - time.monotonic()) > 0.0:
                    got += tracker.poll(left_s)
            got += tracked.collect(tracker, 0.5)
    truth = [np.hstack(motion.poses(index / MOST_HZ)) for index in range(count)]
    held = [
        tracked.compare(
            tracked.poses(got, sensor),
            tracked.signed(np.array([each[sensor] for each in truth])),
            [True] * count,
        )
        for sensor in range(case.sensors)
    ]
    return {"asked_hz": MOST_HZ, **figures(tracker, got, held)}


@contextmanager
def loopback() -> Iterator[None]:
    """Confine Lab Streaming Layer to this computer."""
    text = (
        "[ports]\nIPv6=disable\n[multicast]\nResolveScope=machine\nListenAddress=127.0.0.1\n"
        "AddressesOverride={127.0.0.1}\n[lab]\nKnownPeers={127.0.0.1}\n"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "lsl_api.cfg"
        path.write_text(text)
        os.environ["LSLAPICFG"] = str(path)
        yield


RUNS: dict[str, Callable[[Case, float], dict[str, Any]]] = {
    "flock": run_flock,
    "motionstar": run_motionstar,
    "fastrak": run_fastrak,
    "vrpn": run_vrpn,
    "lsl": run_lsl,
}


def is_good(case: Case, found: dict[str, Any]) -> bool:
    """Whether a run is as claimed."""
    kept = found["accepted"] >= KEPT * found["intact"]
    whole = bool(case.lost_share or case.unplugged_s) or (
        found["accepted"] == found["sent"] and found["counted_lost"] == 0
    )
    again = found["reconnections"] == bool(case.unplugged_s)
    return found["wrong"] == 0 and found["frames"] > 0 and kept and whole and again


def apart(case: Case, seconds: float) -> dict[str, Any]:
    """A run in a process of its own."""
    text = json.dumps(asdict(case))
    done = subprocess.run(
        [sys.executable, __file__, "--one", text, "--seconds", str(seconds)],
        capture_output=True, text=True, check=False, timeout=seconds * 3.0 + 120.0,
    )  # fmt: skip
    if done.returncode:
        return {"failed": done.stderr[-600:]}
    return json.loads(done.stdout)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--at-once", type=int, default=3)
    parser.add_argument("--one", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        print(json.dumps(run(Case(**json.loads(given.one)), given.seconds)))
        return 0
    cases = long() if given.long else short()
    bad = 0
    with ThreadPoolExecutor(len(cases) if given.long else given.at_once) as pool:
        futures = {pool.submit(apart, case, given.seconds): case for case in cases}
        for future in as_completed(futures):
            case, found = futures[future], future.result()
            good = "failed" not in found and is_good(case, found)
            bad += not good
            print(told(case, found, good=good), flush=True)
    print(f"{len(cases) - bad} of {len(cases)} runs of {given.seconds:g} s as claimed")
    return int(bad > 0)


def told(case: Case, found: dict[str, Any], *, good: bool) -> str:
    """A run in a line."""
    extra = f" {100 * case.lost_share:g} % lost" if case.lost_share else ""
    extra += f" unplugged {case.unplugged_s:g} s" if case.unplugged_s else ""
    head = (
        f"{'ok ' if good else 'BAD'} {case.driver} {case.form} x{case.sensors} {case.mode}{extra}:"
    )
    if "failed" in found:
        return f"{head} {found['failed']}"
    return (
        f"{head} {found['hz']:.1f} of {found['asked_hz']:.1f} Hz, {found['frames']} frames, "
        f"{found['sent']} records sent, {found['intact']} intact, {found['accepted']} taken, "
        f"{found['wrong']} wrong; {found['counted_lost']} told as lost, "
        f"{found['refused']} refused, reconnected {found['reconnections']}; stood still for "
        f"{found['stood_still_s']:.2f} s at most"
    )


if __name__ == "__main__":
    sys.exit(main())
