"""Time to load the lexicon and to answer verbs, once the whole of it is in a store.

Run by hand: ``python benchmarks/words.py [--json] [--verbs 100] [--verbnet DIR]``. VerbNet is read
from the folder named, else from ``$CAPAR_LINGUISTICS/verbnet-3.4``, else from ``verbnet-3.4`` in
``../shared/linguistics`` beside the checkout; where there is none, verbs are of WordNet alone.
"""

import argparse
import json
import os
import random
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import TypeVar

from capar.pipelines.linguistic_report import answer_verb, primitive_files, primitive_words
from kb.lexicon.loading import load_verbnet, load_words
from kb.lexicon.verbnet import read_verbnet
from kb.lexicon.wordnet import WordNet, compressed_lines, wordnet
from kb.store.stores import Store, open_store

Value = TypeVar("Value")

SHARED = Path(__file__).parents[2] / "shared" / "linguistics"
VERBNET = Path(os.environ.get("CAPAR_LINGUISTICS", SHARED)) / "verbnet-3.4"
SEED = 5


def timed(work: Callable[[], Value]) -> tuple[float, Value]:
    """A piece of work with its time [s]."""
    start = perf_counter()
    value = work()
    return perf_counter() - start, value


def loading(store: Store, verbnet: Path) -> tuple[dict[str, float], list[str]]:
    """Seconds to read and to load each source of words, and the verbs that there are then."""
    words = primitive_words(primitive_files())
    rows = {
        "read WordNet's verbs": timed(lambda: WordNet(compressed_lines("wordnet-3.1-verbs")))[0]
    }
    rows["load WordNet, Levin and links"] = timed(lambda: load_words(store, words))[0]
    rows["see that they are loaded"] = timed(lambda: load_words(store, words))[0]
    if not verbnet.is_dir():
        return rows, sorted(wordnet().lemmas)
    rows["read VerbNet"], classes = timed(lambda: read_verbnet(verbnet))
    rows["load VerbNet"] = timed(lambda: load_verbnet(store, classes, wordnet()))[0]
    members = {m.lemma for top in classes for each in top.family for m in each.members}
    return rows, sorted(each for each in members if wordnet().of_lemma(each))


def answering(store: Store, verbs: list[str]) -> dict[str, tuple[float, float]]:
    """Milliseconds to answer each verb for the first time and for the second."""
    words = primitive_words(primitive_files())
    answer_verb("move", words, store=store)

    def once(verb: str) -> float:
        return 1e3 * timed(lambda: answer_verb(verb, words, store=store))[0]

    return {verb: (once(verb), once(verb)) for verb in verbs}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument("--verbs", type=int, default=100, help="how many verbs are sampled")
    parser.add_argument("--verbnet", type=Path, default=VERBNET, help="folder of VerbNet's classes")
    options = parser.parse_args()
    store = open_store(None)
    loads, known = loading(store, options.verbnet)
    verbs = random.Random(SEED).sample(known, min(options.verbs, len(known)))
    times = answering(store, verbs)
    first = [each[0] for each in times.values()]
    again = [each[1] for each in times.values()]
    slowest = max(times, key=lambda each: times[each][0])
    figures = {
        "load_s": loads,
        "verbs": len(verbs),
        "median_ms": median(first),
        "slowest_ms": max(first),
        "slowest_verb": slowest,
        "median_again_ms": median(again),
        "slowest_again_ms": max(again),
        "over_100_ms": sum(each > 100.0 for each in first),
    }
    if options.json:
        print(json.dumps(figures, indent=2))
        return
    for what, seconds in loads.items():
        print(f"{what:32}{seconds:8.3f} s")
    print(f"{f'answer one of {len(verbs)} verbs':32}{'median':>10}{'slowest':>10}")
    print(f"{'  the first time':32}{median(first):7.1f} ms{max(first):7.1f} ms  ({slowest})")
    print(f"{'  again':32}{median(again):7.1f} ms{max(again):7.1f} ms")


if __name__ == "__main__":
    main()
