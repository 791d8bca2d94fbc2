"""Recordings that others made, held against what they timed and where things ended.

python benchmarks/recordings.py [carries] [containers] [--takes 16]

The recordings are found through the environment variable CAPAR_DATA; without it nothing is done.
"""

import argparse
import json
import os
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from capar.evaluation.carry_timing import Carry, Miss, measure, near
from capar.evaluation.containers import halved, landings
from extractors.readers.bundle.capture_toml import read_capture, read_files, takes
from extractors.readers.bundle.location import open_bundle

EXAMPLES = Path(__file__).parents[1] / "examples"
SCENES = EXAMPLES / "boxed_vr" / "scenes.toml"
UNSEEN = {Miss.STILL, Miss.CREEPS}
"""What motion alone cannot tell: the object does not move, or less than what counts as motion."""


def carries(take: str) -> list[Carry]:
    """Every carry of a scene, of objects with a mesh and without."""
    table, _ = open_bundle(f"{SCENES}:{take}")
    bodies = read_files(table)["scene"].bodies
    return [
        measure(f"{take} {name}", body) for name, body in bodies.items() if name != "main_camera"
    ]


def carried(names: list[str]) -> dict[str, Any]:
    """How many ends of carries are found within 0.1 s, and why the others are not."""
    found = [each for name in names for each in carries(name)]
    hits = near(found)
    misses = [{each.onset.miss, each.offset.miss} - {None} for each in found]
    seen = np.array([not each & UNSEEN for each in misses])
    return {
        "carries": len(found),
        "onset_percent": _percent(hits[:, 0]),
        "offset_percent": _percent(hits[:, 1]),
        "both_percent": _percent(hits.all(axis=1)),
        "onsets_missed": _counts(each.onset.miss for each in found),
        "offsets_missed": _counts(each.offset.miss for each in found),
        "carries_without_those_that_do_not_move": int(seen.sum()),
        "both_percent_without_those_that_do_not_move": _percent(hits[seen].all(axis=1)),
        "missed": [
            {
                "carry": each.name,
                "end": side,
                "error_s": round(end.error_s, 2),
                "shift_mm": round(1000.0 * end.shift_m, 1),
                "why": end.miss,
            }
            for each in found
            for side, end in (("onset", each.onset), ("offset", each.offset))
            if end.miss
        ],
    }


def contained(names: list[str]) -> dict[str, Any]:
    """``into`` against where the objects' middles are, for the whole box and for its halves."""
    whole: Counter[str] = Counter()
    halves: Counter[str] = Counter()
    wrong, left_out = [], {}
    for name in names:
        capture = read_capture(f"{SCENES}:{name}")
        left_out[name] = [
            each.message for each in capture.notices if each.code == "objects-left-out"
        ]
        parted, both = halved(capture, "carton")
        for counts, group in (
            (whole, landings(capture, ["carton"])),
            (halves, landings(parted, both)),
        ):
            for each in group:
                right = "right" if each.told == each.true else "wrong"
                counts[f"{'into' if each.true else 'not into'}, {right}"] += 1
                if each.told != each.true:
                    wrong.append(f"{name}: {each.object} {each.container}, told {each.told}")
    return {
        "scenes": len(names),
        "whole_box": dict(sorted(whole.items())),
        "its_halves": dict(sorted(halves.items())),
        "wrong": wrong,
        "left_out": left_out,
    }


def _percent(hits: Any) -> float:
    return round(100.0 * float(np.mean(hits)), 1)


def _counts(kinds: Any) -> dict[str, int]:
    return dict(sorted(Counter(str(each) for each in kinds if each).items()))


PARTS: dict[str, Callable[[list[str]], dict[str, Any]]] = {
    "carries": carried,
    "containers": contained,
}


def main() -> None:
    """Print each part as JSON that people can read."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", help="carries, containers; else all")
    parser.add_argument("--takes", type=int, default=16, help="scenes of groceries, at most")
    options = parser.parse_args()
    if unknown := sorted(set(options.parts) - set(PARTS)):
        parser.error(f"no part {unknown}; there are {list(PARTS)}")
    if not Path(os.environ.get("CAPAR_DATA") or "no folder").is_dir():
        print("no recordings: set CAPAR_DATA")
        return
    names = takes(SCENES)[: options.takes]
    found = {part: PARTS[part](names) for part in options.parts or PARTS}
    print(json.dumps(found, indent=2, ensure_ascii=False))


if __name__ == "__main__":
    main()
