"""Numbers as a person writes them."""

import re

_DECIMAL = re.compile(r"(?<![\w.:/])-?\d+\.\d+(?:[eE][+-]?\d+)?(?![\w.:/])")


def rounded(value: float, places: int) -> float:
    """A number rounded to decimal places; below 1, to one significant digit more than that."""
    return round(value, places) if abs(value) >= 1.0 else float(f"{value:.{places + 1}g}")


def figure(value: float) -> str:
    """A number as text, such as 0.116, 14.117, 0.02492 or 2."""
    return f"{rounded(value, 3) + 0.0:.15g}"


def figures(text: str) -> str:
    """A text whose decimal numbers, those that are words of their own, are written so."""
    return _DECIMAL.sub(lambda found: figure(float(found[0])), text)
