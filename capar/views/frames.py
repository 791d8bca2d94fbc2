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
    for each in observation.segments:
        yield {
            "capture": observation.capture,
            "performer": observation.performer(each.ee),
            "ee": each.ee,
            "index": each.index,
            "name": each.name,
            "objects": each.objects,
            "start_s": each.start_s,
            "end_s": each.end_s,
            "first": each.first,
            "last": each.last,
            "possessed": each.possessed,
            "purpose": each.purpose,
            **asdict(each.features),
        }


def _contacts(observation: Observation) -> Iterator[Row]:
    for each in observation.facts:
        if isinstance(each, Touching):
            yield {
                "capture": observation.capture,
                "body": each.body,
                "other": each.other,
                "start_s": each.first / observation.rate_hz,
                "end_s": each.last / observation.rate_hz,
                "first": each.first,
                "last": each.last,
            }


def _facts(observation: Observation) -> Iterator[Row]:
    for each in observation.facts:
        yield {
            "capture": observation.capture,
            "predicate": each.predicate,
            "arguments": tuple(asdict(each).values()),
            "atom": str(each),
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
