"""A complex action as text and as Turtle."""

from pyoxigraph import RdfFormat

from capar.model.par import ComplexPar, Step
from kb.encode.pars import COMMON
from kb.exchange import part
from kb.lookup.pars import Pars, observations_of
from kb.store import names
from kb.store.answer_values import turtle
from ontology import CAPAR


def as_text(actionary: Pars, name: str) -> str:
    """The action's links and steps, and every observation of it with its shares of time.

    Raises:
        UnknownNameError: There is neither an observation nor a complex action of that name.
    """
    found = observations_of(actionary.store, name)
    values = [actionary.complex_par(each.name) for each in found]
    first = values[0]
    lines = [f"{first.name}({', '.join(first.objects)})"]
    for ee, steps in _rows(first).items():
        lines.append(f"  {'every link' if ee == COMMON else ee}")
        for index, step in enumerate(steps):
            own = (_rows(each).get(ee, ())[index : index + 1] for each in values)
            shares = " ".join(f"{sum(each.share for each in steps):.3f}" for steps in own)
            purpose = f" to {step.purpose}" if step.purpose else ""
            lines.append(f"    {index + 1}. {_call(step) + purpose:<48} {shares}")
    for relation in first.relations:
        (one, i), (two, j) = relation.first, relation.second
        lines.append(f"  {one} {i + 1} {relation.relation} {two} {j + 1}")
    lines.append("  observed, in the order of the shares:")
    for each in found:
        acting = {ipar.agent for ipar in actionary.ipars(each.name)} or {each.agent}
        performers = sorted(acting, key=lambda agent: (agent != each.agent, agent))
        lines.append(
            f"    {each.name} by {' and '.join(performers)}, {each.duration_s:.3f} s, "
            f"profile {each.profile}"
        )
    return "\n".join(lines) + "\n"


def _call(step: Step) -> str:
    return f"{step.action}({', '.join(step.objects)})"


def _rows(value: ComplexPar) -> dict[str, tuple[Step, ...]]:
    """The steps of each link, and the one that ends them all."""
    common = {COMMON: (value.common,)} if value.common else {}
    return {link.ee: link.steps for link in value.links} | common


def as_turtle(actionary: Pars, name: str) -> str:
    """The complex action, and its steps as each observation saw them."""
    keep = {CAPAR.enacts, CAPAR.step, CAPAR.name, CAPAR.agent, CAPAR.duration, CAPAR.objects}
    triples = []
    for each in observations_of(actionary.store, name):
        about = names.observation(each.name)
        quads = part(actionary.store, each.name)
        whole = {q.object for q in quads if q.subject == about and q.predicate == CAPAR.enacts}
        steps = {q.object for q in quads if q.predicate in {CAPAR.step, CAPAR.complexStep}}
        triples += [
            q.triple
            for q in quads
            if q.subject in whole | steps or (q.subject == about and q.predicate in keep)
        ]
    return turtle(sorted(dict.fromkeys(triples), key=str), form=RdfFormat.TURTLE)


FORMATS = {"text": as_text, "turtle": as_turtle}
"""How an action may be written."""
