"""The statuses of verb classes are derived, and what shows them is told."""

from pathlib import Path

import pytest
from motions import TALL_MAN, drink_from_mug, slide_object
from observations import MUG, Piece, observation

from capar.model.errors import RuleError
from capar.model.facts import Fact, Intended
from capar.model.observation import Observation
from capar.model.par import FeatureSet
from capar.pipelines.linguistic_report import (
    cases_of,
    linguistics,
    primitive_files,
    primitive_words,
    standing,
)
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.lexicon.loading import load_verbnet
from kb.lexicon.verbnet import read_class
from kb.lexicon.verbs import Case
from kb.lexicon.wordnet import wordnet
from kb.reports.formats import write
from kb.reports.linguistics import ClassReport, Evidence, How, LinguisticReport, Status

EXAMPLE = Path(__file__).parent.parent / "lexicon" / "example-18.1.xml"
PUBLISHED = ("reach", "hit", "touch", "touch_with", "move_obj", "move_obj_to", "resume_posture")


def files(*stems: str) -> list[Path]:
    return [each for each in primitive_files() if each.stem in stems]


def of(report: LinguisticReport, number: str) -> ClassReport:
    return next(each for each in report.classes if each.number == number)


def verbs(report: LinguisticReport) -> dict[tuple[str, str], tuple[How, tuple[str, ...]]]:
    return {
        (each.number, verb.verb): (verb.how, verb.primitives)
        for each in report.classes
        for verb in each.verbs
    }


@pytest.fixture(scope="module")
def published() -> LinguisticReport:
    return linguistics(files(*PUBLISHED))


def test_the_published_primitives_address_what_the_thesis_shows(
    published: LinguisticReport,
) -> None:
    found = verbs(published)
    assert found["20", "touch"] == (How.ADDRESSED, ("Touch", "TouchWith"))
    assert found["18.1", "hit"] == found["18.1", "strike"] == (How.ADDRESSED, ("Hit",))
    assert found["11.2", "move"] == (How.ADDRESSED, ("MoveObj", "MoveObjTo"))
    assert found["11.4", "carry"] == (How.GENERAL, ("MoveObj", "MoveObjTo"))
    assert found["18.1", "kick"] == (How.GENERAL, ("Hit",))
    assert found["13.5.1", "catch"] == (How.MISSING, ())
    assert of(published, "18.2").status is Status.NOT
    assert of(published, "20").status is Status.PARTLY


@pytest.mark.parametrize("stem", ["throw", "kick", "lift"])
def test_adding_a_rule_file_changes_only_what_depends_on_it(stem: str) -> None:
    before = verbs(linguistics(files(*PUBLISHED)))
    after = verbs(linguistics(files(*PUBLISHED, stem)))
    (own,) = primitive_words(files(stem))
    changed = {key for key in before | after if before.get(key) != after.get(key)}
    assert changed
    assert {verb for _, verb in changed if verb in own.verbs} == set(own.verbs)
    for key in changed:
        assert own.name in after[key][1] or key[1] in own.verbs


def test_a_users_primitive_counts_by_its_verb_alone(tmp_path: Path) -> None:
    path = tmp_path / "nudge.lp"
    path.write_text('%* Nudge: a little push. *%\nprimitive("Nudge").\nverb("Nudge", "nudge").\n')
    found = verbs(linguistics([*files(*PUBLISHED), path]))
    assert found["20", "nudge"] == (How.ADDRESSED, ("Nudge",))


def test_a_class_that_a_rule_file_states_wins(tmp_path: Path) -> None:
    path = tmp_path / "prod.lp"
    path.write_text('primitive("Prod").\nverb("Prod", "prod"). levin("Prod", "19").\n')
    report = linguistics([*files(*PUBLISHED), path])
    assert of(report, "19").status is Status.ADDRESSED
    assert of(report, "19").files == (f"{tmp_path.name}/prod.lp",)


def test_a_primitive_stands_in_one_file(tmp_path: Path) -> None:
    for name in ("a.lp", "b.lp"):
        (tmp_path / name).write_text('primitive("Twice").\n')
    with pytest.raises(RuleError, match="also stated by"):
        primitive_words(sorted(tmp_path.glob("*.lp")))


def test_what_was_observed_is_evidence() -> None:
    book = Actionary.in_memory()
    book.add(observe(slide_object(TALL_MAN).capture, rules="thesis"))
    report = linguistics(files(*PUBLISHED), store=book.store)
    slide = of(report, "11.2")
    assert [(each.primitive, each.kind) for each in slide.proofs] == [("MoveObj", "observed")]
    assert slide.segments == 1
    assert report.coverage.segments == report.coverage.segments_named == 2
    book.forget(report.observations[0])
    assert not of(linguistics(files(*PUBLISHED), store=book.store), "11.2").proofs


def test_a_purpose_that_was_stated_is_a_partial_answer() -> None:
    book = Actionary.in_memory()
    book.add(observe(drink_from_mug(TALL_MAN).capture, rules="thesis"))
    found = verbs(linguistics(files(*PUBLISHED), store=book.store))
    how, by = found["39.1", "drink"]
    assert how is How.PURPOSE
    assert "MoveObj" in by


def test_a_shipped_case_is_evidence() -> None:
    report = linguistics(files(*PUBLISHED), cases=[Case("Hit", "hit_on_drum")])
    (proof,) = of(report, "18.1").proofs
    assert (proof.primitive, proof.kind, proof.where) == ("Hit", "tested", "hit_on_drum")


def test_cases_are_found_in_rule_files_and_beside_them(tmp_path: Path) -> None:
    rule = tmp_path / "nudge.lp"
    rule.write_text(
        'primitive("Nudge").\nverb("Nudge", "nudge").\n'
        "%* Example: a little push.\nframes(0, 9).\nlink(right_hand, hand, right).\n"
        "=> right_hand: Nudge\n*%\n"
    )
    (tmp_path / "push.cases").write_text(
        '%% Pushed aside\n% A story.\n=> named(seg(right_hand,1),"Push")\n=> not x("Pull")\n'
    )
    assert cases_of([rule], tmp_path) == (
        Case("Nudge", f"{tmp_path.name}/nudge.lp: a little push."),
        Case("Push", "push: Pushed aside"),
    )


def test_members_of_an_imported_verbnet_are_told_beside() -> None:
    book = Actionary.in_memory()
    load_verbnet(book.store, [read_class(EXAMPLE)], wordnet())
    report = linguistics(files(*PUBLISHED), store=book.store)
    assert report.verbnet
    found = {each.verb: each.counts for each in of(report, "18.1").verbs}
    assert found == {"hit": True, "kick": True, "strike": True, "pick up": False}


def test_a_verb_stands_to_the_rule_base_by_its_senses() -> None:
    words = primitive_words(files(*PUBLISHED))
    assert standing("strike", words).represented_by == ("Hit",)
    assert standing("shove", words).general_only == ("MoveObj", "MoveObjTo")
    assert standing("think", words).words.startswith("not represented")


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


@pytest.fixture(scope="module")
def fidget() -> LinguisticReport:
    """Two changes of posture of which the second comes before a rest, a push and a touch."""
    named = (
        *(("PostureChange", "Push"), ("Push", "PostureChange"), ("PostureChange", "Rest")),
        *(("Rest", "Touch"), ("Touch", "")),
    )
    return reported(doing(*named), Case("Push", "a_push"))


def test_a_stated_purpose_shows_the_class_by_its_own_segments_alone() -> None:
    stated = Intended(0, "MoveObj", "any", "any", "Eat")
    seen = doing(("MoveObj", "Eat"), ("MoveObj", "MoveObjTo"), ("MoveObjTo", ""), stated=(stated,))
    eat = of(reported(seen, Case("MoveObj", "a_move")), "39.1")
    assert {each.verb: each.how for each in eat.verbs}["eat"] is How.PURPOSE
    assert [(each.primitive, each.where) for each in eat.proofs] == [("MoveObj", "Fidget")]
    assert eat.segments == 1


def test_a_segment_counts_in_a_class_by_a_verb_of_its_own_primitive() -> None:
    report = reported(doing(("ResumePosture", ""), ("Hit", "")))
    assert report.coverage.segments == report.coverage.segments_named == 2
    assert report.coverage.segments_in_classes == 1


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
