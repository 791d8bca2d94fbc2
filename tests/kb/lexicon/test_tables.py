"""The shipped tables agree with each other, and with the facts that they were made from."""

import csv
import os
from pathlib import Path

import pytest

from kb.lexicon.links import (
    ThesisStatus,
    above,
    book_order,
    levin_class,
    levin_classes,
    remarks,
    thesis_claims,
)
from kb.lexicon.wordnet import FOLDER, table
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
    assert levin_class("9.10").title == "Pocket Verbs"


@pytest.mark.parametrize("name", ["thesis_claims", "motion_classes", "needs"])
def test_a_table_names_only_known_classes(name: str) -> None:
    for row in table(name):
        assert not row["class"] or row["class"] in levin_classes()


def test_each_claim_has_its_sentence_and_reason() -> None:
    assert len(thesis_claims()) == 24
    for claim in thesis_claims():
        assert claim.quote
        assert claim.reason
        assert claim.section in {"6", "6.1", "6.3"}


def test_the_claims_say_what_the_thesis_says() -> None:
    said = {(claim.levin, verb): claim.status for claim in thesis_claims() for verb in claim.verbs}
    direct = {key for key, status in said.items() if status is ThesisStatus.DIRECT}
    assert {("20", "touch"), ("40.3", "clap"), ("18.1", "hit"), ("39.1", "drink")} <= direct
    assert said["17.1", "throw"] is ThesisStatus.EXTENSION
    assert said["13.5.1", "catch"] is ThesisStatus.NOT


def test_disagreements_stand_as_remarks() -> None:
    assert {"rest", "pick", "clap", "kick", "reach"} <= {each.verb for each in remarks()}


def test_the_licence_lies_beside_the_words() -> None:
    notice = (FOLDER / "LICENSE.WordNet.txt").read_text(encoding="utf-8")
    assert "WordNet 3.1 Copyright 2011 by Princeton University" in notice
    assert "Creative Commons Attribution 4.0" in notice


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
