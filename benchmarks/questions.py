"""How long named questions, a cold ``capar query`` and ``capar check`` take in a large Actionary.

``python benchmarks/questions.py [--copies 25]`` asks one in a temporary folder: the demo and four
performed actions, each 25 times. ``questions.py FROM TO --copies 25`` writes every observation of
the Actionary FROM 25 times into the folder TO, under other names; ``questions.py FOLDER`` asks
FOLDER, with ``--capture``, ``--object`` and ``--performer`` of it. Questions are asked about one
capture and over all, in one process that has the folder open, medians; a command is a process of
its own, its processor time. ``--first`` leaves out all but so many actions and questions of each
kind.
"""

import argparse
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import replace
from importlib import resources
from pathlib import Path

from pyoxigraph import Literal, NamedNode, Quad

from kb.actionary import Actionary
from kb.store.names import GRAPHS, OBSERVATION
from kb.store.stores import EmbeddedStore

PERFORMED = ("touch", "slide", "pick_up", "pour")
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


def read(line: str, given: dict[str, str], scope: dict[str, str]) -> tuple[str, dict[str, str]]:
    """The name of a question and its parameters."""
    question, _, stated = line.partition(" ")
    name, _, wanted = question.partition(":")
    parameters = {key: given[key] for key in wanted.split(",") if key}
    parameters |= dict(pair.split("=") for pair in stated.split())
    return name, parameters | ({} if name in {"abilities", "notices"} else scope)


def asked(actionary: Actionary, name: str, parameters: dict[str, str]) -> None:
    """Ask a question a few times and print the median [ms] and the number of rows."""
    times: list[float] = []
    rows = 0
    while len(times) < REPEATS and sum(times) < LONGEST_S:
        begun = time.perf_counter()
        rows = len(actionary.ask(name, **parameters))
        times.append(time.perf_counter() - begun)
    told = " ".join(f"{key}={value}" for key, value in parameters.items())
    print(f"{statistics.median(times) * 1e3:10.0f} ms {rows:7,} rows  {name} {told}", flush=True)


def example(folder: Path, most: int | None) -> None:
    """Write an Actionary of the demo and of some performed actions, no more of them than that."""
    from capar.body.scripted_actions import action_capture
    from capar.pipelines.observation import observe

    demo = Path(str(resources.files("capar"))) / "demo" / "drink_from_mug"
    with Actionary.open(folder) as actionary:
        actionary.add(observe(demo))
        for action in PERFORMED[:most]:
            # A name that is no word of anything else, as copies replace it wherever it stands.
            capture = replace(action_capture(action, rate_hz=30.0), name=f"performed_{action}")
            actionary.add(observe(capture))


def command(*arguments: str) -> float:
    """Run a command a few times, print the median of its processor time, and return it [ms]."""
    times = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        line = [sys.executable, "-c", "from capar.cli import main; main()", *arguments]
        subprocess.run(line, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        times.append(spent)
        if spent > 5.0:
            break
    taken_ms = statistics.median(times) * 1e3
    print(f"{taken_ms:10.0f} ms               {' '.join(arguments[:-2])}", flush=True)
    return taken_ms


def asked_all(folder: Path, options: argparse.Namespace) -> None:
    """Ask every question, and the commands."""
    capture = options.capture
    given = {"object": options.object, "body": options.object, "performer": options.performer}
    given |= {"observation": capture, "time": "2"}
    with Actionary.open(folder, read_only=True) as actionary:
        every = actionary.observations()
        recorded_s = sum(each.duration_s for each in every)
        print(f"{len(every)} observations of {recorded_s:.0f} s")
        print("of one capture")
        for line in OF_CAPTURE[: options.first]:
            asked(actionary, *read(line, given, {"capture": capture}))
        print("over all")
        for line in OVER_ALL[: options.first]:
            asked(actionary, *read(line, given, {}))
    print("commands")
    for line in OF_CAPTURE[: options.first]:
        name, parameters = read(line, given, {"capture": capture})
        stated = (f"{key}={value}" for key, value in parameters.items())
        command("query", name, *stated, "--actionary", str(folder))
    taken_ms = command("check", "--actionary", str(folder))
    print(f"{taken_ms / recorded_s:10.1f} ms               of check for each second of recording")


def main() -> None:
    """Copy an Actionary, or ask one."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("target", type=Path, nargs="?")
    parser.add_argument("--copies", type=int, default=25)
    parser.add_argument("--first", type=int, help="ask no more questions of each kind")
    parser.add_argument("--capture", default="drink_from_mug")
    parser.add_argument("--object", default="mug")
    parser.add_argument("--performer", default="man")
    options = parser.parse_args()
    if options.target:
        copies(options.folder, options.target, options.copies)
    elif options.folder:
        asked_all(options.folder, options)
    else:
        with tempfile.TemporaryDirectory() as made:
            one, many = Path(made) / "one", Path(made) / "many"
            example(one, options.first)
            copies(one, many, options.copies)
            asked_all(many, options)


if __name__ == "__main__":
    main()
