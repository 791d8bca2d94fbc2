"""A query in a process of its own, which ends with the time that the query was given."""

import json
import math
import subprocess
import sys
from pathlib import Path

from kb.errors import QueryError, StoreError, TimeLimitError
from kb.store.answers import Answer, decode

LONGEST_S = 1e6
"""What a system's clocks can wait for at most; a longer time limit is cut to it [s]."""


def ask(
    query: str,
    *,
    seconds: float,
    folder: Path | None = None,
    dump: bytes = b"",
    address: str = "",
) -> Answer:
    """What a query answers over a folder, a dump of N-Quads or a server.

    Raises:
        QueryError: It is no query, or its time limit is no positive number of seconds.
        StoreError: The store does not answer.
        TimeLimitError: It took longer than it may; the process was ended.
    """
    if not 0.0 < seconds < math.inf:
        raise QueryError(
            f"{seconds:g} s is no time limit; give a positive number of seconds "
            "(--time-limit SECONDS)"
        )
    request = {"query": query, "folder": str(folder) if folder else "", "address": address}
    data = json.dumps(request).encode() + b"\n" + dump
    command = [sys.executable, "-P", "-m", "kb.store.query_worker"]
    try:
        done = subprocess.run(
            command, input=data, capture_output=True, timeout=min(seconds, LONGEST_S), check=False
        )
    except subprocess.TimeoutExpired:
        raise TimeLimitError(seconds) from None
    head, _, body = done.stdout.partition(b"\n")
    if done.returncode != 0 or not head:
        text = done.stderr.decode(errors="replace").strip() or f"exit code {done.returncode}"
        raise StoreError(f"the query's process failed: {text}")
    kind, _, rest = head.decode().partition(" ")
    if kind == "query-error":
        raise QueryError(json.loads(rest))
    if kind == "store-error":
        raise StoreError(json.loads(rest))
    return decode(rest, body)
