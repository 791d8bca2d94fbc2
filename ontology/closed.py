"""A namespace that is closed: a misspelt term is an error."""

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
        if name not in cls.__annotations__:
            raise UnknownNameError("term of the ontology", name, cls.__annotations__)
        term = NamedNode(BASE + name)
        setattr(cls, name, term)
        return term
