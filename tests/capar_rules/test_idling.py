"""Rest that nothing disturbs, numbered outside of the rules, is what asking every tick gives."""

from hypothesis import given
from hypothesis import strategies as st

from capar.model.facts import Resting, Touching
from capar_rules.borders.border_numbers import undisturbed
from capar_rules.borders.ticks import Undisturbed

SPANS = st.lists(
    st.tuples(st.integers(0, 60), st.integers(0, 20)).map(lambda each: (each[0], sum(each))),
    max_size=8,
)


@given(SPANS, SPANS, st.sets(st.integers(0, 80)))
def test_a_rest_counts_from_the_last_tick_of_it_that_lies_in_a_contact(rests, contacts, others):
    ticks = sorted(others | {0, 80} | {frame for span in contacts for frame in span})
    own = sorted(Touching("hand", "box", *each) for each in contacts)
    found = set(undisturbed("hand", ticks, [Resting("hand", *each) for each in rests], own))
    expected = set()
    for first, last in rests:
        inside = [at for at, frame in enumerate(ticks) if first <= frame <= last]
        touched = [at for at in inside if any(a <= ticks[at] <= b for a, b in contacts)]
        if inside and not touched:
            expected.add(Undisturbed("hand", inside[0], inside[-1]))
        elif touched and inside[0] < touched[-1] < inside[-1]:
            expected.add(Undisturbed("hand", touched[-1], inside[-1]))
    assert found == expected
