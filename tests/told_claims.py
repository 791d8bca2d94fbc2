"""The steps of a timed telling, read from its text alone: words, thing, hands, times."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

SPAN = re.compile(r" \((\d[^()]*?) s\)")
"""The times of a step: ``(1.20–3.50 s)``, ``(1.20–3.50 s and 4.00–5.00 s)``."""

HAND = re.compile(r"\bthe (left|right) hand\b|\b(both) hands\b")
SUBJECT = re.compile(r"^(?:.*\bwhile )?the (left|right) hand (?=\w+ed |took |put |\w+ )")
AGENT = re.compile(r"^.*?\b(?:agent|woman|man|child) |^[A-Z]\w+ (?=\w+ed |took |put )")
"""Who acts, with what opens the sentence: in the recordings some have names."""

UNTIMED = re.compile(r"^,? ?(turning (?:it|the [a-z ]+?)(?: (?!and )\w+)*)(?:, (?:and )?|\.$)")
"""A turn that has no times of its own, before the next step."""


@dataclass(frozen=True)
class Claim:
    """One told step: its words, of which thing, to where, by which hands, and when."""

    said: str
    thing: str
    goal: str
    hands: tuple[str, ...]
    spans: tuple[tuple[float, float], ...]
    timed: bool = True
    """Whether the times are its own, or those of the step beside which it went on."""

    @property
    def start_s(self) -> float:
        """When it began [s]."""
        return self.spans[0][0]

    @property
    def end_s(self) -> float:
        """When it ended [s]."""
        return self.spans[-1][1]


def claims(text: str, nouns: Mapping[str, str]) -> Iterator[Claim]:
    """The steps of a timed telling, in the order of the text.

    Args:
        text: The telling.
        nouns: Objects by how they are spoken of.
    """
    hands: tuple[str, ...] = ()
    thing = verb = ""
    spans: tuple[tuple[float, float], ...] = ()
    for sentence in re.split(r"(?<=\.) (?=[A-Z])", text):
        at = 0
        for found in SPAN.finditer(sentence):
            said, at = sentence[at : found.start()].strip(" ,"), found.end()
            if beside := UNTIMED.match(said):
                yield Claim(beside[1], thing, "", hands, spans, timed=False)
            said = UNTIMED.sub("", AGENT.sub("", said).removeprefix("and "))
            rest = SPAN.sub("", sentence[found.start() :])
            if said.startswith("which "):
                hands = ("left",) if hands == ("right",) else ("right",)
                said = said.removeprefix("which ")
            elif subject := SUBJECT.match(said):
                hands, said = (subject[1],), said[subject.end() :]
            elif " over to " not in said:
                hands = _hands(said) or _hands(rest.split(" while ")[0]) or hands
            if said.startswith(("the ", "a ", "an ")) or said in nouns:
                said = f"{verb} {said}"
            verb = said.split(" ")[0]
            mention = _mentioned(said.removeprefix("reached "), nouns)
            thing = mention or thing
            spans = _spans(found[1])
            goal, said = _goal(said, rest, nouns)
            yield Claim(said, thing, goal, hands, spans)
        if beside := UNTIMED.match(sentence[at:]):
            yield Claim(beside[1], thing, "", hands, spans, timed=False)


def _hands(words: str) -> tuple[str, ...]:
    found = HAND.search(words)
    if found is None or f"over to {found[0]}" in words:
        return ()
    return ("left", "right") if found[2] else (found[1],)


def _mentioned(words: str, nouns: Mapping[str, str]) -> str:
    """The object that is named first; empty where that is ``it``, or none is."""
    places = {
        (found.start(), -len(name)): thing
        for name, thing in nouns.items()
        if (found := re.search(rf"\b{re.escape(name)}\b", words))
    }
    pronoun = re.search(r"\bit\b", words)
    first = min(places, default=(len(words), 0))
    return "" if not places or (pronoun and pronoun.start() < first[0]) else places[first]


def _goal(said: str, rest: str, nouns: Mapping[str, str]) -> tuple[str, str]:
    """Where the thing is put, or in what it is used, also where a list of things comes first.

    Returns:
        That, and the words of the step with it.
    """
    spoken = "|".join(map(re.escape, sorted(nouns, key=len, reverse=True))) or "-"
    goal = re.compile(rf"\b(?:in|on|into) (?:the )?({spoken})\b")
    item = rf",? (?:and )?(?:(?:the|an?) )?(?:{spoken})"
    listed = re.compile(rf"^(?:{item})*,? ((?:in|on) the ({spoken}))\b")
    if found := goal.search(said):
        return nouns[found[1]], said
    if found := listed.match(rest):
        return nouns[found[2]], f"{said} {found[1]}"
    return "", said


def _spans(words: str) -> tuple[tuple[float, float], ...]:
    numbers = [float(number) for number in re.findall(r"\d+\.\d+", words)]
    ends = numbers if len(numbers) % 2 == 0 else numbers * 2
    return tuple(zip(ends[::2], ends[1::2], strict=True))
