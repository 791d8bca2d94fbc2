"""What virtual performers look at against what is measured of it, by their eyes and by the face.

Every action of ``capar perform`` by man, woman and child; of eyes with a tracker's noise, too.
Beside each: how many fixations are told right throughout, and the share of their time that is, on
things and on none; the farthest that the eyes miss the point they look at while it stays.

Run as ``PYTHONPATH=.:tests python benchmarks/looking.py [ACTION ...]``.
"""

import sys
from collections.abc import Sequence

import numpy as np
from virtual_bodies.drinking import AGENTS
from virtual_bodies.looking import Fixation, fixations, share_told

from capar.body.recording import record
from capar.body.scripted_actions import ACTIONS, performed
from capar.body.sensors import PERFECT, Tracker


def line(found: Sequence[Fixation]) -> str:
    things = [fixation for fixation in found if fixation.thing]
    right = sum(fixation.told == 1.0 for fixation in things)
    missed = np.degrees(max(fixation.missed_rad for fixation in found))
    return (
        f"{right:3} of {len(things):3} on things, {100 * share_told(found, of_things=True):5.1f} % "
        f"of their time; {100 * share_told(found, of_things=False):5.1f} % of the time on none; "
        f"missed by {missed:.2f} degrees at most"
    )


RECORDINGS = {
    "eyes": {"tracker": PERFECT},
    "noisy eyes": {"tracker": Tracker()},
    "face": {"tracker": PERFECT, "eye_tracker": False},
}


def main() -> None:
    every: dict[str, list[Fixation]] = {kind: [] for kind in RECORDINGS}
    for action in sys.argv[1:] or ACTIONS:
        for who in AGENTS:
            made = performed(action, who)
            for kind, how in RECORDINGS.items():
                here = fixations(made, record(made, name=action, seed=3, **how))
                every[kind].extend(here)
                print(f"{action:8} {who:6} {kind:10}  {line(here)}", flush=True)
    for kind, found in every.items():
        print(f"{'all':15} {kind:10}  {line(found)}")


if __name__ == "__main__":
    main()
