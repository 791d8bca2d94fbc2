"""Time to explain a segment against the length of a capture, in milliseconds.

``python benchmarks/explaining.py [--trials 1 10 100] [--json]``: the facts of the shipped capture
are told again and again, one trial after the other; each segment of the last trial is explained, so
that what came before it could matter. Processor time.
"""

import argparse
import json
from collections.abc import Callable
from dataclasses import replace
from importlib import resources
from statistics import median
from time import process_time

from capar.model.facts import Fact, Frames
from capar_rules.engine.profiles import profile
from capar_rules.explain.explanation import Explainer
from capar_rules.pars.inference import infer
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import read_capture

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
    start = process_time()
    work()
    return 1000.0 * (process_time() - start)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, nargs="+", default=[1, 10, 100])
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    with resources.as_file(resources.files("capar") / "demo" / "drink_from_mug") as bundle:
        facts = measure(read_capture(bundle)).facts
    rows = [timed(facts, copies) for copies in options.trials]
    if options.json:
        print(json.dumps(rows, indent=2))
        return
    for row in rows:
        row["median_of_first"] = row["median_ms"] / rows[0]["median_ms"]
    for name in rows[0]:
        print(f"{name:20}" + "".join(f"{row[name]:12,.4g}" for row in rows))


if __name__ == "__main__":
    main()
