"""``capar record``: a live tracker to a capture bundle."""

import json
import time
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

app = typer.Typer()


@app.command()
def record(
    source: Annotated[
        str, typer.Argument(help="A device address, or the file of a recording that was cut off.")
    ],
    output: Annotated[Path, typer.Argument(help="The folder of the capture bundle to make.")],
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.0, help="How long; 0 until it is interrupted.")
    ] = 0.0,
    as_json: Annotated[bool, typer.Option("--json", help="Print for machines.")] = False,
) -> None:
    """Record a tracker into OUTPUT.live as it sends, then make a capture bundle of it.

    The recording is kept: after a crash or a kill the bundle is made from it.
    """
    from capar.model.errors import FileError
    from extractors.devices.bundle_writer import write_bundle
    from extractors.devices.recording import read_live_recording

    live = Path(source)
    if output.exists():
        raise FileError(output, "exists already.", "Bundles are never overwritten.")
    if not live.is_file():
        live = output.with_name(f"{output.name}.live")
        _record(source, live, seconds)
    recording = read_live_recording(live)
    write_bundle(recording, output)
    report = {
        "recording": str(live),
        "bundle": str(output),
        "frames": len(recording.host_s),
        "sensors": list(recording.description.sensors),
        "counts": asdict(recording.counts) if recording.counts else None,
        "events": [each.message for each in recording.events],
    }
    typer.echo(json.dumps(report, indent=2, sort_keys=True) if as_json else _told(report))


def _record(address: str, path: Path, seconds: float) -> None:
    """Record until the time is over, or the user ends it."""
    from extractors.devices.drivers import find_tracker
    from extractors.devices.recording import RecordingWriter

    with find_tracker(address) as tracker:
        writer = RecordingWriter(path, tracker.describe(), address)
        end, told = time.monotonic() + seconds, 0
        try:
            while not seconds or time.monotonic() < end:
                for frame in tracker.poll(0.1):
                    writer.write(frame)
                for event in tracker.events[told:]:
                    typer.echo(event.message, err=True)
                    writer.tell(event)
                told = len(tracker.events)
        except KeyboardInterrupt:
            typer.echo("ended", err=True)
    writer.close(tracker.counts)


def _told(report: dict[str, Any]) -> str:
    counts = report["counts"]
    lost = f", {counts['lost_records']} poses lost" if counts else "; the recording was cut off"
    names = ", ".join(report["sensors"])
    return (
        f"{report['frames']} frames of {names}{lost}\n"
        f"wrote {report['bundle']} from {report['recording']}"
    )
