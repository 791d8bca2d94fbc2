"""An observation shows itself: in a terminal, in a notebook, and as data frames."""

import sys
from base64 import b64decode
from dataclasses import replace
from html.parser import HTMLParser
from io import StringIO
from xml.etree import ElementTree

import pandas as pd
import pytest
from observations import MUG, drink_from_mug, pick_up_with_both_hands
from rich.console import Console

from capar.cli import output
from capar.model.errors import CaparError
from capar.model.facts import Touching
from capar.views.tables import segments_table


class Page(HTMLParser):
    """What a page holds: its tags, the rows of its table, and where its pictures come from."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.rows: list[list[str]] = []
        self.sources: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        self.sources += [value or "" for name, value in attrs if name in ("src", "href")]

    def handle_data(self, data: str) -> None:
        if self.tags and self.tags[-1] in ("td", "th"):
            self.rows[-1][-1] += data


def test_a_notebook_shows_a_row_a_segment_and_a_picture_that_is_part_of_the_page() -> None:
    seen = drink_from_mug()
    page = Page(seen._repr_html_())
    assert len(page.rows) == 1 + len(seen.segments)
    names = [row[page.rows[0].index("name")] for row in page.rows[1:]]
    assert names == [each.name for each in seen.segments]
    (source,) = page.sources
    head, _, data = source.partition(",")
    assert head == "data:image/svg+xml;base64"
    assert ElementTree.fromstring(b64decode(data)).tag.endswith("svg")


def test_nothing_in_a_capture_becomes_markup() -> None:
    bad = "<script>alert(1)</script>"
    seen = drink_from_mug()
    odd = replace(seen, capture=bad, objects=(replace(MUG, assumed=bad), *seen.objects[1:]))
    assert "script" not in Page(odd._repr_html_()).tags
    assert bad not in odd._repr_html_()


def test_a_frame_has_a_row_for_each_segment_contact_or_fact() -> None:
    seen = pick_up_with_both_hands()
    frame = seen.to_frame()
    assert isinstance(frame, pd.DataFrame)
    assert list(frame["name"]) == [each.name for each in seen.segments]
    assert list(frame["end_s"]) == [each.end_s for each in seen.segments]
    touches = [each for each in seen.facts if isinstance(each, Touching)]
    contacts = seen.to_frame("contacts")
    assert list(zip(contacts["body"], contacts["other"], strict=True)) == [
        (each.body, each.other) for each in touches
    ]
    assert list(seen.to_frame("facts")["atom"]) == [str(each) for each in seen.facts]


def test_without_pandas_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(CaparError, match=r"pip install 'capar\[frames\]'"):
        drink_from_mug().to_frame()


def test_at_80_columns_no_address_name_or_number_is_broken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where such columns do not fit they are wider than the terminal, which then breaks lines."""
    out = StringIO()
    monkeypatch.setattr(output, "console", lambda: Console(width=80, file=out))
    both = pick_up_with_both_hands()
    output.print_whole(segments_table(both, width=80))
    address = "a_study_of_tables:take_number_12/right_hand/17"
    rows = [[address, "ResumePosture", "bottle table", "subject_12", "12.345", "13.456"]]
    columns = ("address", "action", "objects", "performer", "begins", "ends")
    output.print_table(columns, rows, names={0, 1, 3, 4, 5})
    for link in both.links:
        for each in link.segments:
            assert f" {link.ee}/{each.index} " in out.getvalue()
    for whole in (address, "ResumePosture", "subject_12", "12.345", "13.456"):
        assert f" {whole} " in out.getvalue()
