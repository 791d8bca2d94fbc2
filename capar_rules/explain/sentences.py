"""Sentences for atoms, from the templates that rule files carry in comments ``%! name/2: text``."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from capar_rules.engine.syntax import Literal, Statement
from capar_rules.explain.clock import Clock
from capar_rules.explain.formatting import Argument

_MOODS = "had not|had|not|mended|brief not|brief|lacks|despite"
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
        lacked = any(key[:3] == ("lacks", name, arity) for key in self.templates)
        return bool(literal.sign) or lacked or name in ("feature", "fits")

    def describes(self, name: str, arity: int, *, as_lacking: bool) -> bool:
        """Whether a sentence says that such an atom holds, or, of one that fails, what does."""
        unlike = ("brief", "brief not", "despite", *(() if as_lacking else ("lacks",)))
        return any(key[1:3] == (name, arity) and key[0] not in unlike for key in self.templates)

    def tell(
        self, predicate: str, arguments: Sequence[str], clock: Clock, *, mood: str = ""
    ) -> str:
        """The sentence for an atom; empty if it has no template."""
        template = self.template(predicate, arguments, mood=mood)
        if template is None:
            return ""
        values = [Argument(each, arguments, clock) for each in arguments]
        return template.text.format(*values)
