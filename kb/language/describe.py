"""What happened in an observation, in plain English, from its segments and their relations."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from capar.model.capture import Agent
from capar.model.observation import Observation, ObservedLink, ObservedObject
from kb.language.phrases import QUIET, Phrasebook, in_past
from kb.language.steps import ON_FOOT, Narrator, Step, spoken
from kb.lexicon.english import PEOPLE, capital, joined, the, the_agent, times
from kb.lexicon.links import PrimitiveWords

Detail = Literal["steps", "summary"]

AGENT = "the agent"
"""Whoever acts alone and has no name."""

MOST_STEPS, MOST_BESIDE, MOST_REPEATED = 6, 7, 4
"""The most steps of a sentence, of another hand beside them, and of what is counted as one."""

ENOUGH_OF_ONE = 2
"""After so many steps, what is done with another object begins another sentence."""

OPENINGS = ("Then ", "Next, ", "After that, ")
"""How sentences begin that tell what was done afterwards, in turn."""


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
    narrator = Narrator(observation, Phrasebook(words))
    agents = (observation.agent, *observation.others)
    told = []
    for agent in agents:
        links = tuple(
            each for each in observation.links if observation.performer(each.ee) == agent.name
        )
        if links or len(agents) == 1:
            writer = _Writer(observation, links, timed=timed)
            steps = list(narrator.steps(links))
            steps = _summary(steps) if detail == "summary" else steps
            subject = _subject(observation, agent)
            if steps:
                told.append(writer.story(steps, subject))
            else:
                told.append(f"{capital(subject)} {writer.idle(narrator.free_motion(links))}.")
    return " ".join(told)


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
    return AGENT if numbered and alone else the_agent(agent.name, agent.kind)


def _summary(steps: Sequence[Step]) -> list[Step]:
    """The steps that changed something; if none did, those that were more than coming and going."""
    changing = [each for each in steps if each.changes and each.pattern not in ON_FOOT]
    return changing or [each for each in steps if each.pattern not in QUIET] or list(steps)


@dataclass
class _Block:
    """Steps of the same end-effectors that are told together, and how often they recur."""

    steps: tuple[Step, ...]
    count: int = 1

    @property
    def end_s(self) -> float:
        return max(each.end_s for each in self.steps)


def _blocks(stream: Sequence[Step]) -> list[_Block]:
    """The steps of one stream, with what recurs in succession counted."""
    out, at = [], 0
    said = [each.signature for each in stream]
    while at < len(stream):
        size, count = 1, 1
        for longer in range(1, MOST_REPEATED + 1):
            again = 1
            while said[at : at + longer] == said[at + longer * again : at + longer * (again + 1)]:
                again += 1
            if again > 1 and longer * again > size * count:
                size, count = longer, again
        run = stream[at : at + size * count]
        if size == 1 and count > 1:
            whole = replace(run[0], end_s=run[-1].end_s, count=count)
            out.append(_Block((replace(whole, segments=_all_segments(run)),)))
        elif count > 1:
            last = replace(run[size - 1], end_s=run[-1].end_s)
            out.append(_Block((*run[: size - 1], last), count))
        else:
            out.append(_Block(tuple(run)))
        at += size * count
    return out


def _all_segments(run: Sequence[Step]) -> tuple[tuple[str, int], ...]:
    return tuple(key for each in run for key in each.segments)


class _Writer:
    """Writes the steps of one agent: sentences in order of time, with pronouns and hands."""

    def __init__(
        self, observation: Observation, links: Sequence[ObservedLink], *, timed: bool
    ) -> None:
        self._nouns = nouns(observation.objects)
        self._movable = {each.name for each in observation.objects if each.tag == "mobile"}
        self._links = {link.ee: link for link in links}
        self._timed = timed
        self._topic, self._rival = "", False

    def story(self, steps: Sequence[Step], subject: str) -> str:
        """Every sentence: steps of the same hand together, beside them what others did meanwhile.

        ``Then`` opens a sentence only where all that was told before had ended, ``Meanwhile``
        where it had not.
        """
        streams: dict[tuple[str, ...], list[_Block]] = {}
        for ees in dict.fromkeys(each.ees for each in steps):
            streams[ees] = _blocks([each for each in steps if each.ees == ees])
        sentences: list[str] = []
        end_s, later = float("-inf"), 0
        while waiting := {ees: blocks for ees, blocks in streams.items() if blocks}:
            ees = min(waiting, key=lambda each: waiting[each][0].steps[0].start_s)
            main, count = self._main(ees, waiting)
            until_s = max(each.end_s for each in main)
            beside = {} if count > 1 else self._beside(ees, waiting, until_s)
            opening = ""
            if sentences:
                after = main[0].start_s >= end_s
                opening = OPENINGS[later % len(OPENINGS)] if after else "Meanwhile, "
                later = later + 1 if after else 0
            text = self._sentence(main, count, beside)
            sentences.append(capital(f"{opening}{subject} {text}."))
            ends = (each.end_s for part in beside.values() for each in part)
            end_s = max(end_s, until_s, *ends)
        return " ".join(sentences)

    def _main(
        self, ees: tuple[str, ...], waiting: dict[tuple[str, ...], list[_Block]]
    ) -> tuple[list[Step], int]:
        """The steps of one sentence, taken from their stream, and how often they recur."""
        blocks = waiting[ees]
        first = blocks.pop(0)
        taken = list(first.steps)
        if first.count > 1:
            return taken, first.count
        others = [each for key, rest in waiting.items() if key != ees for each in rest]
        while blocks and blocks[0].count == 1:
            following = blocks[0].steps[0]
            turns_away = following.objects[:1] != taken[-1].objects[:1]
            if len(taken) >= MOST_STEPS and (turns_away or following.pattern not in QUIET):
                break
            sharing = [
                each
                for each in others
                if set(each.steps[0].ees) & set(ees) and each.steps[0].start_s < following.start_s
            ]
            missed = [
                each
                for each in others
                if taken[-1].end_s <= each.steps[0].start_s and each.end_s <= following.start_s
            ]
            own = sum(bool(each.objects) for each in taken)
            if sharing or missed or (turns_away and own >= ENOUGH_OF_ONE):
                break
            taken.append(following)
            blocks.pop(0)
        return taken, 1

    @staticmethod
    def _beside(
        ees: tuple[str, ...], waiting: dict[tuple[str, ...], list[_Block]], until_s: float
    ) -> dict[tuple[str, ...], list[Step]]:
        """What other end-effectors did that began before the end of a sentence, taken likewise."""
        out: dict[tuple[str, ...], list[Step]] = {}
        for other, blocks in waiting.items():
            shares = {ee for key, rest in waiting.items() if rest and len(key) > 1 for ee in key}
            if set(other) & set(ees) or len(other) > 1 or (set(other) & shares):
                continue
            taken: list[Step] = []
            while (
                blocks
                and blocks[0].count == 1
                and len(taken) < MOST_BESIDE
                and blocks[0].steps[0].start_s < until_s
                and 2.0 * (min(blocks[0].end_s, until_s) - blocks[0].steps[0].start_s)
                >= blocks[0].end_s - blocks[0].steps[0].start_s
            ):
                taken += blocks.pop(0).steps
            if taken:
                out[other] = taken
        return out

    def _sentence(
        self, main: Sequence[Step], count: int, beside: dict[tuple[str, ...], list[Step]]
    ) -> str:
        """The steps as the rest of a sentence whose subject is the agent."""
        text = self._stream(main, named=())
        for number, (ees, steps) in enumerate(beside.items()):
            comma = "," if len(main) + len(steps) > 2 else ""
            word = f"{comma} while" if number == 0 else f"{comma} and"
            text += f"{word} {self._hands(ees)} {self._stream(steps, named=ees)}"
        return f"{text}, {times(count)} in all" if count > 1 else text

    def _stream(self, steps: Sequence[Step], *, named: tuple[str, ...]) -> str:
        """Steps of one hand; named once, where it is not the subject."""
        parts = []
        self._topic, self._rival = "", False
        for step in steps:
            text = self._phrase(step, named)
            if step.pattern in ON_FOOT or "{ee}" in step.pattern:
                with_hand = ""
            else:
                with_hand = "" if step.ees == named else self._with(step)
                named = step.ees
            if "{with}" in text:
                text = text.replace("{with}", f"{with_hand.strip()} " if with_hand else "")
            else:
                text += with_hand
            parts.append(f"{text}{self._tail(step)}")
        return joined(parts)

    def _with(self, step: Step) -> str:
        """The hand that does it; ``using`` where something goes along with the object."""
        return f" {'using' if '{1} with {' in step.pattern else 'with'} {self._hands(step.ees)}"

    def _phrase(self, step: Step, named: tuple[str, ...]) -> str:
        same = step.ees == named and len(named) == 1
        hand = f"the {self._links[named[0]].kind}" if same else self._hands(step.ees)
        text = in_past(step.pattern).replace("{ee}", hand)
        rival = False
        for place, name in enumerate(step.objects, 1):
            if f"{{{place}}}" in text:
                it = place == 1 and name == self._topic and not self._rival
                mention = "it" if it else the(self._nouns.get(name, name))
                text = text.replace(f"{{{place}}}", mention)
                rival = rival or (place > 1 and name in self._movable)
        if step.objects:
            self._topic, self._rival = step.objects[0], rival
        return text

    def _tail(self, step: Step) -> str:
        """How often, whether with a pause, what for, and when."""
        tail = f" {times(step.count)}" if step.count > 1 else ""
        tail += f" to {step.purpose}" if step.purpose else ""
        if self._timed:
            instant = step.start_s == step.end_s
            span = "" if instant else f"–{step.end_s:.2f}"
            tail += f" ({step.start_s:.2f}{span} s)"
        return tail + (", with a pause" if step.paused else "")

    def _hands(self, ees: Sequence[str]) -> str:
        if len(ees) > 1:
            kind = self._links[ees[0]].kind
            return f"both {'feet' if kind == 'foot' else f'{kind}s'}"
        return f"the {spoken(self._links[ees[0]])}"

    def idle(self, moved: dict[str, tuple[float, float]]) -> str:
        """What moved where no object was touched, and that none was where there was one."""
        untouched = " without touching anything" if self._movable else ""
        kinds: dict[str, list[str]] = {}
        for ee in moved:
            kinds.setdefault(self._links[ee].kind, []).append(ee)
        parts = []
        for ees in kinds.values():
            start_s, end_s = (
                pick(moved[ee][at] for ee in ees) for at, pick in ((0, min), (1, max))
            )
            span = f" ({start_s:.2f}–{end_s:.2f} s)" if self._timed else ""
            pair = [self._hands(ees)] if len(ees) == 2 else [self._hands((ee,)) for ee in ees]
            parts.append(f"moved {joined(pair)}{span}")
        return f"{joined(parts)}{untouched}" if parts else "touched nothing"
