"""Observations as pandas data frames; pandas comes with the extra ``frames``."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from importlib import import_module
from typing import Any

from capar.model.errors import CaparError, UnknownNameError
from capar.model.facts import Touching
from capar.model.observation import Observation

Row = dict[str, Any]


def observation_frame(observation: Observation, of: str) -> Any:
    """A DataFrame of an observation.

    Args:
        observation: What was understood of a capture.
        of: ``segments``, ``contacts`` or ``facts``; each is a row.

    Raises:
        UnknownNameError: There is no frame of that.
        CaparError: pandas is not installed.
    """
    if of not in FRAMES:
        raise UnknownNameError("data frame", of, FRAMES)
    columns, rows = FRAMES[of]
    return _pandas().DataFrame(list(rows(observation)), columns=list(columns))


def _pandas() -> Any:
    try:
        return import_module("pandas")
    except ModuleNotFoundError as error:
        if error.name != "pandas":
            raise
        raise CaparError(
            "data frames need pandas, which is not installed; it comes with the extra 'frames': "
            "pip install 'capar[frames]'"
        ) from None


def _segments(observation: Observation) -> Iterator[Row]:
    for segment in observation.segments:
        yield {
            "capture": observation.capture,
            "performer": observation.performer(segment.ee),
            "ee": segment.ee,
            "index": segment.index,
            "name": segment.name,
            "objects": segment.objects,
            "start_s": segment.start_s,
            "end_s": segment.end_s,
            "first": segment.first,
            "last": segment.last,
            "possessed": segment.possessed,
            "purpose": segment.purpose,
            **asdict(segment.features),
        }


def _contacts(observation: Observation) -> Iterator[Row]:
    for fact in observation.facts:
        if isinstance(fact, Touching):
            yield {
                "capture": observation.capture,
                "body": fact.body,
                "other": fact.other,
                "start_s": fact.first / observation.rate_hz,
                "end_s": fact.last / observation.rate_hz,
                "first": fact.first,
                "last": fact.last,
            }


def _facts(observation: Observation) -> Iterator[Row]:
    for fact in observation.facts:
        yield {
            "capture": observation.capture,
            "predicate": fact.predicate,
            "arguments": tuple(asdict(fact).values()),
            "atom": str(fact),
        }


FRAMES: Mapping[str, tuple[tuple[str, ...], Callable[[Observation], Iterator[Row]]]] = {
    "segments": (
        (
            "capture", "performer", "ee", "index", "name", "objects", "start_s", "end_s", "first",
            "last", "possessed", "purpose", "rel_start", "rel_end", "change_loc", "end_effector",
            "force",
        ),
        _segments,
    ),
    "contacts": (
        ("capture", "body", "other", "start_s", "end_s", "first", "last"),
        _contacts,
    ),
    "facts": (("capture", "predicate", "arguments", "atom"), _facts),
}  # fmt: skip
"""Columns and rows of each frame; times [s] take frames as evenly spaced."""
