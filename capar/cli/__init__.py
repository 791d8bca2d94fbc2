"""The commands: thin modules that parse, call the library and print, each imported on demand."""

import atexit
import gc
import os
import sys
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup

from capar import __version__
from capar.cli.output import error_message
from capar.model.errors import CaparError, NoAnswerError, UnknownNameError

GROUPS = {
    "Look at captures": "observe.demo window.open_ captures.inspect captures.view captures.facts "
    "captures.new_capture trackers.devices trackers.record trackers.simulate",
    "Observe": "observe.observe label.label explain.explain evaluate.test evaluate.evaluate",
    "Ask the Actionary": "ask.query ask.show actionary.agent actionary.object_ actionary.correct "
    "actionary.forget ask.check",
    "Rules": "rules.rules",
    "Language": "language.describe language.parse language.verb language.lexicon language.report",
    "Bodies": "body.fit body.perform body.map_ regenerate.regenerate regenerate.roundtrip",
    "Share": "share.export share.import_ share.backup ask.serve",
}
"""Where each command stands, by the heading under which the help lists it."""

COMMANDS = {
    place.partition(".")[2].rstrip("_").replace("_", "-"): (place, heading)
    for heading, places in GROUPS.items()
    for place in places.split()
}
"""Module and attribute of each command, and its heading, by its name."""


class Commands(TyperGroup):
    """The commands of the table, loaded on demand."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Names of the commands, sorted."""
        return sorted(COMMANDS)

    def get_command(self, ctx: Any, name: str) -> Any:
        """The command of that name, if there is one."""
        if name not in COMMANDS:
            return None
        module, _, attribute = COMMANDS[name][0].partition(".")
        app = getattr(import_module(f"{__name__}.{module}"), attribute)
        if not isinstance(app, typer.Typer):
            function, app = app, typer.Typer()
            app.command()(function)
        app._add_completion = False  # the root's is for all
        app.rich_markup_mode = None
        command = typer.main.get_command(app)
        command.name = name
        command.help = (command.help or "").replace("\\b\n", "\b\n")  # keeps examples in lines
        return command

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands under the headings of the table."""
        width = max(map(len, COMMANDS))
        limit = formatter.width - 6 - width
        for heading in GROUPS:
            rows = [
                (f"{name:{width}}", self.get_command(ctx, name).get_short_help_str(limit))
                for name, (_, own) in COMMANDS.items()
                if own == heading
            ]
            with formatter.section(heading):
                formatter.write_dl(rows)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The command that is named first.

        Raises:
            UnknownNameError: There is none of that name.
        """
        name = args[0]
        if not ctx.resilient_parsing and not name.startswith("-") and name not in COMMANDS:
            raise UnknownNameError("command", name, sorted(COMMANDS))
        return super().resolve_command(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        """Run the command; typer itself would end an interrupted one without a word."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            typer.echo("capar: interrupted; nothing was left half-written", err=True)
            raise typer.Exit(130) from None
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode=None,  # help in boxes would take twice as long, and is cut in a pipe
    pretty_exceptions_enable=False,
)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"capar {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version and stop."
    ),
) -> None:
    """Say what somebody did in a motion capture, as knowledge to query, explain and replay."""


def main() -> None:
    """Run a command; a user's mistake exits with 2, rules that contradict each other with 1."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its threads spin, and sum in any order
    atexit.register(gc.freeze)  # what is left at the end is not searched for cycles
    try:
        app()
    except NoAnswerError as error:
        from capar.cli.output import save_contradiction

        save_contradiction(error)
        sys.exit(1)
    except (CaparError, OSError) as error:
        message = error_message(error) if isinstance(error, OSError) else error
        typer.echo(f"capar: {message}", err=True)
        sys.exit(2)
