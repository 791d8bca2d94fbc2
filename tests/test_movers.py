"""Whatever moves has a mover, in motions of known truth and in recordings that others made."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import motions
import pytest
from combinations import EVERY
from motion_files import recordings_folder

from capar.model.capture import Capture
from capar.model.facts import Displaced, MovedBy
from capar.pipelines.observation import observe
from capar_rules.borders.deflicker import steady
from capar_rules.movers.movers import movers
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import read_capture

EXAMPLES = Path(__file__).parents[1] / "examples"
FLOOR = 0.05
"""Largest share of an object's motion without a mover [1] (spec 10)."""

MADE: dict[str, Callable[[], Capture]] = {
    "drinking": lambda: motions.drink_from_mug(motions.WOMAN).capture,
    "sliding": lambda: motions.slide_object(motions.TALL_MAN).capture,
    "rolling": lambda: motions.roll_object(motions.WOMAN).capture,
    "with both hands": lambda: motions.pick_up_with_both_hands(motions.WOMAN).capture,
    "handing over": lambda: motions.hand_over().capture,
}
RECORDED = (
    *(f"bimacs_optitrack:take{take}" for take in range(0, 10, 1 if EVERY else 3)),
    "omomo_intermimic:sub2_woodchair_003",
    "omomo_intermimic:sub2_woodchair_004",
    "omomo_intermimic:sub2_largetable_000",
    "manipnet:cube_med2",
)
"""Every third take of the cook; `CAPAR_SCENES=all` takes each."""


def told(capture: Capture) -> tuple[Counter[str], tuple[MovedBy, ...]]:
    """Frames of motion by object, and what moves it."""
    facts = steady(measure(capture).facts)
    frames: Counter[str] = Counter()
    for each in facts:
        if isinstance(each, Displaced):
            frames[each.object] += each.last - each.first + 1
    return frames, movers(facts)


def unmoved(found: Sequence[MovedBy], thing: str) -> int:
    parts = [each for each in found if each.object == thing and each.how == "unknown"]
    return sum(each.last - each.first + 1 for each in parts)


@pytest.mark.parametrize("name", MADE)
def test_every_motion_of_a_motion_of_known_truth_has_a_mover(name: str) -> None:
    frames, found = told(MADE[name]())
    assert frames
    for thing, count in frames.items():
        assert unmoved(found, thing) <= FLOOR * count, (thing, found)


@pytest.mark.parametrize("place", RECORDED)
def test_every_motion_of_a_recording_has_a_mover(
    place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    frames, found = told(read_capture(f"{EXAMPLES}/{place}"))
    assert frames
    for thing, count in frames.items():
        assert unmoved(found, thing) <= FLOOR * count, (thing, found)


def without(capture: Capture, hand: str) -> Capture:
    kept = tuple(each for each in capture.sensors if each.name != hand)
    return replace(capture, sensors=kept)


def assert_nobody_else_moves(whole: Capture, hand: str, thing: str) -> None:
    frames, before = told(whole)
    caused = sum(
        each.last - each.first + 1 for each in before if (each.object, each.mover) == (thing, hand)
    )
    assert caused >= 0.9 * frames[thing]
    _, after = told(without(whole, hand))
    assert unmoved(after, thing) >= 0.9 * caused
    assert {each.how for each in after if each.object == thing} == {"unknown"}


def test_without_the_hand_that_drinks_nobody_moves_the_mug() -> None:
    capture = MADE["drinking"]()
    other = replace(capture.sensor("right_hand"), name="left_hand", side="left", link="left_arm")
    still = replace(other.stream, positions=other.stream.positions * 0.0 + 1.5)
    both = replace(capture, sensors=(*capture.sensors, replace(other, stream=still)))
    assert_nobody_else_moves(both, "right_hand", "mug")


@pytest.mark.parametrize(("hand", "thing"), [("right_hand", "whisk"), ("left_hand", "bottle")])
def test_with_one_hand_removed_from_a_recording_its_thing_is_moved_by_nobody(
    hand: str, thing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    capture = read_capture(f"{EXAMPLES}/bimacs_optitrack:take0")
    assert_nobody_else_moves(capture, hand, thing)
    (told_of,) = [
        each
        for each in observe(without(capture, hand)).notices
        if each.code == "no-mover" and each.bodies == (thing,)
    ]
    assert float(told_of["share"]) >= 0.9
