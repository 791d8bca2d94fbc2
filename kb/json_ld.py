"""JSON-LD with a context, so that its words are short and other programs know them."""

import json
from typing import Any

from ontology import PREFIXES


def with_context(expanded: bytes) -> bytes:
    """Expanded JSON-LD with our prefixes as its context; it states the same."""
    document = {"@context": dict(PREFIXES), "@graph": _compact(json.loads(expanded))}
    return (json.dumps(document, indent=1, ensure_ascii=False) + "\n").encode()


def _compact(value: Any, under: str = "") -> Any:
    """A value with the IRIs short that name its keys, classes, datatypes and things."""
    if isinstance(value, dict):
        return {_short(key): _compact(each, key) for key, each in value.items()}
    if isinstance(value, list):
        return [_compact(each, under) for each in value]
    return _short(value) if under in {"@id", "@type"} else value


def _short(iri: str) -> str:
    for prefix, base in PREFIXES.items():
        name = iri.removeprefix(base)
        if iri.startswith(base) and not name.startswith("//"):
            return f"{prefix}:{name}"
    return iri
