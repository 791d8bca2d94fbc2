"""Load rate and query latency of the Actionary's stores, beside rdflib's memory store, in one run.

``python benchmarks/actionary.py [--largest 1000000] [--rdflib 10000]``: sizes from 10^4 triples up
in tens.
rdflib is measured up to 10^4 unless told otherwise: beyond, its joins do not end in useful time.
"""

import argparse
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from observations import drink_from_mug, pick_up_with_both_hands, with_unknown
from pyoxigraph import Quad

from capar.model.observation import Observation
from kb.actionary import Actionary
from kb.encode.observation import encode
from kb.queries.questions import question
from kb.store.names import GRAPHS
from kb.store.stores import EmbeddedStore
from ontology.files import ontology

MADE = (drink_from_mug(), pick_up_with_both_hands(), with_unknown())
AGENTS = 50
REPEATS = 15

ASKED: dict[str, dict[str, object]] = {
    "world": {"capture": "o0", "time": 2.0},
    "before": {"action": "MoveObjTo"},
    "goal": {"goal": "table"},
    "follows": {"action": "Reach"},
    "hand": {"action": "Reach"},
    "grasped": {"object": "mug", "purpose": "Drink"},
    "performers": {"action": "DrinkFromMug"},
    "touching": {"object": "mug"},
    "shared": {"first": "DrinkFromMug", "second": "PickUpWithBothHands"},
    "allen": {"action": "o1"},
    "unknown": {},
    "unexplained": {},
    "instruments": {},
    "observations": {},
    "actions": {},
    "notices": {},
    "looked_at": {"action": "TouchWith"},
}


def many(triples: int) -> Iterator[Quad]:
    """Statements of as many observations as make so many triples."""
    for each in ontology():
        yield Quad(each.subject, each.predicate, each.object, GRAPHS["ontology"])
    count, index = 0, 0
    while count < triples:
        quads = encode(numbered(index)).quads
        yield from quads
        count += len(quads)
        index += 1


def numbered(index: int) -> Observation:
    """One of many observations, by one of many agents, some of a rare action."""
    made = MADE[index % len(MADE)]
    agent = replace(made.agent, name=f"agent{index % AGENTS}")
    rare = f"Rare{index // 1000}" if index % 1000 == 0 else made.complex_par.name
    return replace(
        made, capture=f"o{index}", agent=agent, complex_par=replace(made.complex_par, name=rare)
    )


def milliseconds(action: Callable[[], object]) -> list[float]:
    """How long an action takes, several times [ms]; fewer times if it is slow."""
    out: list[float] = []
    begun = time.perf_counter()
    while len(out) < REPEATS and (len(out) < 3 or time.perf_counter() - begun < 10):
        at = time.perf_counter()
        action()
        out.append((time.perf_counter() - at) * 1e3)
    return out


def measure(name: str, store: Any, ask: Callable[[str], object], rate: float, size: int) -> None:
    """Print a line for each question."""
    print(f"\n{name}, {size:,} triples: loaded at {rate:,.0f} triples/s")
    every: list[float] = []
    for asked, parameters in ASKED.items():
        query = question(asked).bind(parameters)
        times = milliseconds(lambda query=query: ask(query))
        every += times
        print(f"  {asked:<14}{statistics.median(times):10.2f} ms")
    lookups = (
        ("recognise", lambda: store.recognise(MADE[0].complex_par)),
        ("one place", lambda: ask(ONE_PLACE)),
    )
    for label, lookup in lookups if store else ():
        print(f"  {label:<14}{statistics.median(milliseconds(lookup)):10.2f} ms (API)")
    every.sort()
    print(f"  {'p95':<14}{every[int(len(every) * 0.95)]:10.2f} ms over all named questions")


ONE_PLACE = (
    "SELECT ?nlt WHERE { <https://w3id.org/capar/data/observation/o0#location.0> "
    "<https://w3id.org/capar/ontology#goalNlt> ?nlt }"
)


def embedded(folder: Path | None, quads: list[Quad]) -> None:
    """The embedded store, in memory or in a folder."""
    store = EmbeddedStore(folder)
    at = time.perf_counter()
    store.bulk(quads)
    rate = len(quads) / (time.perf_counter() - at)
    actionary = Actionary(store)
    measure("folder" if folder else "memory", actionary, store.ask, rate, len(quads))
    if folder:
        adds = []
        for index in range(20):
            made = replace(drink_from_mug(), capture=f"new{index}")
            at = time.perf_counter()
            actionary.add(made)
            adds.append((time.perf_counter() - at) * 1e3)
        print(f"  {'add, flushed':<14}{statistics.median(adds):10.2f} ms")
    actionary.close()


def rdflib_memory(quads: list[Quad]) -> None:
    """The memory store of rdflib."""
    from rdflib import Graph

    text = "".join(f"{each.triple} .\n" for each in quads)
    graph = Graph()
    at = time.perf_counter()
    graph.parse(data=text, format="nt")
    rate = len(quads) / (time.perf_counter() - at)
    measure("rdflib memory", None, lambda query: list(graph.query(query)), rate, len(quads))


def main() -> None:
    """Measure every size."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--largest", type=int, default=1_000_000, help="up to 10000000")
    parser.add_argument("--rdflib", type=int, default=10_000, help="largest size for rdflib")
    chosen = parser.parse_args()
    size = 10_000
    while size <= chosen.largest:
        quads = list(many(size))
        if size <= chosen.rdflib:
            rdflib_memory(quads)
        embedded(None, quads)
        with tempfile.TemporaryDirectory() as folder:
            embedded(Path(folder) / "actionary", quads)
        size *= 10


if __name__ == "__main__":
    main()
