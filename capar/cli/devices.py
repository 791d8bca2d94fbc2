"""``capar devices``: which trackers can be read, and what one sends."""

import json
import math
import time
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from extractors.devices.tracker import LiveTracker

app = typer.Typer()


@app.command()
def devices(
    address: Annotated[
        str, typer.Argument(help="A device address; without one, drivers and ports are listed.")
    ] = "",
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, help="How long to watch it.")
    ] = 2.0,
    as_json: Annotated[bool, typer.Option("--json", help="Print for machines.")] = False,
) -> None:
    """List drivers and serial ports, or open a tracker and say what comes from it."""
    from extractors.devices.drivers import find_tracker

    report = _watched(find_tracker(address), seconds) if address else _listed()
    if as_json:
        typer.echo(json.dumps(report, indent=2, sort_keys=True))
    else:
        (_show if address else _show_list)(report)


def _listed() -> dict[str, Any]:
    from extractors.devices.drivers import EXAMPLES
    from extractors.devices.serial_line import find_ports

    return {"drivers": EXAMPLES, "ports": find_ports()}


def _show_list(report: dict[str, Any]) -> None:
    typer.echo("drivers, each with an address:")
    for name, example in report["drivers"].items():
        typer.echo(f"  {name:<11} {example}")
    typer.echo("serial ports:" if report["ports"] else "no serial ports")
    for port, what in report["ports"].items():
        typer.echo(f"  {port:<11} {what}")


def _watched(tracker: "LiveTracker", seconds: float) -> dict[str, Any]:
    """What a tracker says of itself, and what arrives for a while."""
    frames = []
    with tracker:
        description = tracker.describe()
        end = time.monotonic() + seconds
        while (left_s := end - time.monotonic()) > 0.0:
            frames += tracker.poll(min(0.1, left_s))
    last = frames[-1] if frames else None
    span_s = frames[-1].host_s - frames[0].host_s if frames else 0.0
    return {
        "kind": description.kind,
        "model": description.model,
        "details": dict(description.details),
        "rate_hz": (len(frames) - 1) / span_s if span_s else 0.0,
        "counts": asdict(tracker.counts),
        "events": [each.message for each in tracker.events],
        "positions_m": {
            name: _numbers(last.positions[index]) if last else None
            for index, name in enumerate(description.sensors)
        },
    }


def _numbers(position: Any) -> list[float] | None:
    """A position, or None where it is lost; JSON has no NaN."""
    return [float(each) for each in position] if all(map(math.isfinite, position)) else None


def _show(report: dict[str, Any]) -> None:
    details = ", ".join(f"{name} {value}" for name, value in report["details"].items())
    typer.echo(f"{report['kind']} {report['model']} {details}".rstrip())
    counts = report["counts"]
    typer.echo(
        f"{counts['frames']} frames at {report['rate_hz']:.1f} Hz, {counts['lost_records']} poses "
        f"lost, {counts['refused_records']} refused, {counts['dropped_bytes']} bytes dropped"
    )
    for name, position in report["positions_m"].items():
        place = "no position" if position is None else " ".join(f"{v:7.3f}" for v in position)
        typer.echo(f"  {name:<16} {place}")
    for message in report["events"]:
        typer.echo(message)
