"""What happened in an observation, in plain English, from its segments and PARs alone."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from capar.model.capture import Agent
from capar.model.observation import Observation, ObservedLink
from kb.language.aggregation import edited
from kb.language.alternating import in_turns
from kb.language.bodily import Told, as_one_body, with_walks
from kb.language.choosing import chosen, longest, mattering
from kb.language.clause import Clause
from kb.language.clauses import clauses, main_things
from kb.language.contacts import Scene
from kb.language.crouching import with_crouching
from kb.language.free_motion import reaches
from kb.language.gathering import gathered
from kb.language.hands import (
    as_the_other_hand,
    by_fingers,
    fingers_of,
    in_sequence,
    mostly_together,
    spoken_links,
    told_in_order,
    with_the_other_hand,
)
from kb.language.holding import Holding
from kb.language.lexicalisation import FREE, LEAVES, STEP, STEP_UP, TWO_STEPS, WALK, Phrasebook
from kb.language.listing import listed
from kb.language.omitting import set_down, without_coming
from kb.language.pauses import pauses
from kb.language.placing import placed, righted, turned_on_the_way, while_moving
from kb.language.planning import sentences
from kb.language.pouring import poured
from kb.language.realisation import Realiser
from kb.language.repeating import as_segmented, deeds, whole
from kb.language.stowing import stowed
from kb.language.turning import Turning, turned, with_turning
from kb.language.turning import timed as in_course
from kb.lexicon.english import PEOPLE, capital, the_agent
from kb.lexicon.links import PrimitiveWords

Detail = Literal["steps", "summary"]

AGENT = "the agent"
"""Whoever acts alone and has no name."""

INITIALS = 2
"""So many letters at most before a number are no name."""

UNTOLD = frozenset({STEP, TWO_STEPS, STEP_UP, WALK, *LEAVES})
"""Patterns of what the feet do that a summary leaves out: all but a walk to a thing, or around it.
"""

TO_THE_LETTER = "thesis"
"""The profile of rules of which every segment is told as a step of its own."""


def describe(
    observation: Observation,
    *,
    detail: Detail = "steps",
    timed: bool = False,
    words: Sequence[PrimitiveWords] = (),
) -> str:
    """Say what was done; where several agents performed, by one after the other.

    Segments of one motion are told as one deed, and scraps with what they belong to; what the
    profile ``thesis`` found is told segment by segment.

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
    seen, told = _deeds(observation, links, book, scene)
    if detail == "summary":
        changes = any(each.changes for part in told for each in part)
        told = [mattering(part) if changes else _counted(main_things(part)) for part in told]
        plain = [replace(each, pauses=0) for each in told_in_order(links, told)]
        if any(each.changes for each in plain):
            walked = with_walks(plain, links, seen, observation.objects, scene)
            plain = [each for each in walked if each.pattern not in UNTOLD]
        steps = mostly_together(links, plain)
    else:
        steps = with_walks(told_in_order(links, told), links, seen, observation.objects, scene)
        if observation.profile != TO_THE_LETTER:
            steps = mostly_together(links, steps)
            steps = with_crouching(steps, observation.links, observation.tracks)
    if observation.profile != TO_THE_LETTER:
        turning = Turning(observation)
        steps = stowed(poured(steps, turning), observation.objects, scene)
        there = placed(steps, observation.objects, scene, turning)
        there = in_course(while_moving(there, scene), scene, turning) if timed else there
        steps = in_sequence(without_coming(set_down(there, scene), scene))
        steps = turned_on_the_way(righted(steps))
    if detail == "summary":
        steps = chosen(gathered(in_turns(steps), observation.objects, scene))
    paused = pauses(steps) if observation.profile != TO_THE_LETTER and detail == "steps" else {}
    if not timed:
        steps = edited(steps)
    if observation.profile != TO_THE_LETTER:
        steps = listed(steps, paused)
    subject = _subject(observation)
    realiser = Realiser(links, observation.objects, timed=timed)
    if not steps:
        moved = _moved_freely(links, book)
        reached = () if observation.profile == TO_THE_LETTER else reaches(observation, moved)
        return f"{capital(subject)} {realiser.idle(moved, reached)}."
    return " ".join(
        capital(f"{part.opening}{subject} {realiser.sentence(part)}.")
        for part in sentences(
            steps,
            lead=longest(steps) if detail == "summary" else (),
            paused=paused,
            timed=timed,
        )
    )


def _subject(observation: Observation) -> str:
    """Who acts; one alone, who has a number instead of a name, as the agent."""
    name = observation.agent.name
    code = name.rstrip("0123456789").rstrip("_- ").lower()
    numbered = name[-1:].isdigit() and (code in PEOPLE or len(code) <= INITIALS)
    if numbered and not observation.others:
        return AGENT
    return the_agent(name, observation.agent.kind)


def _deeds(
    observation: Observation, links: Sequence[ObservedLink], book: Phrasebook, scene: Scene
) -> tuple[list[Told], list[Told]]:
    """What each link did by itself, and as one body."""
    to_the_letter = observation.profile == TO_THE_LETTER
    holding = None if to_the_letter else Holding(observation)
    turning = Turning(observation)
    told = [clauses(observation, link, book, scene, turning, holding) for link in links]
    if to_the_letter:
        return [], [as_segmented(each) for each in told]
    ways = [turned(each, turning) for each in as_the_other_hand(links, told)]
    seen = [with_turning(deeds(rest, scene, turning), found) for rest, found in ways]
    for place, link in enumerate(links):
        ways = [
            turned(tuple(replace(step, ees=(link.ee,)) for step in part), turning)
            for part in (
                clauses(observation, finger, book, scene, turning, None)
                for finger in fingers_of(link, observation.links)
            )
        ]
        found = [with_turning(deeds(rest, scene, turning), turns) for rest, turns in ways]
        seen[place] = by_fingers(seen[place], found)
    told = as_one_body(links, seen, observation.objects, scene)
    return seen, with_the_other_hand(links, seen, told)


def _of(observation: Observation, agent: Agent) -> Observation:
    """What one of several agents did."""
    own = tuple(each for each in observation.links if observation.performer(each.ee) == agent.name)
    return replace(observation, agent=agent, links=own)


def _counted(alike: tuple[Clause, ...]) -> tuple[Clause, ...]:
    """Clauses that say the same as one that says how often."""
    return (whole(alike, count=len(alike)),) if alike else ()


def _moved_freely(
    links: Sequence[ObservedLink], book: Phrasebook
) -> dict[str, tuple[float, float]]:
    """The end-effectors that moved by themselves, each from when to when [s]."""
    free = {
        link.ee: [
            each for each in link.segments if book.pattern(each.name, each.general, (), 0) == FREE
        ]
        for link in links
    }
    return {ee: (own[0].start_s, own[-1].end_s) for ee, own in free.items() if own}
