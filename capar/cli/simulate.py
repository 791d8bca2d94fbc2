"""``capar simulate``: a tracker for those who have none."""

import json
import time
from shlex import quote
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def simulate(
    kind: Annotated[str, typer.Argument(help="flock, motionstar, fastrak or vrpn.")],
    capture: Annotated[
        str, typer.Option("--capture", help="A capture to play in a loop; else a made-up motion.")
    ] = "",
    sensors: Annotated[
        int, typer.Option("--sensors", min=1, max=13, help="Sensors of the made-up motion.")
    ] = 4,
    erc: Annotated[
        bool, typer.Option("--erc", help="Flock: with an extended-range controller as unit 1.")
    ] = False,
    lost: Annotated[
        float, typer.Option("--lost", min=0.0, max=1.0, help="Share of bytes or packets lost.")
    ] = 0.0,
    garbled: Annotated[
        float, typer.Option("--garbled", min=0.0, max=1.0, help="Share of bytes garbled.")
    ] = 0.0,
    port: Annotated[int, typer.Option("--port", help="TCP or UDP port; 0 takes a free one.")] = 0,
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.0, help="How long; 0 until it is interrupted.")
    ] = 0.0,
    as_json: Annotated[bool, typer.Option("--json", help="Print for machines.")] = False,
) -> None:
    """Simulate a tracker on a pseudo-terminal or on loopback, and say its address."""
    from extractors.devices.motion_source import CapturedMotion, MotionSource, SmoothMotion
    from extractors.devices.simulators import Wanted, make_simulator
    from extractors.readers.bundle.capture_toml import read_capture

    motion: MotionSource = SmoothMotion(sensors)
    names = ""
    if capture:
        motion = CapturedMotion(read_capture(capture))
        names = f"&names={','.join(motion.sensors)}"
    simulator, options = make_simulator(kind, Wanted(motion, erc, lost, garbled, port))
    with simulator:
        address = f"{kind}:{simulator.place}?{options}{names}"
        typer.echo(json.dumps({"address": address}) if as_json else address)
        if not as_json:
            # The shell would take an address that is not quoted for several commands.
            typer.echo(f"in another terminal: capar record {quote(address)} FOLDER", err=True)
        _wait(seconds)


def _wait(seconds: float) -> None:
    """Until the time is over, or the user ends it."""
    end = time.monotonic() + seconds
    try:
        while not seconds or time.monotonic() < end:
            time.sleep(0.1)
    except KeyboardInterrupt:
        return
