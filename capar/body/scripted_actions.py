"""Actions that virtual bodies perform, and where: what can be tried without a recording."""

from functools import cache

import numpy as np

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import Performance, Role, perform, perform_together
from capar.body.recording import record, record_together
from capar.body.scenes import (
    HINGE_M,
    Scene,
    Thing,
    box,
    cup,
    door_scene,
    drawer_scene,
    scene,
    table,
)
from capar.body.scripts import (
    Script,
    carry,
    carry_together,
    carry_tray,
    drink,
    hand_over,
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
    vector,
    wipe,
)
from capar.body.sensors import PERFECT, Tracker
from capar.model.capture import Capture, TagType
from capar.model.errors import UnknownNameError

ASKEW = 0.8
"""How far the crate that is pushed is turned [rad]: straight ahead is at the wrist's limit."""

TOSS_TABLE_M, OFFER_M = 0.8073, 0.12
"""Height of the table above which is thrown, unless hips are lower, and how far above a table a mug
is handed over [m]."""

ACTIONS: dict[str, Script] = {
    "drink": drink("mug"),
    "sip": sip("mug"),
    "touch": touch("crate"),
    "touch_from_rest": touch_from_rest("crate"),
    "slide": slide("mug", (0.0, 0.12, 0.0)),
    "carry": carry("mug"),
    "pick_up": lift_with_both_hands("crate", height=0.2),
    "turn": turn("mug", float(np.radians(40.0))),
    "push": push("crate", (0.15 * np.cos(ASKEW), 0.15 * np.sin(ASKEW), 0.0)),
    "carry_tray": carry_tray("tray", "mug"),
    "carry_two": carry_together("tin", ("carton",), (0.0, 0.2, 0.2)),
    "pour": pour("mug", lift=0.18, over=(0.0, 0.25, 0.0), angle=float(np.radians(80.0))),
    "door": push_open("door", float(np.radians(32.0)), hinge=(0.0, HINGE_M, 0.0)),
    "drawer": pull_open("drawer", 0.15),
    "wipe": wipe("sponge", 0.14),
    "toss": toss("mug"),
}
"""Each has the objects of its own scene. Those of thesis 5.2 are ``sip`` (DrinkFromMug), ``touch``
(TouchCycle), ``touch_from_rest``, ``slide`` (SlideObject) and ``pick_up`` (PickUpWithBothHands)."""

JOINT_ACTIONS = ("hand_over",)
"""Those of two bodies."""


def action_scene(human: Human, action: str) -> Scene:
    """A table with what the action needs, or what stands on a hinge or a rail."""
    tall = human.measures["stature"]
    if action in {"door", "drawer"}:
        return door_scene(tall) if action == "door" else drawer_scene(tall)
    top = min(TOSS_TABLE_M, 0.52 * tall) if action == "toss" else 0.52 * tall
    ahead, aside = 0.24 * tall, -0.10 * tall
    mug = Thing("mug", cup(0.035, 0.09), (0.22 * tall, aside, top), round=True)
    crate = Thing("crate", box(0.15, 0.20, 0.15), (ahead, 0.02 * tall, top))
    needed = {
        "touch": (crate,),
        "touch_from_rest": (crate,),
        "pick_up": (crate,),
        "push": (Thing("crate", box(0.15, 0.20, 0.22), (0.29 * tall, -0.08 * tall, top), ASKEW),),
        "pour": (mug, Thing("bowl", cup(0.07, 0.06), (0.22 * tall, aside + 0.34, top), round=True)),
        "carry_tray": (
            Thing("stand", box(0.40, 0.14, 0.10), (0.34 * tall, 0.0, top), tag=TagType.FIXED),
            Thing("tray", box(0.24, 0.30, 0.03), (0.34 * tall, 0.0, top + 0.10)),
            Thing("mug", cup(0.035, 0.09), (0.34 * tall, 0.0, top + 0.13), round=True),
        ),
        "carry_two": (
            Thing("tin", box(0.035, 0.05, 0.12), (ahead, aside, top)),
            Thing("carton", box(0.035, 0.05, 0.14), (ahead - 0.043, aside, top)),
        ),
        "wipe": (Thing("sponge", box(0.12, 0.08, 0.05), (ahead, -0.09 * tall, top)),),
    }
    return scene(table(top, near_m=0.13 * tall), *needed.get(action, (mug,)))


@cache
def performed(action: str, who: str = "man", *, rate_hz: float = 60.0) -> Performance:
    """An action as a ready-made body performs it.

    Args:
        action: One of ``ACTIONS``.
        who: ``man``, ``woman`` or ``child``.
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
    made = performed(action, who, rate_hz=rate_hz)
    return record(made, name=action, seed=seed, tracker=Tracker() if noisy else PERFECT)


@cache
def performed_together(
    action: str, bodies: tuple[str, str] = ("man", "woman"), *, rate_hz: float = 60.0
) -> dict[str, Performance]:
    """An action as two ready-made bodies perform it across a table, by the names of their agents.

    Args:
        action: One of ``JOINT_ACTIONS``.
        bodies: Two of ``man``, ``woman`` and ``child``.
        rate_hz: Frames a second.

    Raises:
        UnknownNameError: There is no such action or body.
    """
    if action not in JOINT_ACTIONS:
        raise UnknownNameError("action of two", action, JOINT_ACTIONS)
    first, second = (Human.of(ready_made(name)) for name in bodies)
    tall = first.measures["stature"]
    top, near_m, depth_m = 0.52 * tall, 0.13 * tall, 0.5
    apart_m = 2.0 * near_m + depth_m
    start = (0.22 * tall, -0.14 * tall, top)
    offer, end = (0.5 * apart_m, 0.0, top + OFFER_M), (apart_m - start[0], 0.14 * tall, top)
    mug = Thing("mug", cup(0.035, 0.11), start, round=True)
    ways = (vector(np.array(b) - np.array(a)) for a, b in ((start, offer), (offer, end)))
    scripts = hand_over("mug", *ways)
    roles = [
        Role("giver", first, scripts["giver"]),
        Role("taker", second, scripts["taker"], (apart_m, 0.0), float(np.pi)),
    ]
    where = scene(table(top, near_m=near_m, depth_m=depth_m), mug)
    return perform_together(where, roles, rate_hz=rate_hz)


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
