"""What knowledge engineers ask, and what they ask it of: a world of demo and recordings.

Questions that have no name are SPARQL of at most eight lines.
"""

import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import motions
from bundles import DRINKING
from observations import drink_from_mug, with_unknown

from capar.model.capture import Agent, Capture
from capar.model.facts import Fact
from capar.model.observation import Observation, Segment
from capar.pipelines.observation import observe_measured
from capar.pipelines.trials import trial_of
from extractors.measure import Measurements, measure

HELD_WHILE_TILTED = """
SELECT ?capture ?from ?to { ?o capar:fact ?h , ?t ; rdfs:label ?capture .
?h a capar:Touching ; capar:body/capar:side "right" ; capar:other/capar:name "whisk" .
?h capar:start ?a ; capar:end ?b .
?t a capar:Leaning ; capar:body/capar:name "bottle" ; capar:start ?c ; capar:end ?d .
BIND(IF(?a > ?c, ?a, ?c) AS ?from) BIND(IF(?b < ?d, ?b, ?d) AS ?to) FILTER(?from < ?to) }
"""
"""When did the right hand hold the whisk while the bottle was tilted?"""

INSIDE = """
SELECT DISTINCT ?capture ?name { ?o rdfs:label ?capture .
{ ?o capar:fact ?in . ?in a capar:Arrangement ; capar:arrangement "inside" }
UNION { ?o capar:segment/capar:placement ?in . ?in capar:preposition "in" }
?in capar:body/capar:name ?name ; capar:other/capar:kind/capar:isA/capar:name "container" }
"""
"""Which objects were ever inside a container?"""

LOOKED_BEFORE = """
SELECT ?who ?object (MAX(?t - ?l) AS ?before) { ?o capar:fact ?look , ?grasp .
?look a capar:LookingAt ; capar:seen ?x ; capar:start ?l .
?grasp a capar:Touching ; capar:body ?hand ; capar:other ?x ; capar:start ?t .
?hand capar:effectorType "hand" ; capar:agent/rdfs:label ?who .
?x capar:name ?object . FILTER(?l < ?t) } GROUP BY ?o ?who ?object
"""
"""Who looked at an object before grasping it, and how long before at most?"""

REACHING_SPEEDS = """
SELECT ?address (capar:highestSpeed(?o, ?hand, ?a, ?b) AS ?speed) { ?o capar:segment ?s .
?s capar:action/capar:name "Reach" ; capar:address ?address ; capar:ofLink ?hand .
?hand capar:side "right" . ?s capar:start ?a ; capar:end ?b }
"""
"""Highest speed of the right hand in each Reach."""

QUERIES = {
    "held while tilted": HELD_WHILE_TILTED,
    "inside": INSIDE,
    "looked before": LOOKED_BEFORE,
    "reaching speeds": REACHING_SPEEDS,
}

HERE = Path(__file__).parents[1]
TAKES = (
    "bimacs_optitrack/shapes.toml:take0",
    "bimacs_optitrack/shapes.toml:take5",
    "omomo_intermimic/hands.toml:sub2_largetable_008",
)
KITCHEN = ("bimacs_optitrack:take0", "bimacs_optitrack:take5")
"""The captures of those takes in which things are stirred and poured."""


def recordings() -> Iterator[str]:
    """The takes that are asked about, where there are recordings."""
    folder = Path(os.environ.get("CAPAR_DATA") or HERE.parent / "shared" / "data")
    if (folder / "bimacs_optitrack").is_dir():
        os.environ.setdefault("CAPAR_DATA", str(folder))
        yield from (f"{HERE / 'examples' / take}" for take in TAKES)


def ambiguous(seen: Observation) -> Observation:
    """The same with another name that fits each of its first segments as well."""
    links = (
        replace(
            each,
            segments=(replace(each.segments[0], candidates=("Hit", "Kick")), *each.segments[1:]),
        )
        for each in seen.links
    )
    return replace(seen, links=tuple(links))


class World:
    """What was observed, and the measurements that it rests on."""

    def __init__(self) -> None:
        self.captures: dict[str, Capture] = {}
        self.measured: dict[str, Measurements] = {}
        self.seen: list[Observation] = []
        lifted = motions.pick_up_with_both_hands(motions.PERFORMERS[0]).capture
        for place in (str(DRINKING), *recordings(), lifted):
            capture = trial_of(place)
            measured = measure(capture)
            self.captures[capture.name] = capture
            self.measured[capture.name] = measured
            self.seen.append(observe_measured(capture, measured))
        unnamed = [replace(drink_from_mug(), agent=Agent(), capture=f"cup_{n}") for n in (1, 2)]
        self.seen += [ambiguous(each) for each in unnamed]
        self.seen.append(with_unknown())

    @property
    def kitchen(self) -> set[str]:
        """The captures in which things are stirred and poured; none without recordings."""
        return self.captures.keys() & set(KITCHEN)

    def segments(self) -> Iterator[tuple[Observation, Segment, str]]:
        """Every segment with its observation and its address."""
        for seen in self.seen:
            for each in seen.segments:
                yield seen, each, f"{seen.capture}/{each.ee}/{each.index}"

    def is_kind(self, segment: Segment, action: str) -> bool:
        """Whether it is a case of an action, as any of the rule bases has it."""
        above = {
            general
            for _, each, _ in self.segments()
            if each.name == segment.name
            for general in each.general
        }
        return segment.known and action in {segment.name, *above}

    def performer(self, seen: Observation, segment: Segment) -> str:
        name = seen.performer(segment.ee)
        return f"agent of {seen.capture}" if name == "agent" else name

    def facts(self, seen: Observation, kind: type[Fact]) -> list[Fact]:
        return [each for each in seen.facts if isinstance(each, kind)]


def step(seen: Observation) -> float:
    return seen.duration_s / (seen.frames - 1)


def side(seen: Observation, ee: str) -> str:
    return next((each.side for each in seen.links if each.ee == ee), "")


def rounded(rows: Iterable[Iterable[object]]) -> set[tuple[object, ...]]:
    return {tuple(round(v, 4) if isinstance(v, float) else v for v in row) for row in rows}
