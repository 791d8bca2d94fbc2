"""What shows a value to people, registered by those who may import it.

A value of the model can be shown as a page, a picture or data frames, but the model may not import
the views that do it. The package's front door names them; they are imported when they are asked.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any

_PLACES: dict[str, str] = {}


def register(form: str, place: str) -> None:
    """Say which function shows values in some form.

    Args:
        form: ``html``, ``frame`` ...
        place: The function, as ``MODULE:FUNCTION``.
    """
    _PLACES[form] = place


def display(form: str) -> Callable[..., Any]:
    """The function that shows values in that form.

    Raises:
        KeyError: No function was registered for it.
    """
    module, _, function = _PLACES[form].partition(":")
    show: Callable[..., Any] = getattr(import_module(module), function)
    return show
