"""Which of the test motions a human body can perform within its joint limits, as a table.

Run as ``PYTHONPATH=.:tests python benchmarks/possible_motions.py [PERFORMER ...]``; one BLAS thread
(``OPENBLAS_NUM_THREADS=1``) is faster than several. A motion is possible if hands and feet, and the
mouth where it is an object, are followed to 10 mm and 10 degrees, and the head's turn likewise,
and no joint is faster than 25 rad/s. Feet that are not tracked stay where they are, and where
that is is tried out; whether the person would fall is not judged.
"""

import sys

import motions
import numpy as np
from virtual_bodies.possible import ACTS, Missed, missed


def row(name: str, who: str, made: Missed) -> str:
    """A line of the table."""
    told = "yes" if made.possible else "no"
    if made.possible and any(made.stands):
        told += ", standing {:+.2f} m ahead and {:+.2f} m to the left".format(*made.stands)
    return (
        f"| {name} | {who} | {told} | {1e3 * made.metres:.1f} | {np.degrees(made.radians):.1f} "
        f"| {made.fastest_radps:.0f} | {made.what} |"
    )


def main(names: list[str]) -> None:
    found = []
    for performer in motions.PERFORMERS:
        if names and performer.name not in names:
            continue
        made = {act.__name__: missed(act(performer).capture) for act in ACTS}
        possible = [judged.possible for judged in made.values()]
        found += possible
        print(f"## {performer.name}: {sum(possible)} of {len(possible)} are possible\n")
        print("| motion | performer | possible | mm | degrees | rad/s | worst |")
        print("|---|---|---|---|---|---|---|")
        for name, judged in made.items():
            print(row(name, performer.name, judged))
        print(flush=True)
    print(f"{sum(found)} of {len(found)} are possible ({np.mean(found):.0%}).")


if __name__ == "__main__":
    main(sys.argv[1:])
