"""Time to measure and to reason against the length of a capture, each beside real time.

Run by hand: ``python benchmarks/observing.py [--minutes 1 10 60] [--json]``. Four sensors and eight
objects with meshes of 10,000 faces at 100 Hz. The plain check, the distance of every pair at every
frame, is timed in the same run on a few frames of each pair and extrapolated.
"""

import argparse
import json
import resource
import time

import fcl
import scene

from capar.model.capture import Capture
from capar_rules.engine.profiles import profile
from capar_rules.pars.inference import infer
from extractors.contact.contacts import shaped, watched
from extractors.measure import Measurements, measure

SAMPLE = 10


def timed(minutes: float) -> dict[str, float]:
    """Seconds and ratios for one length."""
    capture = scene.capture(minutes)
    start = time.perf_counter()
    measured = measure(capture)
    extracted = time.perf_counter()
    inference = infer(measured.facts, profile=profile())
    reasoned = time.perf_counter()
    seconds = 60.0 * minutes
    plain_s = plain(capture, measured)
    return {
        "minutes": minutes,
        "facts": len(measured.facts),
        "segments": sum(len(each.segments) for each in inference.links),
        "extract_s": extracted - start,
        "reason_s": reasoned - extracted,
        "times real time": seconds / (reasoned - start),
        "plain check_s": plain_s,
        "times plain check": plain_s / (extracted - start),
        "peak memory_gb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20,
    }


def plain(capture: Capture, measured: Measurements) -> float:
    """How long the distance of every pair at every frame would take [s]."""
    frames = len(capture.times)
    chosen = range(0, frames, max(1, frames // SAMPLE))
    total = 0.0
    for pair in watched(capture, measured.bodies):
        bodies = [shaped(each) for each in pair]
        if None in bodies:
            continue
        trees = [fcl.CollisionObject(each.surface.tree) for each in bodies if each]
        start = time.perf_counter()
        for frame in chosen:
            for tree, each in zip(trees, pair, strict=True):
                pose = each.poses.settled
                turn = fcl.Transform(pose.orientations[frame], pose.positions[frame])
                tree.setTransform(turn)
            fcl.distance(*trees, fcl.DistanceRequest(), fcl.DistanceResult())
        total += (time.perf_counter() - start) * frames / len(chosen)
    return total


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, nargs="+", default=[1.0, 10.0, 60.0])
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    rows = []
    for minutes in options.minutes:
        rows.append(timed(minutes))
        if not options.json:
            line = (f"{name} {value:,.4g}" for name, value in rows[-1].items())
            print("  ".join(line), flush=True)
    if options.json:
        print(json.dumps(rows, indent=2))


if __name__ == "__main__":
    main()
