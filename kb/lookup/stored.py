"""Keeping, listing and forgetting whole observations."""

from typing import TYPE_CHECKING

from pyoxigraph import Literal

from capar.model.errors import UnknownNameError
from kb.encode import encode
from kb.encode.run import run, run_removal
from kb.encode.scene import identity
from kb.errors import ExistsError
from kb.findings import Added, Stored
from kb.lookup import agents, recognition
from kb.store import names
from kb.store import updates as writing
from kb.store.consistency import check_consistent
from kb.store.shacl_validation import validate_statements
from kb.store.sparql import fill
from kb.store.stores import Store, is_address
from ontology import CAPAR

if TYPE_CHECKING:
    from capar.model.observation import Observation

_LIST = f"""SELECT ?name ?action ?agent ?profile ?version ?rules ?duration
WHERE {{
  ?seen a {CAPAR.Observation} ;
    {CAPAR.capture}/{CAPAR.name} ?name ;
    {CAPAR.name} ?action ;
    {CAPAR.agent}/{CAPAR.name} ?agent ;
    {CAPAR.profile} ?profile ;
    {CAPAR.version} ?version ;
    {CAPAR.ruleBase}/{CAPAR.sha256} ?rules ;
    {CAPAR.duration} ?duration .
  @filters@
}}
ORDER BY ?name"""


def add(store: Store, observation: "Observation", *, name: str | None, replace: bool) -> Added:
    """Keep an observation, whole and checked."""
    graph = names.observation(observation.capture)
    there = store.ask(f"SELECT ?identity WHERE {{ {graph} {CAPAR.identity} ?identity }}").rows
    same = there and getattr(there[0][0], "value", "") == identity(observation)
    if there and not same and not replace:
        raise ExistsError(
            f"an observation {observation.capture!r} of another capture is in {store.place}; "
            "give this capture another name, forget that one, or ask to replace it"
        )
    recognised = recognition.recognise(store, observation.complex_par, besides=graph) or ""
    called = name or observation.complex_par.name or recognised or observation.capture
    statements = encode(observation, name=called)
    validate_statements(observation.capture, statements)
    quads = agents.joined(statements.quads, agents.aliases(store))
    check_consistent(observation.capture, quads)
    if there or is_address(store.place):
        change = writing.replacement(graph, [*quads, *run(observation)])
        store.change(f"{run_removal(graph)} ;\n{change}")
    else:
        store.insert([*quads, *run(observation)])
    return Added(observation.capture, called, recognised, bool(there), len(quads))


def forget(store: Store, name: str) -> None:
    """Take an observation back."""
    known = [each.name for each in observations(store)]
    if name not in known:
        raise UnknownNameError("observation", name, known, where=store.place)
    graph = names.observation(name)
    store.change(f"{run_removal(graph)} ;\n{writing.removal(graph)}")


def observations(store: Store, filters: str = "") -> tuple[Stored, ...]:
    """Observations, by name; of those, the ones for which some patterns over ``?seen`` hold."""
    rows = store.ask(fill(_LIST, filters=filters)).rows
    out = []
    for row in rows:
        text = [each.value if isinstance(each, Literal) else "" for each in row]
        name, action, agent, profile, version, rules, duration = text
        out.append(Stored(name, action, agent, profile, version, rules, float(duration)))
    return tuple(out)
