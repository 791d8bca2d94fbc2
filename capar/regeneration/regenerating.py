"""The whole way from a capture to a verified motion of another body."""

from capar.body.human import Human
from capar.regeneration.motions import Motion, perform_plan
from capar.regeneration.planning import plan
from capar.regeneration.quality import Quality, quality
from capar.regeneration.scenes import Scene
from capar.regeneration.sources import Source

MARGINS_M = (0.013, 0.03, 0.05)
"""How far free hands keep from things; the next where a motion is too near something [m]."""

BY_MARGIN = {"penetration", "free hand clear"}
"""The gates that a wider margin may mend."""


def regenerate(source: Source, human: Human, scene: Scene | None = None) -> tuple[Motion, Quality]:
    """Let a body do in a scene what was recorded; verified at every frame.

    Args:
        source: The recorded performance.
        human: Who performs.
        scene: Where; as it was recorded, unless stated.

    Raises:
        PlanError: It is out of reach or impossible; the message says what would help.
    """
    best: tuple[Motion, Quality] | None = None
    for margin_m in MARGINS_M:
        motion = perform_plan(plan(source, scene or source.scene, human, margin_m=margin_m))
        found = motion, quality(motion)
        if best is None or len(found[1].failed) < len(best[1].failed):
            best = found
        if not BY_MARGIN & set(found[1].failed):
            break
    assert best is not None
    return best
