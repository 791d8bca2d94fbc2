"""Notices are told one a line, many alike as one, and each with the bodies it is about."""

from observations import drink_from_mug

from capar.model.notices import Notice, notice
from capar.views.notices import note_lines, reservations

TOLERANCE = notice("contact-tolerance", tolerance_m=0.005, stated=True)


def stand_in(name: str) -> Notice:
    return notice("stand-in-shape", name, shape="box 0.1 x 0.1 x 0.1 m")


def test_a_few_notices_stand_one_a_line_as_they_are() -> None:
    lines = note_lines([TOLERANCE, *(stand_in(f"a{each}") for each in range(5))])
    assert (
        lines[0]
        == "note [contact-tolerance]: bodies count as touching within 5.0 mm, as the capture states"
    )
    assert lines[5] == "note [stand-in-shape]: 'a4' is a stand-in: box 0.1 x 0.1 x 0.1 m"
    assert len(lines) == 6


def test_more_than_five_of_one_code_are_one_line() -> None:
    lines = note_lines([*(stand_in(f"a{each}") for each in range(50)), TOLERANCE])
    assert lines[0] == (
        "note [stand-in-shape]: 50 stand-in shapes: a0, a1, a2 and others (--json tells all)"
    )
    assert len(lines) == 2


def test_many_of_a_code_without_a_word_of_its_own_are_counted_too() -> None:
    alike = [
        notice("flicker", "hand", "mug", start_s=each, length_s=0.1, taken="apart")
        for each in range(7)
    ]
    assert note_lines(alike) == ("note [flicker]: 7 alike: hand and mug",)
    vague = [notice("rule-violation", violation=f"about {each}") for each in range(6)]
    assert note_lines(vague) == ("note [rule-violation]: 6 alike",)


def test_only_what_bears_on_the_truth_is_a_reservation_and_only_of_the_bodies_asked_for() -> None:
    notices = (TOLERANCE, stand_in("mug"), stand_in("box"))
    assert reservations(notices) == notices[1:]
    assert reservations(notices, about={"hand", "box"}) == (stand_in("box"),)
    seen = drink_from_mug()
    assert reservations(seen.notices) == seen.notices
