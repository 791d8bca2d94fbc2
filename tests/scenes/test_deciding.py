"""An explanation leaves out nothing that decided, and rests on nothing that did not."""

import random

import pytest

from capar.model.facts import Fact, Frames, Link, RateMhz, Touching
from capar.pipelines.explanation import explained
from capar_rules.engine.profiles import profile
from scenes.deciding import Asked, Loss, Removal, asked, removals
from scenes.hands import SCENES as HANDS
from scenes.objects import SCENES as OBJECTS

pytestmark = pytest.mark.long

RULES = profile("extended")
SOME = {
    "return": (OBJECTS, "drawer_half_shut_and_shut", "ResumePosture"),
    "hold": (HANDS, "touch_and_return", "Touch"),
    "transit": (OBJECTS, "can_out_of_a_chest", "Lower"),
}


@pytest.fixture(scope="module")
def found() -> dict[str, tuple[Asked, list[Removal]]]:
    """For each of some segments, what it was named by, and what the loss of each fact changes."""
    wanted = []
    for scenes, scene, name in SOME.values():
        seen = explained(scenes[scene](100.0, 0.0, 0.0, 0)[0], rules=RULES)
        named = [each for each in seen.observation.segments if each.name == name]
        wanted.append(asked(seen.explainer, random.Random(0).choice(named), RULES))
    return dict(zip(SOME, zip(wanted, removals(wanted, RULES), strict=True), strict=True))


@pytest.mark.parametrize("which", SOME)
def test_what_gives_a_segment_another_name_is_told(
    which: str, found: dict[str, tuple[Asked, list[Removal]]]
) -> None:
    _, lost = found[which]
    assert not [str(each.fact) for each in lost if each.untold]
    assert not [str(each.fact) for each in lost if each.idle]


@pytest.mark.parametrize("which", SOME)
def test_facts_decide_and_are_told_and_others_decide_nothing(
    which: str, found: dict[str, tuple[Asked, list[Removal]]]
) -> None:
    """Neither side of the comparison is empty, or it would hold of anything."""
    _, lost = found[which]
    assert any(each.cited and each.loss is not Loss.NOTHING for each in lost)
    assert any(not each.cited and each.loss is Loss.NOTHING for each in lost)


@pytest.mark.parametrize("which", SOME)
def test_a_told_fact_that_is_kept_secret_is_found(
    which: str, found: dict[str, tuple[Asked, list[Removal]]]
) -> None:
    _, lost = found[which]
    secret = [Removal(each.fact, False, each.loss) for each in lost if each.cited]
    assert any(each.untold for each in secret)


@pytest.mark.parametrize("which", SOME)
def test_no_fact_of_the_whole_recording_is_taken_away(
    which: str, found: dict[str, tuple[Asked, list[Removal]]]
) -> None:
    one, lost = found[which]
    kinds: set[type[Fact]] = {type(each.fact) for each in lost}
    assert Touching in kinds
    assert not kinds & {Frames, RateMhz, Link}
    assert {type(each) for each in one.facts} >= {Frames, RateMhz, Link}
