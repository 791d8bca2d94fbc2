"""Ground rules, and time to ground them, against the number of contacts in one long rest.

Run by hand: ``python benchmarks/resting.py [--json]``. A hand rests for the whole of a trial, while
a box comes to it and goes away again each second; beside it a second hand rests as long and nothing
comes. Whether a rest is disturbed is numbered outside of the rules. Beside the whole profile
``extended``, in the same run: that numbering alone, and the plain way, which asks it of every tick
of the rest inside the rules; the solver leaves off at the first tick that answers, so it is slower
and no steeper as long as the answer is yes.
"""

import argparse
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from statistics import median
from time import perf_counter

import clingo

from capar.model.facts import Fact, Frames, Link, RateMhz, Resting, Tag, Touching, program
from capar_rules.borders.border_numbers import Tick, number_borders, undisturbed
from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import solve

RATE_HZ = 100
PERIOD = 100

BY_TICKS = """
contact_at(Hand, Body, Tick) :- within(Hand, Body, _, _, From, To), Tick = From..To.
touched(Hand, From, To) :- spans(Hand, resting, Hand, Hand, From, To), Tick = From..To,
    contact_at(Hand, Hand, Tick).
#show touched/3.
"""


def trial(contacts: int) -> tuple[Fact, ...]:
    """Two hands at rest throughout, one of which a box touches so many times."""
    frames = PERIOD * (contacts + 1)
    return (
        Frames(0, frames),
        RateMhz(1000 * RATE_HZ),
        Tag("box", "mobile"),
        *(Link(each, "hand", "none") for each in ("left_hand", "right_hand")),
        *(Resting(each, 0, frames) for each in ("left_hand", "right_hand")),
        *(
            Touching("right_hand", "box", start, start + 40)
            for start in range(PERIOD // 2, frames - PERIOD, PERIOD)
        ),
    )


def seconds(work: Callable[[], object], *, runs: int) -> float:
    """Median time of a piece of work [s]."""
    times = []
    for _ in range(runs):
        start = perf_counter()
        work()
        times.append(perf_counter() - start)
    return median(times)


def measure(contacts: int, *, runs: int) -> dict[str, float]:
    """Seconds for one length, by way."""
    facts, files = trial(contacts), profile("extended").files
    numbered = number_borders(facts, crossings_only=False)
    ticks = [each.frame for each in numbered if isinstance(each, Tick) and each.ee == "right_hand"]
    rests = [each for each in facts if isinstance(each, Resting) and each.ee == "right_hand"]
    own = [each for each in facts if isinstance(each, Touching)]
    text = program((*facts, *numbered))
    row = {
        "contacts": float(contacts),
        "numbered outside": seconds(
            lambda: list(undisturbed("right_hand", ticks, rests, own)), runs=runs
        ),
        "asked of every tick": seconds(lambda: solve((), text + BY_TICKS), runs=runs),
        "all rules": seconds(lambda: ground_rules(files, text), runs=runs),
        "ground rules": float(ground_rules(files, text)),
    }
    row["ground rules a contact"] = row["ground rules"] / contacts
    return row


def ground_rules(files: Iterable[Path], text: str) -> int:
    """How many ground rules the rule files have over facts."""
    control = clingo.Control(logger=lambda code, message: None)
    for path in files:
        control.load(str(path))
    control.add("base", [], text)
    control.ground([("base", [])])
    control.solve()
    return int(control.statistics["problem"]["lp"]["rules"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    rows = [
        measure(contacts, runs=options.runs)
        for contacts in (500, 1_000, 2_000, 4_000, 8_000, 16_000)
    ]
    if options.json:
        print(json.dumps(rows, indent=2))
        return
    for row in rows:
        print("  ".join(f"{name} {value:,.4g}" for name, value in row.items()))
    first, last = rows[0], rows[-1]
    longer = last["contacts"] / first["contacts"]
    for name in ("ground rules", "all rules"):
        growth = last[name] / first[name] / longer
        print(f"growth of {name} over {longer:.0f} times the contacts: {growth:.2f} of linear")


if __name__ == "__main__":
    main()
