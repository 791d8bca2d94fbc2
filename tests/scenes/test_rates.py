"""Scenes keep their names at other rates, with other noise and in other draws (spec 10)."""

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from scenes.batteries import BATTERIES
from scenes.hands import SCENES
from scenes.rates import ALL, USUAL, Cell, main, stays, table
from scenes.score import Outcome, observed

RATES_HZ = (30.0, 100.0, 240.0)
NOISES_M = (0.0, 0.0005, 0.0015)
NOISE_RAD_PER_M = np.radians(0.2) / 0.001
"""Rotations are as noisy as the tip of a hand is: a fifth of a degree beside a millimetre."""

SOME = 4
"""One scene in so many is observed here, each with a rate, noise and draw of its own."""

WAYS = [
    (name, RATES_HZ[place % 3], NOISES_M[place // 3 % 3], place // 9 % 3)
    for place, name in enumerate(sorted(SCENES)[::SOME])
]


@pytest.mark.parametrize(("name", "rate_hz", "noise_m", "draw"), WAYS)
def test_a_scene_has_its_names_at_any_rate_and_noise(
    name: str, rate_hz: float, noise_m: float, draw: int
) -> None:
    for each in observed(name, SCENES[name], rate_hz, noise_m, NOISE_RAD_PER_M * noise_m, draw):
        assert each.named, f"{each.ee} at {rate_hz:g} Hz: {each.expected}, found {each.found}"


def outcome(end_s: float, *, named: bool = True) -> Outcome:
    """One unit of one step."""
    return Outcome(
        "a", "hand", ("Rest() 0.00-1.00",), (f"Rest() 0.00-{end_s:.2f}",), named, named, 0
    )


def kept(folder: Path, cell: Cell, battery: str, *found: Outcome) -> None:
    """Keep outcomes as the tool does."""
    rows = [asdict(each) for each in found]
    (folder / f"{cell.name}_{battery}.json").write_text(json.dumps(rows))


def test_noiseless_scenes_are_recorded_once_at_each_rate() -> None:
    assert len(ALL) == len(set(ALL)) == 21
    assert sum(cell.noise_mm == 0.0 for cell in ALL) == 3


def test_a_border_stays_within_50_ms_and_other_steps_do_not_count() -> None:
    assert stays(outcome(1.04), outcome(1.0)) is True
    assert stays(outcome(1.05), outcome(1.0)) is True
    assert stays(outcome(1.06), outcome(1.0)) is False
    other = Outcome("a", "hand", (), ("Touch(cup) 0.00-1.00",), False, False, None)
    assert stays(other, outcome(1.0)) is None


def test_the_batteries_of_a_cell_are_pooled_only_when_all_are_there(tmp_path: Path) -> None:
    first, *others = BATTERIES
    kept(tmp_path, USUAL, first, outcome(1.0), outcome(1.0, named=False))
    assert "**all**" not in table(tmp_path)
    for battery in others:
        kept(tmp_path, USUAL, battery, outcome(1.0))
    right, all_of_them = len(BATTERIES), len(BATTERIES) + 1
    pooled = f"{right} of {all_of_them} ({100.0 * right / all_of_them:.1f} %)"
    assert f"**all**, worst {first} | {pooled} | {pooled}" in table(tmp_path)


def test_remarks_below_a_table_outlast_a_new_table(tmp_path: Path) -> None:
    cells = tmp_path / "cells"
    cells.mkdir()
    kept(cells, USUAL, "hands", outcome(1.0))
    path = tmp_path / "rates.md"
    path.write_text("# Old\n\n| old |\n\n## What moved\n\nNothing.\n")
    main([str(cells), "--cell", "100:0.5:0", "--battery", "hands", "--table", str(path)])
    text = path.read_text()
    assert text.endswith("\n## What moved\n\nNothing.\n")
    assert "| old |" not in text
    assert "1 of 1" in text
