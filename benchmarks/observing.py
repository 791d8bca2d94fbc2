"""Time of the whole of `observe`, stage by stage, against the length of a capture.

Run by hand: ``python benchmarks/observing.py [--minutes 1 10 60] [--sensors 12] [--json]``. Hands,
feet and a head, more sensors on trunk and limbs where more are asked for, and eight objects with
meshes of 10,000 faces at 100 Hz. Times are wall time in one process; stages that call each other
are listed beneath their caller and counted in it.
"""

import argparse
import json
import resource
import time
from collections.abc import Callable
from typing import Any
from unittest.mock import patch

import scene

from capar.pipelines.observation import observe

STAGES = {
    "measure": "capar.pipelines.observation.measure",
    "  contact": "extractors.measure.contacts",
    "  line of sight": "extractors.measure.attention",
    "  handling": "extractors.measure.handling",
    "flicker": "capar.pipelines.observation.steady",
    "reason": "capar.pipelines.observation.infer",
    "  facts to text": "capar_rules.engine.solver.program",
    "  answers back": "capar_rules.engine.solver._shown",
    "PARs": "capar.pipelines.observation.upars",
    "composing": "capar.pipelines.observation.compose",
}
"""Every stage that is timed, and the name by which its caller knows it."""


def measure(minutes: float, sensors: int) -> dict[str, float]:
    """Seconds of each stage and of the whole, and the whole against real time."""
    capture = scene.with_trunk(scene.capture(minutes), sensors)
    spent = dict.fromkeys(STAGES, 0.0)
    patches = [patch(place, _timed(stage, place, spent)) for stage, place in STAGES.items()]
    for each in patches:
        each.start()
    start = time.perf_counter()
    seen = observe(capture)
    whole = time.perf_counter() - start
    for each in patches:
        each.stop()
    return {
        "minutes": minutes,
        "facts": len(seen.facts),
        "segments": sum(len(link.segments) for link in seen.links),
        "observe": whole,
        **spent,
        "observe, times real time": 60.0 * minutes / whole,
        "contact, times real time": 60.0 * minutes / spent["  contact"],
        "facts to text and back, share": (spent["  facts to text"] + spent["  answers back"])
        / whole,
        "peak memory [GB]": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20,
    }


def _timed(stage: str, place: str, spent: dict[str, float]) -> Callable[..., Any]:
    """The function of that name, which adds the time that it takes to a stage's."""
    module, _, name = place.rpartition(".")
    function = getattr(__import__(module, fromlist=[name]), name)

    def timed(*arguments: Any, **options: Any) -> Any:
        start = time.perf_counter()
        try:
            return function(*arguments, **options)
        finally:
            spent[stage] += time.perf_counter() - start

    return timed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, nargs="+", default=[1.0, 10.0, 60.0])
    parser.add_argument("--sensors", type=int, default=5, metavar="N", help="5 or more")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    rows = [measure(minutes, options.sensors) for minutes in options.minutes]
    if options.json:
        print(json.dumps(rows, indent=2))
        return
    for name in rows[0]:
        print(f"{name:32}" + "".join(f"{row[name]:14,.4g}" for row in rows))


if __name__ == "__main__":
    main()
