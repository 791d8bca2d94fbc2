"""Knowledge of what somebody did in a motion capture: observed, explained, stored and queried.

>>> import capar
>>> seen = capar.observe("captures/breakfast")      # a folder with a capture.toml
>>> seen.segments[0].name
'Reach'
>>> print(capar.describe(seen))                     # plain English
>>> print(capar.explain("captures/breakfast", "right_hand/3")[0].summary)
>>> with capar.open_actionary("actionary") as book:
...     book.add(seen)
...     book.ask("hand", action="Reach")

Everything listed in ``__all__`` is imported when it is first used, so that ``import capar`` is
fast. A user's mistake raises ``CaparError``, whose text says what, where and what would have been
right. Times are in seconds, lengths in metres, quaternions w x y z.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path
    from typing import Any

    from capar.model.capture import Capture as Capture
    from capar.model.errors import CaparError as CaparError
    from capar.model.json_form import from_json as from_json
    from capar.model.json_form import to_json as to_json
    from capar.model.observation import Observation as Observation
    from capar.pipelines.explanation import explain as explain
    from capar.pipelines.explanation import why_not as why_not
    from capar.pipelines.language import describe as describe
    from capar.pipelines.many import observe_many as observe_many
    from capar.pipelines.observation import calibrate as calibrate
    from capar.pipelines.observation import observe as observe
    from extractors.readers.bundle.capture_toml import read_capture as read_capture
    from kb.actionary import Actionary as Actionary

__version__ = "0.1.0"

_LAZY = {
    "Actionary": "kb.actionary",
    "CaparError": "capar.model.errors",
    "Capture": "capar.model.capture",
    "Observation": "capar.model.observation",
    "calibrate": "capar.pipelines.observation",
    "describe": "capar.pipelines.language",
    "explain": "capar.pipelines.explanation",
    "from_json": "capar.model.json_form",
    "observe": "capar.pipelines.observation",
    "observe_many": "capar.pipelines.many",
    "read_capture": "extractors.readers.bundle.capture_toml",
    "to_json": "capar.model.json_form",
    "why_not": "capar.pipelines.explanation",
}
"""The module of each public name."""

__all__ = [
    "Actionary",
    "CaparError",
    "Capture",
    "Observation",
    "calibrate",
    "describe",
    "explain",
    "from_json",
    "label",
    "observe",
    "observe_many",
    "open_actionary",
    "read_capture",
    "to_json",
    "why_not",
]


def open_actionary(
    place: "str | Path | None" = None, *, read_only: bool = False, wait_s: float = 0.0
) -> "Actionary":
    """The Actionary at a place: what was observed, to be asked in SPARQL or by named questions.

    Args:
        place: A folder, a server's address, or ``":memory:"`` for one that ends with the process;
            by default ``CAPAR_ACTIONARY``, else ``./actionary``.
        read_only: Whether it is only read, which any number may do beside a writer.
        wait_s: How long to wait for another writer [s].

    Raises:
        LockedError: Another process writes the folder.
        StoreError: There is nothing to read, or it cannot be used.
    """
    from kb.actionary import Actionary

    if place == ":memory:":
        return Actionary.in_memory()
    return Actionary.open(place, read_only=read_only, wait_s=wait_s)


def label(
    captures: "Iterable[Capture | Observation | Path | str]",
    *,
    per_frame: bool = False,
    vocabulary: "Path | str | None" = None,
    rules: str = "extended",
) -> "Iterator[dict[str, Any]]":
    """What was observed as rows: segments, contacts, possessions and motions (docs/labels.md).

    Args:
        captures: Observations, captures, or patterns of their places.
        per_frame: Whether a row is a frame of an end-effector instead.
        vocabulary: A file of rules that map our names to other labels.
        rules: The name of the rule profile to observe with.

    Raises:
        CaparError: A capture or the vocabulary has a fault.
    """
    rows: Iterator[dict[str, Any]] = import_module("capar.evaluation.labelling").label(
        captures, per_frame=per_frame, vocabulary=vocabulary, rules=rules
    )
    return rows


def __getattr__(name: str) -> object:
    """A public name, imported when it is first used (PEP 562)."""
    if name not in _LAZY:
        raise AttributeError(f"module 'capar' has no attribute {name!r}")
    value: object = getattr(import_module(_LAZY[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names, for completion in a shell."""
    return sorted({*globals(), *__all__})
