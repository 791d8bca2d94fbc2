"""Sentences for atoms, from the templates that rule files carry in comments ``%! name/2: text``."""

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from capar_rules.engine.syntax import Literal, Statement
from capar_rules.explain.clock import Clock
from capar_rules.explain.formatting import Argument

_MOODS = "had not|had|not|mended|brief not|brief|lacks|again|despite"
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
instead), "again" (the same where that was told already), "despite" (what holds and must not).
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
        unlike = ("brief", "brief not", "again", "despite", *(() if as_lacking else ("lacks",)))
        return bool(self._moods.get((name, arity), set()).difference(unlike))

    def tell(
        self, predicate: str, arguments: Sequence[str], clock: Clock, *, mood: str = ""
    ) -> str:
        """The sentence for an atom; empty if it has no template."""
        template = self.template(predicate, arguments, mood=mood)
        if template is None:
            return ""
        values = [Argument(each, arguments, clock) for each in arguments]
        return template.text.format(*values)
