"""Knowing a complex action again, whoever performed it (spec 5.7)."""

from collections import Counter

from pyoxigraph import Literal, NamedNode

from capar.model.par import ComplexPar
from kb.encode.complex_pars import complex_node, is_known
from kb.store.stores import Store
from ontology import CAPAR


def recognise(store: Store, value: ComplexPar, *, besides: NamedNode | None = None) -> str | None:
    """The name that most observations give the action; of equals, the first by alphabet.

    Args:
        store: Where to look.
        value: The complex action.
        besides: An observation that does not count.
    """
    if not is_known(value):
        return None
    node = complex_node(value)
    found = store.ask(
        f"SELECT ?seen ?name WHERE {{ ?seen {CAPAR.enacts} {node} ; {CAPAR.name} ?name }}"
    )
    given = Counter(
        name.value for seen, name in found.rows if isinstance(name, Literal) and seen != besides
    )
    return min(given, key=lambda name: (-given[name], name)) if given else None
