"""Notices as people read them: one a line, many alike as one, reservations by themselves."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from capar.model.notices import KINDS, Notice
from capar.model.observation import Observation
from capar.views.lost_contact import contact_gaps
from capar.views.plain_notices import NAMED, sentences_of
from kb.lexicon.english import capital

HEADING = "Known with reservations:"

LOSS, SUPPORT = "long-gap", "assumed-support"
"""The codes of a body that was not tracked for some time, and of what bears things."""

UNEXPLAINED = frozenset({"mount-gap", "no-mover"})
"""The codes of what moves without contact."""

MOST = 5
"""So many notices of one code are listed one by one."""


def reservations(
    notices: Iterable[Notice], *, about: Collection[str] | None = None
) -> tuple[Notice, ...]:
    """The notices that affect what is reported of some bodies; None is all."""
    return tuple(
        each
        for each in notices
        if KINDS[each.code].several and (about is None or set(each.bodies) & set(about))
    )


def reservations_on_told(observation: Observation) -> tuple[Notice, ...]:
    """The notices that affect a telling.

    Without losses of what neither acts nor is a thing, and supports where nothing can be put. Of a
    thing that moves while no contact is found, when that is, and which hand is taken to have it.
    """
    gaps = contact_gaps(observation)
    told_of = {each.bodies[0] for each in gaps}
    told = {link.ee for link in observation.links} | {thing.name for thing in observation.objects}
    movable = any(thing.tag == "mobile" for thing in observation.objects)
    known = (
        each
        for each in reservations(observation.notices)
        if each.code not in UNEXPLAINED or told_of.isdisjoint(each.bodies)
    )
    return gaps + tuple(
        each
        for each in known
        if (each.code != LOSS or told.intersection(each.bodies))
        and (each.code != SUPPORT or movable)
    )


def note_lines(notices: Iterable[Notice], *, most: int = MOST) -> tuple[str, ...]:
    """Notices one a line; those of a code that has more of them than most as one line."""
    return tuple(
        f"note [{code}]: {text}"
        for code, group in _by_code(notices).items()
        for text in _texts(code, group, most)
    )


def named_in(texts: Iterable[str], bodies: Iterable[str], *, called: Mapping[str, str]) -> set[str]:
    """The bodies of which texts speak by their name, as ``the red cup``."""
    whole = "\n".join(texts)
    names = {body: called.get(body, body.replace("_", " ")) for body in bodies}
    found = set()
    for body, name in sorted(names.items(), key=lambda row: len(row[1]), reverse=True):
        whole, count = re.subn(rf"\bthe {re.escape(name)}\b", "", whole, flags=re.IGNORECASE)
        if count:
            found.add(body)
    return found


def reservation_lines(
    notices: Sequence[Notice],
    *,
    called: Mapping[str, str] = MappingProxyType({}),
    unshaped: Collection[str] | None = None,
) -> tuple[str, ...]:
    """What follows a text whose reservations those are: a gap, a heading, and the notes.

    Args:
        notices: What is known with reservations.
        called: What bodies are called in the text, where that is not their name.
        unshaped: The bodies that have no shape; None where that is not known.
    """
    lacking = None if unshaped is None else {called.get(body, body) for body in unshaped}
    groups = (
        (code, [replace(each, bodies=_called(each, called)) for each in group])
        for code, group in _by_code(notices).items()
    )
    lines = (line for code, group in groups for line in _plain(code, group, lacking))
    return ("", HEADING, *lines) if notices else ()


def _by_code(notices: Iterable[Notice]) -> dict[str, list[Notice]]:
    alike: dict[str, list[Notice]] = {}
    for notice in notices:
        alike.setdefault(notice.code, []).append(notice)
    return alike


def _called(notice: Notice, called: Mapping[str, str]) -> tuple[str, ...]:
    return tuple(called.get(body, body) for body in notice.bodies)


def _plain(code: str, group: Sequence[Notice], unshaped: Collection[str] | None) -> Iterable[str]:
    """What notices of one code mean to whoever reads what was done."""
    said = sentences_of(code, group, unshaped=unshaped)
    return [f"note: {text}." for text in said or map(capital, _texts(code, group, most=1))]


def _texts(code: str, group: Sequence[Notice], most: int) -> Iterable[str]:
    if len(group) <= most:
        return [notice.message for notice in group]
    names = list(dict.fromkeys(" and ".join(notice.bodies).replace("_", " ") for notice in group))
    named = ", ".join(filter(None, names[:NAMED]))
    more = " and others (--json tells all)" if len(names) > NAMED else ""
    what = KINDS[code].several or "alike"
    return [f"{len(group)} {what}{': ' if named else ''}{named}{more}"]
