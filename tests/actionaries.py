"""Where tests keep an Actionary, and what they put into it."""

import shutil
import sys
from pathlib import Path

import motions
import pytest

from kb.actionary import Actionary
from kb.store.stores import RemoteStore

STORES = ("memory", "folder", "server")

ACTIONS = {
    "DrinkFromMug": motions.drink_from_mug,
    "PickUpWithBothHands": motions.pick_up_with_both_hands,
    "SlideObject": motions.slide_object,
    "TouchCycle": motions.touch_cycle,
    "TouchFromRest": motions.touch_from_rest,
}
"""The five test actions by name."""


def oxigraph_binary() -> str | None:
    """The server's program: beside this Python, or on the path."""
    beside = Path(sys.executable).parent / "oxigraph"
    return str(beside) if beside.exists() else shutil.which("oxigraph")


def opened(kind: str, folder: Path, request: pytest.FixtureRequest) -> Actionary:
    """An empty Actionary of a kind."""
    if kind == "memory":
        return Actionary.in_memory()
    if kind == "folder":
        return Actionary.open(folder / "actionary")
    address = request.getfixturevalue("server")
    RemoteStore(address).change("CLEAR ALL")
    return Actionary.open(address)
