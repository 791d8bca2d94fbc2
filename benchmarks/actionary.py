"""Load rate and query latency of the Actionary's stores, beside rdflib's memory store, in one run.

``python benchmarks/actionary.py [--smallest 10000] [--largest 1000000] [--rdflib 10000]``: sizes in
tens, a table each, in milliseconds; the last rows ask without SPARQL. rdflib is measured up to 10^4
unless told otherwise: beyond, its joins do not end in useful time.
"""

import argparse
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from observations import drink_from_mug, pick_up_with_both_hands, with_unknown
from pyoxigraph import Quad

from capar.model.observation import Observation
from kb.actionary import Actionary
from kb.encode.observation import encode
from kb.queries.questions import question
from kb.store.names import GRAPHS
from kb.store.stores import EmbeddedStore
from kb.store.updates import VERSION
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
    yield VERSION
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


def answers(store: Actionary | None, ask: Callable[[str], object]) -> dict[str, float]:
    """Milliseconds to answer each question, and the 95th percentile over all of them."""
    every: list[float] = []
    found = {}
    for asked, parameters in ASKED.items():
        query = question(asked).bind(parameters)
        times = milliseconds(lambda query=query: ask(query))
        every += times
        found[asked] = statistics.median(times)
    every.sort()
    found["95 % of all"] = every[int(len(every) * 0.95)]
    if store:
        for label, lookup in (
            ("recognise", lambda: store.recognise(MADE[0].complex_par)),
            ("one place", lambda: ask(ONE_PLACE)),
        ):
            found[label] = statistics.median(milliseconds(lookup))
    return found


ONE_PLACE = (
    "SELECT ?nlt WHERE { <https://w3id.org/capar/data/observation/o0#location.0> "
    "<https://w3id.org/capar/ontology#goalNlt> ?nlt }"
)


def embedded(folder: Path | None, quads: list[Quad]) -> dict[str, float]:
    """The embedded store, in memory or in a folder."""
    store = EmbeddedStore(folder)
    at = time.perf_counter()
    store.bulk(quads)
    rate = len(quads) / (time.perf_counter() - at)
    with Actionary(store) as actionary:
        found = {"triples/s loaded": rate, **answers(actionary, store.ask)}
        if folder:
            adds = []
            for index in range(20):
                made = replace(drink_from_mug(), capture=f"new{index}")
                at = time.perf_counter()
                actionary.add(made)
                adds.append((time.perf_counter() - at) * 1e3)
            found["add, flushed"] = statistics.median(adds)
    return found


def rdflib_memory(quads: list[Quad]) -> dict[str, float]:
    """The memory store of rdflib."""
    from rdflib import Graph

    text = "".join(f"{each.triple} .\n" for each in quads)
    graph = Graph()
    at = time.perf_counter()
    graph.parse(data=text, format="nt")
    rate = len(quads) / (time.perf_counter() - at)
    return {"triples/s loaded": rate, **answers(None, lambda query: list(graph.query(query)))}


def main() -> None:
    """Measure every size."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--smallest", type=int, default=10_000, help="triples")
    parser.add_argument("--largest", type=int, default=1_000_000, help="up to 10000000")
    parser.add_argument("--rdflib", type=int, default=10_000, help="largest size for rdflib")
    chosen = parser.parse_args()
    size = chosen.smallest
    while size <= chosen.largest:
        quads = list(many(size))
        columns = {"rdflib": rdflib_memory(quads)} if size <= chosen.rdflib else {}
        columns["memory"] = embedded(None, quads)
        with tempfile.TemporaryDirectory() as folder:
            columns["folder"] = embedded(Path(folder) / "actionary", quads)
        print(f"\n{f'{len(quads):,} triples':20}" + "".join(f"{name:>14}" for name in columns))
        for row in columns["folder"]:
            cells = (
                f"{found[row]:14,.2f}" if row in found else " " * 14 for found in columns.values()
            )
            print(f"{row:20}{''.join(cells)}", flush=True)
        size *= 10


if __name__ == "__main__":
    main()
