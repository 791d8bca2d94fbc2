"""The command that shows a capture in three dimensions."""

from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import Rules, rule_base

app = typer.Typer()


@app.command()
def view(
    capture: Annotated[
        str,
        typer.Argument(help="A capture bundle's folder or capture.toml; FOLDER:TAKE for a take."),
    ],
    html: Annotated[
        Path | None,
        typer.Option(help="Write one HTML file that opens in a browser without a network."),
    ] = None,
    png: Annotated[Path | None, typer.Option(help="Draw the moment --at to a PNG file.")] = None,
    at: Annotated[
        float | None, typer.Option(help="Which moment [s]; the middle if not given.")
    ] = None,
    profile: Annotated[
        str, typer.Option(help="The rules that name what the timeline shows: extended or thesis.")
    ] = "extended",
    rules: Rules = None,
    fit: Annotated[
        bool,
        typer.Option("--fit", help="Fit a human body to the recording and show it too."),
    ] = False,
    only_bodies: Annotated[
        bool,
        typer.Option("--only-bodies", help="Show what the recording holds, without observing it."),
    ] = False,
) -> None:
    """Show the bodies of CAPTURE as they moved, over what was found in them.

    Use it before anything else on a capture.toml of your own: wrong units, axes and mounts are
    seen at once.
    """
    from capar.cli._output import written
    from capar.model.errors import CaparError
    from capar.views.viewer.stage import stage
    from extractors.readers.bundle.capture_toml import read_capture

    if at is not None and png is None:
        raise CaparError("--at is the moment of a picture: give --png FILE too")
    if html is None and png is None:
        raise CaparError("nothing to write: give --html FILE, or --png FILE with --at SECONDS")
    trial = read_capture(capture)
    shown = stage(trial, at_s=at)
    if fit:
        from capar.body.whole_bodies import fit_body
        from capar.views.viewer.mannequin import with_mannequin

        shown = with_mannequin(shown, fit_body(capture, trial))
    if png is not None:
        from capar.views.viewer.snapshot import snapshot

        with written(png) as draft:
            snapshot(shown, at if at is not None else float(shown.times.mean()), draft)
        typer.echo(f"drew {png}")
    if html is not None:
        from capar.pipelines.observation import observe
        from capar.views.viewer.web_page import web_page

        found = None if only_bodies else observe(trial, rules=rule_base(profile, rules))
        page = web_page(shown, found)
        with written(html) as draft:
            draft.write_text(page, encoding="utf-8")
        typer.echo(f"wrote {html}: open it in a browser")
