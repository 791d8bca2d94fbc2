"""``capar new-capture``: a first capture.toml from what motion files hold."""

import json
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def new_capture(
    files: Annotated[
        list[Path] | None, typer.Argument(help="Motion files of one trial.", show_default=False)
    ] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="The capture.toml to write, or its folder.")
    ] = Path("capture.toml"),
    force: Annotated[bool, typer.Option("--force", help="Overwrite what is there.")] = False,
    schema: Annotated[
        bool, typer.Option("--schema", help="Print the JSON schema of capture.toml, for editors.")
    ] = False,
) -> None:
    """Write a commented capture.toml that a person then edits; it is read back at once."""
    if schema:
        from extractors.readers.schema.reference import json_schema

        typer.echo(json.dumps(json_schema(), indent=2))
        return
    from capar.model.errors import CaparError

    if not files:
        raise CaparError("no motion file is named; like capar new-capture recording.c3d")
    _write_draft(files, output, force=force)


def _write_draft(files: list[Path], output: Path, *, force: bool) -> None:
    from capar.cli._output import written
    from capar.model.errors import CaparError, FileError
    from extractors.readers.bundle.capture_toml import read_capture
    from extractors.readers.drafting.draft import EDIT, draft
    from extractors.readers.registry import read_recording

    folder = output.is_dir() or output.suffix != ".toml"
    path = output / "capture.toml" if folder else output
    if path.exists() and not force:
        raise FileError(path, "is there already.", "Name another with -o, or say --force.")
    recordings = [read_recording(each) for each in files]
    text = draft(recordings, path.parent, files[0].name.split(".")[0])
    path.parent.mkdir(parents=True, exist_ok=True)
    with written(path) as draft_file:
        draft_file.write_text(text, encoding="utf-8")
    typer.echo(f"wrote {path}")
    for number, line in enumerate(text.splitlines(), 1):
        if EDIT in line:
            typer.echo(f"{path}:{number}: look at: {line.strip()}")
    try:
        capture = read_capture(path)
    except CaparError as error:
        typer.echo(f"it cannot be read yet: {error}")
    else:
        typer.echo(
            f"it reads as a capture of {len(capture.times)} frames at {capture.rate_hz:.4g} Hz; "
            f"sensors: {len(capture.sensors)}, objects: {len(capture.objects)}"
        )
