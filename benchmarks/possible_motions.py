"""Which of the test motions a human body can perform standing, within its joint limits, as a table.

Run as ``PYTHONPATH=.:tests python benchmarks/possible_motions.py [PERFORMER ...]``; one BLAS thread
(``OPENBLAS_NUM_THREADS=1``) is faster than several. A motion is possible if hands and feet, and the
mouth where it is an object, are followed to 10 mm and 10 degrees, and the head's turn likewise,
no joint is faster than 25 rad/s, and the centre of mass is above the soles that bear weight, or
within what is between them. Feet that are not tracked stay where they are, and where that is is
tried out.
"""

import sys

import motions
import numpy as np
from virtual_bodies.possible import ACTS, Missed, missed


def row(name: str, made: Missed) -> str:
    """A line of the table."""
    told = "yes" if made.possible else f"no: {' and '.join(made.reasons)}"
    if made.possible and any(made.stands):
        told += ", standing {:+.2f} m ahead and {:+.2f} m to the left".format(*made.stands)
    return (
        f"| {name} | {told} | {1e3 * made.metres:.1f} | {np.degrees(made.radians):.1f} "
        f"| {made.fastest_radps:.0f} | {-1e3 * made.beside_m:.0f} | {made.what} |"
    )


def main(names: list[str]) -> None:
    found = []
    for performer in motions.PERFORMERS:
        if names and performer.name not in names:
            continue
        print(f"## {performer.name}\n")
        print("| motion | possible | mm | degrees | rad/s | mm inside the soles | worst |")
        print("|---|---|---|---|---|---|---|")
        own = []
        for act in ACTS:
            made = missed(act(performer).capture)
            own.append(made.possible)
            print(row(act.__name__, made), flush=True)
        print(f"\n{sum(own)} of {len(own)} are possible.\n", flush=True)
        found += own
    print(f"{sum(found)} of {len(found)} are possible ({np.mean(found):.0%}).")


if __name__ == "__main__":
    main(sys.argv[1:])
