"""An address of a segment reads back as it was written, and anything else is refused."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug

from capar.model.errors import UnknownNameError
from capar.model.observation import (
    AddressError,
    SegmentAddress,
    find_segment,
    split_capture,
)

words = st.text(st.characters(exclude_characters="/", exclude_categories=["Cs", "Z", "C"]),
                min_size=1)  # fmt: skip
captures = st.lists(words, max_size=3).map("/".join)


@given(words, st.integers(0, 10**6), captures)
def test_an_address_reads_back_as_it_was_written(ee: str, index: int, capture: str) -> None:
    address = SegmentAddress(ee, index, capture)
    assert SegmentAddress.parse(str(address)) == address


@pytest.mark.parametrize(
    "text",
    ["", "3", "right_hand", "right_hand/", "/3", "a//3", "right_hand/-1", "a/x", "a:b:3", "a/²"],
)
def test_a_text_that_is_no_address_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(AddressError, match="write CAPTURE/END_EFFECTOR/INDEX, such as "):
        SegmentAddress.parse(text)


@pytest.mark.parametrize(("ee", "index"), [("", 0), ("a/b", 0), ("a", -1)])
def test_what_could_not_be_read_back_is_no_address(ee: str, index: int) -> None:
    with pytest.raises(AddressError):
        SegmentAddress(ee, index)


def test_each_segment_is_found_with_and_without_its_capture() -> None:
    seen = drink_from_mug()
    for segment in seen.segments:
        for capture in ("", seen.capture):
            address = SegmentAddress(segment.ee, segment.index, capture)
            assert find_segment(seen.links, address, capture=seen.capture) is segment


def test_another_capture_or_segment_is_refused_with_those_there_are() -> None:
    seen = drink_from_mug()
    with pytest.raises(UnknownNameError, match="no capture 'Other'; there are: DrinkFromMug"):
        find_segment(seen.links, SegmentAddress.parse("Other/right_hand/0"), capture=seen.capture)
    with pytest.raises(UnknownNameError, match="no segment 'right_hand/99'; there are: "):
        find_segment(seen.links, SegmentAddress("right_hand", 99), capture=seen.capture)


def test_a_capture_is_demanded_where_there_may_be_several() -> None:
    assert split_capture("a/b:c/hand/3") == ("a/b:c", SegmentAddress("hand", 3))
    with pytest.raises(AddressError, match="names no capture"):
        split_capture("hand/3")
