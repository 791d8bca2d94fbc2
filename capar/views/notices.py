"""Notices as people read them: one a line, many alike as one, reservations under a heading."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from types import MappingProxyType

from capar.model.notices import KINDS, Notice
from capar.model.observation import Observation
from kb.lexicon.english import capital

HEADING = "Known with reservations:"

MOST = 5
"""Up to so many notices of one code are listed one by one."""

NAMED = 3
"""Up to so many bodies are named."""

BY_DISTANCE = "contacts are inferred from distance, as shapes are missing: {bodies}"
PLAIN: Mapping[str, str] = {
    "long-gap": "not tracked {when}, so that what it did then is assumed: {bodies}",
    "stand-in-shape": "no surface was recorded, so that a rough one is assumed: {bodies}",
    "assumed-support": "not in the recording, but assumed: {bodies}",
    "objects-left-out": "left out, as the shape is not known: {bodies}",
    "mount-gap": "moved as one, though measured {shown_cm:.0f} cm apart: {bodies}",
    "no-mover": "moved {when} without a contact that explains it: {bodies}",
    "bone-stretches": "joints of the skeleton come apart by up to {stretch_cm:.0f} cm",
    "pivot-distance": BY_DISTANCE,
    "touch-estimated": BY_DISTANCE,
}
"""What the notices of a code say together to whoever reads what was done; those of other codes are
given by their messages. ``bodies``, ``when`` and lengths come from the notices' fields."""

_NUMBERED = re.compile(r"^\d+ +([A-Za-z][^(]*)\(.*$")
"""What a game's export calls an object: ``100 half egg carton(Clone)-18146``."""

_SIDED = re.compile(r"^([lr])[_ ]+(.+?)\d*$")
"""What a skeleton calls a part of the body: ``r_middle1``."""


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
    """The notices that affect a description.

    Left out are losses of what neither acts nor is an object, and supports where nothing can move.
    """
    described = {link.ee for link in observation.links}
    described |= {thing.name for thing in observation.objects}
    movable = any(thing.tag == "mobile" for thing in observation.objects)
    return tuple(
        each
        for each in reservations(observation.notices)
        if (each.code != "long-gap" or described.intersection(each.bodies))
        and (each.code != "assumed-support" or movable)
    )


def note_lines(notices: Iterable[Notice], *, most: int = MOST) -> tuple[str, ...]:
    """Notices one a line; those of a code that has more of them than most as one line."""
    return tuple(
        f"note [{code}]: {text}"
        for code, group in _by_code(notices).items()
        for text in _texts(code, group, most)
    )


def reservation_lines(
    notices: Sequence[Notice],
    *,
    called: Mapping[str, str] = MappingProxyType({}),
    unshaped: Collection[str] | None = None,
) -> tuple[str, ...]:
    """What follows a text whose reservations those are: a gap, a heading, and the notes.

    Args:
        notices: The reservations.
        called: What bodies are called in the text, where that is not their name.
        unshaped: The bodies that have no shape; None where that is not known.
    """
    lines = []
    for code, group in _by_code(notices).items():
        bodies = list(dict.fromkeys(body for notice in group for body in notice.bodies))
        if code in PLAIN and PLAIN[code] == BY_DISTANCE and unshaped is not None:
            bodies = [body for body in bodies if body in unshaped] or bodies
        names = list(dict.fromkeys(_spoken(body, called) for body in bodies))
        left = len(names) - NAMED
        texts: Iterable[str] = _texts(code, group, most=1)
        if code in PLAIN:
            named = ", ".join(names[:NAMED]) + (f" and {left} more" if left > 0 else "")
            texts = [PLAIN[code].format(bodies=named, when=_when(group), **_lengths(group))]
        lines += [f"note: {capital(text)}." for text in texts]
    return ("", HEADING, *lines) if notices else ()


def _by_code(notices: Iterable[Notice]) -> dict[str, list[Notice]]:
    alike: dict[str, list[Notice]] = {}
    for notice in notices:
        alike.setdefault(notice.code, []).append(notice)
    return alike


def _spoken(body: str, called: Mapping[str, str]) -> str:
    """A body's name as people say it: without a file's numbers, with its side in words."""
    if body in called:
        return called[body]
    sided = _SIDED.match(body)
    if sided is None:
        return _NUMBERED.sub(r"\1", body).replace("_", " ").strip()
    return f"{'left' if sided[1] == 'l' else 'right'} {sided[2].replace('_', ' ')}"


def _when(group: Sequence[Notice]) -> str:
    """When something was so: the interval of the longest notice, and how many others there are."""
    times = [(n.start_s, n.end_s) for n in group if n.start_s is not None and n.end_s is not None]
    if not times:
        return "at any time"
    start_s, end_s = max(times, key=lambda each: each[1] - each[0])
    more = sum(int(dict(notice.values).get("times", 1)) for notice in group) - 1
    others = f" and {more} more time{'s' * (more > 1)}" if more > 0 else ""
    return f"from {start_s:.2f} to {end_s:.2f} s{others}"


def _lengths(group: Sequence[Notice]) -> dict[str, float]:
    """The greatest gap between bodies, and by how much bones stretch [cm]."""
    values = [dict(notice.values) for notice in group]
    gaps = [float(each.get("shown_m", 0.0)) for each in values]
    stretches = [
        float(each.get("longest_m", 0.0)) - float(each.get("shortest_m", 0.0)) for each in values
    ]
    return {"shown_cm": 100.0 * max(gaps), "stretch_cm": 100.0 * max(stretches)}


def _texts(code: str, group: Sequence[Notice], most: int) -> Iterable[str]:
    if len(group) <= most:
        return [notice.message for notice in group]
    names = list(dict.fromkeys(" and ".join(notice.bodies).replace("_", " ") for notice in group))
    named = ", ".join(filter(None, names[:NAMED]))
    more = " and others (--json tells all)" if len(names) > NAMED else ""
    what = KINDS[code].several or "alike"
    return [f"{len(group)} {what}{': ' if named else ''}{named}{more}"]
