"""A summary names few deeds, those that matter, in the order in which they began.

What is done again is told again only where it takes longer.
"""

from dataclasses import replace

from hypothesis import assume, given
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
    for at, step in enumerate(told):
        same = [each for each in told[:at] if (each.pattern, each.objects) == said_of(step)]
        assert all(lasts_s(each) < lasts_s(step) for each in same)


@given(done())
def test_what_took_longest_is_told(steps: tuple[Clause, ...]) -> None:
    assume(len(steps) <= MOST_DEEDS)
    told = [(each.ees, each.grip, said_of(each)) for each in chosen(steps)]
    longest = max(steps, key=lasts_s)
    assert (longest.ees, longest.grip, said_of(longest)) in told


def test_the_same_for_much_longer_is_told_instead_and_for_longer_too() -> None:
    short, longer = deed("Turn", 0.0, 1.0), deed("Turn", 5.0, 6.5, grip=1)
    longest = deed("Turn", 9.0, 13.0, grip=2)
    assert chosen((short, longer)) == (short, longer)
    assert chosen((short, longest)) == (longest,)
    assert chosen((longest, replace(short, start_s=20.0, end_s=21.0, grip=3))) == (longest,)


def said_of(step: Clause) -> tuple[str, tuple[str, ...]]:
    return step.pattern, step.objects


def lasts_s(step: Clause) -> float:
    return step.end_s - step.start_s


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


def test_a_tool_is_neither_fetched_nor_put_back_in_a_summary() -> None:
    take = replace(deed("MoveObjTo", 0.0, 1.0), pattern="take {1} from {2}")
    stir, back = deed("Stir", 1.0, 3.0), deed("PutDown", 3.0, 4.0)
    back = replace(back, pattern="put {1} back on {2}", objects=("mug", "table"))
    assert chosen((take, stir, back)) == (stir,)
    assert chosen((take, back)) == (take, back)
    assert chosen((take, stir, replace(back, grip=1))) == (stir, replace(back, grip=1))


def test_help_is_told_beside_the_work_that_it_helps() -> None:
    stir = deed("Stir", 2.0, 5.0)
    steady = replace(stir, pattern="steady {1}", objects=("bowl",), ees=("left_hand",))
    steady = replace(steady, start_s=1.0, end_s=4.0, changes=False)
    assert chosen((steady, stir)) == (replace(steady, start_s=2.0), stir)
