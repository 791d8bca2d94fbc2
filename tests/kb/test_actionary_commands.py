"""The commands that ask, show, export, import, check and forget."""

import csv
import io
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import pytest
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.cli import main
from kb.actionary import Actionary
from kb.queries.questions import PARAMETERS, questions


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


def test_a_wrong_name_or_parameter_says_which_exist(folder: Path) -> None:
    wrong = capar("query", "hand", "akction=Reach", at=folder)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert "there are: action, address, capture, ee, " in wrong.stderr
    assert "Did you mean 'action'?" in wrong.stderr
    nowhere = capar("query", "hands", at=folder)
    assert nowhere.returncode == 2 and "Did you mean 'hand'?" in nowhere.stderr
    missing = capar("query", "hand", at=folder)
    assert missing.returncode == 2 and "action must be given" in missing.stderr
    bare = capar("query", "hand", "Reach", at=folder)
    assert bare.returncode == 2 and "NAME=VALUE" in bare.stderr


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


def test_a_users_query_can_neither_write_nor_run_for_ever(folder: Path) -> None:
    writes = capar("query", "DELETE WHERE { ?s ?p ?o }", at=folder)
    assert writes.returncode == 2 and "may not write" in writes.stderr
    endless = "SELECT (COUNT(*) AS ?n) { ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l }"
    slow = capar("query", endless, "--time-limit", "0.5", at=folder)
    assert slow.returncode == 2 and "stopped after 0.5 s" in slow.stderr


def test_an_action_is_shown_as_text_picture_and_turtle(folder: Path) -> None:
    text = capar("show", "DrinkFromMug", at=folder).stdout
    assert "1. Reach(mug) to PickUp" in text and "0.444" in text and "every link" in text
    assert (
        "left_hand 1 equals right_hand 1" in capar("show", "PickUpWithBothHands", at=folder).stdout
    )
    picture = ElementTree.fromstring(
        capar("show", "DrinkFromMug", "--format", "svg", at=folder).stdout
    )
    assert len(list(picture.iter("{http://www.w3.org/2000/svg}rect"))) == 6
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


def test_the_shell_completes_questions_and_parameters() -> None:
    def completed(words: str, at: int) -> str:
        extra = {
            "_CAPAR_COMPLETE": "complete_zsh",
            "_TYPER_COMPLETE_ARGS": words,
            "COMP_CWORD": str(at),
        }
        command = "import sys; sys.argv = ['capar']; from capar.cli import main; main()"
        return subprocess.run(
            [sys.executable, "-c", command],
            env={"PATH": "/usr/bin:/bin", **extra},
            capture_output=True,
            text=True,
            check=False,
        ).stdout

    assert "touching" in completed("capar query tou", 2)
    assert "capture=" in completed("capar query world cap", 3)


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


ANSWERLESS = ("follows action=ResumePosture", "both_hands object=mug", "unknown")


@pytest.mark.parametrize("asked", ANSWERLESS)
def test_a_question_about_what_is_there_may_have_no_answer(asked: str, tmp_path: Path) -> None:
    place = tmp_path / "one"
    with Actionary.open(place) as actionary:
        actionary.add(drink_from_mug())
    done = capar("query", *asked.split(), "--json", at=place)
    assert (done.returncode, done.stdout, done.stderr) == (0, "[]\n", "")


def test_whose_name_every_text_of_a_question_is_can_be_looked_up(folder: Path) -> None:
    texts = {p.name for each in questions().values() for p in each.parameters if p.kind == "text"}
    assert texts == set(PARAMETERS)
    for name, described in PARAMETERS.items():
        found = capar(
            "query", f"SELECT ?name WHERE {{ {described['known']} }}", "--json", at=folder
        )
        assert found.returncode == 0, found.stderr
        not_here = {"arrangement", "body", "preposition"}
        not_here |= {"lemma", "levin"}  # these need the lexicon
        assert json.loads(found.stdout) or name in not_here, name


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


def test_an_export_that_cannot_be_written_is_refused_before_the_actionary_is_read(
    tmp_path: Path,
) -> None:
    done = capar("export", str(tmp_path / "none" / "a.trig"), at=tmp_path / "nowhere")
    assert done.returncode == 2 and "No such file or directory" in done.stderr
