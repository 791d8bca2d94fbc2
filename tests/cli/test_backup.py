"""An Actionary is backed up and restored whole, and none is made by a typing mistake."""

from pathlib import Path

import pytest
from observations import drink_from_mug, pick_up_with_both_hands
from typer.testing import CliRunner, Result

from capar.cli import app
from capar.model.errors import FileError
from capar.model.observation import SegmentAddress
from kb.actionary import Actionary
from kb.corrections import Correction, correct

RUNNER = CliRunner()
SIP = '%* Sip: sip. *%\nprimitive("Sip").\n'


def capar(*words: object, terminal: bool = False, answer: str = "") -> Result:
    with pytest.MonkeyPatch.context() as patch:
        if terminal:
            patch.setattr("capar.cli.options.can_ask", lambda: True)
        return RUNNER.invoke(app, [str(each) for each in words], input=answer)


@pytest.fixture
def known(tmp_path: Path) -> Path:
    place = tmp_path / "actionary"
    with Actionary.open(place) as actionary:
        actionary.add(drink_from_mug())
        actionary.add(pick_up_with_both_hands())
        address = SegmentAddress("right_hand", 1, "DrinkFromMug")
        correct(actionary.store, address, Correction(name="Sip"), by="Ada")
        actionary.declare_agent("Ada")
    (place / "rules").mkdir()
    (place / "rules" / "sip.lp").write_text(SIP)
    return place


def held(place: Path) -> set[str]:
    with Actionary.open(place, read_only=True) as actionary:
        return {str(each) for each in actionary.store.quads()}


def test_what_is_restored_from_a_backup_is_what_was_there(known: Path, tmp_path: Path) -> None:
    file, again = tmp_path / "kept.nq", tmp_path / "restored"
    done = capar("backup", file, "--actionary", known)
    assert done.exit_code == 0
    assert f"capar import {file}" in done.output
    assert (tmp_path / "kept.rules" / "sip.lp").read_text() == SIP
    assert capar("import", file, "--actionary", again, "--new").exit_code == 0
    assert held(again) == held(known)


def test_a_backup_has_a_name_of_its_own_and_takes_no_others_place(known: Path) -> None:
    assert capar("backup", "--actionary", known).exit_code == 0
    (made,) = known.parent.glob("actionary.*.nq")
    before = made.read_bytes()
    refused = capar("backup", made, "--actionary", known).exception
    assert isinstance(refused, FileError)
    assert made.read_bytes() == before


@pytest.mark.parametrize("place", ["actonary", "nowhere/actionary"])
def test_a_mistyped_place_is_refused_with_the_remedy_and_nothing_is_made(
    known: Path, tmp_path: Path, place: str
) -> None:
    file = tmp_path / "kept.nq"
    capar("backup", file, "--actionary", known)
    before = sorted(tmp_path.rglob("*"))
    refused = capar("import", file, "--actionary", tmp_path / place).exception
    assert isinstance(refused, FileError)
    assert "--new" in str(refused)
    assert ("Did you mean" in str(refused)) is (place == "actonary")
    assert sorted(tmp_path.rglob("*")) == before
    assert capar("import", file, "--actionary", tmp_path / place, "--new").exit_code == 0


def test_one_at_a_terminal_is_asked_before_an_actionary_is_made(
    known: Path, tmp_path: Path
) -> None:
    file, other = tmp_path / "kept.nq", tmp_path / "other"
    capar("backup", file, "--actionary", known)
    asked = capar("import", file, "--actionary", other, terminal=True, answer="n\n")
    assert "Make a new one?" in asked.output
    assert isinstance(asked.exception, FileError)
    assert not other.exists()
    assert capar("import", file, "--actionary", other, terminal=True, answer="y\n").exit_code == 0
    assert other.is_dir()


def test_a_place_of_another_name_needs_no_answer_where_nobody_can_be_asked(
    known: Path, tmp_path: Path
) -> None:
    file = tmp_path / "kept.nq"
    capar("backup", file, "--actionary", known)
    assert capar("import", file, "--actionary", tmp_path / "kitchen").exit_code == 0
