"""Actions that virtual bodies perform, and where: what can be tried without a recording."""

from functools import cache

import numpy as np

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import Performance, Role, perform, perform_together
from capar.body.recording import record, record_together
from capar.body.scenes import GUIDED, HINGE_M, Scene, Thing, box, cup, scene, table
from capar.body.scripts import (
    SIDES,
    STAND,
    Hand,
    Move,
    Phase,
    Script,
    carry_together,
    drink,
    lift_with_both_hands,
    pour,
    pull_open,
    push,
    push_open,
    sip,
    slide,
    toss,
    touch,
    touch_from_rest,
    turn,
    wipe,
)
from capar.body.sensors import PERFECT, Tracker
from capar.model.capture import Capture, TagType
from capar.model.errors import UnknownNameError

ASKEW = 0.8
"""How far the crate that is pushed is turned [rad]: straight ahead is at the wrist's limit."""

TOSS_TABLE_M = 0.8073
"""Height of the table above which is thrown, unless hips are lower [m]."""

HELD = {"right": Hand("holds", "mug")}
CARRY: Script = (
    STAND,
    Phase("reach", 1.0, {"right": Hand("reaches", "mug")}, look="mug"),
    Phase("grasp", 0.3, HELD, look="mug"),
    Phase("lift", 0.8, HELD, {"mug": Move((0.0, 0.0, 0.2))}, look="mug"),
    Phase("carry", 0.9, HELD, {"mug": Move((0.0, 0.2, 0.0))}, look="mug"),
    Phase("lower", 0.8, HELD, {"mug": Move((0.0, 0.0, -0.2))}, look="mug"),
    Phase("hold", 0.3, HELD, look="mug"),
    Phase("return", 1.0, look="ahead"),
    Phase("stand", 0.6, look="ahead"),
)
BOTH = {side: Hand("holds", "tray") for side in SIDES}


def _tray(ahead_m: float, up_m: float) -> dict[str, Move]:
    """Where a tray goes, and the mug on it."""
    return {name: Move((ahead_m, 0.0, up_m)) for name in ("tray", "mug")}


CARRY_TRAY: Script = (
    STAND,
    Phase("reach", 1.1, {side: Hand("reaches", "tray") for side in SIDES}, look="tray"),
    Phase("grasp", 0.3, BOTH, look="tray"),
    Phase("lift", 1.0, BOTH, _tray(0.0, 0.15), look="tray"),
    Phase("carry", 1.1, BOTH, _tray(-0.12, 0.0), look="tray"),
    Phase("lower", 1.0, BOTH, _tray(0.0, -0.15), look="tray"),
    Phase("release", 0.3, BOTH, look="tray"),
    Phase("return", 1.0, look="ahead"),
    Phase("stand", 0.6, look="ahead"),
)
ACTIONS: dict[str, Script] = {
    "drink": drink("mug"),
    "sip": sip("mug"),
    "touch": touch("crate"),
    "touch_from_rest": touch_from_rest("crate"),
    "slide": slide("mug", (0.0, 0.12, 0.0)),
    "carry": CARRY,
    "pick_up": lift_with_both_hands("crate", height=0.2),
    "turn": turn("mug", float(np.radians(40.0))),
    "push": push("crate", (0.15 * np.cos(ASKEW), 0.15 * np.sin(ASKEW), 0.0)),
    "carry_tray": CARRY_TRAY,
    "carry_two": carry_together("tin", ("carton",), (0.0, 0.2, 0.2)),
    "pour": pour("mug", lift=0.18, over=(0.0, 0.25, 0.0), angle=float(np.radians(80.0))),
    "door": push_open("door", float(np.radians(32.0)), hinge=(0.0, HINGE_M, 0.0)),
    "drawer": pull_open("drawer", 0.15),
    "wipe": wipe("sponge", 0.14),
    "toss": toss("mug"),
}
"""Each has the things of its own scene. Those of thesis 5.2 are ``sip`` (DrinkFromMug), ``touch``
(TouchCycle), ``touch_from_rest``, ``slide`` (SlideObject) and ``pick_up`` (PickUpWithBothHands)."""


def action_scene(human: Human, action: str) -> Scene:
    """A table with what the action needs, or what stands on a hinge or a rail."""
    tall = human.measures["stature"]
    top = min(TOSS_TABLE_M, 0.52 * tall) if action == "toss" else 0.52 * tall
    mug = Thing("mug", cup(0.035, 0.09), (0.22 * tall, -0.10 * tall, top), round=True)
    crate = Thing("crate", box(0.15, 0.20, 0.15), (0.24 * tall, 0.02 * tall, top))
    askew = Thing("crate", box(0.15, 0.20, 0.22), (0.29 * tall, -0.08 * tall, top), ASKEW)
    bowl = Thing("bowl", cup(0.07, 0.06), (0.22 * tall, -0.10 * tall + 0.34, top), round=True)
    if action in GUIDED:
        return GUIDED[action](tall)
    stand = Thing("stand", box(0.40, 0.14, 0.10), (0.34 * tall, 0.0, top), tag=TagType.FIXED)
    tray = Thing("tray", box(0.24, 0.30, 0.03), (0.34 * tall, 0.0, top + 0.10))
    borne = Thing("mug", cup(0.035, 0.09), (0.34 * tall, 0.0, top + 0.13), round=True)
    ahead, aside = 0.24 * tall, -0.10 * tall
    tin = Thing("tin", box(0.035, 0.05, 0.12), (ahead, aside, top))
    carton = Thing("carton", box(0.035, 0.05, 0.14), (ahead - 0.043, aside, top))
    sponge = Thing("sponge", box(0.12, 0.08, 0.05), (0.24 * tall, -0.09 * tall, top))
    needed = {
        "wipe": (sponge,),
        "touch": (crate,), "touch_from_rest": (crate,), "pick_up": (crate,),
        "push": (askew,), "pour": (mug, bowl), "carry_tray": (stand, tray, borne),
        "carry_two": (tin, carton),
    }  # fmt: skip
    return scene(table(top, near_m=0.13 * tall), *needed.get(action, (mug,)))


@cache
def performed(action: str, who: str = "man", *, rate_hz: float = 60.0) -> Performance:
    """An action as a ready-made body performs it.

    Args:
        action: One of ``ACTIONS``.
        who: One of ``READY_MADE``.
        rate_hz: Frames a second.

    Raises:
        UnknownNameError: There is no such action or body.
    """
    if action not in ACTIONS:
        raise UnknownNameError("action", action, ACTIONS)
    human = Human.of(ready_made(who))
    return perform(human, action_scene(human, action), ACTIONS[action], rate_hz=rate_hz)


def action_capture(
    action: str, who: str = "man", *, rate_hz: float = 60.0, noisy: bool = False, seed: int = 3
) -> Capture:
    """What a tracker records of an action: a perfect one, or one with usual faults."""
    tracker = Tracker() if noisy else PERFECT
    made = performed(action, who, rate_hz=rate_hz)
    return record(made, name=action, seed=seed, tracker=tracker)


HELD_JOINT_ACTIONS = {"right": Hand("holds", "mug")}
REACHED = {"right": Hand("reaches", "mug")}
OFFER_M = 0.12
"""How far above the table the mug is handed over [m]."""


def hand_over(
    thing_to_offer: tuple[float, float, float], offer_to_table: tuple[float, float, float]
) -> dict[str, Script]:
    """One takes a mug from the table and holds it out, the other takes it and puts it down.

    Args:
        thing_to_offer: From where the mug stands to where it is handed over [m].
        offer_to_table: From there to where it is put down [m].
    """
    times = {
        "stand": 0.6, "reach": 1.0, "grasp": 0.4, "offer": 1.1, "take": 1.1, "share": 0.5,
        "leave": 1.0, "set down": 1.0, "let go": 0.4, "return": 1.0, "end": 0.6,
    }  # fmt: skip
    giver = {
        "reach": Phase("", 0.0, REACHED, look="mug"),
        "grasp": Phase("", 0.0, HELD_JOINT_ACTIONS, look="mug"),
        "offer": Phase("", 0.0, HELD_JOINT_ACTIONS, {"mug": Move(thing_to_offer)}, look="mug"),
        "take": Phase("", 0.0, HELD_JOINT_ACTIONS, look="mug"),
        "share": Phase("", 0.0, HELD_JOINT_ACTIONS, look="mug"),
    }
    taker = {
        "offer": Phase("", 0.0, look="mug"),
        "take": Phase("", 0.0, REACHED, look="mug"),
        "share": Phase("", 0.0, HELD_JOINT_ACTIONS, look="mug"),
        "leave": Phase("", 0.0, HELD_JOINT_ACTIONS, look="mug"),
        "set down": Phase("", 0.0, HELD_JOINT_ACTIONS, {"mug": Move(offer_to_table)}, look="mug"),
        "let go": Phase("", 0.0, HELD_JOINT_ACTIONS, look="mug"),
    }
    return {"giver": _timed(giver, times), "taker": _timed(taker, times)}


def _timed(phases: dict[str, Phase], times: dict[str, float]) -> Script:
    """A script of all phases, in those that are not named of which the hands rest."""
    rests = Phase("", 0.0, look="ahead")
    found = {name: phases.get(name, rests) for name in times}
    return tuple(
        Phase(name, times[name], phase.hands, phase.moves, phase.look)
        for name, phase in found.items()
    )


JOINT_ACTIONS = ("hand_over",)


@cache
def performed_together(
    action: str, bodies: tuple[str, str] = ("man", "woman"), *, rate_hz: float = 60.0
) -> dict[str, Performance]:
    """An action as two ready-made bodies perform it, by the names of their agents.

    Args:
        action: One of ``JOINT_ACTIONS``.
        bodies: Two of ``READY_MADE``.
        rate_hz: Frames a second.

    Raises:
        UnknownNameError: There is no such action or body.
    """
    if action not in JOINT_ACTIONS:
        raise UnknownNameError("action of two", action, JOINT_ACTIONS)
    humans = [Human.of(ready_made(name)) for name in bodies]
    where, spots, apart_m = _across_a_table(humans[0])
    start, offer, end = (np.array(spot) for spot in spots)
    scripts = hand_over(_metres(offer - start), _metres(end - offer))
    roles = [
        Role("giver", humans[0], scripts["giver"]),
        Role("taker", humans[1], scripts["taker"], (apart_m, 0.0), float(np.pi)),
    ]
    return perform_together(where, roles, rate_hz=rate_hz)


def _across_a_table(human: Human) -> tuple[Scene, list[tuple[float, float, float]], float]:
    """A table between two, the ways of a mug on and above it, and how far they are apart [m]."""
    tall = human.measures["stature"]
    top, near_m, depth_m = 0.52 * tall, 0.13 * tall, 0.5
    apart_m = 2.0 * near_m + depth_m
    start = (0.22 * tall, -0.14 * tall, top)
    mug = Thing("mug", cup(0.035, 0.11), start, round=True)
    offer = (0.5 * apart_m, 0.0, top + OFFER_M)
    end = (apart_m - start[0], 0.14 * tall, top)
    return scene(table(top, near_m=near_m, depth_m=depth_m), mug), [start, offer, end], apart_m


def _metres(way: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in way)
    return x, y, z


def joint_capture(
    action: str,
    bodies: tuple[str, str] = ("man", "woman"),
    *,
    rate_hz: float = 60.0,
    noisy: bool = False,
    seed: int = 3,
) -> Capture:
    """What a tracker records of an action of two: a perfect one, or one with usual faults."""
    made = performed_together(action, bodies, rate_hz=rate_hz)
    return record_together(made, name=action, seed=seed, tracker=Tracker() if noisy else PERFECT)
