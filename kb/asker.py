"""The process that asks one query: a request on standard input, an answer on standard output."""

import json
import sys
from pathlib import Path
from typing import BinaryIO

from pyoxigraph import RdfFormat
from pyoxigraph import Store as Oxigraph

from kb import answers
from kb.errors import QueryError, StoreError
from kb.reading_folder import read

LONGEST = 160
"""Letters of a parser's complaint that are worth reading."""


def answer(source: BinaryIO) -> bytes:
    """The answer to a request: a line that says its kind, then its bytes."""
    request = json.loads(source.readline())
    try:
        media_type, data = _ask(request, source)
    except (QueryError, SyntaxError) as error:
        return b"query-error " + json.dumps(_short(str(error))).encode()
    except (StoreError, OSError) as error:
        return b"store-error " + json.dumps(str(error)).encode()
    return f"answer {media_type}\n".encode() + data


def _short(problem: str) -> str:
    """A parser's complaint without the rest of what it would have taken."""
    first = problem.splitlines()[0] if problem else ""
    return "no SPARQL: " + (first if len(first) <= LONGEST else first[:LONGEST] + " ...")


def _ask(request: dict[str, str], source: BinaryIO) -> tuple[str, bytes]:
    if request["address"]:
        from kb.remote import post_query

        return post_query(request["address"], request["query"])
    if request["folder"]:
        return read(Path(request["folder"]), lambda store: _evaluated(store, request["query"]))[0]
    store = Oxigraph()
    store.bulk_load(input=source.read(), format=RdfFormat.N_QUADS)
    return _evaluated(store, request["query"])


def _evaluated(store: Oxigraph, query: str) -> tuple[str, bytes]:
    return answers.encode(store.query(query, use_default_graph_as_union=True))


def main() -> None:
    """Answer the one request."""
    sys.stdout.buffer.write(answer(sys.stdin.buffer))


if __name__ == "__main__":
    main()
