"""What a client asks and what it is answered, apart from sockets."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from capar.model.errors import CaparError


@dataclass(frozen=True, slots=True)
class Request:
    """One HTTP request."""

    method: str
    path: str
    """Without what follows a question mark, percent signs resolved."""

    query: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Values by name of what follows it."""

    headers: Mapping[str, str] = field(default_factory=dict)
    """By their names in small letters."""

    body: bytes = b""

    @property
    def media_type(self) -> str:
        """Of the body, without parameters."""
        return self.headers.get("content-type", "").partition(";")[0].strip().lower()


@dataclass(frozen=True, slots=True)
class Response:
    """One HTTP response."""

    status: int
    media_type: str
    body: bytes
    allow: str = ""
    """The methods that the path has, where it has not the one that was asked."""


class RefusedError(CaparError):
    """A request that is not answered, with the status that says why."""

    def __init__(self, status: int, message: str, *, allow: str = "") -> None:
        self.status = status
        self.allow = allow
        super().__init__(message)
