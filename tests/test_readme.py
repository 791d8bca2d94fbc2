"""Commands of the README and of docs/ run, in order, one folder a page; links lead somewhere."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import demonstration_files
import pytest
import typer
from commands import capar, clean_environment
from robot_data import demo_data

from capar.cli import app

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
PAGES = [README, *sorted((ROOT / "docs").glob("*.md"))]
PROSE = [*PAGES, ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("[!.]*/README.md"))]
WITH_COMMANDS = [page for page in PAGES if "```console" in page.read_text()]
CAPAR = str(Path(sys.executable).parent / "capar")


def commands(page: Path) -> list[str]:
    """The commands of a page's console blocks."""
    blocks = re.findall(r"```console\n(.*?)```", page.read_text(), re.S)
    lines = [line for block in blocks for line in block.splitlines()]
    return [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the parts of a checkout that the pages name."""
    (tmp_path / "capar").mkdir()
    (tmp_path / "capar" / "demo").symlink_to(ROOT / "capar" / "demo")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    (tmp_path / "tests").symlink_to(ROOT / "tests")
    (tmp_path / "mine").mkdir()
    for place, takes in (("study", '["s1", "s2"]'), ("demos/d", ""), ("more_m", ""),
                         ("robot", '["episode_0", "episode_3"]')):  # fmt: skip
        shutil.copytree(ROOT / "capar" / "demo" / "drink_from_mug", tmp_path / place)
        toml = tmp_path / place / "capture.toml"
        name = Path(place).name
        text = toml.read_text().replace('"drink_from_mug"', f'"{name}"', 1)
        toml.write_text(f"takes = {takes}\n{text}" if takes else text)
    demo_data(tmp_path / "robot_data", count=4)
    pages = (ROOT / "docs" / "own-files.md").read_text()
    (mapping,) = re.findall(r"```toml\n([^`]*observation\.state.*?)```", pages, re.S)
    (tmp_path / "robot_data" / "capture.toml").write_text(mapping)
    demonstration_files.write(tmp_path / "lift.hdf5", demos=4)
    return tmp_path


WRITTEN: dict[str, tuple[Path, list[Path]]] = {}
"""Where each command without an Actionary wrote what: on another page it would write the same."""


def run(command: str, folder: Path) -> None:
    """Run a command, or copy what it wrote on an earlier page."""
    capar_, name, *arguments = shlex.split(command)
    assert capar_ == "capar"
    if command in WRITTEN:
        earlier, written = WRITTEN[command]
        for path in written:
            copy = folder / path.relative_to(earlier)
            copy.mkdir() if path.is_dir() else shutil.copy(path, copy)
        return
    before = {*folder.rglob("*")}
    done = capar(name, *arguments, cwd=folder)
    assert done.returncode == 0, f"{command}\n{done.stderr}"
    assert name != "roundtrip" or done.stdout.endswith("1 asked, 1 in reach, 1 passed\n")
    if "--actionary" not in arguments:
        WRITTEN[command] = folder, sorted({*folder.rglob("*")} - before)


@pytest.mark.long
@pytest.mark.parametrize("page", WITH_COMMANDS, ids=lambda page: page.stem)
def test_every_command_of_a_page_runs(page: Path, folder: Path) -> None:
    for command in commands(page):
        run(command, folder)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_a_page_shows_of_commands_that_wait_or_serve_is_taken_by_them(page: Path) -> None:
    """They are run by tests of their own: of the window, of the server, of trackers."""
    root = typer.main.get_command(app)
    for line in re.findall(r"^    capar (.+)", page.read_text(), re.M):
        name, *arguments = shlex.split(line, comments=True)
        command = root.get_command(typer.Context(root), name)
        command.make_context(name, arguments)


@pytest.mark.long
def test_python_of_the_pages_runs(folder: Path) -> None:
    for page in PAGES:
        for code in re.findall(r"```python\n(.*?)```", page.read_text(), re.S):
            command = [sys.executable, "-c", code]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
            assert done.returncode == 0, f"{page.name}\n{code}\n{done.stderr}"


def test_the_installed_script_observes_the_demo(folder: Path) -> None:
    arguments = shlex.split(commands(README)[0])[1:]
    done = subprocess.run(
        [CAPAR, *arguments],
        cwd=folder,
        env=clean_environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (folder / "drink.png").stat().st_size > 10_000


@pytest.mark.parametrize("page", PROSE, ids=lambda page: str(page.relative_to(ROOT)))
def test_what_a_page_links_to_is_there(page: Path) -> None:
    for path in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
        assert (page.parent / path).exists(), path


def test_every_benchmark_that_a_page_names_is_there() -> None:
    for page in PROSE:
        for path in re.findall(r"\b(?:benchmarks|tests)/[\w/]+\.py", page.read_text()):
            assert (ROOT / path).exists(), f"{page.name}: {path}"


def test_the_readme_stays_short() -> None:
    text = README.read_text()
    assert len(text.splitlines()) <= 200
    assert len(text) <= 14_000
