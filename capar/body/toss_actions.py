"""A throw from one hand to the other, as virtual bodies perform it."""

import numpy as np

from capar.body.scripts import STAND, Hand, Move, Phase, Script
from capar.body.tosses import GRAVITY_MPS2, Toss, Vector

VELOCITY: Vector = (0.0, 1.1, 1.4)
"""With which the right hand throws: to the left and upwards [m/s]."""

SWINGS_S, FLIES_S, STOPS_S = 0.3, 0.3, 0.25
"""How long the throw, the flight and the stop take [s]."""

LIFT: Vector = (0.0, -0.08, 0.16)
"""From where the thing stands to where the throw begins [m]."""

BESIDE = np.array([0.0, 0.04, -0.02])
"""From where the thing is caught to where the hand waits as if it held it there [m]."""


def toss(thing: str) -> Script:
    """Take a thing, throw it to the left hand, catch it there, and put it down.

    Args:
        thing: What is thrown.
    """
    thrown = np.array(VELOCITY)
    caught = thrown + GRAVITY_MPS2 * FLIES_S
    # A hand that speeds up or slows down evenly covers half of the speed times the time.
    swing, stop = 0.5 * SWINGS_S * thrown, 0.5 * STOPS_S * caught
    flight = FLIES_S * thrown + 0.5 * GRAVITY_MPS2 * FLIES_S**2
    meets = LIFT + swing + flight
    down = -float((meets + stop)[2])
    right, left = {"right": Hand("holds", thing)}, {"left": Hand("holds", thing)}
    waits = {**right, "left": Hand("awaits", thing, awaited=_vector(meets + BESIDE))}
    swings_on = {"right": Hand("lets_go", thing, velocity=VELOCITY)}
    flies = {**swings_on, "left": Hand("reaches", thing)}
    catches = {"right": Hand("lets_go", thing), **left}
    throws = Move(_vector(swing), toss=Toss(end=VELOCITY))
    falls = Move(_vector(flight), toss=Toss(VELOCITY, falls=True))
    stops = Move(_vector(stop), toss=Toss(_vector(caught)))
    return (
        STAND,
        Phase("reach", 1.0, {"right": Hand("reaches", thing)}, look=thing),
        Phase("grasp", 0.3, right, look=thing),
        Phase("lift", 0.9, waits, {thing: Move(LIFT)}, look=thing),
        Phase("poise", 0.5, waits, look=thing),
        Phase("throw", SWINGS_S, waits, {thing: throws}, look=thing),
        Phase("fly", FLIES_S, flies, {thing: falls}, look=thing),
        Phase("catch", STOPS_S, catches, {thing: stops}, look=thing),
        Phase("hold", 0.4, catches, look=thing),
        Phase("lower", 0.9, catches, {thing: Move((0.0, 0.0, down))}, look=thing),
        Phase("release", 0.4, catches, look=thing),
        Phase("return", 1.0, look="ahead"),
        Phase("stand", 0.6, look="ahead"),
    )


def _vector(values: np.ndarray) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
