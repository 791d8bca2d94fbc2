"""BehaviorTree.CPP 4: a complex action as a tree that a robot's executive loads and ticks.

Every action and condition is a subtree of its own with the arguments as its blackboard entries,
since leaves that are registered by a function alone declare no ports. A subtree holds one leaf,
``DoReach`` or ``IsContact``, in the place of which an executive puts what its robot does.
"""

from xml.etree import ElementTree as ET

from capar.export.plan_sources import HOLDER, PlanSource, PlanStep, bound_condition
from capar.model.par import Condition

FORMAT = "4"

CONDITIONS = {
    "Contact": ("first", "second"),
    "NoContact": ("first", "second"),
    "Posture": ("agent",),
    "Capable": ("who", "action"),
}
"""Conditions that the executive has to check, with their arguments."""

PORTS = ("ee", "objects", "purpose", "duration_s", "posture")
"""What every action is told."""


def behavior_tree(source: PlanSource) -> str:
    """A complex action as the XML text of BehaviorTree.CPP 4.

    Links go side by side, each a sequence of its steps. A step is a sequence: applicability,
    each preparatory specification as a fallback (it holds already, or its action makes it hold),
    the action itself, and its post-assertions.

    Args:
        source: The complex action.
    """
    main = f"{source.name}Main" if source.name in _actions(source) else source.name
    root = ET.Element("root", BTCPP_format=FORMAT, main_tree_to_execute=main)
    tree = ET.SubElement(root, "BehaviorTree", ID=main)
    links = {ee: steps for ee, steps in source.links.items() if steps}
    holder = tree
    if len(links) > 1:
        count = {"success_count": "-1", "failure_count": "1"}
        holder = ET.SubElement(tree, "Parallel", {"name": "links", **count})
    for ee, steps in links.items():
        sequence = ET.SubElement(holder, "Sequence", name=ee)
        for planned in steps:
            _step(sequence, planned)
    for action in _actions(source):
        leaf = ET.SubElement(root, "BehaviorTree", ID=action)
        ET.SubElement(leaf, "Action", ID=f"Do{action}")
    for condition in CONDITIONS:
        leaf = ET.SubElement(root, "BehaviorTree", ID=condition)
        ET.SubElement(leaf, "Condition", ID=f"Is{condition}")
    _models(ET.SubElement(root, "TreeNodesModel"), source)
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _step(parent: ET.Element, planned: PlanStep) -> None:
    sequence = ET.SubElement(parent, "Sequence", name=f"{planned.ipar.upar} step")
    for condition in planned.upar.applicability:
        _condition(sequence, planned, condition)
    for preparation in planned.upar.preparation:
        fallback = ET.SubElement(sequence, "Fallback")
        _condition(fallback, planned, preparation.condition)
        names = dict(zip(planned.upar.objects, planned.ipar.objects, strict=True))
        objects = (names.get(name, name) for name in preparation.action.objects)
        ET.SubElement(
            fallback,
            "SubTree",
            ID=preparation.action.action,
            ee=planned.ipar.ee,
            objects=";".join(objects),
            purpose=preparation.action.purpose,
            duration_s="",
            posture="",
        )
    _action(sequence, planned)
    for condition in planned.upar.post_assertions:
        _condition(sequence, planned, condition)


def _action(parent: ET.Element, planned: PlanStep) -> None:
    duration = planned.ipar.core.duration_s
    ET.SubElement(
        parent,
        "SubTree",
        ID=planned.ipar.upar,
        ee=planned.ipar.ee,
        objects=";".join(planned.ipar.objects),
        purpose=planned.ipar.core.purpose,
        duration_s="" if duration is None else f"{duration:.3f}",
        posture=planned.ipar.posture,
    )


def _condition(parent: ET.Element, planned: PlanStep, condition: Condition) -> None:
    """A condition as a leaf; one that must not hold is the leaf of its opposite."""
    if condition.kind == "duration":
        return
    name = {"contact": "Contact", "posture": "Posture", "capable": "Capable"}[condition.kind]
    if condition.kind == "contact" and not condition.holds:
        name = "NoContact"
    values = bound_condition(planned.upar, planned.ipar, condition)
    ports = dict(zip(CONDITIONS[name], values, strict=True))
    if name == "Posture":
        ports["agent"] = planned.ipar.ee if condition.arguments[0] != HOLDER else values[0]
    ET.SubElement(parent, "SubTree", {"ID": name, **ports})


def _actions(source: PlanSource) -> list[str]:
    """Every action that the tree calls, those of preparatory specifications included."""
    used = {planned.ipar.upar for planned in source.steps}
    prepared = {p.action.action for planned in source.steps for p in planned.upar.preparation}
    return sorted(used | prepared)


def _models(parent: ET.Element, source: PlanSource) -> None:
    """What the subtrees are told, for editors of trees."""
    subtrees = dict.fromkeys(_actions(source), PORTS) | CONDITIONS
    for name, ports in subtrees.items():
        model = ET.SubElement(parent, "SubTree", ID=name)
        for port in ports:
            ET.SubElement(model, "input_port", name=port, type="std::string")
