"""Right and left exchanged: what is called right lies left of where the head looks."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture, Sensor
from capar.model.notices import Notice, notice
from extractors.bodies.poses import rotation_matrices
from extractors.thresholds import Thresholds

UP = np.array([0.0, 0.0, 1.0])


def side_notices(capture: Capture, thresholds: Thresholds) -> Iterator[Notice]:
    """A notice for each person whose pairs of right and left are exchanged nearly always.

    It may be the names, the declared direction of sight, or a world that is a mirror image.
    """
    for head in capture.sensors:
        if head.end_effector != "head":
            continue
        votes = [
            (right, left, _sides(head, right, left, thresholds))
            for right in capture.sensors
            if (left := _other(capture, head, right))
        ]
        exchanged = sum(int((sides < 0.0).sum()) for *_, sides in votes)
        shown = sum(len(sides) for *_, sides in votes)
        least = thresholds.shown_share * len(capture.times)
        if shown and shown >= least and exchanged >= thresholds.exchanged_share * shown:
            right, left, _ = max(votes, key=lambda vote: len(vote[2]))
            share = round(exchanged / shown, 3)
            yield notice("sides-exchanged", right.name, left.name, head.name, share=share)


def _other(capture: Capture, head: Sensor, right: Sensor) -> Sensor | None:
    """The left sensor of a right one's kind, of the person whose head it is."""
    agent = capture.agent_of(head)
    if right.side != "right" or capture.agent_of(right) != agent:
        return None
    alike = (
        each
        for each in capture.sensors
        if each.side == "left"
        and each.end_effector == right.end_effector
        and capture.agent_of(each) == agent
    )
    return next(alike, None)


def _sides(
    head: Sensor, right: Sensor, left: Sensor, thresholds: Thresholds
) -> Float[np.ndarray, "some"]:
    """How far the right one is on the right of the left one in the frames that show it [m]."""
    ahead = rotation_matrices(head.stream.orientations) @ np.asarray(head.gaze)
    rightward = np.cross(ahead / np.linalg.norm(head.gaze), UP)
    level = np.linalg.norm(rightward, axis=1)
    apart = right.stream.positions - left.stream.positions
    with np.errstate(invalid="ignore", divide="ignore"):
        aside = np.einsum("ij,ij->i", apart, rightward) / level
        wide = np.abs(aside) > thresholds.apart_share * np.linalg.norm(apart, axis=1)
        return np.asarray(aside[wide & (level > thresholds.level_gaze)])
