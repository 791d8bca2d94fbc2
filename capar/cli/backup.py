"""Write a copy of the Actionary from which it can be made again."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from capar.cli._options import Place, opened, require_actionary

app = typer.Typer()


@app.command()
def backup(
    file: Annotated[
        Path | None,
        typer.Argument(help="Where to, as N-Quads; else beside the Actionary, by date and time."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    actionary: Place = None,
) -> None:
    """Write all that the Actionary holds to FILE, and its rules beside it; both are read again.

    `capar import FILE --actionary FOLDER` makes it again, in a folder that is not there yet.
    """
    from capar.cli._output import print_json
    from capar.model.errors import FileError
    from capar_rules.authoring.user_rules import actionary_rules
    from kb import Actionary
    from kb.backup import back_up, back_up_rules
    from kb.store.stores import is_address

    require_actionary(actionary, observed=True)
    place = opened(actionary)
    if file is None and is_address(place):
        raise FileError(place, "is a server.", "Say where its backup goes: capar backup FILE.nq")
    target = file or _beside(Path(place).absolute())
    with Actionary.open(actionary, read_only=True) as book:
        statements = back_up(book.store, target)
    rules = back_up_rules(actionary_rules(place), target)
    if json:
        print_json({"file": str(target), "statements": statements, "rules": list(map(str, rules))})
        return
    typer.echo(f"{target}: {statements} statements")
    for rule_file in rules:
        typer.echo(str(rule_file))
    typer.echo(f"To restore: capar import {target} --actionary NEW_FOLDER --new")


def _beside(folder: Path) -> Path:
    now = datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    return folder.with_name(f"{folder.name}.{now}.nq")
