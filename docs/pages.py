"""The pages of the site: those of the repository, and references written from code."""

import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import Any

import click
import typer
from mkdocs.structure.files import File, Files

import capar
from capar.cli import app
from capar_rules.authoring.glossary import glossary
from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import rule_file
from kb.queries.questions import questions
from ontology import BASE
from ontology.files import read, term_files

ROOT = Path(__file__).parents[1]
SHOWN = ("*.md", "docs/**/*", "ontology/**/*", "capar_rules/*", "examples/**/*", "tests/**/*")
SHIM = "https://unpkg.com/iframe-worker/shim"
SUFFIXES = (".md", ".png", ".ipynb", "first_run.txt")


def on_files(files: Files, config: Any) -> Files:
    """Every page under the name that it has in the repository, and those written from code."""
    paths = {
        path for pattern in SHOWN for path in ROOT.glob(pattern) if path.name.endswith(SUFFIXES)
    }
    own = [each for each in files if not each.src_uri.endswith((*SUFFIXES, ".py"))]
    for path in sorted(paths):
        uri = path.relative_to(ROOT).as_posix()
        own.append(File.generated(config, uri, abs_src_path=str(path)))
    for name, page in WRITTEN.items():
        text = "\n".join(page())
        own.append(File.generated(config, f"docs/{name}.md", content=text))
    return Files(own)


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Fenced blocks whose second word is a file's name have it as their title."""
    return re.sub(r"^```(\w+) (\S+)$", r'```\1 title="\2"', markdown, flags=re.M)


def on_post_page(output: str, **_: Any) -> str:
    """The search of pages opened as files by our own script, in place of one on the network."""
    own = (ROOT / "docs" / "search_in_frame.js").read_text(encoding="utf-8")
    return output.replace(f'<script src="{SHIM}"></script>', f"<script>{own}</script>")


on_post_template = on_post_page
"""The page that says that there is none."""


def _cell(text: str) -> str:
    """Text as a cell of a table; code in it stays as it is."""
    parts = re.sub(r"\s+", " ", text).strip().split("`")
    parts[::2] = [each.replace("|", "\\|").replace("<", "&lt;") for each in parts[::2]]
    return "`".join(parts)


def _table(head: str, rows: Any) -> Iterator[str]:
    """A table with its head, ``a | b``."""
    yield from ("", f"| {head} |", f"|{'---|' * (head.count('|') + 1)}")
    yield from (f"| {' | '.join(map(_cell, row))} |" for row in rows)
    yield ""


def _commands() -> Iterator[str]:
    yield "# Commands"
    yield "\nAs `capar COMMAND --help` prints them."
    root = typer.main.get_command(app)
    yield from _command(root, click.Context(root, info_name="capar"))


def _command(command: Any, ctx: click.Context) -> Iterator[str]:
    """A command with its options, and the commands below it."""
    below = command.list_commands(ctx) if hasattr(command, "list_commands") else []
    if ctx.parent:
        yield f"\n{'#' * len(ctx.command_path.split())} {ctx.command_path}\n"
    text = re.sub(r"^\x08\n", "", command.help or "", flags=re.M)
    yield text
    if not below:
        yield f"\n    {command.get_usage(ctx).removeprefix('Usage: ')}"
    records = (each.get_help_record(ctx) for each in command.get_params(ctx))
    rows = [each for each in records if each and not each[0].startswith("--help")]
    if rows and ctx.parent:
        yield from _table("option | meaning", ([f"`{a}`", b] for a, b in rows))
    for name in below:
        sub = command.get_command(ctx, name)
        yield from _command(sub, click.Context(sub, info_name=name, parent=ctx))


def _python() -> Iterator[str]:
    yield "# Python\n"
    yield (capar.__doc__ or "").split(">>>")[0]
    yield from (f"\n::: capar.{name}" for name in capar.__all__)


def _questions() -> Iterator[str]:
    yield "# Named questions"
    yield "\n`capar query NAME PARAMETER=VALUE` ([how to ask](ask.md)); these are all of them."
    for name, asked in sorted(questions().items()):
        yield f"\n## {name}\n\n{asked.text}"
        rows = ([f"`{each.name}`", each.meaning] for each in asked.parameters)
        yield from _table("parameter | meaning", rows) if asked.parameters else ()


def _rule_words() -> Iterator[str]:
    yield "# Words of rules"
    yield "\nWhat a rule may read or state, by the file that defines it (`capar rules words`)."
    for file, words in groupby(glossary(profile("extended")).words, key=lambda each: each.file):
        yield f"\n## {file or 'stated by a rule file'}"
        yield from _table("word | meaning", ([f"`{each}`", each.meaning] for each in words))


def _primitives() -> Iterator[str]:
    yield "# Primitives"
    yield "\nEach is one file of logic; `capar rules show NAME` prints it with its cases."
    for path in sorted(rule_file("primitives").glob("*.lp")):
        text = path.read_text(encoding="utf-8").strip()
        name = re.search(r'^primitive\("(\w+)"\)', text, re.M)
        if name:
            yield f"\n## {name[1]}\n\n```prolog\n{text}\n```"


def _terms() -> Iterator[str]:
    yield "# Terms of the ontology"
    yield "\nThe prefix of all is `capar:`; [how to ask with them](../ontology/README.md)."
    for file in term_files():
        told: dict[str, dict[str, str]] = {}
        for triple in read(file):
            if str(getattr(triple.subject, "value", "")).startswith(BASE):
                value = getattr(triple.object, "value", "")
                key = triple.predicate.value.rsplit("#")[-1]
                told.setdefault(triple.subject.value.removeprefix(BASE), {}).setdefault(key, value)
        rows = [
            [f"`{term}`", own["type"].rsplit("#")[-1], own["definition"]]
            for term, own in told.items()
            if {"type", "definition"} <= own.keys()
        ]
        if rows:
            yield f"\n## {file.name}"
            yield from _table("term | is | definition", rows)


WRITTEN = {
    "commands": _commands, "python": _python, "questions": _questions,
    "rule-words": _rule_words, "primitives": _primitives, "terms": _terms,
}  # fmt: skip
"""Pages that are written from code, by name."""
