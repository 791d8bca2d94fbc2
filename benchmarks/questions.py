"""How long named questions take in a large Actionary, and how one is made.

``python benchmarks/questions.py FROM TO --copies 25`` writes every observation of the Actionary
FROM 25 times into the folder TO, under other names; ``python benchmarks/questions.py FOLDER`` asks
FOLDER every question, about one capture and over all, and prints medians.
"""

import argparse
import statistics
import time
from collections import defaultdict
from pathlib import Path

from pyoxigraph import Literal, NamedNode, Quad

from kb.actionary import Actionary
from kb.store.names import GRAPHS, OBSERVATION
from kb.store.stores import EmbeddedStore

REPEATS = 5
LONGEST_S = 20.0
"""A question that takes longer is asked once."""

LONGEST_RENAMED = 300
"""Texts of as many characters or more, such as files and curves, keep the name that is in them."""

OF_CAPTURE = (
    "abilities:performer",
    "ambiguous",
    "arrangements",
    "contacts",
    "held",
    "looked_at",
    "looked_before",
    "notices:observation",
    "place:body,time",
    "relations",
    "rule",
    "segments",
    "sources",
    "speeds",
    "touching:object",
    "unknown",
    "uses:object",
    "where",
    "world:time",
)
OVER_ALL = (
    "actions",
    "ambiguous",
    "arrangements arrangement=inside",
    "both_hands",
    "durations action=Reach",
    "durations action=Reach,Lift",
    "follows action=Lift effector=hand",
    "follows action=Reach",
    "grasped:object",
    "hand action=Reach",
    "held",
    "instruments",
    "kinds action=MoveObj",
    "levin levin=9.4",
    "looked_before",
    "performers action=Reach",
    "sources",
    "touching:object",
    "unknown",
    "uses:object",
    "verb lemma=raise",
)


def copies(source: Path, target: Path, count: int) -> None:
    """Write every observation of an Actionary several times into a new folder."""
    observations: dict[str, list[Quad]] = defaultdict(list)
    shared: list[Quad] = []
    for quad in EmbeddedStore(source, read_only=True).quads():
        graph = quad.graph_name.value if isinstance(quad.graph_name, NamedNode) else ""
        (observations[graph] if graph.startswith(OBSERVATION) else shared).append(quad)
    store = EmbeddedStore(target)
    store.bulk(shared)
    agents = [quad for quad in shared if quad.graph_name == GRAPHS["agents"]]
    for graph, quads in observations.items():
        name = graph.removeprefix(OBSERVATION)
        own = [quad for quad in agents if str(quad.subject).endswith(f".{name}>")]
        store.bulk(quads)
        for number in range(1, count):
            store.bulk(_renamed(quad, name, f"{name}_{number}") for quad in (*quads, *own))
    store.close()


def _renamed(quad: Quad, name: str, other: str) -> Quad:
    def node(given: NamedNode) -> NamedNode:
        return NamedNode(given.value.replace(name, other))

    subject, about, graph = quad.subject, quad.object, quad.graph_name
    if isinstance(about, Literal) and name in about.value and len(about.value) < LONGEST_RENAMED:
        about = Literal(about.value.replace(name, other), datatype=about.datatype)
    return Quad(
        node(subject) if isinstance(subject, NamedNode) else subject,
        quad.predicate,
        node(about) if isinstance(about, NamedNode) else about,
        node(graph) if isinstance(graph, NamedNode) else graph,
    )


def asked(actionary: Actionary, line: str, given: dict[str, str], scope: dict[str, str]) -> None:
    """Ask a question a few times and print the median [ms] and the number of rows."""
    question, _, stated = line.partition(" ")
    name, _, wanted = question.partition(":")
    parameters = {key: given[key] for key in wanted.split(",") if key}
    parameters |= dict(pair.split("=") for pair in stated.split())
    parameters |= {} if name in {"abilities", "notices"} else scope
    times: list[float] = []
    rows = 0
    while len(times) < REPEATS and sum(times) < LONGEST_S:
        begun = time.perf_counter()
        rows = len(actionary.ask(name, **parameters))
        times.append(time.perf_counter() - begun)
    told = " ".join(f"{key}={value}" for key, value in parameters.items())
    print(f"{statistics.median(times) * 1e3:10.0f} ms {rows:7,} rows  {name} {told}", flush=True)


def main() -> None:
    """Copy an Actionary, or ask one."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("target", type=Path, nargs="?")
    parser.add_argument("--copies", type=int, default=25)
    parser.add_argument("--capture", default="bimacs_optitrack:take0")
    parser.add_argument("--object", default="bottle")
    parser.add_argument("--performer", default="tall_man")
    options = parser.parse_args()
    if options.target:
        copies(options.folder, options.target, options.copies)
        return
    capture = options.capture
    given = {"object": options.object, "body": options.object, "performer": options.performer}
    given |= {"observation": capture, "time": "5"}
    with Actionary.open(options.folder, read_only=True) as actionary:
        print("of one capture")
        for line in OF_CAPTURE:
            asked(actionary, line, given, {"capture": capture})
        print("over all")
        for line in OVER_ALL:
            asked(actionary, line, given, {})


if __name__ == "__main__":
    main()
