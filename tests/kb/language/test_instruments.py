"""A description tells what goes along with what bears it, and what is done with an instrument."""

import pytest
from scenes.hands import SCENES

from capar.pipelines.observation import observe
from kb.language.describe import describe

TOLD = {
    "carry_a_carton_with_a_ball": (
        "lifted the carton with the ball using both hands",
        "put it back on the table",
    ),
    "push_with_a_stick": (
        "brought the stick to the box with the right hand",
        "pushed the box with it",
    ),
    "hit_a_block_away": ("struck the block with the right hand",),
}


@pytest.mark.parametrize("name", TOLD)
def test_loads_and_targets_are_told(name: str) -> None:
    capture, _ = SCENES[name](100.0, 0.0005, 0.00175, 0)
    text = str(describe(observe(capture)))
    for clause in TOLD[name]:
        assert clause in text
