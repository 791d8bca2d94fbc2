"""The bodies of a capture by name: tag objects, links for their end-effectors, and sensors."""

from collections.abc import Mapping

from pyoxigraph import NamedNode

from kb.store import names
from kb.store.statements import LABEL, Statements
from ontology import CAPAR


class Bodies:
    """What a body's name stands for in the graph of an observation."""

    def __init__(
        self, out: Statements, objects: Mapping[str, NamedNode], links: Mapping[str, NamedNode]
    ) -> None:
        self._out = out
        self._objects = objects
        self._links = links

    def __getitem__(self, name: str) -> list[NamedNode]:
        """The tag object and the link of that name, which are one body; else a sensor."""
        group = (self._objects, self._links)
        return [each[name] for each in group if name in each] or [self._sensor(name)]

    def _sensor(self, name: str) -> NamedNode:
        node = names.part(self._out.about, "sensor", name)
        return self._out.add(node, (CAPAR.Sensor,), {LABEL: name, CAPAR.name: name})
