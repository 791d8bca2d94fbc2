"""A namespace that is closed: a misspelt term is an error."""

from inspect import get_annotations
from typing import Any

from pyoxigraph import NamedNode

from capar.model.errors import UnknownNameError

BASE = "https://w3id.org/capar/ontology#"
"""The namespace of every term of ours."""

DATA = "https://w3id.org/capar/data/"
"""The namespace of what is stored: observations, agents, kinds, actions."""


class Closed(type):
    """A class whose annotated names are the terms of a namespace, and nothing else is."""

    def __getattr__(cls, name: str) -> Any:
        """The term of that name.

        Raises:
            UnknownNameError: The ontology has no such term.
        """
        if name.startswith("__"):
            raise AttributeError(name)
        known = names(cls)
        if name not in known:
            raise UnknownNameError("term of the ontology", name, known)
        term = NamedNode(BASE + name)
        setattr(cls, name, term)
        return term


def names(namespace: type) -> tuple[str, ...]:
    """The names of a closed namespace, sorted: its own and those that it takes from others."""
    return tuple(sorted(name for base in namespace.__mro__ for name in get_annotations(base)))
