"""The lexicon's shipped tables, read as rows by column."""

import csv
import gzip
from functools import cache
from importlib.resources import files

FOLDER = files("ontology") / "lexicon"
"""Where the words' data files lie."""


@cache
def table(name: str) -> tuple[dict[str, str], ...]:
    """The rows of a shipped ``NAME.tsv``, each by the names of its columns."""
    text = (FOLDER / f"{name}.tsv").read_text(encoding="utf-8")
    rows = csv.DictReader(text.splitlines(), delimiter="\t", quoting=csv.QUOTE_NONE)
    return tuple(rows)


def compressed_lines(name: str) -> list[str]:
    """The lines of a shipped ``NAME.tsv.gz``."""
    packed = (FOLDER / f"{name}.tsv.gz").read_bytes()
    return gzip.decompress(packed).decode("utf-8").splitlines()
