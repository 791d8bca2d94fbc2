"""Share the Actionary: import, export and backup."""

import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from capar.cli.options import Json, New, Place, Wait, confirm_new, opened, require_actionary

if TYPE_CHECKING:
    from capar.export.plans import PlanSource


def import_(
    file: Annotated[str, Argument(help="The file, or - for standard input.")],
    format_: Annotated[
        str | None,
        Option("--format", help="turtle, trig, nquads or jsonld; else by the file's name."),
    ] = None,
    wait: Wait = 0.0,
    new: New = False,
    actionary: Place = None,
) -> None:
    """Import Turtle, TriG, N-Quads or JSON-LD.

    All of it or none is taken, checked by the shapes.
    An observation in FILE replaces the one of its name.
    """
    from kb import Actionary
    from kb.exchange import bring_in, format_of, read

    chosen = format_of(file, format_)
    confirm_new(actionary, new=new)
    quads = read(_bytes(file), chosen, path=file)
    with Actionary.open(actionary, wait_s=wait) as opened:
        statements, observations = bring_in(opened.store, quads, source=file)
    typer.echo(f"{statements} statements, {observations} observations")


def _bytes(file: str) -> bytes:
    from capar.model.errors import FileError

    if file == "-":
        return sys.stdin.buffer.read()
    try:
        return Path(file).read_bytes()
    except OSError as error:
        raise FileError(file, f"cannot be read ({error.strerror})") from None


def export(
    file: Annotated[
        Path | None,
        Argument(
            metavar="[FILE|CAPTURE|OBSERVATION]",
            help="Where to; standard output if left out. Of a plan: the capture, or the stored "
            "observation, whose action is written.",
        ),
    ] = None,
    format_: Annotated[
        str | None,
        Option(
            "--format",
            help="turtle, trig, nquads, jsonld or rdfxml; else by the file's name. Of a plan: "
            "pddl (domain and problem), bt (BehaviorTree.CPP 4) or bml (BML 1.0).",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        Option(help="Of a plan: a file, or for pddl a new folder; else standard output."),
    ] = None,
    observation: Annotated[
        str | None, Option(help="Only this observation, with all that it mentions.")
    ] = None,
    soma: Annotated[
        bool,
        Option(
            "--soma", help="Write the observation as an episode in terms of SOMA and DUL alone."
        ),
    ] = False,
    actionary: Place = None,
) -> None:
    """Export the Actionary or an observation as RDF, or a plan.

    With --format pddl, bt or bml: the action of CAPTURE or OBSERVATION as a plan for others.
    """
    from capar.cli.output import check_writable, written
    from capar.model.errors import CaparError, UnknownNameError
    from capar.pipelines.plan_export import PLAN_FORMATS
    from kb.exchange import FORMATS

    if format_ is not None and format_ not in {*FORMATS, *PLAN_FORMATS}:
        raise UnknownNameError("format", format_, [*FORMATS, *PLAN_FORMATS])
    if format_ in PLAN_FORMATS:
        if soma:
            raise CaparError("--soma writes RDF; leave it out, or --format")
        _export_plan(str(file or observation or ""), format_, output, actionary)
        return
    if output is not None:
        raise CaparError(
            "--output is of a plan (--format pddl, bt or bml); RDF goes to FILE: "
            "`capar export FILE --format trig`"
        )
    from kb import Actionary
    from kb.exchange import export as exported
    from kb.exchange import export_episode, format_of, misplaced

    if soma and observation is None:
        raise CaparError("--soma writes one episode; name it by --observation")
    chosen = format_of(file or "", format_ or (None if file else "trig"))
    if file is not None:
        check_writable(file)
    with Actionary.open(actionary, read_only=True) as opened:
        if soma and observation is not None:
            data = export_episode(opened.store, chosen, observation)
        else:
            data = exported(opened.store, chosen, observation=observation)
        lost = (
            misplaced(opened.store) if chosen in {"turtle", "rdfxml"} and observation is None else 0
        )
    if lost:
        typer.echo(
            f"capar: {chosen} has no graphs; {lost} statements would come back in another one. "
            "TriG and N-Quads keep them.",
            err=True,
        )
    if file is None:
        sys.stdout.buffer.write(data)
        return
    with written(file) as draft:
        draft.write_bytes(data)
    what = f"observation {observation}" if observation else "everything"
    typer.echo(f"wrote {what} to {file}: {len(data):,} bytes of {chosen}", err=True)


def _export_plan(name: str, format_: str, output: Path | None, actionary: str | None) -> None:
    """Write a complex action as a plan; PDDL's two files go to a folder."""
    from capar.cli.output import check_new_folder, check_writable, written
    from capar.model.errors import CaparError
    from capar.pipelines.plan_export import plan_files

    if not name:
        raise CaparError(f"--format {format_} writes one action; name a capture or an observation")
    folder = format_ == "pddl"
    if folder and output is None:
        raise CaparError("PDDL is two files, a domain and a problem; name a folder by --output")
    if output is not None:
        (check_new_folder if folder else check_writable)(output)
    files = plan_files(_plan_source(name, actionary), format_)
    if output is None:
        typer.echo("".join(files.values()), nl=False)
        return
    if folder:
        output.mkdir(exist_ok=True)
    for file, text in files.items():
        with written(output / file if folder else output) as draft:
            draft.write_text(text, "utf-8")
    typer.echo(f"wrote {name} to {output} as {format_}", err=True)


def _plan_source(name: str, actionary: str | None) -> "PlanSource":
    """The action of a capture at a path, else of an observation in the Actionary."""
    from capar.cli.options import has_actionary, opened
    from capar.model.errors import FileError
    from capar.pipelines.plan_export import capture_plan, stored_plan
    from kb import Actionary

    if Path(name).exists() or Path(name.rpartition(":")[0] or name).exists():
        return capture_plan(name)
    place = opened(actionary)
    if not has_actionary(place, named=actionary):
        raise FileError(
            name, f"is no capture, and {place} is no Actionary that could hold an observation.",
            "Name a capture's folder, or an Actionary by --actionary.",
        )  # fmt: skip
    with Actionary.open(place, read_only=True) as words:
        return stored_plan(words, name)


def backup(
    file: Annotated[
        Path | None,
        Argument(help="Where to, as N-Quads; else beside the Actionary, by date and time."),
    ] = None,
    json: Json = False,
    actionary: Place = None,
) -> None:
    """Write all that the Actionary holds to a file, and its rules.

    The rules are written beside it.
    `capar import FILE --actionary FOLDER` makes it again, in a folder that is not there yet.
    """
    from capar.cli.output import print_json
    from capar.model.errors import FileError
    from capar_rules.authoring.user_rules import actionary_rules
    from kb import Actionary
    from kb.exchange import back_up, back_up_rules
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
