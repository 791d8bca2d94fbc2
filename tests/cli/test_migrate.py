"""The command that migrates what an older program kept, and addresses that commands print."""

import gzip
import json
from pathlib import Path

import pytest
from pyoxigraph import RdfFormat
from pyoxigraph import Store as Oxigraph
from typer.testing import CliRunner

from capar.cli import app
from capar.model.errors import FileError
from capar.model.json_form import from_json
from kb.errors import SchemaError, StoreError
from kb.store.embedded import DATA_FOLDER
from kb.store.schema import SCHEMA

FIXTURE = Path(__file__).parents[1] / "fixtures" / "schema-1"
RUNNER = CliRunner()


def old_folder(place: Path) -> Path:
    (place / DATA_FOLDER).mkdir(parents=True)
    store = Oxigraph(place / DATA_FOLDER)
    text = gzip.decompress((FIXTURE / "actionary.nq.gz").read_bytes())
    store.bulk_load(text, RdfFormat.N_QUADS)
    store.flush()
    return place


@pytest.mark.parametrize(
    "command",
    [("query", "actions"), ("check",), ("export",), ("show", "x"), ("forget", "x"), ("verb", "go")],
    ids=" ".join,
)
def test_every_command_refuses_an_older_actionary(command: tuple[str, ...], tmp_path: Path) -> None:
    place = old_folder(tmp_path / "known")
    done = RUNNER.invoke(app, [*command, "--actionary", str(place)])
    assert isinstance(done.exception, SchemaError)
    assert f"run: capar migrate --actionary {place}" in str(done.exception)


def test_the_command_that_the_refusal_names_mends_it(tmp_path: Path) -> None:
    place = old_folder(tmp_path / "known")
    done = RUNNER.invoke(app, ["migrate", "--actionary", str(place)])
    kept = tmp_path / "known.schema-1.nq"
    assert done.output == f"{place}: migrated from schema 1 to {SCHEMA}; backup: {kept}\n"
    assert "drink_from_mug" in RUNNER.invoke(app, ["query", "observations", "--actionary",
                                                   str(place)]).output  # fmt: skip
    again = RUNNER.invoke(app, ["migrate", "--actionary", str(place)])
    assert again.output == f"{place}: is of schema {SCHEMA} already\n"
    restored = tmp_path / "restored"
    assert RUNNER.invoke(app, ["import", str(kept), "--actionary", str(restored)]).exit_code == 0


def test_a_file_is_migrated_beside_its_backup(tmp_path: Path) -> None:
    file = tmp_path / "seen.json"
    old = gzip.decompress((FIXTURE / "observation.json.gz").read_bytes())
    file.write_bytes(old)
    done = RUNNER.invoke(app, ["migrate", str(file)])
    assert done.exit_code == 0, done.output
    assert (tmp_path / "seen.schema-1.json").read_bytes() == old
    assert from_json(file.read_text("utf-8")).capture == json.loads(old)["capture"]
    assert "already" in RUNNER.invoke(app, ["migrate", str(file)]).output


def test_what_is_not_there_is_not_made(tmp_path: Path) -> None:
    done = RUNNER.invoke(app, ["migrate", "--actionary", str(tmp_path / "none")])
    assert isinstance(done.exception, StoreError)
    assert "no Actionary there" in str(done.exception)
    assert not list(tmp_path.iterdir())
    assert isinstance(RUNNER.invoke(app, ["migrate", str(tmp_path / "a.json")]).exception, OSError)
    (tmp_path / "b.json").write_bytes(b"\xff\xfe")
    wrong = RUNNER.invoke(app, ["migrate", str(tmp_path / "b.json")])
    assert isinstance(wrong.exception, FileError)
