"""What each telling obeys, read from its text: order of time, and verbs that are read back."""

import re

from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.language import Instruction, Plan, Question, parse
from kb.language.lexicalisation import TURNED, in_progress
from kb.language.vocabulary import Vocabulary
from kb.lexicon.english import past
from kb.lexicon.tables import table

WORDS = Vocabulary(primitive_words(primitive_files()))
VERBS = {
    *(past(row["pattern"].split()[0]) for row in table("phrases")),
    *map(past, ("bend", "crouch", "lean", "shift")),
    past("pack"),
    *map(past, ("begin", "stand", "straighten")),
    *(in_progress(pattern).split()[0] for pattern in TURNED),
}
"""Every verb that a telling may have, in the past, or of what goes on beside something else."""

SPAN = re.compile(r"\((\d+\.\d\d)(?:–[^()]*?(\d+\.\d\d))? s\)")
"""The time of a step, from its start to its end; pauses may stand between."""

MEANWHILE = re.compile(r", turning [^,(]*\([^)]*\)")
"""What went on beside the step before it."""

IN_TURN = re.compile(r", then (with [^.]*)")
"""The hands that do one after the other what was said last."""

AFTERWARDS = ("Then ", "Next, ", "After that, ", "Once more, ")


def spans(text: str) -> list[tuple[float, float]]:
    """Start and end of each step, as they stand in the text [s]."""
    return [(float(first), float(last or first)) for first, last in SPAN.findall(text)]


def steps_of(text: str) -> tuple[Instruction, ...]:
    """The steps that are read in a telling or in instructions."""
    value = parse(text, WORDS)
    assert not isinstance(value, Question)
    return value.steps if isinstance(value, Plan) else (value,)


def verbs_of(text: str) -> list[str]:
    """The verbs of a telling, each as often as it stands there, or goes on with another hand."""
    in_turn = [hand for hands in IN_TURN.findall(text) for hand in re.findall("with", hands)]
    return [word for word in re.findall(r"[a-z]+", text) if word in VERBS] + in_turn


def sentences(text: str) -> list[str]:
    """The sentences of a telling."""
    return re.split(r"(?<=\.) (?=[A-Z])", text)


def against_time(text: str) -> list[str]:
    """Sentences whose connectives say another order than their times.

    A sentence that begins with ``Then`` tells what began when all that was told had ended; one
    with ``Meanwhile`` what was done in the time of it; what stands after ``while`` began in the
    time of what stands before. No step of a hand stands after one that ended later, but for what
    is said to go on beside it.
    """
    wrong, end_s = [], 0.0
    for sentence in sentences(text):
        own = spans(sentence)
        start_s, last_s = min(own)[0], max(last for _, last in own)
        if sentence.startswith(AFTERWARDS) and start_s < end_s:
            wrong.append(sentence)
        if sentence.startswith("Meanwhile") and start_s >= end_s:
            wrong.append(sentence)
        main, _, beside = sentence.partition(" while ")
        for stream in (main, beside) if " hand " not in beside.partition(" hand ")[2] else (main,):
            ends = [last for _, last in spans(MEANWHILE.sub("", stream))]
            wrong += [sentence] if ends != sorted(ends) else []
        until_s = max(last for _, last in spans(main))
        if any(not start_s <= first <= until_s for first, _ in spans(beside)):
            wrong.append(sentence)
        end_s = max(end_s, last_s)
    return wrong
