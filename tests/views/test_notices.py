"""Notices are told one a line, many alike as one, and each with the bodies it is about."""

import pytest
from observations import drink_from_mug

from capar.model.capture import Notice
from capar.views.notices import bodies, note_lines, reservations

TOLERANCE = Notice("contact-tolerance", "bodies count as touching within 5.0 mm")


def stand_in(name: str) -> Notice:
    return Notice("stand-in-shape", f"{name!r} is a stand-in: box 0.1 x 0.1 x 0.1 m")


def test_a_few_notices_stand_one_a_line_as_they_are() -> None:
    lines = note_lines([TOLERANCE, *(stand_in(f"a{each}") for each in range(5))])
    assert lines[0] == "note [contact-tolerance]: bodies count as touching within 5.0 mm"
    assert lines[5] == "note [stand-in-shape]: 'a4' is a stand-in: box 0.1 x 0.1 x 0.1 m"
    assert len(lines) == 6


def test_more_than_five_of_one_code_are_one_line() -> None:
    lines = note_lines([*(stand_in(f"a{each}") for each in range(50)), TOLERANCE])
    assert lines[0] == (
        "note [stand-in-shape]: 50 stand-in shapes: a0, a1, a2 …; --json lists them"
    )
    assert len(lines) == 2


def test_many_of_a_code_without_a_word_of_its_own_are_counted_too() -> None:
    alike = [Notice("flicker", f"hand with mug: 0.10 s at {each}.00 s") for each in range(7)]
    assert note_lines(alike) == ("note [flicker]: 7 alike: hand and mug; --json lists them",)
    vague = [Notice("odd", f"something about {each}") for each in range(6)]
    assert note_lines(vague) == ("note [odd]: 6 alike; --json lists them",)


@pytest.mark.parametrize(
    ("message", "about"),
    [
        ("'mug' has no shape, so no contact of it is known", ("mug",)),
        ("'mug' and 'head' count as touching while their origins are near", ("mug", "head")),
        ("hand: 3 frames in which its markers are not rigid are taken as lost", ("hand",)),
        ("3 of 16 objects have no shape and are left out: 'a'", ()),
    ],
)
def test_a_notice_says_which_bodies_it_is_about(message: str, about: tuple[str, ...]) -> None:
    assert bodies(Notice("x", message)) == about


def test_only_what_bears_on_the_truth_is_a_reservation_and_only_of_the_bodies_asked_for() -> None:
    notices = (TOLERANCE, stand_in("mug"), stand_in("box"))
    assert reservations(notices) == notices[1:]
    assert reservations(notices, about={"hand", "box"}) == (stand_in("box"),)
    seen = drink_from_mug()
    assert reservations(seen.notices) == seen.notices
