"""What is told of real recordings: texts that we read, kept beside this file.

A text is of one reading of its recording, whose digest is its first line: where the rules read the
recording otherwise by now, there is nothing to compare. ``CAPAR_GOLDEN=write`` writes the texts
anew, to be read again.
"""

import hashlib
import os
from pathlib import Path

import pytest

from capar.model.observation import Observation
from capar.report import primitive_files, primitive_words
from capar.words import observed
from kb.language.describe import describe

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[4] / "shared/data"))
EXAMPLES = Path(__file__).parents[3] / "examples"
GOLDEN = Path(__file__).parent / "golden"
TAKES = (
    "pyomeca_box_lift",
    "hand_embodiment_pillow",
    "bimacs_optitrack:take0",
    "bimacs_optitrack:take1",
    "bimacs_optitrack:take7",
    "manipnet:cup1",
)


@pytest.mark.skipif(
    not (DATA.is_dir() and EXAMPLES.is_dir()), reason=f"no recordings in {DATA}; see CAPAR_DATA"
)
@pytest.mark.parametrize("take", TAKES)
def test_a_recording_is_told_as_we_read_it(take: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(DATA))
    seen = observed(str(EXAMPLES / take), profile="extended", rules=None)
    told = describe(seen, words=primitive_words(primitive_files()))
    path = GOLDEN / f"{take.replace(':', '.')}.txt"
    if os.environ.get("CAPAR_GOLDEN") == "write":
        path.write_text(f"{digest(seen)}\n{told}\n", encoding="utf-8")
    read, text = path.read_text(encoding="utf-8").splitlines()
    if read != digest(seen):
        pytest.skip(f"{take} is read otherwise than when its text was written (CAPAR_GOLDEN=write)")
    assert told == text


def digest(seen: Observation) -> str:
    """What the rules say of a recording, as one word: what a telling depends on."""
    rows = [
        (each.ee, each.first, each.last, each.name, each.general, each.objects, each.possessed)
        for each in seen.segments
    ]
    moves = [(each.ee, each.start_s, each.core.motion.value) for each in seen.ipars]
    said = (rows, moves, [each.purpose for each in seen.segments], sorted(map(str, seen.facts)))
    return hashlib.sha256(repr(said).encode()).hexdigest()
