"""The summary of an explanation in one sentence: the name's own conditions first."""

import re
from collections.abc import Iterable, Iterator, Sequence

from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.reason import Reason

BESIDE = ("joins_in(", "looks(", "kept_from(")
"""Prefixes of atoms that accompany a name and are no reason for it."""

_TIME = re.compile(r"\d+\.\d\d s")

FEATURES = "features("
"""Prefix of atoms that primitives share; a primitive's own conditions precede them."""

BORDERS = ("segment(", "border(", "member(")
"""Prefixes of atoms that say where a segment begins and ends, not what it is."""

APART = ("no_contact", "uncounted")
"""Predicates of no contact that counts at a border; where that border lies is no reason."""


def summary(name: str, reason: Reason) -> str:
    """Why a segment has a name, in one sentence."""
    return f"{name}, because {_listed(_leading(reason))}."


def _leading(reason: Reason) -> list[str]:
    """The leading sentences, each once; sentences that differ only in their time are merged."""
    places: dict[str, list[str]] = {}
    for each in _deciding(reason):
        if each.leading:
            text, at, time = each.sentence.rpartition(" at ")
            timed = bool(at and _TIME.fullmatch(time))
            times = places.setdefault(text if timed else each.sentence, [])
            if timed and time not in times:
                times.append(time)
    return [
        f"{text} at {' and '.join(sorted(times, key=_seconds))}" if times else text
        for text, times in places.items()
    ]


def _deciding(reason: Reason) -> list[Reason]:
    """The nodes from which the name follows: first its own conditions, then its features."""
    passed = set[int]()
    own = list(_resting_on([reason], passed))
    shared = [each for each in own if each.atom.startswith(FEATURES)]
    features = [each for top in shared for each in _resting_on(top.because, passed)]
    features += [each for each in own if _rank(each) == 0]
    return [*(each for each in own if _rank(each)), *sorted(features, key=_order)]


def _resting_on(tops: "Iterable[Reason]", passed: set[int]) -> Iterator[Reason]:
    """Nodes from the top, each once, as far down as the features."""
    waiting = list(reversed(list(tops)))
    while waiting:
        each = waiting.pop()
        if each.atom.startswith(BESIDE) or id(each) in passed:
            continue
        passed.add(id(each))
        yield each
        if not each.atom.startswith(FEATURES):
            waiting += [below for below in reversed(each.because) if _bears(each, below)]


def _bears(reason: Reason, below: Reason) -> bool:
    """Whether a child of a node is relevant to the name, not only to where a border is.

    Doubts are relevant to derived atoms, not to the measurements themselves.
    """
    if below.atom.startswith("doubted("):
        return bool(reason.rule)
    return not reason.atom.startswith((*BORDERS, *APART))


def _rank(reason: Reason) -> int:
    """Sort key of features: contacts of the end-effector come first."""
    predicate = reason.atom.partition("(")[0]
    if predicate == "contact_at":
        hand, body = split_arguments(reason.atom)[:2]
        return 0 if hand == body else 2
    if predicate in APART:
        segment, _, body = split_arguments(reason.atom)[:3]
        return 0 if segment.startswith(f"seg({body},") else 2
    return {"moved": 1, "stays": 1}.get(predicate, 3)


def _order(reason: Reason) -> tuple[int, float]:
    """The rank, and among contacts the time: what was so at the start comes first."""
    rank = _rank(reason)
    time = _TIME.search(reason.sentence) if rank in (0, 2) else None
    return rank, _seconds(time[0]) if time else 0.0


def _seconds(time: str) -> float:
    return float(time.removesuffix(" s"))


def _listed(parts: Sequence[str]) -> str:
    if len(parts) < 2:
        return "".join(parts) or "the rules say so"
    return f"{', '.join(parts[:-1])}, and {parts[-1]}"
