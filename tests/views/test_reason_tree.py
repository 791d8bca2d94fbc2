"""The tree of reasons tells each thing once, and joint actions and looks as they were observed."""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

import pytest
from recomputed import STORIES, told
from recomputed.known import TIME

from capar.model.observation import JointAction, Observation
from capar.views.reason_tree import ABOVE, ALSO_ABOVE, note, reason_tree, spoken_texts
from capar.views.reasons import reasons_svg
from capar_rules.explain.explanation import Explanation, Reason

pytestmark = pytest.mark.long

JOINT = re.compile(rf"it is part of one action of (.+): (\w+), from {TIME} to {TIME}")

LOOK = re.compile(rf"the [\w ]+ looked at the [\w ]+ from {TIME} to {TIME}")


def trees(name: str) -> Iterator[tuple[Observation, Explanation, Reason]]:
    story = told(name)
    for explanation in story.explanations:
        observation = story.seen.observation
        yield observation, explanation, reason_tree(explanation, observation)


@pytest.mark.parametrize("name", STORIES)
def test_each_sentence_stands_once_and_none_is_lost(name: str) -> None:
    for _, explanation, tree in trees(name):
        told_once = Counter(node.sentence for node in tree.walk())
        assert max(told_once.values()) == 1
        beside = ("joins_in(", "looks(")
        kept = [cause for cause in explanation.reason.because if not cause.atom.startswith(beside)]
        for cause in kept:
            for node in cause.with_sentences().walk():
                assert not node.sentence or node.sentence in told_once


@pytest.mark.parametrize("name", STORIES)
def test_a_line_says_that_reasons_of_it_stand_above(name: str) -> None:
    for _, explanation, tree in trees(name):
        whole: dict[str, int] = {}
        for node in explanation.reason.with_sentences().walk():
            whole[node.sentence] = max(whole.get(node.sentence, 0), len(node.because))
        for node in tree.walk():
            if node is tree or node.atom.startswith("looks("):
                continue
            left_out = whole.get(node.sentence, 0) > len(node.because)
            above = ALSO_ABOVE if node.because else ABOVE
            assert note(node).endswith(above) == left_out, node.sentence


@pytest.mark.parametrize("name", STORIES)
def test_joint_actions_are_those_that_were_observed(name: str) -> None:
    for observation, explanation, tree in trees(name):
        own = explanation.ee, explanation.index
        found = [JOINT.fullmatch(node.sentence) for node in tree.because]
        joint = {(at[2], at[3], at[4]) for at in found if at}
        assert joint == {
            (one.name, f"{one.start_s:.2f}", f"{one.end_s:.2f}")
            for one in observation.joint
            if own in zip(one.ees, one.segments, strict=True)
        }


@pytest.mark.parametrize("name", STORIES)
def test_that_something_was_looked_at_rests_on_measured_looks(name: str) -> None:
    for _, _, tree in trees(name):
        for node in tree.because:
            if "was looked at" in node.sentence:
                assert node.because
                assert all("looked at the" in look.sentence for look in node.because)


def test_one_segment_alone_is_called_the_segment() -> None:
    for name in STORIES:
        for _, explanation, tree in trees(name):
            span = f"{explanation.start_s:.2f} s and {explanation.end_s:.2f} s"
            spans = [
                node.sentence
                for node in tree.walk()
                if node.sentence.startswith("the segment lies between")
            ]
            assert set(spans) <= {f"the segment lies between {span}"}, (name, spans)


def test_some_story_has_joint_actions_and_looks_before_a_segment() -> None:
    sentences = {
        node.sentence for name in STORIES for *_, tree in trees(name) for node in tree.walk()
    }
    assert any(JOINT.fullmatch(sentence) for sentence in sentences)
    assert any("in the segment before this one" in sentence for sentence in sentences)


def test_of_many_joint_actions_of_one_name_the_longest_is_told() -> None:
    story = told("carry")
    observation, explanation = story.seen.observation, story.explanations[1]
    joint = tuple(
        JointAction(
            "Lift",
            ("mug",),
            tuple(sorted((explanation.ee, *"abcde"[:count]))),
            (explanation.index,) * (count + 1),
            10,
            10 + 10 * count,
            0.1,
            0.1 + 0.1 * count,
        )
        for count in (2, 5, 3)
    )
    tree = reason_tree(explanation, replace(observation, joint=joint))
    sentences = [node.sentence for node in tree.because if "it is part of" in node.sentence]
    assert sentences == [
        "it is part of 3 actions of 3 to 6 end-effectors each; the longest, of the a, the b and 4 "
        "more: Lift, from 0.10 s to 0.60 s"
    ]
    pair = reason_tree(explanation, replace(observation, joint=joint[:2]))
    sentences = [node.sentence for node in pair.because if "it is part of" in node.sentence]
    assert sentences[0] == (
        "it is part of one action of the a, the b and the right hand: Lift, from 0.10 s to 0.30 s"
    )
    assert len(sentences) == 2


def test_reservations_are_not_of_who_looked_or_acts_as_well() -> None:
    for name in STORIES:
        for *_, tree in trees(name):
            spoken = list(spoken_texts(tree))
            assert not any(JOINT.fullmatch(sentence) for sentence in spoken)
            assert not any(LOOK.fullmatch(sentence) for sentence in spoken)
            assert tree.sentence in spoken


def test_the_drawn_tree_has_the_same_lines() -> None:
    story = told("carry")
    explanation = story.explanations[0]
    drawn = reasons_svg([explanation], story.seen.observation)
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", drawn))
    for node in reason_tree(explanation, story.seen.observation).walk():
        assert node.sentence.split()[-1] in text
