"""Observe the batteries at other rates, with other noise and in other draws, and keep a table.

    cd tests && python -m scenes.rates FOLDER [--cell 30:1.5:1 ...] [--table scenes/rates.md]

Each cell is a rate [Hz], a noise of positions [mm] and a draw; rotations have a fifth of a degree
of noise for each millimetre. The outcome of each cell is kept in the folder, and a cell that is
there is not observed again: the folder is to be emptied when the program has changed. The table has
all cells of the folder; where one has all batteries, a row pools them and names the worst. What
the table's file says under a heading below the table stays.
"""

import argparse
import json
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from scenes.batteries import BATTERIES
from scenes.score import Outcome, observed

RATES_HZ = (30.0, 100.0, 240.0)
NOISES_MM = (0.0, 0.5, 1.5)
DRAWS = (0, 1, 2)
DEGREES_PER_MM = 0.2
"""Rotations are as noisy as the tip of a hand is."""

MOVED_S = 0.05
"""A border that is further than this from that of the usual cell has moved [s] (spec 10)."""

HEADER = """# The batteries at other rates, noises and draws

Units right by names, objects and order; those of which each border is within 0.1 s of the truth as
well; and of those with the same steps as at 100 Hz with 0.5 mm in draw 0, how many have all borders
within 50 ms of it. Made by `python -m scenes.rates` (see there).

| rate [Hz] | noise [mm] | draw | battery | names | borders | within 50 ms |
|---|---|---|---|---|---|---|
"""


@dataclass(frozen=True, slots=True, order=True)
class Cell:
    """A way of recording the scenes."""

    rate_hz: float
    noise_mm: float
    draw: int

    @classmethod
    def read(cls, text: str) -> "Cell":
        """A cell as written on the command line: rate, noise and draw, by colons."""
        rate, noise, draw = text.split(":")
        return cls(float(rate), float(noise), int(draw))

    @property
    def name(self) -> str:
        """The name of its file, less the suffix."""
        return f"{self.rate_hz:g}_{self.noise_mm:g}_{self.draw}"


USUAL = Cell(100.0, 0.5, 0)
ALL = tuple(
    Cell(rate, noise, draw)
    for rate in RATES_HZ
    for noise in NOISES_MM
    for draw in (DRAWS if noise else DRAWS[:1])
)
"""Every way; without noise all draws are the same."""


def observed_cell(cell: Cell, battery: str) -> list[Outcome]:
    """The outcomes of a battery recorded so."""
    noise_rad = float(np.radians(DEGREES_PER_MM * cell.noise_mm))
    return [
        outcome
        for name, scene in BATTERIES[battery].items()
        for outcome in observed(
            name, scene, cell.rate_hz, cell.noise_mm / 1000.0, noise_rad, cell.draw
        )
    ]


def outcomes(folder: Path, cell: Cell, battery: str) -> list[Outcome] | None:
    """What the folder has of a cell; None if nothing."""
    path = folder / f"{cell.name}_{battery}.json"
    if not path.exists():
        return None
    return [
        Outcome(**{**each, "expected": tuple(each["expected"]), "found": tuple(each["found"])})
        for each in json.loads(path.read_text())
    ]


def borders(outcome: Outcome) -> list[tuple[str, float]]:
    """The steps that were found, each with its end [s]."""
    return [(step.rsplit(" ", 1)[0], float(step.rsplit("-", 1)[1])) for step in outcome.found]


def stays(one: Outcome, usual: Outcome) -> bool | None:
    """Whether no border is far from the usual one; None if the steps are others."""
    mine, its = borders(one), borders(usual)
    if [step for step, _ in mine] != [step for step, _ in its]:
        return None
    # Times are shown in hundredths of a second, whose differences are not exact in binary.
    return all(round(abs(a - b), 2) <= MOVED_S for (_, a), (_, b) in zip(mine, its, strict=True))


def row(cell: Cell, battery: str, found: list[Outcome], usual: list[Outcome] | None) -> str:
    """A row of the table."""
    named, placed = sum(each.named for each in found), sum(each.placed for each in found)
    kept = [] if usual is None else [stays(a, b) for a, b in zip(found, usual, strict=True)]
    same = [each for each in kept if each is not None]
    near = part(sum(same), len(same)) if usual is not None else ""
    count = len(found)
    return (
        f"| {cell.rate_hz:g} | {cell.noise_mm:g} | {cell.draw} | {battery} "
        f"| {part(named, count)} | {part(placed, count)} | {near} |"
    )


def part(some: int, count: int) -> str:
    """How many of how many, with the share in percent."""
    return f"{some} of {count}" + (f" ({100.0 * some / count:.1f} %)" if count else "")


def pooled(cell: Cell, found: dict[str, list[Outcome]], usual: dict[str, list[Outcome]]) -> str:
    """The row of all batteries of a cell together, with the name of the worst."""
    worst = min(found, key=lambda each: sum(one.named for one in found[each]) / len(found[each]))
    every = [outcome for battery in found for outcome in found[battery]]
    known = [outcome for battery in found for outcome in usual.get(battery, ())]
    beside = known if len(known) == len(every) else None
    return row(cell, f"**all**, worst {worst}", every, beside)


def overall(cells: Iterable[dict[str, list[Outcome]]], usual: dict[str, list[Outcome]]) -> str:
    """The row of all cells together."""
    pairs = [
        (one, its)
        for found in cells
        for name, outcomes in found.items()
        for one, its in zip(outcomes, usual[name], strict=True)
    ]
    row_of_all = row(USUAL, "**all cells**", [one for one, _ in pairs], [its for _, its in pairs])
    return "| any | any | any " + row_of_all[row_of_all.index("| **all cells**") :]


def table(folder: Path) -> str:
    """All cells of a folder."""
    usual = _batteries(folder, USUAL)
    rows = []
    for cell in ALL:
        found = _batteries(folder, cell)
        rows += [row(cell, name, each, usual.get(name)) for name, each in found.items()]
        if len(found) == len(BATTERIES):
            rows.append(pooled(cell, found, usual))
    cells = [_batteries(folder, cell) for cell in ALL]
    if all(name in usual for found in cells for name in found):
        rows.append(overall(cells, usual))
    return HEADER + "\n".join(rows) + "\n"


def _batteries(folder: Path, cell: Cell) -> dict[str, list[Outcome]]:
    """What the folder has of a cell, by battery."""
    found = ((name, outcomes(folder, cell, name)) for name in BATTERIES)
    return {name: each for name, each in found if each is not None}


def fill(folder: Path, cells: Iterable[Cell], batteries: Iterable[str]) -> None:
    """Observe what the folder lacks of some cells."""
    folder.mkdir(parents=True, exist_ok=True)
    for cell in cells:
        for battery in batteries:
            path = folder / f"{cell.name}_{battery}.json"
            if not path.exists():
                rows = [asdict(each) for each in observed_cell(cell, battery)]
                path.write_text(json.dumps(rows, indent=1) + "\n")


def remarks(path: Path) -> str:
    """What a table's file says below its table, under headings of its own."""
    _, heading, rest = (path.read_text() if path.exists() else "").partition("\n## ")
    return heading + rest


def main(arguments: list[str] | None = None) -> int:
    """Observe some cells, and write the table of all that the folder has."""
    parser = argparse.ArgumentParser(prog="scenes.rates", description=__doc__)
    parser.add_argument("folder", type=Path, help="where outcomes are kept, a file a cell")
    parser.add_argument("--cell", action="append", type=Cell.read, help="RATE:NOISE_MM:DRAW")
    parser.add_argument("--battery", action="append", choices=tuple(BATTERIES))
    parser.add_argument("--table", type=Path, help="the table's file; else it is printed")
    options = parser.parse_args(arguments)
    fill(options.folder, options.cell or ALL, options.battery or BATTERIES)
    text = table(options.folder)
    if options.table:
        options.table.write_text(text + remarks(options.table))
    else:
        sys.stdout.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
