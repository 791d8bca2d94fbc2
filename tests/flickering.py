"""Measurements of contact that flicker, made from those that do not."""

from dataclasses import replace

from capar.model.facts import Fact, Link, Touching

LOST_S = 0.1
"""How long each contact of a hand is lost [s]."""


def flickering(
    facts: tuple[Fact, ...], rate_hz: float, *, every_s: float = 0.34
) -> tuple[Fact, ...]:
    """The facts with a tenth of a second lost of each contact of a hand, again and again."""
    hands = {each.ee for each in facts if isinstance(each, Link)}
    gap, period = round(LOST_S * rate_hz), round(every_s * rate_hz)
    found: list[Fact] = []
    for each in facts:
        if isinstance(each, Touching) and each.body in hands:
            first = each.first
            while each.last - first > period + 2 * gap:
                found.append(replace(each, first=first, last=first + period - 1))
                first += period + gap
            found.append(replace(each, first=first))
        else:
            found.append(each)
    return tuple(found)
