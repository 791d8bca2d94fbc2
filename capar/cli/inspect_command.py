"""``capar inspect``: what a capture or a motion file holds."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from capar.cli._options import Set
from capar.cli._output import console, print_json

if TYPE_CHECKING:
    from collections.abc import Iterator

    from capar.model.capture import Capture, Notice

app = typer.Typer()

STREAM_COLUMNS = (
    "stream", "kind", "s", "Hz", "jitter ms", "lost", "longest gap s", "rest mm", "rest deg",
    "range m",
)  # fmt: skip
PAIR_COLUMNS = ("nearest pairs", "", "least m", "at s", "near for s")


@app.command()
def inspect(
    place: Annotated[
        str, typer.Argument(help="A folder with a capture.toml (and :take), or a motion file.")
    ],
    as_json: Annotated[bool, typer.Option("--json", help="Print for machines.")] = False,
    calibration: Annotated[
        bool,
        typer.Option("--calibration", help="Say what is decided once for the whole capture."),
    ] = False,
    set_: Set = None,
) -> None:
    """Say what a capture holds: streams, rate, gaps, noise, ranges and near pairs."""
    if calibration:
        _calibration(place, set_ or [], as_json=as_json)
        return
    report = _report(place)
    if as_json:
        print_json(report, sort_keys=True)
    else:
        _show(report)


def _calibration(place: str, settings: list[str], *, as_json: bool) -> None:
    from capar.model.json_form import to_json
    from capar.views.calibration import calibration_tables
    from extractors.calibration import calibrate
    from extractors.readers.bundle.capture_toml import read_capture
    from extractors.set_values import set_values

    known = set_values(calibrate(read_capture(place)), settings)
    if as_json:
        typer.echo(to_json(known), nl=False)
        return
    for table in calibration_tables(known):
        console().print(table)


def _report(place: str) -> dict[str, Any]:
    path = Path(place)
    bundled = path.suffix == ".toml" or not path.exists() or (path / "capture.toml").is_file()
    if bundled:
        return _of_capture(place)
    return _of_file(path)


def _of_capture(place: str) -> dict[str, Any]:
    from capar.model.capture import recorded_at
    from extractors.readers.bundle.capture_toml import read_capture
    from extractors.readers.drafting.survey import as_json, near_pairs, survey

    capture = read_capture(place)
    kinds = {sensor.name: f"sensor, {sensor.role.value}" for sensor in capture.sensors}
    kinds |= {thing.name: f"object, {thing.tag.value}" for thing in capture.objects}
    streams = {name: body.stream for name, body in capture.bodies.items()}
    surveys = [survey(name, kinds[name], stream) for name, stream in streams.items()]
    head = {
        "name": capture.name,
        "frames": len(capture.times),
        "rate_hz": capture.rate_hz,
        "recorded_at": recorded_at(capture.sources),
        "shapes": {
            name: body.shape.description for name, body in capture.bodies.items() if body.shape
        },
        "notices": [found.document() for found in (*capture.notices, *_findings(capture))],
        "sources": [{"path": s.path, "format": s.format} for s in capture.sources],
    }
    return head | as_json(surveys, near_pairs(streams))


def _findings(capture: "Capture") -> "Iterator[Notice]":
    """What measuring finds to be wrong: motion without a mover, falls, sizes and distances."""
    from capar.model.notices import KINDS
    from capar.pipelines.movers import unmoved_notices
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
    from extractors.readers.drafting.survey import as_json, near_pairs, survey
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
    notices = [told.document() for told in (*recording.notices, *unit)]
    surveys = [survey(name, kinds[name], stream) for name, stream in streams.items()]
    head = {
        "name": path.name,
        "format": recording.format,
        "frames": len(recording.times),
        "recorded_at": recording.source.recorded_at,
        "notices": notices,
        "sources": [{"path": recording.source.path, "format": recording.format}],
    }
    return head | as_json(surveys, near_pairs(streams))


def _show(report: dict[str, Any]) -> None:
    from capar.views.tables import terminal_table

    out = console()
    when = f"recorded {report['recorded_at']}" if report["recorded_at"] else "no date of recording"
    out.print(f"[bold]{report['name']}[/]: {report['frames']} frames, {when}")
    rows = [
        (
            stream["name"], stream["kind"], f"{stream['seconds']:.2f}", f"{stream['rate_hz']:.1f}",
            f"{stream['jitter_ms']:.1f}", str(stream["lost"]), f"{stream['longest_gap_s']:.2f}",
            _figure(stream["noise_mm"]), _figure(stream["noise_deg"]),
            " x ".join(f"{length:.2f}" for length in stream["range_m"] or ()) or "-",
        )
        for stream in report["streams"]
    ]  # fmt: skip
    out.print(terminal_table(STREAM_COLUMNS, rows, names={0}))
    if report["pairs"]:
        pairs = [
            (
                pair["first"], pair["second"], f"{pair['least_m']:.3f}",
                f"{pair['at_s']:.2f}", f"{pair['near_s']:.2f}",
            )
            for pair in report["pairs"]
        ]  # fmt: skip
        out.print(terminal_table(PAIR_COLUMNS, pairs, names={0, 1}))
    for name, text in report.get("shapes", {}).items():
        out.print(f"shape of {name}: {text}", highlight=False)
    for told in report["notices"]:
        out.print(f"[yellow]{told['code']}[/]: {told['message']}", highlight=False)


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"
