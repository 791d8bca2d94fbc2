"""Bodies fitted to recordings that others made, and the recordings performed by other bodies.

``python benchmarks/recorded_bodies.py [WORD ...]``: what is left of residuals, and how bodies
stand, of recordings whose names hold one of these words, of ``all``, or of a box lift, a walk and a
reach. Recordings without a capture of their own in ``examples/`` are drafted first, as ``capar
new-capture`` does. With ``--regenerate`` all, or those of the words, that have an ``assumed.toml``
in ``examples/`` are performed by a woman and a child. Without the recordings nothing is done.
"""

import argparse
import os
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import scene
from natural import abreast, bodies_alone, sheet, staged

from capar.body.body_fitting import fit_body, ground, whole_body
from capar.body.sensor_fitting import Fit
from capar.model.errors import CaparError
from capar.pipelines.round_trips import body, observed_source, round_trip
from capar.regeneration.captures import read_completion
from capar.regeneration.motion import Motion
from capar.regeneration.quality import failures
from capar.regeneration.scenes import read_scene
from capar.regeneration.sources import MOVES_M
from capar.views.viewer.stage import stage, with_mannequin
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

AGENTS = ("woman", "child")
CELL = (840, 420)  # Width and height of a moment in a picture.

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


def performances() -> Iterator[tuple[str, str, Path]]:
    """The name and the place of each recording that is performed, and what is assumed of it."""
    for assumed in sorted(EXAMPLES.glob("*/*assumed.toml")):
        name = assumed.name.removesuffix("assumed.toml").rstrip(".")
        place = assumed.with_name(f"{name or 'capture'}.toml")
        if place.exists():
            yield name or assumed.parent.name, str(place), assumed
        else:  # a take
            hands = "largebox_hands.toml" if "largebox" in name else "hands.toml"
            yield name, f"{assumed.with_name(hands)}:{name}", assumed


def performed(place: str, assumed: Path, agent: str) -> tuple[str, Motion | None]:
    """What comes of a recording that a body performs; a child's scene may be its own."""
    began = time.process_time()
    own = assumed.with_name(assumed.name.replace("assumed", f"{agent}.scene"))
    try:
        source = observed_source(place, assumed)
        where = read_scene(own, source.scene) if own.exists() else source.scene
        trip = round_trip(source, agent, body(agent, source), 0, where)
    except CaparError as error:
        return f"refused: {error}", None
    if trip.quality is None:
        return f"refused: {trip.refused}", None
    par = "same PAR" if trip.same_par else "another PAR"
    said = failures(trip.quality) or "every gate"
    return f"{said}; {par}, {time.process_time() - began:.0f} s", trip.motion


def pictured(place: str, assumed: Path, motions: list[Motion], path: Path) -> None:
    """Draw a recording, and beside it what bodies made of it.

    Where a hand takes hold, and where what it holds is farthest from where it was. Nothing of what
    cannot be performed by anybody.
    """
    try:
        source = observed_source(place, assumed)
    except CaparError:
        return
    if whole_body(place):
        capture, from_s = read_capture(place), read_completion(assumed).from_s
        shown = bodies_alone(with_mannequin(stage(capture), fit_body(place, capture)))
    else:
        shown, from_s = stage(source.capture), 0.0
    shown = replace(shown, times=shown.times - from_s)
    first = min(hold.first for hold in source.holds)
    gone = [np.linalg.norm(p.translation - p.translation[0], axis=1) for p in source.paths.values()]
    far = np.max(gone, axis=0)
    there = (
        source.times[[first, int(far.argmax())]] if far.max() > MOVES_M else source.times[[first]]
    )
    made = [(staged(motion), motion.plan.scene) for motion in motions]
    rows = [
        abreast([(each, float(time_s), scene) for each, scene in [(shown, source.scene), *made]])
        for time_s in there
    ]
    sheet([(row, [0.0]) for row in rows], path, cell=CELL)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", metavar="WORD", help="of the names of recordings")
    parser.add_argument("--regenerate", action="store_true", help="perform them by other bodies")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="draw what is performed")
    asked = parser.parse_args()
    if not scene.recordings():
        return
    if asked.regenerate:
        print(f"| recording | {' | '.join(AGENTS)} |\n|---|---|---|")
        for name, place, assumed in performances():
            if not asked.words or any(word in name for word in asked.words):
                made = [performed(place, assumed, agent) for agent in AGENTS]
                print(f"| {name} | {' | '.join(said for said, _ in made)} |", flush=True)
                motions = [motion for _, motion in made if motion]
                if asked.pictures:
                    asked.pictures.mkdir(parents=True, exist_ok=True)
                    pictured(place, assumed, motions, asked.pictures / f"{name}.png")
        return
    words = asked.words or ["box lift", "walk.bvh", "ReachForwardHigh"]
    print("| recording | followed | median [mm] | 95 % [mm] | over 30 mm | worst of medians [mm] "
          "| sole above floor [mm] | stature [m] | time / motion |")  # fmt: skip
    print("|---|---|---|---|---|---|---|---|---|")
    for name, place in places():
        if words == ["all"] or any(word in name for word in words):
            print(row(name, place), flush=True)


if __name__ == "__main__":
    main()
