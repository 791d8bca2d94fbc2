"""What a check says of a rule file: each finding with its place and what would have been right."""

from dataclasses import asdict, dataclass
from typing import Any

from capar_rules.engine.syntax import Place

ERROR, NOTE = "error", "note"


@dataclass(frozen=True, slots=True, order=True)
class Finding:
    """One remark on a rule file."""

    place: Place
    code: str
    """A stable name in kebab case: ``unknown-predicate`` ..."""

    message: str
    remedy: str
    level: str = ERROR
    """``error``: the file does not count; ``note``: it may."""

    def __str__(self) -> str:
        """The finding as one line, the way compilers write."""
        return f"{self.place}: {self.level}: {self.message} {self.remedy}".rstrip()

    def as_json(self) -> dict[str, Any]:
        """The finding as plain values."""
        return asdict(self)

    @classmethod
    def from_json(cls, content: dict[str, Any]) -> "Finding":
        """The finding of plain values."""
        return cls(**{**content, "place": Place(**content["place"])})


def errors(findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Those for which a file does not count."""
    return tuple(each for each in findings if each.level == ERROR)
