"""Levin's classes, the thesis's claims, and what rule files state of words."""

import csv
import os
import re
from functools import cache
from pathlib import Path

import pytest

from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.lexicon.links import (
    above,
    book_order,
    class_links,
    levin_classes,
    sense_key,
    sense_links,
    thesis_claims,
)
from kb.lexicon.verbs import doubts, doubts_of
from kb.lexicon.wordnet import table, wordnet
from kb.reports.linguistics import unstated_classes

SHARED = Path(os.environ.get("CAPAR_LINGUISTICS", Path(__file__).parents[4] / "shared/linguistics"))
needs_shared = pytest.mark.skipif(
    not SHARED.is_dir(), reason=f"no folder {SHARED}; CAPAR_LINGUISTICS names another"
)


def test_classes_stand_in_the_books_order_below_known_ones() -> None:
    numbers = list(levin_classes())
    assert numbers == sorted(numbers, key=book_order)
    assert sum(bool(each.size) for each in levin_classes().values()) == 191
    assert list(above("40.3.1")) == ["40.3", "40"]
    assert levin_classes()["9.10"].title == "Pocket Verbs"


@pytest.mark.parametrize("name", ["thesis_claims", "motion_classes", "needs"])
def test_a_table_names_only_known_classes(name: str) -> None:
    for row in table(name):
        assert not row["class"] or row["class"] in levin_classes()


@needs_shared
def test_the_classes_left_unmentioned_are_the_listed_ones() -> None:
    listed = (SHARED / "thesis_unstated_classes.txt").read_text().split()
    assert set(unstated_classes()) == set(listed)


@needs_shared
def test_every_quoted_sentence_is_the_theses_own() -> None:
    with (SHARED / "thesis_levin_capability.tsv").open(encoding="utf-8") as file:
        sentences = " ".join(row["quote"] for row in csv.DictReader(file, delimiter="\t"))
    for claim in thesis_claims():
        assert claim.quote in sentences


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


def cover(folder: Path, stated: str) -> Path:
    path = folder / "cover.lp"
    path.write_text(f'%* Cover: over all of it. *%\nprimitive("Cover").\n{stated}\n')
    return path


def test_each_unknown_is_told_with_what_is_near_it() -> None:
    verb, levin, sense = doubts("coverr", ("9.1", "99.9"), ("77",))
    assert verb.startswith("WordNet has no verb 'coverr'; the nearest are cover")
    assert levin.startswith("Levin has no class '99.9'; the nearest is 9.9")
    assert sense == "WordNet has no sense 77 of 'coverr'"


def test_nothing_that_ships_is_in_doubt() -> None:
    assert doubts_of(primitive_words(primitive_files())) == ()


def test_a_sense_is_stated_by_its_number_or_its_key(tmp_path: Path) -> None:
    (number,) = primitive_words([cover(tmp_path, 'verb("Cover", "cover"). sense("Cover", 2).')])
    assert [each.key for each in sense_links(number)] == ["cover%2:35:01::"]
    text = 'verb("Cover", "cover"). sense("Cover", "cover%2:35:01::").'
    (key,) = primitive_words([cover(tmp_path, text)])
    assert sense_links(key) == sense_links(number)
