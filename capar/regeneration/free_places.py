"""Where things of a scene have room: beside each other, and out of the way of a goal."""

from collections.abc import Iterator, Mapping

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from capar.body.human import Human
from capar.body.scenes import Thing
from capar.model.capture import TagType
from capar.regeneration.collisions import Surroundings
from capar.regeneration.scenes import Scene
from capar.regeneration.solving import Solver

ROOM_M = 0.01
"""Things that are nearer are in each other's way [m]."""

ASIDE_M = 0.06
"""So far from others a thing is put: a hand has room between them [m]."""

EDGE_M = 0.02
"""How far a thing that is put down stays from its support's edge [m]."""

STEP_M = 0.06
"""Of the grid on which places are sought [m]."""

ARM = 0.42
"""How far from where it stands a body puts things, as a share of its stature [1]."""

MOST = 8
"""Places that are offered on each support [1]."""

Spot = tuple[float, float, float]


class Room:
    """Distances between things of a scene, wherever they are put."""

    def __init__(self, human: Human, scene: Scene) -> None:
        self.human, self.scene = human, scene
        self.around = Surroundings(human, scene)
        self.rest = Solver(human, (*scene.place, scene.floor_m), scene.heading).rest

    def near(self, poses: Mapping[str, RigidTransform], within_m: float) -> set[frozenset[str]]:
        """The things that are nearer to each other than so much.

        Args:
            poses: Of things that are not where the scene has them.
            within_m: The distance [m].
        """
        usual = {name: thing.pose for name, thing in self.scene.things.items()}
        self.around.pose(self.rest, {**usual, **poses})
        pairs = self.around.things_near()
        return {frozenset((p.part, p.thing)) for p in pairs if p.distance_m < within_m}

    def meet(self, first: str, at: RigidTransform, second: str, there: RigidTransform) -> bool:
        """Whether there is no room for two things, each at a pose."""
        return frozenset((first, second)) in self.near({first: at, second: there}, ROOM_M)

    def places(
        self, name: str, support: str, keep_off: Mapping[str, RigidTransform]
    ) -> tuple[Spot, ...]:
        """Free places for a thing on another one within an arm's length, nearest first.

        Args:
            name: The thing.
            support: What it is put on.
            keep_off: Where other things will be that have to have room besides.
        """
        found: list[Spot] = []
        thing, tops = self.scene.thing(name), self.scene.thing(support)
        height = _top(tops) - float(_corners(thing)[0, 2] - thing.place[2])
        for x, y in sorted(self._grid(tops), key=lambda spot: self._far(thing, spot)):
            pose = RigidTransform.from_components([x, y, height], thing.pose.rotation)
            if _within(thing, pose, tops) and self._free(name, support, pose, keep_off):
                found.append((x, y, height))
            if len(found) == MOST:
                break
        return tuple(found)

    def _grid(self, support: Thing) -> Iterator[tuple[float, float]]:
        (low_x, low_y, _), (high_x, high_y, _) = _corners(support)
        for x in np.arange(low_x + 0.5 * STEP_M, high_x, STEP_M):
            for y in np.arange(low_y + 0.5 * STEP_M, high_y, STEP_M):
                away = np.hypot(x - self.scene.place[0], y - self.scene.place[1])
                if away <= ARM * self.human.measures["stature"]:
                    yield float(x), float(y)

    def _far(self, thing: Thing, spot: tuple[float, float]) -> float:
        return float(np.hypot(spot[0] - thing.place[0], spot[1] - thing.place[1]))

    def _free(
        self, name: str, support: str, pose: RigidTransform, keep_off: Mapping[str, RigidTransform]
    ) -> bool:
        others = {other: keep_off[other] for other in keep_off if other != name}
        for poses in ({name: pose}, {name: pose, **others}):
            near = self.near(poses, ASIDE_M)
            if any(name in pair and support not in pair for pair in near):
                return False
        return True


def standing_places(scene: Scene) -> tuple[str, ...]:
    """Fixed things on which others can be put, sorted."""
    return tuple(sorted(t.name for t in scene.things.values() if t.tag is TagType.FIXED))


def _corners(thing: Thing) -> Float[np.ndarray, "2 3"]:
    spots = thing.pose.apply(np.array(thing.shape.vertices))
    return np.stack([spots.min(axis=0), spots.max(axis=0)])


def _top(thing: Thing) -> float:
    return float(_corners(thing)[1, 2])


def _within(thing: Thing, pose: RigidTransform, support: Thing) -> bool:
    """Whether all of a thing is above its support."""
    spots = pose.apply(np.array(thing.shape.vertices))[:, :2]
    low, high = _corners(support)[:, :2]
    return bool((spots > low + EDGE_M).all() and (spots < high - EDGE_M).all())
