"""Findings of `rules check`, and the solver's messages as findings."""

import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from capar.model.errors import RuleError
from capar_rules.engine.solver import brave, understand
from capar_rules.engine.syntax import Place

ERROR, NOTE = "error", "note"


@dataclass(frozen=True, slots=True, order=True)
class Finding:
    """One error or note about a rule file."""

    place: Place
    code: str
    """A stable name in kebab case: ``unknown-predicate`` ..."""

    message: str
    remedy: str
    level: str = ERROR
    """``error``: the file is not loaded; ``note``: it may be."""

    def __str__(self) -> str:
        """The finding as one line, as compilers print theirs."""
        return f"{self.place}: {self.level}: {self.message} {self.remedy}".rstrip()

    def as_json(self) -> dict[str, Any]:
        """The finding as plain values."""
        return asdict(self)

    @classmethod
    def from_json(cls, content: dict[str, Any]) -> "Finding":
        """The finding of plain values."""
        return cls(**{**content, "place": Place(**content["place"])})


def errors(findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """The findings that keep a file from being loaded."""
    return tuple(each for each in findings if each.level == ERROR)


_MESSAGE = re.compile(r"[^:\n]*:(\d+):(\d+)(?:-[\d:]+)?: (?:error|info): (.*)")
_UNSAFE = re.compile(r": note: '(\w+)' is unsafe")


def unsafe_findings(text: str, file: str, *, ground: bool = False) -> Iterator[Finding]:
    """What the solver reports when it reads a file, or grounds it by itself."""
    try:
        if ground:
            brave(text, ())
        else:
            understand(text)
    except RuleError as error:
        yield from solver_findings(str(error), file)


def solver_findings(message: str, file: str) -> Iterator[Finding]:
    """The solver's messages as findings."""
    variables = _UNSAFE.findall(message)
    found = False
    for line in message.splitlines():
        match = _MESSAGE.match(line)
        if match is None:
            continue
        found = True
        place = Place(file, int(match[1]), int(match[2]))
        if "unsafe" in match[3]:
            names = ", ".join(dict.fromkeys(variables)) or "a variable"
            yield Finding(
                place, "unsafe-variable", f"nothing says which values {names} may take.",
                "Name it in a condition without not, such as segment(Segment, From, To).",
            )  # fmt: skip
        elif "syntax error" in match[3] or "lexer error" in match[3]:
            wrong = match[3].split("error, ")[-1]
            yield Finding(
                place, "syntax", f"this is no rule: {wrong}.",
                "A rule reads head :- condition, condition. and ends with a full stop.",
            )  # fmt: skip
        else:
            yield Finding(place, "refused", f"the solver refuses it: {match[3]}.", "Rewrite it.")
    if not found:
        yield Finding(
            Place(file, 1, 1), "refused", f"the solver refuses it: {message.strip()[:200]}.",
            "Rewrite it.",
        )  # fmt: skip
