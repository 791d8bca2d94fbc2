"""Keeping arms, legs and trunk out of things, as a task of inverse kinematics."""

from collections.abc import Collection, Mapping

import mink
import numpy as np
from jaxtyping import Float

from capar.body.recording import HAND_SEGMENTS
from capar.regeneration.collisions import Surroundings
from capar.regeneration.solving import vectors

CLEAR_M = 0.001
"""How far the surface of a limb is kept from that of a thing [m]."""

HEAD = ("head", "right_eye", "left_eye")
HEAD_CLEAR_M = 0.015
"""Likewise the head, whose contacts are observed from 5 mm on [m]."""

CLEAR_COST = 100.0
"""Weight of a metre by which a limb is nearer [1/m]; two thirds of that of a palm's place."""


class ClearTask(mink.Task):
    """Pushes every part of the body but the hands, which have ways of their own, out of things.

    A part that is far enough from a thing adds nothing.
    """

    def __init__(self, around: Surroundings, met: Collection[str] = ()) -> None:
        """Watch all parts and things.

        Args:
            around: The body and the things.
            met: Things that the head meets, from which it is not kept away.
        """
        self.around = around
        self.pairs = [
            (geom, name)
            for geom, name in around.pairs()
            if not _is_hand(part := around.parts[geom]) and not (part in HEAD and name in met)
        ]
        self.clear_m = np.array(
            [HEAD_CLEAR_M if around.parts[geom] in HEAD else CLEAR_M for geom, _ in self.pairs]
        )
        geoms = [(geom, around.geoms[name]) for geom, name in self.pairs]
        self.geoms = np.array(geoms, dtype=int).reshape(-1, 2)
        self.reaches = around.model.geom_rbound[self.geoms].sum(axis=1)
        super().__init__(cost=np.full(len(self.pairs), CLEAR_COST))
        self.things = {name: vectors(thing.pose) for name, thing in around.scene.things.items()}
        self.active = True
        """Whether anything is pushed at all."""

        self.measured: np.ndarray | None = None
        self.gaps = np.full(len(self.pairs), np.inf)
        self.slopes = np.zeros((len(self.pairs), self.around.model.nv))

    def place(self, things: Mapping[str, Float[np.ndarray, "7"]]) -> None:
        """Take where things are from now on, as ``vectors`` has it; others stay."""
        self.things |= things
        self.measured = None

    def compute_error(self, configuration: mink.Configuration) -> Float[np.ndarray, "rows"]:
        """How much nearer each part is to a thing than it may be, negative [m]."""
        self._measure(configuration)
        short = np.minimum(self.gaps - self.clear_m, 0.0)
        return short if self.active else np.zeros(len(short))

    def compute_jacobian(
        self, configuration: mink.Configuration
    ) -> Float[np.ndarray, "pairs dofs"]:
        """How the distances of those that are too near change with the joints."""
        self._measure(configuration)
        self.slopes[:] = 0.0
        for row in np.flatnonzero(self.gaps < self.clear_m) if self.active else ():
            self.slopes[row] = self.around.slope(*self.pairs[row])
        return self.slopes

    def _measure(self, configuration: mink.Configuration) -> None:
        known = self.measured is not None and np.array_equal(self.measured, configuration.q)
        if known or not self.active:
            return
        self.measured = np.array(configuration.q)
        self.around.place(self.measured, self.things)
        middles = self.around.data.geom_xpos[self.geoms]
        apart = np.linalg.norm(middles[:, 0] - middles[:, 1], axis=1) - self.reaches
        self.gaps[:] = np.inf
        for row in np.flatnonzero(apart < HEAD_CLEAR_M):
            self.gaps[row] = self.around.gap(*self.pairs[row], HEAD_CLEAR_M)


def _is_hand(part: str) -> bool:
    return part.partition("_")[2] in (*HAND_SEGMENTS, "thumb")
