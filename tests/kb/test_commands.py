"""The commands of the Actionary: query, show, export, import, check, forget."""

import csv
import io
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeAlias

import pytest
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.cli import main
from kb.actionary import Actionary
from kb.queries.questions import questions


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("commands") / "actionary"
    with Actionary.open(place) as actionary:
        for made in (drink_from_mug, pick_up_with_both_hands, with_unknown):
            actionary.add(made())
    return place


@dataclass(frozen=True)
class Done:
    """What a command printed, and how it ended."""

    returncode: int
    stdout: str
    stderr: str


def capar(*words: str, at: Path | None = None, given: str = "") -> Done:
    """Run a command in this process, as its main function does."""
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8") for _ in range(2))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["capar", *words])
        patch.setattr(sys, "stdin", io.StringIO(given))
        patch.setattr(sys, "stdout", out)
        patch.setattr(sys, "stderr", err)
        if at is not None:
            patch.setenv("CAPAR_ACTIONARY", str(at))
        try:
            main()
            code = 0
        except SystemExit as end:
            code = int(end.code or 0)
    return Done(code, *(_text(each) for each in (out, err)))


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    stream.seek(0)
    return stream.read()


def test_the_list_names_every_question_and_what_it_asks() -> None:
    done = capar("query", "--list", "--json")
    listed = json.loads(done.stdout)
    assert [each["name"] for each in listed] == list(questions())
    assert all(each["question"].endswith((".", "?")) for each in listed)


def test_a_named_question_prints_a_table_csv_json_and_turtle(folder: Path) -> None:
    table = capar("query", "hand", "action=Reach", at=folder)
    assert table.stdout.splitlines()[0].split() == ["ee", "side", "segments"]
    rows = list(
        csv.reader(
            io.StringIO(capar("query", "hand", "action=Reach", "--format", "csv", at=folder).stdout)
        )
    )
    assert rows == [
        ["ee", "side", "segments"],
        ["right_hand", "right", "3"],
        ["left_hand", "left", "1"],
    ]
    found = json.loads(capar("query", "hand", "action=Reach", "--json", at=folder).stdout)
    assert found[0] == {"ee": "right_hand", "side": "right", "segments": 3}
    from rdflib import Graph

    turtle = capar("query", "hand", "action=Reach", "--format", "turtle", at=folder).stdout
    assert len(Graph().parse(data=turtle, format="turtle")) > 10


def test_sparql_comes_from_a_string_a_file_or_standard_input(folder: Path, tmp_path: Path) -> None:
    text = "SELECT (COUNT(?s) AS ?n) WHERE { ?s a capar:UnknownSegment }"
    file = tmp_path / "mine.rq"
    file.write_text(text)
    for done in (
        capar("query", text, "--json", at=folder),
        capar("query", str(file), "--json", at=folder),
        capar("query", "-", "--json", at=folder, given=text),
    ):
        assert json.loads(done.stdout) == [{"n": 1}], done.stderr


def test_an_action_is_shown_as_text_and_turtle(folder: Path) -> None:
    text = capar("show", "DrinkFromMug", at=folder).stdout
    assert "1. Reach(mug) to PickUp" in text and "0.444" in text and "every link" in text
    assert (
        "left_hand 1 equals right_hand 1" in capar("show", "PickUpWithBothHands", at=folder).stdout
    )
    from rdflib import Graph

    turtle = capar("show", "DrinkFromMug", "--format", "turtle", at=folder).stdout
    graph = Graph().parse(data=turtle, format="turtle")
    assert len(list(graph.query("SELECT ?s { ?s a <https://w3id.org/capar/ontology#Step> }"))) == 6
    unknown = capar("show", "DrinkFromCup", at=folder)
    assert unknown.returncode == 2 and "DrinkFromMug" in unknown.stderr


def test_export_import_check_and_forget_work_together(folder: Path, tmp_path: Path) -> None:
    file, other = tmp_path / "all.trig", tmp_path / "other"
    assert capar("export", str(file), at=folder).returncode == 0
    brought = capar("import", str(file), at=other)
    assert brought.returncode == 0 and "3 observations" in brought.stdout
    again = capar("export", "--format", "trig", at=other)
    assert again.stdout == file.read_text()
    checked = capar("check", at=other)
    assert checked.returncode == 0 and checked.stdout == "3 observations, 0 problems\n"
    assert capar("forget", "Strange", at=other).stdout == "forgot Strange\n"
    rows = json.loads(capar("query", "observations", "--json", at=other).stdout)
    assert [row["observation"] for row in rows] == ["DrinkFromMug", "PickUpWithBothHands"]
    gone = capar("forget", "Strange", at=other)
    assert gone.returncode == 2 and "there are: DrinkFromMug, PickUpWithBothHands" in gone.stderr


def test_check_finds_what_is_wrong_and_ends_with_2(tmp_path: Path) -> None:
    place = tmp_path / "broken"
    with Actionary.open(place) as actionary:
        actionary.add(drink_from_mug())
        actionary.store.change(BREAKING)
    done = capar("check", at=place)
    assert done.returncode == 2
    assert "lies outside the reach" in done.stdout
    assert "of which nothing is said" in done.stdout
    problems = json.loads(capar("check", "--json", at=place).stdout)
    assert {each["observation"] for each in problems} == {"DrinkFromMug"}


GRAPH = "https://w3id.org/capar/data/observation/DrinkFromMug"
BREAKING = f"""PREFIX capar: <https://w3id.org/capar/ontology#>
WITH <{GRAPH}>
DELETE {{ ?l capar:goalNlt ?n }}
INSERT {{ ?l capar:goalNlt "9.0 0.0 0.0 1.0 0.0 0.0 0.0"^^capar:nlt }}
WHERE {{ ?l capar:goalNlt ?n }} ;
DELETE WHERE {{ GRAPH <{GRAPH}> {{ <{GRAPH}#segment.right_hand.2> ?p ?o }} }}"""


def test_the_actionary_is_what_the_option_says_before_the_environment(
    folder: Path, tmp_path: Path
) -> None:
    rows = capar("query", "actions", "--json", "--actionary", str(folder), at=tmp_path / "none")
    assert rows.returncode == 0 and json.loads(rows.stdout)
    nowhere = capar("query", "actions", at=tmp_path / "none")
    assert nowhere.returncode == 2 and "no Actionary there" in nowhere.stderr


WRONG = (
    ("touching object=mugg", "no object 'mugg'; there are: ", "Did you mean 'mug'?"),
    ("goal goal=shelf action=MoveObjTo", "no object 'shelf'; there are: ", "mug"),
    ("goal goal=mug action=MoveObjTwo", "no action 'MoveObjTwo'; there are: ", "'MoveObjTo'?"),
    ("performers action=Reech", "no action 'Reech'; there are: ", "Did you mean 'Reach'?"),
    ("shared first=Drink second=DrinkFromMug", "no whole action 'Drink'; there are: ", "Strange"),
    ("notices observation=DrinkFromMugg", "no observation 'DrinkFromMugg'", "'DrinkFromMug'?"),
    ("world capture=nope time=1", "no capture 'nope'; there are: ", "DrinkFromMug"),
    ("world capture=DrinkFromMug time=99", "DrinkFromMug lasts from 0 to ", "99 s lies outside"),
    ("world capture=DrinkFromMug time=-1", "DrinkFromMug lasts from 0 to ", "-1 s lies outside"),
)


@pytest.mark.parametrize(("asked", "told", "hint"), WRONG)
def test_a_question_about_what_is_not_there_is_a_mistake(
    asked: str, told: str, hint: str, folder: Path
) -> None:
    done = capar("query", *asked.split(), at=folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert f"{folder}: {told}" in done.stderr and hint in done.stderr


@pytest.mark.parametrize(("name", "text"), [("e.ttl", ""), ("e.jsonld", "[]"), ("e.nq", "# no\n")])
def test_a_file_without_statements_is_a_mistake_and_makes_no_actionary(
    name: str, text: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(text)
    done = capar("import", str(tmp_path / name), at=tmp_path / "new")
    assert (done.returncode, done.stdout) == (2, "")
    assert f"{tmp_path / name}: holds no statements" in done.stderr
    assert [each.name for each in tmp_path.iterdir()] == [name]


def test_a_full_disk_is_told_with_the_file(folder: Path) -> None:
    done = capar("export", "/dev/full", "--format", "trig", at=folder)
    assert done.returncode == 2
    assert (
        "capar: /dev/full: cannot be used: No space left on device. Free some space" in done.stderr
    )


Ask: TypeAlias = Callable[..., Done]


@pytest.fixture
def ask(folder: Path) -> Ask:
    """A command that asks the Actionary."""
    return partial(capar, at=folder)


def test_what_begins_as_sparql_is_no_questions_name(ask: Ask) -> None:
    described = ask("query", "DESCRIBE <https://w3id.org/capar/data/observation/Strange>")
    assert described.returncode == 0 and "capar:Observation" in described.stdout
    prologue = "BASE <https://w3id.org/capar/data/> describe <observation/Strange>"
    assert ask("query", prologue).stdout == described.stdout
    long = ask("query", f"DESCRIBE <urn:{'a' * 5000}>")
    assert (long.returncode, long.stdout.split()) == (0, ["subject", "predicate", "object"])
    for text in ("DROP ALL", "LOAD <http://127.0.0.1/x>", "PREFIX a: <b:c> clear all"):
        writes = ask("query", text)
        assert writes.returncode == 2 and "may not write" in writes.stderr, text
    for text in ("", "  ", "# nothing"):
        empty = ask("query", text)
        assert empty.returncode == 2 and "the query is empty" in empty.stderr
    empty = ask("query", "-", given="")
    assert empty.returncode == 2 and "the query is empty" in empty.stderr


@pytest.mark.parametrize("limit", ["nan", "inf", "-1", "0"])
def test_a_time_limit_that_is_none_is_refused(limit: str, ask: Ask) -> None:
    done = ask("query", "actions", "--time-limit", limit)
    assert (done.returncode, done.stdout) == (2, "")
    assert "a positive number of seconds" in done.stderr


def test_several_actions_are_asked_for_with_a_comma(ask: Ask) -> None:
    def rows(action: str) -> list[dict[str, object]]:
        return json.loads(ask("query", "segments", f"action={action}", "--json").stdout)

    both = rows("MoveObj,MoveObjTo")
    assert both
    assert sorted(map(str, both)) == sorted(map(str, [*rows("MoveObj"), *rows("MoveObjTo")]))


def test_a_verb_is_not_asked_of_an_actionary_without_a_lexicon(ask: Ask) -> None:
    done = ask("query", "verb", "lemma=raise")
    assert done.returncode == 2
    assert "no lexicon is loaded; `capar lexicon load`" in done.stderr


@pytest.mark.parametrize("question", ["contacts", "held", "looked_before"])
def test_a_kind_is_that_of_the_thing_which_a_question_tells_of(question: str, ask: Ask) -> None:
    rows = json.loads(ask("query", question, "kind=mug", "--json").stdout)
    assert rows
    assert {row.get("object", row.get("other")) for row in rows} == {"mug"}


def test_a_time_that_ends_before_it_begins_is_refused_and_a_moment_is_none(ask: Ask) -> None:
    done = ask("query", "segments", "from=8", "until=5")
    assert done.returncode == 2
    assert "from=8 is after until=5" in done.stderr
    rows = json.loads(ask("query", "segments", "from=2", "until=2", "--json").stdout)
    assert rows
    assert all(row["begins"] < 2.0 < row["ends"] for row in rows)


def test_a_filter_that_fits_in_two_ways_counts_once(ask: Ask) -> None:
    query = ["query", "durations", "action=Reach", "--json"]
    reaches = {row["performer"]: row for row in json.loads(ask(*query).stdout)}
    for row in json.loads(ask(*query, "kind=object").stdout):
        (by_name,) = json.loads(ask(*query, f"performer={row['performer']}").stdout)
        assert row == by_name == reaches[row["performer"]]


def test_a_segment_is_asked_for_by_its_address(ask: Ask) -> None:
    _, first, *_ = ask("query", "segments").stdout.splitlines()
    address = first.split()[0]
    found = ask("query", "segments", f"address={address}")
    assert [row.split()[0] for row in found.stdout.splitlines()[1:]] == [address]
    bare = ask("query", "rule", address)
    assert bare.returncode == 2 and "NAME=VALUE: action, address, ee" in bare.stderr
