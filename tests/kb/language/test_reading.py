"""Sentences in and out: steps come back from their sentences, people are read as they mean it.

``instructions_first.txt`` and ``instructions_second.txt`` were written by somebody who had not seen
the grammar; ``*_read.md`` hold what is read, each line judged by us as ``right`` or ``wrong``.
"""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import TALL_MAN, drink_from_mug

from capar.model.capture import NAME
from capar.model.errors import CaparError
from capar.model.par import Call
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.observation import observe
from capar.views.readings import question_lines, reading_lines
from kb.actionary import Actionary
from kb.language import Instruction, Question, parse, sentence
from kb.language.reader import SentenceError
from kb.language.vocabulary import EFFECTORS, EVERYTHING, PREPOSITIONS, Vocabulary
from kb.lexicon.english import noun, past
from kb.lexicon.wordnet import table

HERE = Path(__file__).parent
WORDS = primitive_words(primitive_files())
ANY = Vocabulary(WORDS)
KNOWN = Vocabulary(WORDS, frozenset({"mug", "table", "head", "blue_cup"}))
CANS = Vocabulary(
    WORDS, frozenset({"coffee_can", "coffee_can_2", "tuna", "tuna_3", "carton", "table"})
)
RESERVED = {*PREPOSITIONS, *EFFECTORS, EVERYTHING, "and", "the", "a", "an", "for", "perform"}

OBJECTS = st.from_regex(NAME, fullmatch=True).filter(
    lambda name: (
        noun(name).replace(" ", "_") == name
        and not RESERVED.intersection(noun(name).lower().split())
    )
)
PURPOSES = st.one_of(
    st.just(""), st.from_regex(r"([A-Z][a-z]{1,6}){1,3}", fullmatch=True), st.text(max_size=8)
)


@given(st.data())
def test_a_step_comes_back_from_its_sentence(data: st.DataObject) -> None:
    objects = tuple(data.draw(st.lists(OBJECTS, max_size=3, unique_by=str.lower)))
    name = data.draw(st.sampled_from([*(each.name for each in WORDS), "Unknown", "My own"]))
    call = Call(name, objects, data.draw(PURPOSES))
    step = Instruction(call, data.draw(st.sampled_from(["", *EFFECTORS])))
    vocabulary = Vocabulary(WORDS, frozenset(objects))
    assert parse(sentence(step, vocabulary), vocabulary) == step


def test_every_primitive_comes_back_over_one_object_and_two() -> None:
    for words in WORDS:
        for objects in (("mug",), ("mug", "blue_cup")):
            step = Instruction(Call(words.name, objects, "PickUp"), "left_hand", "", "table")
            assert parse(sentence(step, KNOWN), KNOWN) == step


def test_a_sentence_says_the_hand_the_source_and_the_end() -> None:
    value = Instruction(Call("MoveObjTo", ("mug", "head"), "Drink"), "right_hand", "", "table")
    text = "Move the mug to the head from the table with the right hand to drink."
    assert sentence(value) == text
    assert parse("move the mug from the table to the head with the right hand to drink") == value


@pytest.mark.parametrize(
    ("text", "action", "objects", "known"),
    [
        ("Put the blue cup on the table.", "MoveObjTo", ("blue_cup", "table"), KNOWN),
        ("touch the table with the mug", "TouchWith", ("mug", "table"), KNOWN),
        ("touch the table with the right hand", "Touch", ("table",), KNOWN),
        ("the agent lifted the mug to the mouth", "MoveObjTo", ("mug", "head"), KNOWN),
        ("stir with the mug in the blue cup", "Stir", ("mug", "blue_cup"), KNOWN),
        ("lift a can of tuna and a third can of tuna", "Lift", ("tuna", "tuna_3"), CANS),
        (
            "The agent put the coffee can, coffee can 2, and the tuna in the carton.",
            "MoveObjTo",
            ("coffee_can", "coffee_can_2", "tuna", "carton"),
            CANS,
        ),
    ],
)
def test_other_ways_to_say_it_are_read(
    text: str, action: str, objects: tuple[str, ...], known: Vocabulary
) -> None:
    read = parse(text, known)
    assert isinstance(read, Instruction)
    assert (read.call.action, read.call.objects) == (action, objects)


@pytest.mark.parametrize(
    ("text", "word", "wanted"),
    [
        ("mvoe the mug", "mvoe", "move"),
        ("move the mgu to the table", "mgu", "mug"),
        ("put the mug the table", "the", "put A on B"),
        ("move the mug to the table wiht the hand", "wiht", "with"),
        ("hit the mug with the left hand with the right hand", "with", None),
        ("hit the mug for luck", "luck", '"Drink"'),
        ("when the mug", "the", "did"),
        ("perform", "", "Reach"),
        ("", "", "who"),
    ],
)
def test_what_cannot_be_read_is_pointed_at(text: str, word: str, wanted: str | None) -> None:
    with pytest.raises(SentenceError) as caught:
        parse(text, KNOWN)
    error = caught.value
    assert error.word == word
    assert error.text[error.column :].startswith(word)
    assert wanted is None or wanted in error.could_be
    assert str(error).splitlines()[-1].index("^") == error.column + 2


@pytest.mark.parametrize(("name", "count", "least"), [("first", 50, 40), ("second", 25, 18)])
def test_what_was_written_unseen_is_read_as_it_was_judged(
    name: str, count: int, least: int
) -> None:
    written = (HERE / f"instructions_{name}.txt").read_text(encoding="utf-8").splitlines()
    text = (HERE / f"instructions_{name}_read.md").read_text(encoding="utf-8")
    blocks = [block.splitlines() for block in text.strip().split("\n\n")]
    assert [line for line, *_ in blocks] == written
    assert len(written) == count
    assert sum(verdict.strip() == "right" for *_, verdict in blocks) >= least
    for line, *reading, _ in blocks:
        try:
            value = parse(line, ANY)
            is_question = isinstance(value, Question)
            read = question_lines(value) if is_question else reading_lines(value)
        except CaparError as error:
            read = ("refused: " + str(error).split("; it could be", maxsplit=1)[0].splitlines()[0],)
        assert [f"    {each}" for each in read] == reading, line


def test_every_phrase_of_a_description_is_read_as_a_primitive_that_has_it() -> None:
    rows = [row for name in ("phrases", "canonical") for row in table(name)]
    for pattern in {row["pattern"] for row in rows if "{1}" in row["pattern"]}:
        verb, _, rest = pattern.partition(" ")
        text = f"The agent {past(verb)} {rest}."
        for place, words in (("{1}", "the mug"), ("{2}", "the table"), ("{ee}", "the right foot")):
            text = text.replace(place, words)
        step = parse(text, ANY)
        assert isinstance(step, Instruction)
        plain = pattern.replace(" back", "").replace(" there", "")
        names = {row["primitive"] for row in rows if row["pattern"] in {pattern, plain}}
        assert step.call.action in names, text
        assert (
            step.call.objects[: pattern.count("2") + 1]
            == ("mug", "table")[: pattern.count("2") + 1]
        )


@pytest.fixture(scope="module")
def drinking() -> Actionary:
    book = Actionary.in_memory()
    book.add(observe(drink_from_mug(TALL_MAN).capture))
    return book


@pytest.mark.parametrize(
    ("text", "variable", "expected"),
    [
        ("who drank?", "performer", {"tall_man"}),
        ("who put down the mug?", "performer", {"tall_man"}),
        ("who picked the mug up?", "performer", {"tall_man"}),
        ("where was the mug put?", "place", {"table"}),
        ("what did she drink from?", "object", {"mug"}),
        ("what was the first thing that he picked up?", "object", {"mug"}),
        ("how often did he touch the mug?", "times", {1}),
        ("which hand moved the mug before it was put on the table?", "ee", {"right_hand"}),
        ("what did the right hand do while the mug was being tilted?", "action", {"Drink"}),
        ("who reached for the table?", "performer", set()),
        ("who held the mug with the left hand?", "performer", set()),
        ("who drank within 0.1 s?", "performer", set()),
        ("who drank before the mug was moved to the head?", "performer", set()),
    ],
)
def test_a_question_is_answered_by_what_entails_it(
    drinking: Actionary, text: str, variable: str, expected: set[object]
) -> None:
    value = parse(text, ANY)
    assert isinstance(value, Question)
    rows = value.chosen(list(drinking.store.ask(value.sparql).plain()))
    assert {row[variable] for row in rows} >= expected
    assert bool(rows) == bool(expected)
