"""Commands run within this process, as their users type them."""

from typer.testing import CliRunner, Result

from capar.cli import app


def capar(*words: object, typed: str = "") -> Result:
    """What became of a command: its outputs, exit code and error."""
    return CliRunner().invoke(app, [str(each) for each in words], input=typed)


def run(*words: object) -> str:
    """What a command prints; its error is raised."""
    done = capar(*words)
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    assert done.exit_code == 0, done.output
    return done.stdout


def refused(*words: object) -> str:
    """The error that ends a command."""
    done = capar(*words)
    assert done.exception is not None, done.output
    return str(done.exception)
