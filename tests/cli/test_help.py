"""The help lists every command, and each can be asked for its own."""

import re

import pytest
from typer.testing import CliRunner

from capar.cli import COMMANDS, app

COLUMNS = 80


def test_the_help_lists_each_command_once_in_a_line() -> None:
    told = CliRunner().invoke(app, ["--help"], env={"COLUMNS": str(COLUMNS)}).stdout
    rows = told.partition("Look at captures:")[2].splitlines()
    names = [row.split()[0] for row in rows if re.match(r"  \S", row)]
    assert sorted(names) == sorted(COMMANDS)
    assert max(map(len, rows)) <= COLUMNS
    assert "..." not in "".join(rows)


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_each_command_has_help(name: str) -> None:
    result = CliRunner().invoke(app, [name, "--help"])
    assert result.exit_code == 0
    assert result.stdout.startswith(f"Usage: root {name}")
    assert "\\b" not in result.stdout


def test_examples_of_a_help_stand_in_lines_of_their_own() -> None:
    told = CliRunner().invoke(app, ["observe", "--help"], env={"COLUMNS": str(COLUMNS)}).stdout
    assert "\n      capar observe mine --plot mine.png\n" in told
