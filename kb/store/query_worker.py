"""The process that asks one query: a request on standard input, an answer on standard output."""

import json
import re
import sys
from pathlib import Path
from typing import BinaryIO

from pyoxigraph import RdfFormat
from pyoxigraph import Store as Oxigraph

from capar.model.errors import UnknownNameError
from kb.errors import QueryError, StoreError
from kb.store import answers, sparql
from kb.store.stores import evaluated, read

LONGEST = 160
"""After how many letters a parser's message is cut."""

NOT_ACCEPTED = {"LATERAL", "SERVICE", "[_]"}
"""What a parser expects but a query may not use, and its sign for the end of a query."""

_NO_FUNCTION = re.compile(r"custom function <([^>]*)> is not supported")


def answer(source: BinaryIO) -> bytes:
    """The answer to a request: a line that says its kind, then its bytes."""
    request = json.loads(source.readline())
    try:
        media_type, data = _ask(request, source)
    except (QueryError, SyntaxError) as error:
        return b"query-error " + json.dumps(user_message(str(error))).encode()
    except (StoreError, OSError) as error:
        return b"store-error " + json.dumps(str(error)).encode()
    return f"answer {media_type}\n".encode() + data


def user_message(problem: str) -> str:
    """A parser's message in short; an unknown function with the names of those that exist."""
    if slip := _NO_FUNCTION.search(problem):
        ours = [f"capar:{each}" for each in (*sparql.FUNCTIONS, *sparql.ARITIES)]
        known = [*ours, "those of SPARQL"]
        return str(UnknownNameError("function", answers.short(slip[1]), known))
    first = problem.splitlines()[0] if problem else ""
    place, expected, listed = first.partition("expected ")
    if expected:
        taken = [e for e in listed.removeprefix("one of ").split(", ") if e not in NOT_ACCEPTED]
        several = "one of " if len(taken) > 1 else ""
        missing = "something is missing here or before"
        first = place + (expected + several + ", ".join(taken) if taken else missing)
    return "no SPARQL: " + (first if len(first) <= LONGEST else first[:LONGEST] + " ...")


def _ask(request: dict[str, str], source: BinaryIO) -> tuple[str, bytes]:
    if request["address"]:
        from kb.store.stores import post_query, query_copy

        if sparql.opens_tracks(request["query"]):
            return answers.encode(query_copy(request["address"], request["query"]))
        return post_query(request["address"], request["query"])
    if request["folder"]:
        return read(Path(request["folder"]), lambda store: _evaluated(store, request["query"]))[0]
    store = Oxigraph()
    store.bulk_load(input=source.read(), format=RdfFormat.N_QUADS)
    return _evaluated(store, request["query"])


def _evaluated(store: Oxigraph, query: str) -> tuple[str, bytes]:
    try:
        return answers.encode(evaluated(store, query))
    except RuntimeError as error:
        if _NO_FUNCTION.search(str(error)):
            raise QueryError(str(error)) from None
        raise


def main() -> None:
    """Answer the one request."""
    sys.stdout.buffer.write(answer(sys.stdin.buffer))


if __name__ == "__main__":
    main()
