"""Rule files are read as they are now, however often they were read before."""

from pathlib import Path

import pytest

from capar.model.errors import RuleError
from capar_rules.engine import syntax
from capar_rules.engine.syntax import parse


def texts(path: Path) -> list[str]:
    return [each.text for each in parse([path])]


@pytest.fixture
def including(tmp_path: Path) -> Path:
    """A file that includes another one, ``below.lp``."""
    (tmp_path / "below.lp").write_text("a(1).\n")
    path = tmp_path / "top.lp"
    path.write_text('#include "below.lp".\nb(X) :- a(X).\n')
    return path


def test_a_file_that_did_not_change_is_parsed_once(
    including: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = parse([including])
    monkeypatch.setattr(syntax, "_parsed", lambda run: pytest.fail("it was parsed again"))
    assert parse([including]) is first


@pytest.mark.parametrize("name", ["top.lp", "below.lp"])
def test_what_changes_in_a_file_or_in_one_that_it_includes_is_read(
    including: Path, name: str
) -> None:
    before = texts(including)
    changed = including.with_name(name)
    changed.write_text(changed.read_text() + "c(2).\n")
    assert sorted(texts(including)) == sorted([*before, "c(2)."])


def test_a_file_that_cannot_be_parsed_any_more_is_an_error_until_it_is_mended(
    including: Path,
) -> None:
    whole, before = including.read_text(), texts(including)
    including.write_text(f"{whole}c(.\n")
    for _ in range(2):
        with pytest.raises(RuleError, match="syntax error"):
            parse([including])
    including.write_text(whole)
    assert texts(including) == before


def test_an_included_file_that_is_gone_is_an_error(including: Path) -> None:
    assert texts(including)
    including.with_name("below.lp").unlink()
    with pytest.raises(RuleError, match=r"below\.lp"):
        parse([including])


def test_only_the_last_lists_of_files_are_kept(tmp_path: Path) -> None:
    for number in range(2 * syntax.ANSWERS):
        path = tmp_path / f"{number}.lp"
        path.write_text(f"a({number}).\n")
        parse([path])
    assert len(syntax._answers) == syntax.ANSWERS
