"""Findings of `rules check`: each with its place, a message and a remedy."""

from dataclasses import asdict, dataclass
from typing import Any

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
