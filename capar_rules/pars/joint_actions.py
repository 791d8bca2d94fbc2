"""What the rules say that several end-effectors do as one action, as values."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from capar.model.observation import JointAction, Segment
from capar_rules.engine.solver import Answer


def joint_actions(
    answer: Answer, segments: Mapping[tuple[str, int], Segment], *, rate_hz: float
) -> tuple[JointAction, ...]:
    """The joint actions of an answer, in order of time.

    Args:
        answer: What the rules derived.
        segments: Every segment by its end-effector and the tick at which it begins.
        rate_hz: Frames a second [Hz].
    """
    parts: dict[Any, list[Segment]] = defaultdict(list)
    for joint, term in answer.of("takes_part"):
        assert isinstance(term, tuple)
        parts[joint].append(segments[str(term[1]), int(str(term[2]))])
    found = [
        _joint(joint, str(name), parts[joint], rate_hz) for joint, name in answer.of("acts_jointly")
    ]
    return tuple(sorted(found, key=lambda each: (each.first, each.last, each.objects)))


def _joint(joint: Any, name: str, parts: Sequence[Segment], rate_hz: float) -> JointAction:
    _, shared, first, last = joint
    own = sorted(parts, key=lambda each: each.ee)
    others = [
        each
        for each in own[0].objects
        if each != shared and all(each in part.objects for part in own)
    ]
    return JointAction(
        name=name,
        objects=(shared, *others),
        ees=tuple(each.ee for each in own),
        segments=tuple(each.index for each in own),
        first=first,
        last=last,
        start_s=first / rate_hz,
        end_s=last / rate_hz,
    )
