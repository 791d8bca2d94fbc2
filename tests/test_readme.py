"""The commands of the README run, in their order, in one folder."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from commands import capar, clean_environment

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
COMMANDS = [
    line.removeprefix("$ ")
    for block in re.findall(r"```console\n(.*?)```", README, re.S)
    for line in block.splitlines()
    if line.startswith("$ ")
]
CAPAR = str(Path(sys.executable).parent / "capar")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the parts of a checkout that the README names."""
    place = tmp_path_factory.mktemp("readme")
    (place / "capar").mkdir()
    (place / "capar" / "demo").symlink_to(ROOT / "capar" / "demo")
    (place / "examples").symlink_to(ROOT / "examples")
    (place / "mine").mkdir()
    return place


def test_the_readme_shows_commands() -> None:
    assert len(COMMANDS) > 10


@pytest.mark.long
def test_every_command_of_the_readme_runs(folder: Path) -> None:
    """All in processes of their own; the first one by the installed script."""
    for number, command in enumerate(COMMANDS):
        name, *arguments = shlex.split(command)
        assert name == "capar"
        done = by_script(arguments, folder) if number == 0 else capar(*arguments, cwd=folder)
        assert done.returncode == 0, f"{command}\n{done.stderr}"
    assert (folder / "drink.png").stat().st_size > 10_000
    assert (folder / "mine" / "capture.toml").exists()
    assert (folder / "known.trig").exists()


def by_script(arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [CAPAR, *arguments], cwd=folder, env=clean_environment(), capture_output=True, text=True,
        check=False,
    )  # fmt: skip


def test_what_the_readme_links_to_is_there() -> None:
    for path in re.findall(r"\]\(([^)#:]+)\)", README):
        assert (ROOT / path).exists(), path
