"""Actions that two virtual bodies perform together, and where: what needs no recording."""

from functools import cache

import numpy as np

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.joint_performances import Role, perform_together, record_together
from capar.body.performing import Performance
from capar.body.scripts import Hand, Move, Phase, Script
from capar.body.sensing import PERFECT, Tracker
from capar.body.things import Scene, Thing, cup, scene, table
from capar.model.capture import Capture
from capar.model.errors import UnknownNameError

HELD = {"right": Hand("holds", "mug")}
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
        "grasp": Phase("", 0.0, HELD, look="mug"),
        "offer": Phase("", 0.0, HELD, {"mug": Move(thing_to_offer)}, look="mug"),
        "take": Phase("", 0.0, HELD, look="mug"),
        "share": Phase("", 0.0, HELD, look="mug"),
    }
    taker = {
        "offer": Phase("", 0.0, look="mug"),
        "take": Phase("", 0.0, REACHED, look="mug"),
        "share": Phase("", 0.0, HELD, look="mug"),
        "leave": Phase("", 0.0, HELD, look="mug"),
        "set down": Phase("", 0.0, HELD, {"mug": Move(offer_to_table)}, look="mug"),
        "let go": Phase("", 0.0, HELD, look="mug"),
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
