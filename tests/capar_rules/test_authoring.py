"""Rules that people write: drafted, tried on their examples, added, ordered and removed."""

from pathlib import Path

import pytest

from capar.model.errors import FileError, RuleError, UnknownNameError
from capar_rules.authoring.user_primitives import (
    add_rule,
    introduced,
    preceded,
    read_examples,
    removable,
    rule_of,
    try_rule,
    user_rules,
    written,
)
from capar_rules.engine.profiles import profile
from capar_rules.lint.checking import admitted_profile, check
from capar_rules.lint.findings import errors
from capar_rules.lint.world_checks import audit

FACTS = """   frames(0, 300).  rate_mhz(100000).  link(hand, hand, right).
   tag(box, mobile).  tag(table, fixed).
   zero_crossing(hand, 0).  zero_crossing(hand, 100).  zero_crossing(hand, 200).
   touching(hand, box, 100, 300).  touching(box, table, 0, 300).
"""

GRASP = f"""%* Grasp: the end-effector goes on touching what is mobile and still. *%
primitive("Grasp").
specialises("Grasp", "Touch").
verb("Grasp", "grasp").
fits(Segment, "Grasp") :-
    fits(Segment, "Touch"),
    object_at(Segment, 0, Object),
    tag(Object, mobile).

%* Example: a hand is laid on a box.
{FACTS}   => hand: Reach, Grasp
*%

%* Counter-example: a hand is laid on a table.
   frames(0, 300).  rate_mhz(100000).  link(hand, hand, right).  tag(table, fixed).
   zero_crossing(hand, 0).  zero_crossing(hand, 100).  zero_crossing(hand, 200).
   touching(hand, table, 100, 300).
   => hand: Reach, Touch
*%
"""


@pytest.fixture
def grasp(tmp_path: Path) -> Path:
    path = tmp_path / "grasp.lp"
    path.write_text(GRASP)
    return path


def test_examples_are_read_as_they_are_written(grasp):
    first, second = read_examples(GRASP)
    assert (first.story, first.positive) == ("a hand is laid on a box.", True)
    assert first.names == (("hand", ("Reach", "Grasp")),)
    assert second.positive is False
    assert read_examples(written(first))[0].facts == first.facts


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("%* Example: nothing.\n   => hand: Reach\n*%\n", "needs facts"),
        ("%* Example: no end.\n   frames(0, 1).\n*%\n", "needs facts and a line such as"),
        ("%* Example: odd.\n   frames(0, a).\n   => hand: Reach\n*%\n", "a is no int"),
        ("%* Example: odd.\n   frames(0, 1).\n   => Reach\n*%\n", "expected END_EFFECTOR"),
        (
            "\n%* Example: odd.\n   frames(0, 9).\n   moving(cup, 0).\n   => hand: Reach\n*%\n",
            r"^x.lp:4: in the example 'odd.': .*moving",
        ),
        (
            "%* Example: odd.\n   frames(0, 9).  moving(cup, 0, 2)\n   => hand: Reach\n*%\n",
            r"^x.lp:2: .*'moving\(cup, 0, 2\)' is no fact",
        ),
        (
            "%* Example: odd.\n   moving(cup, 0, 2)\n   frames(0, 9).\n   => hand: Reach\n*%\n",
            r"^x.lp:2: .*'moving\(cup, 0, 2\)' is no fact",
        ),
        (
            "%* Example: odd.\n   frames(0, 9).\n   Moving(cup, 0, 2).\n   => hand: Reach\n*%\n",
            r"^x.lp:3: .*'Moving\(cup, 0, 2\)\.' is no fact",
        ),
    ],
)
def test_an_example_that_cannot_be_read_says_why(text, message):
    with pytest.raises(RuleError, match=message):
        read_examples(text, file="x.lp")


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ('primitive( "Nip" ).\n', ["Nip"]),
        ('primitive("Nip"). primitive("Sip").\n', ["Nip", "Sip"]),
        ('% primitive("Nap").\n%* primitive("Nop"). *%\nprimitive(\n"Nip").\n', ["Nip"]),
        ('primitive("nip it; good").\n', ["nip it; good"]),
        ('primitive("Nip").\nfits(S, "Nip" :- x.\n', ["Nip"]),
    ],
)
def test_what_a_file_introduces_is_read_as_rules_are(tmp_path, text, names):
    path = tmp_path / "nip.lp"
    path.write_text(text)
    assert introduced(path) == names


def test_examples_that_hold_are_silent_and_others_say_what_was_found(grasp):
    assert try_rule(grasp, base="thesis") == ()
    grasp.write_text(GRASP.replace("=> hand: Reach, Grasp", "=> hand: Grasp, Grasp"))
    (failure,) = try_rule(grasp, base="thesis")
    assert "expects hand: Grasp, Grasp; found Reach, Grasp" in failure


def test_a_file_without_examples_lacks_one_of_each_kind(grasp):
    grasp.write_text(GRASP.split("%* Example", maxsplit=1)[0])
    lacking = try_rule(grasp, base="thesis")
    assert [each.partition("lacks ")[2].split()[1] for each in lacking] == [
        "Example", "Counter-example",
    ]  # fmt: skip


def test_an_added_rule_is_the_users_until_it_is_removed(grasp, tmp_path):
    folder = tmp_path / "rules"
    added = add_rule(grasp, folder=folder, base="thesis")
    assert user_rules(folder) == (added,)
    assert list(folder.iterdir()) == [added]
    base = admitted_profile("thesis", added=user_rules(folder))
    assert rule_of(base, "Grasp").origin == "project"
    assert rule_of(base, "Grasp", actionary=tmp_path).origin == "user"
    with pytest.raises(FileError, match="exists already"):
        add_rule(grasp, folder=folder, base="thesis")
    assert removable("Grasp", files=user_rules(folder)) == added
    added.unlink()
    assert user_rules(folder) == ()
    with pytest.raises(UnknownNameError, match="rule of the user's"):
        removable("Grasp", files=user_rules(folder))


def test_an_ambiguity_is_refused_unless_it_is_ordered(grasp, tmp_path):
    grasp.write_text(GRASP.replace('specialises("Grasp", "Touch").\n', ""))
    folder = tmp_path / "rules"
    with pytest.raises(RuleError, match="Grasp and Touch name the same segments"):
        add_rule(grasp, folder=folder, base="thesis")
    assert user_rules(folder) == ()
    added = add_rule(grasp, folder=folder, base="thesis", over=["Touch"])
    assert added.read_text().endswith('\n*%\nprecedes("Grasp", "Touch").\n')
    added.unlink()
    added = add_rule(grasp, folder=folder, base="thesis", kind_of=["Touch"])
    assert added.read_text().endswith('\n*%\nspecialises("Grasp", "Touch").\n')


UNLOAD = """%* Unload: a possessed object is taken off a thing that bore it. *%
primitive("Unload").
specialises("Unload", "MoveObj").
fits(Segment, "Unload") :-
    fits(Segment, "MoveObj"),
    taken_off(Segment, _, _).
taken_off(Segment, Load, Bearer) :-
    possessed(Segment, Load, _),
    borne_at(Segment, start, Load, Bearer),
    tag(Bearer, mobile),
    not borne_at(Segment, end, Load, Bearer).

%* Example: a cup is taken off a tray and held in the air.
   frames(0, 400).  rate_mhz(100000).  link(hand, hand, right).
   tag(cup, mobile).  tag(tray, mobile).
   touching(hand, cup, 100, 400).  touching(cup, tray, 0, 200).
   upward(cup, tray, 0, 1000).
   moving(cup, 200, 300).
   => hand: Reach, Touch, Unload, Touch
*%

%* Counter-example: a cup is taken off a table, which is fixed.
   frames(0, 400).  rate_mhz(100000).  link(hand, hand, right).
   tag(cup, mobile).  tag(table, fixed).
   touching(hand, cup, 100, 400).  touching(cup, table, 0, 200).
   upward(cup, table, 0, 1000).
   moving(cup, 200, 300).
   => hand: Reach, Touch, MoveObj, Touch
*%
"""


@pytest.fixture
def unload(tmp_path):
    path = tmp_path / "unload.lp"
    path.write_text(UNLOAD)
    return path


def test_names_that_may_share_a_segment_are_refused_until_they_are_ordered(unload, tmp_path):
    folder = tmp_path / "rules"
    with pytest.raises(RuleError, match=r"Unload and Carry, .* may name the same segments"):
        add_rule(unload, folder=folder)
    with pytest.raises(RuleError, match="may name the same segments") as refused:
        add_rule(unload, folder=folder, over=["Carry"])
    assert '"Carry"' not in str(refused.value)
    added = add_rule(unload, folder=folder, over=["all"])
    first = preceded(added)["Unload"]
    assert {"Carry", "Lift", "Slide"} <= {*first}
    assert not {"MoveObj", "Reach", "Touch"} & {*first}
    assert errors(check(added)) == ()
    audited = audit(profile("thesis", added=(added,)))
    assert (audited.unchecked, audited.clean) == (("Unload",), True)


def test_a_rule_whose_example_fails_is_not_added(grasp, tmp_path):
    grasp.write_text(GRASP.replace("=> hand: Reach, Grasp", "=> hand: Grasp, Grasp"))
    with pytest.raises(RuleError, match="examples do not hold"):
        add_rule(grasp, folder=tmp_path / "rules", base="thesis")
    assert user_rules(tmp_path / "rules") == ()
