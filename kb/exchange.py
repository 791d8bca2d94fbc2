"""The Actionary in and out: RDF files, backups, and episodes in terms of SOMA."""

import json
from collections.abc import Iterable, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from pyoxigraph import (
    BlankNode,
    CanonicalizationAlgorithm,
    Dataset,
    DefaultGraph,
    NamedNode,
    Quad,
    RdfFormat,
    Triple,
    parse,
    serialize,
)

from capar.model.errors import FileError, UnknownNameError
from kb.corrections import claim_statements
from kb.errors import ShapeError, StoreError
from kb.lookup.agents import aliases, joined
from kb.lookup.pars import observations, unknown_observation
from kb.store import names, sparql, updates
from kb.store.answer_values import turtle
from kb.store.statements import insertion
from kb.store.stores import Store
from kb.store.validation import by_thing, faults
from ontology import DATA, PREFIXES
from ontology import files as ontology_files


def with_context(expanded: bytes) -> bytes:
    """Expanded JSON-LD with our prefixes as its context; it states the same."""

    def short(iri: str) -> str:
        for prefix, base in PREFIXES.items():
            name = iri.removeprefix(base)
            if iri.startswith(base) and not name.startswith("//"):
                return f"{prefix}:{name}"
        return iri

    def compact(value: Any, under: str = "") -> Any:
        """A value with the IRIs short that name its keys, classes, datatypes and things."""
        if isinstance(value, dict):
            return {short(key): compact(each, key) for key, each in value.items()}
        if isinstance(value, list):
            return [compact(each, under) for each in value]
        return short(value) if under in {"@id", "@type"} else value

    document = {"@context": dict(PREFIXES), "@graph": compact(json.loads(expanded))}
    return (json.dumps(document, indent=1, ensure_ascii=False) + "\n").encode()


FORMATS = {
    "turtle": RdfFormat.TURTLE,
    "trig": RdfFormat.TRIG,
    "nquads": RdfFormat.N_QUADS,
    "jsonld": RdfFormat.JSON_LD,
    "rdfxml": RdfFormat.RDF_XML,
}
"""Formats by name.

Turtle and RDF/XML have no graphs, and get them back by what their statements are about.
"""

SUFFIXES = {
    ".ttl": "turtle",
    ".turtle": "turtle",
    ".trig": "trig",
    ".nq": "nquads",
    ".nquads": "nquads",
    ".jsonld": "jsonld",
    ".json": "jsonld",
    ".rdf": "rdfxml",
    ".owl": "rdfxml",
}
"""Formats by a file's ending."""


def format_of(path: Path | str, given: str | None = None) -> str:
    """The format of a file: what is given, else what its name says.

    Raises:
        UnknownNameError: No such format, or a name that states none.
        FileError: The name has no ending that states one.
    """
    name = given or SUFFIXES.get(Path(path).suffix.lower(), Path(path).suffix)
    if not name:
        *some, last = sorted(FORMATS)
        raise FileError(
            path, "its name tells no format;", f"add --format: {', '.join(some)} or {last}."
        )
    _form(name)
    return name


def _form(name: str) -> RdfFormat:
    if name not in FORMATS:
        raise UnknownNameError("format", name, FORMATS)
    return FORMATS[name]


def export(
    store: Store, format_name: str, *, observation: str | None = None, runs: bool = False
) -> bytes:
    """Everything, or an observation with what it mentions, as bytes that are always the same.

    Args:
        store: What is exported.
        format_name: One of ``FORMATS``.
        observation: The capture of the one that is meant; all if None.
        runs: Whether everything includes when and where observations were made, which is of this
            computer alone.

    Raises:
        UnknownNameError: There is no such format or observation.
    """
    form = _form(format_name)
    if observation is None:
        left_out = None if runs else names.GRAPHS["runs"]
        quads = sorted({e for e in store.quads() if e.graph_name != left_out}, key=str)
    else:
        quads = sorted({*part(store, observation), updates.VERSION}, key=str)
    triples = dict.fromkeys(quad.triple for quad in quads)
    if form in {RdfFormat.TURTLE, RdfFormat.TRIG}:
        return turtle(quads if form == RdfFormat.TRIG else triples, form=form).encode()
    if form == RdfFormat.RDF_XML:
        return serialize(triples, format=form, prefixes=dict(PREFIXES)) or b""
    data = serialize(quads, format=form) or b""
    return with_context(data) if form == RdfFormat.JSON_LD else data


def misplaced(store: Store) -> int:
    """How many statements Turtle would put into another graph than theirs."""
    return sum(
        1
        for each in store.quads()
        if isinstance(each.subject, NamedNode) and home(each.triple) != each.graph_name
    )


def part(store: Store, observation: str) -> list[Quad]:
    """An observation's statements, those of everything that it mentions, and claims about it.

    Raises:
        UnknownNameError: There is no such observation.
    """
    graph = names.observation(observation)
    own = store.graph(graph)
    if not own:
        raise unknown_observation(store, observation)
    shared: list[Quad] = []
    for name in ("agents", "objects", "actions"):
        where = names.GRAPHS[name]
        found = store.ask(
            f"CONSTRUCT {{ ?s ?p ?o }} WHERE {{ {graph} <{PREFIXES['capar']}mentions> ?s . "
            f"GRAPH {where} {{ ?s ?p ?o }} }}"
        )
        shared += [Quad(t.subject, t.predicate, t.object, where) for t in found.triples or ()]
    return [*own, *shared, *claim_statements(store, observation)]


def read(data: bytes, format_name: str, *, path: Path | str = "-") -> list[Quad]:
    """Statements of a file, each in the graph where it belongs, its unnamed things named.

    Raises:
        FileError: It is not what its format says, or says nothing.
    """
    try:
        parsed = list(parse(data, format=FORMATS[format_name]))
    except (SyntaxError, ValueError) as error:
        raise FileError(path, f"is no {format_name}: {error}") from None
    if not parsed:
        raise FileError(path, f"holds no statements of {format_name}.", "Export it again.")
    if any(isinstance(t, BlankNode) for each in parsed for t in (each.subject, each.object)):
        dataset = Dataset(parsed)
        dataset.canonicalize(CanonicalizationAlgorithm.RDFC_1_0)
        parsed = [
            Quad(_named(q.subject), q.predicate, _named(q.object), q.graph_name) for q in dataset
        ]
    return [
        Quad(each.subject, each.predicate, each.object, home(each.triple))
        if isinstance(each.graph_name, DefaultGraph) and isinstance(each.subject, NamedNode)
        else each
        for each in parsed
    ]


def _named(term: Any) -> Any:
    """A term, an unnamed thing by an IRI that follows from what is said of it."""
    return NamedNode(f"{DATA}genid/{term.value}") if isinstance(term, BlankNode) else term


def home(triple: Triple) -> NamedNode:
    """The graph of a statement, by what it is about; the ontology says nothing but its own."""
    assert isinstance(triple.subject, NamedNode)
    if triple in _ontology():
        return names.GRAPHS["ontology"]
    if triple.subject.value.startswith(ontology_files.KIND):
        return names.GRAPHS["objects"]
    return names.graph_of(triple.subject)


@cache
def _ontology() -> frozenset[Triple]:
    return frozenset(ontology_files.ontology())


def bring_in(store: Store, quads: Iterable[Quad], *, source: str = "the file") -> tuple[int, int]:
    """Add statements, all or none; an observation among them replaces the one of its name.

    The ontology is the program's own and is not taken from outside.

    Returns:
        How many statements and how many observations came in.

    Raises:
        SchemaError: A program of another schema exported them.
        ShapeError: They break the model.
    """
    stated = list(quads)
    updates.check_version(source, stated)
    taken = [each for each in stated if each.graph_name != names.GRAPHS["ontology"]]

    def classes(thing: NamedNode) -> list[object]:
        return [row[0] for row in store.ask(f"SELECT ?kind {{ {thing} a ?kind }}").rows]

    if problems := faults(by_thing(taken), elsewhere=classes):
        raise ShapeError(source, problems)
    seen = sorted(
        {
            each.graph_name.value
            for each in taken
            if isinstance(each.graph_name, NamedNode)
            and each.graph_name.value.startswith(names.OBSERVATION)
        }
    )
    taken = joined(taken, aliases(store))
    if taken:
        removals = [updates.removal(NamedNode(each)) for each in seen]
        store.change(" ;\n".join([*removals, insertion(taken)]))
    return len(taken), len(seen)


def back_up(store: Store, file: Path) -> int:
    """Write every statement, when and where observations were made included, as N-Quads.

    Every statement is read first, and the file is read again when it is written.

    Returns:
        How many statements it holds.

    Raises:
        FileError: The file is there already.
        DamagedError: A statement cannot be read.
        StoreError: The file does not hold what the store does.
    """
    store.check_readable()
    data = export(store, "nquads", runs=True)
    try:
        with file.open("xb") as target:
            target.write(data)
    except FileExistsError:
        raise FileError(file, "exists already.", "Name another file.") from None
    kept = len(read(file.read_bytes(), "nquads", path=file)) if data else 0
    held = len(set(store.quads()))
    if kept != held:
        file.unlink()
        raise StoreError(f"{file}: {kept} statements were written of {held}; try again")
    return kept


def back_up_rules(folder: Path | None, file: Path) -> Sequence[Path]:
    """Copy the rule files that stand in an Actionary's folder into a folder beside its backup."""
    rules = sorted(folder.glob("*.lp")) if folder and folder.is_dir() else []
    beside = file.with_name(f"{file.stem}.rules")
    copies = []
    for rule_file in rules:
        beside.mkdir(exist_ok=True)
        copies.append(beside / rule_file.name)
        copies[-1].write_bytes(rule_file.read_bytes())
    return copies


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
    if observation not in [each.name for each in observations(store)]:
        raise unknown_observation(store, observation)
    template = (files("kb") / "soma_episode.rq").read_text(encoding="utf-8")
    query = sparql.fill(template, graph=str(names.observation(observation)))
    return tuple(sorted(store.ask(sparql.complete(query)).triples or (), key=str))


def export_episode(store: Store, format_name: str, observation: str) -> bytes:
    """The same as bytes that are always the same.

    Raises:
        UnknownNameError: There is no such format or observation.
        StoreError: It shows nothing that was done.
    """
    form = _form(format_name)
    stated = episode(store, observation)
    if not stated:
        raise StoreError(f"{observation}: nothing was done in it")
    plain = form in {RdfFormat.JSON_LD, RdfFormat.N_QUADS}
    data = serialize(stated, format=form, prefixes=None if plain else VOCABULARIES) or b""
    return with_context(data) if form == RdfFormat.JSON_LD else data
