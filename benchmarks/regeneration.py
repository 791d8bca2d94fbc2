"""Round trips of five actions on three bodies in drawn scenes: what comes out, and how good.

Run as ``PYTHONPATH=.:tests python benchmarks/regeneration.py [SCENES [ACTION ...]]``.
"""

import sys
import time
from collections import Counter

from capar.body.scripted_actions import ACTIONS, action_capture
from capar.pipelines.round_trips import Trip, observed_source, round_trips

AGENTS = ("man", "woman", "child")
SEED = 7
RATE_HZ = 30.0


def line(action: str, trip: Trip, seconds: float) -> str:
    head = f"{action:8} {trip.agent:6} scene {trip.scene:2} {seconds:6.1f} s  "
    if trip.quality is None:
        return f"{head}not performed: {trip.refused}"
    failed = [
        f"{g.name} {g.value:.2f} {g.unit} {g.bodies}" for g in trip.quality.gates if not g.passed
    ]
    same = "same PAR" if trip.same_par else f"another PAR ({trip.names})"
    if trip.same_par and not trip.same_contacts:
        same += ", other contacts"
    if trip.same_par and not trip.same_relations:
        same += ", other relations"
    return f"{head}{same}; {'; '.join(failed) or 'every gate passed'}"


def run(action: str, scenes: int) -> list[Trip]:
    source = observed_source(action_capture(action, rate_hz=RATE_HZ))
    trips, began = [], time.process_time()
    for trip in round_trips(source, AGENTS, scenes=scenes, seed=SEED):
        print(line(action, trip, time.process_time() - began), flush=True)
        trips.append(trip)
        began = time.process_time()
    return trips


def summary(trips: list[Trip]) -> str:
    done = [trip for trip in trips if not trip.refused]
    good = [trip for trip in done if trip.quality is not None and trip.quality.passed]
    failed = Counter(name for trip in done if trip.quality for name in trip.quality.failed)
    return (
        f"{len(trips)} asked, {len(done)} in reach, {sum(t.same_par for t in done)} same PAR, "
        f"{len(good)} every gate, {sum(t.passed for t in done)} passed; "
        f"failed gates: {dict(failed)}"
    )


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2
    everything: list[Trip] = []
    for action in sys.argv[2:] or ACTIONS:
        found = run(action, count)
        print(f"{action}: {summary(found)}", flush=True)
        everything += found
    print(f"all: {summary(everything)}")
