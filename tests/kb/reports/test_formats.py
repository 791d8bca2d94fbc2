"""Each format shows the whole report, and can be read by what reads such files."""

import csv
import io
import json
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

from capar.model.errors import UnknownNameError
from capar.pipelines.linguistic_report import linguistics
from kb.reports.formats import FORMATS, write
from kb.reports.linguistics import LinguisticReport

PDFLATEX = shutil.which("pdflatex")


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


def test_the_drawing_is_svg_with_a_box_for_each_status(report: LinguisticReport) -> None:
    root = ElementTree.fromstring(write(report, "svg"))
    rects = [each.get("class") for each in root.iter("{http://www.w3.org/2000/svg}rect")]
    assert {"direct", "extension", "not"} == set(rects)
    texts = " ".join(each.text or "" for each in root.iter("{http://www.w3.org/2000/svg}text"))
    assert "blink, point, squint" in texts


def test_latex_leaves_no_sign_of_its_own_unescaped(report: LinguisticReport) -> None:
    for line in write(report, "latex").splitlines():
        if line.startswith("\\"):
            continue
        assert not re.search(r"(?<!\\)[%#$_]", line)


@pytest.mark.skipif(PDFLATEX is None, reason="no pdflatex on this machine")
def test_latex_compiles_and_no_cell_prints_over_another(
    report: LinguisticReport, tmp_path: Path
) -> None:
    assert PDFLATEX is not None
    (tmp_path / "report.tex").write_text(write(report, "latex"), encoding="utf-8")
    done = subprocess.run(
        [PDFLATEX, "-interaction=nonstopmode", "-halt-on-error", "report.tex"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:]
    assert (tmp_path / "report.pdf").stat().st_size > 10_000
    log = (tmp_path / "report.log").read_text(encoding="latin-1")
    wide = [float(each) for each in re.findall(r"Overfull \\hbox \(([0-9.]+)pt too wide", log)]
    assert not [each for each in wide if each > 1.0], log


def test_an_unknown_format_is_answered_with_the_known(report: LinguisticReport) -> None:
    with pytest.raises(UnknownNameError, match="html"):
        write(report, "pdf")
