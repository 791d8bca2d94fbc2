"""Constraint locations by kind of object, action, purpose and side (thesis 4.4.2.2)."""

from dataclasses import dataclass, replace

from pyoxigraph import Literal, NamedNode

from capar.model.locations import ConstraintLocation
from capar.model.par import Nlt
from kb.findings import FoundLocation
from kb.lookup import kinds
from kb.store import names
from kb.store.answers import Found
from kb.store.literals import nlt_of
from kb.store.sparql import fill
from kb.store.stores import Store
from ontology import CAPAR

OTHER = {"right": "left", "left": "right"}
"""The other side of the body."""

_RANK = f"""SELECT DISTINCT ?kind ?place ?side
WHERE {{
  VALUES ?kind {{ @kinds@ }}
  {{ ?place {CAPAR.goalKind} ?kind }} UNION {{ ?place {CAPAR.dominantKind} ?kind }}
  @filters@
  ?place {CAPAR.side} ?side .
}}"""

_DETAIL = f"""SELECT ?place ?observation ?agent ?action ?purpose ?ee ?side ?frame
  ?dominant ?goal ?held ?at ?seen ?view
WHERE {{
  VALUES ?place {{ @places@ }}
  ?place {CAPAR.actionName} ?action ;
    {CAPAR.ee} ?ee ;
    {CAPAR.agent}/{CAPAR.name} ?agent ;
    {CAPAR.side} ?side ;
    {CAPAR.frame} ?frame .
  ?in {CAPAR.location} ?place ;
    {CAPAR.capture}/{CAPAR.name} ?observation .
  OPTIONAL {{ ?place {CAPAR.purpose} ?purpose }}
  OPTIONAL {{ ?place {CAPAR.dominant}/{CAPAR.name} ?dominant }}
  OPTIONAL {{ ?place {CAPAR.goal}/{CAPAR.name} ?goal }}
  OPTIONAL {{ ?place {CAPAR.seen}/{CAPAR.name} ?seen }}
  OPTIONAL {{ ?place {CAPAR.eeNlt} ?held }}
  OPTIONAL {{ ?place {CAPAR.goalNlt} ?at }}
  OPTIONAL {{ ?place {CAPAR.vNlt} ?view }}
}}"""


@dataclass(frozen=True, slots=True, order=True)
class _Ranked:
    """A place by how well it fits: less is better."""

    distance: int
    mirrored: bool
    place: str
    kind: str


def find(
    store: Store,
    kind: str,
    *,
    action: str | None,
    purpose: str | None,
    side: str | None,
    most: int | None = None,
) -> tuple[FoundLocation, ...]:
    """Constraint locations that fit, best first, and so many at most."""
    order = kinds.above(store, kind)
    filters = []
    if action is not None:
        filters.append(f"?place {CAPAR.actionName} {Literal(action)} .")
    if purpose is not None:
        filters.append(f"?place {CAPAR.purpose} {Literal(purpose)} .")
    nodes = " ".join(str(names.shared("kind", each)) for each in order)
    rows = store.ask(fill(_RANK, kinds=nodes, filters="\n  ".join(filters))).rows
    ranked = [each for row in rows if (each := _ranked(row, order, side)) is not None]
    nearest = {each.place: each for each in sorted(ranked, reverse=True)}
    best = sorted(nearest.values())[:most]
    if not best:
        return ()
    places = " ".join(each.place for each in best)
    details = {str(row[0]): row[1:] for row in store.ask(fill(_DETAIL, places=places)).rows}
    return tuple(_found(details[each.place], each, kind) for each in best)


def _ranked(row: tuple[Found, ...], order: tuple[str, ...], side: str | None) -> _Ranked | None:
    """How well a place fits; nothing if it was made with neither the side nor its other one."""
    kind, place, on = row
    if not isinstance(kind, NamedNode) or not isinstance(on, Literal):
        return None
    word = names.last_word(kind)
    if side in {None, on.value}:
        return _Ranked(order.index(word), False, str(place), word)
    return (
        _Ranked(order.index(word), True, str(place), word) if OTHER.get(on.value) == side else None
    )


def _found(row: tuple[Found, ...], ranked: _Ranked, asked: str) -> FoundLocation:
    text = [each.value if isinstance(each, Literal) else "" for each in row]
    observation, agent, action, purpose, ee, on, frame, dominant, goal, held, at, seen, view = text
    location = ConstraintLocation(
        action=action,
        purpose=purpose,
        ee=ee,
        side=on,
        frame=int(frame),
        dominant=dominant,
        goal=goal,
        ee_nlt=_nlt(held),
        goal_nlt=_nlt(at),
        seen=seen,
        v_nlt=_nlt(view),
    )
    return FoundLocation(
        location=mirrored(location) if ranked.mirrored else location,
        kind=ranked.kind,
        observation=observation,
        agent=agent,
        mirrored=ranked.mirrored,
        inherited=ranked.kind != asked,
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
