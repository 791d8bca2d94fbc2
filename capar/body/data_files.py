"""The data files beside this package: numbers with their sources, read once."""

import tomllib
from functools import cache
from importlib.resources import files
from typing import Any


@cache
def table(name: str) -> dict[str, Any]:
    """The table ``data/<name>.toml``; callers do not change it."""
    text = (files("capar.body") / "data" / f"{name}.toml").read_text("utf-8")
    return tomllib.loads(text)


def mirrored(name: str) -> str:
    """The name of the same thing on the other side: ``right_hand`` and ``left_hand``."""
    if "right_" in name:
        return name.replace("right_", "left_")
    return name.replace("left_", "right_")


def is_right(name: str) -> bool:
    """Whether a name is of the right side, whose rows stand for both sides."""
    return "right_" in name
