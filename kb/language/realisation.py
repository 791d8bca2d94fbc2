"""One sentence out of clauses: pronouns for what was just named, hands, times, "while"."""

import re
from collections.abc import Sequence
from dataclasses import replace

from capar.model.observation import ObservedLink
from kb.language.clauses import Clause
from kb.language.lexicalisation import in_past
from kb.language.vocabulary import SIDES
from kb.lexicon.english import joined, noun, the, times

_ALL_PLACES = re.compile(r"\{1\}(?:, \{\d\})*,? and \{\d\}")
"""Places of several objects that a verb has as one."""


class Realiser:
    """Says clauses; remembers the hand, and within a sentence what each hand has to do with."""

    def __init__(self, links: Sequence[ObservedLink], *, timed: bool) -> None:
        self._kinds = {link.ee: link.kind for link in links}
        self._names = {link.ee: _spoken(link) for link in links}
        self._timed = timed
        self._topic = ""
        self._several: tuple[str, ...] = ()
        self._ees: tuple[str, ...] = ()

    def sentence(self, steps: Sequence[Clause], often: str, until_s: float) -> str:
        """The clauses as the rest of a sentence whose subject is the agent."""
        streams: dict[tuple[str, ...], list[Clause]] = {}
        for step in steps:
            streams.setdefault(step.ees, []).append(step)
        if len(streams) > 1:
            self._ees = ()
        main, *others = streams.values()
        text = self._of_agent(main)
        if others:
            comma = "," if len(steps) > 2 else ""
            meanwhile = [self._of_hand(each, _shared_topic(main)) for each in others]
            text = f"{text}{comma} while {joined(meanwhile)}"
        if often and self._timed:
            text = f"{text} (the last until {until_s:.2f} s)"
        return f"{text}, {often} in all" if often else text

    def idle(self, ees: Sequence[str]) -> str:
        """That nothing was touched, and what was moved, as the rest of a sentence."""
        kinds: dict[str, list[str]] = {}
        for ee in ees:
            kinds.setdefault(self._kinds[ee], []).append(ee)
        moved = joined([self._hands(tuple(each)) for each in kinds.values()])
        return f"moved {moved} and touched nothing" if moved else "touched nothing"

    def _of_agent(self, steps: Sequence[Clause]) -> str:
        parts = []
        self._topic, self._several = "", ()
        for step in steps:
            text = self._verb_phrase(step)
            told = step.ees == self._ees or "{ee}" in step.pattern
            hand = "" if told else self._with_hands(step)
            if "{with}" in text:
                text = text.replace("{with}", f"{hand} " if hand else "")
            elif hand:
                text = f"{text} {hand}"
            self._ees = step.ees
            parts.append(f"{text}{self._end(step)}")
        return joined(parts)

    def _with_hands(self, step: Clause) -> str:
        """The hand as what is used, or where the tool is that was just named."""
        *_, word, last = step.pattern.split(" ") if " with {" in step.pattern else ("", "")
        tool = word == "with" and last.startswith("{")
        return f"{'in' if tool else 'with'} {self._hands(step.ees)}"

    def _of_hand(self, steps: Sequence[Clause], topic: str) -> str:
        """The clauses with their hand as the subject, after something was spoken of."""
        parts = []
        self._topic, self._several = topic, ()
        hand = self._hands(steps[0].ees)
        self._ees = ()
        for step in steps:
            own = replace(step, pattern="move away") if "{ee}" in step.pattern else step
            text = self._verb_phrase(own).replace("{with}", "")
            parts.append(f"{text}{self._end(step)}")
        return f"{hand} {joined(parts)}"

    def _end(self, step: Clause) -> str:
        often = f" {times(step.count)}" if step.count > 1 else ""
        often = f" {step.often}" if step.often else often
        purpose = f"{often} to {_with_it(step.purpose)}" if step.purpose else often
        return f"{purpose} ({step.start_s:.2f}–{step.end_s:.2f} s)" if self._timed else purpose

    def _verb_phrase(self, step: Clause) -> str:
        pattern = in_past(step.pattern)
        if step.pattern == "let go of {1}" and step.objects[0] == self._topic:
            pattern = in_past("let go")
        if pattern.endswith(" there") and step.objects[0] != self._topic:
            pattern = f"{pattern.removesuffix('there')}in place"
        if "{1}" in pattern and step.objects == self._several:
            pattern = _ALL_PLACES.sub("them", pattern)
        self._several = step.objects if _ALL_PLACES.search(pattern) else ()
        filled = pattern.replace("{ee}", self._moved_away(step))
        for number, name in enumerate(step.objects, 1):
            filled = filled.replace(f"{{{number}}}", self._mention(name, number))
        named = "{1}" in step.pattern or step.objects[:1] == (self._topic,)
        self._topic = step.objects[0] if named and not self._several else ""
        return filled

    def _mention(self, name: str, number: int) -> str:
        return "it" if number == 1 and name == self._topic else the(name)

    def _moved_away(self, step: Clause) -> str:
        if step.ees == self._ees and len(step.ees) == 1:
            return f"the {self._kinds[step.ees[0]]}"
        return self._hands(step.ees)

    def _hands(self, ees: tuple[str, ...]) -> str:
        if len(ees) > 1:
            kind = self._kinds[ees[0]]
            return f"both {'feet' if kind == 'foot' else kind + 's'}"
        return f"the {self._names[ees[0]]}"


def _shared_topic(steps: Sequence[Clause]) -> str:
    """What every clause is about first; empty if that differs."""
    things = {step.objects[:1] for step in steps}
    return "".join(things.pop()) if len(things) == 1 else ""


def _with_it(purpose: str) -> str:
    """The purpose as said of what is spoken of: ``pick it up``, ``drink``."""
    head, _, particle = purpose.partition(" ")
    return f"{head} it {particle}" if particle else purpose


def _spoken(link: ObservedLink) -> str:
    """A body part by its side, where it has one: ``left elbow``, whatever its sensor is called."""
    return f"{link.side} {link.kind}" if link.side in SIDES else noun(link.ee)
