"""What statements must obey: the SHACL shapes, NLTs, words, times and units."""

import math
import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache, lru_cache
from math import isclose, isfinite
from typing import Any, TypeAlias

from pyoxigraph import BlankNode, Literal, NamedNode, Quad, Triple

from kb.errors import ShapeError
from kb.store.statements import TYPE, LiteralError, Statements, nlt_of, numbers
from ontology import BASE, CAPAR, terms
from ontology.files import classes_below, ontology_kinds, read, shape_files

SH = "http://www.w3.org/ns/shacl#"
UNIT_TOLERANCE = 1e-3
"""How far an NLT's quaternion may lie from unit length [1]."""

Node = NamedNode | BlankNode | Literal
Kinds: TypeAlias = Callable[[NamedNode], Iterable[object]]
"""The classes of a thing."""

Properties: TypeAlias = Mapping[NamedNode, Collection[Node]]
"""What is said of a thing, by property."""

NLTS = (CAPAR.eeNlt, CAPAR.goalNlt, CAPAR.vNlt)
"""The properties whose values are NLTs."""


@dataclass(frozen=True)
class Rule:
    """What a shape asks of one property of its things."""

    shape: str
    target: NamedNode
    path: NamedNode
    message: str
    least: int
    most: float
    datatype: NamedNode | None
    is_iri: bool
    of_class: NamedNode | None
    among: frozenset[str]
    pattern: re.Pattern[str] | None
    lowest: float
    highest: float
    at_most: NamedNode | None
    """Another property whose value may not be smaller."""


def _text_of(value: Node) -> str:
    assert not isinstance(value, BlankNode)
    return value.value


@cache
def rules() -> tuple[Rule, ...]:
    """What every shape asks, shape by shape."""
    found = []
    for file in shape_files():
        said: dict[object, dict[str, list[Node]]] = {}
        for triple in read(file):
            assert not isinstance(triple.object, Triple)
            name = triple.predicate.value.removeprefix(SH)
            said.setdefault(triple.subject, {}).setdefault(name, []).append(triple.object)
        for node, shape in said.items():
            for target in shape.get("targetClass", ()):
                found += [_rule(str(node), target, said, each) for each in shape["property"]]
    return tuple(found)


def _rule(name: str, target: Node, said: dict[object, dict[str, list[Node]]], node: Node) -> Rule:
    asked = said[node]

    def one(key: str, default: str) -> str:
        return _text_of(asked[key][0]) if key in asked else default

    def term(key: str) -> NamedNode | None:
        return NamedNode(one(key, "")) if key in asked else None

    pattern = one("pattern", "")
    return Rule(
        shape=name,
        target=NamedNode(_text_of(target)),
        path=NamedNode(one("path", "")),
        message=one("message", ""),
        least=int(one("minCount", "0")),
        most=float(one("maxCount", "inf")),
        datatype=term("datatype"),
        is_iri=one("nodeKind", "") == SH + "IRI",
        of_class=term("class"),
        among=frozenset(_list(said, asked["in"][0])) if "in" in asked else frozenset(),
        pattern=re.compile(pattern) if pattern else None,
        lowest=float(one("minInclusive", "-inf")),
        highest=float(one("maxInclusive", "inf")),
        at_most=term("lessThanOrEquals"),
    )


def _list(said: dict[object, dict[str, list[Node]]], node: Node) -> Iterable[str]:
    rdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
    while node in said:
        yield str(said[node][rdf + "first"][0])
        node = said[node][rdf + "rest"][0]


@cache
def _rules_of() -> Mapping[object, tuple[Rule, ...]]:
    """What is asked of the things of each class, and so of those of the classes below it."""
    found: dict[object, tuple[Rule, ...]] = {}
    for rule in rules():
        for kind in (rule.target, *classes_below(rule.target)):
            found[kind] = (*found.get(kind, ()), rule)
    return found


def violations(
    triples: Iterable[Triple | Quad], *, elsewhere: Kinds = lambda thing: ()
) -> tuple[str, ...]:
    """What is wrong with statements by our shapes, a line each, sorted.

    Args:
        triples: The statements.
        elsewhere: The classes of a thing that they refer to and do not state.
    """
    said: dict[object, dict[NamedNode, list[Node]]] = {}
    for triple in triples:
        assert not isinstance(triple.object, Triple)
        said.setdefault(triple.subject, {}).setdefault(triple.predicate, []).append(triple.object)
    return _judged(said, elsewhere)


def _judged(
    things: Mapping[Any, Properties], elsewhere: Kinds = lambda thing: ()
) -> tuple[str, ...]:
    asked = _rules_of()

    def kinds(thing: NamedNode) -> Iterable[object]:
        stated: Iterable[object] = things.get(thing, {}).get(TYPE, ())
        return stated or ontology_kinds().get(thing, ()) or elsewhere(thing)

    found = {
        f"{_short(thing)}: {rule.message}"
        for thing, said in things.items()
        for kind in said.get(TYPE, ())
        for rule in asked.get(kind, ())
        if not _obeys(said, rule, kinds)
    }
    return tuple(sorted(found))


def _obeys(said: Properties, rule: Rule, kinds: Kinds) -> bool:
    values = said.get(rule.path, ())
    if not rule.least <= len(values) <= rule.most:
        return False
    return all(_fits(value, rule, kinds) for value in values) and (
        rule.at_most is None
        or all(_number(a) <= _number(b) for a in values for b in said.get(rule.at_most, ()))
    )


def _is_of_type(value: Node, rule: Rule, kinds: Kinds) -> bool:
    """Whether a value is a thing of the class, or a literal of the datatype, that is asked."""
    if rule.of_class or rule.is_iri:
        named = isinstance(value, NamedNode)
        return named and (rule.of_class is None or _is_of(value, rule.of_class, kinds))
    return not rule.datatype or (isinstance(value, Literal) and value.datatype == rule.datatype)


def _is_of(value: Node, asked: NamedNode, kinds: Kinds) -> bool:
    below = classes_below(asked)
    return isinstance(value, NamedNode) and any(e == asked or e in below for e in kinds(value))


def _fits(value: Node, rule: Rule, kinds: Kinds) -> bool:
    if not _is_of_type(value, rule, kinds):
        return False
    if rule.among and str(value) not in rule.among:
        return False
    if rule.pattern and not (not isinstance(value, BlankNode) and rule.pattern.search(value.value)):
        return False
    if rule.lowest > -math.inf or rule.highest < math.inf:
        return rule.lowest <= _number(value) <= rule.highest
    return True


def _number(value: Node) -> float:
    try:
        return float(_text_of(value))
    except ValueError:
        return math.nan


def nlt_problems(triples: Iterable[Triple | Quad]) -> tuple[str, ...]:
    """NLTs that are no finite place with a unit quaternion, a line each, sorted."""
    found = []
    for triple in triples:
        if isinstance(triple.object, Literal) and triple.object.datatype == CAPAR.nlt:
            problem = nlt_problem(triple.object.value)
            if problem:
                found.append(f"{_short(triple.subject)}: {problem}")
    return tuple(sorted(found))


def nlt_problem(text: str) -> str:
    """What is wrong with an NLT's literal; empty if nothing is."""
    try:
        norm = math.hypot(*nlt_of(text).orientation)
    except LiteralError as error:
        return str(error)
    if abs(norm - 1.0) > UNIT_TOLERANCE:
        return f"NLT {text!r} has a quaternion of length {norm:.4g}; orientations have length 1"
    return ""


def validate_statements(name: str, statements: Statements) -> None:
    """Refuse statements that break the model.

    Raises:
        ShapeError: They do; it says where and how.
    """
    nlts = [
        f"{_short(thing)}: {problem}"
        for thing, said in statements.things.items()
        for each in NLTS
        for value in said.get(each, ())
        if (problem := nlt_problem(value.value))
    ]
    found = (*_judged(statements.things), *sorted(nlts))
    if found:
        raise ShapeError(f"observation {name!r}", found)


def _short(node: object) -> str:
    text = node.value if isinstance(node, NamedNode) else str(node)
    return text.rsplit("/", 1)[-1]


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
    start, end, duration = (
        _number_consistency(said, e) for e in (CAPAR.start, CAPAR.end, CAPAR.duration)
    )
    if start is None or end is None or duration is None:
        return
    if not isclose(duration, end - start, rel_tol=1e-6, abs_tol=1e-6):
        yield f"It lasts from {start:g} to {end:g} s, which is not {duration:g} s."


def _clock(said: Said) -> Iterator[str]:
    """What a capture says of its length in frames, in seconds, and of its rate."""
    frames, rate, duration = (
        _number_consistency(said, each) for each in (CAPAR.frames, CAPAR.rate, CAPAR.duration)
    )
    if frames is None or rate is None or duration is None:
        return
    if not _near(frames - 1, duration * rate):
        yield f"{frames:g} frames at {rate:g} a second do not last {duration:g} s."


def _times(said: Said, capture: Said) -> Iterator[str]:
    """Times beside the frames that they are the times of, by the rate of the capture."""
    rate = _number_consistency(capture, CAPAR.rate)
    pairs = (
        (CAPAR.firstFrame, CAPAR.start),
        (CAPAR.lastFrame, CAPAR.end),
        (CAPAR.frame, CAPAR.time),
    )
    for frame_at, time_at in pairs:
        frame, time = _number_consistency(said, frame_at), _number_consistency(said, time_at)
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


def _number_consistency(said: Said, predicate: NamedNode) -> float | None:
    for value in said.get(predicate, ()):
        try:
            number = float(value.value) if isinstance(value, Literal) else float("nan")
        except ValueError:
            continue
        if isfinite(number):
            return number
    return None


def _short_consistency(iri: str) -> str:
    return iri.rsplit("/", 1)[-1]
