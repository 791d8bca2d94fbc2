"""Time to reason over facts against the length of a capture, beside facts for every frame.

Run by hand: ``python benchmarks/reasoning.py [--json]``. Four end-effectors each pick a mug up,
carry it and put it down once in four seconds; the rules of the profile ``extended`` name every
segment. Beside it, in the same run, the plain way: one atom a frame, and borders found by a walk
along the frames, which is linear, or by asking that no border lies between, which is cubic.
"""

import argparse
import json
from collections.abc import Callable
from statistics import median
from time import perf_counter

from capar.model.facts import Fact, Frames, Link, Moving, RateMhz, Tag, Touching, program
from capar_rules.borders.numbering import number_borders
from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import solve
from capar_rules.pars.inference import infer

RATE_HZ = 100
PERIOD = 400
HANDS = ("right_hand", "left_hand", "right_foot", "left_foot")

WALK = """
before(Hand, Frame + 1, Frame) :- contact(Hand, Object, Frame),
    not contact(Hand, Object, Frame - 1).
before(Hand, Frame + 1, Start) :- before(Hand, Frame, Start), frame(Frame), contact(Hand, _, Frame).
#show before/3.
"""
NONE_BETWEEN = """
border(Hand, Frame) :- contact(Hand, Object, Frame), not contact(Hand, Object, Frame - 1).
border(Hand, Frame) :- contact(Hand, Object, Frame), not contact(Hand, Object, Frame + 1).
between(Hand, First, Last) :- border(Hand, First), border(Hand, Middle), border(Hand, Last),
    First < Middle, Middle < Last.
segment(Hand, First, Last) :- border(Hand, First), border(Hand, Last), First < Last,
    not between(Hand, First, Last).
#show segment/3.
"""


def episodes(frames: int) -> tuple[Fact, ...]:
    """A capture of so many frames, as interval facts."""
    facts: list[Fact] = [Frames(0, frames), RateMhz(1000 * RATE_HZ), Tag("table", "fixed")]
    for hand in HANDS:
        mug = f"{hand}_mug"
        facts += [Link(hand, "hand", "none"), Tag(mug, "mobile")]
        free = 0
        for start in range(0, frames - PERIOD, PERIOD):
            facts += [
                Touching(hand, mug, start + 100, start + 300),
                Moving(mug, start + 122, start + 268),
                Touching(mug, "table", free, start + 120),
            ]
            free = start + 270
    return tuple(facts)


def every_frame(frames: int) -> str:
    """The same contacts of the hands, one atom a frame."""
    spans = [each for each in episodes(frames) if isinstance(each, Touching) and each.body in HANDS]
    atoms = [
        f"contact({each.body},{each.other},{frame})."
        for each in spans
        for frame in range(each.first, each.last + 1)
    ]
    return "\n".join(atoms) + f"\nframe(0..{frames})."


def seconds(work: Callable[[], object], *, runs: int) -> float:
    """Median time of a piece of work [s]."""
    times = []
    for _ in range(runs):
        start = perf_counter()
        work()
        times.append(perf_counter() - start)
    return median(times)


def measure(frames: int, *, runs: int, cubic: bool, walk: bool) -> dict[str, float]:
    """Seconds for one length, by way of reasoning."""
    facts, rules = episodes(frames), profile("extended")
    row = {
        "frames": float(frames),
        "segments": float(sum(len(each.segments) for each in infer(facts, profile=rules).links)),
        "number the borders": seconds(
            lambda: number_borders(facts, crossings_only=False), runs=runs
        ),
        "interval facts": seconds(lambda: infer(facts, profile=rules), runs=runs),
    }
    row["times real time"] = frames / RATE_HZ / row["interval facts"]
    if walk:
        text = every_frame(frames)
        row["every frame, a walk"] = seconds(lambda: solve((), text + WALK), runs=runs)
    if cubic:
        row["every frame, none between"] = seconds(
            lambda: solve((), text + NONE_BETWEEN), runs=runs
        )
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    minute = 60 * RATE_HZ
    rows = [
        measure(frames, runs=options.runs, cubic=frames <= minute, walk=frames <= 60 * minute)
        for frames in (minute, 10 * minute, 60 * minute, 1_000_000)
    ]
    if options.json:
        print(json.dumps(rows, indent=2))
        return
    for row in rows:
        print("  ".join(f"{name} {value:,.4g}" for name, value in row.items()))
    first, last = rows[0], rows[-1]
    growth = (last["interval facts"] / first["interval facts"]) / (last["frames"] / first["frames"])
    print(f"growth from one minute to 1e6 frames: {growth:.2f} of linear")
    print(f"size of the facts of one minute: {len(program(episodes(minute))):,} characters")


if __name__ == "__main__":
    main()
