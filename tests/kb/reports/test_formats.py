"""Each format shows the whole report, and can be read by what reads such files."""

import csv
import io
import json

import pytest

from capar.model.errors import UnknownNameError
from capar.pipelines.linguistic_report import linguistics
from kb.reports.formats import FORMATS, write
from kb.reports.linguistics import LinguisticReport


@pytest.fixture(scope="module")
def report() -> LinguisticReport:
    return linguistics()


@pytest.mark.parametrize("form", FORMATS)
def test_every_format_is_the_same_each_time_and_names_every_class(
    report: LinguisticReport, form: str
) -> None:
    text = write(report, form)
    assert text == write(linguistics(), form)
    assert text.endswith("\n")
    for each in report.classes:
        assert each.number in text


def test_the_table_of_verbs_is_csv(report: LinguisticReport) -> None:
    rows = list(csv.DictReader(io.StringIO(write(report, "csv"))))
    assert len(rows) == sum(len(each.verbs) for each in report.classes)
    touch = next(row for row in rows if (row["class"], row["verb"]) == ("20", "touch"))
    assert touch["system"] == "addressed: by rule only"
    assert touch["class: thesis"] == "direct, not"


def test_json_holds_the_values(report: LinguisticReport) -> None:
    value = json.loads(write(report, "json"))
    assert [each["number"] for each in value["classes"]] == [e.number for e in report.classes]
    assert value["coverage"]["classes"] == len(report.classes)


def test_an_unknown_format_is_answered_with_the_known(report: LinguisticReport) -> None:
    with pytest.raises(UnknownNameError, match="html"):
        write(report, "pdf")
