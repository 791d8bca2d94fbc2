"""Summaries say true numbers, and contrast a name with neighbours that the segment has not."""

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from recomputed import STORIES, Known, told
from recomputed.summaries import Fragment, fragments

from capar_rules.borders.border_numbers import number_borders
from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import solve

pytestmark = pytest.mark.long

CONTRAST = re.compile(
    r"\bNot (\w+(?:, \w+)*(?: or (?:its kinds? )?\w+(?:, \w+)*(?: and \w+)?)?), "
    r"(?:because|though) "
)
"""The names of a contrast."""

BESIDE = re.compile(r"^\w+(?:, a kind of \w+(?: and \w+)?)?, and not ([\w, ]+?), because ")
"""The names that are denied for the same reasons as the name is given."""


@cache
def numbered(name: str) -> tuple[tuple[Known, Fragment], ...]:
    """What the summaries of a story tell with numbers."""
    story = told(name)
    return tuple(
        (known, each)
        for known, found in zip(story.known, story.explanations, strict=True)
        if " taken " not in found.summary  # what was mended is told in the sentences of the tree
        for each in fragments(known, found.summary)
    )


def contrasted(summary: str) -> Iterator[str]:
    """The names that a summary says the segment has not."""
    for found in (*CONTRAST.finditer(summary), *BESIDE.finditer(summary)):
        yield from filter(None, re.split(r",? or (?:its kinds? )?| and |, ", found[1]))


@pytest.mark.parametrize("name", STORIES)
def test_every_number_in_a_summary_is_true(name: str) -> None:
    for known, each in numbered(name):
        assert each.holds(known), f"{known.segment.ee}/{known.segment.index}: {each}"


@pytest.mark.parametrize("name", STORIES)
def test_a_segment_fits_no_name_that_its_summary_denies(name: str, tmp_path: Path) -> None:
    story = told(name)
    rules = profile(STORIES[name].rules)
    shown = tmp_path / "shown.lp"
    shown.write_text("#show fits/2.\n")
    facts = story.seen.observation.facts
    borders = number_borders(facts, crossings_only=rules.crossings_only)
    fitting = {
        (str(term[1]), int(term[2]), str(what))
        for term, what in solve((*rules.files, shown), (*facts, *borders)).of("fits")
        if isinstance(term, tuple)
    }
    for known, found in zip(story.known, story.explanations, strict=True):
        first, _ = story.seen.explainer.ticks(known.segment)
        denied = {(known.segment.ee, first, each) for each in contrasted(found.summary)}
        assert not denied & fitting
        assert not known.segment.known or (known.segment.ee, first, found.name) in fitting


def test_nearly_every_name_is_contrasted_with_another_or_told_of_which_kind_it_is() -> None:
    summaries = [
        each.summary
        for name in STORIES
        for each in told(name).explanations
        if each.name != "Unknown"
    ]
    said = re.compile(rf"{CONTRAST.pattern}|, and not |[Ii]t is a kind of |, a kind of ")
    bare = [summary for summary in summaries if not said.search(summary)]
    assert len(bare) <= len(summaries) // 20, bare


def test_no_recomputation_of_a_number_accepts_another_one() -> None:
    """Where each number of a part is several times as great, the part is false."""
    for name in STORIES:
        for known, each in numbered(name):
            other = tuple(re.sub(r"\d+(?:\.\d+)?", _greater, text) for text in each.told)
            wrong = Fragment(each.body, each.text, each.check, other)
            assert other == each.told or not wrong.holds(known), wrong


def _greater(number: re.Match[str]) -> str:
    return f"{3.0 * float(number[0]) + 7.0:.{2 * ('.' in number[0])}f}"
