"""From a capture, or an observation that is stored, to what plans for others are written from."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from capar.export.pddl import pddl
from capar.export.plans import PlanSource, behavior_tree, bml, plan_source
from capar.model.errors import UnknownNameError
from capar.model.facts import Fact, Frames, LookingAt, RateMhz
from capar.model.observation import Observation
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.encode.facts import stored_facts
from kb.encode.shared import kind_of
from ontology import CAPAR

PLAN_FORMATS = ("pddl", "bt", "bml")
"""PDDL 2.1 domain and problem, BehaviorTree.CPP 4 XML, and BML 1.0."""


def observed_plan(observation: Observation) -> PlanSource:
    """The complex action of an observation.

    Raises:
        PlanExportError: It has no steps.
    """
    stated = {each.name: kind_of(each) for each in observation.objects}
    with Actionary.in_memory() as words:
        kinds = {name: words.kinds_above(stated[name]) for name in observation.complex_par.objects}
    return plan_source(
        observation.complex_par,
        observation.ipars,
        observation.upars,
        kinds,
        name=observation.complex_par.name,
        looks=_looks(observation.facts),
    )


def stored_plan(actionary: Actionary, name: str) -> PlanSource:
    """The complex action of an observation in an Actionary.

    Raises:
        UnknownNameError: There is none of that name.
    """
    seen = actionary.observations()
    known = {each.name: each.name for each in seen}
    chosen = known.get(name) or next((each.name for each in seen if each.action == name), None)
    if chosen is None:
        raise UnknownNameError("observation", name, known, where=str(actionary.store.place))
    par = actionary.complex_par(chosen)
    stated = _stated_kinds(actionary, chosen)
    kinds = {each: actionary.kinds_above(stated.get(each, each)) for each in par.objects}
    action = next(each.action for each in seen if each.name == chosen)
    return plan_source(
        par,
        actionary.ipars(chosen),
        actionary.upars(),
        kinds,
        name=action,
        looks=_looks(stored_facts(actionary.store, chosen)),
    )


def capture_plan(capture: Path | str) -> PlanSource:
    """The complex action that is observed in a capture.

    Raises:
        CaparError: The capture has a fault, or nobody acts in it.
    """
    return observed_plan(observe(capture))


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


def _stated_kinds(actionary: Actionary, observation: str) -> dict[str, str]:
    """The kind of every object of an observation."""
    text = f"""SELECT DISTINCT ?name ?kind WHERE {{
  ?seen {CAPAR.capture}/{CAPAR.name} ?capture ; {CAPAR.object} ?thing .
  ?thing {CAPAR.name} ?name ; {CAPAR.kind}/{CAPAR.name} ?kind .
  FILTER(?capture = "{observation}")
}}"""
    rows = actionary.store.ask(text).plain()
    return {str(row["name"]): str(row["kind"]) for row in rows}


def _looks(measured: Iterable[Fact]) -> Iterator[tuple[str, float, float]]:
    """What was looked at, from when to when [s]."""
    known = tuple(measured)
    rate = next((each.rate / 1000.0 for each in known if isinstance(each, RateMhz)), 0.0)
    if not rate or not any(isinstance(each, Frames) for each in known):
        return
    found = sorted(
        (each.first, each.last, each.object) for each in known if isinstance(each, LookingAt)
    )
    for first, last, seen in found:
        yield seen, first / rate, last / rate
