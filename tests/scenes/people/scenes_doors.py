"""Scenes in which somebody opens a gate, a drawer or a cupboard on the way."""

from scenes.hands import shapes
from scenes.hands.paths import pose
from scenes.hands.scene import performer
from scenes.household.builders import gate
from scenes.objects.builders import NEAR, UP, Grip, Hinge, cabinet, cupboard, seize, travel
from scenes.people.person import person
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage


@scene
def push_a_gate_open_on_the_way(s: PeopleStage) -> None:
    """Somebody walks up to a gate, pushes it open while walking on, and walks through."""
    performer(s, yaw_deg=30)
    p = person(s, at=(-1.5, 0.58))
    door = gate(s, (0.0, 0.0, 0.0), width=0.95)
    p.stand(0.7)
    p.walk(1.1, speed=0.8)
    right = p.right
    right.rest(0.6)
    face = Grip((-0.008, 0.42, 0.95), NEAR, UP)
    seize(right, door.leaf, face, 0.9, hold=0.4)
    p.until(right)
    p.walk(0.6, speed=0.5, busy=(right,))
    swing = Hinge(door.hinge.point, door.hinge.axis, -1.0)
    swing.turn(right, 80.0, p.clock - right.clock)
    right.step("Open", door.leaf, door.body)
    right.hold(0.5, door.leaf, door.body)
    right.leave(1.0)
    right.rest(0.6)
    p.until(right)
    p.walk(1.1, speed=0.9, first="left", swing_rad=0.1)
    p.stand(0.7)
    p.finish(p.clock)


@scene
def open_a_drawer_by_a_step_back(s: PeopleStage) -> None:
    """A drawer is pulled open while the right foot steps back."""
    performer(s, yaw_deg=-95)
    p = person(s, form=shapes.gripping_hand(0.04, 0.04), hands=("right",))
    s.desk((0.8, -0.1, 0.85), (0.5, 0.6), "dresser_top")
    chest = cabinet(s, (0.6, -0.1, 0.95))
    s.put("leg", shapes.box(0.3, 0.3, 0.088, "block"), (0.78, -0.1, 0.85), tag="fixed")
    right = p.right
    right.rest(0.6)
    seize(right, chest.drawer, chest.grip, 0.9, hold=0.5)
    begin = right.clock
    travel(right, "Open", (-0.2, 0.0, 0.0), 1.0, chest.drawer, chest.body)
    right.hold(0.6, chest.drawer, chest.body)
    back = p.trunk.at(0.0) @ pose((-0.3, 0.0, 0.0))
    p.stride("right", back, begin + 0.1, begin + 0.75)
    p.clock = begin
    p.shift((-0.15, 0.0, 0.0), 1.0)
    right.home = p.chest.at(p.clock) @ p.local["right"]
    right.leave(0.9)
    right.rest(0.6)


@scene
def open_a_cupboard_after_a_walk(s: PeopleStage) -> None:
    """Somebody walks up to a cupboard, opens its door, and leaves it open."""
    performer(s, yaw_deg=170)
    p = person(s, at=(-1.4, 0.0), form=shapes.gripping_hand(0.04, 0.04), hands=("left",))
    s.desk((0.9, 0.0, 0.9), (0.6, 0.8))
    cup = cupboard(s, (0.75, 0.0, 0.912), side="right")
    p.stand(0.7)
    p.walk(1.45, speed=1.0, first="left")
    left = p.left
    left.rest(0.6)
    seize(left, cup.leaf, cup.grip, 0.9, hold=0.4)
    cup.hinge.turn(left, 55.0, 1.3)
    left.step("Open", cup.leaf, cup.body)
    left.hold(0.5, cup.leaf, cup.body)
    left.leave(0.9)
    left.rest(0.6)
