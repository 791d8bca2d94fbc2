"""The words of rules: each that a rule file may read is explained, or is of one file alone."""

import pytest

from capar_rules.authoring.glossary import Glossary, glossary, words_of_text
from capar_rules.engine.profiles import Profile, profile
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import parse
from capar_rules.lint.text_checks import AUTHORED, known

PROFILES = ("extended", "thesis")


@pytest.fixture(scope="module", params=PROFILES)
def base(request: pytest.FixtureRequest) -> Profile:
    return profile(request.param)


@pytest.fixture(scope="module")
def words(base: Profile) -> Glossary:
    return glossary(base)


def test_every_word_that_a_rule_file_may_use_is_explained_or_internal(base, words):
    rules = known(parse(base.files))
    explained = {each.signature for each in words.words if each.meaning.strip()}
    internal = {signature for _, signature in words.internal}
    assert (rules.heads | rules.inputs | set(AUTHORED)) <= explained | internal
    assert not explained & internal


def test_what_is_internal_is_read_within_its_own_file_alone(base, words):
    read: dict[tuple[str, int], set[str]] = {}
    for statement in parse(base.files):
        for literal in statement.body:
            for atom in literal.atoms:
                read.setdefault(atom.signature, set()).add(statement.place.file)
    for file, signature in words.internal:
        assert read.get(signature, set()) <= {str(rule_file(file))}, signature


def test_every_explanation_has_words_and_is_of_what_there_is(base, words):
    rules = known([each for name in PROFILES for each in parse(profile(name).files)])
    there = rules.heads | rules.inputs | set(AUTHORED)
    for each in words.words:
        assert len(each.meaning) > 3, each
        assert each.signature in there | {(name, 0) for name in rules.constants}, each


def test_the_forms_of_explanations_are_read():
    text = """%* Story: a concept.

   goes(Segment, Body)      it goes
                            on and on
   ends(Segment)            ... and it ends
   pair(Kind, f(A, B))   both
   Not an entry: words(like, these).
*%
#defined given/1.           % given(Body): by hand.
#defined stated/0.          % The user says so.
#const far_mm = 5.          % Too far [mm].
% near(Body): closer than that.
near(Body) :- given(Body).
"""
    told = {str(each): (each.line, each.meaning) for each in words_of_text(text, file="x.lp")}
    assert told == {
        "goes(Segment, Body)": (3, "it goes on and on"),
        "ends(Segment)": (5, "it goes on and on and it ends"),
        "pair(Kind, f(A, B))": (6, "both"),
        "given(Body)": (9, "by hand"),
        "stated": (10, "The user says so"),
        "far_mm": (11, "Too far [mm]; it is 5"),
        "near(Body)": (12, "closer than that"),
    }
