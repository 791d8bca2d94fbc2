"""Notices as people read them: one a line, many alike as one, reservations by themselves."""

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from capar.model.notices import KINDS, Notice
from capar.model.observation import Observation
from capar.views.lost_contact import contact_gaps
from kb.lexicon.english import capital, joined, number, the
from kb.lexicon.wordnet import table

STAYS_M = 0.02
"""What is found again less far than this [m] from where it was lost has stayed, as far as known."""

NAMED = 3
"""Of more bodies, so many are named."""

LIMB = frozenset({"wrist", "palm", "hand"})
"""Names of parts of the body that are hands, beside those of their fingers."""

_NUMBERED = re.compile(r"^\d+ +([A-Za-z][^(]*)\(.*$")
"""What a game's export calls a thing: ``100 half egg carton(Clone)-18146``."""

_SIDED = re.compile(r"^([lr])[_ ]+(.+?)\d*$")
"""What a skeleton calls a part of the body: ``r_middle1``."""


def sentences_of(
    code: str, group: Sequence[Notice], *, unshaped: Collection[str] | None = None
) -> Sequence[str] | None:
    """The notices of one code in plain sentences; None where their messages say it.

    Args:
        code: The code.
        group: The notices.
        unshaped: The bodies that have no shape; None where that is not known.
    """
    if code in BY_DISTANCE:
        return [_by_distance(group, unshaped)]
    said = PLAIN.get(code)
    return None if said is None else list(said(group))


def _spoken(body: str) -> str:
    """A body's name as people say it: without a file's numbers, with its side in words."""
    name = _NUMBERED.sub(r"\1", body).replace("_", " ").strip()
    sided = _SIDED.match(body)
    if sided is None:
        return name
    part = sided[2].replace("_", " ")
    finger = " finger" if part in _parts() - {"palm", "thumb"} else ""
    return f"{'left' if sided[1] == 'l' else 'right'} {part}{finger}"


def _parts() -> frozenset[str]:
    return frozenset(row["part"] for row in table("body_parts") if row["whole"] == "hand")


def _the(body: str) -> str:
    return the(_spoken(body))


def _bodies(group: Sequence[Notice]) -> list[str]:
    return list(dict.fromkeys(body for notice in group for body in notice.bodies))


def _named(bodies: Sequence[str]) -> str:
    """Bodies as a list; of many the first, and how many others there are."""
    names = list(dict.fromkeys(map(_the, bodies)))
    for name in list(names):
        pair = [f"the {side} {name.removeprefix('the right ')}" for side in ("right", "left")]
        if set(pair) <= set(names):
            names[names.index(pair[0])] = f"both {name.removeprefix('the right ')}s"
            names.remove(pair[1])
    left = len(names) - NAMED
    if left <= 1:
        return joined(names)
    return joined([*names[:NAMED], f"{number(left)} others"])


def _lost(group: Sequence[Notice]) -> Iterable[str]:
    return map(_one_lost, group)


def _one_lost(each: Notice) -> str:
    """When a body was not tracked, and what is assumed of it."""
    name, values = capital(_the(each.bodies[0])), dict(each.values)
    if each.start_s is None or each.end_s is None:
        return f"{name} was not tracked at all; what it touched is not known"
    span = f"{each.start_s:.2f} to {each.end_s:.2f} s"
    times = int(values.get("times", 1))
    if times > 1 and "lost_s" in values:
        share = f"for {values['lost_s']:.0f} of {values['of_s']:.0f} s"
        return f"{name} was not tracked {share}; what it did then is not known"
    lost = f"from {span}" if times == 1 else f"{times} times, for longest from {span}"
    if values.get("fixed") or 0.0 <= float(values.get("moved_m", -1.0)) < STAYS_M:
        return f"{name} was not tracked {lost}; it is assumed to have stayed where it was"
    return (
        f"{name} was not tracked {lost}; what touched it before and after is assumed to have "
        "touched it meanwhile"
    )


def _rough(group: Sequence[Notice]) -> Iterable[str]:
    """Whose shapes were assumed."""
    bodies = _bodies(group)
    parts = [each for each in bodies if _SIDED.match(each)]
    if len(parts) <= NAMED:
        named = _named(bodies).replace("both hands", "the hands")
        return [f"The recording has no surfaces of {named}; rough ones are assumed"]
    hands = any({*_spoken(each).split()} & {*LIMB, *_parts()} for each in parts)
    also = ", including the hands" if hands else ""
    return [f"The recording has no surface of the body{also}; a rough one is assumed"]


def _assumed(group: Sequence[Notice]) -> Iterable[str]:
    """Which supports the recording lacks."""
    bodies = _bodies(group)
    if len(bodies) == 1:
        return [f"{capital(_the(bodies[0]))} is assumed: it is not in the recording"]
    neither = "neither is" if len(bodies) == 2 else "none of them is"
    return [f"{capital(_named(bodies))} are assumed: {neither} in the recording"]


def _by_distance(group: Sequence[Notice], unshaped: Collection[str] | None) -> str:
    """Of which bodies contacts are told by how near they are: of those that have no shape."""
    if unshaped is None:
        shared = set.intersection(*(set(each.bodies) for each in group))
        lacking = list(shared) if len(shared) == 1 else []
    else:
        lacking = [body for body in _bodies(group) if body in unshaped]
    if not lacking:
        return "Some contacts are inferred from distance: the recording lacks shapes of some bodies"
    named = _named(lacking)
    which = "of either" if len(lacking) == 2 else "of any of them"
    if len(lacking) == 1:
        which = f"of the {named.split()[-1]}"
    return f"Contacts of {named} are inferred from distance: the recording has no shape {which}"


BY_DISTANCE = frozenset({"pivot-distance", "touch-estimated"})
"""The codes of pairs of bodies whose contacts are told by how near they are."""


def _left_out(group: Sequence[Notice]) -> Iterable[str]:
    """Of what nothing can be told."""
    bodies = _bodies(group)
    one = len({*map(_the, bodies)}) == 1
    are, them = ("is", "it") if one else ("are", "them")
    shapes = "its shape is" if one else "their shapes are"
    left = f"{capital(_named(bodies))} {are} left out, and what was done with {them} is not told"
    return [f"{left}: {shapes} not known"]


def _gap(group: Sequence[Notice]) -> Iterable[str]:
    """What moves as one although it was measured apart."""
    for each in group:
        first, second = map(_the, each.bodies)
        gap_cm = 100.0 * float(each["shown_m"])
        _, side, *part = [*first.split(), "", ""]
        finger = " ".join(filter(None, part))
        if _SIDED.match(each.bodies[0]) and finger.split()[0] in _parts():
            held = f"The {side} hand is assumed to have held {second}"
            yield f"{held}, though that hand's {finger} was measured {gap_cm:.0f} cm from it"
        else:
            moved = f"{capital(first)} and {second} moved as one"
            yield f"{moved}, but were measured {gap_cm:.0f} cm apart"


def _unmoved(group: Sequence[Notice]) -> Iterable[str]:
    """What moves although no contact tells who moves it."""
    for each in group:
        when = "At times" if each.start_s is None or int(each["times"]) > 1 else (
            f"From {each.start_s:.2f} to {each.end_s:.2f} s"
        )  # fmt: skip
        found = "no contact was found that could have moved"
        yield f"{when}, {found} {_the(each.bodies[0])}"


def _unfelt(group: Sequence[Notice]) -> Iterable[str]:
    """When things moved without contact, by thing and hand that is taken to have it."""
    for bodies in dict.fromkeys(each.bodies for each in group):
        when = joined(
            [
                f"from {each.start_s:.2f} to {each.end_s:.2f} s"
                for each in group
                if each.bodies == bodies
            ]
        )
        thing = _the(bodies[0])
        hand = next(the(str(each["called"])) for each in group if each.bodies == bodies)
        found = f"no contact with {thing} was found, although it moved"
        yield f"{capital(when)}, {found}; {hand} is assumed to have held it"


def _stretched(group: Sequence[Notice]) -> Iterable[str]:
    """By how much parts of the body come apart that bones hold together."""
    by_cm = max(100.0 * (float(each["longest_m"]) - float(each["shortest_m"])) for each in group)
    return [f"Joints of the skeleton come apart by up to {by_cm:.0f} cm, which bones do not"]


PLAIN: Mapping[str, Callable[[Sequence[Notice]], Iterable[str]]] = {
    "long-gap": _lost,
    "stand-in-shape": _rough,
    "assumed-support": _assumed,
    "objects-left-out": _left_out,
    "mount-gap": _gap,
    "no-mover": _unmoved,
    "contact-gap": _unfelt,
    "bone-stretches": _stretched,
}
"""What makes plain sentences of the notices of a code; of others the messages are told."""


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
