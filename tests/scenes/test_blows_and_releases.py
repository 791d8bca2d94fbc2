"""What meets fast is not always struck, and what leaves a hand not always thrown or let go of."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from combinations import in_turn
from scipy.spatial.transform import Rotation

import capar
from capar.pipelines.language import vocabulary
from capar.pipelines.linguistic_report import primitive_files, primitive_words
from kb.actionary import Actionary
from kb.language import Question, parse
from scenes.hands import shapes
from scenes.hands.paths import LEFTWARD, NEAR, UP, Times, quintic
from scenes.hands.performer import GRAVITY, Hand, travel
from scenes.hands.scene import at_table
from scenes.hands.stage import Noise, Stage
from scenes.hands.things import Thing
from scenes.household.builders import mallet
from scenes.objects import forms
from scenes.objects.builders import Grip, begin_with, floor

BORDER_S = 0.1
"""A border is right when it is no further from the truth [s]."""

Write = Callable[[Stage], None]
TRACKERS = ((30.0, 0.0005), (60.0, 0.0015), (120.0, 0.0015))
"""Rates [Hz] and noise of positions [m]."""

END = Grip((0.0, 0.0, 0.0), NEAR, UP)
"""The end of a handle that lies along x from its origin."""


def hammered(s: Stage, side: str, form: shapes.Form, up: float, arm: float, blows: int) -> None:
    """A tool that turns about a joint so far behind the grip [m] strikes a peg again and again."""
    y = 0.1 * _aside(side)
    at_table(s, height=0.8, yaw_deg=350 * y)
    s.put("block", shapes.box(0.2, 0.2, 0.08, "block"), (0.72, y), tag="fixed")
    peg = s.put("peg", forms.nail(), (0.72, y, s.height + 0.08), tag="fixed")
    far, low = form.vertices[:, 0].max() - 0.015, form.vertices[:, 2].min()
    tool = s.put("tool", form, (0.72 - far, y, s.height + 0.15 - low))
    hand = s.hand(side)
    begin_with(hand, tool, END)
    hand.hold(0.5, tool)
    joint = hand.now[:3, 3] - (arm, 0.0, 0.0)
    for blow in range(blows):
        if blow:
            hand.idle(0.08)
        for name, way, duration, speed in (
            ("Lift" if blow else "Raise", up if blow else up - 0.02, 0.35, 0.0),
            ("Hit", -up, 0.2, 1.4),
        ):
            angle = way / (far + arm)
            law = partial(_swung, angle, duration, speed / (far + arm))
            hand.body.turn(hand.clock, hand.clock + duration, joint, (0.0, -1.0, 0.0), law)
            hand.idle(duration)
            hand.step(name, *((tool, peg) if name == "Hit" else (tool,)))
    hand.hold(0.6, tool, peg)


def _swung(angle: float, duration: float, speed: float, since: Times) -> Times:
    return angle * quintic(since / duration, 0.0, speed * duration / abs(angle))


def set_down(s: Stage, side: str, size: float, high: float, far: float, duration: float) -> None:
    """A small thing is taken aside by a fast hop and stays where it comes down."""
    thing, table, hand = _taken(s, side, shapes.box(size, size, size, "cube"))
    hand.hop(high, (0.05, -far * _aside(side), 0.0), duration)
    hand.step("MoveObjTo", thing, table)
    hand.hold(0.4, thing, table)
    hand.leave(0.9)
    hand.idle(0.2)


def shoved_off(s: Stage, side: str, form: shapes.Form, speed: float) -> None:
    """A thing is pushed over a table's far edge at a speed [m/s], tips and falls to the floor."""
    edge, y = 0.8, 0.1 * _aside(side)
    table = at_table(s, yaw_deg=400 * y, depth=edge - 0.3)
    floor(s)
    low, high = form.vertices.min(axis=0), form.vertices.max(axis=0)
    thing = s.put("thing", form, (0.45, y, s.height - low[2]))
    hand = s.hand(side, idle=0.2)
    hand.reach(thing, "-x", 0.9, up=0.7, fingers=UP, hold=0.4)
    hand.take(thing)
    way = edge + 0.003 - 0.45
    travel(hand, "Push", (way, 0.0, 0.0), 1.6 * way / speed, thing, table, arrive=speed)
    hand.let_go()
    _tipped(thing, hand.clock, edge, s.height, speed, (high[0] - low[0]) / 2.0, -low[2])
    hand.move((0.06 * speed, 0.0, 0.0), 0.15, depart=speed)
    hand.fly(hand.home, 0.9)
    hand.step("ResumePosture", thing)
    hand.idle(0.3)


def _tipped(
    thing: Thing, start: float, edge: float, top: float, speed: float, half: float, below: float
) -> None:
    """It slides on and turns about the edge, until its half is over it, and falls then."""
    base, turning, duration = thing.body.at(start), 55.0, min(half / speed, 0.2)

    def tipping(since: Times) -> np.ndarray:
        angle = turning * since**2 / 2.0
        way, up = 0.003 + speed * since, below
        return np.stack(
            [
                edge + way * np.cos(angle) + up * np.sin(angle),
                top - way * np.sin(angle) + up * np.cos(angle),
                angle,
            ],
            axis=1,
        )

    last, before = tipping(np.array([duration, duration - 1e-4]))
    rate = (last - before) / 1e-4

    def law(since: Times) -> np.ndarray:
        free = np.clip(since - duration, 0.0, None)[:, None]
        x, z, angle = (tipping(np.minimum(since, duration)) + free * rate).T
        z = z - GRAVITY / 2.0 * free[:, 0] ** 2
        out = np.tile(base, (len(since), 1, 1))
        out[:, :3, :3] = Rotation.from_rotvec(np.outer(angle, LEFTWARD)).as_matrix() @ base[:3, :3]
        out[:, 0, 3], out[:, 2, 3] = x, z
        return out

    fine = np.linspace(0.0, 1.0, 1001)
    end = start + float(fine[np.argmax(law(fine)[:, 2, 3] <= half)])
    thing.body.play(start, end, law)
    thing.free.append((start, end))


def let_fall(s: Stage, side: str, form: shapes.Form, fall: float, hold: float) -> None:
    """A thing is carried over a bin beside the table and let go, over it or deep inside [m]."""
    sign = _aside(side)
    thing, _, hand = _taken(s, side, form, depth=0.4)
    floor(s)
    s.put("bin", forms.open_box(0.3, 0.3, 0.3, "bin"), (0.45, 1.0 * sign, 0.0))
    travel(hand, "Lift", (0.0, 0.0, 0.15), 0.6, thing)
    travel(hand, "Carry", (0.0, 0.85 * sign, 0.0), 1.2, thing)
    down = max(0.0, s.height + 0.15 - 0.008 - fall)
    if down:
        travel(hand, "Lower", (0.0, 0.0, -down), 1.0, thing)
    if hold:
        hand.hold(hold, thing)
    start, duration = hand.clock, float(np.sqrt(2.0 * fall / GRAVITY))
    hand.let_go()
    thing.body.shift(start, start + duration, _falling)
    thing.free.append((start, start + duration))
    hand.move((0.0, 0.0, down + 0.1), 0.8)
    hand.fly(hand.home, 1.0)
    hand.step("Drop", thing)
    hand.idle(0.2)


def _falling(since: Times) -> np.ndarray:
    return np.outer(since**2, (0.0, 0.0, -GRAVITY / 2.0))


def pulled_from_behind(s: Stage, side: str, size: float, by: tuple[float, float]) -> None:
    """A hand reaches over a tub to its far side and brings it near with its palm."""
    y = 0.12 * _aside(side)
    table = at_table(s, height=0.68, yaw_deg=-900 * y)
    tub = s.put("tub", shapes.box(size, size * 1.2, 0.18, "tub"), (0.75, -y))
    hand = s.hand(side, idle=0.2)
    hand.go_without_step((0.75, -y, s.height + 0.4), 0.7)
    hand.reach(tub, "+x", 0.8, up=0.6, fingers=UP, hold=0.4)
    hand.take(tub)
    travel(hand, "Pull", (by[0], by[1] * _aside(side), 0.0), 1.0, tub, table, hold=0.4)
    hand.let_go()
    hand.move((0.06, 0.0, 0.0), 0.3)
    hand.move((0.0, 0.0, 0.33), 0.6)
    hand.fly(hand.home, 0.9)
    hand.step("ResumePosture", tub)
    hand.idle(0.2)


def _aside(side: str) -> float:
    return -1.0 if side == "right" else 1.0


def _taken(s: Stage, side: str, form: shapes.Form, depth: float = 0.7) -> tuple[Thing, Thing, Hand]:
    """A thing on a table, the table, and a hand that has just taken the thing from above."""
    sign = _aside(side)
    table = at_table(s, height=0.72, yaw_deg=50 * sign, depth=depth)
    low = form.vertices[:, 2].min()
    thing = s.put("thing", form, (0.45, 0.15 * sign, s.height - low))
    hand = s.hand(side, idle=0.2)
    hand.reach(thing, "+z", 0.8, up=1.0)
    hand.take(thing)
    return thing, table, hand


BOX, CARTON = shapes.box(0.1, 0.1, 0.16), shapes.box(0.16, 0.16, 0.14)
SCENES: dict[str, Write] = {
    "hammer from the wrist": lambda s: hammered(s, "right", forms.hammer(), 0.2, 0.05, 2),
    "mallet from the elbow": lambda s: hammered(s, "left", mallet(), 0.3, 0.25, 2),
    "hammer three times": lambda s: hammered(s, "left", forms.hammer(), 0.14, 0.25, 3),
    "die set down": lambda s: set_down(s, "right", 0.016, 0.12, 0.2, 0.4),
    "cube set down": lambda s: set_down(s, "left", 0.05, 0.08, 0.1, 0.35),
    "box shoved off": lambda s: shoved_off(s, "right", BOX, 0.5),
    "carton shoved off": lambda s: shoved_off(s, "left", CARTON, 0.8),
    "ball rolled off": lambda s: shoved_off(s, "right", shapes.ball(0.08), 0.6),
    "ball let go over a bin": lambda s: let_fall(s, "right", shapes.ball(0.03), 0.862, 0.0),
    "box let go over a bin": lambda s: let_fall(s, "left", shapes.box(0.07, 0.07, 0.05), 0.5, 0.5),
    "ball let go in a bin": lambda s: let_fall(s, "left", shapes.ball(0.04), 0.12, 0.4),
    "tub pulled": lambda s: pulled_from_behind(s, "right", 0.15, (-0.25, 0.0)),
    "small tub pulled aslant": lambda s: pulled_from_behind(s, "left", 0.1, (-0.2, 0.1)),
}
"""Each kind by a right and a left hand, and by things of different sizes."""


@pytest.mark.parametrize(
    ("rate_hz", "noise_m", "name"), in_turn(TRACKERS, [(name,) for name in SCENES])
)
def test_a_blow_a_release_and_a_pull_are_named(name: str, rate_hz: float, noise_m: float) -> None:
    stage = Stage(name.replace(" ", "_"))
    SCENES[name](stage)
    seen = capar.observe(stage.capture(rate_hz, Noise(noise_m, 0.002), 7))
    (unit,) = stage.expectation(rate_hz).units
    (link,) = seen.links
    assert [(each.name, each.objects) for each in link.segments] == list(unit.actions)
    for found, step in zip(link.segments, unit.steps, strict=True):
        assert abs(found.start_s - step.start_s) <= BORDER_S, found


def _answers(kind: str, question: str) -> bool:
    stage = Stage(kind.replace(" ", "_"))
    SCENES[kind](stage)
    with Actionary.in_memory() as known:
        known.add(capar.observe(stage.capture(60.0, Noise(0.001, 0.002), 7)))
        read = parse(question, vocabulary(primitive_words(primitive_files()), known.store))
        assert isinstance(read, Question)
        return bool(list(known.store.ask(read.sparql).plain()))


@pytest.mark.parametrize(
    ("kind", "question", "yes"),
    [
        ("ball let go over a bin", "did anyone drop anything?", True),
        ("ball let go in a bin", "did anyone put anything into the bin?", True),
        ("ball let go over a bin", "what was dropped into the bin?", True),
        ("box let go over a bin", "did anyone throw anything?", False),
        ("die set down", "did anyone drop anything?", False),
        ("box shoved off", "did anyone drop anything?", False),
        ("box shoved off", "did anyone throw anything?", False),
    ],
)
def test_only_what_falls_from_a_hand_was_dropped(kind: str, question: str, yes: bool) -> None:
    assert _answers(kind, question) is yes
