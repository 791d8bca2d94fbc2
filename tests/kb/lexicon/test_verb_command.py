"""What `capar verb` says of verbs that were seen, that were not, and that there are not."""

from pathlib import Path

import pytest
from observations import MUG, Piece, observation
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import UnknownNameError
from capar.model.facts import Intended
from capar.model.par import FeatureSet
from kb.actionary import Actionary

RUNNER = CliRunner()
STILL = FeatureSet("0", "0", "0", "hand", "0")


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No Actionary and no rules of somebody's own stand around."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("CAPAR_ACTIONARY", raising=False)
    monkeypatch.delenv("CAPAR_RULES", raising=False)


@pytest.fixture
def book(tmp_path: Path) -> str:
    """Three lifts, two of them for two ends, then a touch."""
    pieces = tuple(
        Piece(name, 10 * index, ("mug",), purpose, STILL)
        for index, (name, purpose) in enumerate(
            (("Lift", "Drink"), ("Lift", "Show"), ("Lift", "Touch"), ("Touch", "")), 1
        )
    )
    stated = (Intended(0, "Lift", "any", "any", "Drink"), Intended(1, "any", "any", "any", "Show"))
    seen = observation(
        "Toast", {"right_hand": pieces}, (MUG,), facts=stated, frames=41, rate_hz=100.0
    )
    with Actionary.open(tmp_path / "book") as actionary:
        actionary.add(seen)
    return str(tmp_path / "book")


def run(*arguments: str) -> str:
    result = RUNNER.invoke(app, list(arguments), catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def seen_lines(told: str) -> list[str]:
    return [each for each in told.splitlines() if each.startswith("Seen:")]


def test_what_was_seen_of_a_primitive_is_summed_over_its_purposes(book: str) -> None:
    assert seen_lines(run("verb", "lift", "--actionary", book)) == ["Seen: Lift in Toast, 3 times."]
    assert "  Toast: Lift, 3 times\n" in run("verb", "move", "--kinds", "--actionary", book)


def test_a_verb_of_which_only_the_more_general_was_seen_was_not_seen(book: str) -> None:
    told = run("verb", "slap", "--actionary", book)
    assert "slap: not represented; only what is more general is: HitAway" in told
    assert not seen_lines(told)


@pytest.mark.parametrize("more", [(), ("--kinds",)])
def test_an_unknown_verb_is_told_with_the_nearest(more: tuple[str, ...]) -> None:
    for verb, near in (("coverr", "cover"), ("xyzzy", "dizzy")):
        result = RUNNER.invoke(app, ["verb", verb, *more])
        assert isinstance(result.exception, UnknownNameError)
        message = str(result.exception)
        assert message.startswith(f"no verb {verb!r} is known; the nearest ")
        assert near in message
        assert "none" not in message


def test_what_a_rule_file_states_wrongly_is_told_beside_the_answer(tmp_path: Path) -> None:
    rules = tmp_path / "mine"
    rules.mkdir()
    (rules / "cover.lp").write_text(
        "%* Cover: over all of it. *%\n"
        'primitive("Cover").\nverb("Cover", "coverr").\nlevin("Cover", "99.9").\n'
        'sense("Cover", 77).\nfeature_row("Cover", any, "1", "0", "1", "1").\n'
    )
    told = run("verb", "coverr", "--rules", str(rules))
    assert "coverr: represented by Cover." in told
    lines = [each for each in told.splitlines() if each.startswith("note [unknown-word]: ")]
    assert [each.partition("Cover: ")[2].partition(";")[0] for each in lines] == [
        "WordNet has no verb 'coverr'",
        "Levin has no class '99.9'",
        "WordNet has no sense 77 of 'coverr'",
    ]
    assert "note" not in run("verb", "cover")
