"""What happened in an observation, in plain English, from its segments and PARs alone."""

from collections.abc import Sequence
from typing import Literal

from capar.model.observation import Observation
from kb.language.clauses import Clause, clauses
from kb.language.contacts import Scene
from kb.language.english import capital, the, times
from kb.language.hands import told_in_order
from kb.language.phrasing import Phrasebook
from kb.language.telling import Telling
from kb.lexicon.links import PrimitiveWords

Detail = Literal["steps", "summary"]

LONGEST = 6
"""The most clauses of one sentence."""

OPENINGS = ("Then", "Next,", "After that,")
"""How sentences after the first begin, in turn."""


def describe(
    observation: Observation,
    *,
    detail: Detail = "steps",
    timed: bool = False,
    words: Sequence[PrimitiveWords] = (),
) -> str:
    """Say what was done.

    Args:
        observation: What was understood of a capture.
        detail: ``steps`` tells every step, ``summary`` only those that changed something.
        timed: Whether each step is followed by its time [s].
        words: What the primitives of the rule base are called; those that are not there are said
            by the verb of a more general one.
    """
    book, scene = Phrasebook(words), Scene(observation)
    told = [
        clauses(observation, link, book, scene, only_changes=detail == "summary")
        for link in observation.links
    ]
    steps = told_in_order(observation.links, told)
    subject = the(observation.agent.name)
    if not steps:
        return f"{capital(subject)} touched nothing."
    telling = Telling(observation.links, timed=timed)
    sentences = [telling.sentence(*each) for each in _sentences(steps)]
    return " ".join(
        f"{_opening(index)}{subject} {sentence}." if index else f"{capital(subject)} {sentence}."
        for index, sentence in enumerate(sentences)
    )


def _opening(index: int) -> str:
    return f"{OPENINGS[(index - 1) % len(OPENINGS)]} "


def _sentences(steps: Sequence[Clause]) -> list[tuple[list[Clause], str, float]]:
    """Clauses by sentence; what is repeated stands once, with how often and until when."""
    out: list[tuple[list[Clause], str, float]] = []
    current: list[Clause] = []
    at = 0
    while at < len(steps):
        size, count = _repetition(steps, at)
        if count > 1:
            if current:
                out.append((current, "", 0.0))
                current = []
            end = steps[at + size * count - 1].end_s
            out.append((list(steps[at : at + size]), times(count), end))
            at += size * count
            continue
        current.append(steps[at])
        at += 1
        if _ends(current, steps[at : at + 1]):
            out.append((current, "", 0.0))
            current = []
    return [*out, (current, "", 0.0)] if current else out


def _ends(current: Sequence[Clause], following: Sequence[Clause]) -> bool:
    """Whether a sentence ends here: it is long, or a hand is free and takes up something else."""
    if not following:
        return False
    last, after = current[-1], following[0]
    if last.overlap_s(after) > 0.0:
        return False
    lets_go = last.pattern.startswith(("let go", "take {ee}"))
    return len(current) >= LONGEST or lets_go or last.ees != after.ees


def _repetition(steps: Sequence[Clause], at: int) -> tuple[int, int]:
    """The length of the block that is repeated from here, and how often it stands; else (1, 1)."""
    best = (1, 1)
    for size in range(1, LONGEST + 1):
        block = [(each.signature, each.ees) for each in steps[at : at + size]]
        count = 1
        while block == [
            (each.signature, each.ees)
            for each in steps[at + size * count : at + size * (count + 1)]
        ]:
            count += 1
        if count > 1 and size * count > best[0] * best[1]:
            best = (size, count)
    return best
