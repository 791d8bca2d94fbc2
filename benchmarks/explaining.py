"""Time to explain a segment against the length of a capture, in milliseconds.

Run by hand: ``python benchmarks/explaining.py [--json]``. The facts of the shipped capture are told
again and again, one trial after the other; each segment of the
last trial is explained, so that what came before it could matter.
"""

import argparse
import json
from collections.abc import Callable
from dataclasses import replace
from importlib import resources
from statistics import median
from time import perf_counter

from capar.model.facts import Fact, Frames
from capar_rules.engine.profiles import profile
from capar_rules.explain.explanation import Explainer
from capar_rules.pars.inference import infer
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import read_capture

COPIES = (1, 10, 100)
TIMED = ("first", "last", "frame")


def repeated(facts: tuple[Fact, ...], copies: int) -> tuple[Fact, ...]:
    """The same trial so many times, one after the other."""
    length = next(each.last for each in facts if isinstance(each, Frames)) + 1
    out: set[Fact] = {Frames(0, copies * length - 1)}
    for fact in facts:
        keys = [key for key in TIMED if hasattr(fact, key)]
        if not isinstance(fact, Frames):
            out |= {
                replace(fact, **{key: getattr(fact, key) + copy * length for key in keys})
                for copy in (range(copies) if keys else (0,))
            }
    return tuple(sorted(out, key=lambda each: (type(each).predicate, each)))


def timed(facts: tuple[Fact, ...], copies: int) -> dict[str, float]:
    """Milliseconds for each segment of the last copy."""
    told = repeated(facts, copies)
    rules = profile()
    explainer = Explainer(told, profile=rules)
    segments = infer(told, profile=rules).links[0].segments
    last = segments[-len(segments) // copies :]
    explainer.explain_all(last)
    alone = [_milliseconds(lambda one=segment: explainer.explain(one)) for segment in last]
    return {
        "trials": copies,
        "segments": len(segments),
        "median_ms": median(alone),
        "slowest_ms": max(alone),
        "together_ms": _milliseconds(lambda: explainer.explain_all(last)) / len(last),
    }


def _milliseconds(work: Callable[[], object]) -> float:
    start = perf_counter()
    work()
    return 1000.0 * (perf_counter() - start)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    with resources.as_file(resources.files("capar") / "demo" / "drink_from_mug") as bundle:
        facts = measure(read_capture(bundle)).facts
    rows = [timed(facts, copies) for copies in COPIES]
    if options.json:
        print(json.dumps(rows, indent=2))
        return
    for row in rows:
        print("  ".join(f"{name} {value:,.4g}" for name, value in row.items()))


if __name__ == "__main__":
    main()
