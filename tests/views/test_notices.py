"""Notices are printed one a line, many alike as one, and each with the bodies it is about."""

import pytest
from observations import drink_from_mug

from capar.model.notices import Notice, notice
from capar.views.notices import HEADING, note_lines, reservation_lines, reservations

TOLERANCE = notice("contact-tolerance", tolerance_m=0.005, stated=True)


def stand_in(name: str) -> Notice:
    return notice("stand-in-shape", name, shape="box 0.1 x 0.1 x 0.1 m")


def test_few_notices_of_a_code_stand_one_a_line_and_more_than_five_as_one() -> None:
    assert len(note_lines([TOLERANCE, *(stand_in(f"a{each}") for each in range(5))])) == 6
    lines = note_lines([*(stand_in(f"a{each}") for each in range(50)), TOLERANCE])
    assert len(lines) == 2
    assert lines[0].startswith("note [stand-in-shape]: 50 stand-in shapes: a0, a1, a2 and others")


def test_only_what_bears_on_the_truth_is_a_reservation_and_only_of_the_bodies_asked_for() -> None:
    notices = (TOLERANCE, stand_in("mug"), stand_in("box"))
    assert reservations(notices) == notices[1:]
    assert reservations(notices, about={"hand", "box"}) == (stand_in("box"),)
    seen = drink_from_mug()
    assert reservations(seen.notices) == seen.notices


@pytest.mark.parametrize(
    ("notices", "said"),
    [
        ((stand_in("r_middle1"), stand_in("mug")), "assumed: right middle, cup."),
        (
            (notice("objects-left-out", "100 half egg carton(Clone)-18146", objects=1),),
            "half egg carton.",
        ),
        (tuple(stand_in(f"a{each}") for each in range(5)), "a0, a1, a2 and 2 more."),
    ],
)
def test_reservations_name_bodies_as_people_do(notices: tuple[Notice, ...], said: str) -> None:
    gap, heading, *lines = reservation_lines(notices, called={"mug": "cup"})
    assert (gap, heading) == ("", HEADING)
    assert [line.endswith(said) for line in lines] == [True]
