"""The worlds of a segment: with nothing changed each holds its name, in every trial."""

from collections.abc import Callable

import motions
import pytest

from capar.pipelines.explanation import explained
from capar_rules.engine.profiles import profile
from capar_rules.explain.why_not import worlds_around

TRIALS = (
    motions.drink_from_mug,
    motions.slide_object,
    motions.pick_up_with_both_hands,
    motions.stand_on_one_leg,
)


@pytest.mark.parametrize("trial", TRIALS, ids=lambda each: each.__name__)
@pytest.mark.parametrize("rules", ["extended", "thesis"])
def test_with_nothing_otherwise_each_segment_is_called_what_it_is(
    trial: Callable[..., motions.Trial], rules: str
):
    seen = explained(trial(motions.TALL_MAN).capture, rules=profile(rules))
    assert seen.observation.segments
    for each in seen.observation.segments:
        assert worlds_around(seen.explainer, each), (each.ee, each.index, each.name)
