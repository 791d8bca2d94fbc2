"""What an older program kept is migrated with a backup, or refused with what to do about it."""

import gzip
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from observations import drink_from_mug
from pyoxigraph import RdfFormat
from pyoxigraph import Store as Oxigraph

from capar.model.errors import FileError, ParError
from capar.model.json_form import document, from_json, to_json
from capar.model.observation import SegmentAddress
from kb.actionary import Actionary
from kb.errors import SchemaError, ShapeError
from kb.exchange import bring_in, export, read
from kb.migration import migrate
from kb.queries.questions import questions
from kb.schema_steps import STEPS
from kb.store.embedded import DATA_FOLDER
from kb.store.names import GRAPHS
from kb.store.schema import SCHEMA, version
from kb.store.stores import open_store
from kb.store_checks import check
from ontology import CAPAR

FIXTURES = Path(__file__).parents[1] / "fixtures"
OLDER = sorted(FIXTURES.glob("schema-*"))
MARK = f"{GRAPHS['ontology']} {CAPAR.schemaVersion}"


def stored(folder: Path) -> bytes:
    """Every statement that a program of an older schema kept, as N-Quads."""
    return gzip.decompress((folder / "actionary.nq.gz").read_bytes())


def written(folder: Path, place: Path) -> Path:
    """A folder as a program of an older schema left it."""
    (place / DATA_FOLDER).mkdir(parents=True)
    store = Oxigraph(place / DATA_FOLDER)
    store.bulk_load(stored(folder), RdfFormat.N_QUADS)
    store.flush()
    return place


@pytest.fixture(params=OLDER, ids=lambda each: each.name)
def older(request: pytest.FixtureRequest) -> Iterator[Path]:
    """The fixture of each older schema."""
    yield request.param


@pytest.fixture(
    params=sorted(FIXTURES.glob("schema-*/observation.json.gz")),
    ids=lambda each: each.parent.name,
)
def older_json(request: pytest.FixtureRequest) -> Iterator[str]:
    """An observation as JSON of each older form: it changes less often than the store's."""
    yield gzip.decompress(request.param.read_bytes()).decode()


def asked(actionary: Actionary, folder: Path) -> list[dict[str, Any]]:
    """What is answered to the questions that were asked, in the columns that there were then."""
    told = json.loads((folder / "answers.json").read_text("utf-8"))
    for each in told:
        columns = list(each["rows"][0]) if each["rows"] else []
        now = actionary.ask(each["question"], **each["parameters"])
        rows = [{name: row[name] for name in columns} for row in now]
        each["rows"] = sorted(rows, key=repr) if columns else now
    return told


def before(folder: Path) -> list[dict[str, Any]]:
    """What was answered then."""
    told = json.loads((folder / "answers.json").read_text("utf-8"))
    return [each | {"rows": sorted(each["rows"], key=repr)} for each in told]


def test_each_older_schema_has_a_fixture_and_a_step_to_the_next_one() -> None:
    assert [each.name for each in OLDER] == [f"schema-{each}" for each in range(1, SCHEMA)]
    assert list(STEPS) == list(range(1, SCHEMA))


def test_an_older_folder_is_refused_with_the_command_that_migrates_it(
    older: Path, tmp_path: Path
) -> None:
    place = written(older, tmp_path / "old")
    for read_only in (True, False):
        with pytest.raises(SchemaError) as raised:
            Actionary.open(place, read_only=read_only)
        assert f"run: capar migrate --actionary {place}" in str(raised.value)
    Actionary.open(tmp_path / "other").close()  # the refusal let go of everything


def test_a_migrated_folder_answers_every_question_as_before(older: Path, tmp_path: Path) -> None:
    place = written(older, tmp_path / "old")
    done = migrate(str(place))
    with Actionary.open(place) as actionary:
        answers = before(older)
        assert {each["question"] for each in answers} <= set(questions())
        assert sum(bool(each["rows"]) for each in answers) > 10
        assert asked(actionary, older) == answers
        assert check(actionary.store, full=False) == ()
        assert version(actionary.store) == SCHEMA
    assert done.backup == tmp_path / f"old.schema-{done.found}.nq"
    assert set(done.backup.read_bytes().splitlines()) >= set(stored(older).splitlines())
    assert migrate(str(place)).backup is None


def test_a_migrated_segment_has_the_address_that_one_kept_now_has(
    older: Path, tmp_path: Path
) -> None:
    place = written(older, tmp_path / "old")
    migrate(str(place))
    query = "SELECT ?a ?ee ?i { ?s capar:address ?a ; capar:ee ?ee ; capar:index ?i }"
    with Actionary.open(place, read_only=True) as actionary:
        rows = list(actionary.query(query).plain())
        (seen,) = actionary.observations()
    assert rows
    for row in rows:
        address = SegmentAddress(str(row["ee"]), int(str(row["i"])), seen.name)
        assert SegmentAddress.parse(str(row["a"])) == address


def test_an_export_of_an_older_schema_is_migrated_as_it_is_imported(older: Path) -> None:
    target = Actionary.in_memory()
    bring_in(target.store, read(stored(older), "nquads"))
    answers = before(older)
    assert asked(target, older) == answers
    assert check(target.store, full=False) == ()


def test_a_failed_backup_leaves_the_folder_as_it_was(older: Path, tmp_path: Path) -> None:
    place = written(older, tmp_path / "old")
    backup = tmp_path / f"old.{older.name}.nq"
    backup.write_text("mine")
    with pytest.raises(FileError, match=r"exists already.*--backup"):
        migrate(str(place))
    store = open_store(place, read_only=True)
    assert older.name == f"schema-{version(store)}"
    assert backup.read_text() == "mine"


@pytest.mark.parametrize(
    ("said", "told"), [("99", "newer program"), ('"old"', "restore"), ("0", "restore")]
)
def test_a_store_of_another_schema_is_refused_with_the_remedy(
    said: str, told: str, tmp_path: Path
) -> None:
    place = tmp_path / "odd"
    with Actionary.open(place) as actionary:
        update = f"DELETE WHERE {{ GRAPH ?g {{ {MARK} ?v }} }} ; "
        graph = GRAPHS["ontology"]
        actionary.store.change(f"{update} INSERT DATA {{ GRAPH {graph} {{ {MARK} {said} }} }}")
    for opening in (lambda: Actionary.open(place), lambda: migrate(str(place))):
        with pytest.raises(SchemaError, match=told):
            opening()


def test_an_export_of_a_newer_schema_is_refused_and_leaves_nothing() -> None:
    source, target = Actionary.in_memory(), Actionary.in_memory()
    source.add(drink_from_mug())
    lines = export(source.store, "nquads", observation="DrinkFromMug").decode()
    newer = lines.replace(f'{CAPAR.schemaVersion} "{SCHEMA}"', f'{CAPAR.schemaVersion} "99"')
    assert newer != lines
    with pytest.raises(SchemaError, match="schema 99; a newer program"):
        bring_in(target.store, read(newer.encode(), "nquads"))
    assert target.observations() == ()


def test_statements_that_break_the_model_are_refused_after_their_migration_too(
    older: Path,
) -> None:
    text = stored(older).replace(b'ontology#side> "right"', b'ontology#side> "up"')
    with pytest.raises(ShapeError):
        bring_in(Actionary.in_memory().store, read(text, "nquads"))


def test_an_older_observation_as_json_is_refused_and_migrated(older_json: str) -> None:
    from capar.model.json_form import SCHEMA as JSON_SCHEMA
    from capar.model.json_form import migrated
    from capar.model.json_form import version as json_version

    with pytest.raises(ParError, match=r"a\.json: .*run: capar migrate a\.json"):
        from_json(older_json, where="a.json")
    seen = from_json(migrated(older_json))
    assert json_version(to_json(seen)) == JSON_SCHEMA
    now, then = document(seen), json.loads(older_json)
    assert {each: now[each] for each in ("capture", "links", "complex_par")} == {
        each: then[each] for each in ("capture", "links", "complex_par")
    }


@pytest.mark.parametrize(
    ("schema", "told"), [(99, "newer program"), ("2", "whole number"), (0, "whole number")]
)
def test_an_observation_as_json_of_another_schema_is_refused(schema: object, told: str) -> None:
    content = document(drink_from_mug()) | {"schema": schema}
    with pytest.raises(ParError, match=told):
        from_json(json.dumps(content), where="a.json")


def test_facts_of_a_kind_that_is_no_longer_measured_are_left_out(
    older: Path, tmp_path: Path
) -> None:
    from kb.lookup.facts import facts

    target = Actionary.in_memory()
    bring_in(target.store, read(stored(older), "nquads"))
    (seen,) = target.observations()
    before = facts(target.store, seen.name)
    graph = f"<https://w3id.org/capar/data/observation/{seen.name}>"
    target.store.change(
        f"INSERT DATA {{ GRAPH {graph} {{ {graph} {CAPAR.fact} <http://x/1> . <http://x/1> "
        f'a {CAPAR.Fact} ; {CAPAR.name} "phlogiston" ; {CAPAR.parameters} "mug 3" }} }}'
    )
    assert before and facts(target.store, seen.name) == before


def test_an_older_document_may_state_facts_that_are_no_longer_measured(older_json: str) -> None:
    from capar.model.json_form import migrated

    content = json.loads(older_json)
    count = len(from_json(migrated(json.dumps(content))).facts)
    content["facts"].append("phlogiston(mug,3)")
    assert len(from_json(migrated(json.dumps(content))).facts) == count
