"""Sentences for atoms, from the templates that rule files carry in comments ``%! name/2: text``."""

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from string import Formatter

from capar_rules.engine.syntax import Literal, Statement
from capar_rules.explain.clock import Clock
from capar_rules.explain.formatting import Argument
from capar_rules.explain.told_motions import SHORTFALLS

_MOODS = "had not|had|not|mended|brief not|brief|lacks|despite"
_NO_SUBJECT = "".join(f"(?<!\\b{word} )" for word in ("of", "with", "to", "on", "by", "from"))
_SHORT = re.compile(rf"\{{(\d+):({'|'.join(SHORTFALLS)})\}}")
_TEMPLATE = re.compile(rf"%!(!?)\s*(?:({_MOODS}) )?(\w+)/(\d+)(?: (\w+))?:\s*(.+)")


@dataclass(frozen=True, slots=True)
class Template:
    """The sentence of one predicate."""

    text: str
    leading: bool
    """Whether it belongs in the summary of an explanation."""


Key = tuple[str, str, int, str]
"""Mood, predicate, arity and an argument.

Moods: "" (it holds), "not", "had" and "had not" (counterfactual), "mended" (taken to hold though
some frames are doubted), "brief" and "brief not" (in a summary), "lacks" (what holds
instead), "despite" (what holds and must not).
"""


class Sentences:
    """The templates of a rule base."""

    def __init__(self, statements: Iterable[Statement]) -> None:
        self.templates: dict[Key, Template] = {}
        for each in statements:
            for line in each.text.splitlines() if each.kind == "comment" else ():
                found = _TEMPLATE.match(line.strip())
                if found:
                    leading, mood, name, arity, kind, text = found.groups()
                    key = mood or "", name, int(arity), kind or ""
                    self.templates[key] = Template(text, bool(leading))
        self._moods: dict[tuple[str, int], set[str]] = defaultdict(set)
        """The moods in which there is a template, by predicate and arity."""
        for mood, name, arity, _ in self.templates:
            self._moods[name, arity].add(mood)

    def template(
        self, predicate: str, arguments: Sequence[str], *, mood: str = ""
    ) -> Template | None:
        """The template for an atom; one for a certain argument precedes the general one.

        Without a template of its own, the mood ``mended`` uses the plain template.
        """
        if mood == "mended" and (mood, predicate, len(arguments), "") not in self.templates:
            mood = ""
        key = mood, predicate, len(arguments)
        for each in arguments:
            if (*key, each) in self.templates:
                return self.templates[*key, each]
        return self.templates.get((*key, ""))

    def tellable(self, literal: Literal) -> bool:
        """Whether a summary can say that a condition of another name fails, and how."""
        if literal.kind != "atom":
            return False
        name, arity = literal.atoms[0].signature
        lacked = "lacks" in self._moods.get((name, arity), ())
        return bool(literal.sign) or lacked or name in ("feature", "fits")

    def describes(self, name: str, arity: int, *, as_lacking: bool) -> bool:
        """Whether a sentence says that such an atom holds, or, of one that fails, what does."""
        unlike = ("brief", "brief not", "despite", *(() if as_lacking else ("lacks",)))
        return bool(self._moods.get((name, arity), set()).difference(unlike))

    def tell(
        self, predicate: str, arguments: Sequence[str], clock: Clock, *, mood: str = ""
    ) -> str:
        """The sentence for an atom; empty if it has no template."""
        template = self.template(predicate, arguments, mood=mood)
        if template is None:
            return ""
        values = [Argument(each, arguments, clock) for each in arguments]
        told = template.text.format(*values)
        for each in clock.several:
            told = re.sub(rf"{_NO_SUBJECT}\bthe {each} (was|is|has|does)\b", _of_several, told)
            told = re.sub(rf"(\bthe {each} (?:moved|ended) .*where) it ", r"\1 they ", told)
            told = re.sub(rf"(\bthe {each} stayed where) it was\b", r"\1 they were", told)
        return told

    def formats(
        self, predicate: str, arguments: Sequence[str], *, mood: str = ""
    ) -> list[tuple[str, str]]:
        """The arguments that the sentence for an atom tells, each with its format."""
        template = self.template(predicate, arguments, mood=mood)
        parts = Formatter().parse(template.text) if template else ()
        return [(arguments[int(place)], form or "") for _, place, form, _ in parts if place]

    def nearness(self, predicate: str, arguments: Sequence[str], clock: Clock) -> float:
        """How near a condition that fails came to holding: a share of what it asks for.

        Zero where its template says no number of what it falls short of.
        """
        template = self.template(predicate, arguments, mood="lacks")
        found = _SHORT.search(template.text) if template else None
        if found is None:
            return 0.0
        return Argument(arguments[int(found[1])], arguments, clock).nearness(found[2])


def _of_several(found: re.Match[str]) -> str:
    """A verb in the plural, after the same name."""
    verb = {"was": "were", "is": "are", "has": "have", "does": "do"}[found[1]]
    return found[0].removesuffix(found[1]) + verb
