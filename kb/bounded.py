"""A query in a process of its own, which ends with the time that the query was given."""

import json
import subprocess
import sys
from pathlib import Path

from kb.answers import Answer, decode
from kb.errors import QueryError, StoreError, TimeLimitError


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
        QueryError: It is no query.
        StoreError: The store does not answer.
        TimeLimitError: It took longer than it may; the process was ended.
    """
    request = {"query": query, "folder": str(folder) if folder else "", "address": address}
    data = json.dumps(request).encode() + b"\n" + dump
    command = [sys.executable, "-P", "-m", "kb.asker"]
    try:
        done = subprocess.run(
            command, input=data, capture_output=True, timeout=seconds, check=False
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
