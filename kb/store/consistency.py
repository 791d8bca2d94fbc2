"""What statements of an observation must agree on beside their shapes: words, times and units."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from functools import lru_cache
from math import isclose, isfinite

from pyoxigraph import Literal, NamedNode, Quad, Triple

from kb.errors import ShapeError
from kb.store.literals import LiteralError, numbers
from kb.store.statements import TYPE
from ontology import BASE, CAPAR, terms

LARGEST_M = 50.0
"""Nothing that somebody handles or stands on is larger than this [m]; 50 mm is, read as metres."""

FRAMES_APART = 2.0
"""How many frames, and a hundredth more, a time may lie from its frame, as clocks are uneven."""

_COMPARED = frozenset(
    {
        *(CAPAR.start, CAPAR.end, CAPAR.duration, CAPAR.frames, CAPAR.rate, CAPAR.size),
        *(CAPAR.firstFrame, CAPAR.lastFrame, CAPAR.frame, CAPAR.time),
    }
)
"""The properties whose values must agree with others of the same thing, or with the capture."""

Said = Mapping[NamedNode, list[object]]


def inconsistencies(statements: Iterable[Triple | Quad]) -> tuple[str, ...]:
    """What contradicts itself in statements, or uses a word of ours that there is not, sorted.

    Each line begins with the thing, a colon and a space, as those of shapes do.
    """
    said: dict[str, dict[NamedNode, list[object]]] = defaultdict(lambda: defaultdict(list))
    found = set()
    for statement in statements:
        if isinstance(statement.subject, NamedNode):
            predicate, value = statement.predicate, statement.object
            if predicate in _COMPARED:
                said[statement.subject.value][predicate].append(value)
            stated = value if predicate == TYPE and isinstance(value, NamedNode) else None
            if words := _unknown_words(predicate, stated):
                found |= {f"{_short(statement.subject.value)}: {word}" for word in words}
    for thing, own in said.items():
        capture = said.get(f"{thing.partition('#')[0]}#capture", {})
        problems = (*_durations(own), *_clock(own), *_times(own, capture), *_sizes(own))
        found |= {f"{_short(thing)}: {problem}" for problem in problems}
    return tuple(sorted(found))


def check_consistent(name: str, statements: Iterable[Triple | Quad]) -> None:
    """Refuse an observation that contradicts itself.

    Raises:
        ShapeError: It does; it says where and how.
    """
    if found := inconsistencies(statements):
        raise ShapeError(f"observation {name!r}", found)


@lru_cache(maxsize=1024)
def _unknown_words(predicate: NamedNode, stated: NamedNode | None) -> tuple[str, ...]:
    """What is wrong with the property, and with the class, if they look like ours and are not."""
    words = [("property", predicate), *([("class", stated)] if stated else [])]
    return tuple(text for kind, word in words if (text := _unknown(kind, word.value)))


def _unknown(kind: str, iri: str) -> str:
    name = iri.removeprefix(BASE)
    if not iri.startswith(BASE) or name in terms():
        return ""
    near = get_close_matches(name, terms(), n=1)
    hint = f" Did you mean capar:{near[0]}?" if near else ""
    return f"The ontology has no {kind} capar:{name}.{hint}"


def _durations(said: Said) -> Iterator[str]:
    start, end, duration = (_number(said, e) for e in (CAPAR.start, CAPAR.end, CAPAR.duration))
    if start is None or end is None or duration is None:
        return
    if not isclose(duration, end - start, rel_tol=1e-6, abs_tol=1e-6):
        yield f"It lasts from {start:g} to {end:g} s, which is not {duration:g} s."


def _clock(said: Said) -> Iterator[str]:
    """What a capture says of its length in frames, in seconds, and of its rate."""
    frames, rate, duration = (
        _number(said, each) for each in (CAPAR.frames, CAPAR.rate, CAPAR.duration)
    )
    if frames is None or rate is None or duration is None:
        return
    if not _near(frames - 1, duration * rate):
        yield f"{frames:g} frames at {rate:g} a second do not last {duration:g} s."


def _times(said: Said, capture: Said) -> Iterator[str]:
    """Times beside the frames that they are the times of, by the rate of the capture."""
    rate = _number(capture, CAPAR.rate)
    pairs = (
        (CAPAR.firstFrame, CAPAR.start),
        (CAPAR.lastFrame, CAPAR.end),
        (CAPAR.frame, CAPAR.time),
    )
    for frame_at, time_at in pairs:
        frame, time = _number(said, frame_at), _number(said, time_at)
        if rate and frame is not None and time is not None and not _near(frame, time * rate):
            yield f"Frame {frame:g} at {rate:g} a second is not at {time:g} s."


def _near(frames: float, others: float) -> bool:
    return abs(frames - others) <= FRAMES_APART + 0.01 * abs(frames)


def _sizes(said: Said) -> Iterator[str]:
    for value in said.get(CAPAR.size, ()):
        try:
            lengths = numbers(value.value) if isinstance(value, Literal) else ()
        except LiteralError:
            continue
        if any(not 0.0 <= each <= LARGEST_M for each in lengths):
            told = " x ".join(f"{each:g}" for each in lengths)
            yield f"A size of {told} m is none of a thing; lengths are in metres."


def _number(said: Said, predicate: NamedNode) -> float | None:
    for value in said.get(predicate, ()):
        try:
            number = float(value.value) if isinstance(value, Literal) else float("nan")
        except ValueError:
            continue
        if isfinite(number):
            return number
    return None


def _short(iri: str) -> str:
    return iri.rsplit("/", 1)[-1]
