"""Doors, lids and drawers are opened and closed; what merely moves in a line is not."""

from collections.abc import Callable

import motions
import pytest
from combinations import meeting
from motions.doors import DOORS, open_and_close_door, open_and_close_drawer

from capar.pipelines.observation import observe
from kb.encode.observation import encode
from kb.language.describe import describe
from kb.store.validation import violations
from ontology import CAPAR

Act = Callable[..., motions.Trial]

RECORDED = {
    "exactly": {},
    "at 60 Hz with noise": {"rate_hz": 60.0, "noise_m": 0.001, "noise_rad": 0.005, "seed": 1},
    "at 240 Hz with noise": {"rate_hz": 240.0, "noise_m": 0.0005, "noise_rad": 0.002, "seed": 2},
}


@pytest.mark.parametrize(
    ("act", "performer", "options"), meeting(DOORS, motions.PERFORMERS, RECORDED)
)
def test_the_steps_are_those_that_were_performed(
    act: Act, performer: motions.Performer, options: dict[str, float]
) -> None:
    trial = act(performer, **options)
    found = {
        each.ee: tuple(one.name for one in each.segments if one.name != "Rest")
        for each in observe(trial.capture).links
    }
    assert found == trial.truth.steps["extended"]


def test_a_description_says_what_was_opened_and_closed() -> None:
    seen = observe(open_and_close_drawer(motions.TALL_MAN).capture)
    assert "opened it, held it there, closed it" in describe(seen)


def test_the_actionary_keeps_the_hinge_with_its_range_and_residual() -> None:
    out = encode(observe(open_and_close_door(motions.TALL_MAN).capture))
    assert not violations(out.things)
    text = "\n".join(map(str, out.quads))
    for term in (CAPAR.Guide, CAPAR.guideKind, CAPAR.opened, CAPAR.residual):
        assert str(term) in text
