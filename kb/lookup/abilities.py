"""What agents are able to do, and what objects lend themselves to (thesis 4.6.1.4)."""

from pyoxigraph import Literal, Quad

from capar.model.errors import UnknownNameError
from capar.model.par import Condition, Upar
from kb.encode import pars as par_encoding
from kb.encode import segments
from kb.errors import StoreError
from kb.findings import Ability
from kb.lookup import kinds
from kb.lookup.stored_pars import upars
from kb.store import names
from kb.store.sparql import fill
from kb.store.statements import LABEL, TYPE, Statements
from kb.store.stores import Store
from ontology import CAPAR

YES = Literal(True)

_AGENT = f"""SELECT DISTINCT ?action ?declared
WHERE {{
  {{
    ?who {CAPAR.capability} ?ability .
    ?ability {CAPAR.action}/{CAPAR.name} ?action .
    BIND(true AS ?declared)
  }}
  UNION
  {{
    ?link {CAPAR.agent} ?who .
    ?segment {CAPAR.ofLink} ?link ; {CAPAR.action}/{CAPAR.name} ?action .
    BIND(false AS ?declared)
  }}
  ?who {CAPAR.name} @name@ .
}}"""

_KIND = f"""SELECT DISTINCT ?action ?declared
WHERE {{
  VALUES ?kind {{ @kinds@ }}
  {{
    ?kind {CAPAR.affords}/{CAPAR.name} ?action .
    BIND(true AS ?declared)
  }}
  UNION
  {{
    ?kind {CAPAR.capability} ?ability .
    ?ability {CAPAR.action}/{CAPAR.name} ?action .
    BIND(true AS ?declared)
  }}
  UNION
  {{
    ?thing {CAPAR.kind} ?kind .
    ?segment {CAPAR.object} ?thing ;
      {CAPAR.action}/{CAPAR.name} ?action .
    BIND(false AS ?declared)
  }}
}}"""


def declare(
    store: Store, action: str, conditions: tuple[Condition, ...], *, agent: str, kind: str
) -> None:
    """State an ability of an agent, or of a kind of agent or object.

    Raises:
        StoreError: Neither of them is named, or both are.
    """
    if bool(agent) == bool(kind):
        raise StoreError("an ability is an agent's or a kind's: name one of them")
    graph = names.GRAPHS["agents" if agent else "objects"]
    node = names.shared("agent", agent) if agent else names.shared("kind", kind)
    out = Statements(names.GRAPHS["actions"])
    needs = par_encoding.conditions(out, conditions)
    word = segments.action(out, action)
    marked = [each for each in (word, *needs) if each is not None]
    quads = [each for each in out.quads if each.predicate != CAPAR.mentions]
    quads += [Quad(each, CAPAR.declared, YES, names.GRAPHS["actions"]) for each in marked]
    quads += _described(agent) if agent else kinds.described(kind)
    ability = names.part(node, "ability", action)
    quads += [
        Quad(node, CAPAR.capability, ability, graph),
        Quad(ability, TYPE, CAPAR.Capability, graph),
        Quad(ability, LABEL, Literal(f"{agent or kind}: {action}"), graph),
        *(Quad(ability, CAPAR.action, each, graph) for each in marked[:1]),
        *(Quad(ability, CAPAR.applicability, each, graph) for each in needs),
    ]
    store.insert(quads)


def _described(agent: str) -> list[Quad]:
    node, graph = names.shared("agent", agent), names.GRAPHS["agents"]
    return [
        Quad(node, CAPAR.declared, YES, graph),
        Quad(node, TYPE, CAPAR.Agent, graph),
        Quad(node, LABEL, Literal(agent), graph),
        Quad(node, CAPAR.name, Literal(agent), graph),
    ]


def of(store: Store, name: str) -> tuple[Ability, ...]:
    """Abilities of an agent of that name, and of the kind of that name and those above it."""
    word = str(Literal(name))
    nodes = " ".join(str(names.shared("kind", each)) for each in kinds.above(store, name))
    found: set[Ability] = set()
    for query in (fill(_AGENT, name=word), fill(_KIND, kinds=nodes)):
        for action, declared in store.ask(query).rows:
            if isinstance(action, Literal) and isinstance(declared, Literal):
                evidence = "declared" if declared.value == "true" else "observed"
                found.add(Ability(action.value, evidence))
    return tuple(sorted(found))


def unmet(store: Store, action: str, agent: str, objects: tuple[str, ...]) -> tuple[Condition, ...]:
    """Conditions of applicability that nothing known speaks for."""
    known = upars(store, action)
    if not known:
        names_known = {each.name for each in upars(store, None)}
        raise UnknownNameError("action", action, names_known, where=store.place)
    fitting = [each for each in known if len(each.objects) == len(objects)] or list(known)
    return tuple(
        each
        for each in fitting[0].applicability
        if not _met(store, fitting[0], each, agent, objects)
    )


def _met(store: Store, upar: Upar, value: Condition, agent: str, objects: tuple[str, ...]) -> bool:
    """Whether an ability speaks for a condition; only capability is known before the act."""
    if value.kind != "capable" or len(value.arguments) != 2:
        return False
    bound = dict(zip(upar.objects, objects, strict=False))
    bound[upar.agent] = agent
    who, action = value.arguments
    able = any(each.action == action for each in of(store, bound.get(who, who)))
    return able is value.holds
