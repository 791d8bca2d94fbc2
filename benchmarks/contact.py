"""Contact of 4 sensors with 8 objects at every frame, beside plain distances in the same run.

``python benchmarks/contact.py [--minutes 1 10] [--faces 10000] [--sample 150] [--json]``

The plain way asks for the distance of every pair at every frame. It would take hours, so it is
timed on evenly spaced frames of the same capture and extrapolated to all. On those frames its
distances also judge the answers: a mismatch is an answer that differs although the distance is
further than 0.05 mm from the tolerance.
"""

import argparse
import json
import time

import fcl
import numpy as np
import scene

from extractors.bodies.bodies import BodyGeometry, bodies_of
from extractors.contact.contacts import watched
from extractors.contact.proximity import Body, near
from extractors.contact.touch_distances import touchable
from extractors.thresholds import Thresholds

TOLERANCE_M = 0.005
EXACT_M = 0.00005
Pair = tuple[BodyGeometry, BodyGeometry]


def surfaces(pairs: list[Pair]) -> dict[BodyGeometry, Body]:
    return {each: touchable(each) for pair in pairs for each in pair if each.shape is not None}


def plain(one: Body, two: Body, frames: np.ndarray) -> np.ndarray:
    """Exact distances [m] at some frames, with nothing skipped."""
    first, second = fcl.CollisionObject(one.surface.tree), fcl.CollisionObject(two.surface.tree)
    out = np.empty(len(frames))
    turns = one.turns_at(frames), two.turns_at(frames)
    for index, frame in enumerate(frames):
        first.setTransform(fcl.Transform(turns[0][index], one.positions[frame]))
        second.setTransform(fcl.Transform(turns[1][index], two.positions[frame]))
        out[index] = fcl.distance(first, second, fcl.DistanceRequest(), fcl.DistanceResult())
    return out


def ours(where: dict[BodyGeometry, Body], pairs: list[Pair]) -> tuple[float, list[np.ndarray]]:
    begin = time.perf_counter()
    found = [near(where[one], where[two], distance_m=TOLERANCE_M) for one, two in pairs]
    return time.perf_counter() - begin, found


def row(minutes: float, sample: int, faces: int) -> dict[str, float]:
    capture = scene.capture(minutes, faces=faces)
    bodies = bodies_of(capture, Thresholds())
    every = list(watched(capture, bodies))
    where = surfaces(every)
    pairs = [each for each in every if each[0] in bodies.sensors.values()]
    first_s, _ = ours(where, pairs)
    seconds, found = ours(where, pairs)
    all_s, _ = ours(where, every)
    frames = np.linspace(0, len(capture.times) - 1, sample).astype(int)
    begin = time.perf_counter()
    exact = [plain(where[one], where[two], frames) for one, two in pairs]
    plain_s = (time.perf_counter() - begin) * len(capture.times) / len(frames)
    wrong = sum(
        int((((far <= TOLERANCE_M) != near_[frames]) & (np.abs(far - TOLERANCE_M) > EXACT_M)).sum())
        for far, near_ in zip(exact, found, strict=True)
    )
    real_s = float(capture.times[-1])
    return {
        "minutes": minutes,
        "pairs": len(pairs),
        "first_s": first_s,
        "seconds": seconds,
        "real_time": real_s / seconds,
        "plain_s": plain_s,
        "over_plain": plain_s / seconds,
        "contact_frames": float(sum(each.sum() for each in found)),
        "judged": float(sample * len(pairs)),
        "mismatches": wrong,
        "all_pairs": len(every),
        "all_pairs_real_time": real_s / all_s,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, nargs="+", default=[1.0, 10.0])
    parser.add_argument("--faces", type=int, default=10_000, help="of a mesh")
    parser.add_argument("--sample", type=int, default=150)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    rows = [row(each, options.sample, options.faces) for each in options.minutes]
    if options.json:
        print(json.dumps(rows, indent=2))
        return
    print(f"{'':24s}" + "".join(f"{each['minutes']:>12g} min" for each in rows))
    for key in rows[0]:
        if key != "minutes":
            print(f"{key:24s}" + "".join(f"{each[key]:>16,.6g}" for each in rows))
    print(f"plain_s is extrapolated from {options.sample} evenly spaced frames of each pair")


if __name__ == "__main__":
    main()
