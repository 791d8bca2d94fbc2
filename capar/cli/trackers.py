"""Live trackers: list them, record one, simulate one."""

import math
import time
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import Json
from capar.cli.output import answer

if TYPE_CHECKING:
    from extractors.devices.tracker import LiveTracker

Seconds = Annotated[float, Option(min=0.0, help="How long; 0 until it is interrupted.")]


def devices(
    address: Annotated[str, Argument(help="A device's; else drivers and ports are listed.")] = "",
    seconds: Annotated[float, Option(min=0.1, help="How long to watch it.")] = 2.0,
    json: Json = False,
) -> None:
    """List trackers and serial ports, or print what one sends."""
    from extractors.devices.drivers import EXAMPLES, find_tracker
    from extractors.devices.lines import find_ports

    if address:
        report = _watched(find_tracker(address), seconds)
    else:
        report = {"drivers": EXAMPLES, "ports": find_ports()}
    answer(report, json=json, sort_keys=True)


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
            name: _position(last.positions[index]) if last else None
            for index, name in enumerate(description.sensors)
        },
    }


def _position(position: Any) -> list[float] | None:
    """A position, or None where it is lost; JSON has no NaN."""
    return [float(each) for each in position] if all(map(math.isfinite, position)) else None


def record(
    source: Annotated[str, Argument(help="A device's address, or a recording cut off.")],
    output: Annotated[Path, Argument(help="The folder of the capture bundle to make.")],
    seconds: Seconds = 0.0,
    json: Json = False,
) -> None:
    """Record a tracker to a capture bundle.

    What it sends is written to OUTPUT.live at once, and kept: after a crash the bundle is made
    from that.
    """
    from capar.model.errors import FileError
    from extractors.devices.recording import read_live_recording, write_bundle

    live = Path(source)
    if output.exists():
        raise FileError(output, "exists already.", "Bundles are never overwritten.")
    if not live.is_file():
        live = output.with_name(f"{output.name}.live")
        _record(source, live, seconds)
    recording = read_live_recording(live)
    write_bundle(recording, output)
    counts = asdict(recording.counts) if recording.counts else None
    names = list(recording.description.sensors)
    report = {
        "recording": str(live),
        "bundle": str(output),
        "frames": len(recording.host_s),
        "sensors": names,
        "counts": counts,
        "events": [each.message for each in recording.events],
    }
    lost = f", {counts['lost_records']} poses lost" if counts else "; the recording was cut off"
    said = f"{len(recording.host_s)} frames of {', '.join(names)}{lost}"
    answer(report, [said, f"wrote {output} from {live}"], json=json, sort_keys=True)


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


def simulate(
    kind: Annotated[str, Argument(help="flock, motionstar, fastrak or vrpn.")],
    capture: Annotated[str, Option(help="A capture to play in a loop.")] = "",
    sensors: Annotated[int, Option(min=1, max=13, help="Of the made-up motion.")] = 4,
    erc: Annotated[bool, Option("--erc", help="With an extended-range unit 1.")] = False,
    lost: Annotated[float, Option(min=0.0, max=1.0, help="Share of bytes lost.")] = 0.0,
    garbled: Annotated[float, Option(min=0.0, max=1.0, help="Share of bytes garbled.")] = 0.0,
    port: Annotated[int, Option(help="TCP or UDP port; 0 takes a free one.")] = 0,
    seconds: Seconds = 0.0,
    json: Json = False,
) -> None:
    """Simulate a tracker on a pseudo-terminal or on loopback.

    Its address is printed, for `capar devices`, `record` and `observe --live --device`.
    """
    import json as codec

    from extractors.devices.drivers import make_simulator
    from extractors.devices.simulator import CapturedMotion, Faults, MotionSource, SmoothMotion
    from extractors.readers.bundle.capture_toml import read_capture

    motion: MotionSource = SmoothMotion(sensors)
    names = ""
    if capture:
        motion = CapturedMotion(read_capture(capture))
        names = f"&names={','.join(motion.sensors)}"
    simulator, options = make_simulator(kind, motion, Faults(lost, garbled), erc=erc, port=port)
    with simulator, suppress(KeyboardInterrupt):
        address = f"{kind}:{simulator.place}?{options}{names}"
        typer.echo(codec.dumps({"address": address}) if json else address)
        if not json:
            # The shell would take an address that is not quoted for several commands.
            typer.echo(f"in another terminal: capar record {quote(address)} FOLDER", err=True)
        end = time.monotonic() + seconds
        while not seconds or time.monotonic() < end:
            time.sleep(0.1)
