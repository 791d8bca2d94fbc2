"""Explain random segments of a battery, and ask whether that is all true and all that decided.

Every sentence is computed again from exact captures. Then each fact about the segment is taken
away, and the segment is named again (``scenes.deciding``): the explanation must rest on whatever
gives it another name.

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
from capar.pipelines.explanation import Explained, measured_of
from capar.pipelines.observation import observe_measured
from capar_rules.engine.profiles import Profile, profile
from capar_rules.explain.explanation import Explainer
from extractors.measure import measure
from scenes.deciding import Asked, Loss, Removal, asked, removals
from scenes.hands.scene import Scene


@dataclass(frozen=True)
class Checked:
    """A segment's explanation: its sentences, and those that are not so."""

    segment: Segment
    sentences: tuple[str, ...]
    wrong: tuple[str, ...]
    """Sentences that are false by recomputation, or that nothing recomputes."""

    asked: Asked
    """What it was named by."""


def checked(scene: Scene, chance: random.Random, rules: Profile, *, name: str = "") -> Checked:
    """Observe a scene, explain one of its segments, and compute each sentence again.

    Args:
        scene: The scene, which is recorded without noise.
        chance: What draws the segment.
        rules: By which it is named.
        name: What the segment is called; any if empty.
    """
    capture, expectation = scene(100.0, 0.0, 0.0, 0)
    measurements = measure(capture)
    observation = observe_measured(capture, measurements, rules=rules)
    measured = measured_of(observation, measurements)
    explainer = Explainer(observation.facts, profile=rules, measured=measured)
    steps = {unit.ee: [step.name for step in unit.steps] for unit in expectation.units}
    segment = chance.choice([each for each in observation.segments if name in ("", each.name)])
    seen = Explained(observation, explainer, measurements)
    known = Known(seen, measurements.facts, segment, capture, steps)
    reason = explainer.explain(segment).reason.with_sentences()
    sentences = tuple(dict.fromkeys(each.sentence for each in reason.walk()))
    wrong = tuple(_wrong(known, sentences))
    return Checked(segment, sentences, wrong, asked(explainer, segment, rules))


def drawn(battery: str, count: int, seed: int, rules: Profile) -> Iterator[tuple[str, Checked]]:
    """Random segments of a battery, of one scene each, with the scene's name."""
    scenes = importlib.import_module(f"scenes.{battery}").SCENES
    chance = random.Random(seed)
    for name in chance.sample(sorted(scenes), count):
        yield name, checked(scenes[name], chance, rules)


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


def lines(name: str, found: Checked, lost: list[Removal]) -> Iterator[str]:
    """What is printed of a segment: counts, and below them each fault."""
    segment, cited = found.segment, [each for each in lost if each.cited]
    decided = sum(each.loss in (Loss.NAME, Loss.OBJECTS, Loss.BORDER) for each in cited)
    yield (
        f"{name} {segment.ee}/{segment.index} {segment.name}: {len(found.sentences)} sentences, "
        f"{len(found.wrong)} wrong; {len(cited)} facts told, {decided} of them change the segment; "
        f"{len(lost) - len(cited)} not told"
    )
    yield from (f"    false: {each}" for each in found.wrong)
    yield from (f"    told, and changes nothing: {each.fact}" for each in lost if each.idle)
    yield from (
        f"    decides the name, and is not told: {each.fact}" for each in lost if each.untold
    )
    for each in lost:
        if not each.cited and each.loss in (Loss.OBJECTS, Loss.BORDER):
            yield f"    decides the {each.loss.value}, and is not told: {each.fact}"


def main(arguments: list[str] | None = None) -> int:
    """Explain random segments and print what is wrong with them."""
    parser = argparse.ArgumentParser(prog="scenes.explanations", description=__doc__)
    parser.add_argument("battery", help="hands, objects, household")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    rules = profile("extended")
    found = list(drawn(options.battery, options.count, options.seed, rules))
    lost = removals([each.asked for _, each in found], rules)
    for (name, each), removed in zip(found, lost, strict=True):
        sys.stdout.writelines(f"{line}\n" for line in lines(name, each, removed))
    told = sum(len(each.sentences) for _, each in found)
    wrong = sum(len(each.wrong) for _, each in found)
    every = [each for removed in lost for each in removed]
    untold, idle = sum(each.untold for each in every), sum(each.idle for each in every)
    sys.stdout.write(
        f"{told} sentences, {wrong} wrong; {len(every)} facts taken away: {untold} decide a name "
        f"and are not told, {idle} are told and change nothing\n"
    )
    return int(wrong + untold + idle > 0)


if __name__ == "__main__":
    sys.exit(main())
