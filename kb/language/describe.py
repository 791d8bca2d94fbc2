"""What happened in an observation, in plain English, from its segments and their relations."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from capar.model.capture import Agent
from capar.model.observation import Observation, ObservedLink, ObservedObject
from kb.language.steps import FREE, NAMELESS, ON_FOOT, QUIET, Narrator, Step, spoken
from kb.lexicon.english import PEOPLE, capital, joined, past, the, the_agent, times
from kb.lexicon.links import PrimitiveWords

Detail = Literal["steps", "summary"]

MOST_STEPS = 8
"""The most steps of a sentence."""

OPENINGS = ("Then ", "Next, ", "After that, ")
"""How sentences begin about what was done afterwards, in turn."""


def describe(
    observation: Observation,
    *,
    detail: Detail = "steps",
    timed: bool = False,
    words: Sequence[PrimitiveWords] = (),
) -> str:
    """Say what was done; where several agents performed, by one after the other.

    Segments that are one action by the rules are one step.

    Args:
        observation: What was understood of a capture.
        detail: ``steps`` describes every step, ``summary`` only those that changed something.
        timed: Whether each step is followed by its time [s].
        words: What the primitives of the rule base are called; those that are not there are said
            by the verb of a more general one.
    """
    narrator = Narrator(observation, words)
    agents = (observation.agent, *observation.others)
    parts = []
    for agent in agents:
        links = [each for each in observation.links if observation.performer(each.ee) == agent.name]
        if not links and len(agents) > 1:
            continue
        writer = _Writer(observation, links, _subject(observation, agent), timed=timed)
        steps = narrator.steps(links)
        if detail == "summary":
            steps = (
                [each for each in steps if each.changes and each.pattern not in ON_FOOT]
                or [each for each in steps if each.pattern not in QUIET]
                or steps
            )
        parts.append(writer.story(steps) if steps else writer.idle())
    return " ".join(parts)


def nouns(objects: Sequence[ObservedObject]) -> dict[str, str]:
    """Objects by what they are called, where that is their kind.

    So it is where a capture says of one object alone that it is a ``large_table``, whatever short
    name it has there.
    """
    kinds = Counter(each.kind for each in objects)
    return {each.name: each.kind for each in objects if "_" in each.kind and kinds[each.kind] == 1}


def _subject(observation: Observation, agent: Agent) -> str:
    """Who acts; one alone, who has a number instead of a name, is the agent."""
    code = agent.name.rstrip("0123456789").rstrip("_- ").lower()
    numbered = agent.name[-1:].isdigit() and (code in PEOPLE or len(code) <= 2)
    alone = not observation.others
    return "the agent" if numbered and alone else the_agent(agent.name, agent.kind)


class _Writer:
    """Writes the steps of one agent: sentences in order of time, with pronouns and hands."""

    def __init__(
        self, observation: Observation, links: Sequence[ObservedLink], subject: str, *, timed: bool
    ) -> None:
        self._nouns = nouns(observation.objects)
        self._movable = {each.name for each in observation.objects if each.tag == "mobile"}
        self._links = {link.ee: link for link in links}
        self._subject, self._timed = subject, timed

    def story(self, steps: Sequence[Step]) -> str:
        """Every sentence: consecutive steps of the same hand, until another one acts in a pause.

        ``Then`` opens a sentence only where all that was said before had ended, ``Meanwhile``
        where it had not.
        """
        waiting = list(steps)
        sentences: list[str] = []
        end_s, later = float("-inf"), 0
        while waiting:
            block, left = waiting[:1], []
            ees = block[0].ees
            for at, step in enumerate(waiting[1:], 1):
                last = block[-1]
                if step.ees != ees:
                    if set(step.ees) & set(ees) or step.start_s >= last.end_s:
                        left += waiting[at:]
                        break
                    left.append(step)
                elif (step.pattern, step.objects) == (last.pattern, last.objects):
                    block[-1] = replace(step, start_s=last.start_s, count=last.count + 1)
                elif len(block) < MOST_STEPS:
                    block.append(step)
                else:
                    left += waiting[at:]
                    break
            waiting = left
            opening = ""
            if sentences:
                after = block[0].start_s >= end_s
                opening = OPENINGS[later % len(OPENINGS)] if after else "Meanwhile, "
                later = later + 1 if after else 0
            sentences.append(capital(f"{opening}{self._subject} {self._sentence(block)}."))
            end_s = max(end_s, *(each.end_s for each in block))
        return " ".join(sentences)

    def _sentence(self, steps: Sequence[Step]) -> str:
        """Steps of one hand; it is named once, and an object is ``it`` where that is clear."""
        parts = []
        topic, clear, named = "", False, False
        for step in steps:
            verb, _, rest = step.pattern.partition(" ")
            text = f"{past(verb)} {rest}".strip()
            hand = self._hands(step.ees)
            if "{ee}" in text:
                kind = self._links[step.ees[0]].kind
                again = f"the {kind}" if topic else ("it", "them")[len(step.ees) - 1]
                text = text.replace("{ee}", again if named else hand)
                named = named or not step.objects
            elif not named and step.pattern not in NAMELESS:
                text += f" {'using' if '{1} with {' in text else 'with'} {hand}"
                named = True
            said = [name for place, name in enumerate(step.objects, 1) if f"{{{place}}}" in text]
            for place, name in enumerate(step.objects, 1):
                it = place == 1 and clear and name == topic
                text = text.replace(
                    f"{{{place}}}", "it" if it else the(self._nouns.get(name, name))
                )
            if step.objects and step.objects[0] in {topic, *said}:
                topic, clear = step.objects[0], not self._movable.intersection(said[1:])
            text += f" {times(step.count)}" if step.count > 1 else ""
            text += f" to {step.purpose}" if step.purpose else ""
            text += f" ({step.start_s:.2f}–{step.end_s:.2f} s)" if self._timed else ""
            parts.append(f"{text}, with a pause" if step.paused else text)
        return joined(parts)

    def _hands(self, ees: Sequence[str]) -> str:
        if len(ees) > 1:
            kind = self._links[ees[0]].kind
            return f"both {'feet' if kind == 'foot' else f'{kind}s'}"
        return f"the {spoken(self._links[ees[0]])}"

    def idle(self) -> str:
        """What moved where no object was touched, and that none was where there was one."""
        moved = {
            link.ee: [each for each in link.segments if FREE in {each.name, *each.general}]
            for link in self._links.values()
        }
        kinds: dict[str, list[str]] = {}
        for ee in (ee for ee, segments in moved.items() if segments):
            kinds.setdefault(self._links[ee].kind, []).append(ee)
        parts = []
        for ees in kinds.values():
            hands = [self._hands(ees)] if len(ees) == 2 else [self._hands((ee,)) for ee in ees]
            start_s = min(moved[ee][0].start_s for ee in ees)
            end_s = max(moved[ee][-1].end_s for ee in ees)
            time = f" ({start_s:.2f}–{end_s:.2f} s)" if self._timed else ""
            parts.append(f"{joined(hands)}{time}")
        untouched = " without touching anything" if self._movable else ""
        did = f"moved {joined(parts)}{untouched}" if parts else "touched nothing"
        return f"{capital(self._subject)} {did}."
