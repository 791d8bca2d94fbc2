"""HermiT finds the ontology and an observation consistent, and finds what contradicts them.

It runs where Java is and CAPAR_HERMIT names HermiT's jar (owlready2 brings one). HermiT knows the
datatypes of OWL 2 alone, so that ours are read as plain strings here.
"""

import os
import shutil
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from observations import with_unknown
from pyoxigraph import Literal, NamedNode, RdfFormat, Triple, serialize

from kb.encode.observation import encode
from kb.store.statements import TYPE
from ontology import BASE, CAPAR
from ontology.files import ontology
from ontology.namespace import XSD

JAR = os.environ.get("CAPAR_HERMIT", "")
DATATYPE = NamedNode("http://www.w3.org/2000/01/rdf-schema#Datatype")
STRING = NamedNode(XSD + "string")
LIFT = NamedNode("https://w3id.org/capar/data/action/Lift")
SEGMENT = NamedNode("https://w3id.org/capar/data/observation/Strange#segment.right_hand.0")

pytestmark = pytest.mark.skipif(
    not (shutil.which("java") and Path(JAR).is_file()), reason="needs Java and CAPAR_HERMIT"
)


def in_datatypes_of_owl(stated: Iterable[Triple]) -> list[Triple]:
    """The same with our datatypes as strings."""
    told = list(dict.fromkeys(stated))
    ours = {each.subject for each in told if each.object == DATATYPE}

    def known(value: Any) -> Any:
        if isinstance(value, Literal) and value.datatype.value.startswith(BASE):
            return Literal(value.value)
        return STRING if value in ours else value

    left = (each for each in told if each.subject not in ours)
    return [Triple(each.subject, each.predicate, known(each.object)) for each in left]


def hermit(folder: Path, *added: Triple) -> str:
    """What HermiT says of the ontology and an observation."""
    own = (each.triple for each in encode(with_unknown()).quads)
    file = folder / "stated.rdf"
    stated = in_datatypes_of_owl([*ontology(), *own, *added])
    file.write_bytes(serialize(stated, format=RdfFormat.RDF_XML) or b"")
    command = ["java", "-cp", JAR, "org.semanticweb.HermiT.cli.CommandLine", "-k", file.as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    return done.stdout + done.stderr


def test_ontology_and_observation_are_consistent(tmp_path: Path) -> None:
    assert "is satisfiable" in hermit(tmp_path)


def test_a_segment_of_a_link_that_is_an_action_is_inconsistent(tmp_path: Path) -> None:
    wrong = (Triple(LIFT, TYPE, CAPAR.Action), Triple(SEGMENT, CAPAR.ofLink, LIFT))
    assert "Inconsistent ontology" in hermit(tmp_path, *wrong)
