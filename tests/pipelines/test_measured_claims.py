"""A picture of a summary shows the numbers that it tells, where they were measured."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recomputed import STORIES, told
from recomputed.summaries import VERBS

from capar.pipelines.explanation import Explained
from capar.pipelines.measured.claims import (
    draw_claims,
    measured_panels,
    measured_rows,
    shown_span,
)
from capar.pipelines.measured.recording import Recording
from capar.pipelines.measured.rows import claimed_rows
from capar.views.movers import mover_lines
from capar.views.panels import Mark, Panel
from capar_rules.borders.ticks import constants
from capar_rules.explain.claimed_measures import ARRANGED, FORMS, PREDICATES, Measure
from capar_rules.explain.explanation import Explanation
from capar_rules.explain.formatting import OF_BODIES

pytestmark = pytest.mark.long

NAMES = (
    "carry",
    "tilt",
    "turn",
    "pour",
    "stir",
    "shake",
    "slide",
    "hand_over",
    "throw",
    "put_down",
)

NUMBER = re.compile(r"\d+(?:\.\d+)? (?:mm/s|mm|cm|m)\b|\d+(?:\.\d)?°|\d+ %")
"""A number with a unit that a panel can have."""

ROUNDED = {"mm/s": 0.5, "mm": 0.5, "cm": 0.5, "m": 0.05, "°": 0.6, "%": 0.5}
"""Half of the last place that is told, in the unit that is told."""

SCALES = {
    ("cm", "mm"): 10.0,
    ("cm", "cm"): 1.0,
    ("cm", "m"): 0.01,
    ("mm", "cm"): 0.1,
    ("mm", "m"): 0.001,
}
"""By the unit of a panel and of a number in it: what the first is multiplied by."""


def pictured(name: str) -> Iterator[tuple[Explained, Explanation, tuple[Panel, ...]]]:
    story = told(name)
    for explanation in story.explanations:
        yield story.seen, explanation, measured_panels(story.seen, explanation)


@pytest.mark.parametrize("name", NAMES)
def test_each_number_of_a_clause_stands_in_a_panel_of_that_clause(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Other panels of the picture may show the same number by chance, of another quantity."""
    monkeypatch.setattr("capar.pipelines.distances.SAMPLES", 2)  # distances take long
    count = 0
    story = told(name)
    for explanation in story.explanations:
        first, last = shown_span(story.seen, explanation)
        for claim in explanation.claims:
            alone = replace(explanation, claims=(claim,))
            shown = " ".join(
                text
                for panel in measured_panels(story.seen, alone)
                for text in (
                    panel.title,
                    *(limit.label for limit in panel.limits),
                    *(mark.label for mark in panel.marks),
                )
            )
            assert all(first <= frame <= last for frame in claim.frames)
            numbers = NUMBER.findall(claim.text) if claim.quantities else []
            for number in numbers:
                assert re.search(rf"(?<![\d.]){re.escape(number)}", shown), claim.text
            count += len(numbers)
    assert count


@pytest.mark.parametrize("name", NAMES)
def test_each_marked_number_lies_on_a_curve_within_what_is_drawn(name: str) -> None:
    for _, explanation, panels in pictured(name):
        for panel in panels:
            low, high = panel.range(explanation.start_s, explanation.end_s)
            for one in (*panel.limits, *panel.marks):
                assert low < one.value < high
            for mark in panel.marks:
                if mark.value >= panel.highest:
                    continue  # its curve is cut off
                slack = 0.51 if panel.unit == "mm/s" else 1e-6
                assert min(off(curve.times, curve.values, mark) for curve in panel.curves) < slack
                assert reads_as_told(mark, panel.unit), mark


def off(times: np.ndarray, values: np.ndarray, mark: Mark) -> float:
    """How far a mark is from a curve at its time."""
    known = np.isfinite(values)
    return abs(float(np.interp(mark.time, times[known], values[known])) - mark.value)


def reads_as_told(mark: Mark, unit: str) -> bool:
    """Whether a mark's label is its value to rounding; its sign is told in words."""
    found = NUMBER.search(mark.label)
    if found is None:
        return mark.label in ("", "halt")
    number, told_unit = re.fullmatch(r"([\d.]+) ?(\D+)", found[0]).groups()
    value = abs(mark.value) * SCALES.get((unit, told_unit), 1.0)
    if mark.label.startswith("less than"):
        return value < float(number)
    if "at most" in mark.label:
        return 0.0 <= float(number) - value + 1e-6 <= 0.1 + 1e-5
    slack = 0.1 if told_unit == "cm" else 1.0 if told_unit == "mm" else 0.01
    return abs(value - float(number)) <= ROUNDED[told_unit] + slack


def test_a_segment_is_told_by_its_conditions_whatever_its_name() -> None:
    """The panels follow from the clauses: another name, and the same claims, the same panels."""
    story = told("carry")
    for explanation in story.explanations:
        renamed = replace(explanation, name="Anything")
        assert titles(story.seen, renamed) == titles(story.seen, explanation)


def titles(seen: Explained, explanation: Explanation) -> list[str]:
    return [panel.title for panel in measured_panels(seen, explanation)]


def test_every_quantity_is_claimed_by_some_clause_and_has_a_panel() -> None:
    claimed = {measure for measures in FORMS.values() for measure in measures}
    claimed |= {measure for measured in PREDICATES.values() for measure, _ in measured}
    claimed |= {measure for measures in ARRANGED.values() for measure in measures}
    assert claimed == set(Measure)
    assert set(FORMS) - set(OF_BODIES) == {"away", "back"}


FURNITURE = re.compile(
    r"[A-Z]\w+(?:, a kind of [\w ]+)?, and not [\w, ]+?(?=, though)|"
    r"the rules say so|[A-Z]\w+(?:, a kind of [\w ]+)?(?:, and not [\w, ]+)?, because |"
    r"It is a kind of [\w, ]+?, because |"
    r"[Nn]ot \w+(?:, \w+)*(?:,? or (?:its kinds? )?\w+(?:, \w+)*(?:,? and \w+)?)?|"
    r", though|, because |,? and at the end|"
    r"(?:A shape is|Shapes are) assumed for [^.]*(?:\.\d+[^.]*)*, so contact is known only "
    r"roughly\.|"
    r"Contact is counted (?:within|from) \d+ mm[^.]*\.|\band\b|\bor\b|[,;. ]"
)
"""What a summary says beside its clauses: names, and what joins clauses; and up to which distance
bodies count as touching, which stands in the panels of their distances."""


@pytest.mark.parametrize("name", STORIES)
def test_whatever_a_summary_says_is_a_claim_that_is_drawn(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each clause has a panel or a row of bars, and nothing is said but clauses."""
    monkeypatch.setattr("capar.pipelines.distances.SAMPLES", 2)  # distances take long
    story = told(name)
    for explanation in story.explanations:
        known = Recording(story.seen, shown_span(story.seen, explanation))
        for claim in explanation.claims:
            alone = replace(explanation, claims=(claim,))
            drawn = [*measured_panels(story.seen, alone), *claimed_rows(known, [claim])]
            assert drawn, claim.text
        assert not unclaimed(explanation), explanation.summary


def unclaimed(explanation: Explanation) -> str:
    """What a summary says that is neither a clause nor joins clauses.

    The subject of a clause may stand once for several.
    """
    rest = explanation.summary
    for claim in sorted(explanation.claims, key=lambda claim: -len(claim.text)):
        words = claim.text.split(" ")
        for first in range(len(words)):
            part = " ".join(words[first:])
            shorter = re.sub(re.escape(part), ";", rest, flags=re.IGNORECASE)
            if shorter != rest:
                rest = shorter
                break
    for claim in explanation.claims:  # what stands behind its subject once, and once behind another
        own = re.sub(rf"^the [\w ]+? (?=(?:{VERBS})\b)", "", claim.text)
        rest = re.sub(re.escape(own), ";", rest, flags=re.IGNORECASE)
    return re.sub(r"\bthe(?: \w+)+?(?= ?;)", "", FURNITURE.sub(lambda part: ";", rest)).strip("; ")


@pytest.mark.parametrize("name", NAMES)
def test_contact_throughout_is_told_with_a_bound_of_every_distance_drawn(name: str) -> None:
    story = told(name)
    count = 0
    for explanation in story.explanations:
        for claim in explanation.claims:
            if not claim.quantities or not re.search(r"\bthroughout(?! but for)", claim.text):
                continue
            alone = replace(explanation, claims=(claim,))
            bodies = next(part.bodies for part in claim.quantities)
            reach = story.seen.explainer.measured.reaches[bodies[0], bodies[1]]
            beyond = re.search(r"at moments up to (\d+(?:\.\d)?) mm apart", claim.text)
            most = float(beyond[1]) + 0.5 if beyond else reach.told_mm
            for panel in measured_panels(story.seen, alone):
                (curve,) = panel.curves
                times = curve.times
                inside = (times >= explanation.start_s) & (times <= explanation.end_s)
                assert curve.values[inside].max() <= most + 1e-6, claim.text
                count += 1
    assert count


@pytest.mark.parametrize("name", NAMES)
def test_each_mover_that_a_line_names_has_bars(name: str) -> None:
    story = told(name)
    for explanation in story.explanations:
        about = story.seen.observation, explanation.ee, explanation.index
        labels = " ".join(row.label for row in measured_rows(story.seen, explanation))
        for line in mover_lines(*about):
            for who in re.findall(r"by the ([\w ]+?)(?= all the time| for |,|;|\.| and )", line):
                assert f"by the {who}" in labels, line


@pytest.mark.parametrize("name", NAMES)
def test_what_holds_is_drawn_once(name: str) -> None:
    for seen, explanation, panels in pictured(name):
        here = [panel for panel in panels if panel.span_s is None]
        bars = [panel.held for panel in here if panel.held and panel.bars]
        rows = [row.held for row in measured_rows(seen, explanation, panels) if row.held]
        shown = [*bars, *rows]
        assert len(shown) == len(set(shown)), shown


@pytest.mark.parametrize("name", NAMES)
def test_only_rests_that_are_long_enough_are_drawn(name: str) -> None:
    for seen, _, _ in pictured(name):
        known = Recording(seen, (0, seen.observation.frames - 1))
        for hand in {segment.ee for segment in seen.observation.segments}:
            for rest in known.rests(hand):
                assert rest.end_s - rest.start_s >= constants()["rest_ms"] / 1000.0 - 1e-9
        break


def test_a_picture_is_written_in_each_format(tmp_path: Path) -> None:
    story = told("carry")
    for suffix, start in ((".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF")):
        path = tmp_path / f"a{suffix}"
        draw_claims(story.seen, story.explanations[1], path)
        assert path.read_bytes().startswith(start)
