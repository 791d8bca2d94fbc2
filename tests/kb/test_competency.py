"""Twenty questions of knowledge engineers are answered as a plain computation answers them.

They are asked of the shipped demo, of two unnamed performers, and where there are recordings of
two takes from a kitchen.
"""

from collections import Counter
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from competency import QUERIES, World, rounded, side, step

from capar.model.errors import UnknownNameError
from capar.model.facts import Leans, Lies, LookingAt, Moving, Touching
from capar.model.observation import Observation, Segment
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.actionary import Actionary
from kb.lexicon.links import class_links, sense_links, thesis_senses
from kb.lexicon.loading import load_words
from kb.lexicon.wordnet import wordnet
from kb.queries.questions import FILTERS, check_known, question, questions


@pytest.fixture(scope="module")
def actionary(world: World) -> Iterator[Actionary]:
    with Actionary.in_memory() as fresh:
        for each in world.seen:
            fresh.add(each)
        load_words(fresh.store, primitive_words(primitive_files()))
        yield fresh


def asked(actionary: Actionary, name: str) -> set[tuple[object, ...]]:
    from kb.store.sparql import prepare

    rows = actionary.store.ask(prepare(QUERIES[name])).plain()
    return rounded(row.values() for row in rows)


def test_when_the_whisk_was_held_while_the_bottle_was_tilted(
    world: World, actionary: Actionary
) -> None:
    expected = set()
    for seen in world.seen:
        for held in world.facts(seen, Touching):
            for tilt in world.facts(seen, Leans):
                first, last = max(held.first, tilt.first), min(held.last, tilt.last)
                right = side(seen, held.body) == "right" and held.other == "whisk"
                if right and tilt.object == "bottle" and first < last:
                    expected.add((seen.capture, first * step(seen), last * step(seen)))
    assert asked(actionary, "held while tilted") == rounded(expected)
    assert {each[0] for each in expected} == world.kitchen


def test_which_objects_were_ever_inside_a_container(world: World, actionary: Actionary) -> None:
    expected = set()
    for seen in world.seen:
        kinds = {each.name: each.kind for each in seen.objects}
        inside = [(e.body, e.other) for e in world.facts(seen, Lies) if e.how == "inside"]
        inside += [(b, o) for s in seen.segments for p, b, o in s.prepositions if p == "in"]
        for body, other in inside:
            if "container" in actionary.kinds_above(kinds.get(other) or other):
                expected.add((seen.capture, body))
    assert asked(actionary, "inside") == expected
    assert not any(body == "bottle" for _, body in expected)  # it is held above the bowl
    inside = {
        (seen.capture, e.body, e.first * step(seen), e.last * step(seen))
        for seen in world.seen
        for e in world.facts(seen, Lies)
        if (e.how, e.other) == ("inside", "bowl")
    }
    rows = actionary.ask("arrangements", arrangement="in", object="bowl")
    found = [(row["observation"], row["body"], row["begins"], row["ends"]) for row in rows]
    assert rounded(found) == rounded(inside)
    assert {(capture, body) for capture, body, *_ in found} == {(k, "whisk") for k in world.kitchen}
    steps = actionary.ask("where", preposition="inside", object="bowl")
    assert {row["observation"] for row in steps} == world.kitchen


@pytest.mark.parametrize("action", ["MoveObj", "Reach", "Touch"])
def test_which_actions_are_kinds_of_one_and_by_whom_they_were_done(
    action: str, world: World, actionary: Actionary
) -> None:
    expected = Counter(
        (each.name, world.performer(seen, each))
        for seen, each, _ in world.segments()
        if world.is_kind(each, action)
    )
    rows = actionary.ask("kinds", action=action)
    assert {(row["kind"], row["performer"]): row["times"] for row in rows} == expected
    performers = actionary.ask("performers", action=action)
    assert len(performers) == sum(expected.values())


def test_which_segments_are_unknown_and_what_they_match_partly(
    world: World, actionary: Actionary
) -> None:
    rows = actionary.ask("unexplained")
    expected = {(s.capture, e.ee, e.index) for s, e, _ in world.segments() if not e.known}
    assert {(row["observation"], row["ee"], row["index"]) for row in rows} == expected
    for row in rows:
        ((_, segment),) = (
            (s, e)
            for s, e, _ in world.segments()
            if (s.capture, e.ee, e.index) == (row["observation"], row["ee"], row["index"])
        )
        assert set(str(row["nearest"] or "").split()) == set(segment.candidates)
    partly = {row["nearest"] for row in actionary.ask("unknown")} - {None}
    assert partly == {n for _, e, _ in world.segments() if not e.known for n in e.candidates}
    assert expected and partly


def test_where_an_object_was_at_a_time(world: World, actionary: Actionary) -> None:
    found = 0
    for name, capture in world.captures.items():
        for thing in capture.objects:
            for time in (1.0, 2.0, 3.5, 7.0):
                rows = actionary.ask("place", capture=name, body=thing.name, time=time)
                frame = round(time * capture.rate_hz)
                if frame >= len(capture.times) or np.isnan(thing.stream.positions[frame]).any():
                    continue
                (row,) = rows
                place = np.array([row["x"], row["y"], row["z"]])
                assert np.linalg.norm(place - thing.stream.positions[frame]) < 0.01
                found += 1
    assert found >= 4


def test_what_the_left_hand_did_during_the_right_hands_stirring_both_ways(
    world: World, actionary: Actionary
) -> None:
    expected = set()
    for seen, one, first in world.segments():
        for two in seen.segments:
            during = two.first < one.first and one.last < two.last
            left = side(seen, one.ee) == "left" and side(seen, two.ee) == "right"
            if left and during and world.is_kind(two, "Stir"):
                expected.add((first, f"{seen.capture}/{two.ee}/{two.index}"))
    rows = actionary.ask("relations", side="left", other="Stir", relation="during")
    assert {(row["first"], row["second"]) for row in rows} == expected
    for row in rows:
        names = {address: each.name for _, each, address in world.segments()}
        assert row["action"] == names[str(row["first"])]
        assert row["other_action"] == names[str(row["second"])]
    together = {
        (first, second)
        for seen, one, first in world.segments()
        for other, two, second in world.segments()
        if seen is other and one is not two and max(one.first, two.first) < min(one.last, two.last)
        if side(seen, one.ee) == "left" and side(seen, two.ee) == "right"
        if world.is_kind(two, "Stir")
    }
    asked_for = {"side": "left", "other": "Stir", "other_side": "right", "relation": "together"}
    rows = actionary.ask("relations", **asked_for)
    assert {(row["first"], row["second"]) for row in rows} == together
    rows = actionary.ask("relations", **asked_for, other_ee="right_hand", other_effector="hand")
    assert {(row["first"], row["second"]) for row in rows} == together
    back = actionary.ask("relations", action="Stir", side="right", other="MoveObj")
    inverse = {(row["second"], row["first"]) for row in back if row["holds"] == "contains"}
    forth = actionary.ask("relations", action="MoveObj", other="Stir", relation="during")
    assert inverse == {(row["first"], row["second"]) for row in forth}
    assert {each.partition("/")[0] for each, _ in expected} == world.kitchen


def test_every_pair_of_segments_stands_in_one_relation_and_its_inverse(
    world: World, actionary: Actionary
) -> None:
    seen = world.seen[0]
    rows = actionary.ask("relations", capture=seen.capture, other="MoveObj")
    moves = [each for each in seen.segments if world.is_kind(each, "MoveObj")]
    assert len(rows) == len(moves) * (len(seen.segments) - 1)
    assert {row["holds"] for row in rows} >= {"before", "after", "meets", "metBy"}
    for row in rows:
        if row["holds"] == "before":
            assert float(row["seconds"]) > 0.0


def test_which_rule_named_a_segment_and_with_which_thresholds(
    world: World, actionary: Actionary
) -> None:
    rows = actionary.ask("rule")
    named = [(s, e, a) for s, e, a in world.segments() if e.known and s.naming]
    rules = {seen.capture: {each.name: each for each in seen.naming} for seen in world.seen}
    expected = {
        (address, each.name, rules[seen.capture][each.name].file) for seen, each, address in named
    }
    assert {(row["address"], row["action"], row["file"]) for row in rows} == expected
    for row in rows:
        rule = rules[str(row["address"]).partition("/")[0]][str(row["action"])]
        told = ", ".join(f"{each.name} = {each.value}" for each in rule.thresholds)
        assert row["thresholds"] == told
        assert f'"{row["action"]}"' in rule.text
    assert any(row["thresholds"] for row in rows)


def test_how_long_each_object_was_held_and_by_which_hand(
    world: World, actionary: Actionary
) -> None:
    touched: Counter[tuple[str, str, str]] = Counter()
    held: Counter[tuple[str, str, str]] = Counter()
    moved: Counter[tuple[str, str, str]] = Counter()
    for seen in world.seen:
        for touch in world.facts(seen, Touching):
            if touch.body not in {link.ee for link in seen.links}:
                continue
            key = (seen.capture, touch.body, touch.other)
            touched[key] += (touch.last - touch.first) * step(seen)
            start, end = touch.first * step(seen), touch.last * step(seen)
            for segment in seen.segments:
                if segment.possessed and (segment.ee, segment.objects[0]) == key[1:]:
                    held[key] += max(0.0, min(end, segment.end_s) - max(start, segment.start_s))
            for motion in world.facts(seen, Moving):
                if motion.object == touch.other:
                    frames = min(touch.last, motion.last) - max(touch.first, motion.first)
                    moved[key] += max(0, frames) * step(seen)
    rows = actionary.ask("held")
    found = {(r["observation"], r["ee"], r["object"]): r for r in rows}
    assert found.keys() == touched.keys() and len(found) == len(rows)
    for key, row in found.items():
        assert row["touched"] == pytest.approx(touched[key], abs=1e-6)
        assert row["held"] == pytest.approx(held[key], abs=1e-6)
        assert row["moved"] == pytest.approx(moved[key], abs=1e-6)
    assert any(held.values()) and any(moved.values()) and any(held[k] < touched[k] for k in held)
    right = actionary.ask("held", side="right", effector="hand")
    assert right == [row for row in rows if row["ee"] == "right_hand"]
    mugs = actionary.ask("held", object="mug", capture=world.seen[0].capture)
    assert mugs == [
        row for row in rows if (row["observation"], row["object"]) == (world.seen[0].capture, "mug")
    ]


def test_who_looked_at_an_object_before_grasping_it(world: World, actionary: Actionary) -> None:
    expected = {}
    for seen in world.seen:
        hands = {each.ee: each for each in seen.links if each.kind == "hand"}
        for look in world.facts(seen, LookingAt):
            for grasp in world.facts(seen, Touching):
                if grasp.body in hands and grasp.other == look.object and look.first < grasp.first:
                    who = seen.performer(grasp.body)
                    who = f"agent of {seen.capture}" if who == "agent" else who
                    key = (seen.capture, who, look.object)
                    before = (grasp.first - look.first) * step(seen)
                    expected[key] = max(before, expected.get(key, 0.0))
    rows = {(who, thing, before) for (_, who, thing), before in expected.items()}
    assert asked(actionary, "looked before") == rounded(rows)
    assert rows


def test_highest_speed_of_the_right_hand_in_each_reach(world: World, actionary: Actionary) -> None:
    found = {str(address): speed for address, speed in asked(actionary, "reaching speeds")}
    expected = {}
    for seen, each, address in world.segments():
        if each.name == "Reach" and side(seen, each.ee) == "right" and seen.tracks:
            speeds = world.measured[seen.capture].tracks[each.ee].speed_mps
            expected[address] = float(np.nanmax(speeds[each.first : each.last + 1]))
    assert expected
    assert {k: v for k, v in found.items() if v is not None} == {
        address: pytest.approx(speed, rel=0.05) for address, speed in expected.items()
    }


@pytest.mark.parametrize("lemma", ["raise", "move", "touch"])
def test_which_segments_are_of_a_verb_that_wordnet_puts_under_another(
    lemma: str, world: World, actionary: Actionary
) -> None:
    words = wordnet()
    asked_for = {synset.offset for _, synset in words.of_lemma(lemma)}
    stated = [link for each in primitive_words(primitive_files()) for link in sense_links(each)]
    under = set()
    for link in (*thesis_senses(), *stated):
        own = words.of_key(link.key)
        if asked_for & {each.offset for each in (own, *words.steps_above(own))}:
            under.add(link.primitive)
    expected = {
        address
        for _, each, address in world.segments()
        if any(world.is_kind(each, name) for name in under)
    }
    assert expected
    rows = actionary.ask("verb", lemma=lemma)
    assert {row["address"] for row in rows} == expected
    assert len(rows) == len(expected)


def test_which_segments_are_of_a_class_of_levins(world: World, actionary: Actionary) -> None:
    within = {
        each.name
        for each in primitive_words(primitive_files())
        if any(number.split(".")[0] == "9" for number in class_links(each)[0])
    }
    expected = {
        address
        for _, each, address in world.segments()
        if any(world.is_kind(each, name) for name in within)
    }
    assert {row["address"] for row in actionary.ask("levin", levin="9")} == expected


def test_every_filter_leaves_exactly_what_it_says(world: World, actionary: Actionary) -> None:
    kinds = {
        (seen.capture, each.name): set(actionary.kinds_above(each.kind or each.name)) | {each.name}
        for seen in world.seen
        for each in seen.objects
    }
    first = world.seen[0].capture
    _, _, known = next(iter(world.segments()))
    fitting: dict[tuple[str, object], Callable[[Observation, Segment], bool]] = {
        ("action", "MoveObj"): lambda seen, each: world.is_kind(each, "MoveObj"),
        ("action", "MoveObj,MoveObjTo"): lambda seen, each: (
            world.is_kind(each, "MoveObj") or world.is_kind(each, "MoveObjTo")
        ),
        ("address", known): lambda seen, each: f"{seen.capture}/{each.ee}/{each.index}" == known,
        ("ee", "left_hand"): lambda seen, each: each.ee == "left_hand",
        ("side", "left"): lambda seen, each: side(seen, each.ee) == "left",
        ("effector", "hand"): lambda seen, each: each.features.end_effector == "hand",
        ("performer", "tall_man"): lambda seen, each: seen.performer(each.ee) == "tall_man",
        ("capture", first): lambda seen, each: seen.capture == first,
        ("from", 2.0): lambda seen, each: each.end_s > 2.0,
        ("until", 2.0): lambda seen, each: each.start_s < 2.0,
        ("kind", "container"): lambda seen, each: any(
            "container" in kinds.get((seen.capture, name), ()) for name in each.objects
        ),
    }
    of_others = {"other", "other_side", "other_ee", "other_effector", "object"}
    assert {name for name, _ in fitting} == FILTERS.keys() - of_others
    for (name, value), fits in fitting.items():
        expected = {address for seen, each, address in world.segments() if fits(seen, each)}
        rows = actionary.ask("segments", **{name: value})
        assert {row["address"] for row in rows} == expected, name
        assert expected


def test_every_question_of_segments_takes_the_same_filters() -> None:
    exempt = {"allen", "before", "shared", "world"}  # of whole actions, conditions, or one time
    other = {"corrections", "held", "notices", "observations", "sources"}  # of observations
    other |= {"arrangements", "contacts", "looked_before"}
    own = {"other", "other_side", "other_ee", "other_effector", "object"}  # of few questions
    body = {"place", "both_hands", "looked_at"}
    for name, each in questions().items():
        taken = {parameter.name for parameter in each.parameters}
        if name not in exempt | other | body:
            assert taken >= FILTERS.keys() - own, name  # its own count, too
        if name in other | {"both_hands", "looked_at"}:
            assert {"performer", "capture"} & taken, name


@pytest.mark.parametrize(
    ("name", "given", "near"),
    [("verb", {"lemma": "raize"}, "raise"), ("levin", {"levin": "9.11"}, "9.1")],
)
def test_a_word_that_the_lexicon_lacks_is_told(
    name: str, given: dict[str, str], near: str, actionary: Actionary
) -> None:
    assert actionary.ask(name, **given) == []
    with pytest.raises(UnknownNameError, match=near):
        check_known(actionary.store, question(name), given)
