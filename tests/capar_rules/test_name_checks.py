"""A check finds names that clash with others or leave them none, whichever file they stand in."""

from collections.abc import Mapping
from pathlib import Path

import pytest

from capar_rules.engine.profiles import profile
from capar_rules.engine.syntax import parse
from capar_rules.lint.audit import NAMED, PROFILES, evaluate, every_world, extents_of, fingerprint
from capar_rules.lint.checking import check
from capar_rules.lint.findings import Finding, errors

FITS = ("fits", 2)

TAP = 'fits(S, "Tap") :- fits(S, "Touch"), object_at(S, 0, Object), tag(Object, fixed).'
KNOCK = 'fits(S, "Knock") :- fits(S, "Touch"), object_at(S, 0, Object), not tag(Object, mobile).'
PECK = 'fits(S, "Peck") :- fits(S, "Touch"), object_at(S, 0, Object), looking_at(_, Object, _, _).'
NOT_CLASHING = "".join(
    f', not fits(S, "{each}")' for each in ("RestFoot", "Stand", "StandOnOneLeg", "TouchOneself")
)


def written(folder: Path, name: str, general: str, rule: str) -> Path:
    path = folder / f"{name.lower()}.lp"
    declared = f'primitive("{name}").\nspecialises("{name}", "{general}").\n'
    path.write_text(f"%* {name}: as said. *%\n{declared}{rule}\n")
    return path


def found(path: Path, *beside: Path) -> Mapping[str, Finding]:
    return {each.code: each for each in check(path, beside=beside)}


def test_two_files_that_name_the_same_segments_are_refused_by_name(tmp_path):
    tap = written(tmp_path, "Tap", "Touch", TAP.replace(").", f"){NOT_CLASHING}."))
    knock = written(tmp_path, "Knock", "Touch", KNOCK.replace(").", f"){NOT_CLASHING}."))
    assert found(tap) == {}
    assert found(knock) == {}
    clash = found(knock, tap)["ambiguous"]
    assert clash.message.startswith("Knock and Tap name the same segments")
    assert 'not fits(Segment, "Tap")' in clash.remedy


def test_a_name_that_takes_every_segment_of_a_more_general_one_is_refused(tmp_path):
    shove = written(tmp_path, "Shove", "Push", 'fits(S, "Shove") :- fits(S, "Push").')
    assert "with Shove, Push never names a segment any more" in found(shove)["shadows"].message
    some = 'fits(S, "Shove") :- fits(S, "Push"), goes_ahead(S, 1).'
    assert found(written(tmp_path, "Shove", "Push", some)) == {}


def test_two_names_that_together_take_every_segment_of_a_third_are_refused(tmp_path):
    near = written(tmp_path, "Near", "Push", 'fits(S, "Near") :- fits(S, "Push"), from_rest(S).')
    far = written(tmp_path, "Far", "Push", 'fits(S, "Far") :- fits(S, "Push"), not from_rest(S).')
    assert found(near) == {}
    assert found(far) == {}
    assert set(found(far, near)) == {"shadows"}


def test_a_rule_whose_conditions_exclude_each_other_never_fires(tmp_path):
    odd = 'fits(S, "Odd") :- fits(S, "Touch"), fits(S, "MoveObj").'
    assert set(found(written(tmp_path, "Odd", "Touch", odd))) == {"never-fires"}


def test_a_rule_about_the_left_hand_is_judged_like_one_about_the_right(tmp_path):
    for side in ("left", "right"):
        rule = (
            f'fits(S, "Nap") :- fits(S, "Touch"), S = seg(Hand, _), link(Hand, hand, {side})'
            f"{NOT_CLASHING}."
        )
        assert found(written(tmp_path, "Nap", "Touch", rule)) == {}
    head = rule.replace("hand, right", "head, right")
    assert set(found(written(tmp_path, "Nap", "Touch", head))) == {"never-fires"}


def test_names_that_only_unjudged_conditions_could_keep_apart_are_refused(tmp_path):
    peck = written(tmp_path, "Peck", "Touch", PECK.replace(").", f"){NOT_CLASHING}."))
    rap = written(tmp_path, "Rap", "Touch", PECK.replace("Peck", "Rap"))
    assert {code for code, each in found(peck).items()} == {"not-judged"}
    clash = found(rap, peck)["ambiguous"]
    assert clash.message.startswith(
        "Rap and Peck, RestFoot, Stand, StandOnOneLeg, TouchOneself may name the same segments"
    )
    assert "looking_at(_,Object,_,_)" in clash.message


@pytest.mark.parametrize(
    "stated",
    ['precedes("Rap", "Peck").', 'precedes("Peck", "Rap").', 'specialises("Rap", "Peck").'],
)
def test_a_stated_order_settles_names_that_unjudged_conditions_might_keep_apart(tmp_path, stated):
    peck = PECK.replace(").", f"){NOT_CLASHING}.")
    subject = stated.split('"')[1]
    rap, peck = (
        written(
            tmp_path, name, "Touch",
            f"{peck.replace('Peck', name)}\n{stated if name == subject else ''}",
        )
        for name in ("Rap", "Peck")
    )  # fmt: skip
    assert errors(tuple(found(rap, peck).values())) == ()


def test_a_condition_that_is_not_fulfilled_in_any_world_shadows_nothing(tmp_path):
    """That nobody looks is so in every world, as no world has eyes that do."""
    idle = 'fits(S, "Idle") :- fits(S, "TouchOneself"), not looking_at(_, _, _, _).'
    assert errors(tuple(found(written(tmp_path, "Idle", "TouchOneself", idle)).values())) == ()


BEFORE = """fits(seg(Hand, From), "Renew") :-
    fits(seg(Hand, From), "Touch"),
    segment(seg(Hand, Before), Before, From),
    fits(seg(Hand, Before), "Touch").
"""


def test_a_rule_that_joins_two_segments_is_not_said_never_to_fire(tmp_path):
    notes = found(written(tmp_path, "Renew", "Touch", BEFORE))
    assert "it joins more than one segment" in notes["not-judged"].message
    assert "never-fires" not in notes
    assert "Renew and RestFoot" in notes["ambiguous"].message


@pytest.mark.parametrize("apart", ['not fits(S, "Peck")', "not looking_at(head, table, 0, 1)"])
def test_names_that_an_unjudged_condition_does_keep_apart_are_taken(tmp_path, apart):
    looking = "looking_at(head, table, 0, 1)"
    rule = f'fits(S, "Peck") :- fits(S, "Touch"), {looking}{NOT_CLASHING}.'
    other = f'fits(S, "Rap") :- fits(S, "Touch"), {apart}, looking_at(_, _, _, _){NOT_CLASHING}.'
    peck = written(tmp_path, "Peck", "Touch", rule)
    rap = written(tmp_path, "Rap", "Touch", other)
    assert errors(tuple(found(rap, peck).values())) == ()


@pytest.mark.parametrize("name", PROFILES)
def test_where_shipped_primitives_can_fit_is_stored_for_the_rules_as_they_are(name):
    rules = parse(profile(name).files)
    stored = extents_of(rules)
    assert stored.fits, (
        f"the rules of {name} have changed ({fingerprint(rules)[:8]}): "
        "run python -m capar_rules.lint.audit"
    )
    limbs = frozenset(sorted(every_world())[::61])
    atoms = evaluate(rules, (FITS, NAMED), limbs=limbs)
    for predicate, worlds in (("fits", stored.fits), ("named", stored.named)):
        holds = {(row[1], row[0][1]) for each, row in atoms if each == predicate}
        assert holds == {(one, limb) for one, those in worlds.items() for limb in those & limbs}
