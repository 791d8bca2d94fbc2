"""What statements must obey: the SHACL shapes, NLTs, words of the ontology, times and units."""

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from typing import TypeAlias

from pyoxigraph import BlankNode, Literal, NamedNode, Quad, Triple

from kb.errors import ShapeError
from kb.store.statements import TYPE, LiteralError, nlt_of, numbers
from ontology import BASE, CAPAR, terms
from ontology.files import classes_below, ontology_kinds, read, shape_files
from ontology.namespace import RDF

SH = "http://www.w3.org/ns/shacl#"
UNIT_TOLERANCE = 1e-3
"""How far an NLT's quaternion may lie from unit length [1]."""

Node = NamedNode | BlankNode | Literal
Kinds: TypeAlias = Callable[[NamedNode], Iterable[object]]
"""The classes of a thing."""

Properties: TypeAlias = Mapping[NamedNode, Collection[Node]]
"""What is said of a thing, by property."""

Things: TypeAlias = Mapping[NamedNode, Properties]
"""What is said, by thing and property."""

LARGEST_M = 50.0
"""Nothing that somebody handles or stands on is larger than this [m]; 50 mm is, read as metres."""

FRAMES_APART = 2.0
"""How many frames, and a hundredth more, a time may lie from its frame, as clocks are uneven."""


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
    while node in said:
        yield str(said[node][RDF + "first"][0])
        node = said[node][RDF + "rest"][0]


@cache
def _rules_of() -> Mapping[object, tuple[Rule, ...]]:
    """What is asked of the things of each class, and so of those of the classes below it."""
    found: dict[object, tuple[Rule, ...]] = {}
    for rule in rules():
        for kind in (rule.target, *classes_below(rule.target)):
            found[kind] = (*found.get(kind, ()), rule)
    return found


def faults(things: Things, *, elsewhere: Kinds = lambda thing: ()) -> tuple[str, ...]:
    """What is wrong with statements, a line each, sorted: the thing, a colon, and the fault.

    Args:
        things: The statements (``by_thing``).
        elsewhere: The classes of a thing that they refer to and do not state.
    """
    found = {*violations(things, elsewhere=elsewhere)}
    for thing, said in things.items():
        broken = [*_nlt_problems(said)]
        if isinstance(thing, NamedNode):
            whole = NamedNode(f"{thing.value.partition('#')[0]}#capture")
            broken += [*_contradictions(said, things.get(whole, {})), *_unknown_words(said)]
        found |= {f"{short(thing)}: {each}" for each in broken}
    return tuple(sorted(found))


def violations(things: Things, *, elsewhere: Kinds = lambda thing: ()) -> tuple[str, ...]:
    """What is wrong with statements by our shapes alone, as lines."""
    asked = _rules_of()

    def kinds(thing: NamedNode) -> Iterable[object]:
        stated: Iterable[object] = things.get(thing, {}).get(TYPE, ())
        return stated or ontology_kinds().get(thing, ()) or elsewhere(thing)

    found = {
        f"{short(thing)}: {rule.message}"
        for thing, said in things.items()
        for kind in said.get(TYPE, ())
        for rule in asked.get(kind, ())
        if not _obeys(said, rule, kinds)
    }
    return tuple(sorted(found))


def by_thing(statements: Iterable[Triple | Quad]) -> Things:
    """Statements by what they are about, and by property."""
    said: dict[NamedNode, dict[NamedNode, list[Node]]] = {}
    for each in statements:
        if not isinstance(each.subject, Triple) and not isinstance(each.object, Triple):
            own = said.setdefault(each.subject, {})  # type: ignore[arg-type]
            own.setdefault(each.predicate, []).append(each.object)
    return said


def check_statements(name: str, things: Things) -> None:
    """Refuse statements that break the model.

    Raises:
        ShapeError: They do; it says where and how.
    """
    if found := faults(things):
        raise ShapeError(f"observation {name!r}", found)


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


def _nlt_problems(said: Properties) -> Iterator[str]:
    """NLTs that are no finite place with a unit quaternion."""
    for values in said.values():
        for each in values:
            if isinstance(each, Literal) and each.datatype == CAPAR.nlt:
                try:
                    norm = math.hypot(*nlt_of(each.value).orientation)
                except LiteralError as error:
                    yield str(error)
                    continue
                if abs(norm - 1.0) > UNIT_TOLERANCE:
                    yield (
                        f"NLT {each.value!r} has a quaternion of length {norm:.4g}; "
                        "orientations have length 1"
                    )


def _unknown_words(said: Properties) -> Iterator[str]:
    """Properties and classes that look like ours and are not."""
    words = [("property", each) for each in said]
    words += [("class", each) for each in said.get(TYPE, ()) if isinstance(each, NamedNode)]
    for kind, word in words:
        if problem := _unknown(kind, word.value):
            yield problem


@cache
def _unknown(kind: str, iri: str) -> str:
    name = iri.removeprefix(BASE)
    if not iri.startswith(BASE) or name in terms():
        return ""
    near = get_close_matches(name, terms(), n=1)
    hint = f" Did you mean capar:{near[0]}?" if near else ""
    return f"The ontology has no {kind} capar:{name}.{hint}"


def _contradictions(said: Properties, capture: Properties) -> Iterator[str]:
    """Durations, times, frames and sizes that do not agree, by the rate of the capture."""
    start, end, lasts = (_first(said, e) for e in (CAPAR.start, CAPAR.end, CAPAR.duration))
    if abs(lasts - (end - start)) > max(1e-6, 1e-6 * abs(lasts)):
        yield f"It lasts from {start:g} to {end:g} s, which is not {lasts:g} s."
    frames, own_rate = _first(said, CAPAR.frames), _first(said, CAPAR.rate)
    if _apart(frames - 1, lasts * own_rate):
        yield f"{frames:g} frames at {own_rate:g} a second do not last {lasts:g} s."
    rate = _first(capture, CAPAR.rate)
    for frame_at, time_at in (
        (CAPAR.firstFrame, CAPAR.start),
        (CAPAR.lastFrame, CAPAR.end),
        (CAPAR.frame, CAPAR.time),
    ):
        frame, time = _first(said, frame_at), _first(said, time_at)
        if _apart(frame, time * rate):
            yield f"Frame {frame:g} at {rate:g} a second is not at {time:g} s."
    for value in said.get(CAPAR.size, ()):
        try:
            lengths = numbers(value.value) if isinstance(value, Literal) else ()
        except LiteralError:
            continue
        if any(not 0.0 <= each <= LARGEST_M for each in lengths):
            stated = " x ".join(f"{each:g}" for each in lengths)
            yield f"A size of {stated} m is impossible; lengths are in metres."


def _apart(frames: float, others: float) -> bool:
    return abs(frames - others) > FRAMES_APART + 0.01 * abs(frames)


def _first(said: Properties, predicate: NamedNode) -> float:
    """The first finite number that a property has; else NaN, of which nothing is said."""
    found = (_number(value) for value in said.get(predicate, ()) if isinstance(value, Literal))
    return next((each for each in found if math.isfinite(each)), math.nan)


def short(node: object) -> str:
    """A thing's name within the data."""
    text = node.value if isinstance(node, NamedNode) else str(node)
    return text.rsplit("/", 1)[-1]
