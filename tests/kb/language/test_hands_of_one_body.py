"""A hand of which its arm tells is told with the other hand, where both move one thing."""

from types import SimpleNamespace

from kb.language.clause import Clause
from kb.language.hands import with_the_other_hand

LEFT, RIGHT = (
    SimpleNamespace(ee=f"{side}_hand", kind="hand", side=side) for side in ("left", "right")
)


def moves(hand: str, pattern: str, start_s: float, end_s: float) -> Clause:
    return Clause(pattern, ("chair",), (f"{hand}_hand",), start_s, end_s, True)


LIFT = moves("left", "lift {1}", 0.0, 2.0)


def told(right: tuple[Clause, ...], own: tuple[Clause, ...] = ()) -> tuple[Clause, ...]:
    return with_the_other_hand([LEFT, RIGHT], [(LIFT,), own], [(LIFT,), right])[1]


def test_what_both_move_for_most_of_a_deed_is_that_deed_of_both() -> None:
    parts = (moves("right", "raise {1}", 0.4, 1.0), moves("right", "lower {1}", 1.2, 1.9))
    (lift,) = told(parts)
    assert (lift.pattern, lift.ees) == (LIFT.pattern, ("right_hand",))
    assert (lift.start_s, lift.end_s) == (0.0, 2.0)


def test_who_moves_it_for_less_than_half_of_a_deed_keeps_its_own() -> None:
    parts = (moves("right", "raise {1}", 1.2, 2.0),)
    assert told(parts) == parts


def test_what_a_hand_is_seen_to_do_by_itself_is_left() -> None:
    parts = (moves("right", "raise {1}", 0.2, 1.9),)
    assert told(parts, own=parts) == parts
