"""The line of sight of a head against 8 objects, at every frame, over the length of a capture.

``python benchmarks/attention.py [--minutes 1 10] [--faces 10000] [--sample 200] [--json]``

The plain way asks every surface at every frame, one ray a call; it is timed on evenly spaced
frames and extrapolated. On those frames its answers judge ours.
"""

import argparse
import json
import time

import numpy as np
import scene

from capar.model.capture import Capture
from extractors.bodies.bodies import Bodies, bodies_of
from extractors.bodies.poses import rotation_matrices
from extractors.contact.surfaces import surface
from extractors.relations.attention import NOTHING, Attention, attention
from extractors.thresholds import Thresholds


def plain(capture: Capture, bodies: Bodies, look: Attention, frames: np.ndarray) -> list[int]:
    """What is seen at some frames, by one ray for each object and frame."""
    head = capture.attending[0]
    stream = bodies.sensors[head.name].poses.settled
    found = []
    for frame in frames:
        turn = rotation_matrices(stream.orientations[[frame]])[0]
        ray = turn @ np.array(head.gaze) / np.linalg.norm(head.gaze)
        eye = stream.positions[frame] + turn @ np.array(head.eye)
        best, seen = np.inf, NOTHING
        for index, name in enumerate(look.objects):
            pose = bodies.objects[name].poses.settled
            back = rotation_matrices(pose.orientations[[frame]])[0].T
            start = back @ (eye - pose.positions[frame])
            shape = capture.tag_object(name).shape
            assert shape is not None
            hits = surface(shape).hits(start[None], (back @ ray)[None])[0]
            for hit in hits:
                if np.linalg.norm(hit - start) < best:
                    best, seen = float(np.linalg.norm(hit - start)), index
        found.append(seen)
    return found


def row(minutes: float, sample: int, faces: int) -> dict[str, float]:
    capture, limits = scene.capture(minutes, faces=faces), Thresholds()
    bodies = bodies_of(capture, limits)
    attention(capture, capture.attending[0], bodies, limits)
    begin = time.perf_counter()
    look = attention(capture, capture.attending[0], bodies, limits)
    seconds = time.perf_counter() - begin
    frames = np.linspace(0, len(capture.times) - 1, sample).astype(int)
    begin = time.perf_counter()
    truth = plain(capture, bodies, look, frames)
    plain_s = (time.perf_counter() - begin) * len(capture.times) / sample
    return {
        "minutes": minutes,
        "seconds": seconds,
        "real_time": float(capture.times[-1]) / seconds,
        "plain_s": plain_s,
        "over_plain": plain_s / seconds,
        "frames_with_a_hit": float((look.seen != NOTHING).sum()),
        "judged": sample,
        "mismatches": int((look.seen[frames] != np.array(truth)).sum()),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, nargs="+", default=[1.0, 10.0])
    parser.add_argument("--faces", type=int, default=10_000, help="of a mesh")
    parser.add_argument("--sample", type=int, default=200)
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
    print(f"plain_s is extrapolated from {options.sample} evenly spaced frames")


if __name__ == "__main__":
    main()
