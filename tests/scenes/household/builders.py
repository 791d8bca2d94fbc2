"""Furniture and household goods of this battery."""

from dataclasses import dataclass

from scenes.hands.paths import NEAR, RIGHTWARD, UP, Vector
from scenes.hands.shapes import Form, ball, block, box, disc, ring, rod, vessel
from scenes.hands.stage import Stage
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import SINK, Cupboard, Grip, Hinge

LEAF_M = 0.016
"""Thickness of a leaf that slides or falls [m]."""

FOOT_M = 0.05
"""Height of a sideboard's feet below its opening [m]."""


@dataclass(frozen=True)
class Rail:
    """A fixed body and a part that slides along a straight line."""

    body: Thing
    part: Thing
    grip: Grip
    """On the part's handle."""


def _barrel(half: float) -> Form:
    """A hinge's barrel along y, about the origin [m]."""
    barrel = disc(forms.HINGE_M, -half, half, 48).copy()
    barrel.apply_transform([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    return Form("barrel", (barrel,))


def _lifted(form: Form, up: float) -> Form:
    """The same form, higher in its frame [m]."""
    parts = [each.copy() for each in form.parts]
    for part in parts:
        part.apply_translation((0.0, 0.0, up))
    return Form(form.kind, tuple(parts))


def _joined(kind: str, *pieces: Form) -> Form:
    """Several forms as one."""
    return Form(kind, tuple(part for piece in pieces for part in piece.parts))


def dresser(
    s: Stage, at: Vector, *, heights: tuple[float, ...], depth: float = 0.36, width: float = 0.34
) -> list[Rail]:
    """Drawers one over the other in one body, each of a height [m], from the lowest up.

    The front's lower edge stands at a place; drawers are called after their number.
    """
    x, y, z = at
    wall = forms.WALL_M
    floors = [z + sum(heights[:k]) + k * wall for k in range(len(heights))]
    bays = [
        _lifted(forms.cabinet(depth, width, high), low - z)
        for low, high in zip(floors, heights, strict=True)
    ]
    body = s.put("dresser", _joined("dresser", *bays), (x, y, z), tag="fixed")
    names = ("lower_drawer", "upper_drawer") if len(heights) == 2 else ("drawer",)
    rails = []
    for name, low, high in zip(names, floors, heights, strict=True):
        made = forms.drawer(depth - 0.02, width - 0.01, high - 0.015)
        drawer = s.put(name, made, (x, y, low - SINK))
        grip = Grip((-forms.HANDLE_M, 0.0, 0.5 * (high - 0.015)), NEAR, RIGHTWARD)
        rails.append(Rail(body, drawer, grip))
    return rails


def sliding_cupboard(
    s: Stage, at: Vector, *, way: float, width: float = 0.6, height: float = 0.32
) -> Rail:
    """A cupboard whose one door covers half of its front and slides sideways before the other.

    Args:
        s: The stage.
        at: Middle of the opening's lower edge; the feet stand five centimetres lower [m].
        way: 1 if the shut door is at the right and opens to the left, -1 the other way round.
        width: Of the cupboard [m].
        height: Of the opening [m].
    """
    x, y, z = at
    half = width / 2.0
    feet = Form("feet", (block((0.06, -half, -FOOT_M), (0.26, half, -forms.WALL_M)),))
    made = _joined("sideboard", forms.cabinet(0.32, width, height, "sideboard"), feet)
    body = s.put("sideboard", made, at, tag="fixed")
    panel = block((-LEAF_M, -half / 2.0, -0.01), (SINK, half / 2.0, height + 0.01))
    handle = block(
        (-LEAF_M - forms.HANDLE_M, -0.004, 0.4 * height), (-LEAF_M, 0.004, 0.4 * height + 0.12)
    )
    leaf = s.put("door", Form("door", (panel, handle)), (x, y - way * half / 2.0, z))
    grip = Grip((-LEAF_M - forms.HANDLE_M, 0.0, 0.4 * height + 0.06), NEAR, RIGHTWARD)
    return Rail(body, leaf, grip)


def oven(s: Stage, at: Vector, *, width: float = 0.44, height: float = 0.34) -> Cupboard:
    """An oven whose door turns down about a hinge at its lower edge."""
    x, y, z = at
    body = s.put("oven", forms.cabinet(0.4, width, height, "oven"), at, tag="fixed")
    axis = (x - forms.HINGE_M + SINK, y, z)
    half = width / 2.0
    panel = block((-0.008, -half, 0.004), (0.006, half, height))
    bar = block(
        (-0.008 - forms.HANDLE_M, -0.04, height - 0.044),
        (-0.008, 0.04, height - 0.036),
    )
    leaf = s.put("door", Form("door", (panel, bar, *_barrel(0.4 * width).parts)), axis)
    return Cupboard(
        body,
        leaf,
        Hinge(axis, (0.0, 1.0, 0.0), -1.0),
        Grip((-0.008 - forms.HANDLE_M, 0.0, height - 0.04), NEAR, UP),
        Grip((-0.008, 0.13, 0.6 * height), NEAR, UP),
    )


def flap_cupboard(s: Stage, at: Vector, *, width: float = 0.5, height: float = 0.3) -> Cupboard:
    """A wall cupboard whose flap turns up about a hinge at its upper edge."""
    x, y, z = at
    body = s.put("cupboard", forms.cabinet(0.3, width, height, "cupboard"), at, tag="fixed")
    axis = (x - forms.HINGE_M + SINK, y, z + height)
    half = width / 2.0
    panel = block((-0.008, -half, -height), (0.006, half, -0.004))
    lip = block((-0.008 - forms.HANDLE_M, -0.06, -height + 0.03), (-0.008, 0.06, -height + 0.038))
    leaf = s.put("flap", Form("flap", (panel, lip, *_barrel(0.4 * width).parts)), axis)
    return Cupboard(
        body,
        leaf,
        Hinge(axis, (0.0, 1.0, 0.0), 1.0),
        Grip((-0.008 - forms.HANDLE_M, 0.0, -height + 0.034), NEAR, UP),
        Grip((-0.008, 0.1, -0.5 * height), NEAR, UP),
    )


def gate(s: Stage, at: Vector, *, width: float = 0.6, height: float = 0.95) -> Cupboard:
    """A gate that stands just over the floor between two posts; its hinge is at the right."""
    x, y, z = at
    post = 0.06
    posts = [
        block((-0.03, low, 0.0), (0.03, low + post, height + 0.05))
        for low in (-post, width + 0.015)
    ]
    body = s.put("posts", Form("posts", tuple(posts)), at, tag="fixed")
    axis = (x, y + forms.HINGE_M - SINK, z + 0.02)
    leaf = s.put("gate", forms.door(width, height, 1.0), axis)
    middle = 0.4 * height + 0.06
    return Cupboard(
        body,
        leaf,
        Hinge(axis, UP, 1.0),
        Grip((-0.008 - forms.HANDLE_M, width - 0.05, middle), NEAR, RIGHTWARD),
        Grip((-0.008, width - 0.2, 0.75 * height), NEAR, UP),
    )


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
