"""Segments of real recordings drawn at random, explained for readers who judge them by that.

Run by hand: ``PYTHONPATH=tests python benchmarks/drawn_explanations.py SEED FOLDER [--count 20]
[--kept FOLDER]`` with ``CAPAR_DATA``. Takes are drawn from those of ``told_sentences.py`` without
replacement, and of each one segment, whatever its name. For each number the folder gets what
``capar explain`` prints, the picture of ``--plot``, and the bodies at the segment's start, middle
and end, as ``capar view --png`` draws them; ``drawn.tsv`` says what was drawn, and is not for
readers. With a second folder, captures and observations are kept there and read again.
"""

import argparse
import random
from pathlib import Path

from told_sentences import TAKES, observed

from capar.model.capture import Capture
from capar.model.observation import Segment
from capar.pipelines.explanation import Explained, explained
from capar.pipelines.explanation_text import explanation_lines, notice_lines, staying
from capar.pipelines.measured.claims import draw_claims
from capar.views.viewer.snapshot import snapshot
from capar.views.viewer.stage import stage
from capar_rules.engine.profiles import profile


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
