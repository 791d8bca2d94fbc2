"""A pytest plugin: files called ``*.motion.toml`` are tests, one for each claim and capture."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

SUFFIX = ".motion.toml"


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "MotionFile | None":
    """Collect files of claims."""
    if file_path.name.endswith(SUFFIX):
        return MotionFile.from_parent(parent, path=file_path)
    return None


class ClaimFailedError(Exception):
    """A claim that does not hold of a capture."""


class MotionFile(pytest.File):
    """A file of claims."""

    def collect(self) -> Iterator["ClaimItem"]:
        """One item for each capture and claim."""
        from capar.claims.claims import read_motion_test

        test = read_motion_test(self.path)
        for capture in test.captures:
            for claim in test.claims:
                name = f"{Path(capture).name}: {claim}"
                yield ClaimItem.from_parent(
                    self, name=name, test=test, capture=capture, claim=claim
                )

    def repr_failure(  # type: ignore[override]  # pytest's own collectors take no style either
        self, excinfo: pytest.ExceptionInfo[BaseException]
    ) -> Any:
        """What is wrong with the file, without a traceback."""
        return _told(excinfo) or super().repr_failure(excinfo)


class ClaimItem(pytest.Item):
    """One claim about one capture."""

    def __init__(self, *, test: Any, capture: str, claim: str, **others: Any) -> None:
        """Keep what is to be judged."""
        super().__init__(**others)
        self.test, self.capture, self.claim = test, capture, claim

    def runtest(self) -> None:
        """Judge the claim."""
        from dataclasses import replace

        from capar.claims.claims import run_motion_test

        one = replace(self.test, captures=(self.capture,), claims=(self.claim,))
        for verdict in run_motion_test(one):
            if not verdict.holds:
                told = verdict.mistake or f"found: {verdict.found}"
                raise ClaimFailedError(f"{verdict.claim}\n{told}")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> str:
        """The claim and what was found, without a traceback."""
        return _told(excinfo) or str(super().repr_failure(excinfo, style))

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where the claim stands."""
        return self.path, None, self.name


def _told(excinfo: pytest.ExceptionInfo[BaseException]) -> str:
    """The message of a user's mistake or of a claim that fails; empty for anything else."""
    from capar.model.errors import CaparError

    return str(excinfo.value) if isinstance(excinfo.value, ClaimFailedError | CaparError) else ""
