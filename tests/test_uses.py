"""What people do with hands and feet is named from the motion alone, whoever does it."""

from collections.abc import Callable
from dataclasses import replace

import motions
import pytest
from combinations import EVERY, meeting
from motions.encounters import ENCOUNTERS, kick
from motions.uses import USES

from capar.pipelines.observation import observe

pytestmark = pytest.mark.long

Act = Callable[..., motions.Trial]


RECORDED = {
    "exactly": {},
    "at 60 Hz with noise": {"rate_hz": 60.0, "noise_m": 0.001, "noise_rad": 0.005, "seed": 1},
}


@pytest.mark.parametrize(
    ("act", "performer", "options"), meeting((*USES, *ENCOUNTERS), motions.PERFORMERS, RECORDED)
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


@pytest.mark.parametrize(
    "performer", motions.PERFORMERS if EVERY else motions.PERFORMERS[:1], ids=lambda each: each.name
)
def test_a_kick_as_short_as_real_ones_is_seen_whatever_the_least_duration_of_contacts(
    performer: motions.Performer,
) -> None:
    """A boot is at a ball for 10 to 20 ms; a contact below 50 ms counts if the thing sets off."""
    trial = kick(performer, pushes_s=0.015)
    for minimum_s in (None, 0.0):
        capture = replace(trial.capture, contact_minimum_s=minimum_s)
        (link,) = observe(capture).links
        assert link.segments[0].name == "Kick"
