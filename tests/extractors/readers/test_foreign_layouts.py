"""Files in other makers' layouts, written by somebody who had not seen the readers, are understood.

Each is drafted and observed as it is, but for the edits that are stated here; what happens in it
stands in the README beside the files.
"""

from itertools import groupby
from pathlib import Path

import pytest

from capar.pipelines.observation import observe
from extractors.readers.drafting.draft import draft
from extractors.readers.registry import read_recording

FOLDER = Path(__file__).parents[2] / "foreign_layouts"
EDITS = {"markers_tabs.trc": (('up = "z"', 'up = "y"'),)}
"""What a person must change in the draft: no word in a TRC, and nothing in it, says what is up."""

STEPS = ["Reach", "Touch", "Lift", "Carry", "PutDown", "Touch", "ResumePosture"]
NEAR_S = 0.06  # Palm and object are nearer than 5 mm for up to 0.18 s beyond what is stated.


def moments() -> dict[str, tuple[float, ...]]:
    """First contact, leaving the support, put down and release of each file [s]."""
    rows = [
        [cell.strip(" `") for cell in line.strip("|").split("|")]
        for line in (FOLDER / "README.md").read_text().splitlines()
    ]
    found = [row for row in rows if len(row) == 11 and row[0].endswith((".csv", ".trc"))]
    return {row[0]: tuple(float(row[n]) for n in (2, 3, 7, 8)) for row in found}


@pytest.mark.parametrize("name", sorted(moments()))
def test_the_draft_says_what_was_done_and_when(name: str, tmp_path: Path) -> None:
    text = draft([read_recording(FOLDER / name)], tmp_path, "foreign")
    for old, new in EDITS.get(name, ()):
        assert text.count(old) == 1
        text = text.replace(old, new)
    (tmp_path / "capture.toml").write_text(text)
    seen = observe(tmp_path)
    hand = next(link for link in seen.links if link.kind == "hand" and link.side == "right")
    steps = [each for each in hand.segments if each.name != "Rest"]
    pauses = {n for n, each in enumerate(steps) if each.name == "Touch"} - {1, len(steps) - 2}
    names = [each.name for n, each in enumerate(steps) if n not in pauses]
    assert [name for name, _ in groupby(names)] == STEPS
    contact, leaves, down, release = moments()[name]
    assert steps[0].end_s == pytest.approx(contact, abs=NEAR_S)
    assert steps[2].start_s == pytest.approx(leaves, abs=NEAR_S)
    assert steps[-2].start_s == pytest.approx(down, abs=NEAR_S)
    assert steps[-1].start_s == pytest.approx(release, abs=NEAR_S)
    others = [each for link in seen.links if link is not hand for each in link.segments]
    assert {each.name for each in others} <= {"Rest"}
