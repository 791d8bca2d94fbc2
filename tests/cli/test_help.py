"""What the README says of all commands is what they offer."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from capar.cli import app

README = (Path(__file__).parents[2] / "README.md").read_text()


def commands(group: Any, before: tuple[str, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Every command by all its words."""
    context = typer.Context(group)
    for name in group.list_commands(context):
        each = group.get_command(context, name)
        if hasattr(each, "list_commands"):
            yield from commands(each, (*before, name))
        else:
            yield " ".join((*before, name)), each


def test_the_readme_names_the_commands_that_print_for_people_or_machines_alone() -> None:
    without = {
        name
        for name, each in commands(typer.main.get_command(app))
        if not any("--json" in option.opts for option in each.params)
    }
    sentence = re.search(r"What it prints for people.*?Errors go", README, re.S)
    assert sentence is not None
    named = set(re.findall(r"`([a-z -]+)`", sentence[0])) - {"--json"}
    assert len(without) > 5
    assert named == without
