"""Bodies fitted to recordings that others made: what is left of residuals, and how they stand.

``python benchmarks/recorded_bodies.py [WORD ...]``: recordings whose names hold one of these words,
``all``, or a box lift, a walk and a reach. Recordings without a capture of their own in
``examples/`` are drafted first, as ``capar new-capture`` does. Without the recordings nothing is
done.
"""

import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import scene

from capar.body.body_fitting import fit_body, ground
from capar.body.sensor_fitting import Fit
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import draft
from extractors.readers.registry import read_recording

EXAMPLES = Path(__file__).parents[1] / "examples"
CLIPS = ("sub2_largetable_000", "sub2_largetable_008", "sub2_woodchair_003", "sub2_woodchair_005",
         "sub3_largebox_003")  # fmt: skip
REACHES = ("ReachBackLow01", "ReachForwardHigh01", "ReachForwardLow01", "ReachForwardMediumMid01",
           "ReachLeft30Low01", "ReachLeft60MediumNear01", "ReachRight120Low01",
           "ReachRight30MediumMid01")  # fmt: skip
FILES = ("cmu_walk.bvh", "std_walking2_markers.trc", "walk_free_01.trc", "sgi_int.c3d",
         "test3.bvh", "racing.c3d", "propulsion.c3d")  # fmt: skip

FAR_MM = 30.0
"""Distances larger than this are counted, as ``capar fit`` reports them [mm]."""


def places() -> Iterator[tuple[str, str]]:
    """The name and the place of each capture."""
    yield "box lift", str(EXAMPLES / "pyomeca_box_lift")
    for clip in CLIPS:
        file = "largebox.toml" if "largebox" in clip else "capture.toml"
        yield clip, f"{EXAMPLES / 'omomo_intermimic' / file}:{clip}"
    for reach in REACHES:
        yield reach, f"{EXAMPLES / 'smartbody_mocap_reaching'}:{reach}"
    for name in FILES:
        source = Path(os.environ["CAPAR_DATA"]) / "foreign_files" / name
        folder = Path(tempfile.mkdtemp())
        (folder / "capture.toml").write_text(draft([read_recording(source)], folder, "drafted"))
        yield name, str(folder)


def soles_mm(made: Fit, floor_m: float | None) -> str:
    """Height of the lower sole above the floor, as half of the frames have it [mm]."""
    if floor_m is None:
        return "-"
    sites = made.human.sites(made.motion, ["right_sole", "left_sole"])
    lower = np.minimum(*(sites[f"{side}_sole"][0][:, 2] for side in ("right", "left")))
    seen = ~np.all([*made.bridged.values()], axis=0)
    return f"{1e3 * (float(np.median(lower[seen])) - floor_m):.0f}"


def row(name: str, place: str) -> str:
    """A recording's line of the table."""
    capture = read_capture(place)
    made = fit_body(place, capture)
    medians = {n: 1e3 * float(np.nanmedian(each)) for n, each in made.residuals_m.items()}
    every = 1e3 * np.concatenate([*made.residuals_m.values()])
    worst = max(medians, key=lambda n: medians[n])
    span = float(made.times[-1] - made.times[0])
    return (
        f"| {name} | {len(medians)} | {np.nanmedian(every):.1f} | {np.nanpercentile(every, 95):.1f}"
        f" | {np.nanmean(every > FAR_MM):.1%}"
        f" | {medians[worst]:.1f} ({worst.rpartition(':')[2]}) | {soles_mm(made, ground(capture))}"
        f" | {made.human.measures['stature']:.2f} | {made.seconds / span:.1f} |"
    )


def main() -> None:
    """Print the table."""
    if not scene.recordings():
        return
    words = sys.argv[1:] or ["box lift", "walk.bvh", "ReachForwardHigh"]
    print("| recording | followed | median [mm] | 95 % [mm] | over 30 mm | worst of medians [mm] "
          "| sole above floor [mm] | stature [m] | time / motion |")  # fmt: skip
    print("|---|---|---|---|---|---|---|---|---|")
    for name, place in places():
        if words == ["all"] or any(word in name for word in words):
            print(row(name, place), flush=True)


if __name__ == "__main__":
    main()
