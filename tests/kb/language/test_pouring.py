"""Pouring is told until the vessel is upright, though the hand rests, or moves on with it."""

from dataclasses import replace

import pytest
from observations import MUG, TABLE, Piece, observation

from capar.model.facts import Posture, Touching
from capar.model.observation import Observation
from capar.model.par import FeatureSet
from kb.language.describe import describe
from kb.language.thresholds import POURING_RAD

WORKS, PLACED = (FeatureSet(start, "101", "10", "hand", "00") for start in ("101", "100"))
BOTTLE = replace(MUG, name="bottle", kind="bottle")
BOWL = replace(MUG, name="bowl", kind="bowl")


def seen(upright_s: float) -> Observation:
    """A bottle is poured from, from 1 to 2 s, held to 3 s and put down till 5 s, tipped until then.

    Args:
        upright_s: When it ceases to be tipped [s].
    """
    pieces = (
        Piece("MoveObjTo", 100, ("bottle", "bowl"), features=PLACED),
        Piece("Pour", 200, ("bottle", "bowl"), features=WORKS),
        Piece("TouchWith", 300, ("bottle", "bowl")),
        Piece("MoveObjTo", 500, ("bottle", "table"), features=PLACED),
    )
    tipped = Posture("bottle", 90, round(1000 * POURING_RAD) + 200, 0)
    still = Posture("bottle", round(100 * upright_s) - 5, round(1000 * POURING_RAD) + 100, 0)
    facts = (
        Posture("bottle", 0, 0, 0),
        tipped,
        *([still] if still.frame > 200 else []),
        Posture("bottle", round(100 * upright_s) + 5, 100, 0),
        Touching("bottle", "table", 495, 500),
    )
    made = observation(
        "Poured",
        {"right_hand": pieces},
        (BOTTLE, BOWL, TABLE),
        facts=facts,
        frames=501,
        rate_hz=100.0,
    )
    (link,) = made.links
    own = tuple(replace(each, possessed=True) for each in link.segments)
    return replace(made, links=(replace(link, segments=own),))


@pytest.mark.parametrize(
    ("upright_s", "told"),
    [
        (2.05, "poured from it into the bowl (1.00–2.00 s)"),
        (2.85, "poured from it into the bowl (1.00–2.80 s)"),
        (4.05, "poured from it into the bowl (1.00–4.00 s)"),
    ],
)
def test_pouring_lasts_while_the_vessel_is_tipped(upright_s: float, told: str) -> None:
    text = describe(seen(upright_s), timed=True)
    assert told in text
    after_s = max(upright_s - 0.05, 3.0)
    assert f" on the table ({after_s:.2f}–5.00 s)" in text
    assert ("held" in text) == (after_s == 3.0)
