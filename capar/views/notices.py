"""Notices as people read them: one a line, many alike as one, those told that bear on the truth."""

import re
from collections.abc import Collection, Iterable, Sequence

from capar.model.capture import Notice

HEADING = "Known with reservations:"

RESERVATIONS = {
    "long-gap": "bodies lost for long",
    "markers-not-rigid": "bodies whose markers are not rigid",
    "stand-in-shape": "stand-in shapes",
    "no-shape": "bodies without a shape",
    "objects-left-out": "groups of objects left out",
    "assumed-support": "assumed supports",
    "pivot-distance": "pairs that touch by the distance of their origins",
}
"""Codes of notices without which what is told would be taken for more certain than it is, each
with what many of it are called."""

MOST = 5
"""So many notices of one code are told one by one."""

NAMED = 3
"""Of more, so many are named."""

_ABOUT = re.compile(r"'(\w+)'(?: and '(\w+)')?|(\w+)(?: with (\w+))?:")


def bodies(notice: Notice) -> tuple[str, ...]:
    """The bodies that a notice begins with; none where it is about something else."""
    found = _ABOUT.match(notice.message)
    return tuple(each for each in found.groups() if each) if found else ()


def reservations(
    notices: Iterable[Notice], *, about: Collection[str] | None = None
) -> tuple[Notice, ...]:
    """The notices that bear on the truth of what is told of some bodies; None is all."""
    return tuple(
        each
        for each in notices
        if each.code in RESERVATIONS and (about is None or set(bodies(each)) & set(about))
    )


def note_lines(notices: Iterable[Notice]) -> tuple[str, ...]:
    """Notices one a line; those of a code that has more than five of them as one line."""
    alike: dict[str, list[Notice]] = {}
    for each in notices:
        alike.setdefault(each.code, []).append(each)
    return tuple(
        f"note [{code}]: {text}" for code, group in alike.items() for text in _texts(code, group)
    )


def reservation_lines(notices: Sequence[Notice]) -> tuple[str, ...]:
    """What follows a text whose reservations those are: a gap, a heading, and the notes."""
    return ("", HEADING, *note_lines(notices)) if notices else ()


def _texts(code: str, group: Sequence[Notice]) -> Iterable[str]:
    if len(group) <= MOST:
        return [each.message for each in group]
    names = list(dict.fromkeys(" and ".join(bodies(each)) for each in group))
    named = ", ".join(filter(None, names[:NAMED])) + (" …" if len(names) > NAMED else "")
    what = RESERVATIONS.get(code, "alike")
    return [f"{len(group)} {what}{': ' if named else ''}{named}; --json lists them"]
