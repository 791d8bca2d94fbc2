"""When and where an observation was made, apart from what it says."""

import os
import platform
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from pyoxigraph import Literal, NamedNode, Quad

from kb.store import names
from kb.store.statements import LABEL, Statements
from ontology import CAPAR
from ontology.vocabularies import PROV, XSD

if TYPE_CHECKING:
    from capar.model.observation import Observation

ENDED = NamedNode(PROV + "endedAtTime")


def run_node(capture: str) -> NamedNode:
    """What the run is called that made the observation of a capture."""
    return names.shared("run", capture)


def run(observation: "Observation") -> list[Quad]:
    """The run that ends now on this computer: its time, the version and the files as they are."""
    graph = names.GRAPHS["runs"]
    out = Statements(graph)
    now = datetime.now(UTC).isoformat(timespec="seconds")
    out.add(
        run_node(observation.capture),
        (CAPAR.Run,),
        {
            LABEL: f"run of {observation.capture}",
            CAPAR.ofObservation: names.observation(observation.capture),
            ENDED: Literal(now, datatype=NamedNode(XSD + "dateTime")),
            CAPAR.version: observation.version,
            CAPAR.host: platform.node(),
            CAPAR.readFrom: [
                Literal(os.path.expandvars(each.path)) for each in observation.sources
            ],
        },
    )
    return out.quads


def run_removal(graph: NamedNode) -> str:
    """The update that forgets the run of an observation."""
    node = run_node(names.observation_name(graph))
    return f"DELETE WHERE {{ GRAPH {names.GRAPHS['runs']} {{ {node} ?property ?value }} }}"
