"""Ask the Actionary: questions, drawings of actions, checks, and an HTTP server."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from capar.cli.options import Corrected, Json, Place
from capar.cli.output import answer, print_table
from capar.model.errors import CaparError, FileError, UnknownNameError

if TYPE_CHECKING:
    from kb.store.answer_values import Answer


TimeLimit = Annotated[float, Option(metavar="SECONDS", help="How long a query may take.")]


def _names(incomplete: str) -> list[tuple[str, str]]:
    """Names of questions that begin so, for the shell."""
    from kb.queries.questions import questions

    return [(n, q.text) for n, q in questions().items() if n.startswith(incomplete)]


def _parameters(ctx: typer.Context, incomplete: str) -> list[tuple[str, str]]:
    """Parameters of the question that was named, for the shell."""
    from kb.queries.questions import questions

    asked = questions().get(str(ctx.params.get("question") or ""))
    found = [(f"{each.name}=", each.meaning) for each in asked.parameters] if asked else []
    return [each for each in found if each[0].startswith(incomplete)]


def query(
    question: Annotated[
        str | None,
        Argument(
            help="A question's name, SPARQL, its file, or - for standard input.",
            autocompletion=_names,
        ),
    ] = None,
    parameters: Annotated[
        list[str] | None,
        Argument(
            metavar="[NAME=VALUE]...",
            help="What a named question is asked of.",
            autocompletion=_parameters,
        ),
    ] = None,
    list_: Annotated[bool, Option("--list", help="List the named questions.")] = False,
    format_: Annotated[str, Option("--format", help="table, csv, json or turtle.")] = "table",
    json: Annotated[bool, Option("--json", help="The same as --format json.")] = False,
    time_limit: TimeLimit = 30.0,
    corrected: Corrected = False,
    actionary: Place = None,
) -> None:
    """Ask a named question (see --list) or any SPARQL.

    A query can neither write nor run longer than --time-limit.
    """
    from kb import Actionary
    from kb.queries.questions import FORMATS, check_known, listing, notes
    from kb.queries.questions import question as named
    from kb.store import sparql

    chosen = "json" if json else format_
    if chosen not in FORMATS:
        raise UnknownNameError("format", chosen, FORMATS)
    if list_ or question is None:
        _print(listing(), chosen)
        return
    raw = _raw(question)
    given = {} if raw else _given(parameters or [], question)
    if raw is not None and parameters:
        raise CaparError("SPARQL takes no parameters; write the values into it")
    text = named(question).bind(given) if raw is None else sparql.prepare(raw)
    for sentence in sparql.unknown_terms(raw or ""):
        typer.echo(f"warning: {sentence}", err=True)
    with Actionary.open(actionary, read_only=True) as opened:
        store = opened.store
        if corrected:
            from kb.corrections import corrected as corrected_copy

            store = corrected_copy(store)
        found = store.ask_within(text, seconds=time_limit)
        if raw is None and not found.rows:
            check_known(store, named(question), given)
        _print(found, chosen)
        if chosen == "table" and found.variables:
            for sentence in notes(named(question), found) if raw is None and found.rows else ():
                typer.echo(f"note: {sentence}", err=True)
            if not found.rows:
                typer.echo("nothing found", err=True)


def _given(parameters: list[str], asked: str) -> dict[str, str]:
    """What a named question is asked of, by parameter."""
    from kb.queries.questions import questions

    given = {}
    for parameter in parameters:
        name, equals, value = parameter.partition("=")
        if not equals:
            taken = questions()[asked].parameters if asked in questions() else ()
            names = f": {', '.join(parameter.name for parameter in taken)}" if taken else ""
            raise CaparError(f"{parameter!r} is no parameter; one is written NAME=VALUE{names}")
        given[name] = value
    return given


def _raw(question: str) -> str | None:
    """SPARQL that was given itself, or by a file or standard input; None for a named question."""
    from kb.store import sparql

    if question == "-":
        return sys.stdin.read()
    if any(each in question for each in "{\n"):
        return question
    path = Path(question)
    try:
        file = path.is_file()
    except OSError:  # too long for a file's name
        file = False
    if path.suffix in {".rq", ".sparql"} or file:
        try:
            return path.read_text("utf-8")
        except UnicodeDecodeError as error:
            raise FileError(path, f"cannot be read as a query ({error})") from None
    return question if sparql.is_meant(question) else None


def _print(found: "Answer", chosen: str) -> None:
    from kb.queries.questions import FORMATS, cells, header

    if chosen == "table" and sys.stdout.isatty():
        shown = list(cells(found))
        words = {n for n, own in enumerate(zip(*shown, strict=True)) if " " not in "".join(own)}
        print_table(header(found), shown, names=words)
    else:
        typer.echo(FORMATS[chosen](found), nl=False)


def show(
    name: Annotated[str, Argument(help="The complex action, or an observation of it.")],
    format_: Annotated[str, Option("--format", help="text, svg or turtle.")] = "text",
    actionary: Place = None,
) -> None:
    """Draw a complex action: its steps, and who was seen to do it."""
    from kb import Actionary
    from kb.reports.complex_actions import FORMATS

    if format_ not in FORMATS:
        raise UnknownNameError("format", format_, FORMATS)
    with Actionary.open(actionary, read_only=True) as opened:
        typer.echo(FORMATS[format_](opened, name), nl=False)


def check(
    shacl: Annotated[bool, Option("--shacl", help="Have pySHACL check too; minutes.")] = False,
    json: Json = False,
    actionary: Place = None,
) -> None:
    """Check that the Actionary is whole and valid.

    Every statement is read, and every observation checked: shapes, NLTs, references.
    """
    from kb import Actionary
    from kb.checks import check as checked

    with Actionary.open(actionary, read_only=True) as opened:
        problems = checked(opened.store, full=shacl)
        count = len(opened.observations())
    lines = [
        (f"{each.observation}: " if each.observation else "") + f"{each.thing}: {each.message}"
        for each in problems
    ]
    answer(problems, [*lines, f"{count} observations, {len(problems)} problems"], json=json)
    if problems:
        raise typer.Exit(2)


def serve(
    host: Annotated[str, Option(help="Where to listen; by default on this computer.")] = (
        "127.0.0.1"
    ),
    port: Annotated[int, Option(min=0, max=65535, help="0 takes any free one.")] = 7879,
    token: Annotated[str, Option(envvar="CAPAR_TOKEN", help="Who has it may add statements.")] = "",
    time_limit: TimeLimit = 30.0,
    actionary: Place = None,
) -> None:
    """Answer SPARQL and named questions over HTTP.

    It runs until Ctrl-C; / lists what can be asked.
    """
    from kb import Actionary
    from kb.serving import ActionaryServer, Service
    from kb.store.stores import place

    where = place(actionary)
    with Actionary.open(where, read_only=True) as opened:
        count = len(opened.observations())
    service = Service(where, token, seconds=time_limit)
    with ActionaryServer(service, host=host, port=port) as server:
        if not server.loopback:
            typer.echo(f"capar: {host} can be reached from other computers", err=True)
        typer.echo(f"{where} ({count} observations) is at {server.url}", err=True)
        server.serve_forever()
