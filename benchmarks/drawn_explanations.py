"""Segments of real recordings drawn at random, explained for readers who judge them by that.

Run by hand: ``PYTHONPATH=tests python benchmarks/drawn_explanations.py SEED FOLDER [--count 20]
[--kept FOLDER]`` with ``CAPAR_DATA``. Takes are drawn without replacement, and of each one
segment, whatever its name. For each number the folder gets what ``capar explain`` prints, the
picture of ``--plot``, and the bodies at the segment's start, middle and end, as ``capar view
--png`` draws them; ``drawn.tsv`` says what was drawn, and is not for readers. With a second
folder, captures and observations are kept there and read again.
"""

import argparse
import pickle
import random
from pathlib import Path

from capar.model.capture import Capture
from capar.model.observation import Observation, Segment
from capar.pipelines.explanation import Explained, explained
from capar.pipelines.explanation_text import explanation_lines, notice_lines, staying
from capar.pipelines.measured.claims import draw_claims
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from capar.views.viewer.snapshot import snapshot
from capar.views.viewer.stage import stage
from capar_rules.engine.profiles import profile
from extractors.measure import measure

ROOT = Path(__file__).parents[1]
DEMO = ROOT / "capar" / "demo" / "drink_from_mug"
CARRIED = (
    *(f"sub2_largetable_{number:03d}" for number in (0, 1, 2, 3, 4, 5, 7, 8, 9)),
    *(f"sub2_woodchair_{number:03d}" for number in range(7)),
)
REACHED = (
    *("BackLow01", "ForwardHigh01", "ForwardLow01", "ForwardMediumMid01", "Left30Low01"),
    *("Left60MediumNear01", "Right120Low01", "Right30MediumMid01"),
)
PACKED = (1, 2, 17, 23, 30, 34, 39, 40, 45, 48, 50, 52, 62, 64, 76, 78)
TAKES = (
    "demo",
    "hand_embodiment_pillow",
    "pyomeca_box_lift",
    *(f"manipnet:{name}" for name in ("cube_med2", "cup1", "mug1")),
    *(f"bimacs_optitrack:take{number}" for number in range(10)),
    *(f"omomo_intermimic/hands.toml:{name}" for name in CARRIED),
    "omomo_intermimic/largebox_hands.toml:sub3_largebox_003",
    *(f"omomo_intermimic:{name}" for name in CARRIED),
    "omomo_intermimic/largebox.toml:sub3_largebox_003",
    *(f"smartbody_mocap_reaching:Reach{name}" for name in REACHED),
    "boxed_vr",
    *(f"boxed_vr/scenes.toml:p{number}_s1" for number in PACKED),
)


def observed(take: str, kept: Path | None) -> tuple[Observation, Capture]:
    """What was understood of a take, and its capture."""
    name = take.replace("/", ".").replace(":", ".")
    files = [] if kept is None else [kept / f"{name}.{what}" for what in ("pickle", "capture")]
    if files and all(file.exists() for file in files):
        observation, capture = (pickle.loads(file.read_bytes()) for file in files)
        return observation, capture
    capture = trial_of(DEMO if take == "demo" else ROOT / "examples" / take)
    observation = observe_measured(capture, measure(capture))
    for file, value in zip(files, (observation, capture), strict=bool(files)):
        file.write_bytes(pickle.dumps(value))
    return observation, capture


def draw(seen: Explained, capture: Capture, segment: Segment, out: Path, number: int) -> None:
    """Write the text and the pictures of one segment."""
    (told,) = seen.explainer.explain_all([segment])
    lines = [*explanation_lines([told], seen, tree=True), *notice_lines([segment], seen, [told])]
    text = "".join(f"{line}\n" for line in lines)
    (out / f"{number:02d}.txt").write_text(text, encoding="utf-8")
    draw_claims(seen, told, out / f"{number:02d}.png", staying=staying(told))
    middle_s = 0.5 * (segment.start_s + segment.end_s)
    moments = {"a_start": segment.start_s, "b_middle": middle_s, "c_end": segment.end_s}
    for when, time_s in moments.items():
        snapshot(stage(capture, at_s=time_s), time_s, out / f"{number:02d}_{when}.png")


def main() -> None:
    """Draw the segments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("seed", type=int)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--kept", type=Path, help="folder of captures and observations")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    chance = random.Random(given.seed)
    takes = chance.sample(list(TAKES), given.count)
    drawn = [(take, chance.random()) for take in takes]
    rows = []
    for number, (take, share) in enumerate(drawn, start=1):
        _, capture = observed(take, given.kept)
        seen = explained(capture, rules=profile())
        segments = seen.observation.segments
        segment = segments[int(share * len(segments))]
        draw(seen, capture, segment, given.folder, number)
        rows.append(f"{number}\t{take}\t{segment.ee}/{segment.index}\t{segment.name}\n")
        print(rows[-1], end="", flush=True)
    (given.folder / "drawn.tsv").write_text("".join(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
