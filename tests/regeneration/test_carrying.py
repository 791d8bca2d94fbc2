"""A held thing is lifted over what stands in its way, or it is refused where that is too high."""

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.virtual_scenes import Thing, box, cup, table
from capar.model.capture import TagType
from capar.regeneration import PlanError
from capar.regeneration.paths import LIFTS_M, Carrying
from capar.regeneration.scenes import Scene
from capar.regeneration.styles import STRAIGHT, Detour, Kind

HEIGHT_M = 0.8


def _way(wall_m: float, tag: TagType = TagType.FIXED) -> tuple[RigidTransform, Detour]:
    """A mug's way of 0.4 m to the left, lifted by 0.1 m, over a wall half-way."""
    mug = Thing("mug", cup(0.035, 0.09), (0.45, -0.2, HEIGHT_M), round=True)
    wall = Thing("wall", box(0.3, 0.02, wall_m), (0.45, 0.0, HEIGHT_M), tag=tag)
    things = {each.name: each for each in (table(HEIGHT_M), mug, wall)}
    carrying = Carrying(Human.of(ready_made("man")), Scene(things, (0.0, 0.0), 0.0), Kind.PATH)
    share = np.linspace(0.0, 1.0, 31)
    lift = 0.4 * share * (1.0 - share)
    spots = mug.pose.translation + np.stack([0.0 * share, 0.4 * share, lift], axis=1)
    part = RigidTransform.from_translation(spots)
    others = {name: thing.pose for name, thing in things.items() if name != "mug"}
    return carrying.way("mug", part, (part[0], part[-1]), others, 0.0)


def test_nothing_is_lifted_that_has_a_free_way() -> None:
    assert _way(0.02)[1] == STRAIGHT


@pytest.mark.parametrize("tag", [TagType.FIXED, TagType.MOBILE])
def test_a_thing_is_lifted_over_a_wall(tag: TagType) -> None:
    path, detour = _way(0.15, tag)
    assert detour.lift_m > 0.0
    over = np.argmin(np.abs(path.translation[:, 1]))
    assert path.translation[over, 2] > HEIGHT_M + 0.15


def test_a_wall_that_is_higher_than_any_lift_is_refused() -> None:
    with pytest.raises(PlanError, match=r"'mug' would go \d+ mm into 'wall' on its way"):
        _way(max(LIFTS_M) + 0.3)


def test_what_was_recorded_a_little_inside_its_support_is_raised_out_of_it() -> None:
    crate = Thing("crate", box(0.2, 0.2, 0.2), (0.45, 0.0, HEIGHT_M))
    things = {each.name: each for each in (table(HEIGHT_M), crate)}
    carrying = Carrying(Human.of(ready_made("man")), Scene(things, (0.0, 0.0), 0.0), Kind.PATH)
    share = np.linspace(0.0, 1.0, 61)
    sunk = np.interp(share, [0.0, 0.1, 0.2, 0.3, 1.0], [0.0, -0.003, -0.003, 0.0, 0.2])
    part = RigidTransform.from_translation(
        crate.pose.translation + np.stack([0.0 * share, 0.1 * share, sunk], axis=1)
    )
    still = {"table": things["table"].pose}
    path, detour = carrying.way("crate", part, (part[0], part[-1]), still, 0.0)
    assert detour == STRAIGHT
    low = path.translation[:, 2] - HEIGHT_M
    assert low.min() > -0.0002
    np.testing.assert_allclose(path.translation[[0, -1]], part.translation[[0, -1]], atol=1e-9)
    np.testing.assert_allclose(low[30:], sunk[30:], atol=1e-9)
