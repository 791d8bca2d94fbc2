"""What is told of real recordings: texts that we read, kept beside this file.

A text holds every step, then a summary. Where rules or words change what is told, the test fails
until ``CAPAR_GOLDEN=write`` rewrites the texts; then they are to be read again.
"""

import os
import re
from pathlib import Path

import pytest
from observed import observed
from tellings import against_time, steps_of, verbs_of

from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.language.describe import describe

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[4] / "shared/data"))
EXAMPLES = Path(__file__).parents[3] / "examples"
GOLDEN = Path(__file__).parent / "golden"
GROCERIES = ("bleach", "mustard", "mug", "apple", "sugar")
"""The first that are packed: contacts of all sixteen take long to find."""

TAKES = (
    *(f"bimacs_optitrack:take{number}" for number in range(10)),
    f"boxed_vr:{'+'.join(GROCERIES)}",
    "hand_embodiment_pillow",
    "manipnet:cube_med2",
    "manipnet:cup1",
    "manipnet:mug1",
    "omomo_intermimic:sub2_woodchair_003",
    "omomo_intermimic/hands.toml:sub2_largetable_008",
    "omomo_intermimic/hands.toml:sub2_woodchair_005",
    "pyomeca_box_lift",
    "smartbody_mocap_reaching:ReachForwardHigh01",
)


@pytest.mark.skipif(not DATA.is_dir(), reason=f"no recordings in {DATA}; see CAPAR_DATA")
@pytest.mark.parametrize("take", TAKES)
def test_a_recording_is_told_as_we_read_it(
    take: str,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(DATA))
    seen = observed(capture_of(take, tmp_path), tmp_path_factory)
    words = primitive_words(primitive_files())
    steps, summary = describe(seen, words=words), describe(seen, detail="summary", words=words)
    told = f"{steps}\n\n{summary}\n"
    path = golden(take)
    if os.environ.get("CAPAR_GOLDEN") == "write":
        path.write_text(told, encoding="utf-8")
    assert told == path.read_text(encoding="utf-8"), (
        f"{take} is told otherwise than {path.name}; CAPAR_GOLDEN=write rewrites it, to be read"
    )


@pytest.mark.skipif(not DATA.is_dir(), reason=f"no recordings in {DATA}; see CAPAR_DATA")
@pytest.mark.parametrize("take", TAKES)
def test_what_is_told_of_a_recording_agrees_with_its_times(
    take: str,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(DATA))
    words = primitive_words(primitive_files())
    told = describe(observed(capture_of(take, tmp_path), tmp_path_factory), timed=True, words=words)
    assert against_time(told) == []
    assert len(steps_of(told)) == len(verbs_of(told))


def test_every_golden_text_is_of_a_take_that_is_told() -> None:
    assert sorted(GOLDEN.iterdir()) == sorted(golden(take) for take in TAKES)


def capture_of(take: str, folder: Path) -> str:
    """Where a take is; some need a bundle of their own."""
    return groceries(folder) if take.startswith("boxed_vr") else str(EXAMPLES / take)


def groceries(folder: Path) -> str:
    """The recording of groceries with only the first of them, as a bundle of its own."""
    text = (EXAMPLES / "boxed_vr" / "capture.toml").read_text(encoding="utf-8")
    kept = {"right_hand", "head", "table", "carton", *GROCERIES}
    tables = re.split(r"\n(?=\[\[)", text)
    about = [re.search(r'^(?:second|name) = "([\w ]+)"', each, re.MULTILINE) for each in tables]
    head, *rest = zip(tables, about, strict=True)
    told = [table for table, name in rest if name and name[1] in kept]
    (folder / "capture.toml").write_text("\n".join([head[0], *told]), encoding="utf-8")
    return str(folder)


def golden(take: str) -> Path:
    """Where the text of a take is."""
    name = take.replace(".toml", "").replace("/", ".").replace(":", ".").replace("+", "_")
    return GOLDEN / f"{name}.txt"
