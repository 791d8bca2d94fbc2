"""Each primitive stands in the classes and senses that were judged to be its own."""

import os
import re
from functools import cache
from pathlib import Path

import pytest

from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.lexicon.links import class_links, levin_classes, sense_key, sense_links, thesis_claims
from kb.lexicon.wordnet import table, wordnet

WORDS = {each.name: each for each in primitive_words(primitive_files())}
JUDGED = table("judged_senses")
DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[4] / "shared/data"))
VERBNET = DATA.parent / "linguistics" / "verbnet-3.4"
UNLISTED = {("HandOver", "13.1"), ("Withdraw", "51.1")}
"""Classes of a primitive whose verb VerbNet 3.4 does not list there."""


@cache
def _members(verbnet: str) -> frozenset[str]:
    text = (VERBNET / f"{verbnet}.xml").read_text(encoding="utf-8")
    return frozenset(re.findall(r'<MEMBER\b[^>]*?\bname="([^"]+)"', text, re.DOTALL))


def _lists(number: str, verb: str) -> bool:
    return any(verb in _members(each) for each in levin_classes()[number].verbnet)


@pytest.mark.parametrize("name", WORDS)
def test_a_primitive_has_the_senses_and_classes_that_were_judged(name: str) -> None:
    """The table judges it, or its own rule file, by ``sense`` and ``levin`` beside the verb."""
    words = WORDS[name]
    rows = [row for row in JUDGED if row["primitive"] == name]
    if words.senses and not rows:
        synsets = [wordnet().of_key(sense_key(words.verbs[0], stated)) for stated in words.senses]
        assert all(words.verbs[0] in synset.lemmas for synset in synsets)
        assert set(words.levin) <= set(levin_classes())
        return
    assert [link.key for link in sense_links(WORDS[name])] == [row["key"] for row in rows]
    classes = tuple(each for each in class_links(WORDS[name])[0] if each)
    assert all(tuple(row["classes"].split()) == classes for row in rows)


@pytest.mark.parametrize("row", JUDGED, ids=lambda row: f"{row['primitive']} {row['key']}")
def test_a_judged_sense_has_the_gloss_by_which_it_was_judged(row: dict[str, str]) -> None:
    synset = wordnet().of_key(row["key"])
    assert synset.definition == row["gloss"]
    assert row["verb"] in synset.lemmas
    assert (
        str(next(each.number for each in synset.senses if each.key == row["key"]))
        == (row["number"])
    )


@pytest.mark.parametrize(
    ("name", "number", "because"),
    [
        ("Turn", "26.6", "that class is of transformation"),
        ("Shake", "22.3", "that class is of combining"),
        ("Give", "13.1", "one person may give from hand to hand"),
        ("Receive", "13.5.2", "one person may receive from hand to hand"),
        ("Reach", "49", "Levin does not list reach there"),
        ("PostureChange", "49", "Levin does not list move there"),
    ],
)
def test_a_primitive_stands_in_no_class_that_means_something_else(
    name: str, number: str, because: str
) -> None:
    assert number not in class_links(WORDS[name])[0], because


def test_rest_is_a_verb_of_spatial_configuration() -> None:
    named = {verb: claim.levin for claim in thesis_claims() for verb in claim.verbs}
    assert named["rest"] == "9.2"


def test_holding_is_no_carrying() -> None:
    assert "carry%2:35:01::" not in {link.key for link in sense_links(WORDS["Carry"])}


@pytest.mark.skipif(not VERBNET.is_dir(), reason=f"no VerbNet 3.4 in {VERBNET}")
def test_verbnet_lists_each_verb_in_the_class_that_we_give_it() -> None:
    rows = [(row["verb"], row["class"]) for row in table("motion_classes")]
    assert [row for row in rows if not _lists(row[1], row[0].replace(" ", "_"))] == []


@pytest.mark.skipif(not VERBNET.is_dir(), reason=f"no VerbNet 3.4 in {VERBNET}")
def test_verbnet_lists_the_verb_of_each_primitive_in_its_classes() -> None:
    missing = {
        (word.name, number)
        for word in WORDS.values()
        for number in class_links(word)[0]
        if number and not any(_lists(number, verb) for verb in word.verbs)
    }
    assert missing <= UNLISTED
