"""Constraint locations by kind of object, action, purpose and side (thesis 4.4.2.2)."""

from dataclasses import replace

from pyoxigraph import Literal, NamedNode

from capar.model.par import ConstraintLocation, Nlt
from kb import names
from kb.answers import Found
from kb.findings import FoundLocation
from kb.literals import nlt_of
from kb.lookup import kinds
from kb.sparql import fill
from kb.store import Store
from ontology import CAPAR

OTHER = {"right": "left", "left": "right"}
"""The other side of the body."""

_FIND = f"""SELECT DISTINCT ?kind ?observation ?agent ?action ?purpose ?side ?frame
  ?dominant ?goal ?ee ?at ?seen ?view
WHERE {{
  VALUES ?kind {{ @kinds@ }}
  {{ ?place {CAPAR.goalKind} ?kind }} UNION {{ ?place {CAPAR.dominantKind} ?kind }}
  @filters@
  ?place {CAPAR.actionName} ?action ;
    {CAPAR.side} ?side ;
    {CAPAR.frame} ?frame .
  ?in {CAPAR.location} ?place ;
    {CAPAR.capture}/{CAPAR.name} ?observation ;
    {CAPAR.agent}/{CAPAR.name} ?agent .
  OPTIONAL {{ ?place {CAPAR.purpose} ?purpose }}
  OPTIONAL {{ ?place {CAPAR.dominant}/{CAPAR.name} ?dominant }}
  OPTIONAL {{ ?place {CAPAR.goal}/{CAPAR.name} ?goal }}
  OPTIONAL {{ ?place {CAPAR.seen}/{CAPAR.name} ?seen }}
  OPTIONAL {{ ?place {CAPAR.eeNlt} ?ee }}
  OPTIONAL {{ ?place {CAPAR.goalNlt} ?at }}
  OPTIONAL {{ ?place {CAPAR.vNlt} ?view }}
}}"""


def find(
    store: Store, kind: str, *, action: str | None, purpose: str | None, side: str | None
) -> tuple[FoundLocation, ...]:
    """Constraint locations that fit, best first."""
    order = kinds.above(store, kind)
    nodes = " ".join(str(names.shared("kind", each)) for each in order)
    filters = []
    if action is not None:
        filters.append(f"?place {CAPAR.actionName} {Literal(action)} .")
    if purpose is not None:
        filters.append(f"?place {CAPAR.purpose} {Literal(purpose)} .")
    query = fill(_FIND, kinds=nodes, filters="\n  ".join(filters))
    found = [_found(row, kind, side) for row in store.ask(query).rows]
    fitting = [each for each in found if side in {None, each.location.side}]
    return tuple(
        sorted(
            fitting,
            key=lambda each: (
                order.index(each.kind),
                each.mirrored,
                each.observation,
                each.location.frame,
                repr(each.location),
            ),
        )
    )


def _found(row: tuple[Found, ...], asked: str, side: str | None) -> FoundLocation:
    kind, *rest = row
    text = [each.value if isinstance(each, Literal) else "" for each in rest]
    observation, agent, action, purpose, on, frame, dominant, goal, ee, at, seen, view = text
    location = ConstraintLocation(
        action=action,
        purpose=purpose,
        side=on,
        frame=int(frame),
        dominant=dominant,
        goal=goal,
        ee_nlt=_nlt(ee),
        goal_nlt=_nlt(at),
        seen=seen,
        v_nlt=_nlt(view),
    )
    other = side is not None and on != side and OTHER.get(on) == side
    word = names.last_word(kind) if isinstance(kind, NamedNode) else ""
    return FoundLocation(
        location=mirrored(location) if other else location,
        kind=word,
        observation=observation,
        agent=agent,
        mirrored=other,
        inherited=word != asked,
    )


def _nlt(text: str) -> Nlt | None:
    return nlt_of(text) if text else None


def mirrored(value: ConstraintLocation) -> ConstraintLocation:
    """The same constraint made with the other side of the body (thesis 4.4.2.2)."""
    return replace(
        value,
        side=OTHER.get(value.side, value.side),
        ee_nlt=value.ee_nlt and value.ee_nlt.mirrored(),
        goal_nlt=value.goal_nlt and value.goal_nlt.mirrored(),
        v_nlt=value.v_nlt and value.v_nlt.mirrored(),
    )
