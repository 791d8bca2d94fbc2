"""How commands step to where an action can be done, and tell it."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from capar.body.human import Human
    from capar.pipelines.stances import Approach
    from capar.regeneration.manner import EffortReport
    from capar.regeneration.motions import Motion
    from capar.regeneration.quality import Quality
    from capar.regeneration.scenes import Scene
    from capar.regeneration.sources import Source
    from capar.regeneration.styles import Style

    Act = Callable[[Scene], tuple[Motion, Quality, EffortReport | None]]


def performed_near(
    source: "Source", human: "Human", scene: "Scene", style: "Style", act: "Act", step: bool
) -> "tuple[Approach | None, tuple[Motion, Quality, EffortReport | None]]":
    """Perform an action from the given place, or, if steps may be taken, from where they lead.

    Raises:
        PlanError: It is out of reach, and no step helps.
    """
    from capar.pipelines.stances import approached

    if not step:
        return None, act(scene)

    def both(where: "Scene") -> "tuple[tuple[Motion, EffortReport | None], Quality]":
        motion, quality, report = act(where)
        return (motion, report), quality

    stepped, (motion, report), quality = approached(source, human, scene, style, both)
    return stepped, (motion, quality, report)


def write_approach(stepped: "Approach", folder: Path, agent: str) -> None:
    """Write the capture of steps as a bundle.

    Args:
        stepped: The steps.
        folder: The new folder.
        agent: Name of the performer.
    """
    from capar.regeneration.stepping_captures import capture_of_steps, write_steps

    capture = capture_of_steps(stepped.steps, name="steps", agent=agent)
    write_steps(stepped.steps, capture, folder)


def approach_answer(stepped: "Approach | None", passed: bool) -> dict[str, Any]:
    """Steps for machines; nothing where none were needed."""
    from capar.cli._gates import gate_rows

    if stepped is None:
        return {}
    return {
        "passed": passed and stepped.quality.passed,
        "steps": {
            "why": stepped.why,
            "ahead_m": stepped.ahead_m,
            "left_m": stepped.aside_m,
            "strides": [{"foot": s.side, "by_m": s.by} for s in stepped.steps.strides],
            "impossible": stepped.tried,
            "gates": gate_rows(stepped.quality.gates),
        },
    }


def tell_approach(stepped: "Approach | None") -> None:
    """Print the steps that were needed, if any, and their gates."""
    from capar.cli._gates import tell_gates

    if stepped is None:
        return
    typer.echo(f"plan: from the given place {stepped.why}")
    for why in stepped.tried:
        typer.echo(f"plan: not possible is {why}")
    for number, stride in enumerate(stepped.steps.strides, start=1):
        x, y = stride.by
        typer.echo(f"{number:3}. {stride.side} foot: Step by ({x:+.2f}, {y:+.2f}) m")
    typer.echo("the steps:")
    tell_gates(stepped.quality.gates, stepped.steps.times)
