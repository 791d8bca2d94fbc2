"""Forms of words: pasts from data and by rule, names as nouns, lists."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kb.lexicon.english import name_of, number, past, the_agent, words_of


@pytest.mark.parametrize(
    ("verb", "form"),
    [
        ("drink", "drank"),
        ("put", "put"),
        ("let go of", "let go of"),
        ("reach for", "reached for"),
        ("move", "moved"),
        ("carry", "carried"),
        ("stay", "stayed"),
        ("stir", "stirred"),
        ("pick up", "picked up"),
        ("withdraw", "withdrew"),
    ],
)
def test_a_verb_has_its_past(verb: str, form: str) -> None:
    assert past(verb) == form


@pytest.mark.parametrize(
    ("name", "kind", "told"),
    [
        ("anna", "woman", "Anna"),
        ("anna_maria", "person", "Anna Maria"),
        ("Anna", "woman", "Anna"),
        ("woman", "woman", "the woman"),
        ("tall_man", "man", "the tall man"),
        ("performer", "person", "the performer"),
        ("second_actor", "person", "the second actor"),
        ("welder", "welder", "the welder"),
        ("old_welder", "welder", "the old welder"),
        ("welder", "person", "Welder"),
        ("man_2", "man", "man 2"),
    ],
)
def test_who_acts_has_an_article_only_with_a_word_for_people(
    name: str, kind: str, told: str
) -> None:
    assert the_agent(name, kind) == told


@given(st.lists(st.from_regex(r"[a-z]{2,8}", fullmatch=True), min_size=1, max_size=4))
def test_words_make_a_name_that_gives_them_back(words: list[str]) -> None:
    text = " ".join(words)
    assert words_of(name_of(text)) == text


@given(st.integers(0, 99))
def test_numbers_below_a_hundred_are_words_and_no_two_the_same(count: int) -> None:
    assert re.fullmatch(r"[a-z]+(-[a-z]+)?", number(count))
    assert all(number(count) != number(other) for other in range(100) if other != count)
    assert [number(each) for each in (12, 20, 99, 100)] == [
        "twelve",
        "twenty",
        "ninety-nine",
        "100",
    ]
