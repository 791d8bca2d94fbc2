"""Styles by agent, action, purpose and end-effector (thesis 4.4.2.3)."""

from pyoxigraph import Literal

from capar.model.par import Style
from kb.findings import FoundStyle
from kb.store.literals import numbers, path_of
from kb.store.sparql import fill
from kb.store.stores import Store
from ontology import CAPAR

_FIND = f"""SELECT ?agent ?observation ?index ?action ?purpose ?ee ?velocity ?path
WHERE {{
  @filters@
  ?style a {CAPAR.AgentStyle} ;
    {CAPAR.agent}/{CAPAR.name} ?agent ;
    {CAPAR.index} ?index ;
    {CAPAR.actionName} ?action ;
    {CAPAR.ee} ?ee .
  ?in {CAPAR.style} ?style ;
    {CAPAR.capture}/{CAPAR.name} ?observation .
  OPTIONAL {{ ?style {CAPAR.purpose} ?purpose }}
  OPTIONAL {{ ?style {CAPAR.velStyle} ?velocity }}
  OPTIONAL {{ ?style {CAPAR.pathStyle} ?path }}
}}"""


def find(
    store: Store, *, agent: str | None, action: str | None, purpose: str | None, ee: str | None
) -> tuple[FoundStyle, ...]:
    """Styles that fit, by observation and in the order in which they were seen there."""
    wanted = {
        f"{CAPAR.agent}/{CAPAR.name}": agent,
        f"{CAPAR.actionName}": action,
        f"{CAPAR.purpose}": purpose,
        f"{CAPAR.ee}": ee,
    }
    filters = [f"?style {path} {Literal(word)} ." for path, word in wanted.items() if word]
    rows = store.ask(fill(_FIND, filters="\n  ".join(filters))).rows
    found = []
    for row in rows:
        text = [each.value if isinstance(each, Literal) else "" for each in row]
        who, observation, index, name, purpose_text, with_, velocity, points = text
        style = Style(name, purpose_text, with_, numbers(velocity), path_of(points))
        found.append(((observation, int(index)), FoundStyle(style, who, observation)))
    return tuple(each for _, each in sorted(found, key=lambda each: each[0]))
