"""Round trips of actions on three bodies in drawn scenes, and what a regeneration takes.

``python benchmarks/regeneration.py`` times the parts of two regenerations at 100 Hz; with ACTIONs,
or ``all`` ten of the figures, it makes round trips of these, ``--scenes`` of each for each body;
with ``--noisy`` of noisy recordings, and in the first scene of others for comparison. The
table at the end says how many fingers closed onto what their hand holds, how deep a bone of them is
inside of anything at any frame, and how far a finger is off what it closed on while it is held.
"""

import argparse
import statistics
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from functools import lru_cache, partial
from itertools import pairwise, product
from multiprocessing import get_context

import numpy as np
from scene import ADDITIONS, REFERENCE_S

from capar.body.scripted_actions import ACTIONS, action_capture
from capar.pipelines.round_trips import Trip, body, numbered_scene, observed_source, round_trip
from capar.regeneration.motion import perform_plan
from capar.regeneration.paths import Care
from capar.regeneration.planning import led
from capar.regeneration.quality import failures, quality
from capar.regeneration.search import reachable
from capar.regeneration.sources import Source

ALL = [
    "drink", "sip", "touch", "touch_from_rest", "slide", "turn", "push", "pick_up", "carry", "pour",
]  # fmt: skip
AGENTS = ("man", "woman", "child")
SEED = 7
TIMED = (("drink", "child", 100.0), ("pour", "woman", 100.0))
"""Action, agent and frames a second."""

Closed = tuple[np.ndarray, np.ndarray]
"""Grasps, fingers that close in them and all fingers; the deepest and the farthest one [mm]."""

Row = tuple[str, Counter[str], float, Closed]
"""A trip in words, what came of it, what it took [s], and how fingers closed."""

FINGERS = "| action | grasps | fingers that close | deepest inside [mm] | farthest off [mm] |"


def line(action: str, trip: Trip) -> str:
    """One trip on one line."""
    head = f"{action:15} {trip.agent:6} scene {trip.scene:2}  "
    if trip.quality is None:
        return f"{head}refused: {trip.refused}"
    same = "same PAR" if trip.same_par else f"another PAR ({trip.names})"
    return f"{head}{same}; {failures(trip.quality) or 'every gate passed'}"


@lru_cache(maxsize=1)
def recorded(action: str, rate_hz: float, *, noisy: bool) -> Source:
    """A recording of the man."""
    return observed_source(action_capture(action, rate_hz=rate_hz, noisy=noisy))


def made(action: str, number: int, agent: str, *, rate_hz: float, noisy: bool) -> Row:
    """One trip, observing the recording left out of its time."""
    source = recorded(action, rate_hz, noisy=noisy)
    began = time.process_time()
    scene = numbered_scene(source, number, SEED)
    trip = round_trip(source, agent, body(agent, source), number, scene)
    took_s = time.process_time() - began
    passed = trip.quality is not None and trip.quality.passed
    came = {
        "asked": True, "in reach": not trip.refused, "same PAR": trip.same_par,
        "every gate": passed, "both": trip.same_par and passed,
    }  # fmt: skip
    counts = Counter(name for name, holds in came.items() if holds)
    return line(action, trip), counts, took_s, closed(trip)


def closed(trip: Trip) -> Closed:
    """How the fingers closed in a trip."""
    if trip.quality is None or trip.motion is None:
        return np.zeros(3, int), np.zeros(2)
    grasps = [grasp for own in trip.motion.grasps.values() for grasp in own if grasp.things]
    reaching, short = (sum(len(getattr(g, name)) for g in grasps) for name in ("reaching", "short"))
    measured = {each.name: each.value for each in (*trip.quality.gates, *trip.quality.told)}
    worst = [measured.get(f"fingers {name}", 0.0) for name in ("inside", "off")]
    return np.array([len(grasps), reaching, reaching + short]), np.array(worst)


def fingers(name: str, rows: list[Row]) -> str:
    """A row of the table of fingers."""
    grasps, reaching, every = np.sum([row[3][0] for row in rows], axis=0)
    inside, off = np.max([row[3][1] for row in rows], axis=0)
    return f"| {name} | {grasps} | {reaching} of {every} | {inside:.2f} | {off:.2f} |"


def summary(name: str, rows: list[Row]) -> str:
    """What came of some trips."""
    counts, took = sum((row[1] for row in rows), Counter[str]()), [row[2] for row in rows]
    told = ", ".join(f"{counts[key]} {key}" for key in ("asked", "in reach", "same PAR"))
    return (
        f"{name:24} {told}, {counts['every gate']} every gate, {counts['both']} both; "
        f"{statistics.median(took):.1f} s in the median, {max(took):.1f} s at most"
    )


def performed(actions: list[str], scenes: int, *, rate_hz: float, noisy: bool, jobs: int) -> None:
    """Trips of some actions, and how many come out well."""
    began = time.process_time()
    exec(ADDITIONS, {})
    scale = REFERENCE_S / (time.process_time() - began)
    print(f"processor time; on the reference machine it is x {scale:.2f}", flush=True)
    table = list[str]()
    every: dict[bool, list[Row]] = {each: [] for each in ((False, True) if noisy else (False,))}
    with ExitStack() as stack:
        each_of = map
        if jobs > 1:
            each_of = stack.enter_context(ProcessPoolExecutor(jobs, get_context("spawn"))).map
        for action, noise in product(actions, every):
            one, rows = partial(made, action, rate_hz=rate_hz, noisy=noise), list[Row]()
            numbers = range(1, scenes + 1 if noise == noisy else 2)
            for row in each_of(one, *zip(*product(numbers, AGENTS), strict=True)):
                print(f"{row[0]}; {row[2]:.1f} s", flush=True)
                rows.append(row)
            print(summary(f"{action}, {'noisy' if noise else 'without noise'}", rows), flush=True)
            every[noise] += rows
            table.append(fingers(f"{action}, {'noisy' if noise else 'without noise'}", rows))
    for noise, found in every.items():
        print(summary(f"all, {'noisy' if noise else 'without noise'}", found))
        table.append(fingers(f"all, {'noisy' if noise else 'without noise'}", found))
    print("\n".join([FINGERS, "|---|---|---|---|---|", *table]), flush=True)


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
    parser.add_argument("--noisy", action="store_true", help="a magnetic tracker's noise as well")
    parser.add_argument("--rate", type=float, default=30.0, help="frames a second")
    parser.add_argument("--jobs", type=int, default=1, help="processes that share the trips")
    asked = parser.parse_args()
    if asked.actions:
        actions = ALL if asked.actions == ["all"] else asked.actions
        performed(actions, asked.scenes, rate_hz=asked.rate, noisy=asked.noisy, jobs=asked.jobs)
        return
    for row in TIMED:
        print(timed(*row), flush=True)


if __name__ == "__main__":
    main()
