"""Round trips of actions on three bodies in drawn scenes, and what a regeneration takes.

``python benchmarks/regeneration.py`` times the parts of two regenerations at 100 Hz; with ACTIONs
or ``all`` it makes round trips of these, ``--scenes`` of each for each body.
"""

import argparse
import time
from collections import Counter
from itertools import pairwise

from capar.body.scripted_actions import ACTIONS, action_capture
from capar.pipelines.round_trips import Trip, body, observed_source, round_trips
from capar.regeneration.motion import perform_plan
from capar.regeneration.paths import Care
from capar.regeneration.planning import led
from capar.regeneration.quality import failures, quality
from capar.regeneration.search import reachable

AGENTS = ("man", "woman", "child")
SEED = 7
TIMED = (("drink", "child", 100.0), ("pour", "woman", 100.0))
"""Action, agent and frames a second."""


def line(action: str, trip: Trip) -> str:
    """One trip on one line."""
    head = f"{action:15} {trip.agent:6} scene {trip.scene:2}  "
    if trip.quality is None:
        return f"{head}refused: {trip.refused}"
    same = "same PAR" if trip.same_par else f"another PAR ({trip.names})"
    return f"{head}{same}; {failures(trip.quality) or 'every gate passed'}"


def performed(actions: list[str], scenes: int, *, rate_hz: float, noisy: bool) -> None:
    """Trips of some actions, and how many come out well."""
    for action in actions:
        counts = Counter[str]()
        source = observed_source(action_capture(action, rate_hz=rate_hz, noisy=noisy))
        for trip in round_trips(source, AGENTS, scenes=scenes, seed=SEED):
            print(line(action, trip), flush=True)
            counts["asked"] += 1
            counts["in reach"] += trip.quality is not None
            counts["same PAR"] += trip.same_par
            counts["every gate"] += trip.quality is not None and trip.quality.passed
        print(action, ", ".join(f"{name} {count}" for name, count in counts.items()), flush=True)


def timed(action: str, agent: str, rate_hz: float) -> str:
    """What one regeneration takes in seconds of processor time."""
    source = observed_source(action_capture(action, rate_hz=rate_hz))
    human, marks = body(agent, source), [time.process_time()]
    plan = led(reachable(source, source.scene, human), Care())
    marks.append(time.process_time())
    motion = perform_plan(plan)
    marks.append(time.process_time())
    verdict = quality(motion)
    marks.append(time.process_time())
    planning, moving, verifying = (after - before for before, after in pairwise(marks))
    lasts = float(source.times[-1])
    return (
        f"{action} by the {agent}, {lasts:.1f} s at {rate_hz:.0f} Hz: planning {planning:.1f} s, "
        f"motion {moving:.1f} s, {lasts / moving:.1f} x real time, verifying {verifying:.1f} s; "
        f"{failures(verdict) or 'every gate passed'}"
    )


def main() -> None:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("actions", nargs="*", metavar="ACTION", help=", ".join(("all", *ACTIONS)))
    parser.add_argument("--scenes", type=int, default=2, help="how many are drawn")
    parser.add_argument("--noisy", action="store_true", help="with a magnetic tracker's noise")
    parser.add_argument("--rate", type=float, default=30.0, help="frames a second")
    asked = parser.parse_args()
    if asked.actions:
        actions = list(ACTIONS) if asked.actions == ["all"] else asked.actions
        performed(actions, asked.scenes, rate_hz=asked.rate, noisy=asked.noisy)
        return
    for row in TIMED:
        print(timed(*row), flush=True)


if __name__ == "__main__":
    main()
