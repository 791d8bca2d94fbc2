"""One observation as an episode in terms of SOMA and DUL, for programs that know only those."""

from importlib.resources import files

from pyoxigraph import RdfFormat, Triple, serialize

from capar.model.errors import UnknownNameError
from kb.errors import StoreError
from kb.exchange import FORMATS
from kb.json_ld import with_context
from kb.lookup.stored import observations
from kb.store import names, sparql
from kb.store.stores import Store
from ontology import PREFIXES

VOCABULARIES = {
    "dul": "http://www.ontologydesignpatterns.org/ont/dul/DUL.owl#",
    "soma": "http://www.ease-crc.org/ont/SOMA.owl#",
    "rdfs": PREFIXES["rdfs"],
}
"""All whose terms an episode uses."""


def episode(store: Store, observation: str) -> tuple[Triple, ...]:
    """The statements of an episode, sorted.

    Raises:
        UnknownNameError: There is no such observation.
    """
    known = [observation.name for observation in observations(store)]
    if observation not in known:
        raise UnknownNameError("observation", observation, known, where=store.place)
    template = (files("kb") / "soma_episode.rq").read_text(encoding="utf-8")
    query = sparql.fill(template, graph=str(names.observation(observation)))
    return tuple(sorted(store.ask(sparql.complete(query)).triples or (), key=str))


def export_episode(store: Store, format_name: str, observation: str) -> bytes:
    """The same as bytes that are always the same.

    Raises:
        UnknownNameError: There is no such format or observation.
        StoreError: It shows nothing that was done.
    """
    if format_name not in FORMATS:
        raise UnknownNameError("format", format_name, FORMATS)
    stated = episode(store, observation)
    if not stated:
        raise StoreError(f"{observation}: nothing was done in it")
    form = FORMATS[format_name]
    if form == RdfFormat.JSON_LD:
        return with_context(serialize(stated, format=form) or b"")
    if form == RdfFormat.N_QUADS:
        return serialize(stated, format=form) or b""
    return serialize(stated, format=form, prefixes=VOCABULARIES) or b""
