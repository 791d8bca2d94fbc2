"""A store whose files were damaged ends no command in a traceback, and says what to do."""

import shutil
from collections.abc import Callable
from importlib import resources
from pathlib import Path

import pytest
from observations import drink_from_mug, pick_up_with_both_hands
from typer.testing import CliRunner

from capar.cli import app
from kb.actionary import Actionary
from kb.errors import DamagedError, StoreError, TimeLimitError
from kb.store import stores
from kb.store.stores import DATA_FOLDER

DEMO = str(resources.files("capar") / "demo" / "drink_from_mug")
RUNNER = CliRunner()

Damage = Callable[[Path], object]


def flipped(share: float) -> Damage:
    """A bit is another one, so far into the file."""

    def flip(file: Path) -> None:
        content = bytearray(file.read_bytes())
        content[min(int(share * len(content)), len(content) - 1)] ^= 0x10
        file.write_bytes(content)

    return flip


def cut(share: float) -> Damage:
    """Only so much of the file is left."""
    return lambda file: file.write_bytes(file.read_bytes()[: int(share * file.stat().st_size)])


KINDS: dict[str, Damage] = {
    "a flip at its start": flipped(0.0),
    "a flip in its middle": flipped(0.5),
    "a flip at its end": flipped(1.0),
    "nothing left": cut(0.0),
    "half of it left": cut(0.5),
    "gone": Path.unlink,
}
FILES = ("CURRENT", "MANIFEST-*", "smallest *.sst", "largest *.sst")
"""What is damaged, by the names that RocksDB gives; logs and options may be lost without harm."""

READING = (
    ("check",),
    ("query", "actions", "--time-limit", "10"),
    ("show", "DrinkFromMug"),
    ("export",),
)
WRITING = (("forget", "DrinkFromMug"), ("observe", DEMO, "--on-unknown", "keep"))


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("whole") / "known"
    with Actionary.open(place) as actionary:
        actionary.add(drink_from_mug())
        actionary.add(pick_up_with_both_hands())
    return place


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing writes beside these readers, so that they need not try again for long."""
    monkeypatch.setattr(stores, "TRIES", 2)


def chosen(place: Path, which: str) -> Path:
    *size, pattern = which.split(" ")
    files = sorted((place / DATA_FOLDER).glob(pattern), key=lambda each: each.stat().st_size)
    return files[-1] if size != ["smallest"] else files[0]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("which", FILES)
def test_a_damaged_store_ends_no_command_in_a_traceback(
    which: str, kind: str, whole: Path, tmp_path: Path
) -> None:
    place = Path(shutil.copytree(whole, tmp_path / "known"))
    KINDS[kind](chosen(place, which))
    said = []
    for number, command in enumerate((*READING, *WRITING)):
        copy = Path(shutil.copytree(place, tmp_path / str(number)))
        done = RUNNER.invoke(app, [*command, "--actionary", str(copy)])
        known = StoreError | TimeLimitError | SystemExit
        assert done.exception is None or isinstance(done.exception, known), command
        # The database may repeat a failed read for ever, until the time limit of a query.
        said.append("" if isinstance(done.exception, TimeLimitError) else str(done.exception or ""))
    assert said[0], "check found nothing"
    for each in filter(None, said):
        assert "capar import FILE" in each and "observe the captures again" in each


def test_a_store_without_its_table_of_contents_is_not_begun_anew(
    whole: Path, tmp_path: Path
) -> None:
    place = Path(shutil.copytree(whole, tmp_path / "known"))
    for file in ("CURRENT", *(each.name for each in (place / DATA_FOLDER).glob("*.log"))):
        (place / DATA_FOLDER / file).unlink()
    before = sorted((place / DATA_FOLDER).iterdir())
    with pytest.raises(DamagedError, match="CURRENT is missing"):
        Actionary.open(place)
    assert sorted((place / DATA_FOLDER).iterdir()) == before


def test_a_damaged_answer_to_a_users_query_says_so_too(whole: Path, tmp_path: Path) -> None:
    place = Path(shutil.copytree(whole, tmp_path / "known"))
    with Actionary.open(place, read_only=True) as actionary:
        flipped(0.5)(chosen(place, "MANIFEST-*"))
        with pytest.raises(StoreError, match="restore it from a backup or export"):
            actionary.query("SELECT ?s { ?s ?p ?o }")
