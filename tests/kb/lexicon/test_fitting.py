"""Verbs for a segment: the rule's own first, then classes by what their predicates want."""

from dataclasses import replace
from pathlib import Path

import pytest

from capar.model.par import FeatureSet
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.verbnet import Frame, Member, Predicate, VerbClass, read_class
from kb.lexicon.verbs import Fit, fitting
from kb.lexicon.verbs import SegmentFeatures as Seen

EXAMPLE = Path(__file__).parent / "example-18.1.xml"
WORDS = (
    PrimitiveWords("Reach", ("reach",)),
    PrimitiveWords("Hit", ("hit",), ("Reach",)),
    PrimitiveWords("MoveObjTo", ("move",)),
)
REACH = Seen("Reach", (), FeatureSet("0", "1", "0", "hand", "0"))
HIT = Seen("Hit", ("Reach",), FeatureSet("0", "1", "0", "hand", "1"))
MOVE_TO = Seen("MoveObjTo", (), FeatureSet("100", "101", "10", "hand", "00"))
PUT = VerbClass(
    "put-9.1",
    "",
    (Member("put", ()),),
    (),
    (
        Frame(
            "NP V NP PP.destination",
            "",
            (),
            (
                Predicate("has_location", ("e1", "Theme", "Initial_Location")),
                Predicate("motion", ("e2", "Theme", "Trajectory")),
                Predicate("has_location", ("e3", "Theme", "Destination")),
            ),
        ),
    ),
    (),
)


def by_verb(fits: tuple[Fit, ...]) -> dict[str, Fit]:
    return {each.verb: each for each in fits}


def test_the_verb_of_the_rule_comes_first_then_its_synonyms() -> None:
    fits = fitting(REACH, WORDS)
    assert [each.verb for each in fits] == ["reach", "reach out"]


def test_the_verb_of_a_more_general_rule_comes_behind() -> None:
    order = [each.verb for each in fitting(HIT, WORDS)]
    assert order.index("hit") < order.index("reach")
    assert "strike" in order


def test_a_class_fits_by_contact_before_and_after() -> None:
    fit = by_verb(fitting(REACH, (), [read_class(EXAMPLE)]))["hit"]
    assert fit.reasons == (
        "!contact(e1, Instrument, Patient) wants no contact before",
        "contact(e2, Instrument, Patient) wants contact after",
    )
    assert not fit.against
    assert fit.source == "prod-18.1: NP V NP PP.instrument"


def test_what_speaks_against_a_class_is_told_and_counts() -> None:
    touching = replace(REACH, features=FeatureSet("1", "1", "0", "hand", "0"))
    better = by_verb(fitting(REACH, (), [read_class(EXAMPLE)]))["hit"]
    worse = by_verb(fitting(touching, (), [read_class(EXAMPLE)]))["hit"]
    assert worse.against == ("!contact(e1, Instrument, Patient) wants no contact before",)
    assert worse.score < better.score


@pytest.mark.parametrize(("seen", "against"), [(MOVE_TO, 0), (REACH, 2)])
def test_a_goal_and_a_motion_are_compared(seen: Seen, against: int) -> None:
    assert len(by_verb(fitting(seen, (), [PUT]))["put"].against) == against


def test_a_class_of_the_primitive_goes_before_another() -> None:
    linked = (PrimitiveWords("Reach", ("reach",), levin=("18.1",)),)
    with_link = by_verb(fitting(REACH, linked, [read_class(EXAMPLE)]))["hit"]
    without = by_verb(fitting(REACH, WORDS, [read_class(EXAMPLE)]))["hit"]
    assert with_link.score > without.score
