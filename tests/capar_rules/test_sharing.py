"""Which contacts of other end-effectors share an object, and between which ticks they change."""

from hypothesis import given
from hypothesis import strategies as st

from capar.model.facts import Touching
from capar_rules.borders.border_numbers import by_object, overlapping, shared
from capar_rules.borders.ticks import Meanwhile, Shares

FRAMES = 200


def contacts(ee: str) -> st.SearchStrategy[list[Touching]]:
    """Contacts of an end-effector with two things, those with the same one apart."""
    ends = st.lists(st.integers(0, FRAMES), min_size=2, max_size=8, unique=True).map(sorted)

    def made(mug: list[int], box: list[int]) -> list[Touching]:
        pairs = [
            (name, first, last)
            for name, frames in (("mug", mug), ("box", box))
            for first, last in zip(frames[::2], frames[1::2], strict=False)
        ]
        return sorted(
            (Touching(ee, name, first, last) for name, first, last in pairs),
            key=lambda each: each.first,
        )

    return st.builds(made, ends, ends)


ticks_of = st.sets(st.integers(1, FRAMES - 1)).map(lambda each: sorted({0, FRAMES} | each))


@given(contacts("right_hand"), contacts("left_hand"))
def test_every_pair_that_shares_object_and_frame_is_found(
    own: list[Touching], others: list[Touching]
) -> None:
    found = overlapping(own, [by_object(others)])
    assert sorted(found) == sorted(
        (one, other)
        for one in own
        for other in others
        if one.other == other.other and one.first <= other.last and other.first <= one.last
    )


@given(contacts("right_hand"), contacts("left_hand"), ticks_of)
def test_a_change_meanwhile_lies_between_its_tick_and_the_next(
    own: list[Touching], others: list[Touching], ticks: list[int]
) -> None:
    pairs = overlapping(own, [by_object(others)])
    facts = list(shared("right_hand", ticks, pairs, rate_hz=100.0))
    spans = {(each.other, each.first): each for each in others}
    for each in facts:
        if isinstance(each, Meanwhile):
            contact = spans[each.object, each.since]
            frame = contact.first if each.kind == "begins" else contact.last
            assert ticks[each.tick] <= frame <= ticks[each.tick + 1]
            assert any(one.other == each.object and one.first <= frame <= one.last for one in own)
    inside = [each for each in pairs if each[0].first <= each[1].first]
    begins = [each for each in facts if isinstance(each, Meanwhile) and each.kind == "begins"]
    assert len(begins) == len(inside)


@given(contacts("right_hand"), contacts("left_hand"))
def test_what_one_shares_before_the_other_shares_after(
    own: list[Touching], others: list[Touching]
) -> None:
    ticks = [0, FRAMES]
    mine = overlapping(own, [by_object(others)])
    yours = overlapping(others, [by_object(own)])
    before = [
        each for each in shared("right_hand", ticks, mine, rate_hz=100.0)
        if isinstance(each, Shares) and each.when == "before"
    ]  # fmt: skip
    after = [
        each for each in shared("left_hand", ticks, yours, rate_hz=100.0)
        if isinstance(each, Shares) and each.when == "after"
    ]  # fmt: skip
    assert len(before) == len(after)
    assert {each.object for each in before} == {each.object for each in after}
