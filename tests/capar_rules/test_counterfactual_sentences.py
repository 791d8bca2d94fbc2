"""Each change that can be counted is told in both moods, in words and not as an atom."""

import re
from itertools import product

import pytest

from capar_rules.engine.profiles import profile
from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.clock import Clock
from capar_rules.explain.counterfactuals import counted
from capar_rules.explain.explanation import rule_base
from capar_rules.lint.audit import words_of

BASE = rule_base(profile())
CLOCK = Clock(100.0, {"hand": [0, 50, 100]}, {("hand", 1): 2}, objects={"seg(hand,1)": "mug"})
VALUES = {
    "Segment": "seg(hand,1)",
    "Side": "end",
    "Hand": "hand",
    "Object": "mug",
    "To": "2",
    "Frame": "100",
}
COURSES = "up", "up_near", "down", "down_near", "aside", "aside_down", "near", "little"
BOTH = "had", "had not"


def heads() -> list[tuple[str, tuple[str, ...]]]:
    """What the free relations can be, one for each of the constants in a pool."""
    found = []
    for word in words_of(BASE.statements):
        for head in word.heads:
            if head.signature not in counted([word]) or head.signature == ("tag", 2):
                continue
            pools = [each.strip("()").split(";") for each in split_arguments(head.text)]
            told = [[VALUES.get(one, one.lower()) for one in pool] for pool in pools]
            found += [(head.signature[0], each) for each in product(*told)]
    return sorted(set(found))


OF_CHANGES = [
    *((mood, "reads", ("hand", "1", "mug", "head", "any")) for mood in BOTH),
    *((mood, "held", ("hand", "mug")) for mood in BOTH),
    *((mood, "moved", ("mug", "seg(hand,1)")) for mood in BOTH),
    ("had", "since", ("hand", "hand", "mug", "50")),
    *(("had", "course", ("seg(hand,1)", "mug", course)) for course in COURSES),
]


@pytest.mark.parametrize(
    ("mood", "name", "arguments"),
    [*((mood, *head) for head in heads() for mood in BOTH), *OF_CHANGES],
)
def test_a_change_has_a_sentence_in_its_mood(mood: str, name: str, arguments: tuple[str, ...]):
    told = BASE.sentences.tell(name, arguments, CLOCK, mood=mood)
    assert told.startswith("had ")
    assert not re.search(r"[_({]|\bseg\b|\bobject\b", told), told


def test_the_relations_that_are_free_are_known():
    names = {name for name, _ in heads()}
    assert {"on", "against", "lies_at", "throws", "struck"} <= names
    assert len(heads()) > 25
