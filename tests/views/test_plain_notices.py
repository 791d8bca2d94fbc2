"""Notes under a text are sentences that its reader can understand, and check."""

from dataclasses import replace

import pytest
from motions import TALL_MAN, drink_from_mug

from capar.model.notices import Notice, notice
from capar.pipelines.observation import observe
from capar.views.notices import (
    BY_DISTANCE,
    PLAIN,
    reservation_lines,
    reservations_on_told,
)


def rough(*names: str) -> list[Notice]:
    return [notice("stand-in-shape", name, shape="a ball") for name in names]


def lost(name: str, times: int = 1, **values: float | bool) -> Notice:
    return notice("long-gap", name, start_s=2.0, end_s=4.5, times=times, **values)


def judged(code: str, *pairs: tuple[str, str]) -> list[Notice]:
    values = {"touch_m": 0.1, "found": "rest", "frames": 9, "distance_m": 0.1}
    return [notice(code, *pair, **values) for pair in pairs]


TOLD: tuple[tuple[list[Notice], str], ...] = (
    (
        rough("right_hand", "left_hand"),
        "The recording has no surfaces of the hands; rough ones are assumed.",
    ),
    (
        rough("pelvis", "l_hip", "r_hip", "l_knee", "r_knee"),
        "The recording has no surface of the body; a rough one is assumed.",
    ),
    (
        rough("pelvis", "l_hip", "r_hip", "l_knee", "r_thumb1"),
        "The recording has no surface of the body, including the hands; a rough one is assumed.",
    ),
    (
        [lost("bowl", fixed=False, moved_m=0.004)],
        "The bowl was not tracked from 2.00 to 4.50 s; it is assumed to have stayed where it was.",
    ),
    (
        [lost("table", fixed=True)],
        "The table was not tracked from 2.00 to 4.50 s; it is assumed to have stayed where it was.",
    ),
    (
        [lost("bottle", fixed=False, moved_m=0.3)],
        "The bottle was not tracked from 2.00 to 4.50 s; what touched it before and after is "
        "assumed to have touched it meanwhile.",
    ),
    (
        [lost("right_hand", 7, fixed=False, lost_s=31.2, of_s=60.0)],
        "The right hand was not tracked for 31 of 60 s; what it did then is not known.",
    ),
    (
        [notice("long-gap", "box", times=1, fixed=False)],
        "The box was not tracked at all; what it touched is not known.",
    ),
    (
        [notice("assumed-support", each, assumed="a box") for each in ("table", "carton")],
        "The table and the carton are assumed: neither is in the recording.",
    ),
    (
        [notice("assumed-support", "floor", assumed="a plate")],
        "The floor is assumed: it is not in the recording.",
    ),
    (
        judged("pivot-distance", ("right_hand", "mug"), ("right_hand", "cup")),
        "Contacts of the right hand are inferred from distance: the recording has no shape of the "
        "hand.",
    ),
    (
        judged("touch-estimated", ("right_hand", "mug"), ("cup", "table")),
        "Some contacts are inferred from distance: the recording lacks shapes of some bodies.",
    ),
    (
        [notice("objects-left-out", "100 half egg carton(Clone)-18146", objects=9)],
        "The half egg carton is left out, and what was done with it is not told: its shape is not "
        "known.",
    ),
    (
        [notice("mount-gap", "r_middle1", "chair", touch_m=0.02, shown_m=0.04, frames=9)],
        "The right hand is assumed to have held the chair, though that hand's middle finger was "
        "measured 4 cm from it.",
    ),
    (
        [notice("no-mover", "chair", start_s=1.0, end_s=2.0, share=0.3, times=1, why="nobody")],
        "From 1.00 to 2.00 s, no contact was found that could have moved the chair.",
    ),
    (
        [
            notice(
                "contact-gap", "chair", "r_wrist", start_s=start_s, end_s=end_s, called="right hand"
            )
            for start_s, end_s in ((1.0, 2.0), (2.5, 4.0))
        ],
        "From 1.00 to 2.00 s and from 2.50 to 4.00 s, no contact with the chair was found, "
        "although it moved; the right hand is assumed to have held it.",
    ),
    (
        [
            notice("bone-stretches", "head", "neck", "jaw", shortest_m=0.1, longest_m=long_m)
            for long_m in (0.15, 0.32)
        ],
        "Joints of the skeleton come apart by up to 22 cm, which bones do not.",
    ),
)


@pytest.mark.parametrize(("group", "text"), TOLD, ids=[text[:40] for _, text in TOLD])
def test_each_kind_has_its_sentence(group: list[Notice], text: str) -> None:
    assert reservation_lines(group)[2:] == (f"note: {text}",)


def test_every_kind_is_told_here() -> None:
    assert {group[0].code for group, _ in TOLD} == {*PLAIN, *BY_DISTANCE}


def test_other_kinds_have_their_own_words_as_a_sentence() -> None:
    (line,) = reservation_lines([notice("no-shape", "mug")])[2:]
    assert line == "note: 'mug' has no shape, so no contact of it is known."


@pytest.mark.parametrize(
    ("unshaped", "text"),
    [
        (
            {"right_hand"},
            "Contacts of the right hand are inferred from distance: the recording has no shape of "
            "the hand.",
        ),
        (
            {"right_hand", "cup", "head"},
            "Contacts of the right hand and the cup are inferred from distance: the recording has "
            "no shape of either.",
        ),
        (
            set(),
            "Some contacts are inferred from distance: the recording lacks shapes of some bodies.",
        ),
    ],
)
def test_only_what_has_no_shape_is_said_to_have_none(unshaped: set[str], text: str) -> None:
    group = judged("pivot-distance", ("right_hand", "mug"), ("right_hand", "cup"))
    assert reservation_lines(group, unshaped=unshaped)[2:] == (f"note: {text}",)
    alone = judged("pivot-distance", ("right_hand", "mug"))
    (line,) = reservation_lines(alone, unshaped={"right_hand"})[2:]
    assert "Contacts of the right hand are inferred" in line


def test_a_note_calls_a_thing_as_the_text_does() -> None:
    (line,) = reservation_lines([lost("chair", fixed=True)], called={"chair": "wooden_chair"})[2:]
    assert line.startswith("note: The wooden chair was not tracked")


def test_what_bears_things_is_noted_only_where_there_are_things() -> None:
    seen = observe(drink_from_mug(TALL_MAN).capture)
    assumed = notice("assumed-support", "floor", assumed="a plate")
    head = notice("long-gap", "nobody", start_s=1.0, end_s=2.0, times=1, fixed=False)
    seen = replace(seen, notices=(assumed, head))
    assert reservations_on_told(seen) == (assumed,)
    fixed = tuple(replace(each, tag="fixed") for each in seen.objects)
    assert reservations_on_told(replace(seen, objects=fixed)) == ()
