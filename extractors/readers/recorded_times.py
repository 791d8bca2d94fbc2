"""When files say that they were recorded, as ISO 8601."""

import re
from datetime import UTC, date, datetime, timedelta

_FORMS = ("%Y-%m-%d, %H:%M:%S.%f", "%Y-%m-%d, %H:%M:%S")
"""Those of Qualisys, beside ISO 8601."""

EARLIEST = datetime(1990, 1, 1, tzinfo=UTC)
"""Stamps since 1970 that are earlier count from when a computer or a simulation started."""


def iso_time(text: str) -> str:
    """A date, or a date and time, as ISO 8601; empty if the text is neither.

    What the text leaves open, such as the time of day or the time zone, stays open.
    """
    stripped = text.strip()
    if re.fullmatch(r"\d{4}-\d\d-\d\d", stripped):
        try:
            return date.fromisoformat(stripped).isoformat()
        except ValueError:
            return ""
    try:
        return _iso(datetime.fromisoformat(stripped))
    except ValueError:
        pass
    for form in _FORMS:
        try:
            return _iso(datetime.strptime(stripped, form))
        except ValueError:
            continue
    return ""


def iso_of_stamp(nanoseconds: int) -> str:
    """Nanoseconds since 1970 as ISO 8601 in UTC, to the microsecond; empty before ``EARLIEST``."""
    try:
        time = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(microseconds=nanoseconds // 1000)
    except OverflowError:
        return ""
    return _iso(time) if time >= EARLIEST else ""


def _iso(time: datetime) -> str:
    """The time with as many decimals as it needs; of UTC with ``Z``."""
    decimals = "milliseconds" if time.microsecond else "seconds"
    whole = time.isoformat(timespec="microseconds" if time.microsecond % 1000 else decimals)
    return whole.replace("+00:00", "Z")
