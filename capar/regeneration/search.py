"""The order of search from a capture to a verified motion of another body.

Each step is taken only if the one before does not do.

======  ================================================  ======================================
step    what is tried                                     the case that needs it
======  ================================================  ======================================
goals   one for each object and event                     (no alternative)
grips   the recorded one, turned: smallest turns first    a table or crate of another height
        drawn back along the fingers                      a forearm inside a large object
        turned as the body itself takes the object        palms of recorded living hands
place   the given one, then twelve around it              a wrist at its limit
paths   the recorded one, lifted, drawn back, kept off    a table's edge, the rim of a mug
motion  as planned                                        nearly all
        wider margins of free hands                       a mug cut in passing
        hands led more firmly besides                     a hand that arrives late
        drawn to the key postures of the grips            an elbow that bent the other way
refuse  remedies: nearer, higher, lower, smaller, taller  what is out of reach
======  ================================================  ======================================

``planning`` tries goals, grips and places, ``paths`` the paths; this module tries motions and
keeps the one that fails fewest gates (``quality``).
"""

from dataclasses import replace

from capar.body.human import Human
from capar.regeneration.motion import Guide, Motion, guide_of, perform_plan
from capar.regeneration.paths import Care
from capar.regeneration.planning import Draft, led, reachable
from capar.regeneration.quality import Quality, quality
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source
from capar.regeneration.styles import Style

WIDER = Care(margin_m=0.03, off_m=0.015)
CARES = (Care(), WIDER, replace(WIDER, firm_s=1.0, weight=2.0))
"""How free hands keep from objects, and how firmly hands are led; the next where that fails."""

BY_CARE = {"penetration", "free hand clear", "event position", "event rotation", "on the way"}
"""The gates that more care may mend: a hand that is led firmly for longer arrives in time."""


def regenerate(
    source: Source, human: Human, scene: Scene | None = None, style: Style | None = None
) -> tuple[Motion, Quality]:
    """Let a body do in a scene what was recorded; verified at every frame.

    The recorded scene and style, unless stated.

    Raises:
        PlanError: It is out of reach or impossible; the message says what would help.
    """
    return best_motion(reachable(source, scene or source.scene, human, style))


def best_motion(draft: Draft) -> tuple[Motion, Quality]:
    """The motion of a draft with grips that fails fewest gates."""
    best = _careful(draft)
    if not best[1].passed and draft.grips:
        best = min(best, _careful(draft, guide_of(draft)), key=_failures)
    return best


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
