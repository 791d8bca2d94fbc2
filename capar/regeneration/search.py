"""The whole way from a capture to a verified motion of another body."""

from collections.abc import Callable

from capar.body.human import Human
from capar.regeneration.motion import Guide, Motion, guide_of, perform_plan
from capar.regeneration.paths import Care
from capar.regeneration.planning import Draft, led, reachable
from capar.regeneration.quality import Quality, quality
from capar.regeneration.scenes import PlanError, Scene
from capar.regeneration.sources import Source
from capar.regeneration.styles import Style

CARES = (
    Care(),
    Care(0.03, 0.015),
    Care(0.03, 0.015, 1.0),
    Care(0.05, 0.02, 1.0),
    Care(weight=2.0),
    Care(0.03, 0.015, 1.0, weight=2.0),
)
"""How free hands keep from things, and how firmly hands are led; the next where that fails."""

BY_CARE = {"penetration", "free hand clear", "event position", "event rotation", "on the way"}
"""The gates that more care may mend: a hand that is led firmly for longer arrives in time."""

BY_GRIP = {"on the way", "event position", "event rotation", "penetration"}
"""The gates that another grip may mend."""

GRIPS = 2
"""So often other grips are sought, which reach also where the motion was worst [1]."""


def regenerate(
    source: Source, human: Human, scene: Scene | None = None, style: Style | None = None
) -> tuple[Motion, Quality]:
    """Let a body do in a scene what was recorded; verified at every frame.

    Raises:
        PlanError: It is out of reach or impossible; the message says what would help.
    """
    where = scene or source.scene
    draft = reachable(source, where, human, style, performs=_performs)
    return best_motion(draft, lambda watched: reachable(source, where, human, style, watched))


def best_motion(draft: Draft, again: Callable[[frozenset[int]], Draft]) -> tuple[Motion, Quality]:
    """The motion of a draft that fails fewest gates."""
    best = _careful(draft)
    if not best[1].passed and draft.grips:
        best = min(best, _careful(draft, guide_of(draft)), key=_failures)
    watched: frozenset[int] = frozenset()
    for _ in range(0 if draft.pressed else GRIPS):
        held = [gate for gate in best[1].gates if not gate.passed and gate.name in BY_GRIP]
        if not held or watched.issuperset(gate.frame for gate in held):
            break
        watched |= {gate.frame for gate in held}
        try:
            found = _careful(again(watched))
        except PlanError:
            break
        best = min(best, found, key=_failures)
    return best


def _performs(draft: Draft) -> bool:
    """Whether the motion of a draft passes every gate."""
    return _careful(draft)[1].passed


def _careful(draft: Draft, guide: Guide | None = None) -> tuple[Motion, Quality]:
    """The best motion of some grips, hands being led with more care where it takes that."""
    tried: list[tuple[Motion, Quality]] = []
    for care in CARES:
        motion = perform_plan(led(draft, care), guide)
        tried.append((motion, quality(motion)))
        if not BY_CARE & set(tried[-1][1].failed):
            break
    return min(tried, key=_failures)


def _failures(made: tuple[Motion, Quality]) -> tuple[int, float]:
    """How many gates fail, and by how much of their limits in all."""
    failed = [gate for gate in made[1].gates if not gate.passed]
    beyond = (abs(gate.value - gate.limit) / max(abs(gate.limit), 1e-9) for gate in failed)
    return len(failed), float(sum(beyond))
