"""What people say is read as they mean it, phrases are read back, and questions are answered.

``instructions_first.txt`` and ``instructions_second.txt`` were written by somebody who had not seen
the grammar. ``*_run.md`` hold what was made of them at first, and are never changed; ``*_read.md``
hold what is read now, each judged by us as ``right`` or ``wrong``.
"""

from itertools import groupby
from pathlib import Path

import pytest
from motions import TALL_MAN, drink_from_mug

from capar.model.errors import CaparError
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from capar.pipelines.observation import observe
from capar.views.readings import question_lines, reading_lines
from kb.actionary import Actionary
from kb.language import Instruction, Plan, Question, parse
from kb.language.vocabulary import Vocabulary
from kb.lexicon.english import past
from kb.lexicon.wordnet import table

HERE = Path(__file__).parent
WORDS = Vocabulary(primitive_words(primitive_files()))


def steps_of(text: str, words: Vocabulary = WORDS) -> tuple[Instruction, ...]:
    """The steps that are read in a description or in instructions."""
    value = parse(text, words)
    assert not isinstance(value, Question)
    return value.steps if isinstance(value, Plan) else (value,)


SETS = {"first": (50, 40), "second": (25, 18)}
"""How many lines each set has, and how many of them must be right at least."""


def _judged(name: str) -> list[tuple[str, list[str], str]]:
    """Lines of a set, each with what is read in it and our judgement."""
    text = (HERE / f"instructions_{name}_read.md").read_text(encoding="utf-8")
    blocks = [block.splitlines() for block in text.strip().split("\n\n")]
    return [(block[0], [row[4:] for row in block[1:-1]], block[-1].strip()) for block in blocks]


def _read(line: str) -> list[str]:
    try:
        value = parse(line, WORDS)
    except CaparError as error:
        return ["refused: " + str(error).split("; it could be", maxsplit=1)[0].splitlines()[0]]
    return list(question_lines(value) if isinstance(value, Question) else reading_lines(value))


@pytest.mark.parametrize("name", SETS)
def test_enough_of_what_was_written_unseen_is_read_rightly(name: str) -> None:
    written = (HERE / f"instructions_{name}.txt").read_text(encoding="utf-8").splitlines()
    judged = _judged(name)
    count, least = SETS[name]
    assert [line for line, _, _ in judged] == written
    assert len(written) == count
    assert sum(verdict == "right" for _, _, verdict in judged) >= least


@pytest.mark.parametrize("name", SETS)
def test_each_line_is_read_as_it_was_when_we_judged_it(name: str) -> None:
    for line, reading, _ in _judged(name):
        assert _read(line) == reading, line


ROWS = [row for name in ("phrases", "canonical") for row in table(name) if "{1}" in row["pattern"]]
PATTERNS = {
    pattern: {row["primitive"] for row in rows}
    for pattern, rows in (
        (key, list(rows))
        for key, rows in groupby(
            sorted(ROWS, key=lambda row: row["pattern"]), key=lambda row: row["pattern"]
        )
    )
}


@pytest.mark.parametrize("pattern", PATTERNS)
def test_every_phrase_of_a_description_is_read_as_one_of_the_primitives_that_have_it(
    pattern: str,
) -> None:
    verb, _, rest = pattern.partition(" ")
    spoken = f"{past(verb)} {rest}".replace("{1}", "the mug").replace("{2}", "the table")
    (step,) = steps_of(f"The agent {spoken.replace('{ee}', 'the right foot')}.")
    plain = pattern.replace(" back", "").replace(" there", "")
    also = {name for other, names in PATTERNS.items() if other == plain for name in names}
    assert step.call.action in PATTERNS[pattern] | also
    assert step.call.objects[0] == "mug"
    assert "{2}" not in pattern or step.call.objects[1] == "table"


def test_numbered_objects_of_several_words_are_read_where_they_are_known() -> None:
    known = Vocabulary(
        WORDS.words, frozenset({"coffee_can", "coffee_can_2", "tuna", "tuna_3", "carton", "table"})
    )
    (step,) = steps_of(
        "The agent put the coffee can, coffee can 2, and the tuna in the carton.", known
    )
    assert step.call.objects[:3] == ("coffee_can", "coffee_can_2", "tuna")
    (step,) = steps_of("The agent put a can of tuna and a third can of tuna on the table.", known)
    assert step.call.objects[:2] == ("tuna", "tuna_3")


@pytest.fixture(scope="module")
def drinking() -> Actionary:
    book = Actionary.in_memory()
    book.add(observe(drink_from_mug(TALL_MAN).capture))
    return book


def _answers(book: Actionary, text: str) -> list[dict[str, object]]:
    value = parse(text, WORDS)
    assert isinstance(value, Question)
    return [dict(row) for row in value.chosen(list(book.store.ask(value.sparql).plain()))]


@pytest.mark.parametrize(
    ("text", "variable", "expected"),
    [
        ("who drank?", "performer", {"tall_man"}),
        ("who moved the mug?", "performer", {"tall_man"}),
        ("who touched the mug?", "performer", {"tall_man"}),
        ("who put down the mug?", "performer", {"tall_man"}),
        ("who picked the mug up?", "performer", {"tall_man"}),
        ("where was the mug put?", "place", {"table"}),
        ("what did she drink from?", "object", {"mug"}),
        ("what was the first thing that he picked up?", "object", {"mug"}),
        ("how often did she drink?", "times", {1}),
        ("how often did he touch the mug?", "times", {1}),
        ("which hand moved the mug before it was put on the table?", "ee", {"right_hand"}),
        ("what did the right hand do while the mug was being tilted?", "action", {"Drink"}),
        ("who poured?", "performer", set()),
        ("who held the mug with the left hand?", "performer", set()),
        ("who drank within 0.1 s?", "performer", set()),
        ("who drank before the mug was moved to the head?", "performer", set()),
    ],
)
def test_a_question_is_answered_by_what_entails_it(
    drinking: Actionary, text: str, variable: str, expected: set[object]
) -> None:
    assert {row[variable] for row in _answers(drinking, text)} >= expected
    if not expected:
        assert not _answers(drinking, text)
