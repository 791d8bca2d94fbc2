"""Of what is told as the grounds of an atom, every part holds."""

from capar.model.facts import Tag
from capar_rules.engine.syntax import parse_text
from capar_rules.explain.derivations import Grounds, Recorder

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
