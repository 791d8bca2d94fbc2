"""Scenes in which somebody walks, with empty hands or with a thing in them."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.people.person import Person, person
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage


def stroll(s: PeopleStage, p: Person, way: float, *, before: float, after: float, speed: float,
           first: str = "right") -> None:  # fmt: skip
    """Stand, walk with empty hands, and stand."""
    p.stand(before)
    p.walk(way, speed=speed, first=first)
    p.stand(after)
    p.finish(p.clock)


@scene
def walk_across_the_room(s: PeopleStage) -> None:
    """Somebody stands, walks two and a half metres at an easy pace, and stands."""
    performer(s, yaw_deg=40)
    p = person(s, hang=True, at=(-1.2, 0.0))
    stroll(s, p, 2.5, before=0.8, after=0.9, speed=1.0)


@scene
def walk_slowly(s: PeopleStage) -> None:
    """A small old person walks at half a metre a second, the left foot first."""
    performer(s, yaw_deg=-70)
    p = person(s, hang=True, size=0.88, at=(-0.5, 0.3))
    stroll(s, p, 1.4, before=1.0, after=1.0, speed=0.5, first="left")


@scene
def walk_briskly(s: PeopleStage) -> None:
    """A tall person walks three metres fast."""
    performer(s, yaw_deg=155)
    p = person(s, hang=True, size=1.08, at=(-1.5, -0.2))
    stroll(s, p, 3.1, before=0.7, after=0.8, speed=1.35)


@scene
def walk_to_a_table_and_take_a_mug(s: PeopleStage) -> None:
    """Somebody walks up to a table, stands for a moment, and takes the mug that is there."""
    performer(s, yaw_deg=15)
    p = person(s, at=(-1.6, 0.1))
    s.desk((0.65, 0.0, 0.76))
    mug = s.put("mug", shapes.vessel(0.042, 0.1), (0.55, -0.1, 0.76))
    p.stand(0.7)
    p.walk(1.65, speed=0.9)
    right = p.right
    right.rest(0.7)
    right.reach(mug, "-y", 0.9, up=0.6)
    right.hold(0.4, mug)
    right.take(mug)
    right.move((0.0, 0.0, 0.22), 0.9)
    right.step("Lift", mug)
    right.hold(0.8, mug)
    p.until(right)
    p.finish(p.clock)
