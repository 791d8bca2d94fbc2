"""What virtual performers look at against what is measured of it, by their eyes and by their face.

Every action of ``capar perform`` by man, woman and child. Beside each: how many fixations are told
right throughout, and the share of their time that is, on things and on none; the farthest that the
eyes miss the point they look at while it stays.

Run as ``PYTHONPATH=.:tests python benchmarks/looking.py [ACTION ...]``.
"""

import sys

import numpy as np
from virtual_bodies.drinking import AGENTS
from virtual_bodies.looking import Fixation, fixations, share_told

from capar.body.recording import record
from capar.body.scripted_actions import ACTIONS, performed
from capar.body.sensing import PERFECT


def line(found: list[Fixation]) -> str:
    things = [each for each in found if each.thing]
    right = sum(each.told >= 0.9 for each in things)
    missed = np.degrees(max(each.missed_rad for each in found))
    return (
        f"{right:3} of {len(things):3} on things, {100 * share_told(found, of_things=True):5.1f} % "
        f"of their time; {100 * share_told(found, of_things=False):5.1f} % of the time on none; "
        f"missed by {missed:.2f} degrees at most"
    )


def main() -> None:
    every: dict[bool, list[Fixation]] = {True: [], False: []}
    for action in sys.argv[1:] or ACTIONS:
        for who in AGENTS:
            made = performed(action, who)
            for eyes, found in every.items():
                capture = record(made, name=action, seed=3, tracker=PERFECT, eye_tracker=eyes)
                here = list(fixations(made, capture))
                found.extend(here)
                label = "eyes" if eyes else "face"
                print(f"{action:8} {who:6} {label}  {line(here)}", flush=True)
    for eyes, found in every.items():
        print(f"{'all':15} {'eyes' if eyes else 'face'}  {line(found)}")


if __name__ == "__main__":
    main()
