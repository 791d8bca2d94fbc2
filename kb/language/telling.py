"""One sentence out of clauses: pronouns for what was just named, hands, times, "while"."""

from collections.abc import Sequence

from capar.model.observation import ObservedLink
from kb.language.clauses import Clause
from kb.language.english import joined, noun, the
from kb.language.phrasing import in_past


class Telling:
    """Says clauses, each sentence anew; remembers within it what is spoken of."""

    def __init__(self, links: Sequence[ObservedLink], *, timed: bool) -> None:
        self._kinds = {link.ee: link.kind for link in links}
        self._timed = timed
        self._topic = ""
        self._ees: tuple[str, ...] = ()

    def sentence(self, steps: Sequence[Clause], often: str, until_s: float) -> str:
        """The clauses as the rest of a sentence whose subject is the agent."""
        self._topic, self._ees = "", ()
        parts: list[str] = []
        last: Clause | None = None
        for step in steps:
            if last is not None and self._at_once(last, step):
                parts[-1] = f"{parts[-1]} while {self._of_hand(step)}"
            else:
                parts.append(self._of_agent(step))
            last = step
        if often and self._timed:
            parts[-1] = f"{parts[-1]} (the last until {until_s:.2f} s)"
        return joined(parts) + (f", {often} in all" if often else "")

    def _at_once(self, last: Clause, step: Clause) -> bool:
        """Whether two clauses of different hands go on at the same time."""
        shorter = min(last.end_s - last.start_s, step.end_s - step.start_s)
        return set(last.ees).isdisjoint(step.ees) and last.overlap_s(step) > shorter / 2

    def _of_agent(self, step: Clause) -> str:
        text = self._verb_phrase(step)
        if step.ees != self._ees and "{ee}" not in step.pattern:
            text = f"{text} with {self._hands(step.ees)}"
        self._ees = step.ees
        return f"{text}{self._end(step)}"

    def _of_hand(self, step: Clause) -> str:
        """The clause with its hand as the subject."""
        text = f"{self._hands(step.ees)} {self._verb_phrase(step)}"
        self._ees = step.ees
        return f"{text}{self._end(step)}"

    def _end(self, step: Clause) -> str:
        purpose = f" to {_with_it(step.purpose)}" if step.purpose else ""
        return f"{purpose} ({step.start_s:.2f}–{step.end_s:.2f} s)" if self._timed else purpose

    def _verb_phrase(self, step: Clause) -> str:
        pattern = in_past(step.pattern)
        if step.pattern == "let go of {1}" and step.objects[0] == self._topic:
            pattern = in_past("let go")
        filled = pattern.replace("{ee}", self._moved_away(step))
        for number, name in enumerate(step.objects, 1):
            filled = filled.replace(f"{{{number}}}", self._mention(name, number))
        if step.objects:
            self._topic = step.objects[0]
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
        return f"the {noun(ees[0])}"


def _with_it(purpose: str) -> str:
    """The purpose as said of what is spoken of: ``pick it up``, ``drink``."""
    head, _, particle = purpose.partition(" ")
    return f"{head} it {particle}" if particle else purpose
