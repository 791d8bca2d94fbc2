"""Household goods and hand tools that the earlier batteries lack, in metres."""

from scenes.hands.paths import Vector
from scenes.hands.shapes import Form, ball, block, box, disc, ring, rod, vessel
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects.handling import NEAR, UP, Grip

TUBE_M = 0.055
"""Radius of a paper roll [m]."""

POLE_M = 0.012
"""Radius of the pole that a paper roll stands on [m]."""

HAFT = Grip((0.0, 0.0, 0.0), NEAR, UP)
"""The end of a shaft that lies along x from its origin."""


def plum(s: Stage, at: Vector, name: str = "plum", radius: float = 0.032) -> Thing:
    """A plum whose lowest point is at a place."""
    x, y, z = (*at, s.height)[:3]
    return s.put(name, ball(radius, "plum"), (x, y, z + radius))


def jar(s: Stage, at: Vector, name: str = "jar", height: float = 0.15) -> Thing:
    """A tall closed jar that a palm can take at its side or from above."""
    return s.put(name, Form("jar", (disc(0.036, 0.0, height),)), at)


def tin_box(s: Stage, at: Vector, name: str, size: Vector) -> Thing:
    """A closed box of a length, width and height [m]."""
    return s.put(name, box(size[0], size[1], size[2], "box"), at)


def basin(s: Stage, at: Vector, name: str = "basin", radius: float = 0.17) -> Thing:
    """A wide and shallow vessel."""
    return s.put(name, vessel(radius, 0.09, "basin", 0.006), at)


def glass(s: Stage, at: Vector, name: str = "glass") -> Thing:
    """A drinking glass."""
    return s.put(name, vessel(0.032, 0.12, "glass", 0.004), at)


def paper_roll() -> Form:
    """An upright roll of paper around a hole, standing on its origin."""
    return Form("roll", tuple(ring(0.02, TUBE_M, 0.0, 0.22)))


def roll_stand() -> Form:
    """A round foot with a pole in its middle, standing on its origin."""
    return Form("stand", (disc(0.08, 0.0, 0.015), disc(POLE_M, 0.01, 0.24)))


def mallet(length: float = 0.3) -> Form:
    """A mallet: a shaft along x from its origin, with a thick head at the far end."""
    shaft = block((0.0, -0.013, -0.013), (length, 0.013, 0.013))
    return Form("mallet", (shaft, block((length - 0.05, -0.03, -0.06), (length, 0.03, 0.04))))


def rake(length: float = 0.4) -> Form:
    """A rake: a shaft along x from its origin, and a cross board at the far end that hangs down."""
    shaft = block((0.0, -0.012, -0.012), (length, 0.012, 0.012))
    return Form("rake", (shaft, block((length - 0.015, -0.08, -0.09), (length, 0.08, 0.012))))


def scraper(length: float = 0.28) -> Form:
    """A scraper: a shaft along x from its origin, and an upright cross board at the far end."""
    shaft = block((0.0, -0.012, -0.012), (length, 0.012, 0.012))
    return Form("scraper", (shaft, block((length - 0.01, -0.06, -0.055), (length, 0.06, 0.03))))


def brush() -> Form:
    """A brush: a wooden back with bristles below, standing on its origin."""
    bristles = block((-0.08, -0.028, 0.0), (0.08, 0.028, 0.03))
    return Form("brush", (bristles, block((-0.1, -0.035, 0.03), (0.1, 0.035, 0.05))))


def long_knife() -> Form:
    """A bread knife: a handle along x from its origin, and a long thin blade with its edge down."""
    handle = block((0.0, -0.012, -0.013), (0.13, 0.012, 0.013))
    return Form("knife", (handle, block((0.13, -0.001, -0.022), (0.4, 0.001, 0.012))))


def tall_spoon(length: float = 0.3) -> Form:
    """A long upright spoon with a thicker end at its origin."""
    bowl = block((-0.012, -0.008, 0.0), (0.012, 0.008, 0.03))
    return Form("spoon", (bowl, *rod(length, 0.005).parts))


def soup_ladle(length: float = 0.3) -> Form:
    """A ladle: a wide cup on its origin, and a stem at its near side with a flat end."""
    cup = vessel(0.035, 0.04, "ladle", 0.004).parts
    stem = block((-0.043, -0.006, 0.01), (-0.033, 0.006, length))
    return Form("ladle", (*cup, stem, block((-0.043, -0.02, length - 0.01), (0.0, 0.02, length))))


def bucket(s: Stage, at: Vector, height: float = 0.2, name: str = "bucket") -> Thing:
    """A bucket with straight walls."""
    return s.put(name, vessel(0.11, height, "bucket", 0.006), at)


def stewpan() -> Form:
    """A pan with two lugs that a palm can lie on at either side."""
    y = 0.12
    lugs = [block((-0.04, low, 0.09), (0.04, low + 0.03, 0.105)) for low in (-y - 0.03, y)]
    return Form("pan", (*vessel(0.121, 0.11, "pan", 0.006).parts, *lugs))


def open_shelves(depth: float, width: float, heights: tuple[float, ...]) -> Form:
    """A rack between two side walls with boards whose tops are at these heights, open in front."""
    y, top = width / 2.0, max(heights)
    sides = [block((0.0, low, 0.0), (depth, low + 0.02, top)) for low in (-y - 0.02, y)]
    boards = [block((0.0, -y, high - 0.02), (depth, y, high)) for high in heights]
    return Form("rack", (*sides, *boards))
