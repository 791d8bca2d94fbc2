"""Lengths, ways and angles as a report prints them."""

import math
from dataclasses import dataclass

from capar_rules.borders.ticks import constants

LEAST_M = 0.01
"""Shorter ways are told as less than that [m]."""

TURNING_M = 0.002
"""A body that moves, and whose origin has a shorter path, turns [m]."""

LONGER, LONGER_M = 1.5, 0.05
"""By this factor and by so much [m] a path is longer than the straight way, to be told too."""

LEVEL_MM = 5
"""A smaller difference of height, or a smaller way aside, is none [mm]."""


@dataclass(frozen=True, slots=True)
class Way:
    """How a body moved between two frames."""

    straight_m: float
    """How far it ended from where it began [m]."""

    path_m: float
    """The length of its path [m]."""

    spread_m: float
    """How far it came at most from the middle of the places where it was [m]."""

    @property
    def winding(self) -> bool:
        """Whether the path is so much longer than the straight way that both are to be told."""
        back = self.straight_m < LEAST_M and self.path_m >= 2.0 * LEAST_M
        return back or self.path_m > max(LONGER * self.straight_m, self.straight_m + LONGER_M)


def length(metres: float) -> str:
    """A length in the unit in which it has two or three digits."""
    if round(1000.0 * metres) < 1000.0 * LEAST_M:
        return f"{1000.0 * metres:.0f} mm"
    if round(100.0 * metres) < 100:
        return f"{100.0 * metres:.0f} cm"
    return f"{metres:.1f} m"


def way(moved: Way, until: str = "", floor_m: float = 0.0) -> str:
    """How far a body moved, and until when if that is told, to stand after ``moved``.

    Args:
        moved: How it moved.
        until: Until when.
        floor_m: From what distance on it counts as moved [m].
    """
    if moved.winding:
        path = f"along a path of {beside(moved.path_m, floor_m)}{until}"
        return f"{path} and ended {_from_start(moved.straight_m, floor_m)}"
    if moved.path_m < TURNING_M:
        return f"by turning{until}"
    return f"{beside(moved.straight_m, floor_m)}{until}"


def place(x_mm: float, y_mm: float, z_mm: float, floor_m: float = 0.0) -> str:
    """Where a body ended that was displaced so, to stand after ``ended``."""
    return _from_start(math.hypot(x_mm, y_mm, z_mm) / 1000.0, floor_m)


def beside(metres: float, limit_m: float) -> str:
    """A length, with a decimal where it would read as a limit that it is not."""
    told = length(metres)
    alike = told == length(limit_m) and abs(metres - limit_m) > 1e-6
    return f"{100.0 * metres:.1f} cm" if alike and metres >= LEAST_M else told


def _from_start(metres: float, floor_m: float) -> str:
    if metres < LEAST_M:
        return f"less than {length(LEAST_M)} from where it began"
    return f"{beside(metres, floor_m)} from where it began"


def gap(metres: float) -> str:
    """How far two bodies are apart, in millimetres where that is near."""
    return f"{1000.0 * metres:.0f} mm" if round(1000.0 * metres) < 100 else length(metres)


def spread(metres: float) -> str:
    """A length that bounds another one: rounded up to a decimal, so that it does, and hardly."""
    if 1000.0 * metres < 100.0:
        return f"{max(upward(1000.0 * metres, 1), 0.1):.1f} mm"
    return extreme(metres)


def extreme(metres: float) -> str:
    """The same of how far a body went at most, in centimetres or metres."""
    if metres < 1.0:
        return f"{upward(100.0 * metres, 1):.1f} cm"
    return f"{upward(metres, 2):.2f} m"


def angle_bound(radians: float) -> str:
    """An angle that bounds another one: rounded up to a decimal."""
    return f"{max(upward(math.degrees(radians), 1), 0.1):.1f}°"


def upward(value: float, digits: int = 0) -> float:
    """The least number of so many decimals that a value does not exceed."""
    scale = 10.0**digits
    return math.ceil(round(value * scale, 6)) / scale


def course(x_mm: int, y_mm: int, z_mm: int) -> str:
    """A displacement by its rise and its way aside, to stand after ``ended``."""
    return " and ".join(_course(x_mm, y_mm, z_mm).values()) or "where it began"


def steep_course(x_mm: int, y_mm: int, z_mm: int) -> str:
    """The same, with how far up or down counts."""
    parts = _course(x_mm, y_mm, z_mm)
    if "height" in parts:
        parts["height"] += f" ({length(constants()['height_mm'] / 1000.0)} or more count)"
    return " and ".join(parts.values()) or "where it began"


def level_course(x_mm: int, y_mm: int, z_mm: int) -> str:
    """The same, with how far to the side counts."""
    parts = _course(x_mm, y_mm, z_mm)
    if "aside" in parts:
        parts["aside"] += f" ({length(constants()['aside_mm'] / 1000.0)} or more count)"
    return " and ".join(parts.values()) or "where it began"


def _course(x_mm: int, y_mm: int, z_mm: int) -> dict[str, str]:
    aside = math.hypot(x_mm, y_mm)
    parts = {}
    if abs(z_mm) < 1 <= aside:
        parts["height"] = "at the same height"
    elif abs(z_mm) >= 1:
        height = _short_of_limit(abs(z_mm), constants()["height_mm"])
        parts["height"] = f"{height} {'higher' if z_mm > 0 else 'lower'}"
    if aside >= LEVEL_MM:
        parts["aside"] = f"{_short_of_limit(aside, constants()['aside_mm'])} to the side"
    return parts


def slope(x_mm: int, y_mm: int, z_mm: int) -> str:
    """Whether a displacement leads more up, down or aside, to stand after ``went``."""
    aside = math.hypot(x_mm, y_mm)
    if abs(z_mm) < LEVEL_MM:
        return "to the side, and neither up nor down"
    sense = "up" if z_mm > 0 else "down"
    if aside < LEVEL_MM:
        return f"straight {sense}"
    if abs(z_mm) >= aside:
        return f"{sense} more than to the side"
    return f"more to the side than {sense}"


def _short_of_limit(millimetres: float, limit_mm: float) -> str:
    """A length, in millimetres where it would read as a limit that it does not reach."""
    told = length(millimetres / 1000.0)
    short = millimetres < limit_mm and told == length(limit_mm / 1000.0)
    return f"{millimetres:.0f} mm" if short else told


@dataclass(frozen=True, slots=True)
class Turns:
    """How often a body turns back on the axis of the world on which it does so most."""

    count: int
    sense: str
    """Along which line."""


@dataclass(frozen=True, slots=True)
class Over:
    """Where a body is to another one."""

    rise_m: float
    """How much higher its middle is than the other's top [m]."""

    aside_m: float
    """How far its middle is outside the other's shadow, to the side [m]; zero over it."""

    share: float
    """Which share of it is in the other's convex hull [1]."""

    deep: float
    """Which share of its ends is well within that: deeper than bodies that touch cut each other."""

    shaped: bool
    """Whether the other has a shape; its top and its shadow are its origin else."""


def over(at: Over, other: str) -> str:
    """How far a body is above another one of that name, in brackets."""
    top = f"the {'top' if at.shaped else 'origin'} of the {other}"
    aside = "over it" if at.aside_m < 0.0005 else f"{length(at.aside_m)} aside of it"
    return f" (its middle {length(at.rise_m)} above {top} and {aside})"


def percent(share: float) -> str:
    """A share, to stand alone."""
    return f"{100.0 * share:.0f} %"


@dataclass(frozen=True, slots=True)
class Shortfall:
    """How a measure falls short of what a condition asks for."""

    text: str
    """To stand after the name of the body; empty if the body did nothing of the kind."""

    nearness: float
    """Its share of what is asked for, below one."""


NOTHING = Shortfall("", 0.0)

NEAR_BY = 0.9
"""How near what leant over and back is taken to come to a tilting [1]."""

FAR_OFF = 0.02
"""How near what did nothing of the kind is taken to come: it is told if nothing else is [1]."""


def not_up(x_mm: int, y_mm: int, z_mm: int) -> Shortfall:
    """Why a displacement is no rise."""
    return _not_steep(math.hypot(x_mm, y_mm), z_mm, "up")


def not_down(x_mm: int, y_mm: int, z_mm: int) -> Shortfall:
    """Why a displacement is no lowering."""
    return _not_steep(math.hypot(x_mm, y_mm), -z_mm, "down")


def _not_steep(aside_mm: float, height_mm: float, sense: str) -> Shortfall:
    least = constants()["height_mm"]
    if _is_little(aside_mm, height_mm):
        return _little(aside_mm, height_mm if sense == "up" else -height_mm, height_mm)
    if height_mm < LEVEL_MM:
        wanted, other = ("higher", "lower") if sense == "up" else ("lower", "higher")
        rise = f"{length(abs(height_mm) / 1000.0)} {wanted if height_mm > 0.0 else other}"
        told = rise if abs(height_mm) >= 1.0 else "at the same height"
        return Shortfall(f"ended {told}, not {length(least / 1000.0)} or more {wanted}", FAR_OFF)
    if height_mm < least:
        far, wanted = apart(height_mm, least)
        comparison = "higher" if sense == "up" else "lower"
        text = f"ended {far} {comparison}, less than the {wanted} that count"
        return Shortfall(text, height_mm / least)
    aside, height = apart(aside_mm, height_mm)
    text = f"ended further to the side ({aside}) than {sense} ({height})"
    return Shortfall(text, height_mm / max(aside_mm, height_mm))


def not_aside(x_mm: int, y_mm: int, z_mm: int) -> Shortfall:
    """Why a displacement is no carrying to the side."""
    aside_mm, least = math.hypot(x_mm, y_mm), constants()["aside_mm"]
    if aside_mm < LEVEL_MM:
        return NOTHING
    if _is_little(aside_mm, z_mm):
        return _little(aside_mm, z_mm, aside_mm)
    if aside_mm < least:
        far, wanted = apart(aside_mm, least)
        text = f"ended {far} to the side, less than the {wanted} that count"
        return Shortfall(text, aside_mm / least)
    height, aside = apart(abs(z_mm), aside_mm)
    text = f"ended further {'up' if z_mm > 0 else 'down'} ({height}) than to the side ({aside})"
    return Shortfall(text, aside_mm / max(abs(z_mm), aside_mm))


def _is_little(aside_mm: float, height_mm: float) -> bool:
    """Whether a displacement can be seen, and is too small to count as up, down or aside."""
    small = abs(height_mm) < constants()["height_mm"] and aside_mm < constants()["aside_mm"]
    return small and max(abs(height_mm), aside_mm) >= LEVEL_MM


def _little(aside_mm: float, z_mm: float, wanted_mm: float) -> Shortfall:
    """Such a displacement, in one clause whichever way it would have had to go.

    Whoever wanted it to go that way, or to the side, came so near; the other way, not at all.
    """
    known = constants()
    height, least = apart(abs(z_mm), known["height_mm"])
    aside, far = apart(aside_mm, known["aside_mm"])
    rise = f"{height} {'higher' if z_mm > 0.0 else 'lower'}"
    parts = [rise] * (abs(z_mm) >= 1.0) + [f"{aside} to the side"] * (aside_mm >= 1.0)
    level = "at the same height and " * (abs(z_mm) < 1.0)
    text = (
        f"ended {level}only {' and '.join(parts)} (up and down count from {least} on, to the side "
        f"from {far} on)"
    )
    share = max(abs(z_mm) / known["height_mm"], aside_mm / known["aside_mm"])
    return Shortfall(text, share if wanted_mm >= 0.0 else FAR_OFF)


def not_near(x_mm: int, y_mm: int, z_mm: int) -> Shortfall:
    """Why a displacement does not end near where it began."""
    far_mm, most = math.hypot(x_mm, y_mm, z_mm), constants()["aside_mm"]
    far, wanted = apart(far_mm, most)
    return Shortfall(f"ended {far} from where it began, not within {wanted}", most / far_mm)


def not_slid(x_mm: int, y_mm: int, z_mm: int) -> Shortfall:
    """Why a displacement on a support is no sliding."""
    far_mm, least = math.hypot(x_mm, y_mm, z_mm), constants()["slide_mm"]
    far, wanted = apart(far_mm, least)
    return Shortfall(
        f"ended only {far} from where it began, less than the {wanted} of a slide", far_mm / least
    )


def not_turned(turned_mrad: int) -> Shortfall:
    """Why an angle about the vertical is no turn."""
    least = constants()["turn_mrad"]
    text = f"turned by {degrees(turned_mrad)} about the vertical, less than {degrees(least)}"
    return Shortfall(text, max(abs(turned_mrad) / least, FAR_OFF))


def not_leant(before_mrad: int, after_mrad: int, most_mrad: int, posture: str) -> Shortfall:
    """Why a change of lean is no tilting; near to one is what leant much more in between."""
    least, change = constants()["turn_mrad"], abs(after_mrad - before_mrad)
    beyond = most_mrad - max(before_mrad, after_mrad) >= least
    most = f" ({angle_bound(most_mrad / 1000.0)} at most in between)" * beyond
    text = (
        f"leant {degrees(before_mrad)} at the start and {degrees(after_mrad)} at the end from "
        f"{posture}{most}, a change of {_short_of(before_mrad, after_mrad)}, less than "
        f"{degrees(least)}"
    )
    return Shortfall(text, max(change / least, NEAR_BY * beyond, FAR_OFF))


def _short_of(before_mrad: int, after_mrad: int) -> str:
    """A change of lean that is too small, as it is told."""
    told, least = change(before_mrad, after_mrad), degrees(constants()["turn_mrad"])
    return told if told != least else f"{math.degrees(abs(after_mrad - before_mrad) / 1e3):.1f}°"


def apart(one_mm: float, other_mm: float) -> tuple[str, str]:
    """Two lengths, in millimetres if they would else read as the same."""
    for digits in (None, 0, 1):
        one, other = (
            length(far / 1000.0) if digits is None else f"{far:.{digits}f} mm"
            for far in (one_mm, other_mm)
        )
        if one != other:
            break
    return one, other


def change(before_mrad: int, after_mrad: int) -> str:
    """The angle between two, as the difference of what is told of them.

    Where that would be on the other side of what counts as turned, the angle itself is rounded.
    """
    least = constants()["turn_mrad"]
    told = abs(round(math.degrees(after_mrad / 1000.0)) - round(math.degrees(before_mrad / 1000.0)))
    counts = abs(after_mrad - before_mrad) >= least
    agrees = counts == (told >= round(math.degrees(least / 1000.0)))
    return f"{told}°" if agrees else degrees(after_mrad - before_mrad)


def degrees(milliradians: int) -> str:
    """An angle in whole degrees."""
    return f"{math.degrees(abs(milliradians) / 1000.0):.0f}°"
