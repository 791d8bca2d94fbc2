"""BML 1.0: a complex action as a block of behaviours for an embodied conversational agent.

The core of BML has no behaviour that takes a thing. A step is written as a gesture whose lexeme
is the action's name, which a realizer that does not know it refuses with a warning, as the
standard asks; the PAR of the step stands in the gesture's description.
"""

from xml.etree import ElementTree as ET

from capar.export.plan_sources import PlanSource, PlanStep
from ontology import BASE

NAMESPACE = "http://www.bml-initiative.org/bml/bml-1.0"

PAR_NAMESPACE = BASE
"""Of the description of a step."""

MODES = {"right_hand": "RIGHT_HAND", "left_hand": "LEFT_HAND"}
"""Hands of a gesture; other end-effectors have none."""

INFLUENCE = "EYES"
"""What of the body a gaze moves."""

SYNCHRONOUS = {
    "equals": (("start", "start"), ("end", "end")),
    "starts": (("start", "start"),),
    "startedBy": (("start", "start"),),
    "finishes": (("end", "end"),),
    "finishedBy": (("end", "end"),),
    "meets": (("end", "start"),),
    "metBy": (("start", "end"),),
}
"""Pairs of sync points that coincide by an Allen relation."""


def bml(source: PlanSource) -> str:
    """A complex action as the XML text of a BML 1.0 block.

    Steps of a link follow one another, each as long as it was observed; where steps of different
    links begin or end together, a constraint keeps them so. What was looked at is a gaze.

    Args:
        source: The complex action.
    """
    ET.register_namespace("", NAMESPACE)
    ET.register_namespace("par", PAR_NAMESPACE)
    root = ET.Element(
        _core("bml"), id=_identifier(source.name), characterId=source.agent, composition="MERGE"
    )
    for ee, steps in source.links.items():
        for number, planned in enumerate(steps):
            _gesture(root, ee, number, planned, source)
    for number, (target, start, end) in enumerate(source.looks):
        ET.SubElement(
            root,
            _core("gaze"),
            id=f"gaze_{number}",
            target=target,
            influence=INFLUENCE,
            start=_seconds(start),
            end=_seconds(end),
        )
    _constraints(root, source)
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _core(name: str) -> str:
    return f"{{{NAMESPACE}}}{name}"


def _identifier(name: str) -> str:
    return name if name[:1].isalpha() else f"b_{name}"


def _seconds(time: float) -> str:
    return f"{time:.3f}"


def _span(planned: PlanStep, source: PlanSource) -> tuple[float, float]:
    """When a step begins and ends, in whole milliseconds, so that durations add up [s]."""
    begin = planned.step.begin * source.duration_s
    return round(begin, 3), round(begin + planned.step.share * source.duration_s, 3)


def _gesture(root: ET.Element, ee: str, number: int, planned: PlanStep, source: PlanSource) -> None:
    begin, end = _span(planned, source)
    before = f"{ee}_{number - 1}:end" if number else _seconds(begin)
    attributes = {
        "id": f"{ee}_{number}",
        "lexeme": planned.ipar.upar,
        "start": before,
        "end": f"{ee}_{number}:start + {_seconds(end - begin)}",
    }
    if ee in MODES:
        attributes["mode"] = MODES[ee]
    gesture = ET.SubElement(root, _core("gesture"), attributes)
    description = ET.SubElement(
        gesture, _core("description"), priority="1", type="application/x-capar-par+xml"
    )
    ET.SubElement(
        description,
        f"{{{PAR_NAMESPACE}}}step",
        action=planned.ipar.upar,
        ee=planned.ipar.ee,
        objects=" ".join(planned.ipar.objects),
        purpose=planned.ipar.core.purpose,
        posture=planned.ipar.posture,
    )


def _constraints(root: ET.Element, source: PlanSource) -> None:
    """Sync points of different links that coincide, by the Allen relations of the action.

    Numbers in seconds would say the same, but not stay true when a realizer changes a duration.
    """
    for relation in source.par.relations:
        first, second = ("_".join((ee, str(i))) for ee, i in (relation.first, relation.second))
        for one, other in SYNCHRONOUS.get(relation.relation, ()):
            if one == other:
                _synchronize(root, f"{first}:{one}", f"{second}:{other}")
    common = [f"{ee}_{len(steps) - 1}:start" for ee, steps in source.links.items() if steps]
    if source.common and len(common) > 1:
        _synchronize(root, *common)


def _synchronize(root: ET.Element, *points: str) -> None:
    number = len(root.findall(_core("constraint")))
    constraint = ET.SubElement(root, _core("constraint"), id=f"constraint_{number}")
    together = ET.SubElement(constraint, _core("synchronize"))
    for point in points:
        ET.SubElement(together, _core("sync"), ref=point)
