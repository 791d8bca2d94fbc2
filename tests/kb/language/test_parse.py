"""Sentences in and out: each step comes back from its sentence, and mistakes are pointed at."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import TALL_MAN, drink_from_mug

from capar.model.capture import NAME
from capar.model.par import Call
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.language import Instruction, Question, parse, sentence
from kb.language.question import Ask
from kb.language.reader import SentenceError
from kb.language.vocabulary import EFFECTORS, EVERYTHING, PREPOSITIONS, Vocabulary
from kb.lexicon.english import noun
from kb.lexicon.links import PrimitiveWords

WORDS = primitive_words(primitive_files())
KNOWN = Vocabulary(WORDS, frozenset({"mug", "table", "head", "blue_cup"}))
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


@st.composite
def steps(draw: st.DrawFn) -> tuple[Instruction, Vocabulary]:
    """Any primitive with arguments, and the words in which it is said."""
    objects = tuple(draw(st.lists(OBJECTS, max_size=3, unique_by=str.lower)))
    name = draw(st.sampled_from([*(each.name for each in WORDS), "Unknown", "My own"]))
    ee = draw(st.sampled_from(["", *EFFECTORS]))
    purpose = draw(PURPOSES)
    vocabulary = Vocabulary(WORDS, frozenset(objects))
    return Instruction(Call(name, objects, purpose), ee), vocabulary


@given(steps())
def test_a_step_comes_back_from_its_sentence(case: tuple[Instruction, Vocabulary]) -> None:
    step, vocabulary = case
    assert parse(sentence(step, vocabulary), vocabulary) == step


@pytest.mark.parametrize("words", WORDS, ids=lambda each: each.name)
@pytest.mark.parametrize("count", [1, 2])
def test_every_primitive_comes_back_over_one_object_and_two(
    words: PrimitiveWords, count: int
) -> None:
    step = Instruction(Call(words.name, ("mug", "blue_cup")[:count], "PickUp"), "left_hand")
    assert parse(sentence(step, KNOWN), KNOWN) == step


def test_a_step_of_an_observation_comes_back() -> None:
    observation = observe(drink_from_mug(TALL_MAN).capture)
    objects = frozenset(each.name for each in observation.objects)
    vocabulary = Vocabulary(WORDS, objects)
    assert observation.segments
    for segment in observation.segments:
        assert parse(sentence(segment, vocabulary), vocabulary) == Instruction.of(segment)
    for link in observation.complex_par.links:
        for step in link.steps:
            assert parse(sentence(step, vocabulary), vocabulary) == Instruction.of(step)


def test_a_sentence_says_the_hand_the_source_and_the_end() -> None:
    value = Instruction(Call("MoveObjTo", ("mug", "head"), "Drink"), "right_hand", "", "table")
    text = "Move the mug to the head from the table with the right hand to drink."
    assert sentence(value) == text
    assert parse(text) == value
    assert parse("move the mug from the table to the head with the right hand to drink") == value


@pytest.mark.parametrize(
    ("text", "action", "objects"),
    [
        ("Put the blue cup on the table.", "MoveObjTo", ("blue_cup", "table")),
        ("touch the table with the mug", "TouchWith", ("mug", "table")),
        ("touch the table with the right hand", "Touch", ("table",)),
        ("release the mug", "ResumePosture", ("mug",)),
        ("the agent moved the mug to the head", "MoveObjTo", ("mug", "head")),
        ("the agent lifted the mug to the mouth", "MoveObjTo", ("mug", "head")),
        ("lift a mug", "Lift", ("mug",)),
        ("stir with the mug in the blue cup", "Stir", ("mug", "blue_cup")),
    ],
)
def test_other_ways_to_say_it_are_read(text: str, action: str, objects: tuple[str, ...]) -> None:
    read = parse(text, KNOWN)
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
    mark = str(error).splitlines()[-1]
    assert mark.index("^") == error.column + 2


def test_a_question_is_answered_from_the_actionary() -> None:
    book = Actionary.in_memory()
    book.add(observe(drink_from_mug(TALL_MAN).capture))
    question = parse("which hand moved the mug to the head?", KNOWN)
    assert isinstance(question, Question)
    assert question.ask is Ask.WHICH_HAND
    (row,) = book.store.ask(question.sparql).plain()
    assert row["ee"] == "right_hand"
    who = parse("who reached for the mug?", KNOWN)
    assert isinstance(who, Question)
    assert [each["performer"] for each in book.store.ask(who.sparql).plain()] == ["tall_man"]
    nobody = parse("who reached for the table?", KNOWN)
    assert isinstance(nobody, Question)
    assert not list(book.store.ask(nobody.sparql).plain())
