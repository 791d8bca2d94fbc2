"""The feature table: known sets of features and their names (thesis 4.5)."""

from collections.abc import Iterable

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import ParError
from capar.model.par import FeatureSet
from kb.encode import segments
from kb.findings import FeatureRow
from kb.lookup.par_decoding import features as decode_features
from kb.lookup.statement_index import StatementIndex
from kb.store import names
from kb.store.answers import plain
from kb.store.statements import LABEL, PropertyValues, Statements
from kb.store.stores import Store
from ontology import CAPAR

_SEEN = f"""SELECT ?features ?name ?general (COUNT(DISTINCT ?segment) AS ?times)
WHERE {{
  ?segment a {CAPAR.Segment} ;
    {CAPAR.features} ?features ;
    {CAPAR.action}/{CAPAR.name} ?name .
  OPTIONAL {{ ?segment {CAPAR.general} ?general }}
}}
GROUP BY ?features ?name ?general"""


def rows(store: Store) -> tuple[FeatureRow, ...]:
    """Every named set of features, declared or seen, sorted."""
    reading = StatementIndex(store.graph(names.GRAPHS["actions"]))
    declared = {
        (reading.text(node, CAPAR.name), decode_features(reading, bits)): reading.words(
            node, CAPAR.general
        )
        for node in reading.things(CAPAR.FeatureRow)
        if (bits := reading.one(node, CAPAR.features))
    }
    seen: dict[tuple[str, FeatureSet], int] = {}
    general: dict[tuple[str, FeatureSet], tuple[str, ...]] = dict(declared)
    for seen_bits, name, more, times in store.ask(_SEEN).rows:
        if isinstance(seen_bits, NamedNode) and isinstance(name, Literal):
            key = (name.value, decode_features(reading, seen_bits))
            seen[key] = seen.get(key, 0) + int(plain(times) or 0)
            general.setdefault(key, tuple(str(plain(more) or "").split()))
    return tuple(
        sorted(FeatureRow(*key, general[key], key in declared, seen.get(key, 0)) for key in general)
    )


def add(store: Store, name: str, value: FeatureSet, general: tuple[str, ...]) -> FeatureRow:
    """Name a set of features."""
    for row in rows(store):
        if row.features == value and row.declared and row.name != name:
            raise ParError(
                f"these features are named {row.name!r} already; "
                "one set of features has one name that a user gave it"
            )
    graph = names.GRAPHS["actions"]
    out = Statements(graph)
    bits = segments.features(out, value)
    action = segments.action(out, name)
    above = segments.actions(out, general)
    properties: PropertyValues = {
        LABEL: name,
        CAPAR.name: name,
        CAPAR.features: bits,
        CAPAR.action: action,
        CAPAR.general: " ".join(general),
        CAPAR.specialises: above,
    }
    node = names.shared("row", names.hashed((name, value)))
    out.share(node, (CAPAR.FeatureRow,), properties)
    keep = [each for each in (node, bits, action, *above) if each is not None]
    marks = [Quad(each, CAPAR.declared, Literal(True), graph) for each in keep]
    store.insert([each for each in out.quads if each.predicate != CAPAR.mentions] + marks)
    return next(row for row in rows(store) if (row.name, row.features) == (name, value))


def program(table: Iterable[FeatureRow]) -> str:
    """The table as facts of the rules, one a line: primitives, their rows, what they specialise."""
    lines: set[str] = set()
    for row in table:
        bits = row.features
        words = (bits.rel_start, bits.rel_end, bits.change_loc, bits.force)
        name = _quoted(row.name)
        lines.add(f"primitive({name}).")
        lines.add(f"feature_row({name}, {bits.end_effector}, {', '.join(map(_quoted, words))}).")
        if row.general:
            lines.add(f"specialises({name}, {_quoted(row.general[0])}).")
    return "".join(f"{line}\n" for line in sorted(lines))


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
