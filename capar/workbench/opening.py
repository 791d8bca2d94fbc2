"""Opening the window: what is looked at first comes first, and the other panels after it."""

from collections.abc import Sequence
from importlib import import_module

from capar.workbench.folders import Folders
from capar.workbench.see import See
from capar.workbench.why import Why
from capar.workbench.window import Settings, Window

LATER = ("again.Again", "bring.Bring", "know.Know", "rules.Rules", "live.Live")
"""The panels whose libraries take long to load."""

SHORT_S = 4.0
"""Before those are loaded it is waited for a short capture to be observed, so long at most [s]."""


def open_window(
    folders: Folders, settings: Settings, captures: Sequence[str] = (), *, port: int = 0
) -> Window:
    """The window with some captures in it, which are observed in the background.

    Raises:
        CaparError: A capture cannot be read.
    """
    window = Window(folders, settings, port=port)
    try:
        window.add(See)
        window.add(Why)
        for place in captures:
            window.open(place, observe=False)
        window.observe()
        window.jobs.wait(SHORT_S)
        for place in LATER:
            module, _, name = place.partition(".")
            window.add(getattr(import_module(f"{__package__}.{module}"), name))
    except BaseException:
        window.close()
        raise
    return window
