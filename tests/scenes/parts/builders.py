"""Things with parts that turn on a hinge or slide on a rail, and hands that move them."""

from dataclasses import dataclass, field
from math import inf
from typing import Any

import numpy as np
from trimesh import Trimesh
from trimesh.transformations import rotation_matrix

from capar.model.capture import TagType
from scenes.hands.paths import (
    AHEAD,
    LEFTWARD,
    NEAR,
    RIGHTWARD,
    UP,
    Body,
    Piece,
    Poses,
    Times,
    Vector,
    about,
    min_jerk,
    pose,
)
from scenes.hands.performer import Hand
from scenes.hands.shapes import Form, block, disc
from scenes.hands.stage import Finger, Stage
from scenes.hands.things import Thing
from scenes.objects import forms
from scenes.objects.builders import SINK, Grip

BEND_S = 0.3
"""How long a thumb takes to come down on a part [s]."""


@dataclass
class Jointed(Body):
    """A part: its pose is its base's, then a turn about an axis of the base or a shift along it.

    Where the turn or shift is zero, its axes are parallel to the base's.
    """

    base: Body = field(kw_only=True)
    point: Vector = (0.0, 0.0, 0.0)
    """Its origin in the base's frame, if neither turned nor shifted [m]."""

    axis: Vector = UP
    """The direction in the base's frame in which it opens, if right-handed."""

    rail: bool = False
    shut: float = 0.0
    """Turn [degrees] or shift [m] where it is closed."""

    moves: list[tuple[float, float, float]] = field(default_factory=list)
    """From when to when [s] how far it is opened [degrees or m]; the first says where it begins."""

    def opened(self, times: Times) -> Times:
        """How far it is open at times: degrees or metres from the closed place."""
        out = np.full(len(times), self.moves[0][2])
        before = self.moves[0][2]
        for start, end, goal in self.moves[1:]:
            out += (goal - before) * min_jerk((times - start) / (end - start))
            before = goal
        return out

    def poses(self, times: Times) -> Poses:
        """Poses at times [s]."""
        way = self.shut + self.opened(times)
        local = np.tile(pose(self.point), (len(times), 1, 1))
        if self.rail:
            local[:, :3, 3] += np.outer(way, self.axis)
        else:
            local = about(self.point, self.axis, np.radians(way)) @ local
        return self.base.poses(times) @ local


@dataclass(frozen=True)
class Pair:
    """A base and its part."""

    base: Thing
    part: Thing
    joint: Jointed
    grip: Grip
    """On the part, far from its hinge."""

    face: Grip | None = None
    """On the part, for a flat palm."""

    def stated(self, *, closed: bool = False) -> "Pair":
        """Let the capture say whose part it is, and where it is closed."""
        self.part.part_of = self.base.name
        along = np.asarray(self.joint.axis)
        shut = self.joint.shut * float(np.sign(along[np.argmax(np.abs(along))])) + 0.0
        if closed and self.joint.rail:
            self.part.closed_m = shut + float(np.abs(along) @ np.asarray(self.joint.point))
        elif closed:
            self.part.closed_deg = shut
        return self


def settle(time: float, *bodies: Body) -> None:
    """Let bodies stay where they are from a time on, whatever they rode on [s]."""
    for each, place in [(each, each.at(time)) for each in bodies]:
        each.play(time, time, lambda since, place=place: np.tile(place, (len(since), 1, 1)))


def work(
    hand: Hand, pair: Pair, to: float, duration: float, name: str = "", *,
    others: tuple[Hand, ...] = (), hold: float = 0.0,
) -> None:  # fmt: skip
    """Move the part until it is open so far [degrees or m], with hands on it, and stay on it."""
    hands, end = (hand, *others), hand.clock + duration
    rides = [each.body.ride(pair.joint, hand.clock) for each in hands]
    word = _moved_to(pair, hand.clock, end, to)
    for each, piece in zip(hands, rides, strict=True):
        each.clock = piece.end = end
        settle(end, each.body)
        each.step(name or word, pair.part, pair.base)
        if hold:
            each.hold(hold, pair.part, pair.base)


def _moved_to(pair: Pair, start: float, end: float, to: float) -> str:
    """Move the part from a time to a time [s], and say what that is called."""
    before = pair.joint.moves[-1][2]
    pair.joint.moves.append((start, end, to))
    return "Open" if to > before else "Close"


def bear(hand: Hand, pair: Pair, grip: Grip) -> None:
    """Hold the base in the air from the first frame on."""
    hand.body.first = grip.on(pair.base, 0.0)
    hand.meet(pair.base)
    hand.take(pair.base)


def free(hand: Hand, *things: Thing) -> None:
    """Move things no longer, but keep on touching."""
    hand.release()
    settle(hand.clock, *(each.body for each in things), hand.body)


def aboard(load: Thing, carrier: Thing, time: float) -> None:
    """Let a load go along with what it lies in or on, from a time on [s]."""
    load.body.ride(carrier.body, time)


def both_palms(s: Stage, hands: tuple[Hand, Hand], base: Thing, duration: float, up: float) -> int:
    """Right and left palm meet a thing's sides at once, and are joined to move it together."""
    right, left = hands
    late = max(right.clock, left.clock)
    for hand, side in ((right, "-y"), (left, "+y")):
        hand.until(late)
        hand.reach(base, side, duration, up=up, hold=0.3)
    since = len(right.steps)
    left.join(base)
    right.take(base)
    return since


def both_off(hands: tuple[Hand, Hand], since: int, duration: float = 1.0) -> None:
    """The left hand takes over the right one's steps, and both go home."""
    right, left = hands
    left.part(right, since)
    for hand in (right, left):
        hand.leave(duration)
        hand.idle(0.2)


def thumb(
    s: Stage, hand: Hand, pair: Pair, grip: Grip, form: Form, away: Vector = (0.0, 0.0, 0.05)
) -> Finger:
    """The thumb of a hand that has just reached the base; it comes to the part from aside [m]."""
    now = hand.clock
    own = np.linalg.inv(hand.now) @ grip.on(pair.part, now)
    finger = Finger(Body(f"{hand.side}_thumb", hand.body.first @ own), hand, form)
    finger.touches.append((pair.part, now, inf))
    _bend(finger, own, away, now - BEND_S, now, out=False)
    s.fingers.append(finger)
    return finger


def _bend(
    finger: Finger, own: np.ndarray, away: Vector, start: float, end: float, *, out: bool
) -> None:
    """Move a thumb in its hand's frame from aside to a place between two times [s], or back."""
    hand = finger.hand.body
    aside = np.linalg.inv(hand.at(end)[:3, :3]) @ np.asarray(away, dtype=float)

    def law(times: Times) -> Poses:
        local = np.tile(own, (len(times), 1, 1))
        far = np.clip((times - start) / (end - start), 0.0, 1.0)
        local[:, :3, 3] += np.outer(1.0 - (1.0 - far if out else far) ** 2, aside)
        return hand.poses(times) @ local

    finger.body.pieces.append(Piece(start if out else 0.0, inf, law))


def squeeze(
    finger: Finger, pair: Pair, to: float, duration: float, *, by: Vector = (), hold: float = 0.0
) -> None:  # fmt: skip
    """Move the part with the thumb of the hand that holds the base, perhaps while it is carried."""
    hand = finger.hand
    start, end = hand.clock, hand.clock + duration
    ride = finger.body.ride(pair.joint, start)
    word = _moved_to(pair, start, end, to)
    if len(by):
        hand.move(by, duration)
    hand.clock = ride.end = end
    finger.body.ride(hand.body, end)
    hand.step(word, pair.part, pair.base)
    if hold:
        hand.hold(hold, pair.part, pair.base)


def leave_tool(finger: Finger, duration: float, away: Vector = (0.0, 0.0, 0.05)) -> None:
    """Let go of a thing that was worked with the thumb, and go home."""
    hand = finger.hand
    ((thing, start, _),) = finger.touches
    finger.touches[0] = (thing, start, hand.clock)
    now, own = hand.clock, np.linalg.inv(hand.now) @ finger.body.at(hand.clock)
    hand.leave(duration)
    _bend(finger, own, away, now, now + BEND_S, out=True)
    hand.idle(0.2)


def put_part(
    s: Stage, base: Thing, name: str, form: Form, start: float, **joint: Any
) -> tuple[Thing, Jointed]:
    """Set a part on its base's joint, open so far at the first frame [degrees or m]."""
    body = Jointed(name, np.eye(4), base=base.body, moves=[(0.0, 0.0, start)], **joint)
    part = Thing(body, form, TagType.MOBILE)
    s.things.append(part)
    return part, body


def _pin(radius: float, half: float) -> Trimesh:
    """A hinge's pin along y about the origin, so long to either side [m]."""
    pin = disc(radius, -half, half, 48).copy()
    pin.apply_transform(rotation_matrix(np.pi / 2.0, AHEAD))
    return pin


def _moved(by: Vector, *parts: Trimesh) -> tuple[Trimesh, ...]:
    """Convex parts, each moved by the same way [m]."""
    out = [each.copy() for each in parts]
    for each in out:
        each.apply_translation(by)
    return tuple(out)


def laptop(
    s: Stage, at: Vector, *, start: float = 0.0, deep: float = 0.22, wide: float = 0.32
) -> Pair:
    """A laptop whose lid's frame stands upright; the lid has a tab in the middle of its edge."""
    x, high, r = deep / 2.0, 0.022, 0.004
    base = s.put("laptop", Form("laptop", (block((-x, -wide / 2, 0), (x, wide / 2, high)),)), at)
    half, edge = wide / 2 - 0.02, deep + 0.014
    lid = Form("lid", (
        block((-r, -half, 0.0), (r, half, deep - 2 * r)),
        block((-r, -0.02, deep - 0.03), (r, 0.02, edge)),
        _pin(r, 0.8 * half),
    ))  # fmt: skip
    point = (x - r, 0.0, high + r - SINK)
    part, joint = put_part(s, base, "lid", lid, start, point=point, axis=LEFTWARD, shut=-90.0)
    tip = Grip((r, 0.0, edge), (0.5, 0.0, 0.87), LEFTWARD)
    return Pair(base, part, joint, tip)


def box(
    s: Stage, at: Vector, *, start: float = 0.0, deep: float = 0.22, wide: float = 0.3,
    high: float = 0.12, name: str = "box", tag: str = "mobile",
) -> Pair:  # fmt: skip
    """A box with a lid on a hinge at its back; the lid has a lip in front."""
    base = s.put(name, forms.open_box(deep, wide, high, name, 0.016), at, tag=tag)
    r, half = forms.HINGE_M, wide / 2.0 - 0.01
    lid = Form("lid", (
        block((-deep, -half, -r), (-0.004, half, 0.004)),
        block((-deep - forms.HANDLE_M, -0.04, -0.004), (-deep, 0.04, 0.004)),
        _pin(r, 0.4 * wide),
    ))  # fmt: skip
    point = (deep / 2.0 - 0.006, 0.0, high + r - SINK)
    part, joint = put_part(s, base, "lid", lid, start, point=point, axis=LEFTWARD)
    lip = Grip((-deep - forms.HANDLE_M, 0.0, 0.0), NEAR, UP)
    return Pair(base, part, joint, lip, Grip((-0.65 * deep, 0.0, 0.004), UP, AHEAD))


def waffle_iron(s: Stage, at: Vector) -> Pair:
    """A waffle iron: a thick round base and a round cover with a long handle in front."""
    r, high, bore = 0.11, 0.1, forms.HINGE_M
    ear = block((0.8 * r, -0.03, 0.0), (r + 0.02, 0.03, high))
    base = s.put("waffle_iron", Form("waffle_iron", (disc(r, 0.0, high, 48), ear)), at)
    back = r + 0.01
    cover = Form("cover", (
        *_moved((-back, 0.0, 0.0), disc(r - 0.012, -bore, 0.022, 48)),
        block((-back - r - 0.1, -0.012, 0.0), (-back - r + 0.03, 0.012, 0.018)),
        block((-0.04, -0.02, -0.004), (0.0, 0.02, 0.006)),
        _pin(bore, 0.01),
    ))  # fmt: skip
    point = (back, 0.0, high + bore - SINK)
    part, joint = put_part(s, base, "cover", cover, 0.0, point=point, axis=LEFTWARD)
    end = Grip((-back - r - 0.1, 0.0, 0.009), NEAR, UP)
    return Pair(base, part, joint, end)


def folder(s: Stage, at: Vector, *, way: float = 1.0) -> Pair:
    """A thick folder whose cover turns to the left, or to the right if the way is -1."""
    wide, tall, high, r = 0.2, 0.28, 0.03, 0.003
    slab = block((-tall / 2, -wide / 2, 0), (tall / 2, wide / 2, high))
    base = s.put("folder", Form("folder", (slab,)), at)
    near, far = sorted((-way * (wide + 0.012), 0.0))
    spine = _pin(r, 0.4 * tall)
    spine.apply_transform(rotation_matrix(np.pi / 2.0, UP))
    cover = Form("cover", (block((-tall / 2, near, -r), (tall / 2, far, r)), spine))
    point = (0.0, way * wide / 2.0, high + r - SINK)
    part, joint = put_part(s, base, "cover", cover, 0.0, point=point, axis=(-way, 0.0, 0.0))
    edge = Grip((0.0, -way * (wide + 0.012), r), (0.0, -0.87 * way, 0.5), AHEAD)
    return Pair(base, part, joint, edge)


def bottle(s: Stage, at: Vector, *, start: float = 0.0) -> Pair:
    """A bottle with a cap on a hinge at its neck; the cap has a tab towards the performer."""
    ear = block((0.008, -0.008, 0.15), (0.021, 0.008, 0.165))
    body = Form("bottle", (disc(0.034, 0.0, 0.13), disc(0.014, 0.12, 0.165), ear))
    base = s.put("bottle", body, at)
    r = 0.004
    cap = Form("cap", (
        *_moved((-0.017, 0.0, 0.0), disc(0.017, -r, 0.01)),
        block((-0.064, -0.008, -0.002), (-0.03, 0.008, 0.006)),
        _pin(r, 0.004),
    ))  # fmt: skip
    point = (0.017, 0.0, 0.165 + r - SINK)
    part, joint = put_part(s, base, "cap", cap, start, point=point, axis=LEFTWARD)
    tab = Grip((-0.064, 0.0, -0.002), (-0.87, 0.0, -0.5), LEFTWARD)
    return Pair(base, part, joint, tab)


def tray(
    s: Stage, at: Vector, *, start: float = 0.0, deep: float = 0.26, wide: float = 0.24
) -> Pair:
    """A covered tray about its origin's upright axis, with a drawer that opens to the front."""
    high, wall = 0.1, forms.WALL_M
    made = _moved((-deep / 2, 0.0, wall), *forms.cabinet(deep, wide, high).parts)
    base = s.put("tray", Form("tray", made), at)
    drawer = forms.drawer(deep - 0.02, wide - 0.01, high - 0.015)
    point = (-deep / 2.0, 0.0, wall - SINK)
    part, joint = put_part(s, base, "drawer", drawer, start, point=point, axis=NEAR, rail=True)
    handle = Grip((-forms.HANDLE_M, 0.0, 0.5 * (high - 0.015)), NEAR, RIGHTWARD)
    return Pair(base, part, joint, handle)


def pencil_case(s: Stage, at: Vector, *, way: float = 1.0) -> Pair:
    """A case whose lid slides along its rims, to the left or, by a way of -1, to the right."""
    long, wide, high = 0.16, 0.3, 0.1
    base = s.put("pencil_case", forms.open_box(long, wide, high, "pencil_case", 0.014), at)
    knob = block((-0.008, -0.03, 0.006), (0.008, 0.03, 0.066))
    slab = block((-long / 2, -wide / 2 + 0.01, 0), (long / 2, wide / 2 - 0.01, 0.006))
    part, joint = put_part(
        s, base, "lid", Form("lid", (slab, knob)), 0.0,
        point=(0.0, 0.0, high - SINK), axis=(0.0, way, 0.0), rail=True,
    )  # fmt: skip
    top = Grip((0.0, 0.0, 0.066), UP, AHEAD)
    return Pair(base, part, joint, top)


def trolley(s: Stage, at: Vector, *, way: float = 1.0) -> Pair:
    """A trolley on four feet with a bar on top and a door in front, whose hinge is at one side."""
    deep, wide, high, low = 0.36, 0.4, 0.4, 0.25
    y, top = wide / 2.0, low + high + 0.012
    feet = [
        block((a, b, 0.0), (a + 0.03, b + 0.03, low - 0.012))
        for a in (0.02, deep - 0.05) for b in (-y, y - 0.03)
    ]  # fmt: skip
    posts = [block((0.0, b, top), (0.02, b + 0.02, top + 0.09)) for b in (-y, y - 0.02)]
    bar = block((0.0, -y, top + 0.08), (0.02, y, top + 0.1))
    shell = _moved((0.0, 0.0, low), *forms.cabinet(deep, wide, high).parts)
    base = s.put("trolley", Form("trolley", (*shell, *feet, *posts, bar)), at)
    door = forms.door(wide, high, way)
    point = (-forms.HINGE_M + SINK, -way * (y + 0.006), low)
    part, joint = put_part(s, base, "door", door, 0.0, point=point, axis=(0.0, 0.0, way))
    handle = Grip(
        (-0.008 - forms.HANDLE_M, way * (wide - 0.05), 0.4 * high + 0.06), NEAR, RIGHTWARD
    )
    return Pair(
        base, part, joint, handle, Grip((-0.008, way * (wide - 0.15), 0.7 * high), NEAR, UP)
    )


def crossed(
    s: Stage, at: Vector, names: tuple[str, str], *, way: float = 1.0, start: float = 0.0,
    jaws: bool = False, size: float = 1.0,
) -> Pair:  # fmt: skip
    """Scissors or pliers: two levers, one over the other, about an upright pivot.

    The base's handle is at the right and thicker, the part's at the left; a way of -1 swaps sides.
    """
    t = 0.006

    def lever(side: float, low: float, thick: float) -> Form:
        def piece(x: Vector, y: Vector, z: Vector) -> Trimesh:
            wide = sorted(side * each for each in y)
            return block((x[0], wide[0], z[0]), (x[1], wide[1], z[1]))

        layer = (low, low + t)
        bar = piece((-0.02, 0.022 if jaws else 0.1), (-0.008, 0.008), layer)
        link = piece((-0.04, -0.015), (0.0, 0.016), layer)
        parts = [bar, link, piece((-0.13, -0.036), (0.0, thick), (-t, t))]
        if jaws:
            parts += [piece((0.015, 0.03), (-0.012, 0.0), layer)]
            parts += [piece((0.025, 0.065), (-0.012, 0.0), (-t, t))]
        return Form(names[0] if thick > 0.02 else names[1], tuple(parts)).scaled(size)

    base = s.put(names[0], lever(-way, -t, 0.024), at)
    part, joint = put_part(s, base, names[1], lever(way, 0.0, 0.016), start, axis=(0.0, 0.0, -way))
    on_part = Grip((-0.09 * size, way * 0.016 * size, 0.0), (0.0, way, 0.0), AHEAD)
    return Pair(base, part, joint, on_part)


def on_handle(way: float = 1.0, size: float = 1.0) -> Grip:
    """Where a palm lies on the base's handle of crossed levers."""
    return Grip((-0.09 * size, -way * 0.024 * size, 0.0), (0.0, -way, 0.0), AHEAD)


def stapler(s: Stage, at: Vector) -> Pair:
    """A stapler whose arm stands up from its foot and is pressed down on it."""
    foot = block((-0.08, -0.022, 0.0), (0.07, 0.022, 0.012))
    base = s.put(
        "stapler", Form("stapler", (foot, block((0.05, -0.022, 0), (0.07, 0.022, 0.03)))), at
    )
    r = 0.006
    arm = Form("arm", (
        block((-0.14, -0.011, -r), (0.0, 0.011, 0.01)),
        block((-0.14, -0.011, -0.024), (-0.125, 0.011, -r)),
        _pin(r, 0.006),
    ))  # fmt: skip
    point = (0.06, 0.0, 0.036 - SINK)
    part, joint = put_part(s, base, "arm", arm, 25.0, point=point, axis=LEFTWARD)
    top = Grip((-0.125, 0.0, 0.01), UP, AHEAD)
    return Pair(base, part, joint, top)


def fist() -> Form:
    """A hand as a plain box, facing along x with its palm at the origin."""
    return Form("hand", (block((-0.06, -0.045, -0.04), (0.0, 0.045, 0.04)),))


def pad() -> Form:
    """A thumb that lies flat: it faces along x."""
    return Form("hand", (block((-0.018, -0.03, -0.009), (0.0, 0.03, 0.009)),))


def stump() -> Form:
    """A thumb that points along x, its tip at the origin."""
    return Form("hand", (block((-0.05, -0.008, -0.008), (0.0, 0.008, 0.008)),))
