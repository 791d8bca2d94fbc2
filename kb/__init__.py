"""The knowledge base: observations as RDF, questions about them, and sentences."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kb.actionary import Actionary as Actionary

__all__ = ["Actionary"]


def __getattr__(name: str) -> object:
    """The Actionary, imported when it is asked for."""
    if name == "Actionary":
        from kb.actionary import Actionary

        return Actionary
    raise AttributeError(f"module 'kb' has no attribute {name!r}")
