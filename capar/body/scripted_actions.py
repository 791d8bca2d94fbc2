"""Actions that virtual bodies perform, and where: what can be tried without a recording."""

from dataclasses import replace
from functools import cache

import numpy as np

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.performing import Performance, Role, perform, perform_together
from capar.body.recording import RIGS, record, record_together
from capar.body.scripts import (
    SIDES,
    Move,
    Script,
    Step,
    Vector,
    drink,
    hand_over,
    handling,
    lift_with_both_hands,
    sip,
    slide,
    toss,
    touch,
    vector,
)
from capar.body.sensors import PERFECT, Tracker
from capar.body.virtual_scenes import (
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
from capar.model.capture import Capture, Purpose, TagType
from capar.model.errors import UnknownNameError

#: How far the crate that is pushed is turned [rad]: straight ahead is at the wrist's limit
ASKEW = 0.8
#: Height of the table above which is thrown, unless hips are lower, and how far above a table a mug
#: is handed over [m]
TOSS_TABLE_M, OFFER_M = 0.8073, 0.12
TURNED = Move(turn=(0.0, 0.0, float(np.radians(40.0))))
SWUNG = Move(turn=(0.0, 0.0, float(np.radians(32.0))), about=(0.0, HINGE_M, 0.0))
PUSHED = Move((0.15 * np.cos(ASKEW), 0.15 * np.sin(ASKEW), 0.0))
LEANT = float(np.radians(80.0))
GRASP: Step = ("grasp", 0.4, None)
TOUCH: Step = ("touch", 0.4, None)
STAY: Step = ("stay", 0.4, None)


def _once(first: Step, name: str, seconds: float, move: Move, hold_s: float) -> list[Step]:
    """One motion between a moment of touching and one of holding."""
    return [first, (name, seconds, move), ("hold", hold_s, None)]


def _carried(pause_s: float, lift_s: float, carry_s: float, by: Vector, end: str) -> list[Step]:
    """Lift, carry and lower; the height is that of the lift [m]."""
    ahead, left, up = by
    return [
        ("grasp", pause_s, None),
        ("lift", lift_s, Move((0.0, 0.0, up))),
        ("carry", carry_s, Move((ahead, left, 0.0))),
        ("lower", lift_s, Move((0.0, 0.0, -up))),
        (end, pause_s, None),
    ]


TRAY = _carried(0.3, 1.0, 1.1, (-0.12, 0.0, 0.15), "release")
TWO = _carried(0.4, 0.9, 0.9, (0.0, 0.2, 0.2), "release")
DOOR = _once(TOUCH, "open", 1.2, SWUNG, 0.4)
DRAWER = _once(TOUCH, "open", 1.0, Move((-0.15, 0.0, 0.0)), 0.4)
STROKES: list[Step] = [("stroke", 0.5, Move((0.0, by_m, 0.0))) for by_m in (0.14, -0.14) * 3]
POUR: list[Step] = [
    GRASP,
    ("lift", 0.9, Move((0.0, 0.0, 0.18))),
    ("bring", 0.9, Move((0.0, 0.25, 0.0))),
    STAY,
    ("lean", 1.0, Move(turn=(-LEANT, 0.0, 0.0))),
    ("pour", 0.5, None),
    ("right", 1.0, Move(turn=(LEANT, 0.0, 0.0))),
    STAY,
    ("bring back", 0.9, Move((0.0, -0.25, 0.0))),
    STAY,
    ("lower", 0.9, Move(home=True)),
    ("release", 0.4, None),
]

#: Each has the objects of its own scene. Those of thesis 5.2 are ``drink_from_mug`` and, faster,
#: ``sip``; ``touch`` (TouchCycle), ``touch_from_rest``, ``slide`` (SlideObject) and ``pick_up``
#: (PickUpWithBothHands)
ACTIONS: dict[str, Script] = {
    "drink": drink("mug"),
    "sip": sip("mug"),
    "drink_from_mug": sip("mug", times_s=(1.45, 1.0, 0.94, 0.2, 0.68, 0.19, 1.03)),
    "touch": touch("crate"),
    "touch_from_rest": touch("crate", seconds=1.4)[:3],
    "slide": slide("mug", (0.0, 0.12, 0.0)),
    "carry": handling("mug", _carried(0.3, 0.8, 0.9, (0.0, 0.2, 0.2), "hold")),
    "pick_up": lift_with_both_hands("crate", height=0.2),
    "turn": handling("mug", _once(GRASP, "turn", 0.9, TURNED, 0.4)),
    "push": handling("crate", _once(TOUCH, "push", 0.9, PUSHED, 0.3), grip="back", reach_s=1.1),
    "carry_tray": handling("tray", TRAY, sides=SIDES, load=("mug",), reach_s=1.1),
    "carry_two": handling("tin", TWO, beside=("carton",)),
    "pour": handling("mug", POUR),
    "door": handling("door", DOOR, grip="back", reach_s=1.1, back_s=1.1),
    "drawer": handling("drawer", DRAWER, grip="top"),
    "wipe": handling("sponge", [TOUCH, *STROKES, ("hold", 0.4, None)], grip="top"),
    "toss": toss("mug"),
}
#: What each step of an action is done for (thesis 4.6.2); the first that fits counts
PURPOSES = {
    "drink_from_mug": (
        Purpose("PickUp", action="Reach"),
        Purpose("Drink", goal="head"),
        Purpose("PutDown", action="MoveObjTo", goal="table"),
        Purpose("Release"),
    )
}
JOINT_ACTIONS = ("hand_over",)  # those of two bodies


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
    """An action of ``ACTIONS`` as a ``man``, ``woman`` or ``child`` performs it."""
    if action not in ACTIONS:
        raise UnknownNameError("action", action, ACTIONS)
    human = Human.of(ready_made(who))
    return perform(human, action_scene(human, action), ACTIONS[action], rate_hz=rate_hz)


def action_capture(
    action: str,
    who: str = "man",
    *,
    rate_hz: float = 60.0,
    noisy: bool = False,
    seed: int = 3,
    rig: str = "hands",
) -> Capture:
    """What a tracker records of an action: a perfect one, or one with usual faults.

    Sensors are those of a rig of ``RIGS``; with the whole one only hands that do something act.
    """
    if rig not in RIGS:
        raise UnknownNameError("rig", rig, RIGS)
    made = performed(action, who, rate_hz=rate_hz)
    busy = {f"{side}_hand" for phase in made.script for side in phase.hands}
    capture = record(
        made, name=action, seed=seed, tracker=Tracker() if noisy else PERFECT, sensors=RIGS[rig],
        acting=None if rig == "hands" else busy, agent=who,
    )  # fmt: skip
    return replace(capture, purposes=PURPOSES.get(action, ()))


@cache
def performed_together(
    action: str, bodies: tuple[str, str] = ("man", "woman"), *, rate_hz: float = 60.0
) -> dict[str, Performance]:
    """An action of ``JOINT_ACTIONS`` as two bodies perform it across a table, by agent."""
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
