"""Descriptions say what the segments say: who did what with what, in order, and nothing else.

Texts under ``golden`` hold every step, then a summary; we read each of them beside its recording.
``CAPAR_GOLDEN=write`` rewrites them, to be read again.
"""

import os
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from motion_files import recordings_folder
from motions import (
    TALL_MAN,
    Trial,
    drink_from_mug,
    hit,
    move_obj,
    pick_up_with_both_hands,
    slide_object,
    touch_cycle,
)
from observations import MUG, TABLE, Piece, observation, with_unknown
from observed import observed
from scenes.hands import SCENES

from capar.model.observation import Observation, ObservedObject, SegmentRelation
from capar.model.par import FeatureSet
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.observation import observe
from kb.language import Plan, Question, describe, parse
from kb.language.steps import Narrator
from kb.language.vocabulary import Vocabulary
from kb.lexicon.english import noun
from kb.lexicon.links import PrimitiveWords

EXAMPLES = Path(__file__).parents[3] / "examples"
GOLDEN = Path(__file__).parent / "golden"
WORDS = primitive_words(primitive_files())
TAKES = (
    "bimacs_optitrack:take0",
    "manipnet:cup1",
    "omomo_intermimic/hands.toml:sub2_largetable_008",
    "pyomeca_box_lift",
)
SPAN = re.compile(r"\((\d+\.\d\d)(?:–(\d+\.\d\d))? s\)")
"""The time of a step, from its start to its end."""

BOWL = replace(MUG, name="bowl", kind="bowl")
IN_HAND = FeatureSet("1", "1", "1", "hand", "0")
CLEANED = Piece("Reach", 50, ("mug",)), Piece("MoveObj", 120, ("mug", "table"), "Clean")
FREE = (Piece("PostureChange", 50, ()),)
HELD = FeatureSet("1", "1", "0", "hand", "0")


@pytest.mark.parametrize("take", TAKES)
def test_a_recording_is_told_as_we_read_it(
    take: str, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    value = observed(str(EXAMPLES / take), tmp_path_factory)
    golden = GOLDEN / f"{take.replace('.toml', '').replace('/', '.').replace(':', '.')}.txt"
    texts = [describe(value, detail=each, words=WORDS) for each in ("steps", "summary")]
    told = "\n\n".join(texts) + "\n"
    if os.environ.get("CAPAR_GOLDEN") == "write":
        golden.write_text(told, encoding="utf-8")
    assert told == golden.read_text(encoding="utf-8")
    timed = describe(value, timed=True, words=WORDS)
    assert_order_is_true(timed)
    assert_steps_cover_segments(value)
    assert_only_what_is_there_is_named(texts[0], value)


def assert_order_is_true(timed: str) -> None:
    """``Then`` begins after all that was told, ``Meanwhile`` before its end; steps are in order."""
    end_s = 0.0
    for sentence in re.split(r"(?<=\.) (?=[A-Z])", timed):
        spans = [(float(first), float(last or first)) for first, last in SPAN.findall(sentence)]
        main = [float(first) for first, _ in SPAN.findall(re.split(r",? while ", sentence)[0])]
        assert main == sorted(main), sentence
        afterwards = sentence.startswith(("Then ", "Next, ", "After that, "))
        assert not afterwards or min(main) >= end_s, sentence
        assert not sentence.startswith("Meanwhile") or min(main) < end_s, sentence
        end_s = max(end_s, *(last for _, last in spans))


def assert_steps_cover_segments(value: Observation) -> None:
    """Every named segment of an object is told by one step, unless it is taking what is given."""
    steps = Narrator(value, WORDS).steps(value.links)
    told = [key for step in steps for key in step.segments]
    assert len(told) == len(set(told))
    named = {(s.ee, s.index) for s in value.segments if s.objects and s.name != "Receive"}
    assert named <= set(told)


def assert_only_what_is_there_is_named(text: str, value: Observation) -> None:
    """A description is read back with known verbs, of objects and hands of the observation."""
    names = {each.name for each in value.objects} | {each.kind for each in value.objects}
    read = parse(text, Vocabulary(WORDS, frozenset(names)))
    assert not isinstance(read, Question)
    steps = read.steps if isinstance(read, Plan) else (read,)
    assert all(step.known and step.call.action for step in steps)
    assert {name for step in steps for name in step.call.objects if name} <= names
    mentioned = {each.name for each in value.objects if noun(each.name) in text}
    assert mentioned <= {name for each in value.segments for name in each.objects} | {
        other for each in value.segments for word in each.prepositions for other in word[2:]
    }


ACTIONS = {
    drink_from_mug: "lifted it to the head, drank, put it back on the table, and let go of it.",
    touch_cycle: "reached for the box with the right hand, touched it, and took the hand away.",
    slide_object: "reached for the box with the right hand, and pushed it along the table.",
    pick_up_with_both_hands: "with both hands, lifted it off the table, put it back on the table",
    hit: "hit the drum with the right hand and took the hand away.",
    move_obj: "pulled the stamp along the table with the right hand.",
}
LOADS_AND_TOOLS = {
    "carry_a_carton_with_a_ball": "carried it with the ball, put the carton with the ball",
    "push_with_a_stick": "pushed the box with the stick",
    "hit_a_block_away": "struck the block with the right hand",
}


@pytest.mark.parametrize(
    ("of", "text"),
    [*ACTIONS.items(), *LOADS_AND_TOOLS.items()],
    ids=lambda each: getattr(each, "__name__", None),
)
def test_an_action_is_told_as_it_was(of: Callable[..., Trial] | str, text: str) -> None:
    if isinstance(of, str):
        value = observe(SCENES[of](100.0, 0.0005, 0.00175, 0)[0])
    else:
        value = observe(of(TALL_MAN).capture)
    told = describe(value)
    assert isinstance(of, str) or told.startswith("The tall man ")
    assert all(part in told for part in text.split(", and ")), told
    assert_order_is_true(describe(value, timed=True))
    assert_steps_cover_segments(value)


def handled(
    *pieces: tuple[str, FeatureSet], relations: tuple[tuple[str, int, int], ...] = ()
) -> Observation:
    """A mug that the right hand handles in pieces of a second each, after reaching for it."""
    rest = [
        Piece(name, 100 * at, ("mug", "bowl")[: features.count], features=features)
        for at, (name, features) in enumerate(pieces, start=2)
    ]
    made = observation(
        "Mug",
        {"right_hand": (Piece("Reach", 100, ("mug",)), *rest)},
        (MUG, BOWL),
        frames=100 * (len(rest) + 1) + 1,
        rate_hz=100.0,
    )
    (link,) = made.links
    own = tuple(replace(each, possessed=each.index > 0) for each in link.segments)
    found = tuple(
        SegmentRelation(kind, ("right_hand", one), ("right_hand", other))
        for kind, one, other in relations
    )
    return replace(made, links=(replace(link, segments=own),), relations=found)


@pytest.mark.parametrize(
    ("pieces", "relations", "told"),
    [
        (["Lift", "Raise"], [("same_action", 2, 1)], "lifted it."),
        (["Shake", "Touch", "Shake"], [("resumes", 3, 1)], "shook it, with a pause"),
        (["Raise", "Lower"], [("fragment_of", 1, 2)], "and lowered it."),
        (["Pour", "Turn"], [("rights", 2, 1)], "and poured from it."),
        (["Shake", "Shake", "Shake"], [], "and shook it three times."),
        (["Raise", "Lower"], [], "raised it, and lowered it."),
    ],
)
def test_segments_that_are_one_action_by_the_rules_are_one_step(
    pieces: list[str], relations: list[tuple[str, int, int]], told: str
) -> None:
    features = [(name, HELD if name == "Touch" else IN_HAND) for name in pieces]
    value = handled(*features, relations=tuple(relations))
    assert told in describe(value)
    assert_order_is_true(describe(value, timed=True))


def made(objects: tuple[ObservedObject, ...], **links: tuple[Piece, ...]) -> Observation:
    """What hands do in pieces, at a hundred frames a second."""
    frames = max(piece.last for pieces in links.values() for piece in pieces) + 1
    return observation("Made", links, objects, frames=frames, rate_hz=100.0)


@pytest.mark.parametrize(
    ("value", "options", "told"),
    [
        (with_unknown(), {}, "handled it and the table in a way that no rule names"),
        (handled(("Raise", IN_HAND)), {"detail": "summary"}, "The agent raised the mug with the"),
        (handled(("Raise", IN_HAND)), {"timed": True}, "raised it (1.00–2.00 s)"),
        (handled(("Nudge", IN_HAND)), {}, "and nudged it."),
        (
            handled(("Nudge", IN_HAND)),
            {"words": [PrimitiveWords("Nudge", ("shove",))]},
            "and shoved it.",
        ),
        (made((MUG, TABLE), right_hand=CLEANED), {}, " to clean."),
        (made((MUG,), right_hand=FREE, left_hand=FREE), {}, " agent moved both hands without "),
        (made((MUG,), right_hand=(Piece("Unknown", 50, ()),)), {}, "The agent touched nothing."),
    ],
)
def test_options_and_users_words(value: Observation, options: dict[str, object], told: str) -> None:
    assert told in describe(value, **options)  # type: ignore[arg-type]


@given(st.lists(st.sampled_from(["Raise", "Lower", "Shake", "Tilt"]), min_size=1, max_size=9))
def test_however_often_something_is_done_it_is_told_so_often(names: list[str]) -> None:
    value = handled(*((name, IN_HAND) for name in names))
    text = describe(value, timed=True)
    assert_order_is_true(text)
    assert_steps_cover_segments(value)
    spans = [float(last) for _, last in SPAN.findall(text) if last]
    assert max(spans) == len(names) + 1.0
