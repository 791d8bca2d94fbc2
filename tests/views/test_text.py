"""The textual form tells PARs apart, one statement a line."""

from dataclasses import replace

import pytest
from observations import drink_from_mug, pick_up_with_both_hands
from rich.console import Console
from rich.table import Table

from capar.views.tables import (
    segments_table,
    steps_table,
)


def shown(table: Table, width: int = 160) -> str:
    console = Console(width=width, color_system=None, force_terminal=False)
    with console.capture() as capture:
        console.print(table)
    return capture.get()


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


@pytest.mark.parametrize("columns", [40, 80, 200])
def test_a_table_cuts_no_name_however_narrow_the_terminal(columns: int) -> None:
    seen = pick_up_with_both_hands()
    out = shown(segments_table(seen), columns) + shown(steps_table(seen.complex_par), columns)
    assert "…" not in out
    for each in seen.segments:
        assert f"{each.ee}/{each.index}" in out or columns < 80


def test_at_eighty_columns_each_segment_is_one_line_with_its_address_and_name() -> None:
    seen = drink_from_mug()
    lines = shown(segments_table(seen, width=80), 80).splitlines()
    for each in seen.segments:
        (line,) = [line for line in lines if f"{each.ee}/{each.index} " in line]
        assert f" {each.name} " in line
