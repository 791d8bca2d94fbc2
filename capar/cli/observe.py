"""Observe a capture or a live tracker: segments, the complex PAR that they make, a picture."""

import json as codec
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer
from typer import Argument, Option

from capar.cli import options
from capar.cli.output import check_picture, console, print_whole, save, stage
from capar.model.errors import CaparError, FileError, RuleError

if TYPE_CHECKING:
    from capar.model.calibration import Calibration
    from capar.model.capture import Capture
    from capar.model.observation import Observation
    from capar.pipelines.live.frames import Poses
    from capar.pipelines.live.ledgers import SegmentEvent
    from capar.pipelines.live.observer import LiveObserver
    from capar_rules.engine.profiles import Profile
    from extractors.measure import Measurements

LIVE_COLUMNS = "   time  status       segment          from-to [s]     what was done"


class OnUnknown(StrEnum):
    """What to do about segments that no rule names."""

    ASK = "ask"
    KEEP = "keep"
    FAIL = "fail"


def observe(
    captures: Annotated[
        list[str] | None,
        Argument(
            metavar="CAPTURE...",
            help="A capture: its folder, or FOLDER:TAKE. Or many: patterns with *, FOLDER:*, or a "
            "folder of captures. None with --device.",
        ),
    ] = None,
    profile: options.ProfileName = "extended",
    name: Annotated[str, Option(help="What the whole action is called.")] = "",
    on_unknown: Annotated[
        OnUnknown | None,
        Option(help="What no rule names: ask (the default at a terminal), keep, or fail."),
    ] = None,
    rules: options.Rules = None,
    steady: options.Steady = None,
    set_: options.Set = None,
    json: options.Json = False,
    script: Annotated[bool, Option("--script", help="Print the PAR as a Python script.")] = False,
    pars: Annotated[bool, Option("--pars", help="Print all UPARs and IPARs too.")] = False,
    plot: options.Plot = None,
    actionary: Annotated[
        str | None,
        Option(
            metavar="PATH|URL",
            envvar="CAPAR_ACTIONARY",
            help="Keep it in this Actionary, whose rules count too.",
        ),
    ] = None,
    fit: Annotated[
        bool,
        Option(
            "--fit", help="Fit a human body first, and take its surface for hands, head and feet."
        ),
    ] = False,
    wait: options.Wait = 0.0,
    new: options.New = False,
    jobs: Annotated[
        int, Option(min=1, metavar="N", help="Of many captures: how many processes observe.")
    ] = 1,
    scheduler: Annotated[
        str,
        Option(metavar="ADDRESS", help="Of many captures: a dask cluster that observes them."),
    ] = "",
    quiet: Annotated[
        bool, Option("--quiet", help="Print no notes and no progress; of many, failures alone.")
    ] = False,
    live: Annotated[
        bool, Option("--live", help="Print segments while they happen, of CAPTURE or --device.")
    ] = False,
    device: Annotated[str, Option(help="With --live: a tracker's address (`capar devices`).")] = "",
    rig: Annotated[str, Option(help="With --device: an earlier capture of the same bodies.")] = "",
    calibration: Annotated[
        Path | None, Option(help="With --live: of `capar inspect --calibration --json`.")
    ] = None,
    lead_in: Annotated[
        float,
        Option(min=0.0, metavar="SECONDS", help="With --live: calibrate by these; 0 for all."),
    ] = 0.0,
    speed: Annotated[
        float, Option(min=0.0, help="With --live CAPTURE: times as fast; 0: no pause.")
    ] = 1.0,
    websocket: Annotated[
        int | None,
        Option(
            metavar="PORT",
            min=0,
            max=65535,
            help="With --live: send events to ws://127.0.0.1:PORT too; 0 takes a free one.",
        ),
    ] = None,
    lsl_markers: Annotated[
        str,
        Option(metavar="NAME", help="With --live: send events as Lab Streaming Layer Markers too."),
    ] = "",
) -> None:
    r"""Say what was done in a capture: named segments and their PAR.

    Segments are those of each hand, foot or head; the complex PAR is what they make together.
    Of many captures each has a line; failures are listed at the end with their commands. With
    --actionary what is kept is not observed again, so that a run that was ended goes on.

    \b
        capar observe mine --plot mine.png
        capar observe 'study:*' more_captures --jobs 2 --actionary known

    With --live a segment is printed when it ends, provisional first and then settled; Ctrl-C ends
    it. Other programs get the same events with --json, --websocket or --lsl-markers.
    """
    given = captures or []
    capture = given[0] if given else ""
    forms = {"--json": json, "--script": script, "--pars": pars}
    named = [form for form, given in forms.items() if given]
    if len(named) > 1:
        raise CaparError(f"{' and '.join(named)} print different things; say one of them")
    check_picture(plot)
    if actionary:
        options.confirm_new(actionary, new=new)
    rule_base = partial(options.rule_base, profile, rules, actionary, steady=steady)
    if len(given) > 1 or (given and (scheduler or _means_many(capture))):
        single = {
            "--script": script, "--pars": pars, "--plot": plot, "--set": set_, "--fit": fit,
            "--on-unknown": on_unknown, "--name": name, "--live": live, "--device": device,
        }  # fmt: skip
        if refused := [option for option, value in single.items() if value]:
            raise CaparError(f"of many captures there is no {' and no '.join(refused)}")
        by = {"jobs": jobs, "scheduler": scheduler, "actionary": actionary, "wait_s": wait}
        _observe_many(given, by | {"rules": rule_base()}, json=json, quiet=quiet)
        return
    if live or device:
        if plot or set_ or on_unknown or fit:
            raise CaparError(
                "--plot, --set, --fit and --on-unknown are not for --live; use its recording"
            )
        source = _Live(
            capture, device, rig, calibration, lead_in, speed, json, name, websocket, lsl_markers
        )
        observation = _observe_live(source, rule_base())
        stored = _store(observation, actionary, name=name, wait_s=wait)
        if not json:
            typer.echo()
            _print(observation, script=script, pars=pars, quiet=quiet)
        typer.echo(stored, err=True, nl=bool(stored))
        return
    if websocket is not None or lsl_markers:
        raise CaparError("--websocket and --lsl-markers send events of --live; give --live as well")
    if not capture:
        raise CaparError("expected a CAPTURE, or --live with --device ADDRESS")
    from capar_rules.authoring.user_rules import new_rules_folder

    choice = on_unknown or (OnUnknown.ASK if options.can_ask() and not json else OnUnknown.KEEP)
    base = rule_base()
    trial, measurements, observe_by = _measured(capture, set_ or [], name, fit=fit, quiet=quiet)
    with stage("naming segments", quiet=quiet):
        observation = observe_by(base)
    folder = new_rules_folder(rules, actionary=actionary)
    if choice is OnUnknown.ASK and _ask_for_names(observation, folder):
        observation = observe_by(rule_base())
    elif choice is OnUnknown.FAIL:
        _fail_on_unknown(observation)
    # Files first: a reader of the output who stops early, as `head` does, ends the command.
    if plot:
        _draw(observation, trial, measurements, plot)
    stored = _store(observation, actionary, name=name, wait_s=wait)
    _print(observation, json=json, script=script, pars=pars, quiet=quiet)
    typer.echo(stored, err=True, nl=bool(stored))


def _measured(
    capture: str, settings: list[str], name: str, *, fit: bool, quiet: bool
) -> "tuple[Capture, Measurements, Callable[[Profile], Observation]]":
    """A capture, what is measured of it, and what observes it by rules."""
    from extractors.readers.bundle.capture_toml import read_capture

    with stage(f"reading {capture}", quiet=quiet):
        trial = read_capture(capture)
    place = Path(capture)
    if place.is_file() and place.suffix != ".toml" and not quiet:
        typer.echo(f"{capture} is read as {place.parent / 'capture.toml'} says", err=True)
    if fit:
        from capar.body.body_fitting import fit_body, with_body_parts

        with stage("fitting a body", quiet=quiet):
            trial = with_body_parts(trial, fit_body(capture, trial))

    # A mistake in the capture is reported before these are loaded, which takes longer.
    from capar.pipelines.observation import observe_measured
    from extractors.calibration import calibrate, set_values
    from extractors.measure import measure

    with stage(f"measuring {len(trial.times)} frames", quiet=quiet):
        measured = measure(trial, set_values(calibrate(trial), settings) if settings else None)
    return trial, measured, lambda base: observe_measured(trial, measured, rules=base, name=name)


def _means_many(place: str) -> bool:
    """Whether a place is a pattern, or a folder that is no capture and has some below it."""
    path = Path(place)
    if path.is_dir():
        return not (path / "capture.toml").is_file() and any(path.rglob("capture.toml"))
    return not path.exists() and any(mark in place for mark in "*?[")


def _observe_many(patterns: list[str], by: Mapping[str, Any], *, json: bool, quiet: bool) -> None:
    """Print a line for each capture, and at the end what failed.

    Args:
        patterns: What captures are meant.
        by: By what they are observed, as ``observe_many`` takes it.
        json: Whether a line is JSON.
        quiet: Whether only failures are printed.

    Raises:
        CaparError: Some failed.
    """
    from capar.pipelines.many import observe_many
    from extractors.readers.bundle.patterns import find_captures

    places = find_captures(patterns)
    failed = []
    for number, done in enumerate(observe_many(places, **by), 1):
        seen = done.observation
        segments = seen.segments if seen else ()
        unknown = sum(not each.known for each in segments)
        row = {
            "capture": done.place, "name": seen.capture if seen else done.known,
            "segments": len(segments), "unknown": unknown,
            "seconds": round(seen.duration_s, 3) if seen else None,
            "known": bool(done.known), "error": done.error,
        }  # fmt: skip
        if seen:
            told = f"{len(segments)} segments in {seen.duration_s:.2f} s"
            told += f", {unknown} without a name" if unknown else ""
        else:
            told = "is kept already" if done.known else "FAILED"
        if done.error:
            failed.append((done.place, done.error))
        if json:
            typer.echo(codec.dumps(row, ensure_ascii=False))
        elif not quiet:
            typer.echo(f"{number}/{len(places)}  {done.place}: {told}")
    if failed:
        where = f" --actionary {by['actionary']}" if by["actionary"] else ""
        lines = [f"  capar observe {quote(place)}{where}\n    {error}" for place, error in failed]
        head = f"{len(failed)} of {len(places)} captures failed; each alone:"
        raise CaparError("\n".join([head, *lines]))


def demo(
    plot: Annotated[Path, Option(help="Where to draw it: .png, .svg or .pdf.")] = Path(
        "drink_from_mug.png"
    ),
) -> None:
    """Observe the shipped capture of drinking, and draw it."""
    from importlib import resources

    with resources.as_file(resources.files("capar") / "demo" / "drink_from_mug") as bundle:
        observe([str(bundle)], name="DrinkFromMug", plot=plot)


def _store(observation: "Observation", place: str | None, *, name: str, wait_s: float) -> str:
    """Add an observation to an Actionary, if one is named; what became of it, to be printed."""
    if not place:
        return ""
    from kb import Actionary
    from kb.corrections import claims

    with Actionary.open(place, wait_s=wait_s) as store:
        known = store.recognise(observation.complex_par)
        added = store.add(observation, name=name or known or None)
        said = claims(store.store, observation.capture)
    what = "seen before" if known else "seen for the first time"
    again = ", in place of the earlier observation of this capture" if added.replaced else ""
    kept = f"kept {added.name} in {place}: {added.action}, {what}{again}"
    if not said:
        return kept
    who = ", ".join(dict.fromkeys(claim.by for claim in said))
    return (
        f"{kept}\n{who} corrected some of these segments (`capar correct {observation.capture}`); "
        "with --corrected, questions and reports use that"
    )


def _print(
    observation: "Observation",
    *,
    json: bool = False,
    script: bool,
    pars: bool,
    quiet: bool = False,
) -> None:
    if json:
        from capar.model.json_form import to_json

        typer.echo(to_json(observation), nl=False)
    elif script:
        from capar.views.script import script as written_script

        typer.echo(written_script(observation), nl=False)
    else:
        from capar.views.tables import par_text

        _tables(observation, quiet=quiet)
        every = (observation.complex_par, *observation.upars, *observation.ipars)
        for par in every if pars else ():
            typer.echo(f"\n{par_text(par)}", nl=False)


def _tables(observation: "Observation", *, quiet: bool) -> None:
    """Tables for a terminal; plain aligned columns for anything else."""
    from capar.views.notices import note_lines
    from capar.views.tables import (
        aligned,
        force_lines,
        joint_lines,
        segment_rows,
        segments_table,
        step_rows,
        steps_table,
        unknown_note,
    )

    if sys.stdout.isatty():
        table = segments_table(observation, width=console().width)
        print_whole(table, steps_table(observation.complex_par))
    else:
        for rows in (segment_rows(observation), step_rows(observation.complex_par)):
            typer.echo("\n".join(aligned(rows)) + "\n")
    unknown = (unknown_note(each) for each in observation.segments if not each.known)
    for line in (*joint_lines(observation), *force_lines(observation), *unknown):
        typer.echo(line)
    for line in () if quiet else note_lines(observation.notices):
        typer.echo(line, err=True)


def _draw(
    observation: "Observation", capture: "Capture", measurements: "Measurements", path: Path
) -> None:
    from capar.views.picture import draw

    speeds = {
        link.ee: (capture.times, measurements.tracks[link.ee].speed_mps)
        for link in observation.links
    }
    lost = {name: each.lost for name, each in measurements.bodies.poses.items()}
    save(path, lambda draft: draw(observation, speeds, path=draft, lost=lost), "drew")


def _fail_on_unknown(observation: "Observation") -> None:
    from capar.views.tables import unknown_note

    unknown = [unknown_note(each) for each in observation.segments if not each.known]
    if unknown:
        raise RuleError("no rule names every segment:\n  " + "\n  ".join(unknown))


def _ask_for_names(observation: "Observation", folder: Path) -> bool:
    """Ask for a name for each unknown feature set; whether any was given."""
    from capar.model.par import ACTION_NAME
    from capar.views.tables import unknown_note
    from capar_rules.authoring.user_rules import teach

    unknown = {each.features: each for each in observation.segments if not each.known}
    names = []
    question = "What is it called? (empty keeps it unknown)"
    for features, segment in unknown.items():
        typer.echo(unknown_note(segment), err=True)
        while True:
            answer = typer.prompt(question, default="", show_default=False, err=True).strip()
            if not answer or ACTION_NAME.fullmatch(answer):
                break
            typer.echo("A name reads like MoveObjTo: letters and digits, capital first.", err=True)
        if answer:
            names.append((answer, features))
    for path in teach(names, folder=folder):
        typer.echo(f"wrote {path}", err=True)
    return bool(names)


class _Live(NamedTuple):
    """What the options say of live observation."""

    source: str  # the capture that is replayed; empty with a device
    device: str
    rig: str
    calibration: Path | None
    lead_in_s: float
    speed: float  # how many times as fast as recorded a capture is replayed; 0: as fast as it goes
    json: bool
    name: str
    websocket: int | None
    markers: str


def _observe_live(options: _Live, rules: "Profile") -> "Observation":
    """Observe until the source ends or the user interrupts.

    Raises:
        CaparError: There is no source or two, or a device without a rig or a calibration.
    """
    if bool(options.source) == bool(options.device):
        raise CaparError("--live takes a CAPTURE to replay, or --device ADDRESS with --rig")
    if options.device and not options.rig:
        raise CaparError(
            "--device needs --rig: a capture bundle of the same bodies, such as an earlier "
            "take by `capar record`, which says what rides on which sensor"
        )
    if options.device and not options.calibration and options.lead_in_s <= 0.0:
        raise CaparError("--device needs --calibration FILE, or --lead-in SECONDS above 0")
    from capar.pipelines.live.frames import lead_in, paced, replayed
    from capar.pipelines.live.observer import LiveObserver
    from capar.pipelines.live.tracking import track
    from extractors.calibration import calibrate
    from extractors.devices.drivers import find_tracker
    from extractors.readers.bundle.capture_toml import read_capture

    known, name, least_s = _stored(options.calibration), options.name, options.lead_in_s
    if not options.device:
        trial = read_capture(options.source)
        known = known or calibrate(lead_in(trial, least_s) if least_s > 0.0 else trial)
        observer = LiveObserver(trial, known, rules=rules, name=name, sentences=True)
        return _run(observer, paced(replayed(trial), options.speed), options)
    rig = read_capture(options.rig)
    rig = replace(rig, name=name or "live", sources=(), notices=())
    with find_tracker(options.device) as tracker:
        observer, frames, batches = track(
            tracker, rig, known, least_s, rules=rules, say=lambda text: typer.echo(text, err=True)
        )
        seen = _run(observer, batches, options)
    typer.echo(f"{observer.frames} frames, {frames.filled} of them lost on the way", err=True)
    return seen


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


def _run(
    observer: "LiveObserver", batches: "Iterable[list[Poses]]", options: _Live
) -> "Observation":
    """Print events until the source ends or Ctrl-C; then settle what is left."""
    from capar.model.json_form import to_json

    with ExitStack() as opened:
        sends = list(_programs(options, opened))
        if not options.json:
            typer.echo(LIVE_COLUMNS)
        try:
            for batch in batches:
                _print_events(observer.push(batch), options, sends)
        except KeyboardInterrupt:
            typer.echo("ended", err=True)
        if observer.frames < 2:
            raise CaparError("no frames came: nothing was observed")
        events, seen = observer.finish()
        _print_events(events, options, sends)
    if options.json:
        whole = {"event": "observation", "observation": codec.loads(to_json(seen))}
        typer.echo(codec.dumps(whole, ensure_ascii=False))
    return seen


def _programs(options: _Live, opened: ExitStack) -> Iterator[Callable[[str], None]]:
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


def _print_events(
    events: "list[SegmentEvent]", options: _Live, sends: list[Callable[[str], None]]
) -> None:
    for event in events:
        line = codec.dumps(event.row(), ensure_ascii=False)
        typer.echo(line if options.json else event)
        for send in sends:
            send(line)
