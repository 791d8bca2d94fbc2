"""What the query command accepts as SPARQL, its messages, and its output for machines."""

import csv
import io
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, TypeAlias

import pytest
from observations import drink_from_mug, with_unknown

from capar.cli import main
from kb.actionary import Actionary


class Done(NamedTuple):
    """How a command ended, and what it printed."""

    returncode: int
    stdout: str
    stderr: str


Ask: TypeAlias = Callable[..., Done]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("queries") / "actionary"
    with Actionary.open(place) as actionary:
        actionary.add(drink_from_mug())
        actionary.add(with_unknown())
    return place


@pytest.fixture
def ask(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Ask:
    """Runs a command in this process, as its main function does."""
    monkeypatch.setenv("CAPAR_ACTIONARY", str(folder))

    def run(*words: str, given: str = "") -> Done:
        monkeypatch.setattr(sys, "argv", ["capar", *words])
        monkeypatch.setattr(sys, "stdin", io.StringIO(given))
        with pytest.raises(SystemExit) as end:
            main()
        return Done(int(end.value.code or 0), *capsys.readouterr())

    return run


def test_machines_get_whole_iris_and_people_short_ones(ask: Ask) -> None:
    text = (
        "SELECT ?o ?s WHERE { ?o a capar:Observation ; rdfs:label 'Strange' . "
        "?o capar:segment ?s . ?s capar:index 0 }"
    )
    whole = "https://w3id.org/capar/data/observation/Strange"
    pair = [whole, f"{whole}#segment.right_hand.0"]
    assert json.loads(ask("query", text, "--json").stdout) == [dict(zip("os", pair, strict=True))]
    table = ask("query", text).stdout.splitlines()
    assert table[1].split() == [each.replace(whole, "data:observation/Strange") for each in pair]
    for printed in (table[1].split()[1], f"<{table[1].split()[1]}>"):
        pasted = f"SELECT ?i WHERE {{ {printed} capar:index ?i . }}"
        assert json.loads(ask("query", pasted, "--json").stdout) == [{"i": 0}]
    lines = ask("query", text, "--format", "csv").stdout.splitlines()
    assert lines == ["o,s", ",".join(pair)]
    graph = f"SELECT (COUNT(*) AS ?n) WHERE {{ GRAPH <{lines[1].split(',')[0]}> {{ ?s ?p ?o }} }}"
    assert json.loads(ask("query", graph, "--json").stdout)[0]["n"] > 0
    built = "CONSTRUCT { ?s a capar:Segment } WHERE { ?s a capar:UnknownSegment }"
    (row,) = csv.DictReader(io.StringIO(ask("query", built, "--format", "csv").stdout))
    assert row["object"] == "https://w3id.org/capar/ontology#Segment"


def test_between_is_told_with_every_body_that_it_is_between() -> None:
    made = with_unknown()
    (link,) = made.links
    said = (
        ("beside", "cup", "shelf"), ("beside", "cup", "table"),
        ("between", "cup", "shelf"), ("between", "cup", "table"),
        ("between", "jug", "bowl"), ("between", "jug", "cup"), ("between", "jug", "shelf"),
    )  # fmt: skip
    segments = tuple(replace(each, prepositions=said) for each in link.segments)
    actionary = Actionary.in_memory()
    actionary.add(replace(made, links=(replace(link, segments=segments),)))
    rows = actionary.ask("where")
    assert [(r["index"], r["preposition"], r["body"], r["other"]) for r in rows] == [
        (index, *each)
        for index in range(len(segments))
        for each in (
            ("beside", "cup", "shelf"),
            ("beside", "cup", "table"),
            ("between", "cup", "shelf table"),
            ("between", "jug", "bowl cup shelf"),
        )
    ]
    narrow = actionary.ask("where", preposition="between", body="cup")
    assert {each["other"] for each in narrow} == {"shelf table"} and len(narrow) == len(segments)


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


def test_a_file_keeps_its_meaning_even_if_it_is_called_like_a_query(
    ask: Ask, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("select all.txt").write_text("ASK {}")
    asked = ask("query", "select all.txt")
    assert asked.stdout.split() == ["answer", "yes"], asked.stderr
    missing = ask("query", "nothere.rq")
    assert missing.returncode == 2
    assert "capar: nothere.rq: cannot be used: No such file or directory. Name" in missing.stderr
    Path("folder.rq").mkdir()
    wrong = ask("query", "folder.rq")
    assert wrong.returncode == 2
    assert "capar: folder.rq: cannot be used: Is a directory. Name a file" in wrong.stderr
    Path("latin.rq").write_bytes("ASK {} # é".encode("latin-1"))
    wrong = ask("query", "latin.rq")
    assert wrong.returncode == 2 and "latin.rq: cannot be read as a query" in wrong.stderr


@pytest.mark.parametrize("limit", ["nan", "inf", "-1", "0"])
def test_a_time_limit_that_is_none_is_refused(limit: str, ask: Ask) -> None:
    done = ask("query", "actions", "--time-limit", limit)
    assert (done.returncode, done.stdout) == (2, "")
    assert "a positive number of seconds" in done.stderr


@pytest.mark.parametrize("file", ["-", "."])
def test_an_import_without_a_format_says_how_to_give_one(
    file: str, ask: Ask, tmp_path: Path
) -> None:
    done = ask("import", file, "--actionary", str(tmp_path / "new"))
    assert done.returncode == 2 and "add --format" in done.stderr
    assert not (tmp_path / "new").exists()


def test_a_word_that_the_ontology_lacks_is_warned_of_with_the_nearest(ask: Ask) -> None:
    done = ask(
        "query", "SELECT ?x { ?x capar:nmae ?y ; a <https://w3id.org/capar/ontology#Segmnet> }"
    )
    assert done.returncode == 0
    assert "warning: the ontology has no capar:nmae" in done.stderr
    assert "capar:name" in done.stderr and "capar:Segment" in done.stderr
    known = ask(
        "query", 'SELECT (capar:element("1 2", 0) AS ?x) { ?s a capar:Segment # capar:nmae\n }'
    )
    assert "warning" not in known.stderr


def test_several_actions_are_asked_for_with_a_comma(ask: Ask) -> None:
    def rows(action: str) -> list[dict[str, object]]:
        return json.loads(ask("query", "segments", f"action={action}", "--json").stdout)

    both = rows("MoveObj,MoveObjTo")
    assert both
    assert sorted(map(str, both)) == sorted(map(str, [*rows("MoveObj"), *rows("MoveObjTo")]))


def test_an_empty_answer_says_so_to_people_alone(ask: Ask) -> None:
    done = ask("query", "corrections")
    assert (done.stdout.splitlines()[1:], done.stderr) == ([], "nothing found\n")
    assert ask("query", "corrections", "--json").stderr == ""


def test_a_verb_is_not_asked_of_an_actionary_without_a_lexicon(ask: Ask) -> None:
    done = ask("query", "verb", "lemma=raise")
    assert done.returncode == 2
    assert "no lexicon is loaded; `capar lexicon load`" in done.stderr


def test_kinds_are_found_by_their_label_without_a_language(ask: Ask) -> None:
    query = "SELECT ?name { ?o capar:kind/capar:isA/rdfs:label 'container' ; capar:name ?name }"
    assert "mug" in ask("query", query).stdout


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


def test_what_is_nowhere_declared_or_recorded_is_noted(ask: Ask) -> None:
    assert "note: nothing is declared" in ask("query", "uses", "object=mug").stderr
    assert "note: recorded is empty" in ask("query", "sources").stderr
    assert "note" not in ask("query", "sources", "--json").stderr


def test_what_is_declared_is_told_beside_what_was_observed(ask: Ask, tmp_path: Path) -> None:
    with Actionary.open(tmp_path / "own") as actionary:
        actionary.add(drink_from_mug())
        (who,) = actionary.agents()
    place = ("--actionary", str(tmp_path / "own"))
    assert "declared of every mug: Wipe" in ask("object", "can", "mug", "Wipe", *place).stdout
    done = ask("query", "uses", "object=mug", *place)
    assert "Wipe" in done.stdout and "nothing is declared" not in done.stderr
    assert "declared of" in ask("agent", "can", who, "Juggle", *place).stdout
    done = ask("query", "abilities", f"performer={who}", *place)
    assert "Juggle" in done.stdout and "nothing is declared" not in done.stderr
    wrong = ask("object", "can", "mgu", "Wipe", *place)
    assert wrong.returncode == 2 and "no kind of object 'mgu'" in wrong.stderr


def test_a_kind_of_end_effector_that_is_not_there_is_told_with_all_there_are(ask: Ask) -> None:
    done = ask("query", "segments", "effector=finger")
    assert done.returncode == 2 and "no kind of end-effector 'finger'; there are: " in done.stderr


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
