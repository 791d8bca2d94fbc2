"""The command that opens the interactive window."""

import webbrowser
from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from capar.cli import options
from capar.model.errors import CaparError, FileError


def open_(
    places: Annotated[
        list[str] | None,
        Argument(
            metavar="[CAPTURE | ACTIONARY]...",
            help="Captures, and at most one Actionary; without any, the shipped demo.",
        ),
    ] = None,
    folder: Annotated[
        list[Path] | None,
        Option(
            metavar="FOLDER",
            help="Where the window may read and write files, besides the folders of what is "
            "opened; new files go to the first. May be repeated; by default the folder you are in.",
        ),
    ] = None,
    profile: options.ProfileName = "extended",
    rules: options.Rules = None,
    port: Annotated[int, Option(min=0, max=65535, help="0 takes any free one.")] = 0,
    dark: Annotated[bool, Option("--dark", help="Light letters on dark.")] = False,
    browser: Annotated[
        bool, Option("--browser/--no-browser", help="Open it in the browser at once, or not.")
    ] = True,
) -> None:
    """Open captures and an Actionary in a window of the browser.

    See what was done, ask why, teach what is unknown, ask what is known, and do it again. It is
    served on this computer only, at an address with a secret in it; Ctrl-C ends it.
    """
    import shutil
    from importlib import resources
    from tempfile import TemporaryDirectory

    from capar.workbench.folders import Folders
    from capar.workbench.opening import open_window
    from capar.workbench.window import Settings
    from extractors.readers.bundle.capture_toml import find_place

    known = [each for each in places or [] if options.has_actionary(each, named=None)]
    captures = [each for each in places or [] if each not in known]
    if len(known) > 1:
        raise CaparError(f"{' and '.join(known)} are two Actionaries; open one at a time")
    named = folder or [Path()]
    for each in named:
        if not each.is_dir():
            raise FileError(each, "is no folder.", "Name one that exists.")
    with TemporaryDirectory() as temporary:
        if not places:
            with resources.as_file(resources.files("capar") / "demo" / "drink_from_mug") as demo:
                captures = [str(shutil.copytree(demo, Path(temporary) / "drink_from_mug"))]
        of_captures = [find_place(each)[0].parent for each in captures]
        folders = Folders([*named, *of_captures, *map(Path, known)])
        settings = Settings(profile, rules, known[0] if known else None, dark)
        settings.rule_base()  # what is wrong with a rule is said before anything is shown
        window = open_window(folders, settings, captures, port=port)
        typer.echo(f"the window is at {window.address}\nCtrl-C ends it", err=True)
        if browser:
            webbrowser.open(window.address)
        try:
            window.wait()
        finally:
            window.close()
