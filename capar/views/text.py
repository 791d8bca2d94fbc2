"""PARs as text that people read and compare line by line: one statement a line."""

from collections.abc import Iterable, Sequence
from functools import singledispatch

from capar.model.observation import Observation
from capar.model.par import (
    Call,
    ComplexPar,
    Condition,
    Constraint,
    CoreSemantics,
    Ipar,
    Motion,
    Preparation,
    Step,
    Upar,
)
from capar.views.tables import (
    aligned,
    force_lines,
    joint_lines,
    segment_rows,
    segments_table,
    step_rows,
    steps_table,
)

__all__ = [
    "call",
    "condition",
    "force_lines",
    "joint_lines",
    "observation_text",
    "par_text",
    "preparation",
    "segment_rows",
    "segments_table",
    "step_rows",
    "steps_table",
]

Line = tuple[str, str]
"""What is stated, and what it is."""

END_EFFECTOR = -1
"""The index that stands for the end-effector among colliding objects (thesis Fig 4.16)."""


@singledispatch
def par_text(par: object) -> str:
    """A UPAR, an IPAR or a complex PAR as lines; equal PARs give equal text.

    Numbers are rounded: times to a millisecond, places to a millimetre, shares to 0.0001.
    """
    raise TypeError(f"{type(par).__name__} is no PAR")


@par_text.register
def _upar(par: Upar) -> str:
    head = f"UPAR {call(Call(par.name, (par.agent, *par.objects)))}"
    lines = [
        *_each("specialises", par.general),
        *_each("applicable if", map(condition, par.applicability)),
        *_each("prepare", map(preparation, par.preparation)),
        *_each("step", map(call, par.steps)),
        *_core(par.core, par.objects),
        *_each("afterwards", map(condition, par.post_assertions)),
        *_each("part of", filter(None, [par.parent])),
    ]
    return _block(head, lines)


@par_text.register
def _ipar(par: Ipar) -> str:
    lines = [
        ("end-effector", par.ee),
        ("start", f"{par.start_s:.3f} s"),
        *_each("prepare", map(preparation, par.preparation)),
        *_core(par.core, par.objects),
        *_each("afterwards", map(condition, par.post_assertions)),
        *_each("posture", filter(None, [par.posture])),
        *_each("part of", filter(None, [par.parent])),
    ]
    return _block(f"IPAR {call(Call(par.upar, (par.agent, *par.objects)))}", lines)


@par_text.register
def _complex(par: ComplexPar) -> str:
    head = f"COMPLEX PAR {call(Call(par.name or 'unnamed', par.objects))}, {par.duration_s:.3f} s"
    out = [head]
    rows = [_step(step) for link in par.links for step in link.steps]
    rows += [_step(par.common)] if par.common else []
    table = iter(aligned(rows, right={3, 4}))
    for link in par.links:
        out += [f"  {link.ee} in sequence", *(f"    {next(table)}" for _ in link.steps)]
    if par.common:
        out += ["  all together, last", f"    {next(table)}"]
    out += [
        f"  {_place(each.first)} {each.relation} {_place(each.second)}" for each in par.relations
    ]
    return "\n".join(out) + "\n"


def observation_text(observation: Observation) -> str:
    """The segments, joint actions, forces, complex PAR, UPARs and IPARs of an observation."""
    parts = [
        "\n".join(aligned(segment_rows(observation), right={1, 2})) + "\n",
        *filter(None, ["".join(f"{line}\n" for line in joint_lines(observation))]),
        *filter(None, ["".join(f"{line}\n" for line in force_lines(observation))]),
        par_text(observation.complex_par),
        *map(par_text, observation.upars),
        *map(par_text, observation.ipars),
    ]
    return "\n".join(parts)


def call(value: Call) -> str:
    """An action with its arguments: ``Reach(mug) for PickUp``."""
    purpose = f" for {value.purpose}" if value.purpose else ""
    return f"{value.action}({', '.join(value.objects)}){purpose}"


def condition(value: Condition) -> str:
    """A condition: ``contact(EE, obj1)``, or ``not contact(EE, obj1)``."""
    return ("" if value.holds else "not ") + f"{value.kind}({', '.join(value.arguments)})"


def preparation(value: Preparation) -> str:
    """A condition, and what is done where it does not hold."""
    return f"{condition(value.condition)}, else {call(value.action)}"


def _core(core: CoreSemantics, objects: Sequence[str]) -> list[Line]:
    moved = f" of {core.moved}" if core.moved else ""
    caused = ", caused by the agent" if core.causal else ""
    motion = "none" if core.motion is Motion.NONE else f"{core.motion.value}{moved}{caused}"
    duration = "a parameter" if core.duration_s is None else f"{core.duration_s:.3f} s"
    return [
        ("motion", motion),
        *_each("force on", core.force),
        *_each("path", (f"({x:.3f}, {y:.3f}, {z:.3f}) m" for x, y, z in core.path)),
        *_each("purpose", filter(None, [core.purpose])),
        *_each("enables", core.enables),
        *_each("until", map(condition, core.termination)),
        ("duration", duration),
        *_each("manner of", filter(None, [core.manner])),
        *_constraint(core.constraint, objects),
    ]


def _constraint(constraint: Constraint, objects: Sequence[str]) -> list[Line]:
    features = constraint.features
    names = {END_EFFECTOR: "EE", **dict(enumerate(objects))}
    pair = " with ".join(names.get(each, f"#{each}") for each in constraint.colliding_objects)
    return [
        ("collides", pair),
        ("relations at start", features.rel_start or "-"),
        ("relations at end", features.rel_end or "-"),
        ("changes location", features.change_loc or "-"),
        ("force", features.force or "-"),
        ("end-effector type", features.end_effector),
    ]


def _step(step: Step) -> tuple[str, ...]:
    return (
        call(Call(step.action, step.objects)),
        f"for {step.purpose}" if step.purpose else "",
        f"to posture {step.posture}" if step.posture else "",
        f"from {step.begin:.4f}",
        f"share {step.share:.4f}",
    )


def _place(place: tuple[str, int]) -> str:
    return f"{place[0]}[{place[1]}]"


def _each(name: str, values: Iterable[str]) -> list[Line]:
    """A line for each value, each with the name, so that a change shows as one line."""
    return [(name, each) for each in values]


def _block(head: str, lines: Sequence[Line]) -> str:
    return "\n".join([head, *(f"  {each}" for each in aligned(lines))]) + "\n"
