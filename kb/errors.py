"""Errors of stores and queries, each with its remedy."""

from capar.model.errors import CaparError


class StoreError(CaparError):
    """A store that cannot be opened, read or written."""


class SchemaError(StoreError):
    """A store, or an export of one, that is kept in another form than this program's.

    Attributes:
        found: The version of its form.
    """

    def __init__(self, place: str, found: int, remedy: str) -> None:
        self.found = found
        super().__init__(f"{place}: this is an Actionary of schema {found}; {remedy}")


class DamagedError(StoreError):
    """A store whose files are not as they were written."""

    def __init__(self, place: str, reason: str) -> None:
        super().__init__(
            f"{place}: its database is damaged ({reason}); move the folder away, then restore it "
            "from a backup or export (capar import FILE) or observe the captures again"
        )


class LockedError(StoreError):
    """A store that another process writes.

    Attributes:
        holder: Which process, where and since when.
    """

    def __init__(self, place: str, holder: str) -> None:
        self.holder = holder
        super().__init__(
            f"{place}: {holder} writes it; try again when it is done, let this command wait "
            "(--wait SECONDS), or serve the store to many writers (oxigraph serve)"
        )


class QueryError(CaparError):
    """A query that is no SPARQL, or that does what a query may not."""


class TimeLimitError(QueryError):
    """A query that took longer than its time limit.

    Attributes:
        seconds: The limit.
    """

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        super().__init__(
            f"the query was stopped after {seconds:g} s; narrow it (bind a subject, add LIMIT) "
            "or allow more time (--time-limit SECONDS)"
        )


class BusyError(CaparError):
    """A question that a server does not answer now, as it has too many others."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"the server is busy ({reason}); ask again in a few seconds")


class LostError(CaparError):
    """A question whose process ended."""

    def __init__(self, memory: int) -> None:
        super().__init__(
            f"the process that was to answer ended; it may hold {memory >> 20} MB. Ask again, or "
            "narrow the query (bind a subject, add LIMIT)"
        )


class ExistsError(CaparError):
    """An observation whose name is already another capture's."""


class ShapeError(CaparError):
    """Statements that break the model.

    Attributes:
        findings: What is wrong, a line each.
    """

    def __init__(self, name: str, findings: tuple[str, ...]) -> None:
        self.findings = findings
        super().__init__(f"{name} breaks the model:\n  " + "\n  ".join(findings))


class CorrectionError(CaparError):
    """A claim about a segment that cannot be: of nobody, of no change, or outside its time."""
