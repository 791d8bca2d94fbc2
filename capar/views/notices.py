"""Notices as people read them: one a line, many alike as one, reservations by themselves."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence

from capar.model.notices import KINDS, Notice
from kb.lexicon.english import joined, number

HEADING = "Known with reservations:"

MOST = 5
"""So many notices of one code are listed one by one."""

_NUMBERED = re.compile(r"^\d+ +([A-Za-z][^(]*)\(.*$")
"""What a game's export calls a thing: ``100 half egg carton(Clone)-18146``."""

NAMED = 3
"""Of more, so many are named."""


def reservations(
    notices: Iterable[Notice], *, about: Collection[str] | None = None
) -> tuple[Notice, ...]:
    """The notices that affect what is reported of some bodies; None is all."""
    return tuple(
        each
        for each in notices
        if KINDS[each.code].several and (about is None or set(each.bodies) & set(about))
    )


def note_lines(notices: Iterable[Notice], *, most: int = MOST) -> tuple[str, ...]:
    """Notices one a line; those of a code that has more of them than most as one line."""
    return tuple(
        f"note [{code}]: {text}"
        for code, group in _by_code(notices).items()
        for text in _texts(code, group, most)
    )


def reservation_lines(
    notices: Sequence[Notice], names: Mapping[str, str] | None = None
) -> tuple[str, ...]:
    """What follows a text whose reservations those are: a gap, a heading, and the notes.

    Args:
        notices: The reservations.
        names: What the text calls bodies, where it is not their name.
    """
    called = names or {}
    groups = _by_code(notices).items()
    lines = (line for code, group in groups for line in _plain(code, group, called))
    return ("", HEADING, *lines) if notices else ()


def _by_code(notices: Iterable[Notice]) -> dict[str, list[Notice]]:
    alike: dict[str, list[Notice]] = {}
    for notice in notices:
        alike.setdefault(notice.code, []).append(notice)
    return alike


def _plain(code: str, group: Sequence[Notice], called: Mapping[str, str]) -> Iterable[str]:
    """What notices of one code mean to whoever reads what was done."""
    if KINDS[code].plain:
        names = [*dict.fromkeys(name for notice in group for name in _about(notice, called))]
        left = len(names) - NAMED
        others = f"{number(left)} other{'s' if left > 1 else ''}"
        named = joined([*names[:NAMED], others] if left > 0 else names)
        return [f"note: {KINDS[code].plain.format(names=named)}"]
    return [f"note: {text}" for text in _texts(code, group, most=1)]


def _about(notice: Notice, called: Mapping[str, str]) -> Iterable[str]:
    """What it is about, as people call it: each of its bodies, or one with another."""
    names = [f"the {called.get(body) or _called(body)}" for body in notice.bodies]
    return names if KINDS[notice.code].listed else (" with ".join(names),)


def _called(body: str) -> str:
    """A body's name without numbers of a file's before it, and what stands in brackets after it."""
    return _NUMBERED.sub(r"\1", body).replace("_", " ").strip()


def _texts(code: str, group: Sequence[Notice], most: int) -> Iterable[str]:
    if len(group) <= most:
        return [notice.message for notice in group]
    names = list(dict.fromkeys(" and ".join(notice.bodies).replace("_", " ") for notice in group))
    named = ", ".join(filter(None, names[:NAMED]))
    more = " and others (--json tells all)" if len(names) > NAMED else ""
    what = KINDS[code].several or "alike"
    return [f"{len(group)} {what}{': ' if named else ''}{named}{more}"]
