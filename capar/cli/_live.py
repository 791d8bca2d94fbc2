"""``capar observe --live``: frames of a tracker, or of a replayed capture, told as they come."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from capar.model.errors import CaparError, FileError

if TYPE_CHECKING:
    from capar.model.calibration import Calibration
    from capar.model.observation import Observation
    from capar.pipelines.live.events import SegmentEvent
    from capar.pipelines.live.frames import Poses
    from capar.pipelines.live.observer import LiveObserver
    from capar_rules.engine.profiles import Profile

COLUMNS = "   time  status       segment          from-to [s]     what was done"
WAIT_S = 0.02
"""Pause while no frame is due [s]."""


@dataclass(frozen=True, slots=True)
class LiveOptions:
    """What the command line says of live observation."""

    source: str
    """The capture that is replayed; empty with a device."""

    device: str
    rig: str
    calibration: Path | None
    lead_in_s: float
    speed: float
    """How many times as fast as it was recorded a capture is replayed; 0: as fast as it goes."""

    json: bool
    name: str = ""
    websocket: int | None = None
    """The port at which programs are sent events; 0 any that is free, None no port."""

    markers: str = ""
    """The name of a Lab Streaming Layer stream of events; empty for none."""

    def __post_init__(self) -> None:
        """Check that there is one source.

        Raises:
            CaparError: None or two, or a device without a rig or a calibration.
        """
        if bool(self.source) == bool(self.device):
            raise CaparError("--live takes a CAPTURE to replay, or --device ADDRESS with --rig")
        if self.device and not self.rig:
            raise CaparError(
                "--device needs --rig: a capture bundle of the same bodies, such as an earlier "
                "take by `capar record`, which says what rides on which sensor"
            )
        if self.device and not self.calibration and self.lead_in_s <= 0.0:
            raise CaparError("--device needs --calibration FILE, or --lead-in SECONDS above 0")


def observe_live(options: LiveOptions, rules: "Profile") -> "Observation":
    """Observe until the source ends or the user interrupts."""
    if options.device:
        return _from_device(options, rules)
    return _from_capture(options, rules)


def _from_capture(options: LiveOptions, rules: "Profile") -> "Observation":
    from capar.pipelines.live.frames import replayed
    from capar.pipelines.live.lead_in import lead_in
    from capar.pipelines.live.observer import LiveObserver
    from extractors.calibration import calibrate
    from extractors.readers.bundle.capture_toml import read_capture

    trial = read_capture(options.source)
    known = _stored(options.calibration)
    if known is None:
        known = calibrate(lead_in(trial, options.lead_in_s) if options.lead_in_s > 0.0 else trial)
    observer = LiveObserver(trial, known, rules=rules, name=options.name, sentences=True)
    return _run(observer, _paced(replayed(trial), options.speed), options)


def _from_device(options: LiveOptions, rules: "Profile") -> "Observation":
    from capar.pipelines.live.device_frames import DeviceFrames
    from capar.pipelines.live.frames import body_names
    from capar.pipelines.live.lead_in import capture_of
    from capar.pipelines.live.observer import LiveObserver
    from extractors.calibration import calibrate
    from extractors.devices.drivers import find_tracker
    from extractors.readers.bundle.capture_toml import read_capture
    from extractors.signals.clock import time_step

    rig = read_capture(options.rig)
    rig = replace(rig, name=options.name or "live", sources=(), notices=())
    known = _stored(options.calibration)
    names = body_names(rig)
    with find_tracker(options.device) as tracker:
        told = tracker.describe()
        step_s = known.step_s if known else _step_s(told.rate_hz, time_step(rig.times))
        frames = DeviceFrames(rig, names, told, step_s)

        def batches() -> "Iterator[list[Poses]]":
            heard = 0
            while True:
                yield [each for frame in tracker.poll(0.1) for each in frames.poses(frame)]
                for event in tracker.events[heard:]:
                    typer.echo(event.message, err=True)
                heard = len(tracker.events)

        source = batches()
        first: list[Poses] = []
        if known is None:
            typer.echo(f"calibrating by {options.lead_in_s:g} s: act as usual", err=True)
            while len(first) * step_s < options.lead_in_s:
                first += next(source)
            known = calibrate(capture_of(rig, first))
        observer = LiveObserver(rig, known, rules=rules, name=options.name, sentences=True)
        seen = _run(observer, _following(first, source), options)
        typer.echo(f"{observer.frames} frames, {frames.filled} of them lost on the way", err=True)
    return seen


def _following(first: "list[Poses]", more: "Iterator[list[Poses]]") -> "Iterator[list[Poses]]":
    yield first
    yield from more


def _step_s(rate_hz: float, usual_s: float) -> float:
    """The step of a tracker that says its rate, or else that of the rig's recording [s]."""
    return 1.0 / rate_hz if rate_hz > 0.0 else usual_s


def _stored(path: Path | None) -> "Calibration | None":
    """The calibration that `capar inspect --calibration --json` printed."""
    if path is None:
        return None
    from capar.model.calibration import Calibration
    from capar.model.json_form import value_from_json

    try:
        found = value_from_json(path.read_text(encoding="utf-8"), Calibration)
    except (CaparError, ValueError, KeyError, TypeError) as error:
        remedy = f"`capar inspect CAPTURE --calibration --json > {path}` writes one."
        raise FileError(path, f"is no calibration: {error}.", remedy) from None
    assert isinstance(found, Calibration)
    return found


def _paced(frames: "list[Poses]", speed: float) -> "Iterator[list[Poses]]":
    """The frames that are due, again and again, at a speed; one at a time as fast as it goes."""
    if speed <= 0.0:
        yield from ([each] for each in frames)
        return
    started, sent = time.monotonic(), 0
    while sent < len(frames):
        due_s = (time.monotonic() - started) * speed + frames[0].time_s
        upto = sent
        while upto < len(frames) and frames[upto].time_s <= due_s:
            upto += 1
        if upto == sent:
            time.sleep(WAIT_S)
        yield frames[sent:upto]
        sent = upto


def _run(
    observer: "LiveObserver", batches: "Iterator[list[Poses]]", options: LiveOptions
) -> "Observation":
    """Tell events until the source ends or Ctrl-C; then settle what is left."""
    from capar.model.json_form import to_json

    with ExitStack() as opened:
        sends = list(_programs(options, opened))
        if not options.json:
            typer.echo(COLUMNS)
        try:
            for batch in batches:
                _tell(observer.push(batch), options, sends)
        except KeyboardInterrupt:
            typer.echo("ended", err=True)
        if observer.frames < 2:
            raise CaparError("no frames came: nothing was observed")
        events, seen = observer.finish()
        _tell(events, options, sends)
    assert seen is not None
    if options.json:
        whole = {"event": "observation", "observation": json.loads(to_json(seen))}
        typer.echo(json.dumps(whole, ensure_ascii=False))
    return seen


def _programs(options: LiveOptions, opened: ExitStack) -> Iterator[Callable[[str], None]]:
    """What sends an event to other programs, each closed with the stack."""
    if options.websocket is not None:
        from capar.pipelines.live.event_socket import EventSocket

        socket = EventSocket(options.websocket)
        opened.callback(socket.close)
        typer.echo(f"events at {socket.address}", err=True)
        yield socket.send
    if options.markers:
        from extractors.devices.lsl import LslMarkers

        markers = LslMarkers(options.markers)
        opened.callback(markers.close)
        typer.echo(f"events in the Lab Streaming Layer stream {options.markers!r}", err=True)
        yield markers.send


def _tell(
    events: "list[SegmentEvent]", options: LiveOptions, sends: list[Callable[[str], None]]
) -> None:
    from capar.pipelines.live.events import event_row

    for event in events:
        line = json.dumps(event_row(event), ensure_ascii=False)
        typer.echo(line if options.json else _line(event))
        for send in sends:
            send(line)


def _line(event: "SegmentEvent") -> str:
    segment = event.segment
    what = event.sentence or f"{segment.name}({', '.join(segment.objects)})"
    if event.status == "purpose":
        what = f"{segment.name}: for {segment.purpose}"
    return (
        f"{event.time_s:7.2f}  {event.status.value:12} {segment.ee}/{segment.index}".ljust(38)
        + f"{segment.start_s:6.2f}-{segment.end_s:<6.2f}   {what}"
    )
