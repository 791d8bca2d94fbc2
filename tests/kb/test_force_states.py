"""What sets a thing going, and what slows it, is kept in the state of the thing (Fig 4.13)."""

from dataclasses import replace

from observations import drink_from_mug

from capar.model.json_form import from_json, to_json
from capar.model.observation import ForceStyle
from kb.actionary import Actionary
from kb.checks import check

FORCE = ForceStyle(
    object="mug",
    ee="right_hand",
    start_s=1.6,
    end_s=2.5,
    struck=True,
    position_m=(0.4, 0.0, 0.8),
    velocity_mps=(0.0, 1.2, 0.0),
    striker_mps=(0.0, 1.25, 0.0),
    follow_mps=(0.0, 0.575, 0.0),
    restitution=0.5,
    damping_per_s=(3.0, 2.5),
    thesis_damping=(0.1, 0.25),
    bounce=None,
    impulse_ns=None,
    residual_m=0.001,
)


def test_damping_and_restitution_are_shown_with_the_kind_of_thing(actionary: Actionary) -> None:
    actionary.add(replace(drink_from_mug(), profile="extended", forces=(FORCE,)))
    shown = actionary.object_profile("mug")
    assert shown["state: damping"] == ("3.0 2.5 0.0",)
    assert shown["state: restitution"] == ("0.5",)
    assert check(actionary.store, full=True) == ()


def test_the_thesis_profile_keeps_the_thesis_damping(actionary: Actionary) -> None:
    actionary.add(replace(drink_from_mug(), profile="thesis", forces=(FORCE,)))
    assert actionary.object_profile("mug")["state: damping"] == ("0.1 0.25 0.0",)


def test_what_was_let_go_keeps_how_it_bounces(actionary: Actionary) -> None:
    tossed = replace(FORCE, struck=False, restitution=None, bounce=0.3, damping_per_s=None)
    actionary.add(replace(drink_from_mug(), profile="extended", forces=(tossed,)))
    shown = actionary.object_profile("mug")
    assert shown["state: restitution"] == ("0.3",)
    assert shown["state: damping"] == ()


def test_forces_come_back_from_json() -> None:
    seen = replace(drink_from_mug(), profile="extended", forces=(FORCE,))
    assert from_json(to_json(seen)) == seen
