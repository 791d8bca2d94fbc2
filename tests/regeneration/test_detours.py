"""The smallest detour that is clear is taken, and where none is, the smallest nearly as good."""

from hypothesis import given, settings
from hypothesis import strategies as st

from capar.regeneration.paths import DETOURS, WORTH_M, smallest_detour
from capar.regeneration.styles import Detour

shortfalls = st.lists(st.floats(0.0001, 0.02), min_size=len(DETOURS), max_size=len(DETOURS))


def _chosen(shorts: dict[Detour, float]) -> Detour:
    """The detour that is chosen if paths come so near, measured no further than decides."""

    def short(detour: Detour, enough: float) -> float:
        # Measuring stops at a frame that comes too near, though later frames may come nearer.
        return shorts[detour] if shorts[detour] < enough else 0.5 * (enough + shorts[detour])

    return smallest_detour(short)


@settings(max_examples=100, deadline=None)
@given(values=shortfalls)
def test_a_way_of_which_no_detour_is_clear_keeps_the_smallest_as_good_as_the_best(
    values: list[float],
) -> None:
    shorts = dict(zip(DETOURS, values, strict=True))
    chosen = _chosen(shorts)
    assert shorts[chosen] < min(values) + WORTH_M
    smaller = DETOURS[: DETOURS.index(chosen)]
    assert all(shorts[detour] >= min(values) + WORTH_M for detour in smaller)
    assert all(detour.size <= chosen.size for detour in smaller)
