"""No rule file counts before its text is judged, whoever loads it, and nothing of it runs."""

from pathlib import Path

import hostile_rules
import pytest

from capar.model.errors import RuleError
from capar_rules.authoring.user_rules import (
    actionary_rules,
    new_rules_folder,
    rules_folder,
    user_rules,
)
from capar_rules.lint.checking import admit, admitted_profile, faults

COUNTED = """%* Counted: it is counted along the ticks. *%
primitive("Counted").
specialises("Counted", "Touch").
since(Hand, From, From) :-
    segment(seg(Hand, From), From, _).
since(Hand, From, Tick + 1) :-
    since(Hand, From, Tick),
    {bound}.
fits(seg(Hand, From), "Counted") :-
    fits(seg(Hand, From), "Touch"),
    since(Hand, From, From).
"""


def kept(folder: Path, name: str, content: str | bytes) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.lp"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def test_mutants_never_break_the_process_that_admits_them(tmp_path):
    count = len(hostile_rules.BY_HAND) + len(hostile_rules.BYTES)
    paths = hostile_rules.write_all(tmp_path, count + 60)[count:]
    refused = [bool(faults([each], profile="thesis")) for each in paths]
    assert len(refused) == len(paths)
    assert refused.count(True) > refused.count(False)


def test_sound_files_and_those_that_only_help_are_admitted(tmp_path):
    sound = kept(tmp_path, "hoist", hostile_rules.SOUND)
    helping = kept(tmp_path, "helping", "seldom(Hand) :- link(Hand, foot, _).\n")
    admit([sound, helping], profile="extended")
    assert admitted_profile("extended", added=(sound, helping)).added == (sound, helping)


def test_files_that_speak_of_each_other_are_judged_together(tmp_path):
    helping = kept(tmp_path, "helping", "seldom(Hand) :- link(Hand, foot, _).\n")
    text = hostile_rules.SOUND.replace("from_rest(Segment)", "seldom(Hand), link(Hand, _, _)")
    using = kept(tmp_path, "hoist", text)
    assert faults([using, helping], profile="extended") == ()
    (alone,) = faults([using], profile="extended")
    assert (alone.code, alone.place.line) == ("unknown-predicate", 8)


def test_what_a_file_includes_is_judged_with_it(tmp_path):
    kept(tmp_path, "beside", '#script (python)\nopen("HARMED", "w")\n#end.\n')
    path = kept(tmp_path, "hoist", f'{hostile_rules.SOUND}#include "beside.lp".\n')
    (found,) = faults([path], profile="extended")
    assert (found.code, Path(found.place.file).name) == ("script", "beside.lp")


def test_a_percent_sign_in_a_text_hides_no_include(tmp_path):
    path = kept(tmp_path, "hoist", hostile_rules.SOUND + 'q("%"). #include "/etc/passwd".\n')
    (found,) = faults([path], profile="extended")
    assert (found.code, found.place.line) == ("include", 10)


@pytest.mark.parametrize(
    ("bound", "ends"),
    [
        ("tick(Hand, Tick, _)", True),
        ("tick(Hand, From, _)", False),
        ("Tick != 1", False),
    ],
)
def test_a_recursion_must_be_bounded_by_what_was_measured(bound, ends, tmp_path):
    path = kept(tmp_path, "counted", COUNTED.format(bound=bound))
    found = faults([path], profile="thesis")
    assert [(each.code, each.place.line) for each in found] == [("unbounded", 6)] * (not ends)


def test_one_primitive_in_two_files_is_refused_and_both_are_named(tmp_path):
    first = kept(tmp_path / "one", "hoist", hostile_rules.SOUND)
    second = kept(tmp_path / "other", "hoist", hostile_rules.SOUND + "% otherwise\n")
    with pytest.raises(RuleError) as refused:
        admitted_profile("extended", added=(first, second))
    assert f'{first}:2:1: error: there is a primitive "Hoist" already, in {second}.' in str(
        refused.value
    )


def test_the_same_file_in_two_folders_counts_once(tmp_path):
    first = kept(tmp_path / "project", "hoist", hostile_rules.SOUND)
    kept(tmp_path / "actionary" / "rules", "hoist", hostile_rules.SOUND)
    assert user_rules(tmp_path / "project", actionary=tmp_path / "actionary") == (first,)


def test_rules_come_from_the_project_and_from_beside_the_actionary(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("CAPAR_RULES", raising=False)
    monkeypatch.delenv("CAPAR_ACTIONARY", raising=False)
    assert user_rules() == ()
    here = kept(Path("rules"), "b", "q(1).\n")
    there = kept(Path("known") / "rules", "a", "p(1).\n")
    assert user_rules() == (here,)
    assert user_rules(actionary="known") == (here, there)
    assert user_rules(actionary="https://example.org/sparql") == (here,)
    monkeypatch.setenv("CAPAR_ACTIONARY", "known")
    assert user_rules() == (here, there)
    monkeypatch.setenv("CAPAR_RULES", "known/rules")
    assert user_rules() == (there,)


def test_a_new_rule_goes_where_a_folder_is_named_else_beside_the_actionary(monkeypatch):
    monkeypatch.delenv("CAPAR_RULES", raising=False)
    monkeypatch.delenv("CAPAR_ACTIONARY", raising=False)
    assert new_rules_folder() == Path("rules")
    assert new_rules_folder(actionary="https://example.org/sparql") == Path("rules")
    assert actionary_rules("https://example.org/sparql") is None
    assert new_rules_folder(actionary="known") == Path("known/rules")
    monkeypatch.setenv("CAPAR_ACTIONARY", "usual")
    assert new_rules_folder() == Path("usual/rules")
    monkeypatch.setenv("CAPAR_RULES", "mine")
    assert new_rules_folder(actionary="known") == rules_folder() == Path("mine")
    assert new_rules_folder(Path("these"), actionary="known") == Path("these")
