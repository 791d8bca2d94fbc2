"""Explanations state the conditions of rules, with values that agree with what was measured."""

from collections.abc import Callable, Iterator
from functools import cache

import motions
import pytest
from combinations import EVERY
from flickering import flickering
from scenes.batteries import SCENES

from capar.model.capture import Capture
from capar.model.facts import (
    Observed,
    ZeroCrossing,
)
from capar.pipelines.explanation import Explained, explained
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import profile
from capar_rules.explain.conditions import Condition
from capar_rules.explain.explanation import Explainer, Explanation, rule_base
from capar_rules.explain.nearest import FEATURE, forms_of
from capar_rules.explain.quantities import QUANTITIES
from capar_rules.explain.sentences import parsed
from capar_rules.lint.text_checks import known
from capar_rules.pars.inference import infer
from extractors.measure import measure

pytestmark = pytest.mark.long

ACTED = (
    motions.drink_from_mug,
    motions.slide_object,
    motions.pick_up_with_both_hands,
    motions.stand_on_one_leg,
    motions.roll_object,
    motions.hit,
)
SOME_SCENES = tuple(sorted(SCENES))[:: 97 if EVERY else 194]
CAPTURES: dict[str, Callable[[], Capture]] = {
    **{each.__name__: lambda make=each: make(motions.TALL_MAN).capture for each in ACTED},
    **{name: lambda scene=SCENES[name]: scene(100.0, 0.0, 0.0, 0)[0] for name in SOME_SCENES},
}

AGREES = {"cm": 0.3, "°": 1.5, "mm/s": 60.0}
"""How far a value that rules compare may be off the one over time, as facts are rounded."""


@cache
def told(name: str) -> tuple[Explained, tuple[Explanation, ...]]:
    """A capture that was observed, and the explanations of all its segments."""
    seen = explained(CAPTURES[name](), rules=profile())
    return seen, seen.explain(seen.observation.segments)


def conditions(name: str) -> Iterator[tuple[Explanation, Condition]]:
    for each in told(name)[1]:
        yield from ((each, condition) for condition in each.conditions)


@pytest.mark.parametrize("rules", ["extended", "thesis"])
def test_every_condition_that_a_primitive_s_rules_ask_of_a_segment_has_a_sentence(rules: str):
    base = rule_base(profile(rules))
    lacking = {
        (literal.sign, literal.atoms[0].signature)
        for name in known(base.statements).primitives
        for form in forms_of(base, name)
        for literal in form.body
        if literal.kind == "atom"
        and literal.atoms[0].signature != FEATURE
        and "Segment" in literal.text.partition("(")[2].split(",")[0]
        and not base.sentences.describes(literal.atoms[0].signature, absent=bool(literal.sign))
    }
    assert lacking <= {(0, ("count", 2)), (1, ("accompanies", 3)), (1, ("lifted", 2))}


def test_every_quantity_of_the_rule_files_is_known_and_every_known_one_is_used():
    comparisons = rule_base(profile()).sentences.comparisons.values()
    named = {
        asked[0]
        for every in comparisons
        for one in every
        if one is not None
        for asked in (one.asked, one.against)
        if asked is not None
    }
    assert {*QUANTITIES} - {"turning"} == named


@pytest.mark.parametrize("name", CAPTURES)
def test_every_value_is_on_its_side_of_the_limit(name: str):
    for each, condition in conditions(name):
        for one in condition.measures:
            assert one.holds, (each.ee, each.index, condition.sentence, one)


@pytest.mark.parametrize("name", CAPTURES)
def test_what_rules_compare_agrees_with_what_is_drawn_over_time(name: str):
    seen, every = told(name)
    for each in every:
        for condition in each.conditions:
            for one in condition.measures:
                series = seen.measures.series(one)
                drawn = series and series.within(one.first, one.last)
                if drawn is None or one.value is None or one.quantity == "closing":
                    continue
                scale = QUANTITIES[one.quantity].scale
                assert drawn * scale == pytest.approx(one.value, abs=AGREES.get(one.unit, 0.1))


@pytest.mark.parametrize("name", CAPTURES)
def test_the_leaves_of_a_derivation_are_facts_of_the_observation(name: str):
    seen, every = told(name)
    facts = {str(fact) for fact in seen.observation.facts}
    kinds = {type(fact).predicate for fact in seen.observation.facts if isinstance(fact, Observed)}
    for each in every:
        leaves = [node for node in each.reason.walk() if not node.because]
        measured = [node.atom for node in leaves if parsed(node.atom)[0] in kinds]
        assert measured
        assert {*measured} <= facts


def test_the_same_capture_is_explained_in_the_same_words():
    one, other = (explained(CAPTURES["drink_from_mug"](), rules=profile()) for _ in range(2))
    assert one.explain(one.observation.segments) == other.explain(other.observation.segments)
    first, second = one.observation.segments[1:3]
    assert one.explain([first, second]) == (*one.explain([first]), *one.explain([second]))


def test_what_flickers_and_decides_is_noted_and_nothing_where_nothing_flickers():
    capture = motions.touch_cycle(motions.WOMAN).capture
    plain = measure(capture).facts
    noted = []
    for facts in (steady(flickering(plain, capture.rate_hz)), plain):
        (link,) = infer(facts, profile=profile()).links
        every = Explainer(facts, profile()).explain_all(link.segments)
        noted.append({each.name: each.notes for each in every})
    assert "flicker: " in noted[0]["Touch"][0]
    assert not any(noted[1].values())


def test_an_unknown_segment_is_explained_by_how_far_it_agreed():
    capture = motions.slide_object(motions.TALL_MAN).capture
    facts = [each for each in measure(capture).facts if not isinstance(each, ZeroCrossing)]
    crossings = [ZeroCrossing("right_hand", frame) for frame in (0, 227)]
    rules = profile("thesis")
    (link,) = infer((*facts, *crossings), profile=rules).links
    explainer = Explainer((*facts, *crossings), rules)
    unknown = [each for each in link.segments if not each.known]
    assert unknown
    for segment in unknown:
        found = explainer.explain(segment)
        assert found.summary.startswith("Unknown because no known primitive agrees with it")
        assert found.conditions
