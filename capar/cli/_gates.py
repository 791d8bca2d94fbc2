"""How commands tell the quality of a motion."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    import numpy as np

    from capar.regeneration.manner import EffortReport
    from capar.regeneration.motions import Motion
    from capar.regeneration.quality import Gate, Quality


def quality_answer(motion: "Motion", quality: "Quality") -> dict[str, Any]:
    """Gates and notes of a motion, for machines."""
    return {
        "passed": quality.passed,
        "gates": gate_rows(quality.gates),
        "told": quality.told,
        "notes": motion.plan.notes,
    }


def gate_rows(gates: "Sequence[Gate]") -> list[dict[str, Any]]:
    """Gates, for machines."""
    return [
        {
            "name": gate.name,
            "value": round(gate.value, 4),
            "limit": gate.limit,
            "unit": gate.unit,
            "passed": bool(gate.passed),
            "frame": gate.frame,
            "bodies": gate.bodies,
        }
        for gate in gates
    ]


def effort_answer(report: "EffortReport | None") -> dict[str, Any]:
    """The effort of a motion, for machines; nothing where none was asked for."""
    if report is None:
        return {}
    return {
        "effort": {
            "asked": report.asked.values,
            "performed": report.performed.values,
            "measured": report.measured.values,
            "why": report.why,
        }
    }


def tell_quality(motion: "Motion", quality: "Quality") -> None:
    """Print every gate with its limit and where it was worst, and the notes."""
    tell_gates(quality.gates, motion.plan.source.times)
    tell_measures(quality)
    for note in motion.plan.notes:
        typer.echo(f"note: {note}")


def tell_gates(gates: "Sequence[Gate]", times: "Sequence[float] | np.ndarray") -> None:
    """Print gates with their limits and where they were worst."""
    typer.echo("gate               value     limit   unit        passed  worst at")
    for gate in gates:
        sign = ">=" if gate.at_least else "<="
        at = f"{times[gate.frame]:.2f} s" if gate.frame >= 0 else ""
        typer.echo(
            f"{gate.name:16} {gate.value:8.3f}  {sign} {gate.limit:6.2f}  {gate.unit:10}  "
            f"{'yes' if gate.passed else 'NO':6}  {at} {gate.bodies}".rstrip()
        )


def tell_measures(quality: "Quality") -> None:
    """Print what is told and not demanded."""
    for measured in quality.told:
        value = f"{measured.value:.1f} {measured.unit}"
        typer.echo(f"{measured.name}: {value} ({measured.bodies}), not demanded")
