"""What is printed of the words of rules: all of them file by file, or one with its rules."""

from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from capar.cli._rule_tables import print_json

if TYPE_CHECKING:
    from capar_rules.authoring.glossary import Glossary, Word


def print_glossary(found: "Glossary") -> None:
    """Every word, file by file, and what each file keeps to itself."""
    within: dict[str, list[str]] = {}
    for file, (name, arity) in found.internal:
        within.setdefault(file, []).append(f"{name}/{arity}")
    for file, words in groupby(found.words, key=lambda each: each.file):
        typer.echo(file)
        for each in words:
            typer.echo(f"  {each}  {each.meaning}")
        if file in within:
            typer.echo(f"  within this file alone: {', '.join(within.pop(file))}")
        typer.echo()
    for file, names in within.items():
        typer.echo(f"{file}\n  within this file alone: {', '.join(names)}\n")


def print_word(found: "Glossary", name: str) -> None:
    """One word: what it means, where it is explained, and the rules that define it."""
    words = found.find(name)
    for each in words:
        typer.echo(f"{each}  {each.meaning}")
        typer.echo(f"  explained in {each.file}:{each.line}" if each.line else f"  in {each.file}")
    for signature in dict.fromkeys(each.signature for each in words):
        for place in found.rules_of(signature):
            typer.echo(f"  defined at {place}\n{_rule(Path(place.file), place.line)}")


def _rule(file: Path, line: int) -> str:
    """The text of the rule that begins on that line."""
    lines = file.read_text(encoding="utf-8").splitlines()[line - 1 :]
    end = next((at for at, each in enumerate(lines, 1) if each.rstrip().endswith(".")), len(lines))
    return "\n".join(f"    {each}" for each in lines[:end])


def print_words_json(found: "Glossary", name: str | None) -> None:
    """The same as JSON: one word, or all of them."""
    words = found.find(name) if name else found.words
    print_json([_row(each, found) for each in words])


def _row(word: "Word", found: "Glossary") -> dict[str, object]:
    return {
        "name": word.name,
        "arguments": list(word.arguments),
        "meaning": word.meaning,
        "file": word.file,
        "line": word.line,
        "defined": [str(each) for each in found.rules_of(word.signature)],
    }
