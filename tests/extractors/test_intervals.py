"""What is looked for through time is found as by looking at every frame."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from extractors.signals.intervals import NEAREST, first_where, last_where

LONG = 12 * NEAREST
places = st.lists(st.integers(0, LONG - 1), max_size=4)
frames = st.integers(-1, LONG)


@given(places, frames)
def test_the_first_frame_from_one_on_and_the_last_up_to_one_are_found(
    where: list[int], frame: int
) -> None:
    holds = np.isin(np.arange(LONG), where)
    later = [each for each in where if each >= max(frame, 0)]
    sooner = [each for each in where if each <= frame]
    assert first_where(holds.__getitem__, max(frame, 0), LONG) == min(later, default=None)
    assert last_where(holds.__getitem__, min(frame, LONG - 1)) == max(sooner, default=None)


@given(st.integers(0, LONG // 3))
def test_what_is_near_is_found_without_asking_about_what_is_far(away: int) -> None:
    middle = LONG // 2
    asked: list[int] = []

    def holds(some: slice) -> np.ndarray:
        index = np.arange(some.start, some.stop)
        asked.append(len(index))
        return np.asarray(np.abs(index - middle) == away)

    assert first_where(holds, middle, LONG) == middle + away
    assert sum(asked) <= 3 * max(away, NEAREST)
    asked.clear()
    assert last_where(holds, middle) == middle - away
    assert sum(asked) <= 3 * max(away, NEAREST)
