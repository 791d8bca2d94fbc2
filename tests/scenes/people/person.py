"""Somebody who stands on the floor of a stage, with hands, feet, head and lower back tracked."""

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model.capture import TagType
from scenes.hands import shapes
from scenes.hands.paths import Body, Vector, facing, pose
from scenes.hands.stage import Watcher
from scenes.hands.things import Thing
from scenes.people.body import TALL_M, Person, foot_place
from scenes.people.limbs import Chest, Limb, Rider, foot_form
from scenes.people.stage import PeopleStage


def person(
    stage: PeopleStage,
    name: str = "",
    *,
    at: Vector = (0.0, 0.0),
    facing_deg: float = 0.0,
    size: float = 1.0,
    hands: tuple[str, ...] = ("right", "left"),
    feet: tuple[str, ...] = ("right", "left"),
    form: shapes.Form | None = None,
    hang: bool = False,
    ground: Thing | None = None,
) -> Person:
    """Somebody who stands at a place; hands before the body at elbow height, or hanging down.

    Args:
        stage: Where.
        name: Of the person; limbs are called after it if there are several.
        at: Place on the floor [m].
        facing_deg: Which way the body faces.
        size: Relative to an adult of middle stature.
        hands: The hands that are tracked.
        feet: The feet that are tracked.
        form: Of the hands, where they are not flat.
        hang: Whether hands hang at the sides.
        ground: What the feet stand on, if not the floor.
    """
    prefix = f"{name}_" if name else ""
    agent = name or "agent"
    stage.people[agent] = round(TALL_M * size, 3)
    ground = ground or stage.floor
    level = ground.site("+z", 1.0, 0.0)[0][2]
    turn = Rotation.from_euler("z", facing_deg, degrees=True)
    trunk = Body(f"{prefix}trunk", pose((*at, level), turn))
    chest = Chest(f"{prefix}chest", trunk.first, trunk=trunk, hip_m=0.52 * TALL_M * size)
    ball = shapes.ball(0.1 * size, "head")
    place = pose((0.02 * size, 0.0, 0.93 * TALL_M * size))
    head = Thing(Rider(f"{prefix}head", place, carrier=chest), ball, TagType.SELF)
    back = Rider(f"{prefix}l5", pose((-0.1 * size, 0.0, 0.57 * TALL_M * size)), carrier=trunk)
    stage.things.append(head)
    stage.watchers.append(Watcher(head.body, "head", agent, ball))
    stage.watchers.append(Watcher(back, "l5", agent))
    made = Person(stage, agent, size, trunk, chest, head)
    for side in hands:
        made.local[side] = _at_home(side, size, hang=hang)
        shape = (form or shapes.flat_hand(side)).scaled(size)
        home = trunk.first @ made.local[side]
        body = Body(f"{prefix}{side}_hand", home)
        made.hands[side] = Limb(body, side, shape, home, member="hand", agent=agent)
    for side in feet:
        spot = trunk.first @ foot_place(side, size)
        body = Body(f"{prefix}{side}_foot", spot)
        made.feet[side] = Limb(body, side, foot_form(size), spot, member="foot", agent=agent)
        made.feet[side].meet(ground)
    stage.hands.extend([*made.hands.values(), *made.feet.values()])
    return made


def _at_home(side: str, size: float, *, hang: bool) -> np.ndarray:
    sign = -1.0 if side == "right" else 1.0
    inward = (0.0, -sign, 0.0)
    if hang:
        return pose((0.02, sign * 0.3 * size, 0.76 * size), facing(inward, (0.0, 0.0, -1.0)))
    return pose((0.18 * size, sign * 0.27 * size, 1.0 * size), facing(inward, (1.0, 0.0, 0.0)))
