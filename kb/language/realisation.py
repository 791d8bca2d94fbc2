"""One sentence out of clauses: pronouns for what was just named, hands, times, "while"."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from capar.model.observation import ObservedLink, ObservedObject
from kb.language.clause import Clause
from kb.language.free_motion import Reached
from kb.language.lexicalisation import (
    BIT_BY_BIT,
    BODILY,
    PACKS,
    STIR,
    SUSTAINED,
    in_past,
    in_progress,
)
from kb.language.planning import Part
from kb.language.vocabulary import SIDES
from kb.lexicon.english import a, joined, noun, number, ordinal, the, times

_ALL_PLACES = re.compile(r"\{1\}(?:, \{\d\})*,? and \{\d\}")
"""Places of several objects that a verb has as one."""

_NUMBER = re.compile(r"_\d+$")
"""What parts the names of things that are alike."""

FIXED = frozenset({"fixed", "self"})
"""Tags of what stays where it is, or is the agent's own: ``it`` after that is what was moved."""


class Realiser:
    """Says clauses; remembers the hand, and within a sentence what each hand has to do with."""

    def __init__(
        self, links: Sequence[ObservedLink], objects: Sequence[ObservedObject], *, timed: bool
    ) -> None:
        self._nouns = nouns(objects)
        self._alike = alike(objects)
        self._told_of: dict[str, list[str]] = {}
        self._kinds = {link.ee: link.kind for link in links}
        self._names = {link.ee: _spoken(link) for link in links}
        self._timed = timed
        self._spans = timed
        self._fixed = {each.name for each in objects if each.tag in FIXED}
        self._touchable = any(each.tag == "mobile" for each in objects)
        self._topic = ""
        self._rivals = set[str]()
        self._several: tuple[str, ...] = ()
        self._ees: tuple[str, ...] = ()
        self._known = set[str]()

    def sentence(self, part: Part) -> str:
        """What a sentence tells, as the rest of one whose subject is the agent."""
        steps, often = part.steps, part.often
        self._spans = self._timed and not often
        streams: dict[tuple[str, ...], list[Clause]] = {}
        for step in part.beside:
            streams.setdefault(step.ees, []).append(step)
        if streams:
            self._ees = ()
        text = self._of_agent(part.told)
        for taken in part.passed:
            text = f"{text}, which {self._of_hand(taken, taken[0].objects[0])}"
        if streams:
            comma = "," if len(steps) > 2 else ""
            told, meanwhile = list(part.told), []
            for stream in streams.values():
                hand = self._hands(stream[0].ees)
                meanwhile.append(f"{hand} {self._of_hand(stream, _shared_topic(told))}")
                told += stream
            text = f"{text}{comma} while {joined(meanwhile)}"
        if not often:
            return text
        span = f" ({steps[0].start_s:.2f}–{part.end_s:.2f} s)" if self._timed else ""
        return f"{text}, {often}{'' if part.more else ' in all'}{span}"

    def idle(
        self, moved: Mapping[str, tuple[float, float]], reached: Sequence[Reached] = ()
    ) -> str:
        """What was moved, and that nothing was touched where there was something to touch.

        Args:
            moved: From when to when each end-effector moved [s].
            reached: Where hands reached, if that is known.
        """
        untouched = " without touching anything" if self._touchable else ""
        if reached:
            parts = [part for each in reached for part in self._there_and_back(each)]
            return f"{joined(parts)}{untouched}"
        kinds: dict[str, list[str]] = {}
        for ee in moved:
            kinds.setdefault(self._kinds[ee], []).append(ee)
        parts = []
        for ees in kinds.values():
            start_s = min(moved[ee][0] for ee in ees)
            end_s = max(moved[ee][1] for ee in ees)
            span = f" ({start_s:.2f}–{end_s:.2f} s)" if self._timed else ""
            parts.append(f"moved {self._hands(tuple(ees))}{span}")
        return f"{joined(parts)}{untouched}" if parts else "touched nothing"

    def _there_and_back(self, reached: Reached) -> list[str]:
        hand, kind = self._hands((reached.ee,)), self._kinds[reached.ee]
        there = f" ({reached.start_s:.2f}–{reached.there_s:.2f} s)" if self._timed else ""
        back = f" ({reached.leaves_s:.2f}–{reached.end_s:.2f} s)" if self._timed else ""
        verb = f"brought the {kind} back"
        parts = [f"reached {reached.where} with {hand}{there}"]
        if reached.leans:
            parts = [f"leaned and reached {reached.where} with {hand}{there}"]
            verb = "straightened up again"
        elif reached.down:
            verb = f"lowered the {kind} again"
        elif reached.where == "backward":
            verb = f"brought the {kind} forward again"
        return [*parts, f"{verb}{back}"] if reached.back else parts

    def _of_agent(self, steps: Sequence[Clause]) -> str:
        parts: list[str] = []
        self._begin("")
        last: Clause | None = None
        for step in steps:
            if last is not None and step.within(last):
                parts[-1] += self._meanwhile(step)
                continue
            last = step
            text = self._verb_phrase(step)
            bodily = step.pattern in BODILY
            told = step.ees == self._ees or "{ee}" in step.pattern or bodily
            hand = "" if told else self._with_hands(step)
            text += self._then(step) if told else ""
            if "{with}" in text:
                text = text.replace("{with}", f"{hand} " if hand else "")
            elif hand:
                text = f"{text} {hand}"
            self._ees = self._ees if bodily else step.ees
            parts.append(f"{text}{self._end(step)}{self._on_the_way(step)}")
        return joined(parts)

    def _with_hands(self, step: Clause) -> str:
        """The hand as what is used, or where the tool is that was just named.

        What goes along with a thing is named by ``with``, and then the hand is what is used.
        """
        *_, word, last = step.pattern.split(" ") if " with {" in step.pattern else ("", "")
        tool = word == "with" and last.startswith("{")
        how = "using" if "{1} with {" in step.pattern else "in" if tool else "with"
        return f"{how} {self._hands(step.ees)}{self._then(step)}"

    def _then(self, step: Clause) -> str:
        """The hands that do it afterwards, one after the other."""
        then = [f"with {self._hands(ees)}" for ees in step.in_turn]
        if then and step.in_turn[-1] in (step.ees, *step.in_turn[:-1]):
            then[-1] += " again"
        return f", then {joined(then)}" if then else ""

    def _of_hand(self, steps: Sequence[Clause], topic: str) -> str:
        """The clauses with their hand as the subject before them, after something was spoken of."""
        parts: list[str] = []
        self._begin(topic)
        last: Clause | None = None
        self._ees = ()
        for step in steps:
            if last is not None and step.within(last):
                parts[-1] += self._meanwhile(step)
                continue
            last = step
            own = replace(step, pattern="move away") if "{ee}" in step.pattern else step
            text = self._verb_phrase(own).replace("{with}", "")
            parts.append(f"{text}{self._end(step)}{self._on_the_way(step)}")
        return joined(parts)

    def _begin(self, topic: str) -> None:
        """Begin to tell what one hand did, after something was spoken of."""
        self._topic, self._several = topic, ()
        self._rivals = self._rivals if topic else set()

    def _meanwhile(self, step: Clause) -> str:
        """How the thing was turned during what was told last."""
        text = in_progress(step.pattern).replace("{1}", self._mention(step.objects[0], 1))
        return f", {text}{self._end(step) if step.sharp else ''}"

    def _on_the_way(self, step: Clause) -> str:
        """How the thing was turned until it was put there."""
        where = " on the way" if self._timed and step.pattern.startswith("carry") else ""
        ways = (replace(each, pattern=f"{each.pattern}{where}") for each in step.along)
        return "".join(map(self._meanwhile, ways))

    def _end(self, step: Clause) -> str:
        often = f" {times(step.count)}" if step.count > 1 else ""
        often = f" {step.often}" if step.often else often
        if step.pauses and step.name in SUSTAINED and not self._spans:
            pauses = "a pause" if step.pauses == 1 else f"{number(step.pauses)} pauses"
            often += f", with {pauses}"
        purpose = f"{often} to {_with_it(step.purpose)}" if step.purpose else often
        if not self._spans or step.apart:
            return purpose
        if step.start_s == step.end_s:
            return f"{purpose} ({step.start_s:.2f} s)"
        spans = step.spans if step.name in SUSTAINED else ((step.start_s, step.end_s),)
        return f"{purpose} ({joined([*map(_span, spans)])})"

    def _verb_phrase(self, step: Clause) -> str:
        pattern = in_past(step.pattern)
        if step.pattern == STIR and step.objects[0] == self._topic:
            pattern = pattern.removesuffix(" with {1}")
        if step.pattern == "let go of {1}" and step.objects[0] == self._topic:
            pattern = in_past("let go")
        if pattern.endswith(" from {1} into {2}") and step.objects[1] == self._topic:
            pattern = pattern.replace("{2}", "it")
        if pattern.endswith(" there") and step.objects[0] != self._topic:
            pattern = f"{pattern.removesuffix('there')}in place"
        if "{1}" in pattern and step.objects == self._several:
            pattern = _ALL_PLACES.sub("them", pattern)
        self._several = step.objects if _ALL_PLACES.search(pattern) else ()
        filled = pattern.replace("{ee}", self._moved_away(step))
        self._rivals -= set(_named(pattern, step.objects))
        spans = [*map(_span, step.apart)] if self._spans else []
        for place, name in enumerate(step.objects, 1):
            if f"{{{place}}}" not in filled:
                continue
            when = f" ({spans[place - 1]})" if place <= len(spans) else ""
            mention = self._mention(name, place)
            tool = place == 1 and pattern.endswith(" with {1}")
            if tool and name not in self._known and mention != "it":
                mention = a(self._nouns.get(name, name))
            filled = filled.replace(f"{{{place}}}", f"{mention}{when}")
        if "{" in pattern:
            self._rivals = set(_named(pattern, step.objects[1:], first=2)) - self._fixed
        if step.pauses and step.name not in SUSTAINED:
            filled += f" {BIT_BY_BIT}"
        self._known |= set(step.objects)
        named = "{1}" in step.pattern or step.objects[:1] == (self._topic,)
        if step.objects:
            self._topic = step.objects[0] if named and not self._several else ""
        return filled

    def _mention(self, name: str, place: int) -> str:
        if place == 1 and name == self._topic and not self._rivals:
            return "it"
        return self._one_of(name) if name in self._alike else the(self._nouns.get(name, name))

    def _one_of(self, name: str) -> str:
        """One of several things alike, by the order in which they are told of."""
        called = self._alike[name]
        told_of = self._told_of.setdefault(called, [])
        if name in told_of:
            return f"the {ordinal(told_of.index(name) + 1)} {called}"
        told_of.append(name)
        count = len(told_of)
        return a(called) if count == 1 else f"a {ordinal(count)} {called}"

    def _moved_away(self, step: Clause) -> str:
        if step.ees == self._ees and len(step.ees) == 1:
            return f"the {self._kinds[step.ees[0]]}"
        return self._hands(step.ees)

    def _hands(self, ees: tuple[str, ...]) -> str:
        if len(ees) > 1:
            kind = self._kinds[ees[0]]
            return f"both {'feet' if kind == 'foot' else kind + 's'}"
        return f"the {self._names[ees[0]]}"


def nouns(objects: Sequence[ObservedObject]) -> dict[str, str]:
    """Objects by what they are called, where that is their kind.

    So it is where a capture says of one object alone that it is a ``large_table``, whatever short
    name it has there.
    """
    kinds = Counter(each.kind for each in objects)
    return {each.name: each.kind for each in objects if "_" in each.kind and kinds[each.kind] == 1}


def alike(objects: Sequence[ObservedObject]) -> dict[str, str]:
    """Things of which there are several of one kind, by what each of them is called.

    Their names are numbered: ``tuna`` and ``tuna_2``, cans, are both a ``can of tuna``.
    """
    several = Counter((each.kind, _NUMBER.sub("", each.name)) for each in objects)
    out = {}
    for each in objects:
        stem = _NUMBER.sub("", each.name)
        if several[each.kind, stem] > 1:
            packed = each.kind in PACKS and each.kind not in stem
            out[each.name] = f"{each.kind} of {noun(stem)}" if packed else noun(stem)
    return out


def _named(pattern: str, objects: Sequence[str], *, first: int = 1) -> Iterator[str]:
    """The objects that a pattern names, but for what goes along with the first.

    Args:
        pattern: A pattern.
        objects: Some of its objects.
        first: The place of the first of them.
    """
    for place, name in enumerate(objects, first):
        if f"{{{place}}}" in pattern and f"{{1}} with {{{place}}}" not in pattern:
            yield name


def _shared_topic(steps: Sequence[Clause]) -> str:
    """What every clause is about first; empty if that differs."""
    things = {step.objects[:1] for step in steps}
    return "".join(things.pop()) if len(things) == 1 else ""


def _span(span: tuple[float, float]) -> str:
    """From when to when: ``1.20–3.50 s``."""
    return f"{span[0]:.2f}–{span[1]:.2f} s"


def _with_it(purpose: str) -> str:
    """The purpose as said of what is spoken of: ``pick it up``, ``drink``."""
    head, _, particle = purpose.partition(" ")
    return f"{head} it {particle}" if particle else purpose


def _spoken(link: ObservedLink) -> str:
    """A body part by its side, where it has one: ``left elbow``, whatever its sensor is called."""
    return f"{link.side} {link.kind}" if link.side in SIDES else noun(link.ee)
