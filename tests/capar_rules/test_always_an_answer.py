"""Rules over measurements have exactly one answer, whatever was measured.

What is drawn are small worlds of two to five bodies, with facts of every kind. In the suite they
are few; ``CAPAR_WORLDS=20000 pytest tests/capar_rules/test_always_an_answer.py`` asks what moves in
so many, and all rules about a tenth of them.
"""

import os
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from random import Random
from typing import Any

import pytest
from bundles import DRINKING
from exit_codes import exit_code

from capar.model.errors import NoAnswerError
from capar.model.facts import MEASURED, Fact, Frames, Link, Observed, RateMhz, Tag, read_fact
from capar_rules.borders.deflicker import steady
from capar_rules.engine.profiles import Profile, profile
from capar_rules.engine.solver import least_contradiction, rule_file
from capar_rules.engine.syntax import Statement, parse
from capar_rules.explain.explanation import Explainer
from capar_rules.lint.text_checks import cycle_findings
from capar_rules.movers.movers import RULES, movers
from capar_rules.pars.inference import infer

WORLDS = int(os.environ.get("CAPAR_WORLDS", "300"))
EXTENDED, THESIS = profile("extended"), profile("thesis")
OF_MOVERS = {
    "displaced",
    "travels",
    "touching",
    "moves_with",
    "flies",
    "rolls",
    "swings",
    "resting",
}
ALWAYS_STATED = (Frames, RateMhz, Link, Tag)
NUMBERS = (0, 1, 20, 50, 100, 300, 700, 1000, 1500, 3000, 10_000)
WORDS = {
    "link_kind": ("hand", "hand", "foot", "head"),
    "link_side": ("right", "left", "none"),
    "tag_type": ("self", "fixed", "mobile", "mobile", "mobile"),
    "of_agent_agent": ("ann", "bob"),
    "intended_action": ("Reach", "MoveObjTo", "any"),
    "intended_purpose": ("PickUp", "Touch"),
    "phase_kind": ("rising", "level", "sinking", "turning", "still"),
    "guided_kind": ("hinge", "rail", "pivot", "track"),
    "bears_share": ("whole", "part", "none"),
    "lies_how": ("inside", "dips", "above", "below", "beside", "along", "near", "shifts",
        "by_part"),
    "passage_how": ("inside", "above"),
    "passage_sides": ("opposite", "other"),
}  # fmt: skip


class World:
    """Bodies and frames about which facts are drawn; the same number draws the same world."""

    def __init__(self, number: int) -> None:
        self.random = Random(number)
        self.bodies = [f"body{each}" for each in range(self.random.randint(2, 5))]
        self.last = self.random.randint(2, 30)
        self.longest = self.random.choice((self.last // 3, self.last))
        self.acting = [each for each in self.bodies if self.random.random() < 0.4]
        kinds = [each for each in MEASURED if each not in ALWAYS_STATED]
        few = [each for each in kinds if each.predicate in OF_MOVERS]
        several = self.random.sample(kinds, self.random.randint(2, 8))
        self.kinds = self.random.choice((kinds, several, few))

    def facts(self) -> tuple[Fact, ...]:
        """All that is measured of it, no fact twice."""
        rate = self.random.choice((5_000, 10_000, 30_000, 100_000))
        links = (self.fact(Link, ee=each) for each in self.acting)
        tags = (self.fact(Tag, object=each) for each in self.bodies if each not in self.acting)
        count = self.random.randint(3, 60)
        drawn = (self.fact(self.random.choice(self.kinds)) for _ in range(count))
        return tuple(dict.fromkeys((Frames(0, self.last), RateMhz(rate), *links, *tags, *drawn)))

    def fact(self, kind: Any, **values: Any) -> Observed:
        """A fact of a kind, with these values or others."""
        for field in fields(kind):
            value = self.value(kind.predicate, field.name, field.type, values)
            values.setdefault(field.name, value)
        fact: Observed = kind(**values)
        return fact

    def value(self, predicate: str, name: str, kind: object, values: dict[str, Any]) -> int | str:
        """A value of a field, where those before it are known."""
        if words := WORDS.get(f"{predicate}_{name}"):
            return self.random.choice(words)
        if kind is str:
            hands = name in ("ee", "foot", "sensor") and self.random.random() < 0.9
            return self.random.choice((hands and self.acting) or self.bodies)
        if name in ("first", "frame"):
            return self.random.randint(0, self.last)
        if name == "last":
            first = values["first"]
            return self.random.randint(first, min(self.last, first + self.longest))
        return self.random.choice(NUMBERS) * self.random.choice((1, 1, 1, -1))


def programs() -> Iterator[tuple[str, tuple[Statement, ...]]]:
    """Every program that is solved over measurements."""
    yield "extended", parse(EXTENDED.files)
    yield "thesis", parse(THESIS.files)
    yield "movers", parse((rule_file(RULES),))
    yield "flicker", parse((rule_file("segmentation/flicker.lp"),))


def test_worlds_have_facts_of_every_kind() -> None:
    drawn = {type(fact) for number in range(WORLDS) for fact in World(number).facts()}
    assert drawn == set(MEASURED)


def test_what_moves_in_any_world_has_one_answer() -> None:
    found = {each.how for number in range(WORLDS) for each in movers(World(number).facts())}
    assert {"along", "body", "carried", "pushed", "set_going", "through", "unknown"} == found


def test_any_world_has_one_answer_of_all_rules_and_each_name_a_reason() -> None:
    for number in range(WORLDS // 10):
        facts = World(number).facts()
        infer(facts, profile=THESIS)
        taken = steady(facts)
        inferred = infer(taken, profile=EXTENDED)
        segments = [segment for link in inferred.links for segment in link.segments]
        reasons = Explainer((*taken, *movers(taken)), EXTENDED).explain_all(segments)
        assert [each.name for each in reasons] == [each.name for each in segments]


@pytest.mark.parametrize(("name", "statements"), [*programs()])
def test_no_rule_forbids_what_was_measured_and_none_but_flicker_chooses(
    name: str, statements: tuple[Statement, ...]
) -> None:
    heads = {each.head_kind for each in statements if each.kind == "rule"}
    assert heads == ({"atom", "choice"} if name == "flicker" else {"atom"})


SETTLED_BY_AN_ARGUMENT = {
    # of bits and changes those of one kind follow from those of another
    "bit_set": "extended thesis",
    "core_change": "extended",
    "core_start": "extended",
    # what goes on by itself follows from the part before
    "by_itself": "movers",
    # one kind of what leads, or of what leaves a motion without a mover, follows from the others
    "by_hand": "movers",
    "leads": "movers",
    "unmoved": "movers",
    "moved": "movers",
    "released": "movers",
}


@pytest.mark.parametrize(("name", "statements"), [*programs()])
def test_no_predicate_depends_on_its_own_negation(
    name: str, statements: tuple[Statement, ...]
) -> None:
    """But for those that an argument of theirs sets apart, so that no atom does."""
    found = {each.message.split()[0] for each in cycle_findings(statements, ())}
    assert found == {each for each, where in SETTLED_BY_AN_ARGUMENT.items() if name in where}


def forbidding(folder: Path) -> Profile:
    """Rules of which a user's file forbids that a contact ever begins."""
    (folder / "sound.lp").write_text('primitive("Sound").\n')
    (folder / "forbids.lp").write_text(":- touching(_, mug, First, _), First > 0.\n")
    return profile("extended", added=(folder / "sound.lp", folder / "forbids.lp"))


def test_the_fewest_facts_without_an_answer_are_found_and_the_file_of_the_user(tmp_path) -> None:
    facts = [read_fact(each) for each in (
        "frames(0,90)", "rate_mhz(30000)", "link(hand,hand,right)", "tag(mug,mobile)",
        "touching(hand,mug,0,5)", "touching(hand,mug,20,60)", "displaced(mug,30,50)",
    )]  # fmt: skip
    with pytest.raises(NoAnswerError) as raised:
        infer(facts, profile=forbidding(tmp_path))
    files, least = least_contradiction(raised.value)
    assert files == (tmp_path / "forbids.lp",)
    assert [str(each) for each in least] == ["touching(hand,mug,20,60)"]


def test_an_observation_without_an_answer_leaves_a_file_that_can_be_sent(
    tmp_path, monkeypatch, capsys
) -> None:
    monkeypatch.chdir(tmp_path)
    rules = forbidding(tmp_path)
    monkeypatch.setattr("capar.cli.options.rule_base", lambda *_, **__: rules)
    assert exit_code(monkeypatch, "observe", str(DRINKING)) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert str(tmp_path / "forbids.lp") in captured.err
    assert "no_answer_forbids_1.lp" in captured.err
    comment, *facts = (tmp_path / "no_answer_forbids_1.lp").read_text().splitlines()
    assert comment.startswith("% ")
    assert [read_fact(each.rstrip(".")).predicate for each in facts] == ["touching"]
