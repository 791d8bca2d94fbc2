"""Segments to primitive PARs, uninstantiated and instantiated (thesis 4.6.1)."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from capar.model.observation import Segment
from capar.model.par import (
    Call,
    Condition,
    Constraint,
    CoreSemantics,
    Ipar,
    Motion,
    Preparation,
    Upar,
)
from capar_rules.pars.complex_pars import posture
from capar_rules.pars.inference import Conditions, Inference, Key, Pair

AGENT = "agent"
"""The parameter that stands for the agent."""

EE = "EE"
"""The parameter that stands for the end-effector."""


@dataclass(frozen=True)
class Measured:
    """What was measured of a segment for its core semantics."""

    motion: Motion
    path: tuple[tuple[float, float, float], ...]
    """Where the moved object, or else the end-effector, begins and ends [m]."""


def upars(inference: Inference, measured: Mapping[Key, Measured], *, name: str) -> tuple[Upar, ...]:
    """One UPAR for each name and feature set, from the first segment that has them."""
    found: dict[tuple[str, object], Upar] = {}
    for segment in _segments(inference):
        if segment.known:
            key = (segment.name, segment.features)
            conditions = inference.conditions[segment.ee, segment.index]
            motion = measured[segment.ee, segment.index].motion
            found.setdefault(key, _upar(segment, conditions, motion, name))
    return tuple(sorted(found.values(), key=lambda each: (each.name, each.core.constraint)))


def ipars(
    inference: Inference, measured: Mapping[Key, Measured], *, agent: str, name: str
) -> tuple[Ipar, ...]:
    """One IPAR a segment, links in order.

    Args:
        inference: Segments and their conditions.
        measured: What was measured of each segment.
        agent: Who acts, where a link does not say whose it is.
        name: What the whole action is called.
    """
    agents = {link.ee: link.agent or agent for link in inference.links}
    return tuple(
        _ipar(
            segment,
            inference.conditions[segment.ee, segment.index],
            measured[segment.ee, segment.index],
            agents[segment.ee],
            name,
        )
        for segment in _segments(inference)
    )


def _segments(inference: Inference) -> Iterable[Segment]:
    return (segment for link in inference.links for segment in link.segments)


def _upar(segment: Segment, conditions: Conditions, motion: Motion, parent: str) -> Upar:
    objects = tuple(f"obj{index + 1}" for index in range(len(segment.objects)))
    return Upar(
        name=segment.name,
        agent=AGENT,
        objects=objects,
        general=segment.general,
        applicability=_applicability(AGENT, segment.name, objects),
        preparation=_preparation(conditions, EE, objects, purpose=segment.name),
        steps=(Call(segment.name, objects),),
        core=_core(segment, conditions, EE, objects, motion),
        post_assertions=_post_assertions(conditions, EE, objects),
        parent=parent,
    )


def _ipar(
    segment: Segment, conditions: Conditions, measured: Measured, agent: str, parent: str
) -> Ipar:
    objects, ee = segment.objects, segment.ee
    return Ipar(
        upar=segment.name,
        agent=agent,
        ee=ee,
        objects=objects,
        start_s=segment.start_s,
        core=_core(
            segment,
            conditions,
            ee,
            objects,
            measured.motion,
            path=measured.path,
            purpose=segment.purpose,
            duration_s=segment.end_s - segment.start_s,
            manner=agent,
        ),
        preparation=_preparation(conditions, ee, objects, purpose=segment.name),
        post_assertions=_post_assertions(conditions, ee, objects),
        posture=posture(segment, parent),
        parent=parent,
    )


def _core(
    segment: Segment,
    conditions: Conditions,
    ee: str,
    objects: Sequence[str],
    motion: Motion,
    *,
    path: tuple[tuple[float, float, float], ...] = (),
    purpose: str = "",
    duration_s: float | None = None,
    manner: str = "",
) -> CoreSemantics:
    moves = "1" in segment.features.change_loc
    forced = (name for name, bit in zip(objects, segment.features.force, strict=True) if bit == "1")
    return CoreSemantics(
        motion=motion,
        moved=objects[segment.features.change_loc.index("1")] if moves else "",
        causal=moves and segment.possessed,
        force=tuple(forced),
        path=path,
        purpose=purpose,
        enables=(purpose,) if purpose else (),
        termination=tuple(
            Condition("duration", ()) if pair is None else _contact(pair, ee, objects, holds=holds)
            for pair, holds in conditions.ends_when
        ),
        duration_s=duration_s,
        manner=manner,
        constraint=Constraint(segment.features, conditions.colliding),
    )


def _contact(pair: Pair, ee: str, objects: Sequence[str], *, holds: bool) -> Condition:
    names = tuple(ee if place < 0 else objects[place] for place in pair)
    return Condition("contact", names, holds)


def _applicability(agent: str, name: str, objects: Sequence[str]) -> tuple[Condition, ...]:
    """That the agent can do the action, and each object can undergo it (thesis 4.6.1.4)."""
    return tuple(Condition("capable", (each, name)) for each in (agent, *objects))


def _preparation(
    conditions: Conditions, ee: str, objects: Sequence[str], *, purpose: str
) -> tuple[Preparation, ...]:
    """Conditions with the actions that make them hold; their purpose is this action's name."""
    return tuple(
        Preparation(
            Condition("posture", (AGENT,))
            if pair is None
            else _contact(pair, ee, objects, holds=True),
            Call(action, tuple(objects[place] for place in places), purpose),
        )
        for pair, action, places in conditions.needs
    )


def _post_assertions(
    conditions: Conditions, ee: str, objects: Sequence[str]
) -> tuple[Condition, ...]:
    return tuple(_contact(pair, ee, objects, holds=holds) for pair, holds in conditions.afterwards)
