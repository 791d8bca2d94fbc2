"""Names of cooking takes as another rig would have recorded them: the pivot of each body elsewhere.

``python benchmarks/moved_pivots.py [--draws 1] [--centimetres 3] [--json]``; the docs' figures are
of five draws. In each draw the pivot of every recorded body is moved by a random offset of one
length that is fixed to the body, and all ten takes are observed and scored as ``capar evaluate``
does (examples/bimacs_optitrack/evaluation.toml); the recorded pivots stand beside them as draw 0.
Without the recordings nothing is done.
"""

import argparse
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import scene
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.evaluation.metrics import report
from capar.evaluation.plan import Plan, read_plan
from capar.evaluation.scoring import Case, compare
from capar.model.capture import Capture, Stream
from capar.pipelines.observation import observe
from extractors.readers.bundle.capture_toml import read_capture

PLAN = Path(__file__).parents[1] / "examples" / "bimacs_optitrack" / "evaluation.toml"
SCORES = ("macro_f1", "f1@10")


def moved(stream: Stream, offset: Float[np.ndarray, "3"]) -> Stream:
    """The same body, tracked at a point that lies elsewhere on it [m, in the body's frame]."""
    positions = stream.positions.copy()
    known = ~stream.lost
    turns = Rotation.from_quat(stream.orientations[known], scalar_first=True)
    positions[known] += turns.apply(offset)
    return replace(stream, positions=positions)


def moved_pivots(capture: Capture, rng: np.random.Generator, length_m: float) -> Capture:
    """The capture with the pivot of every body that a file tracks moved by so much [m]."""

    def elsewhere(body: Any) -> Any:
        way = rng.normal(size=3)
        if np.nanmax(np.ptp(body.stream.positions[~body.stream.lost], axis=0)) == 0.0:
            return body  # assumed furniture, which no rig tracks
        return replace(body, stream=moved(body.stream, length_m * way / np.linalg.norm(way)))

    return replace(
        capture,
        sensors=tuple(map(elsewhere, capture.sensors)),
        objects=tuple(map(elsewhere, capture.objects)),
    )


def scores(plan: Plan, draw: int, length_m: float) -> dict[str, dict[str, float]]:
    """Scores of each group and hand, of one draw of offsets."""
    assert plan.mapping is not None
    rng = np.random.default_rng(draw)
    cases = []
    for pair in plan.pairs:
        capture = read_capture(pair.capture)
        if draw:
            capture = moved_pivots(capture, rng, length_m)
        labels = plan.labels_of(pair)
        cases.append(Case(observe(capture), labels, capture.times, pair.name))
    groups = report(compare(cases, plan.mapping, groups=plan.groups))["groups"]
    return {
        f"{group}: {hand}": {name: found[name] for name in SCORES}
        for group, parts in groups.items()
        for hand, found in (*parts["links"].items(), ("both", parts["all"]))
    }


def lines(found: list[dict[str, dict[str, float]]]) -> Iterator[str]:
    """A line for each group and hand: recorded, and each draw."""
    for key in found[0]:
        values = "  ".join("/".join(f"{draw[key][name]:.1f}" for name in SCORES) for draw in found)
        yield f"{key:45} {values}"


def main() -> None:
    """Print macro F1 and F1@10 of each draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=1)
    parser.add_argument("--centimetres", type=float, default=3.0)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if not scene.recordings():
        return
    plan = read_plan(PLAN)
    draws = range(options.draws + 1)
    found = [scores(plan, draw, options.centimetres / 100.0) for draw in draws]
    print(json.dumps(found, indent=2) if options.json else "\n".join(lines(found)))


if __name__ == "__main__":
    main()
