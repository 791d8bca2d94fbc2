"""A summary names few deeds, those that matter, in the order in which they began."""

from hypothesis import given
from hypothesis import strategies as st

from kb.language.choosing import chosen
from kb.language.clause import Clause, in_time
from kb.language.thresholds import MOST_DEEDS

PATTERNS = {
    "Lift": "lift {1}",
    "Carry": "carry {1}",
    "Turn": "turn {1}",
    "PutDown": "put {1} on {2}",
    "Stir": "stir in {2} with {1}",
    "MoveObjTo": "bring {1} to {2}",
}


def deed(name: str, start_s: float, end_s: float, thing: str = "mug", grip: int = 0) -> Clause:
    """Something that the right hand did."""
    return Clause(
        PATTERNS[name],
        (thing, "bowl") if "{2}" in PATTERNS[name] else (thing,),
        ("right_hand",),
        start_s,
        end_s,
        changes=True,
        name=name,
        general=("MoveObj",) if name in ("Lift", "Carry", "Turn") else (),
        goes_on=name == "Stir",
        grip=grip,
    )


@st.composite
def done(draw: st.DrawFn) -> tuple[Clause, ...]:
    """Deeds in order of time, with several things."""
    out, now = [], 0.0
    for grip in range(draw(st.integers(1, 6))):
        thing = draw(st.sampled_from(("mug", "cup", "jar", "box")))
        for name in draw(st.lists(st.sampled_from(sorted(PATTERNS)), min_size=1, max_size=5)):
            lasts = draw(st.floats(0.1, 3.0))
            out.append(deed(name, now, now + lasts, thing, grip))
            now += lasts
    return tuple(out)


@given(done())
def test_a_summary_is_short_in_order_and_says_nothing_twice(steps: tuple[Clause, ...]) -> None:
    told = chosen(steps)
    assert 0 < len(told) <= MOST_DEEDS
    assert set(told) <= set(steps)
    assert list(told) == sorted(told, key=in_time)
    assert len({(each.pattern, each.objects) for each in told}) == len(told)


def test_what_leads_to_a_deed_and_what_is_on_the_way_goes_first() -> None:
    steps = tuple(
        deed(name, 2.0 * grip + at, 2.0 * grip + at + 0.5, thing, grip)
        for grip, thing in enumerate(("mug", "cup", "jar"))
        for at, name in enumerate(("Lift", "Carry", "PutDown"))
    )
    assert [(each.name, each.objects[0]) for each in chosen(steps)] == [
        ("PutDown", "mug"),
        ("PutDown", "cup"),
        ("PutDown", "jar"),
    ]
