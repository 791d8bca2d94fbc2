"""Files of the annotation tools ELAN (.eaf) and Praat (.TextGrid), read by pympi."""

import contextlib
import io
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from capar.model.errors import FileError
from extractors.readers.files import read_bytes

BOMS = ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig"))
"""How a file begins that says its encoding; Praat writes UTF-16 where a text needs it."""

INTERVALS = "IntervalTier"


@dataclass(frozen=True, slots=True)
class Annotation:
    """One annotated interval."""

    tier: str
    start_s: float
    end_s: float
    text: str
    where: str
    """File and line, or the tier and the interval's number where lines are not told."""


def read_elan(path: Path) -> tuple[Annotation, ...]:
    """The time-aligned annotations of every tier of an ELAN file; tiers of references have none.

    Raises:
        FileError: It is no ELAN file, or an annotation has no time.
    """
    from defusedxml import DefusedXmlException
    from defusedxml.ElementTree import ParseError, fromstring
    from pympi import Eaf

    text = read_bytes(path)
    try:
        root = fromstring(text)
    except ParseError as error:
        raise FileError(f"{path}:{error.position[0]}", f"is no XML: {error}.", _ELAN) from None
    except (DefusedXmlException, ValueError) as error:
        raise FileError(path, f"is refused: {error!r}.", _ELAN) from None
    if root.tag != "ANNOTATION_DOCUMENT":
        raise FileError(path, f"holds <{root.tag}>.", _ELAN)
    file = _quietly(path, lambda: Eaf(str(path), suppress_version_warning=True), _ELAN)
    lines = _lines(text.decode("utf-8", "replace"), r'ANNOTATION_ID="([^"]*)"')
    return tuple(
        _aligned(file, path, tier, name, lines)
        for tier, (aligned, *_) in file.tiers.items()
        for name in aligned
    )


def read_praat(path: Path) -> tuple[Annotation, ...]:
    """The intervals with a text, of every interval tier of a TextGrid.

    Raises:
        FileError: It is no TextGrid.
    """
    from pympi import TextGrid

    content = read_bytes(path)
    codec = next((name for bom, name in BOMS if content.startswith(bom)), "utf-8")
    file = _quietly(path, lambda: TextGrid(str(path), codec=codec), _PRAAT)
    tiers = [tier for tier in file.get_tiers() if tier.tier_type == INTERVALS]
    lines = _interval_lines(content.decode(codec, "replace"))
    return tuple(
        Annotation(tier.name, start, end, text, _place(path, tier.name, index, lines))
        for tier in tiers
        for index, (start, end, text) in enumerate(tier.get_intervals(), 1)
        if text.strip()
    )


_ELAN = "Give an ELAN annotation file (.eaf), as ELAN saves it."
_PRAAT = "Give a Praat TextGrid, as Praat saves it."


def _quietly(path: Path, read: Callable[[], Any], remedy: str) -> Any:
    """What pympi reads; it raises bare exceptions of many kinds and may write to the terminal."""
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            return read()
    except Exception as error:  # pympi raises Exception itself, and whatever bytes make of it
        kind = type(error).__name__
        raise FileError(path, f"cannot be read to its end ({kind}: {error}).", remedy) from None


def _aligned(file: Any, path: Path, tier: str, name: str, lines: dict[str, int]) -> Annotation:
    first, last, text, _ = file.tiers[tier][0][name]
    where = f"{path}:{lines[name]}" if name in lines else f"{path}: tier {tier!r}, {name}"
    times = [file.timeslots.get(each) for each in (first, last)]
    if None in times:
        raise FileError(
            where, f"annotation {text!r} on tier {tier!r} has no time of its own.",
            "Align its start and its end to the time line in ELAN.",
        )  # fmt: skip
    start, end = (float(each) / 1000.0 for each in times)
    return Annotation(tier, start, end, text, where)


def _lines(text: str, pattern: str) -> dict[str, int]:
    """The line of each name that a pattern finds."""
    return {
        match.group(1): text.count("\n", 0, match.start()) + 1
        for match in re.finditer(pattern, text)
    }


def _interval_lines(text: str) -> dict[tuple[str, int], int]:
    """The line of each interval of a long TextGrid, by tier and number; a short one has none."""
    out: dict[tuple[str, int], int] = {}
    tier = ""
    for number, line in enumerate(text.splitlines(), 1):
        if match := re.match(r'\s*name = "(.*)"\s*$', line):
            tier = match.group(1).replace('""', '"')
        elif match := re.match(r"\s*intervals \[(\d+)\]", line):
            out[tier, int(match.group(1))] = number
    return out


def _place(path: Path, tier: str, index: int, lines: dict[tuple[str, int], int]) -> str:
    line = lines.get((tier, index))
    return f"{path}:{line}" if line else f"{path}: tier {tier!r}, interval {index}"
