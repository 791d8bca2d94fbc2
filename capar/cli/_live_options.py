"""The options of ``capar observe`` that are about live observation."""

from pathlib import Path
from typing import Annotated

import typer

Live = Annotated[
    bool,
    typer.Option(
        "--live", help="Tell segments while they happen: of CAPTURE, replayed, or of --device."
    ),
]
Device = Annotated[
    str,
    typer.Option(
        help="With --live: a tracker's address; `capar devices` lists examples.",
        show_default=False,
    ),
]
Rig = Annotated[
    str,
    typer.Option(
        help="With --device: a capture of the same bodies, such as an earlier take.",
        show_default=False,
    ),
]
StoredCalibration = Annotated[
    Path | None,
    typer.Option(
        "--calibration",
        help="With --live: what `capar inspect CAPTURE --calibration --json` printed.",
        show_default=False,
    ),
]
LeadIn = Annotated[
    float,
    typer.Option(
        min=0.0,
        metavar="SECONDS",
        help="With --live: calibrate by so many first seconds; 0 by the whole of CAPTURE.",
    ),
]
Speed = Annotated[
    float,
    typer.Option(
        min=0.0,
        help="With --live CAPTURE: how many times as fast to replay it; 0 as fast as it goes.",
    ),
]
Websocket = Annotated[
    int | None,
    typer.Option(
        metavar="PORT",
        min=0,
        max=65535,
        help="With --live: also send events as JSON to programs that connect to "
        "ws://127.0.0.1:PORT; 0 takes a free port and says which. Needs capar[live].",
        show_default=False,
    ),
]
Markers = Annotated[
    str,
    typer.Option(
        "--lsl-markers",
        metavar="NAME",
        help="With --live: also send events as JSON in a Lab Streaming Layer stream of that name "
        "and of type Markers. Needs capar[live].",
        show_default=False,
    ),
]
