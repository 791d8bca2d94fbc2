"""Plans for other programs: a complex action and its steps, as a behaviour tree or as BML."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from xml.etree import ElementTree as ET

from capar.model.errors import CaparError
from capar.model.par import ComplexPar, Condition, Ipar, Step, Upar
from ontology import BASE

GENERAL_KIND = "object"
"""The kind of what no kind was stated of."""

HOLDER = "EE"
"""The parameter of a condition that stands for the end-effector."""


class PlanExportError(CaparError):
    """An action that cannot be written as a plan."""


@dataclass(frozen=True, slots=True)
class PlanStep:
    """A step, the instantiated PAR of it, and the uninstantiated one that it is a case of."""

    step: Step
    ipar: Ipar
    upar: Upar

    @property
    def moves(self) -> bool:
        """Whether the step moves its dominant object."""
        return bool(self.ipar.core.moved)

    @property
    def lasts(self) -> bool:
        """Whether it ends when its time is over, rather than when a contact changes."""
        return any(each.kind == "duration" for each in self.upar.core.termination)

    @property
    def rests(self) -> bool:
        """Whether it ends in a posture rather than in a contact."""
        return not any(each.holds for each in self.upar.post_assertions)


@dataclass(frozen=True, slots=True)
class PlanSource:
    """A complex action, whatever it was read from."""

    name: str
    agent: str
    duration_s: float
    links: Mapping[str, tuple[PlanStep, ...]]
    """Steps by end-effector, a step common to all links as the last of each."""

    common: Step | None
    par: ComplexPar
    kinds: Mapping[str, tuple[str, ...]]
    """The kind of every object, and the more general ones above it, nearest first."""

    looks: tuple[tuple[str, float, float], ...] = ()
    """What was looked at, from when to when [s]."""

    @property
    def steps(self) -> tuple[PlanStep, ...]:
        """Every step, link by link."""
        return tuple(each for steps in self.links.values() for each in steps)


def plan_source(
    par: ComplexPar,
    ipars: Iterable[Ipar],
    upars: Iterable[Upar],
    kinds: Mapping[str, tuple[str, ...]],
    *,
    name: str,
    looks: Iterable[tuple[str, float, float]] = (),
) -> PlanSource:
    """A complex action with the PARs of its steps.

    Args:
        par: The complex action.
        ipars: The instantiated actions of its observation, in order of time for each link.
        upars: The uninstantiated actions that they are cases of.
        kinds: Of every object, its kind and those above it.
        name: What the action is called.
        looks: What was looked at, from when to when [s].

    Raises:
        PlanExportError: It has no steps, or a step has no PAR.
    """
    by_link: dict[str, list[Ipar]] = {}
    for each in ipars:
        by_link.setdefault(each.ee, []).append(each)
    known = tuple(upars)
    links = {
        link.ee: tuple(
            _plan_step(step, by_link.get(link.ee, []), known)
            for step in (*link.steps, *([par.common] if par.common else []))
        )
        for link in par.links
    }
    if not any(links.values()):
        raise PlanExportError(f"{name!r} has no steps; observe a capture in which a hand acts")
    agent = next(iter(by_link.values()))[0].agent
    return PlanSource(name, agent, par.duration_s, links, par.common, par, kinds, tuple(looks))


def bound_condition(upar: Upar, ipar: Ipar, condition: Condition) -> tuple[str, ...]:
    """The arguments of a UPAR's condition, as an IPAR binds them."""
    names = dict(zip(upar.objects, ipar.objects, strict=True))
    names |= {upar.agent: ipar.agent, HOLDER: ipar.ee}
    return tuple(names.get(each, each) for each in condition.arguments)


def _plan_step(step: Step, ipars: list[Ipar], upars: tuple[Upar, ...]) -> PlanStep:
    found = [
        each
        for each in ipars
        if each.upar == step.action and (step.ee == "all" or each.objects == step.objects)
    ]
    number = step.segments[0] if step.ee != "all" else -1
    fitting = [ipars[number]] if 0 <= number < len(ipars) else found[-1:]
    if not fitting or fitting[0].upar != step.action:
        raise PlanExportError(f"step {step.action!r} of {step.ee!r} has no PAR of its own")
    (ipar,) = fitting
    for upar in upars:
        same = upar.core.constraint.features == ipar.core.constraint.features
        if upar.name == ipar.upar and same:
            return PlanStep(step, ipar, upar)
    raise PlanExportError(f"no action {ipar.upar!r} with the features of step {step.action!r}")


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
    models = ET.SubElement(root, "TreeNodesModel")
    for name, ports in (dict.fromkeys(_actions(source), PORTS) | CONDITIONS).items():
        model = ET.SubElement(models, "SubTree", ID=name)
        for port in ports:
            ET.SubElement(model, "input_port", name=port, type="std::string")
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
    duration = planned.ipar.core.duration_s
    ET.SubElement(
        sequence,
        "SubTree",
        ID=planned.ipar.upar,
        ee=planned.ipar.ee,
        objects=";".join(planned.ipar.objects),
        purpose=planned.ipar.core.purpose,
        duration_s="" if duration is None else f"{duration:.3f}",
        posture=planned.ipar.posture,
    )
    for condition in planned.upar.post_assertions:
        _condition(sequence, planned, condition)


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
    name = source.name
    root = ET.Element(
        _core("bml"),
        id=name if name[:1].isalpha() else f"b_{name}",
        characterId=source.agent,
        composition="MERGE",
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
            start=f"{start:.3f}",
            end=f"{end:.3f}",
        )
    _constraints(root, source)
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _core(name: str) -> str:
    return f"{{{NAMESPACE}}}{name}"


def _gesture(root: ET.Element, ee: str, number: int, planned: PlanStep, source: PlanSource) -> None:
    """A step; its times are in whole milliseconds, so that durations add up."""
    begin = planned.step.begin * source.duration_s
    end = round(begin + planned.step.share * source.duration_s, 3)
    attributes = {
        "id": f"{ee}_{number}",
        "lexeme": planned.ipar.upar,
        "start": f"{ee}_{number - 1}:end" if number else f"{begin:.3f}",
        "end": f"{ee}_{number}:start + {end - round(begin, 3):.3f}",
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
