"""Of what is told as the grounds of an atom, every part holds."""

import pytest

from capar.model.facts import Tag
from capar_rules.engine.solver import worlds
from capar_rules.engine.syntax import parse_text
from capar_rules.explain.derivations import NUMBERS, Grounds, Numbering, Recorder

RULES = """
like(Thing, Kind) :- tag(Thing, Kind).
handy(Thing) :- like(Thing, (mobile; self)).
also(tag(Thing, Kind), beside(Thing)) :- tag(Thing, Kind), beside(Thing).
beside(Thing) :- like(Thing, self).
"""


def why(*facts: Tag) -> Grounds:
    statements = parse_text(RULES)
    recorder = Recorder(statements, targets=(("handy", 1), ("also", 2)))
    return recorder.solve([facts])[0].why("handy(hand)")


def walk(grounds: Grounds) -> list[str]:
    return [grounds.atom, *(atom for each in grounds.because for atom in walk(each))]


def test_of_a_choice_in_a_body_the_grounds_are_the_one_that_holds() -> None:
    """Both choices are written in one rule, and one of them is false."""
    told = walk(why(Tag("hand", "self")))
    assert "like(hand,self)" in told
    assert "like(hand,mobile)" not in told


def test_what_is_to_be_told_below_a_measurement_is_told_below_it() -> None:
    told = why(Tag("hand", "self")).because[0].because[0]
    assert told.atom == "tag(hand,self)"
    assert [each.atom for each in told.because] == ["beside(hand)"]


def test_what_is_derived_in_a_window_is_what_is_derived_from_its_facts_alone() -> None:
    recorder = Recorder(parse_text(RULES), targets=(("handy", 1), ("also", 2)))
    windows = [(Tag("hand", "self"),), (Tag("mug", "mobile"),), (Tag("table", "fixed"),)]
    together = recorder.solve(windows)
    assert [each.holding("handy") for each in together] == [[("hand",)], [("mug",)], []]
    for window, derived in zip(windows, together, strict=True):
        (alone,) = recorder.solve([window])
        assert derived.holding("like") == alone.holding("like")
        for (thing,) in derived.holding("handy"):
            assert derived.why(f"handy({thing})") == alone.why(f"handy({thing})")


NUMBERED = """
kind(cup). kind(mug). tag(table, fixed).
seen(Thing, (first; second)) :- at(Thing, _), kind(Thing).
early(Thing) :- at(Thing, Time), Time < 3.
late(Thing) :- at(Thing, _), not early(Thing).
last(Time) :- Time = #max { When : at(_, When), kind(cup) ; 0 }.
all_early :- early(Thing) : at(Thing, _).
either(1;2) :- last(2).
{ moved(Thing) : at(Thing, _) } 1 :- all_early.
:- moved(mug).
"""
WINDOWS = (
    {"at": ["cup,1", "mug,2"]},
    {"at": ["mug,5"]},
    {},
)
PREDICATES = (
    "seen/2",
    "early/1",
    "late/1",
    "last/1",
    "all_early/0",
    "either/1",
    "moved/1",
    "tag/2",
)


def shows(wider: int) -> str:
    named = (each.split("/") for each in PREDICATES)
    return "\n".join(f"#show {name}/{int(arity) + wider}." for name, arity in named)


def answers(window: dict[str, list[str]]) -> list[tuple[str, ...]]:
    facts = "".join(f"{name}({each})." for name, rows in window.items() for each in rows)
    return worlds(f"{NUMBERED}#defined at/2.\n{shows(0)}\n{facts}")


@pytest.mark.parametrize("number", range(len(WINDOWS)))
def test_what_follows_in_a_window_is_what_follows_from_it_alone(number: int) -> None:
    statements = parse_text(NUMBERED)
    numbering = Numbering(statements)
    facts = "".join(
        f"{NUMBERS}({n})." + "".join(f"at({n},{row})." for row in window.get("at", []))
        for n, window in enumerate(WINDOWS)
    )
    text = "\n".join(numbering.rule(each) for each in statements if each.kind == "rule")
    together = worlds(f"{text}\n{shows(1)}\n{facts}")
    found = {tuple(sorted(own(atom) for atom in world if of(atom) == number)) for world in together}
    assert found == {tuple(sorted(each)) for each in answers(WINDOWS[number])}


def of(atom: str) -> int:
    return int(atom.partition("(")[2].split(",")[0].rstrip(")"))


def own(atom: str) -> str:
    name, _, rest = atom.partition("(")
    inside = rest.removesuffix(")").partition(",")[2]
    return f"{name}({inside})" if inside else name
