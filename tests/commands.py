"""Commands as processes of their own, forked from one that has imported what they import.

Each has its own folder, environment, outputs and exit code, and `capar.cli.main` runs in it as the
script `capar` runs it; what it need not do is import the same libraries again. Tests of starting,
of signals, of full disks and of closed outputs start the script itself.
"""

import ctypes
import io
import multiprocessing
import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from multiprocessing.context import ForkServerContext
from pathlib import Path
from tempfile import TemporaryDirectory

LOADED = (
    "capar.cli.explain",
    "capar.cli.observe",
    "capar.cli.body",
    "capar.cli.ask",
    "capar.cli.regenerate",
    "capar.pipelines.explanation",
    "capar.pipelines.observation",
    "capar.regeneration.search",
    "capar.views.picture",
    "capar_rules.explain.explanation",
    "extractors.readers.bundle.capture_toml",
    "kb.actionary",
)
"""Modules that are imported once for all commands; one that is missing is imported by a command."""


@dataclass(frozen=True)
class Done:
    """A command that has ended."""

    returncode: int | None
    stdout: str
    stderr: str


def clean_environment() -> dict[str, str]:
    """The environment, without settings of ours."""
    return {key: value for key, value in os.environ.items() if not key.startswith("CAPAR_")}


def capar(
    *arguments: object,
    cwd: Path,
    environment: Mapping[str, str] | None = None,
    together: bool = False,
    ordinary: bool = False,
) -> Done:
    """Run a command of the command line.

    Args:
        arguments: What stands behind `capar`.
        cwd: The folder in which it runs.
        environment: The whole environment; if None, this one without settings of ours.
        together: Whether errors go to the standard output too.
        ordinary: Whether it has no more rights to files than who owns them.
    """
    env = dict(clean_environment() if environment is None else environment)
    with TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        errors = out if together else Path(folder) / "errors"
        told = (list(map(str, arguments)), str(cwd), env, str(out), str(errors), ordinary)
        process = _context().Process(target=_command, args=told)
        process.start()
        process.join()
        code = process.exitcode
        process.close()
        return Done(code, out.read_text(), "" if together else errors.read_text())


@cache
def _context() -> ForkServerContext:
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(LOADED))
    return context


def _command(
    arguments: Sequence[str],
    cwd: str,
    environment: Mapping[str, str],
    out: str,
    errors: str,
    ordinary: bool,
) -> None:
    """Be the command: what `capar` does, with its own outputs, folder and environment."""
    from capar.cli import main

    _redirect(out, errors)
    if ordinary:
        _drop_overrides()
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(cwd)
    sys.argv = ["capar", *arguments]
    try:
        main()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()


_OVERRIDES = (1, 2)
"""CAP_DAC_OVERRIDE and CAP_DAC_READ_SEARCH: by them an administrator needs no rights to files."""


def _drop_overrides() -> None:
    """Be an administrator no more in what concerns files; for others there is nothing to drop."""
    libc = ctypes.CDLL(None)
    header, sets = (ctypes.c_uint32 * 2)(0x20080522, 0), (ctypes.c_uint32 * 6)()
    assert libc.capget(header, sets) == 0
    for each in _OVERRIDES:
        libc.prctl(24, each, 0, 0, 0)  # those of what it starts, which fails for who has none
        for effective_or_permitted in (0, 1):
            sets[effective_or_permitted] &= ~(1 << each)
    assert libc.capset(header, sets) == 0


def _redirect(out: str, errors: str) -> None:
    flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND
    for path, number in ((out, 1), (errors, 2)):
        opened = os.open(path, flags, 0o600)
        os.dup2(opened, number)
        os.close(opened)
    sys.stdout = io.TextIOWrapper(os.fdopen(1, "wb", closefd=False), encoding="utf-8")
    sys.stderr = io.TextIOWrapper(
        os.fdopen(2, "wb", closefd=False), encoding="utf-8", line_buffering=True
    )
