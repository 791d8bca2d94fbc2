"""Where a free hand reaches that touches nothing: up, forward and down, to the left, and back.

Directions are the person's own, as both hands hang or rest when the recording begins.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from capar.model.locations import SampledTrack
from capar.model.observation import Observation, ObservedLink
from kb.language.thresholds import (
    ALONG_SHARE,
    APEX_M,
    ASIDE_SHARE,
    LEANT_M,
    REACHED_M,
    REST_S,
    STANDING_M,
    STILL_M,
    SWAYING,
    UNSEEN_S,
)

HAND, HEAD = "hand", "head"


@dataclass(frozen=True)
class Reached:
    """One hand's way to a place in the air, and back."""

    ee: str
    where: str
    """In words: ``forward and up``."""

    start_s: float
    there_s: float
    """When it is as far as it gets."""

    leaves_s: float
    end_s: float
    back: bool
    """Whether it comes back."""

    down: bool
    """Whether it comes back downward."""

    leans: bool
    """Whether the person leans there with the head."""


def reaches(
    observation: Observation, moved: Mapping[str, tuple[float, float]]
) -> tuple[Reached, ...]:
    """Where hands reach from rest that move freely; empty where that cannot be told.

    Args:
        observation: What was understood of a capture.
        moved: From when to when each end-effector moved [s].
    """
    tracks = {each.body: each for each in observation.tracks if each.step_s > 0.0}
    hands = [link for link in observation.links if link.kind == HAND and link.ee in tracks]
    ahead = _ahead(hands, tracks)
    head = next((tracks[body] for body in tracks if body == HEAD), None)
    free = [
        link.ee
        for link in hands
        if link.ee in moved and moved[link.ee][0] > link.segments[0].start_s
    ]
    if not free:
        return ()
    middle = np.mean([tracks[link.ee].positions[0] for link in hands], axis=0)
    ways = (_reached(ee, tracks[ee], moved[ee], ahead, middle, head) for ee in free)
    found = [each for each in ways if each is not None]
    furthest_m = max((way for _, way in found), default=0.0)
    return tuple(each for each, way in found if way >= SWAYING * furthest_m)


def _ahead(
    hands: Sequence[ObservedLink], tracks: Mapping[str, SampledTrack]
) -> Float[np.ndarray, "3"] | None:
    """The level direction in which the person looks at first; None without both hands."""
    sides = {link.side: tracks[link.ee].positions[0] for link in hands}
    if not {"left", "right"} <= set(sides):
        return None
    right = (sides["right"] - sides["left"]) * (1.0, 1.0, 0.0)
    length = float(np.linalg.norm(right))
    if not length > 0.0:
        return None
    return np.cross((0.0, 0.0, 1.0), right / length)


def _reached(
    ee: str,
    track: SampledTrack,
    span: tuple[float, float],
    ahead: Float[np.ndarray, "3"] | None,
    middle: Float[np.ndarray, "3"],
    head: SampledTrack | None,
) -> tuple[Reached, float] | None:
    """Where one hand gets that moves in that time, and how far [m]; None where it gets nowhere."""
    first, last = (round(each / track.step_s) for each in span)
    places = track.positions[first : last + 1]
    if len(places) < 2 or np.isnan(places).any():
        return None
    ways = np.linalg.norm(places - places[0], axis=1)
    furthest_m = float(ways.max())
    furthest = places[int(ways.argmax())]
    where = _direction(furthest - places[0], furthest - middle, ahead)
    if furthest_m < REACHED_M or not where:
        return None
    apex = first + int(ways.argmax())
    if head is not None:
        above = track.positions[apex, 2] > head.positions[min(apex, len(head.positions) - 1), 2]
        where += " above the head" if above else ""
    there = np.flatnonzero(ways > furthest_m - STILL_M)
    home = _stops(places, max(round(UNSEEN_S / track.step_s), 1))
    returns = places[-1] - places[int(there[-1])]
    down = -float(returns[2]) > ASIDE_SHARE * float(np.linalg.norm(returns))
    home = min(home, _arrives(places, int(there[-1]), np.array([0.0, 0.0, -1.0]))) if down else home
    found = Reached(
        ee=ee,
        where=where,
        start_s=span[0],
        there_s=(first + int(there[0])) * track.step_s,
        leaves_s=(first + int(there[-1])) * track.step_s,
        end_s=(first + max(home, int(there[-1]))) * track.step_s,
        back=float(ways[-1]) < 0.5 * furthest_m,
        down=down,
        leans=head is not None and _leans(head, first, apex, furthest - places[0]),
    )
    return found, furthest_m


def _arrives(places: Float[np.ndarray, "frames 3"], since: int, way: Float[np.ndarray, "3"]) -> int:
    """The frame since another one at which it is as far along a direction as it gets."""
    along = (places[since:] - places[since]) @ way
    return since + int(np.argmax(along > float(along.max()) - STILL_M))


def _leans(head: SampledTrack, first: int, apex: int, way: Float[np.ndarray, "3"]) -> bool:
    """Whether the head goes down and with the hand, as that reaches from a frame to another.

    Args:
        head: Where the head is.
        first: The frame since which the hand reaches.
        apex: The frame at which it is as far as it gets.
        way: Its way until then [m].
    """
    places = head.positions[
        [min(first, len(head.positions) - 1), min(apex, len(head.positions) - 1)]
    ]
    gone = places[1] - places[0]
    level_m, along = float(np.linalg.norm(gone[:2])), float(gone[:2] @ way[:2])
    with_it = along > ALONG_SHARE * level_m * float(np.linalg.norm(way[:2]))
    return level_m > LEANT_M and -float(gone[2]) > STANDING_M and with_it


def _stops(places: Float[np.ndarray, "frames 3"], brief: int) -> int:
    """The frame since which a hand is near to where it stays, and as slow as one at rest.

    Args:
        places: Where it is [m].
        brief: In how many frames its speed is measured.
    """
    away = np.linalg.norm(places - places[-1], axis=1) > APEX_M
    home = int(np.flatnonzero(away)[-1]) + 1 if away.any() else 0
    gone = np.linalg.norm(places[home + brief :] - places[home : len(places) - brief], axis=1)
    still = np.flatnonzero(gone < STILL_M * UNSEEN_S / REST_S)
    return home + int(still[0]) if len(still) else len(places) - 1


def _direction(
    way: Float[np.ndarray, "3"],
    place: Float[np.ndarray, "3"],
    ahead: Float[np.ndarray, "3"] | None,
) -> str:
    """A way in words of the person; empty where it goes aside and it is not known where that is.

    Args:
        way: How far the hand goes [m].
        place: Where it gets to, from the middle between both hands at rest [m].
        ahead: The direction in which the person looks.
    """
    unit = way / np.linalg.norm(way)
    upward = ["up" if unit[2] > 0.0 else "down"] if abs(unit[2]) > ASIDE_SHARE else []
    far = float(np.linalg.norm(unit[:2])) > ASIDE_SHARE
    level = {} if ahead is None or not far else _level(place, ahead)
    aside = [max(level, key=level.__getitem__)] if upward and level else list(level)
    return " and ".join([" ".join(aside), *upward] if aside else upward)


def _level(place: Float[np.ndarray, "3"], ahead: Float[np.ndarray, "3"]) -> dict[str, float]:
    """Where a place is around the person, in at most two words, with how far it is that way [m]."""
    on, left = float(place @ ahead), float(place @ np.cross((0.0, 0.0, 1.0), ahead))
    words = {
        "forward" if on > 0.0 else "backward": abs(on),
        "to the left" if left > 0.0 else "to the right": abs(left),
    }
    least_m = ASIDE_SHARE * float(np.hypot(on, left))
    return {word: way_m for word, way_m in words.items() if way_m > least_m}
