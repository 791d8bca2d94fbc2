"""Changes to a store as SPARQL updates: each is one, so that nothing half-written is seen."""

from pyoxigraph import Literal, NamedNode, Quad

from kb.store import schema
from kb.store.names import GRAPHS
from kb.store.sparql import fill
from kb.store.statements import insertion
from ontology import CAPAR
from ontology import files as ontology_files

_ORPHANS = f"""DELETE {{ GRAPH ?shared {{ ?thing ?predicate ?value }} }}
WHERE {{
  GRAPH @graph@ {{ @graph@ {CAPAR.mentions} ?thing }}
  FILTER NOT EXISTS {{
    GRAPH ?elsewhere {{ ?other {CAPAR.mentions} ?thing }}
    FILTER(?elsewhere != @graph@)
  }}
  VALUES ?shared {{ @shared@ }}
  FILTER NOT EXISTS {{ GRAPH ?shared {{ ?thing {CAPAR.declared} true }} }}
  GRAPH ?shared {{ ?thing ?predicate ?value }}
}}"""


def removal(graph: NamedNode) -> str:
    """The update that takes an observation back, and what nothing else mentions."""
    shared = " ".join(str(GRAPHS[each]) for each in ("agents", "objects", "actions"))
    orphans = fill(_ORPHANS, graph=str(graph), shared=shared)
    return f"{orphans} ;\nDROP SILENT GRAPH {graph}"


def replacement(graph: NamedNode, quads: list[Quad]) -> str:
    """The update that puts an observation in the place of one of the same name."""
    return f"{removal(graph)} ;\n{insertion(quads)}"


def graph_replacement(graph: NamedNode, quads: list[Quad]) -> str:
    """The update that gives a graph these statements and no others."""
    return f"DROP SILENT GRAPH {graph} ;\n{insertion(quads)}"


def ontology_digest() -> Quad:
    """What distinguishes the ontology of a store from another one."""
    graph = GRAPHS["ontology"]
    return Quad(graph, CAPAR.sha256, Literal(ontology_files.digest()), graph)


def ontology_replacement() -> str:
    """The update that gives a store the present ontology and schema version."""
    graph = GRAPHS["ontology"]
    stated = [Quad(s, p, o, graph) for s, p, o in ontology_files.ontology()]
    return graph_replacement(graph, [*stated, ontology_digest(), schema.statement()])
