"""Ask the Actionary: questions, drawings of actions, checks, and an HTTP server."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from capar.cli.options import Corrected, Json, Place
from capar.cli.output import console, print_json

if TYPE_CHECKING:
    from kb.store.answers import Answer


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
        typer.Argument(
            help="A question's name, SPARQL, a file of SPARQL, or - for standard input.",
            autocompletion=_names,
            show_default=False,
        ),
    ] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[NAME=VALUE]...",
            help="What a named question is asked of.",
            autocompletion=_parameters,
            show_default=False,
        ),
    ] = None,
    list_: Annotated[bool, typer.Option("--list", help="List the named questions.")] = False,
    format_: Annotated[str, typer.Option("--format", help="table, csv, json or turtle.")] = "table",
    json: Annotated[bool, typer.Option("--json", help="The same as --format json.")] = False,
    time_limit: Annotated[
        float, typer.Option(metavar="SECONDS", help="How long the question may take.")
    ] = 30.0,
    corrected: Corrected = False,
    actionary: Place = None,
) -> None:
    """Ask a named question (see --list) or any SPARQL.

    A query can neither write nor run longer than --time-limit.
    """
    from capar.model.errors import UnknownNameError
    from kb import Actionary
    from kb.queries.questions import FORMATS, check_known, listing, notes
    from kb.queries.questions import question as named
    from kb.store.sparql import unknown_terms

    chosen = "json" if json else format_
    if chosen not in FORMATS:
        raise UnknownNameError("format", chosen, FORMATS)
    if list_ or question is None:
        _print(listing(), chosen)
        return
    given = _given(parameters or [], question)
    raw = _raw(question)
    text = _text(question, raw, given)
    for sentence in unknown_terms(raw or ""):
        typer.echo(f"warning: {sentence}", err=True)
    with Actionary.open(actionary, read_only=True) as opened:
        store = opened.store
        if corrected:
            from kb.corrections import corrected as corrected_copy

            store = corrected_copy(store)
        answer = store.ask_within(text, seconds=time_limit)
        if raw is None and not answer.rows:
            check_known(store, named(question), given)
        _print(answer, chosen)
        if chosen == "table" and answer.variables:
            said = notes(named(question), answer) if raw is None and answer.rows else []
            for sentence in said:
                typer.echo(f"note: {sentence}", err=True)
            if not answer.rows:
                typer.echo("nothing found", err=True)


def _given(parameters: list[str], asked: str) -> dict[str, str]:
    """What a named question is asked of, by parameter."""
    from capar.model.errors import CaparError
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


def _text(question: str, raw: str | None, given: dict[str, str]) -> str:
    """The SPARQL that is meant."""
    from capar.model.errors import CaparError
    from kb.queries.questions import question as named
    from kb.store import sparql

    if raw is None:
        return named(question).bind(given)
    if given:
        raise CaparError("SPARQL takes no parameters; write the values into it")
    return sparql.prepare(raw)


def _raw(question: str) -> str | None:
    """SPARQL that was given itself, or by a file or standard input; None for a named question."""
    from capar.model.errors import FileError
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


def _print(answer: "Answer", chosen: str) -> None:
    from kb.queries.questions import FORMATS, cells, header

    if chosen != "table" or not sys.stdout.isatty():
        typer.echo(FORMATS[chosen](answer), nl=False)
        return
    from capar.views.tables import terminal_table

    console().print(terminal_table(header(answer), list(cells(answer))))


def show(
    name: Annotated[str, typer.Argument(help="The complex action, or an observation of it.")],
    format_: Annotated[str, typer.Option("--format", help="text, svg or turtle.")] = "text",
    actionary: Place = None,
) -> None:
    """Draw a complex action: its steps, and who was seen to do it."""
    from capar.model.errors import UnknownNameError
    from kb import Actionary
    from kb.reports.complex_actions import FORMATS

    if format_ not in FORMATS:
        raise UnknownNameError("format", format_, FORMATS)
    with Actionary.open(actionary, read_only=True) as opened:
        typer.echo(FORMATS[format_](opened, name), nl=False)


def check(
    shacl: Annotated[
        bool,
        typer.Option("--shacl", help="Have pySHACL check every observation as well; minutes."),
    ] = False,
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
    if json:
        print_json(problems)
    else:
        for problem in problems:
            whose = f"{problem.observation}: " if problem.observation else ""
            typer.echo(f"{whose}{problem.thing}: {problem.message}")
        typer.echo(f"{count} observations, {len(problems)} problems")
    if problems:
        raise typer.Exit(2)


def serve(
    host: Annotated[str, typer.Option(help="Where to listen; by default on this computer.")] = (
        "127.0.0.1"
    ),
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 takes any free one.")] = 7879,
    token: Annotated[
        str,
        typer.Option(envvar="CAPAR_TOKEN", help="Let clients that bear this token add statements."),
    ] = "",
    time_limit: Annotated[
        float, typer.Option(metavar="SECONDS", help="How long a query may take.")
    ] = 30.0,
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
    with ActionaryServer(Service(where, token, time_limit), host=host, port=port) as server:
        if not server.loopback:
            typer.echo(f"capar: {host} can be reached from other computers", err=True)
        typer.echo(f"{where} ({count} observations) is at {server.url}", err=True)
        server.serve_forever()
