"""The tutorials, word for word: each command is run, and answers what the page says."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from commands import capar

TUTORIALS = sorted((Path(__file__).parents[1] / "examples" / "tutorials").glob("*.md"))
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)

SHELL = re.compile(r"[|<>&;$*?`~\n\\]")
"""What a shell does something about; a command without it is its words."""


def blocks(text: str) -> list[tuple[str, str, str]]:
    """Language, file and content of each block, in order."""
    return [(found[1], found[2] or "", found[3]) for found in BLOCK.finditer(text)]


def commands(block: str) -> list[tuple[str, str]]:
    """Each command, with what is to be typed below it, and its answer."""
    out: list[tuple[str, str]] = []
    end = ""
    for line in block.splitlines(keepends=True):
        if line.startswith("$ "):
            out.append((line[2:], ""))
            marker = re.search(r"<<'(\w+)'", line)
            end = marker[1] if marker else ""
        elif end:
            out[-1] = (out[-1][0] + line, "")
            end = "" if line.strip() == end else end
        else:
            out[-1] = (out[-1][0], out[-1][1] + line)
    return out


def run(command: str, folder: Path) -> str:
    """What a shell answers, to whoever reads both its outputs."""
    name, *arguments = shlex.split(command.splitlines()[0])
    if name == "capar" and not SHELL.search(command.strip()):
        return capar(*arguments, cwd=folder, together=True).stdout
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {each: os.environ[each] for each in os.environ if not each.startswith("CAPAR")}
    done = subprocess.run(
        ["bash", "-c", command], cwd=folder, env={**environment, "PATH": path},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
    )  # fmt: skip
    return done.stdout


@pytest.mark.long
@pytest.mark.parametrize("page", TUTORIALS, ids=lambda each: each.stem)
def test_every_command_answers_what_the_page_says(page: Path, tmp_path: Path) -> None:
    tried = 0
    for language, file, content in blocks(page.read_text(encoding="utf-8")):
        if file:
            (tmp_path / file).write_text(content, encoding="utf-8")
        if language == "console":
            for command, answer in commands(content):
                assert run(command, tmp_path) == answer, command
                tried += 1
    assert tried


def test_there_is_a_tutorial() -> None:
    assert TUTORIALS
