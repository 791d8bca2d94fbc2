"""What the BML 1.0 standard says of the elements that a plan may consist of, and a check.

From the standard's chapters on blocks, synchronisation, gaze, gesture, pointing, posture and
locomotion: the core elements, their attributes with the values that are closed lists, their sync
points, and what may stand in them.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.etree import ElementTree as ET

NAMESPACE = "http://www.bml-initiative.org/bml/bml-1.0"
STROKES = ("start", "ready", "strokeStart", "stroke", "strokeEnd", "relax", "end")
HELD = ("start", "ready", "relax", "end")
SIMPLE = ("start", "end")
HANDS = ("LEFT_HAND", "RIGHT_HAND", "BOTH_HANDS")
BODY = ("EYES", "HEAD", "SHOULDER", "WAIST", "WHOLE")


@dataclass(frozen=True)
class Behaviour:
    """An element that is a behaviour."""

    points: tuple[str, ...]
    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    values: dict[str, tuple[str, ...]] = field(default_factory=dict)
    children: tuple[str, ...] = ("description",)


BEHAVIOURS = {
    "gesture": Behaviour(STROKES, ("lexeme",), ("mode",), {"mode": HANDS}),
    "pointing": Behaviour(STROKES, ("target",), ("mode",), {"mode": HANDS}),
    "gaze": Behaviour(
        HELD,
        ("target",),
        ("influence", "offsetAngle", "offsetDirection"),
        {"influence": BODY},
    ),
    "posture": Behaviour(HELD, children=("stance", "pose", "description")),
    "locomotion": Behaviour(SIMPLE, ("target",), ("manner",)),
    "head": Behaviour(STROKES, ("lexeme",), ("repetition", "amount")),
}
BLOCK = {"id", "characterId", "composition"}
COMPOSITIONS = {"MERGE", "APPEND", "REPLACE"}
RELATIONS = {"synchronize": set(), "before": {"ref"}, "after": {"ref"}}
REFERENCE = re.compile(r"(?:(?P<behaviour>[A-Za-z]\w*):(?P<point>\w+)(?: [+-] \d+(?:\.\d+)?)?)")


def check_bml(text: str) -> ET.Element:
    """Check a block, element by element; the first breach is an assertion that names it."""
    root = ET.fromstring(text)
    assert root.tag == _core("bml"), root.tag
    assert "id" in root.attrib
    assert set(root.attrib) <= BLOCK, root.attrib
    assert root.get("composition", "MERGE") in COMPOSITIONS
    kinds = {each.get("id"): _name(each) for each in root}
    assert None not in kinds, "every behaviour and constraint has an id"
    assert len(kinds) == len(root), "ids are unique in a block"
    for each in root:
        if _name(each) == "constraint":
            _check_constraint(each, kinds)
        else:
            _check_behaviour(each, kinds)
    return root


def _core(name: str) -> str:
    return f"{{{NAMESPACE}}}{name}"


def _name(element: ET.Element) -> str:
    assert element.tag.startswith(f"{{{NAMESPACE}}}"), f"{element.tag} is no core element"
    return element.tag.removeprefix(f"{{{NAMESPACE}}}")


def _check_behaviour(element: ET.Element, kinds: dict[str, str]) -> None:
    name = _name(element)
    assert name in BEHAVIOURS, f"<{name}> is no core behaviour"
    says = BEHAVIOURS[name]
    allowed = {"id", *says.points, *says.required, *says.optional}
    assert set(element.attrib) <= allowed, f"<{name}> has {set(element.attrib) - allowed}"
    assert set(says.required) <= set(element.attrib), f"<{name}> lacks one of {says.required}"
    for attribute, values in says.values.items():
        assert element.get(attribute, values[0]) in values, element.attrib
    for point in says.points:
        if point in element.attrib:
            _check_time(element.attrib[point], kinds)
    for child in element:
        assert _name(child) in says.children, child.tag
        assert {"priority", "type"} <= set(child.attrib), "a description has priority and type"
        assert all(not inner.tag.startswith(f"{{{NAMESPACE}}}") for inner in child)


def _check_constraint(element: ET.Element, kinds: dict[str, str]) -> None:
    assert set(element.attrib) <= {"id"}
    assert len(element), "a constraint constrains something"
    for relation in element:
        name = _name(relation)
        assert name in RELATIONS, name
        assert set(relation.attrib) == RELATIONS[name], relation.attrib
        references = [each.get("ref", "") for each in relation]
        assert len(references) >= (2 if name == "synchronize" else 1)
        for each, reference in zip(relation, references, strict=True):
            assert _name(each) == "sync"
            assert REFERENCE.fullmatch(reference), reference
            _check_time(reference, kinds)


def _check_time(value: str, kinds: dict[str, str]) -> None:
    """A number of seconds since the block began, or a sync point of a behaviour in it."""
    found = REFERENCE.fullmatch(value)
    if not found:
        assert float(value) >= 0.0, value
        return
    kind = kinds.get(found["behaviour"])
    assert kind is not None, f"{value}: no behaviour {found['behaviour']!r}"
    assert found["point"] in BEHAVIOURS[kind].points, f"{value}: no sync point of <{kind}>"


def times_of(root: ET.Element) -> dict[str, dict[str, float]]:
    """When each behaviour begins and ends, references followed [s]."""
    stated = {each.get("id", ""): each for each in root if _name(each) != "constraint"}

    def at(value: str) -> float:
        found = REFERENCE.fullmatch(value)
        if not found:
            return float(value)
        offset = float(value.rpartition(" + ")[2]) if " + " in value else 0.0
        return at(stated[found["behaviour"]].get(found["point"], "0")) + offset

    return {
        name: {point: at(each.attrib[point]) for point in SIMPLE if point in each.attrib}
        for name, each in stated.items()
    }


def synchronized(root: ET.Element) -> Iterator[list[tuple[str, str]]]:
    """The sync points that each constraint keeps together."""
    for each in root.iter(_core("synchronize")):
        yield [tuple(sync.get("ref", "").split(":")) for sync in each]
