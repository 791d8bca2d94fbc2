"""Explain random segments of a battery, and compute every sentence again from exact captures.

Run by hand: ``cd tests && python -m scenes.explanations BATTERY [--count 20] [--seed 0]``.
"""

import argparse
import importlib
import random
import sys
from collections.abc import Iterator
from dataclasses import dataclass

from recomputed import Known, form

from capar.model.observation import Segment
from capar.pipelines.explanation import Explained, distances
from capar.pipelines.observation import observe_measured
from capar_rules.engine.profiles import profile
from capar_rules.explain.explanation import Explainer
from extractors.measure import measure
from scenes.hands.scene import Scene


@dataclass(frozen=True)
class Checked:
    """A segment's explanation: its sentences, and those that are not so."""

    segment: Segment
    sentences: tuple[str, ...]
    wrong: tuple[str, ...]
    """Sentences that are false by recomputation, or that nothing recomputes."""


def checked(scene: Scene, chance: random.Random) -> Checked:
    """Observe a scene, explain one of its segments, and compute each sentence again."""
    capture, expectation = scene(100.0, 0.0, 0.0, 0)
    measurements = measure(capture)
    rules = profile("extended")
    observation = observe_measured(capture, measurements, rules=rules)
    explainer = Explainer(
        observation.facts, profile=rules, distance_m=distances(capture, measurements)
    )
    steps = {unit.ee: [step.name for step in unit.steps] for unit in expectation.units}
    segment = chance.choice(observation.segments)
    seen = Explained(observation, explainer)
    known = Known(seen, measurements.facts, segment, capture, steps)
    reason = explainer.explain(segment).reason.with_sentences()
    sentences = tuple(dict.fromkeys(each.sentence for each in reason.walk()))
    return Checked(segment, sentences, tuple(_wrong(known, sentences)))


def _wrong(known: Known, sentences: tuple[str, ...]) -> Iterator[str]:
    for sentence in sentences:
        try:
            _, check, arguments = form(sentence)
            right = check(known, *arguments)
        except (AssertionError, KeyError, ValueError, StopIteration) as reason:
            yield f"{sentence} ({type(reason).__name__}: {str(reason)[:80]})"
        else:
            if not right:
                yield sentence


def main(arguments: list[str] | None = None) -> int:
    """Explain random segments and print what is wrong with them."""
    parser = argparse.ArgumentParser(prog="scenes.explanations", description=__doc__)
    parser.add_argument("battery", help="hands, objects, household")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args(arguments)
    scenes = importlib.import_module(f"scenes.{asked.battery}").SCENES
    chance = random.Random(asked.seed)
    told = wrong = 0
    for name in chance.sample(sorted(scenes), asked.count):
        found = checked(scenes[name], chance)
        told, wrong = told + len(found.sentences), wrong + len(found.wrong)
        segment = found.segment
        sys.stdout.write(
            f"{name} {segment.ee}/{segment.index} {segment.name}: {len(found.sentences)}"
            f" sentences, {len(found.wrong)} wrong\n"
        )
        sys.stdout.writelines(f"    {each}\n" for each in found.wrong)
    sys.stdout.write(f"{told} sentences, {wrong} wrong\n")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
