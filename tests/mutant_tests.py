"""Which tests run for a mutant, stage by stage: those that most likely catch it come first."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from executed import IMPORTED, Executed
from mutations import Mutation

FIRST = {
    "capar_rules": ("tests/rules",),
    "extractors": ("tests/extractors", "tests/model"),
}
"""By package, the tests that say most of it."""

SECOND = (
    "tests/scenes/test_rates.py",
    "tests/test_motions.py",
    "tests/test_published.py",
    "tests/capar_rules",
)
NOT_RUN = ("tests/test_architecture.py", "tests/test_readme.py")
"""They judge how files are written and what is installed, not what a program does."""

MOST_MENTIONS = 6
"""A word in more test files than this says nothing of where a module is tested."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """A fault of one file."""

    file: str
    mutation: Mutation

    @property
    def name(self) -> str:
        """What it is called in the results."""
        return self.mutation.name(self.file)


@dataclass(frozen=True, slots=True)
class Selection:
    """Chooses tests by what they execute, where that is known, and otherwise by their names."""

    tree: Path
    executed: Executed
    thorough: bool
    """All tests run for what survives the likely ones."""

    def stages(self, mutant: Mutant) -> Iterator[list[str]]:
        """Tests to run one stage after another, until one fails."""
        if mutant.file.endswith(".py") and self.executed.files:
            yield from self._executing(mutant)
        else:
            yield from self._likely(mutant)
        if self.thorough:
            yield [each for each in SECOND if (self.tree / each).exists()]
            yield ["tests"]

    def _executing(self, mutant: Mutant) -> Iterator[list[str]]:
        """Those that execute the changed lines: first in files that import the module, then others.

        Then, if asked, what else is in their files: a test may see a result that an earlier one
        of its file has left in a cache.
        """
        tests = tests_executing(mutant, self.executed, (self.tree / mutant.file).read_text())
        seconds = {
            file: sum(taken for test, taken in found.items() if test in tests)
            for file, found in self.executed.files.items()
            if tests & found.keys()
        }
        imported = mutant.file.removesuffix(".py").replace("/", ".")
        texts = {file: (self.tree / file).read_text(encoding="utf-8") for file in seconds}
        files = sorted(seconds, key=lambda file: (imported not in texts[file], seconds[file]))
        yield [test for file in files for test in self.executed.files[file] if test in tests]
        if self.thorough and files:
            yield [*files, *(part for test in sorted(tests) for part in ("--deselect", test))]

    def _likely(self, mutant: Mutant) -> Iterator[list[str]]:
        package, stem = mutant.file.split("/")[0], Path(mutant.file).stem
        first = [each for each in FIRST[package] if (self.tree / each).exists()]
        if package != "capar_rules":
            yield self._mentioning(stem)
        yield [*first, "-k", stem]
        yield first
        if package == "capar_rules" and self.thorough:
            # Names of rule files are everyday words, so few of the tests that mention one mean it.
            yield self._mentioning(stem)

    def _mentioning(self, stem: str) -> list[str]:
        """Test files that use the name of a module or rule file as a word, if they are few."""
        word = re.compile(rf"\b{stem}\b")
        paths = sorted((self.tree / "tests").rglob("test_*.py"))
        found = [each for each in paths if word.search(each.read_text(encoding="utf-8"))]
        names = [str(each.relative_to(self.tree)) for each in found]
        if len(names) > MOST_MENTIONS:
            return []
        return [each for each in names if each not in NOT_RUN]


def tests_executing(mutant: Mutant, executed: Executed, text: str) -> set[str]:
    """The tests that execute what a mutant changes, given the text of its file.

    What is changed where a module is imported, a constant or a default, is executed by whoever
    executes a line that names it, or else any line of the module.
    """
    statement = statement_at(text, mutant.mutation.start)
    last = text.encode()[: mutant.mutation.end].count(b"\n") + 1
    tests = executed.tests_of(mutant.file, range(statement.lineno, last + 1))
    if tests != {IMPORTED}:
        return tests - {IMPORTED}
    return executed.tests_of_name(assigned(statement)) or executed.tests_of_file(mutant.file)


def statement_at(text: str, offset: int) -> ast.stmt:
    """The innermost statement of a module around a byte of it."""
    before = text.encode()[:offset]
    line = before.count(b"\n") + 1
    around = [
        node
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.stmt) and node.lineno <= line <= (node.end_lineno or 0)
    ]
    return max(around, key=lambda node: (node.lineno, -(node.end_lineno or 0)))


def assigned(statement: ast.stmt) -> str | None:
    """The name that a statement gives a value, if it does that."""
    match statement:
        case ast.Assign(targets=[ast.Name(name)]) | ast.AnnAssign(target=ast.Name(name)):
            return name
    return None
