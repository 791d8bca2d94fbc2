"""Allen's relations of the steps of several links are those of their frames."""

import itertools
from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from capar.model.par import LinkSteps, Step
from capar_rules.pars.pars import _relations, allen

INVERSE = {
    "meets": "metBy", "starts": "startedBy", "finishes": "finishedBy", "during": "contains",
    "overlaps": "overlappedBy", "equals": "equals",
}  # fmt: skip
BOTH = INVERSE | {other: one for one, other in INVERSE.items()}


def link(ee: str, borders: list[int], frames: int) -> LinkSteps:
    """A link whose steps lie between borders, in frames."""
    steps = (
        Step("Reach", ee, (), float(Fraction(last - first, frames)), "",
             float(Fraction(first, frames)), (index,), "")
        for index, (first, last) in enumerate(itertools.pairwise(borders))
    )  # fmt: skip
    return LinkSteps(ee, tuple(steps))


@st.composite
def two(draw: st.DrawFn) -> tuple[int, list[int], list[int]]:
    """How many frames there are, and the borders of two links in them."""
    frames = draw(st.integers(10, 2000))
    borders = st.lists(st.integers(1, frames - 1), max_size=6, unique=True)
    one, other = ([0, *sorted(draw(borders)), frames] for _ in range(2))
    return frames, one, other


@given(two())
def test_relations_are_told_as_their_frames_have_them(case: tuple[int, list[int], list[int]]):
    frames, one, other = case
    found = {
        (each.first[1], each.second[1]): each.relation
        for each in _relations((link("a", one, frames), link("b", other, frames)), frames)
    }
    expected = {}
    for i, (first, last) in enumerate(itertools.pairwise(one)):
        for j, (begin, end) in enumerate(itertools.pairwise(other)):
            if begin <= last and first <= end:
                expected[i, j] = allen(first, last, begin, end)
    assert found == expected


@given(st.lists(st.integers(0, 6), min_size=4, max_size=4))
def test_of_two_intervals_each_has_the_inverse_relation_to_the_other(ends: list[int]):
    first, last, begin, end = ends
    if first < last and begin < end:
        relation = allen(first, last, begin, end)
        back = allen(begin, end, first, last)
        assert back == (BOTH | {"before": "after", "after": "before"})[relation]
