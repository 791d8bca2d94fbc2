"""Time to reason over facts against the length of a capture, beside facts for every frame.

``python benchmarks/reasoning.py [--minutes 1 10 60] [--runs 3] [--json]``: four end-effectors each
pick a mug up, carry it and put it down once in four seconds; the rules of the profile ``extended``
name every segment. Beside it, in the same run, the plain way: one atom a frame, and borders found
by a walk along the frames, which is linear (up to ten minutes), or by asking that no border lies
between, which is cubic (one minute). Processor time; 1e6 frames are ``--minutes 166.7``.
"""

import argparse
import json
from collections.abc import Callable
from statistics import median
from time import process_time

from capar.model.facts import Fact, Frames, Link, Moving, RateMhz, Tag, Touching
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
    """Median processor time of a piece of work [s]; one run is enough of what takes a second."""
    times: list[float] = []
    while len(times) < runs and sum(times) < 1.0:
        start = process_time()
        work()
        times.append(process_time() - start)
    return median(times)


def measure(minutes: float, *, runs: int) -> dict[str, float]:
    """Seconds for one length, by way of reasoning."""
    frames = round(60.0 * minutes * RATE_HZ)
    facts, rules, found = episodes(frames), profile("extended"), []
    row = {
        "frames": float(frames),
        "interval facts [s]": seconds(lambda: found.append(infer(facts, profile=rules)), runs=runs),
        "  of it borders numbered": seconds(
            lambda: number_borders(facts, crossings_only=False), runs=runs
        ),
        "every frame, a walk [s]": float("nan"),
        "every frame, none between [s]": float("nan"),
        "segments": float(sum(len(link.segments) for link in found[0].links)),
    }
    row["times real time"] = 60.0 * minutes / row["interval facts [s]"]
    for name, way, longest in (("a walk", WALK, 10.0), ("none between", NONE_BETWEEN, 1.0)):
        if minutes <= longest:
            text = every_frame(frames) + way
            row[f"every frame, {name} [s]"] = seconds(lambda text=text: solve((), text), runs=runs)
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, nargs="+", default=[1.0, 10.0, 60.0])
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    rows = [measure(minutes, runs=options.runs) for minutes in options.minutes]
    for row in rows:
        growth = row["interval facts [s]"] / rows[0]["interval facts [s]"]
        row["growth, of linear"] = growth / (row["frames"] / rows[0]["frames"])
    if options.json:
        print(json.dumps(rows, indent=2))
        return
    print(f"{'':30}" + "".join(f"{each:>10g} min" for each in options.minutes))
    for key in rows[0]:
        print(f"{key:30}" + "".join(f"{row[key]:14,.4g}" for row in rows))


if __name__ == "__main__":
    main()
