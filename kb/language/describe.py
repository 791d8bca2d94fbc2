"""What happened in an observation, in plain English, from its segments and PARs alone."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from capar.model.capture import Agent
from capar.model.observation import Observation, ObservedLink
from kb.language.aggregation import edited
from kb.language.clauses import Clause, clauses
from kb.language.contacts import Scene
from kb.language.hands import spoken_links, told_in_order
from kb.language.lexicalisation import FREE, Phrasebook
from kb.language.realisation import Realiser
from kb.language.repeating import counted, repetition
from kb.lexicon.english import capital, the_agent, times
from kb.lexicon.links import PrimitiveWords

Detail = Literal["steps", "summary"]

LONGEST = 6
"""The most clauses of one sentence."""

LONGEST_OF_TWO = 4
"""The most clauses of each hand in a sentence about two."""

ENOUGH_OF_ONE = 3
"""After so many clauses, what is done with another thing begins another sentence."""

OPENINGS = ("Then", "Next,", "After that,")
"""How sentences after the first begin, in turn."""


def describe(
    observation: Observation,
    *,
    detail: Detail = "steps",
    timed: bool = False,
    words: Sequence[PrimitiveWords] = (),
) -> str:
    """Say what was done; where several agents performed, by one after the other.

    Args:
        observation: What was understood of a capture.
        detail: ``steps`` describes every step, ``summary`` only those that changed something.
        timed: Whether each step is followed by its time [s].
        words: What the primitives of the rule base are called; those that are not there are said
            by the verb of a more general one.
    """
    book, scene = Phrasebook(words), Scene(observation)
    told = [observation]
    if observation.others:
        agents = (observation.agent, *observation.others)
        told = [each for each in (_of(observation, agent) for agent in agents) if each.links]
    return " ".join(_story(each, book, scene, detail=detail, timed=timed) for each in told)


def _story(
    observation: Observation, book: Phrasebook, scene: Scene, *, detail: Detail, timed: bool
) -> str:
    """What one agent did."""
    links = spoken_links(observation.links)
    summary = detail == "summary"
    told = [
        counted(clauses(observation, link, book, scene, only_changes=summary)) for link in links
    ]
    if summary and any(each.changes for part in told for each in part):
        told = [part if any(each.changes for each in part) else () for part in told]
    steps = told_in_order(links, told)
    if not timed:
        steps = edited(steps, summary=summary)
    subject = the_agent(observation.agent.name, observation.agent.kind)
    realiser = Realiser(links, timed=timed)
    if not steps:
        return f"{capital(subject)} {realiser.idle(_moved_freely(links, book))}."
    out: list[str] = []
    for index, part in enumerate(parts := _sentences(steps)):
        opening = _opening(index, parts[index - 1], part) if index else ""
        sentence = f"{opening}{subject} {realiser.sentence(part.steps, part.often, part.end_s)}."
        out.append(capital(sentence))
    return " ".join(out)


def _of(observation: Observation, agent: Agent) -> Observation:
    """What one of several agents did."""
    own = tuple(each for each in observation.links if observation.performer(each.ee) == agent.name)
    return replace(observation, agent=agent, links=own)


def _moved_freely(links: Sequence[ObservedLink], book: Phrasebook) -> list[str]:
    """The end-effectors that moved by themselves."""
    return [
        link.ee
        for link in links
        if any(book.pattern(each.name, each.general, (), 0) == FREE for each in link.segments)
    ]


@dataclass(frozen=True)
class _Part:
    """The content of one sentence; what is repeated stands once, with how often and until when."""

    steps: tuple[Clause, ...]
    often: str = ""
    end_s: float = 0.0


def _opening(index: int, before: _Part, part: _Part) -> str:
    recurs = before.often and _said(part) == _said(before)[: len(part.steps)]
    return "Once more, " if recurs else f"{OPENINGS[(index - 1) % len(OPENINGS)]} "


def _said(part: _Part) -> list[tuple[object, ...]]:
    return [(each.signature, each.ees) for each in part.steps]


def _sentences(steps: Sequence[Clause]) -> list[_Part]:
    """Clauses by sentence."""
    out: list[_Part] = []
    current: list[Clause] = []
    at = 0
    while at < len(steps):
        size, count = repetition(steps, at, longest=LONGEST)
        if current and (count > 1 or _ends(current, steps[at])):
            out.append(_Part(tuple(current)))
            current = []
        if count > 1:
            end_s = steps[at + size * count - 1].end_s
            out.append(_Part(tuple(steps[at : at + size]), times(count), end_s))
            at += size * count
        else:
            current.append(steps[at])
            at += 1
    return [*out, _Part(tuple(current))] if current else out


def _ends(current: Sequence[Clause], following: Clause) -> bool:
    """Whether a sentence ends before a clause.

    One hand's sentence ends when it is long, when the hand has let go, and when it turns to
    another thing after enough was told of the first. What the other hand does at
    the same time goes on in the same sentence; what it does later, or both do, in another.
    """
    own = [each for each in current if each.ees == following.ees]
    other = [each for each in current if each.ees != following.ees]
    if other and max(each.end_s for each in other) <= following.start_s:
        return True
    if any(set(each.ees) & set(following.ees) for each in other):
        return True
    if not other and own and (_frees(own[-1]) or _turns_away(own, following)):
        return True
    return len(own) >= (LONGEST_OF_TWO if other else LONGEST)


def _turns_away(told: Sequence[Clause], following: Clause) -> bool:
    return len(told) >= ENOUGH_OF_ONE and told[-1].objects[:1] != following.objects[:1]


def _frees(clause: Clause) -> bool:
    return clause.pattern.startswith(("let go", "take {ee}"))
