"""How often steps bring into reach what is out of reach from the given place.

Drawn scenes in which the performer has to stand at a place, the recorded one or farther away; what
is refused there is tried again with steps, and observed again.

    PYTHONPATH=.:tests python benchmarks/steps_into_reach.py touch carry --away -0.6 0.3 \
        --scenes 1 2 3 --results FILE
"""

import argparse
import json
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

from capar.body.human import Human
from capar.body.scripted_actions import action_capture
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import body, numbered_scene, observed_source
from capar.regeneration import PlanError, regenerate
from capar.regeneration.captures import capture_of, capture_of_steps
from capar.regeneration.planning import beside, why_unreachable
from capar.regeneration.scenes import DRAWS, Scene
from capar.regeneration.sources import Source
from capar.regeneration.stepping import approached
from capar.regeneration.styles import own_style

SEED = 7
AGENTS = ("man", "woman", "child")
STEPS = {"Stand", "Step", "Walk"}
"""What feet may be seen to do."""


def main() -> None:
    """Try all trips that are asked for, and print how many came out well."""
    asked = _asked()
    counts: Counter[str] = Counter()
    for action in asked.actions:
        source = observed_source(action_capture(action, rate_hz=30.0))
        for number in asked.scenes:
            scene = numbered_scene(source, number, SEED, DRAWS[asked.draw])
            scene = replace(beside(scene, *asked.away), stays=True)
            for agent in AGENTS:
                row = _trip(source, body(agent, source), scene)
                row |= {"action": action, "scene": number, "agent": agent}
                with asked.results.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
                counts.update(["asked", *(key for key in row if row[key] is True)])
                print(action, number, agent, row, flush=True)
    print(dict(counts))


def _trip(source: Source, human: Human, scene: Scene) -> dict[str, Any]:
    try:
        why = why_unreachable(source, scene, human, own_style(source))
        if why is None:
            return {"reached": True}
        found, motion, quality = approached(
            source, human, scene, own_style(source), lambda there: regenerate(source, human, there)
        )
    except PlanError as error:
        return {"refused": True, "why": str(error)}
    assert found is not None
    again = observe(capture_of(motion, name=source.capture.name, agent="performer"))
    steps = observe(capture_of_steps(found.steps, name="steps", agent="performer"))
    feet = {segment.name for segment in steps.segments if segment.ee.endswith("_foot")}
    return {
        "why": why,
        "stepped": True,
        "every_gate": quality.passed and found.quality.passed,
        "same_par": again.complex_par.signature == source.observation.complex_par.signature,
        "seen_as_steps": feet <= STEPS and len(feet) > 1,
        "strides": len(found.steps.strides),
        "ahead_m": found.ahead_m,
        "left_m": found.aside_m,
        "tried": len(found.tried),
    }


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("actions", nargs="+")
    parser.add_argument("--away", nargs=2, type=float, default=(0.0, 0.0))
    parser.add_argument("--scenes", nargs="+", type=int, default=list(range(1, 11)))
    parser.add_argument("--draw", choices=sorted(DRAWS), default="usual")
    parser.add_argument("--results", type=Path, required=True)
    return parser.parse_args()


if __name__ == "__main__":
    main()
