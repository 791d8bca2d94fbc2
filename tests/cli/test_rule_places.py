"""Rules that people write, as commands find them: in the project, and beside the Actionary."""

import json
from pathlib import Path

import pytest
import typer
from bundles import DRINKING
from shell import capar, run

from capar.cli import app
from capar.model.errors import CaparError, FileError, RuleError
from kb.actionary import Actionary

SIP = """%* Sip: a possessed object is held to what it touches. *%
primitive("Sip").
specialises("Sip", "MoveObj").
verb("Sip", "sip").
feature_row("Sip", hand, "101", "101", "10", "00").
"""

BAD = 'primitive("Bad").\n\nfits(Segment, "Bad") :- featurs(Segment, _, _, _, _).\n'

COMMANDS = {
    "describe": [DRINKING],
    "evaluate": [DRINKING, "labels.csv", "--mapping", "mapping.toml"],
    "explain": [DRINKING],
    "facts": [DRINKING],
    "label": [DRINKING, "--output", "labels.csv"],
    "lexicon load": [],
    "observe": [DRINKING],
    "open": [DRINKING, "--no-browser"],
    "parse": ["move the mug to the table"],
    "report linguistics": [],
    "rules add": ["sip.lp"],
    "rules audit": [],
    "rules diff": ["sip.lp"],
    "rules list": [],
    "rules new": ["Sip", "--from", f"{DRINKING}/right_hand/2"],
    "regenerate": ["--say", "drink from the mug", "--scene", DRINKING],
    "rules show": ["Reach"],
    "view": [DRINKING, "--html", "seen.html"],
    "rules test": ["sip.lp"],
    "rules words": [],
    "test": ["sip.motion.toml"],
    "verb": ["carry"],
}
"""Every command that reads rules that people wrote, with what it needs beside."""

ONLY_FILES = {"rules check", "rules remove"}
"""Commands that take rule files for what they are, and have none of them count."""


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder without rules or an Actionary, and with a sound rule file and a test."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("CAPAR_ACTIONARY", raising=False)
    monkeypatch.delenv("CAPAR_RULES", raising=False)
    Path("sip.lp").write_text(SIP)
    Path("sip.motion.toml").write_text(
        f'captures = ["{Path(DRINKING).name}"]\n[[expect]]\nthat = "right_hand Sip(mug, head)"\n'
    )
    Path(Path(DRINKING).name).symlink_to(DRINKING)
    return tmp_path


def kept(folder: str, name: str, text: str) -> Path:
    path = Path(folder) / f"{name}.lp"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def with_rules(group: object, path: str = "") -> set[str]:
    """The commands below a group that take --rules."""
    if not hasattr(group, "list_commands"):
        names = {each.name for each in group.params}  # type: ignore[attr-defined]
        return {path} if "rules" in names else set()
    context = typer.Context(group)  # type: ignore[arg-type]
    return {
        found
        for name in group.list_commands(context)
        for found in with_rules(group.get_command(context, name), f"{path} {name}".strip())
    }


def test_every_command_that_takes_rules_is_tried_here():
    assert with_rules(typer.main.get_command(app)) == {*COMMANDS, *ONLY_FILES}


@pytest.mark.parametrize("place", ["rules", "actionary/rules"])
@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_a_bad_rule_reaches_the_solver_through_no_command(command, place, monkeypatch):
    bad = kept(place, "bad", BAD)
    monkeypatch.setenv("CAPAR_ACTIONARY", "actionary")
    result = capar(*command.split(), *COMMANDS[command])
    assert isinstance(result.exception, RuleError), result.output
    assert f"{bad}:3:25: error: there is no predicate featurs/5. The nearest are features" in str(
        result.exception
    )


def test_a_bad_rule_can_still_be_checked_and_removed():
    bad = kept("rules", "bad", BAD)
    told = capar("rules", "check", bad)
    assert (told.exit_code, "unknown" in told.output or "no predicate" in told.output) == (2, True)
    assert run("rules", "remove", "Bad") == f"removed {bad}\n"
    assert run("rules", "list").startswith("core  ")


def test_the_list_says_where_each_rule_comes_from():
    kept("rules", "sip", SIP)
    kept("actionary/rules", "gulp", SIP.replace("Sip", "Gulp").replace("sip", "gulp"))
    assert "represented by Gulp" in run("verb", "gulp")
    rows = json.loads(run("rules", "list", "--profile", "thesis", "--json"))
    origins = {each["name"]: each["origin"] for each in rows}
    assert (origins["Reach"], origins["Sip"], origins["Gulp"]) == ("core", "project", "user")
    assert "user  Gulp < MoveObj: a possessed object" in run("rules", "list")
    elsewhere = run("rules", "list", "--actionary", "https://example.org/sparql")
    assert "Sip" in elsewhere
    assert "Gulp" not in elsewhere
    assert 'primitive("Gulp").' in run("rules", "show", "Gulp")


def test_rules_beside_the_actionary_name_what_is_observed_and_kept_there():
    kept("known/rules", "sip", SIP)
    thesis = [DRINKING, "--profile", "thesis"]
    assert "Sip" not in run("observe", *thesis)
    assert "Sip" in run("observe", *thesis, "--actionary", "known")
    assert "Sip" in run("explain", *thesis, "--actionary", "known")
    assert "Sip" in run("show", "drink_from_mug_tall_man", "--actionary", "known")
    assert "known/rules/sip.lp" in run("facts", *thesis, "--actionary", "known")


def test_claims_are_judged_with_the_rules_that_count():
    Path("sip.motion.toml").write_text('profile = "thesis"\n' + Path("sip.motion.toml").read_text())
    kept("mine", "sip", SIP)
    alone = capar("test", "sip.motion.toml")
    assert alone.exit_code == 1 or isinstance(alone.exception, CaparError)
    assert "holds" in run("test", "sip.motion.toml", "--rules", "mine")


def test_a_rule_is_added_beside_the_actionary_that_is_named_and_removed_from_there():
    words = ["--general", "MoveObj", "--definition", "it is held to what it touches"]
    seen = ["--from", f"{DRINKING}/right_hand/2", "--profile", "thesis"]
    example = run("rules", "new", "Sip", *seen, *words)
    other = (
        "\n%* Counter-example: a hand is laid on a table.\n"
        "   frames(0, 300).  rate_mhz(100000).  link(hand, hand, right).  tag(table, fixed).\n"
        "   zero_crossing(hand, 0).  zero_crossing(hand, 100).  zero_crossing(hand, 200).\n"
        "   touching(hand, table, 100, 300).\n   => hand: Reach, Touch\n*%\n"
    )
    Path("sip.lp").write_text(example + other)
    named = ["--profile", "thesis", "--actionary", "known"]
    Actionary.open("known").close()
    assert run("rules", "add", "sip.lp", *named) == "added known/rules/sip.lp\n"
    assert "user  Sip" in run("rules", "list", *named)
    with pytest.raises(RuleError, match="already, in known/rules/sip"):
        run("rules", "diff", "sip.lp", *named)
    assert run("rules", "remove", "Sip", "--actionary", "known") == "removed known/rules/sip.lp\n"
    assert "Sip" not in run("rules", "list", *named)


def test_a_misspelt_actionary_is_refused_and_not_made():
    with pytest.raises(FileError, match="is no folder of rule files"):
        run("rules", "list", "--rules", "nowhere")
    for command in (["add", "sip.lp"], ["add", "sip.lp", "--reclassify"]):
        with pytest.raises(FileError, match=r"konwn: is no Actionary\. `capar observe CAPTURE"):
            run("rules", *command, "--actionary", "konwn")
    with pytest.raises(FileError, match="actionary: is no Actionary"):
        run("rules", "add", "sip.lp", "--reclassify")
    assert not Path("konwn").exists()
    assert not Path("actionary").exists()


def test_a_rule_on_which_another_rests_stays():
    sip = kept("rules", "sip", SIP)
    gulp = SIP.replace("Sip", "Gulp").replace("MoveObj", "Sip").replace('"sip"', '"gulp"')
    kept("rules", "gulp", gulp)
    with pytest.raises(RuleError, match=r"stays: Gulp \(rules/gulp.lp\) rests on Sip"):
        run("rules", "remove", "Sip")
    assert sip.exists()
    run("rules", "remove", "Gulp")
    assert run("rules", "remove", "Sip") == f"removed {sip}\n"
