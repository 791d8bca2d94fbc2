"""Commands run in the process of a test, of which only the exit code and what is printed matter."""

import pytest

from capar.cli import main


def exit_code(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    """The exit code of ``capar`` with these arguments."""
    monkeypatch.setattr("sys.argv", ["capar", *arguments])
    try:
        main()
    except SystemExit as end:
        return int(end.code or 0)
    return 0
