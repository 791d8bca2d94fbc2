"""Look at captures: what a file holds, a first capture.toml, a picture, the measured facts."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from capar.cli.options import Beside, Capture, Json, ProfileName, Rules, Set, Steady, rule_base
from capar.cli.output import answer, console, emit, print_json, save
from capar.model.errors import CaparError, FileError

if TYPE_CHECKING:
    from capar.model.capture import Capture as CaptureData
    from capar.model.capture import Notice, Stream


def inspect(
    place: Annotated[str, Argument(help="A capture (FOLDER:TAKE), or a motion file.")],
    json: Json = False,
    calibration: Annotated[
        bool, Option("--calibration", help="Print what holds throughout.")
    ] = False,
    set_: Set = None,
) -> None:
    """Say what a capture or motion file holds.

    That is its streams with rate, gaps, noise and range, and which bodies come near each other.
    """
    if calibration:
        from capar.model.json_form import to_json
        from capar.views.tables import calibration_tables
        from extractors.calibration import calibrate, set_values
        from extractors.readers.bundle.capture_toml import read_capture

        known = set_values(calibrate(read_capture(place)), set_ or [])
        if json:
            typer.echo(to_json(known), nl=False)
        else:
            console().print(*calibration_tables(known))
        return
    path = Path(place)
    bundled = path.suffix == ".toml" or not path.exists() or (path / "capture.toml").is_file()
    report = _of_capture(place) if bundled else _of_file(path)
    if not json:
        report["notices"] = [f"{told['code']}: {told['message']}" for told in report["notices"]]
    answer(report, json=json, sort_keys=True)


def _of_capture(place: str) -> dict[str, Any]:
    from capar.model.capture import recorded_at
    from extractors.readers.bundle.capture_toml import read_capture

    capture = read_capture(place)
    kinds = {sensor.name: f"sensor, {sensor.role.value}" for sensor in capture.sensors}
    kinds |= {thing.name: f"object, {thing.tag.value}" for thing in capture.objects}
    streams = {name: body.stream for name, body in capture.bodies.items()}
    shapes = {n: body.shape.description for n, body in capture.bodies.items() if body.shape}
    head = {
        "name": capture.name,
        "frames": len(capture.times),
        "rate_hz": capture.rate_hz,
        "recorded_at": recorded_at(capture.sources),
        "shapes": shapes,
        "notices": [found.document() for found in (*capture.notices, *_findings(capture))],
        "sources": [{"path": s.path, "format": s.format} for s in capture.sources],
    }
    return head | _surveyed(streams, kinds)


def _surveyed(streams: "Mapping[str, Stream]", kinds: Mapping[str, str]) -> dict[str, Any]:
    from extractors.readers.drafting.survey import as_json, near_pairs, survey

    surveys = [survey(name, kinds[name], stream) for name, stream in streams.items()]
    return as_json(surveys, near_pairs(streams))


def _findings(capture: "CaptureData") -> "Iterator[Notice]":
    """Faults that only measuring finds: motion without a mover, falls, sizes and distances."""
    from capar.model.notices import KINDS
    from capar.pipelines.observation import unmoved_notices
    from capar_rules.borders.deflicker import steady
    from capar_rules.movers.movers import movers
    from extractors.measure import measure

    measured = measure(capture)
    facts = steady(measured.facts)
    found = unmoved_notices((*facts, *movers(facts)), capture.times)
    yield from (told for told in (*measured.notices, *found) if KINDS[told.code].fault)


def _of_file(path: Path) -> dict[str, Any]:
    import numpy as np

    from capar.model.capture import Stream, notice
    from extractors.readers.registry import read_recording

    recording = read_recording(path)
    metres = recording.unit_m or 1.0
    streams = {
        name: Stream(stream.times, stream.positions * metres, stream.orientations)
        for name, stream in recording.bodies.items()
    }
    kinds = dict.fromkeys(streams, "body")
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (len(recording.marker_times), 1))
    for name, points in recording.markers.items():
        streams[name] = Stream(recording.marker_times, points * metres, upright)
        kinds[name] = "marker"
    unit = [notice("no-unit")] if recording.unit_m is None else []
    head = {
        "name": path.name,
        "format": recording.format,
        "frames": len(recording.times),
        "recorded_at": recording.source.recorded_at,
        "notices": [told.document() for told in (*recording.notices, *unit)],
        "sources": [{"path": recording.source.path, "format": recording.format}],
    }
    return head | _surveyed(streams, kinds)


def new_capture(
    files: Annotated[list[Path] | None, Argument(help="Motion files of one trial.")] = None,
    output: Annotated[Path, Option("--output", "-o", help="Its file or folder.")] = Path(
        "capture.toml"
    ),
    force: Annotated[bool, Option("--force", help="Overwrite what is there.")] = False,
    schema: Annotated[bool, Option("--schema", help="Print the JSON schema of it.")] = False,
) -> None:
    """Write a commented capture.toml for motion files.

    It is read back at once, and the lines that need a look are listed.
    """
    from extractors.readers.bundle.capture_toml import read_capture, takes
    from extractors.readers.drafting.draft import EDIT, draft
    from extractors.readers.registry import own_bundle, read_recording, says_itself

    if schema:
        from extractors.readers.schema.reference import json_schema

        print_json(json_schema())
        return
    if not files:
        raise CaparError("no motion file is named; like capar new-capture recording.c3d")
    folder = output.is_dir() or output.suffix != ".toml"
    path = output / "capture.toml" if folder else output
    if path.exists() and not force:
        raise FileError(path, "is there already.", "Name another with -o, or say --force.")
    shown = Path(os.path.relpath(files[0].resolve(), path.parent.resolve())).as_posix()
    first, *_ = takes(files[0]) or [""] if says_itself(files[0]) else [""]
    text = own_bundle(files[0], shown, first) or draft(
        [read_recording(each) for each in files], path.parent, files[0].name.split(".")[0]
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    emit(text, path)
    typer.echo(f"wrote {path}")
    for number, line in enumerate(text.splitlines(), 1):
        if EDIT in line:
            typer.echo(f"{path}:{number}: look at: {line.strip()}")
    try:
        capture = read_capture(f"{path}:{first}" if first else path)
    except CaparError as error:
        typer.echo(f"it cannot be read yet: {error}")
    else:
        typer.echo(
            f"it reads as a capture of {len(capture.times)} frames at {capture.rate_hz:.4g} Hz; "
            f"sensors: {len(capture.sensors)}, objects: {len(capture.objects)}"
        )


def view(
    capture: Capture,
    html: Annotated[Path | None, Option(help="Write a file for any browser.")] = None,
    png: Annotated[Path | None, Option(help="Draw the moment --at to a PNG file.")] = None,
    at: Annotated[float | None, Option(help="Which moment [s]; the middle if not given.")] = None,
    profile: ProfileName = "extended",
    rules: Rules = None,
    fit: Annotated[bool, Option("--fit", help="Show a fitted human body too.")] = False,
    only_bodies: Annotated[bool, Option("--only-bodies", help="Leave out the timeline.")] = False,
) -> None:
    """Show the bodies of a capture in three dimensions.

    Use it before anything else on a capture.toml of your own: wrong units, axes and mounts are
    seen at once. Under the bodies a timeline shows what was observed.
    """
    from capar.pipelines.observation import observe
    from capar.views.viewer.stage import stage, virtual_hands, with_fingers
    from extractors.readers.bundle.capture_toml import read_capture

    if at is not None and png is None:
        raise CaparError("--at is the moment of a picture: give --png FILE too")
    if html is None and png is None:
        raise CaparError("nothing to write: give --html FILE, or --png FILE with --at SECONDS")
    trial = read_capture(capture)
    shown, timeline = stage(trial, at_s=at), html is not None and not only_bodies
    hands = any(True for _ in virtual_hands(trial))
    found = observe(trial, rules=rule_base(profile, rules)) if timeline or hands or fit else None
    facts = found.facts if found else ()
    shown = with_fingers(shown, trial, facts)
    if fit:
        from capar.body.body_fitting import fit_body
        from capar.body.grasping import fingered_fit
        from capar.views.viewer.stage import with_mannequin

        made = fingered_fit(fit_body(capture, trial), trial, facts)
        shown = with_mannequin(shown, made)
    if png is not None:
        from capar.views.viewer.snapshot import snapshot

        moment = at if at is not None else float(shown.times.mean())
        save(png, lambda draft: snapshot(shown, moment, draft), "drew")
    if html is not None:
        from capar.views.viewer.web_page import web_page

        save(html, web_page(shown, found if timeline else None))
        typer.echo("open it in a browser", err=True)


def facts(
    capture: Capture,
    profile: ProfileName = "extended",
    ranked: Annotated[bool, Option(help="Number the borders too, for the rules.")] = True,
    derive: Annotated[
        bool,
        Option("--derive", help="Add contact/3, moved/2 and regrasps/2 as the rules derive them."),
    ] = False,
    rules: Rules = None,
    actionary: Beside = None,
    steady: Steady = None,
) -> None:
    """Print the measured facts of a capture as an ASP program.

    clingo reads it together with the rule files that it names.
    """
    from capar.model.facts import program
    from capar.pipelines.observation import facts_program
    from capar_rules.engine.solver import rule_file, solve, text_of
    from extractors.readers.bundle.capture_toml import read_capture

    base = rule_base(profile, rules, actionary, steady=steady)
    trial = read_capture(capture)
    measurements, borders = facts_program(trial, rules=base)
    typer.echo(f"% {trial.name}: what was measured.\n{program(measurements.facts)}", nl=False)
    if ranked:
        typer.echo(
            f"% Borders, numbered for the profile {base.name}.\n{program(borders)}", nl=False
        )
        typer.echo(f"% Rules: {' '.join(map(str, base.files))}")
    if derive:
        files = (*base.files, rule_file("explain/derived.lp"))
        answer = solve(files, (*measurements.facts, *borders))
        typer.echo("% Derived.")
        for name in ("contact", "moved", "regrasps"):
            for arguments in answer.of(name):
                typer.echo(f"{text_of((name, *arguments))}.")
