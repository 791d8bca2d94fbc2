"""What statements must obey: the SHACL shapes, NLTs, words of the ontology, times and units."""

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from typing import Any, TypeAlias

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


@cache
def rules() -> tuple[Rule, ...]:
    """What every shape asks, shape by shape."""
    found = []
    for file in shape_files():
        said: dict[object, dict[str, list[Any]]] = {}
        for triple in read(file):
            name = triple.predicate.value.removeprefix(SH)
            said.setdefault(triple.subject, {}).setdefault(name, []).append(triple.object)
        for node, shape in said.items():
            for target in shape.get("targetClass", ()):
                for asked in (said[each] for each in shape["property"]):

                    def one(key: str, default: Any = None, asked: Any = asked) -> Any:
                        return asked[key][0] if key in asked else default

                    among = set()
                    link = one("in")
                    while link in said:
                        among.add(str(said[link][RDF + "first"][0]))
                        link = said[link][RDF + "rest"][0]
                    pattern = one("pattern")
                    found.append(
                        Rule(
                            shape=str(node),
                            target=target,
                            path=one("path"),
                            message=one("message").value,
                            least=int(one("minCount", Literal(0)).value),
                            most=float(one("maxCount", Literal("inf")).value),
                            datatype=one("datatype"),
                            is_iri=one("nodeKind") == NamedNode(SH + "IRI"),
                            of_class=one("class"),
                            among=frozenset(among),
                            pattern=pattern and re.compile(pattern.value),
                            lowest=float(one("minInclusive", Literal("-inf")).value),
                            highest=float(one("maxInclusive", Literal("inf")).value),
                            at_most=one("lessThanOrEquals"),
                        )
                    )
    return tuple(found)


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
            broken += _contradictions(said, things.get(whole, {}))
            words = [("property", each) for each in said]
            words += [("class", each) for each in said.get(TYPE, ())]  # type: ignore[misc]
            broken += filter(None, (_unknown(kind, word.value) for kind, word in words))
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
    """Refuse statements that break the model, with a ShapeError."""
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


def _fits(value: Node, rule: Rule, kinds: Kinds) -> bool:
    """Whether a value is of the class or datatype, and in the range, that are asked."""
    if rule.of_class or rule.is_iri:
        if not isinstance(value, NamedNode):
            return False
        if rule.of_class:
            asked = {rule.of_class, *classes_below(rule.of_class)}
            if asked.isdisjoint(kinds(value)):
                return False
    elif rule.datatype and not (isinstance(value, Literal) and value.datatype == rule.datatype):
        return False
    named = not rule.among or str(value) in rule.among
    if not named or (rule.pattern and not rule.pattern.search(value.value)):
        return False
    if rule.lowest > -math.inf or rule.highest < math.inf:
        return rule.lowest <= _number(value) <= rule.highest
    return True


def _number(value: Node) -> float:
    try:
        return float(value.value)
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


@cache
def _unknown(kind: str, iri: str) -> str:
    name = iri.removeprefix(BASE)
    if not iri.startswith(BASE) or name in terms():
        return ""
    near = get_close_matches(name, terms(), n=1)
    hint = f" Did you mean capar:{near[0]}?" if near else ""
    return f"The ontology has no {kind} capar:{name}.{hint}"


_AGREEING = frozenset(
    {CAPAR.duration, CAPAR.frames, CAPAR.firstFrame, CAPAR.lastFrame, CAPAR.frame, CAPAR.size}
)
"""Properties of which one at least is of each two that may not agree."""


def _contradictions(said: Properties, capture: Properties) -> Iterator[str]:
    """Durations, times, frames and sizes that do not agree, by the rate of the capture."""
    if said.keys().isdisjoint(_AGREEING):
        return
    start, end, lasts = (_first(said, e) for e in (CAPAR.start, CAPAR.end, CAPAR.duration))
    if abs(lasts - (end - start)) > max(1e-6, 1e-6 * abs(lasts)):
        yield f"It lasts from {start:g} to {end:g} s, which is not {lasts:g} s."

    def apart(frames: float, others: float) -> bool:
        return abs(frames - others) > FRAMES_APART + 0.01 * abs(frames)

    frames, own_rate = _first(said, CAPAR.frames), _first(said, CAPAR.rate)
    if apart(frames - 1, lasts * own_rate):
        yield f"{frames:g} frames at {own_rate:g} a second do not last {lasts:g} s."
    rate = _first(capture, CAPAR.rate)
    for frame_at, time_at in (
        (CAPAR.firstFrame, CAPAR.start),
        (CAPAR.lastFrame, CAPAR.end),
        (CAPAR.frame, CAPAR.time),
    ):
        frame, time = _first(said, frame_at), _first(said, time_at)
        if apart(frame, time * rate):
            yield f"Frame {frame:g} at {rate:g} a second is not at {time:g} s."
    for value in said.get(CAPAR.size, ()):
        try:
            lengths = numbers(value.value) if isinstance(value, Literal) else ()
        except LiteralError:
            continue
        if any(not 0.0 <= each <= LARGEST_M for each in lengths):
            stated = " x ".join(f"{each:g}" for each in lengths)
            yield f"A size of {stated} m is impossible; lengths are in metres."


def _first(said: Properties, predicate: NamedNode) -> float:
    """The first finite number that a property has; else NaN, of which nothing is said."""
    found = (_number(value) for value in said.get(predicate, ()) if isinstance(value, Literal))
    return next((each for each in found if math.isfinite(each)), math.nan)


def short(node: object) -> str:
    """A thing's name within the data."""
    text = node.value if isinstance(node, NamedNode) else str(node)
    return text.rsplit("/", 1)[-1]
