"""Which tests execute which lines of the extractors, and how long each test takes.

Run by hand, from the root: ``python tests/executed.py --maps out/executed tests/extractors/*.py``.
Each file of tests runs in a process of its own, so that none spares another the work by a cache,
and leaves a map in a JSON file. ``mutants.py`` reads them. Files that have a map are left out.
"""

import argparse
import json
import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = "extractors"
TARGET = "CAPAR_EXECUTED"
"""Names the file of the map, in the process that runs the tests."""

IMPORTED = ""
"""The context of what is executed when a module is imported, before any test."""

Places = dict[str, dict[int, set[str]]]
"""By file and line, the tests that execute it."""


@dataclass(slots=True)
class Executed:
    """What some test files execute."""

    files: dict[str, dict[str, float]] = field(default_factory=dict)
    """By test file, its tests in their order, and the seconds each takes; no test that fails."""

    passed: set[str] = field(default_factory=set)
    """Tests that are known to pass without any mutant."""

    places: Places = field(default_factory=lambda: defaultdict(lambda: defaultdict(set)))

    def tests_of(self, file: str, lines: Iterable[int]) -> set[str]:
        """The tests that execute one of some lines; with IMPORTED for those of imports."""
        return set().union(*(self.places[file].get(line, set()) for line in lines))

    def tests_of_file(self, file: str) -> set[str]:
        """The tests that execute any line of a file, when it is imported already."""
        return set().union(*self.places[file].values()) - {IMPORTED}

    def tests_of_name(self, name: str | None) -> set[str]:
        """The tests that execute a line with a name in it, in any module."""
        found: set[str] = set()
        if name:
            for file, places in self.places.items():
                lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
                found |= self.tests_of(file, (n for n in places if named_in(lines, n, name)))
        return found - {IMPORTED}

    def add(self, path: Path) -> None:
        """Read the map of one more file of tests."""
        found = json.loads(path.read_text())
        self.files[found["tests"]] = found["seconds"]
        self.passed |= found["seconds"].keys()
        names = [IMPORTED, *found["contexts"]]
        for file, lines in found["lines"].items():
            for line, contexts in lines.items():
                tests = (names[each] for each in contexts)
                known = {each for each in tests if each in found["seconds"] or each == IMPORTED}
                self.places[file][int(line)] |= known


def named_in(lines: list[str], number: int, name: str) -> bool:
    """Whether a line of a module uses a name."""
    return number <= len(lines) and re.search(rf"\b{name}\b", lines[number - 1]) is not None


def read_maps(folder: Path) -> Executed:
    """All maps of a folder, as one."""
    found = Executed()
    for path in sorted(folder.glob("*.json")):
        found.add(path)
    return found


class _Recorder:
    """A pytest plugin that records the lines that each test executes."""

    def __init__(self, target: Path) -> None:
        import coverage

        self.target = target
        self.seconds: dict[str, float] = defaultdict(float)
        self.failed: set[str] = set()
        self.coverage = coverage.Coverage(data_file=None, source=[str(ROOT / PACKAGE)])
        self.coverage.start()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self.coverage.switch_context(item.nodeid)
        return (yield)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.seconds[report.nodeid] += report.duration
        if report.outcome != "passed":
            self.failed.add(report.nodeid)

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        self.coverage.stop()
        passed = {name: s for name, s in self.seconds.items() if name not in self.failed}
        numbers = {name: number for number, name in enumerate([IMPORTED, *self.seconds])}
        data, lines = self.coverage.get_data(), {}
        for file in data.measured_files():
            contexts = data.contexts_by_lineno(file)
            told = {each: [numbers[name] for name in names] for each, names in contexts.items()}
            lines[str(Path(file).relative_to(ROOT))] = told
        told = {
            "tests": str(Path(session.config.args[0]).relative_to(ROOT)),
            "seconds": {name: round(taken, 3) for name, taken in passed.items()},
            "contexts": list(self.seconds),
            "lines": lines,
        }
        self.target.write_text(json.dumps(told))


def pytest_configure(config: pytest.Config) -> None:
    """Record, where a map is asked for."""
    if target := os.environ.get(TARGET):
        config.pluginmanager.register(_Recorder(Path(target)))


def write_map(tests: Path, maps: Path) -> bool:
    """Run one file of tests and write its map, unless there is one; tell whether it was made."""
    name = str(tests.resolve().relative_to(ROOT)).removesuffix(".py").replace("/", ".")
    target = (maps / f"{name}.json").resolve()
    if target.exists():
        return False
    folders = os.pathsep.join([str(ROOT), str(ROOT / "tests")])
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "executed"]
    environment = {**os.environ, "PYTHONPATH": folders, TARGET: str(target)}
    subprocess.run([*command, str(tests.resolve())], cwd=ROOT, env=environment, check=False)
    return target.exists()


def main() -> None:
    """Map what files of tests execute."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--maps", type=Path, default=Path("out/executed"))
    parser.add_argument("tests", type=Path, nargs="+")
    asked = parser.parse_args()
    asked.maps.mkdir(parents=True, exist_ok=True)
    for path in asked.tests:
        write_map(path, asked.maps)


if __name__ == "__main__":
    main()
