"""From a capture, or an observation that is stored, to what plans for others are written from."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from capar.export.pddl import pddl
from capar.export.plans import PlanSource, behavior_tree, bml, plan_source
from capar.model.errors import UnknownNameError
from capar.model.facts import Fact, LookingAt, RateMhz
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.encode.observation import stored_facts
from kb.encode.shared import kind_of
from ontology import CAPAR

PLAN_FORMATS = ("pddl", "bt", "bml")
"""PDDL 2.1 domain and problem, BehaviorTree.CPP 4 XML, and BML 1.0."""


def observed_plan(seen: Observation | Path | str) -> PlanSource:
    """The complex action of an observation, or of what is observed in a capture.

    Raises:
        PlanExportError: It has no steps.
        CaparError: The capture has a fault.
    """
    observation = seen if isinstance(seen, Observation) else observe(seen)
    par, stated = observation.complex_par, {o.name: kind_of(o) for o in observation.objects}
    with Actionary.in_memory() as words:
        kinds = {name: words.kinds_above(stated[name]) for name in par.objects}
    looks = _looks(observation.facts)
    return plan_source(par, observation.ipars, observation.upars, kinds, name=par.name, looks=looks)


def stored_plan(actionary: Actionary, name: str) -> PlanSource:
    """The complex action of an observation in an Actionary.

    Raises:
        UnknownNameError: There is none of that name.
    """
    seen = {each.name: each.action for each in actionary.observations()}
    chosen = name if name in seen else next((n for n, done in seen.items() if done == name), None)
    if chosen is None:
        raise UnknownNameError("observation", name, seen, where=str(actionary.store.place))
    par = actionary.complex_par(chosen)
    text = f"""SELECT DISTINCT ?name ?kind WHERE {{
  ?seen {CAPAR.capture}/{CAPAR.name} ?capture ; {CAPAR.object} ?thing .
  ?thing {CAPAR.name} ?name ; {CAPAR.kind}/{CAPAR.name} ?kind .
  FILTER(?capture = "{chosen}")
}}"""
    stated = {str(r["name"]): str(r["kind"]) for r in actionary.store.ask(text).plain()}
    kinds = {each: actionary.kinds_above(stated.get(each, each)) for each in par.objects}
    looks = _looks(stored_facts(actionary.store, chosen))
    return plan_source(
        par, actionary.ipars(chosen), actionary.upars(), kinds, name=seen[chosen], looks=looks
    )


def plan_files(source: PlanSource, format_name: str) -> dict[str, str]:
    """A plan as text by file name; PDDL has two files.

    Raises:
        UnknownNameError: There is no such format.
    """
    if format_name == "pddl":
        made = pddl(source)
        return {"domain.pddl": made.domain, "problem.pddl": made.problem}
    if format_name == "bt":
        return {f"{source.name}.xml": behavior_tree(source)}
    if format_name == "bml":
        return {f"{source.name}.bml": bml(source)}
    raise UnknownNameError("plan format", format_name, PLAN_FORMATS)


def _looks(measured: Iterable[Fact]) -> Iterator[tuple[str, float, float]]:
    """What was looked at, from when to when [s]."""
    known = tuple(measured)
    rate = next((each.rate / 1000.0 for each in known if isinstance(each, RateMhz)), 0.0)
    looks = (each for each in known if isinstance(each, LookingAt))
    for first, last, name in sorted((e.first, e.last, e.object) for e in looks if rate):
        yield name, first / rate, last / rate
