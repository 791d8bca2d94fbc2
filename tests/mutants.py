"""Which faults the tests would notice: put one after another into a copy, and run the tests.

Run by hand, from the root, with maps of what tests execute (``executed.py``) where there are any:
``python tests/mutants.py --count 100 --maps out/executed``. Faults are drawn by a seed from the
rules and the extractors, as often from the ones as from the others. Each is put into a copy of the
tree. Of an extractor those tests run that execute what is changed; of a rule file the rule cases,
its own first. With ``--thorough`` all others run as well. A fault is caught by the first test that
fails. Tests have 4 GB of memory: a fault that makes a loop endless fails there, and harms nothing
else. Results are kept, one JSON object a line, and a run goes on where one with the same file of
results stopped.
"""

import argparse
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path
from queue import Queue
from tempfile import TemporaryDirectory

from executed import read_maps
from mutant_tests import NOT_RUN, Mutant, Selection
from mutations import difference, of_python, of_rules, python_differs, rules_differ

ROOT = Path(__file__).parents[1]
RULE_PACKAGES = ("primitives", "vocabulary", "segmentation", "naming", "composition")
PACKAGES = ("capar", "extractors", "capar_rules", "kb", "ontology")
UNLIKELY = ("tests/extractors/devices", "tests/body", "tests/kb/test_kills.py")
"""They take minutes and run little of what is changed, so they run only for their own modules."""

CAUGHT, SURVIVED, TIMEOUT = "caught", "survived", "timeout"
NEVER = "no test executes it"

MEMORY_BYTES = 4 << 30
"""Most memory that a process of tests may have [bytes]."""

LIMITED_PYTEST = f"""
import resource, sys, pytest
resource.setrlimit(resource.RLIMIT_DATA, ({MEMORY_BYTES}, {MEMORY_BYTES}))
sys.exit(pytest.console_main())
"""
"""Pytest within that memory. Address space that browsers merely reserve is not counted."""

FAILED, NOT_FOUND, NO_TESTS = 1, 4, 5
"""Exit codes of pytest: a test failed, there is none of a name, and none was selected."""


@dataclass(frozen=True, slots=True)
class Result:
    """What became of a mutant."""

    name: str
    file: str
    kind: str
    status: str
    by: str
    """The test that caught it, or the tests that ran out of time."""

    seconds: float
    diff: str


def drawn(seed: int) -> Iterator[Mutant]:
    """Every mutant there is, in an order of chance: one of rules, one of extractors, by turns."""
    chance = random.Random(seed)
    packages = [_rules(f"capar_rules/{package}") for package in RULE_PACKAGES]
    orders = [iter(chance.sample(package, len(package))) for package in packages]
    modules = _modules()
    extractors = iter(chance.sample(modules, len(modules)))
    turns = [each for order in orders for each in (order, extractors)]
    while turns:
        for order in list(turns):
            found = next(filter(_differs, order), None)
            if found:
                yield found
            elif order in turns:
                turns = [each for each in turns if each is not order]


def _rules(folder: str) -> list[Mutant]:
    included = _included()
    files = sorted(each for each in (ROOT / folder).glob("*.lp") if each in included)
    return [
        Mutant(str(file.relative_to(ROOT)), mutation)
        for file in files
        for mutation in sorted(set(of_rules(file.read_text(encoding="utf-8"))))
    ]


def _included() -> set[Path]:
    """The rule files that a profile loads; the others are no part of what is observed."""
    waiting = [ROOT / "capar_rules" / f"{name}.lp" for name in ("extended", "thesis")]
    waiting += (ROOT / "capar_rules" / "primitives").glob("*.lp")
    for path in waiting:
        names = re.findall(r'^#include "([^"]+)"', path.read_text(encoding="utf-8"), re.MULTILINE)
        found = ((path.parent / name).resolve() for name in names)
        waiting += [each for each in found if each not in waiting]
    return set(waiting)


def _modules() -> list[Mutant]:
    sources = sorted(each for name in PACKAGES for each in (ROOT / name).rglob("*.py"))
    texts = {each: each.read_text(encoding="utf-8") for each in sources}
    words = Counter(re.findall(r"\w+", "\n".join(texts.values())))
    return [
        Mutant(str(path.relative_to(ROOT)), mutation)
        for path, text in texts.items()
        if path.is_relative_to(ROOT / "extractors")
        for mutation in sorted(set(of_python(text, words=words)))
    ]


def _differs(mutant: Mutant) -> bool:
    before = (ROOT / mutant.file).read_text(encoding="utf-8")
    differ = rules_differ if mutant.file.endswith(".lp") else python_differs
    return differ(before, mutant.mutation.applied(before))


def tried(mutant: Mutant, selection: Selection, *, limit_s: float) -> Result:
    """Put a mutant into a copy of the tree, run the tests, and take it out again."""
    path = selection.tree / mutant.file
    before = path.read_text(encoding="utf-8")
    after = mutant.mutation.applied(before)
    start = time.monotonic()
    try:
        stages = list(selection.stages(mutant))
        path.write_text(after, encoding="utf-8")
        status, by = _outcome(stages, selection.tree, until=start + limit_s)
    finally:
        path.write_text(before, encoding="utf-8")
    if status == CAUGHT and by not in selection.executed.passed:
        if _run(selection.tree, [by], until=time.monotonic() + limit_s)[0] == FAILED:
            raise SystemExit(f"{by} fails without any mutant: mend that first")
        selection.executed.passed.add(by)
    diff = difference(mutant.file, before, after)
    seconds = round(time.monotonic() - start, 1)
    return Result(mutant.name, mutant.file, mutant.mutation.kind, status, by, seconds, diff)


def _outcome(stages: Sequence[Sequence[str]], tree: Path, *, until: float) -> tuple[str, str]:
    """Whether some test fails, and which one."""
    if not any(stages):
        return SURVIVED, NEVER
    for tests in filter(None, stages):
        code, output = _run(tree, tests, until=until)
        if code == NOT_FOUND:
            # A constant in a test's parameters has changed, and so has the test's name.
            code, output = _run(tree, sorted({each.split("::")[0] for each in tests}), until=until)
        if code is None:
            return TIMEOUT, " ".join(tests)[:200]
        if code not in (0, NO_TESTS):
            failed = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", output, re.MULTILINE)
            return CAUGHT, failed[1] if failed else tests[0]
    return SURVIVED, ""


def _run(tree: Path, tests: Sequence[str], *, until: float) -> tuple[int | None, str]:
    """The exit code of tests, None where they ran out of time, and what they said."""
    unlikely = [each for each in UNLIKELY if not any(test.startswith(each) for test in tests)]
    left_out = [part for each in (*NOT_RUN, *unlikely) for part in ("--ignore", each)]
    options = ["-x", "-q", "-rfE", "-p", "no:cacheprovider"]
    process = subprocess.Popen(
        [sys.executable, "-c", LIMITED_PYTEST, *options, *tests, *left_out],
        cwd=tree,
        env={**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    try:
        output, _ = process.communicate(timeout=max(until - time.monotonic(), 0.1))
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # processes that the tests have started, too
        process.communicate()
        return None, ""
    return process.returncode, output


def results_in(path: Path) -> dict[str, Result]:
    """What earlier runs have found, by name."""
    if not path.exists():
        return {}
    rows = (Result(**json.loads(line)) for line in path.read_text().splitlines())
    return {row.name: row for row in rows}


def run(mutants: Sequence[Mutant], asked: argparse.Namespace) -> None:
    """Try each mutant that has no result yet, and add its result to the file."""
    results, jobs = asked.results, asked.jobs
    waiting = [each for each in mutants if each.name not in results_in(results)]
    with TemporaryDirectory(prefix="mutants") as place, ThreadPoolExecutor(jobs) as pool:
        trees: Queue[Selection] = Queue()
        for number in range(jobs):
            tree = Path(place) / str(number)
            shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(".*", "__pycache__"))
            trees.put(Selection(tree, read_maps(asked.maps), asked.thorough))

        def try_one(mutant: Mutant) -> Result:
            selection = trees.get()
            try:
                return tried(mutant, selection, limit_s=asked.limit)
            finally:
                trees.put(selection)

        for done in as_completed([pool.submit(try_one, each) for each in waiting]):
            result = done.result()
            with results.open("a") as file:
                file.write(json.dumps(asdict(result)) + "\n")
            _say(f"{result.status:9} {result.seconds:7.1f} s  {result.file}  {result.by}")


def report(found: Sequence[Result]) -> None:
    """How many were caught, and what each survivor changes."""
    for result in found:
        if result.status == SURVIVED:
            _say(f"\n{result.name} {result.kind}\n{result.diff}")
    counts = {
        each: sum(row.status == each for row in found) for each in (CAUGHT, SURVIVED, TIMEOUT)
    }
    _say(", ".join(f"{count} {status}" for status, count in counts.items()))


def _say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def main() -> None:
    """Draw mutants, try them, and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=1800.0, help="seconds for each mutant")
    parser.add_argument("--results", type=Path, default=Path("out/mutants.jsonl"))
    parser.add_argument("--maps", type=Path, default=Path("out/executed"), help="by executed.py")
    parser.add_argument("--only", default="", help="of those drawn, the files that begin so")
    parser.add_argument("--thorough", action="store_true", help="in the end, all tests")
    parser.add_argument("--list", action="store_true", help="show the mutants and run nothing")
    asked = parser.parse_args()
    found = islice(drawn(asked.seed), asked.count)
    mutants = [each for each in found if each.file.startswith(asked.only)]
    if asked.list:
        for each in mutants:
            before = (ROOT / each.file).read_text(encoding="utf-8")
            _say(f"{each.name} {each.mutation.kind}")
            _say(difference(each.file, before, each.mutation.applied(before)))
        return
    asked.results.parent.mkdir(parents=True, exist_ok=True)
    run(mutants, asked)
    names = {each.name for each in mutants}
    report([row for row in results_in(asked.results).values() if row.name in names])


if __name__ == "__main__":
    main()
