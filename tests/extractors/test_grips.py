"""A hand shifts on an object when it pauses there at another place, however both move."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, box, eased, hand, stream
from scipy.spatial.transform import Rotation

from capar.model.capture import TagObject, TagType
from extractors.bodies.bodies import geometry_of
from extractors.relations.arrangement import shifts
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds

LIMITS = Thresholds()
TIMES = np.arange(0.0, 4.0, 0.01)
WIDTH_M = LIMITS.hand_width_m


def found(
    way_m: float, *, carry: np.ndarray | None = None, turn: np.ndarray | None = None
) -> list[Interval]:
    """Shifts of a hand that goes so far on an object, and stirs before and after."""
    place = np.outer(eased(TIMES, 1.5, 2.0), [way_m, 0.0, 0.0])
    place[:, 1] += 0.1
    place += np.outer(eased(TIMES, 0.3, 0.6) + eased(TIMES, 3.0, 3.3), [0.0, 0.01, 0.0])
    carry = np.zeros((len(TIMES), 3)) if carry is None else carry
    turns = Rotation.from_rotvec(np.outer(0.0 * TIMES if turn is None else turn, [0.0, 0.0, 1.0]))
    thing = TagObject(
        "thing",
        TagType.MOBILE,
        stream(carry, orientations=turns.as_quat(scalar_first=True)),
        box(0.2, 0.1, 0.1),
    )
    palm = hand(carry + turns.apply(place), ball(0.04))
    figures = [geometry_of(each, LIMITS) for each in (palm, thing)]
    return list(shifts(*figures, (0, len(TIMES) - 1), LIMITS))


@given(st.floats(WIDTH_M + 0.01, 0.3))
@settings(max_examples=10, deadline=None)
def test_farther_than_a_hands_width_is_one_shift_at_its_time(way_m: float) -> None:
    ((first, last),) = found(way_m)
    assert 0.5 < TIMES[first] < 1.6
    assert 1.9 < TIMES[last] < 3.2


@given(st.floats(0.0, WIDTH_M - 0.02))
@settings(max_examples=10, deadline=None)
def test_nearer_than_a_hands_width_is_none(way_m: float) -> None:
    assert found(way_m) == []


@given(st.floats(-0.5, 0.5), st.floats(0.0, 3.0))
@settings(max_examples=10, deadline=None)
def test_it_does_not_depend_on_where_the_object_is_carried(way_m: float, angle: float) -> None:
    share = eased(TIMES, 0.5, 3.5)
    carry = np.outer(share, [0.0, way_m, 0.3])
    assert len(found(0.15, carry=carry, turn=angle * share)) == 1
    assert found(0.0, carry=carry, turn=angle * share) == []


def test_a_contact_of_a_few_frames_tells_nothing() -> None:
    thing = TagObject("thing", TagType.MOBILE, stream(np.zeros((9, 3))), box(0.1, 0.1, 0.1))
    palm = hand(np.outer(np.arange(9), [0.1, 0.0, 0.0]), ball(0.04))
    figures = [geometry_of(each, LIMITS) for each in (palm, thing)]
    assert list(shifts(*figures, (2, 5), LIMITS)) == []
