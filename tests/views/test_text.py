"""The textual form tells PARs apart, one statement a line."""

from dataclasses import replace
from difflib import unified_diff

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug, pick_up_with_both_hands
from rich.console import Console
from rich.table import Table

from capar.views.tables import (
    aligned,
    observation_text,
    par_text,
    segments_table,
    steps_table,
)


def shown(table: Table, width: int = 160) -> str:
    console = Console(width=width, color_system=None, force_terminal=False)
    with console.capture() as capture:
        console.print(table)
    return capture.get()


def changed(before: str, after: str) -> list[str]:
    lines = unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=0)
    return [each for each in lines if each[0] in "+-" and each[:3] not in {"+++", "---"}]


def test_equal_pars_give_equal_text_and_others_do_not() -> None:
    assert observation_text(drink_from_mug()) == observation_text(drink_from_mug())
    texts = [par_text(each) for each in drink_from_mug().upars]
    assert len(set(texts)) == len(texts)


def test_one_changed_field_changes_one_line() -> None:
    par = drink_from_mug().ipars[0]
    other = replace(par, core=replace(par.core, purpose="Touch"))
    assert changed(par_text(par), par_text(other)) == [
        "-  purpose             PickUp",
        "+  purpose             Touch",
    ]


def test_every_segment_stands_in_the_table_with_its_times_and_features() -> None:
    seen = drink_from_mug()
    text = shown(segments_table(seen))
    for segment in seen.segments:
        (line, *_) = [
            each
            for each in text.splitlines()
            if f"{segment.start_s:.3f}" in each and f"{segment.end_s:.3f}" in each
        ]
        assert segment.name in line
        assert ", ".join(segment.objects) in line
        assert f"{segment.features.rel_start} > {segment.features.rel_end}" in line
        assert segment.purpose in line


def test_names_with_brackets_are_printed_as_they_are() -> None:
    seen = replace(drink_from_mug(), capture="[red]x[/red]")
    assert "[red]x[/red]" in shown(segments_table(seen))


cells = st.text(st.characters(categories=["L", "Nd"]), max_size=8)


@given(st.lists(st.tuples(cells, cells, cells), min_size=1, max_size=8))
def test_columns_stand_under_each_other(rows: list[tuple[str, str, str]]) -> None:
    lines = aligned(rows)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    starts = []
    for index, width in enumerate(widths):
        before = [each for each in widths[:index] if each]
        starts.append(sum(before) + 2 * len(before) if width else None)
    for line, row in zip(lines, rows, strict=True):
        for start, cell in zip(starts, row, strict=True):
            assert start is None or line[start : start + len(cell)] == cell
        assert line == line.rstrip()


@pytest.mark.parametrize("columns", [40, 80, 200])
def test_a_table_cuts_no_name_however_narrow_the_terminal(columns: int) -> None:
    seen = pick_up_with_both_hands()
    out = shown(segments_table(seen), columns) + shown(steps_table(seen.complex_par), columns)
    assert "…" not in out
    for each in seen.segments:
        assert f"{each.ee}/{each.index}" in out or columns < 80
