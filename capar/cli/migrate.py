"""Bring what an older program kept to the present schema."""

from pathlib import Path
from typing import Annotated

import typer

from capar.cli.options import Place, Wait


def migrate(
    files: Annotated[
        list[Path] | None,
        typer.Argument(help="Observations as JSON; if there are none, the Actionary."),
    ] = None,
    backup: Annotated[
        Path | None,
        typer.Option(help="Where the Actionary is exported to before; else beside its folder."),
    ] = None,
    wait: Wait = 0.0,
    actionary: Place = None,
) -> None:
    """Bring the Actionary, or FILES of observations, to the present schema; a backup first."""
    for file in files or ():
        _migrate_file(file)
    if actionary is None and files:
        return
    from kb.migration import migrate as migrated
    from kb.store.schema import SCHEMA
    from kb.store.stores import place

    done = migrated(place(actionary), backup=backup, wait_s=wait)
    _tell(done.place, done.found, SCHEMA, done.backup)


def _migrate_file(path: Path) -> None:
    from capar.cli.output import written
    from capar.model.errors import FileError
    from capar.model.json_form import SCHEMA, from_json, migrated, to_json, version

    try:
        text = path.read_text("utf-8")
    except UnicodeDecodeError as error:
        raise FileError(path, f"is no JSON ({error})") from None
    found = version(text, where=str(path))
    kept = path.with_name(f"{path.stem}.schema-{found}{path.suffix}")
    if found == SCHEMA:
        _tell(str(path), found, SCHEMA, None)
        return
    new = to_json(from_json(migrated(text, where=str(path)), where=str(path)))
    if kept.exists():
        raise FileError(kept, "exists already.", "Move it away; the backup takes its name.")
    with written(kept) as draft:
        draft.write_text(text, "utf-8")
    with written(path) as draft:
        draft.write_text(new, "utf-8")
    _tell(str(path), found, SCHEMA, kept)


def _tell(place: str, found: int, now: int, backup: Path | None) -> None:
    if backup is None:
        typer.echo(f"{place}: is of schema {now} already")
    else:
        typer.echo(f"{place}: migrated from schema {found} to {now}; backup: {backup}")
