"""Long work shows how far it is where somebody looks, and nowhere else."""

import io

import pytest

from capar.cli.output import progress


class Terminal(io.StringIO):
    """A standard error that somebody looks at."""

    def isatty(self) -> bool:
        return True


def test_on_a_terminal_a_bar_says_what_is_done_and_nothing_is_left_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    screen = Terminal()
    monkeypatch.setattr("sys.stderr", screen)
    assert list(progress("observing")(["one", "two", "three"])) == ["one", "two", "three"]
    assert "observing" in screen.getvalue()


@pytest.mark.parametrize(("terminal", "steps"), [(False, 3), (True, 1)])
def test_in_a_pipe_and_for_one_step_nothing_is_shown(
    terminal: bool, steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = Terminal() if terminal else io.StringIO()
    monkeypatch.setattr("sys.stderr", screen)
    assert list(progress("observing")(range(steps))) == list(range(steps))
    assert screen.getvalue() == ""
