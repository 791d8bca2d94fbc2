"""A way that falls short of a condition is told with number and threshold, or not at all."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from capar_rules.borders.ticks import constants
from capar_rules.explain import quantities

MM = st.integers(-3000, 3000)
NUMBER = re.compile(r"([\d.]+) (mm|cm|m)\b")
LITTLE = re.compile(r"ended (?:at the same height and )?only .* to the side from .* on\)$")
SCALE = {"mm": 1.0, "cm": 10.0, "m": 1000.0}


def told_mm(text: str) -> list[float]:
    """The lengths that a text tells, in order [mm]."""
    return [float(number) * SCALE[unit] for number, unit in NUMBER.findall(text)]


def rises(x: int, y: int, z: int) -> bool:
    return z >= constants()["height_mm"] and z * z >= x * x + y * y


def travels(x: int, y: int, z: int) -> bool:
    aside = x * x + y * y
    return aside >= constants()["aside_mm"] ** 2 and z * z < aside


def is_little(x: int, y: int, z: int) -> bool:
    """Whether a way can be seen, and is too short to count, whichever way it goes."""
    known, aside = constants(), math.hypot(x, y)
    short = abs(z) < known["height_mm"] and aside < known["aside_mm"]
    return short and max(abs(z), aside) >= quantities.LEVEL_MM


@given(MM | st.integers(-60, 60), MM | st.integers(-60, 60), MM | st.integers(-60, 60))
def test_why_it_is_no_rise_is_told_of_what_went_up_alone(x: int, y: int, z: int) -> None:
    if rises(x, y, z):
        return
    short = quantities.not_up(x, y, z)
    little = is_little(x, y, z)
    assert bool(LITTLE.match(short.text)) == little
    if not little:
        assert short.text.endswith("or more higher") == (z < quantities.LEVEL_MM)
    assert 0.0 <= short.nearness <= 1.0
    if z:
        assert quantities.not_down(x, y, -z) == replaced(short)


def replaced(short: quantities.Shortfall) -> quantities.Shortfall:
    """The same of a way down."""
    text = short.text.replace("than up", "than down")
    swapped = {"higher": "lower", "lower": "higher"}
    text = re.sub("higher|lower", lambda found: swapped[found[0]], text)
    return quantities.Shortfall(text, short.nearness)


@given(MM, MM, MM)
def test_why_it_is_no_carrying_is_told_of_what_went_aside(x: int, y: int, z: int) -> None:
    if travels(x, y, z):
        return
    short = quantities.not_aside(x, y, z)
    seen = math.hypot(x, y) >= quantities.LEVEL_MM
    assert bool(short.text) == (seen or is_little(x, y, z))
    assert 0.0 <= short.nearness <= 1.0


@given(MM, MM, MM)
def test_two_lengths_that_decide_are_never_told_as_the_same(x: int, y: int, z: int) -> None:
    wanted = [] if rises(x, y, z) else [quantities.not_up(x, y, z).text]
    wanted += [] if travels(x, y, z) else [quantities.not_aside(x, y, z).text]
    for text in filter(None, wanted):
        if text.endswith("or more higher"):
            continue
        if LITTLE.match(text):
            *_, least, far = told_mm(text)
            height, aside = abs(z), math.hypot(x, y)
            assert height < 1 or told_mm(text)[0] != least
            assert aside < 1 or told_mm(text)[-3] != far
            continue
        one, other = told_mm(text)
        assert one != other or abs(math.hypot(x, y) - abs(z)) < 1.0


@pytest.mark.parametrize(
    ("way", "told"),
    [
        ((330, 0, 300), "ended further to the side (33 cm) than up (30 cm)"),
        ((100, 0, 48), "ended 48 mm higher, less than the 50 mm that count"),
        (
            (30, 0, 30),
            "ended only 3 cm higher and 3 cm to the side (up and down count from 5 cm on, "
            "to the side from 10 cm on)",
        ),
        ((0, 0, -300), "ended 30 cm lower, not 5 cm or more higher"),
    ],
)
def test_a_way_that_is_no_rise(way: tuple[int, int, int], told: str) -> None:
    assert quantities.not_up(*way).text == told
