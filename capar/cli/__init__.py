"""The commands, one module each: they parse, call and print; each is imported when it is named."""

import os
import sys
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

import typer
from typer.core import TyperGroup

from capar import __version__
from capar.cli._output import error_message
from capar.model.errors import CaparError, UnknownNameError


class Commands(TyperGroup):
    """Every module of this package as the command of its name, loaded on demand."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Names of the commands, sorted."""
        modules = [each.name for each in iter_modules(__path__) if not each.name.startswith("_")]
        return sorted(name.removesuffix("_command").replace("_", "-") for name in modules)

    def get_command(self, ctx: Any, name: str) -> Any:
        """The command of that name, if there is one."""
        if name not in self.list_commands(ctx):
            return None
        stem = name.replace("-", "_")
        try:
            module = import_module(f"{__name__}.{stem}")
        except ModuleNotFoundError as error:
            if error.name != f"{__name__}.{stem}":
                raise
            module = import_module(f"{__name__}.{stem}_command")
        module.app._add_completion = False  # the root's is for all
        module.app.rich_markup_mode = None
        command = typer.main.get_command(module.app)
        command.name = name
        return command

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The command that is named first.

        Raises:
            UnknownNameError: There is none of that name.
        """
        name = args[0]
        wanted = not ctx.resilient_parsing and not name.startswith("-")
        if wanted and self.get_command(ctx, name) is None:
            raise UnknownNameError("command", name, self.list_commands(ctx))
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
    """Run a command; a user's mistake goes to standard error and exits with 2."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # its threads spin, and sum in any order
    try:
        app()
    except CaparError as error:
        typer.echo(f"capar: {error}", err=True)
        sys.exit(2)
    except OSError as error:
        typer.echo(f"capar: {error_message(error)}", err=True)
        sys.exit(2)
