"""Share the Actionary: import, export and backup."""

import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from capar.cli import options
from capar.cli.output import answer, check_new_folder, check_writable, emit, save
from capar.model.errors import CaparError, FileError, UnknownNameError


def import_(
    file: Annotated[str, Argument(help="The file, or - for standard input.")],
    format_: Annotated[str | None, Option("--format", help="turtle, trig, nquads, jsonld.")] = None,
    wait: options.Wait = 0.0,
    new: options.New = False,
    actionary: options.Place = None,
) -> None:
    """Import Turtle, TriG, N-Quads or JSON-LD.

    All of it or none is taken, checked by the shapes.
    An observation in FILE replaces the one of its name.
    """
    from kb import Actionary
    from kb.exchange import bring_in, format_of, read

    chosen = format_of(file, format_)
    options.confirm_new(actionary, new=new)
    quads = read(_bytes(file), chosen, path=file)
    with Actionary.open(actionary, wait_s=wait) as opened:
        statements, observations = bring_in(opened.store, quads, source=file)
    typer.echo(f"{statements} statements, {observations} observations")


def _bytes(file: str) -> bytes:
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
            help="Where to; else standard output. Of a plan, whose action it is.",
        ),
    ] = None,
    format_: Annotated[
        str | None,
        Option(
            "--format", help="turtle, trig, nquads, jsonld or rdfxml; of a plan pddl, bt or bml."
        ),
    ] = None,
    output: Annotated[
        Path | None, Option(help="Of a plan: a file, or for pddl a new folder.")
    ] = None,
    observation: Annotated[str | None, Option(help="Only this one, with what it mentions.")] = None,
    soma: Annotated[bool, Option("--soma", help="An episode in terms of SOMA and DUL.")] = False,
    actionary: options.Place = None,
) -> None:
    """Export the Actionary or an observation as RDF, or a plan.

    With --format pddl, bt or bml: the action of CAPTURE or OBSERVATION as a plan for others.
    """
    from capar.pipelines.plan_export import PLAN_FORMATS
    from kb import Actionary
    from kb.exchange import FORMATS, export_episode, format_of, misplaced
    from kb.exchange import export as exported

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
        graphless = chosen in {"turtle", "rdfxml"} and observation is None
        lost = misplaced(opened.store) if graphless else 0
    if lost:
        typer.echo(
            f"capar: {chosen} has no graphs; {lost} statements would come back in another one. "
            "TriG and N-Quads keep them.",
            err=True,
        )
    if file is None:
        sys.stdout.buffer.write(data)
    else:
        save(
            file, data, f"wrote {observation or 'everything'}, {len(data):,} bytes of {chosen}, to"
        )


def _export_plan(name: str, format_: str, output: Path | None, actionary: str | None) -> None:
    """Write a complex action as a plan; PDDL's two files go to a folder.

    The action is that of a capture at a path, else of an observation in the Actionary.
    """
    from capar.pipelines.plan_export import observed_plan, plan_files, stored_plan
    from kb import Actionary

    if not name:
        raise CaparError(f"--format {format_} writes one action; name a capture or an observation")
    folder = format_ == "pddl"
    if folder and output is None:
        raise CaparError("PDDL is two files, a domain and a problem; name a folder by --output")
    if output is not None:
        (check_new_folder if folder else check_writable)(output)
    place = options.opened(actionary)
    if Path(name).exists() or Path(name.rpartition(":")[0] or name).exists():
        source = observed_plan(name)
    elif options.has_actionary(place, named=actionary):
        with Actionary.open(place, read_only=True) as words:
            source = stored_plan(words, name)
    else:
        raise FileError(
            name, f"is no capture, and {place} is no Actionary that could hold an observation.",
            "Name a capture's folder, or an Actionary by --actionary.",
        )  # fmt: skip
    files = plan_files(source, format_)
    if output is None:
        typer.echo("".join(files.values()), nl=False)
        return
    if folder:
        output.mkdir(exist_ok=True)
    for file, text in files.items():
        emit(text, output / file if folder else output)
    typer.echo(f"wrote {name} to {output} as {format_}", err=True)


def backup(
    file: Annotated[Path | None, Argument(help="Where to; else beside the Actionary.")] = None,
    json: options.Json = False,
    actionary: options.Place = None,
) -> None:
    """Write all that the Actionary holds to a file, and its rules.

    The rules are written beside it.
    `capar import FILE --actionary FOLDER` makes it again, in a folder that is not there yet.
    """
    from capar_rules.authoring.user_rules import actionary_rules
    from kb import Actionary
    from kb.exchange import back_up, back_up_rules
    from kb.store.stores import is_address

    options.require_actionary(actionary, observed=True)
    place = options.opened(actionary)
    if file is None and is_address(place):
        raise FileError(place, "is a server.", "Say where its backup goes: capar backup FILE.nq")
    folder, now = Path(place).absolute(), datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    target = file or folder.with_name(f"{folder.name}.{now}.nq")
    with Actionary.open(actionary, read_only=True) as book:
        statements = back_up(book.store, target)
    rules = [str(each) for each in back_up_rules(actionary_rules(place), target)]
    restored = f"To restore: capar import {target} --actionary NEW_FOLDER --new"
    answer(
        {"file": str(target), "statements": statements, "rules": rules},
        [f"{target}: {statements} statements", *rules, restored],
        json=json,
    )
