"""What shows a class: segments of its own primitives, not of what is more general."""

import pytest
from observations import MUG, Piece, observation

from capar.model.facts import Fact, Intended
from capar.model.observation import Observation
from capar.model.par import FeatureSet
from capar.pipelines.linguistic_report import linguistics, primitive_files
from kb.actionary import Actionary
from kb.lexicon.verbs import Case
from kb.reports.formats import coverage, write
from kb.reports.linguistics import ClassReport, Evidence, How, LinguisticReport

STILL = FeatureSet("0", "0", "0", "hand", "0")


def doing(*pieces: tuple[str, str], stated: tuple[Fact, ...] = ()) -> Observation:
    """Segments by name and purpose, ten frames each."""
    told = tuple(
        Piece(name, 10 * index, ("mug",), purpose, STILL)
        for index, (name, purpose) in enumerate(pieces, 1)
    )
    frames = 10 * len(pieces) + 1
    return observation(
        "Fidget", {"right_hand": told}, (MUG,), facts=stated, frames=frames, rate_hz=100.0
    )


def reported(seen: Observation, *cases: Case) -> LinguisticReport:
    book = Actionary.in_memory()
    book.add(seen)
    return linguistics(primitive_files(), store=book.store, cases=cases)


def of(report: LinguisticReport, number: str) -> ClassReport:
    return next(each for each in report.classes if each.number == number)


@pytest.fixture(scope="module")
def fidget() -> LinguisticReport:
    """Two changes of posture of which the second comes before a rest, a push and a touch."""
    named = (
        *(("PostureChange", "Push"), ("Push", "PostureChange"), ("PostureChange", "Rest")),
        *(("Rest", "Touch"), ("Touch", "")),
    )
    return reported(doing(*named), Case("Push", "a_push"))


def test_a_more_general_primitive_shows_no_class(fidget: LinguisticReport) -> None:
    shown = {(each.primitive, each.where) for each in of(fidget, "20").proofs}
    assert shown == {("Touch", "Fidget")}
    assert of(fidget, "20").segments == 1
    assert {each.primitive for each in of(fidget, "12").proofs} == {"Push"}


def test_what_came_next_is_no_purpose_that_somebody_stated(fidget: LinguisticReport) -> None:
    put = of(fidget, "9.1")
    assert put.proofs == ()
    assert put.segments == 0
    spatial = of(fidget, "9.2")
    assert {each.verb: each.how for each in spatial.verbs}["rest"] is not How.PURPOSE


def test_a_stated_purpose_shows_the_class_by_its_own_segments_alone() -> None:
    stated = Intended(0, "MoveObj", "any", "any", "Eat")
    seen = doing(("MoveObj", "Eat"), ("MoveObj", "MoveObjTo"), ("MoveObjTo", ""), stated=(stated,))
    eat = of(reported(seen, Case("MoveObj", "a_move")), "39.1")
    assert {each.verb: each.how for each in eat.verbs}["eat"] is How.PURPOSE
    assert [(each.primitive, each.where) for each in eat.proofs] == [("MoveObj", "Fidget")]
    assert eat.segments == 1


def test_a_purpose_stated_for_another_action_is_not_stated_for_this() -> None:
    stated = Intended(0, "Reach", "any", "any", "Eat")
    seen = doing(("MoveObj", "Eat"), stated=(stated,))
    assert of(reported(seen), "39.1").proofs == ()


def test_a_segment_counts_in_a_class_by_a_verb_of_its_own_primitive() -> None:
    report = reported(doing(("ResumePosture", ""), ("Hit", "")))
    assert report.coverage.segments == report.coverage.segments_named == 2
    assert report.coverage.segments_in_classes == 1


def test_nobody_reads_a_more_general_verb_as_seen(fidget: LinguisticReport) -> None:
    text = " ".join(write(fidget, "text").split())
    why = "kiss: not addressed; only what is more general is: Touch, TouchOneself, TouchWith."
    assert why in text
    figures = dict(coverage(fidget))
    general = [
        each for report in fidget.classes for each in report.verbs if each.how is How.GENERAL
    ]
    assert figures["verbs not addressed, only what is more general"].startswith(
        f"{len(general)} of"
    )
    assert figures["verbs only as a purpose that the user states"].startswith("0 of")
    for form in ("text", "md", "html", "latex", "csv", "svg"):
        told = write(fidget, form)
        assert "seen only as" not in told
        assert "seen in general" not in told
        assert "in general only" not in told
    assert "not addressed, only what is more general" in write(fidget, "csv")


def test_an_addressed_verb_says_what_shows_it(fidget: LinguisticReport) -> None:
    verbs = [each for report in fidget.classes for each in report.verbs]
    for each in verbs:
        addressed = each.how is How.ADDRESSED
        assert addressed == (each.evidence is not Evidence.NONE)
        assert (each.evidence is Evidence.OBSERVED) == (addressed and each.segments > 0)
        if each.evidence is Evidence.TESTED:
            assert each.cases and each.cases[0] in each.standing
    assert {each.evidence for each in verbs} >= {Evidence.OBSERVED, Evidence.NONE}
    for kind in ("csv", "md", "html"):
        assert "observed (" in write(fidget, kind)


def test_with_an_empty_actionary_nothing_is_observed() -> None:
    report = linguistics(primitive_files(), cases=[Case("Push", "a_push")])
    verbs = [each for each in report.classes for each in each.verbs]
    assert Evidence.OBSERVED not in {each.evidence for each in verbs}
    assert "observed (" not in write(report, "csv")
    push = next(each for each in verbs if each.verb == "push" and each.how is How.ADDRESSED)
    assert push.evidence is Evidence.TESTED
    assert push.standing == "addressed: tested (a_push)"
