"""Scenes in which somebody walks, with empty hands or with a thing in them."""

from scenes.hands import shapes
from scenes.hands.scene import performer
from scenes.people.body import Person
from scenes.people.handling import hold_between, mug, set_down, take_up, together
from scenes.people.person import person
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


@scene
def reach_while_arriving(s: PeopleStage) -> None:
    """The left hand goes for a box without any halt where the walk ends."""
    performer(s, yaw_deg=-125)
    p = person(s, at=(-1.3, -0.2), size=1.05)
    s.desk((0.62, 0.0, 0.8))
    box = s.put("box", shapes.box(0.12, 0.12, 0.12), (0.5, 0.0, 0.8))
    p.stand(0.2)
    p.walk(1.3, speed=1.1, first="left", busy=(p.left,))
    p.along(p.left, 0.2, p.clock)
    p.left.reach(box, "+y", 0.8)
    p.left.hold(0.9, box)
    p.until(p.left)
    p.finish(p.clock)


@scene
def carry_a_mug_to_another_table(s: PeopleStage) -> None:
    """A mug is lifted off one table, carried two metres, and put down on another one."""
    performer(s, yaw_deg=80, offset=(0.4, -0.2))
    p = person(s, at=(-0.9, 0.0))
    s.desk((-0.6, -0.62, 0.74), (0.6, 0.6), "first_table")
    goal = s.desk((1.4, -0.62, 0.74), (0.6, 0.6), "second_table")
    cup = mug(s, (-0.55, -0.42, 0.74))
    p.right.idle(0.2)
    take_up(p.right, cup, "+y", lift=0.25, up=0.85)
    p.until(p.right)
    p.walk(2.0, speed=0.9)
    p.right.hold(0.5, cup)
    set_down(p.right, cup, goal, 0.25)
    p.right.idle(0.2)
    p.until(p.right)
    p.finish(p.clock)


@scene
def carry_a_box_to_a_table(s: PeopleStage) -> None:
    """A large box that both hands hold is carried to a table and put down on it."""
    performer(s, yaw_deg=-20)
    p = person(s, at=(-1.4, 0.0), size=1.06)
    table = s.desk((0.65, 0.0, 0.72))
    box = s.put("box", shapes.box(0.24, 0.3, 0.2), (-0.95, 0.0, 0.92))
    hold_between(p, box)
    p.stand(0.8)
    p.walk(1.45, speed=0.8)
    for hand in (p.right, p.left):
        hand.hold(0.6, box)
    together(p, box, table, down=0.2, hold=0.5)
    p.until(p.right)


@scene
def carry_a_tray_with_a_cup(s: PeopleStage) -> None:
    """A child carries a tray with a cup on it three steps ahead and keeps it."""
    performer(s, yaw_deg=200)
    p = person(s, at=(-0.6, 0.2), size=0.78)
    tray = s.put("tray", shapes.tray(0.24, 0.32), (-0.3, 0.2, 0.78))
    cup = s.put("cup", shapes.vessel(0.035, 0.08, "cup"), (-0.28, 0.22, 0.788))
    hold_between(p, tray)
    p.right.take_along(tray, cup)
    p.stand(0.9)
    p.walk(0.95, speed=0.6, first="left")
    p.stand(0.9)
    p.finish(p.clock)


@scene
def walk_backwards(s: PeopleStage) -> None:
    """Somebody walks a metre and a half backwards."""
    performer(s, yaw_deg=-160)
    p = person(s, hang=True, at=(0.8, 0.0), size=0.95)
    stroll(s, p, -1.5, before=0.8, after=0.8, speed=0.7, first="left")


@scene
def walk_there_and_back(s: PeopleStage) -> None:
    """Somebody walks ahead, stands for a second, and walks backwards to the first place."""
    performer(s, yaw_deg=115)
    p = person(s, hang=True, at=(-0.7, 0.4))
    p.stand(0.7)
    p.walk(1.3, speed=0.9)
    p.stand(1.2)
    p.walk(-1.3, speed=0.7, first="left")
    p.stand(0.8)
    p.finish(p.clock)


@scene
def take_a_ball_and_walk_off_with_it(s: PeopleStage) -> None:
    """A ball is lifted off a table with the left hand and carried backwards away from it."""
    performer(s, yaw_deg=60)
    p = person(s, at=(0.1, 0.0), size=0.92)
    s.desk((0.7, 0.0, 0.7))
    ball = s.put("ball", shapes.ball(0.06), (0.55, 0.12, 0.76))
    p.left.idle(0.2)
    take_up(p.left, ball, "+y", lift=0.2, up=0.5)
    p.until(p.left)
    p.walk(-1.1, speed=0.6)
    p.left.hold(0.7, ball)
    p.until(p.left)
    p.finish(p.clock)


@scene
def put_a_bottle_down_and_walk_off(s: PeopleStage) -> None:
    """A bottle is put down on a table; hand and body go away from it at once, backwards."""
    performer(s, yaw_deg=10)
    p = person(s, at=(0.1, 0.0))
    table = s.desk((0.65, 0.0, 0.78))
    bottle = s.put("bottle", shapes.bottle(), (0.5, -0.15, 0.98))
    p.right.begin_at(bottle, "-y", up=0.35, fingers=(1.0, 0.0, 0.0))
    p.right.take(bottle)
    p.right.hold(0.7, bottle)
    p.right.move((0.0, 0.0, -0.2), 0.9)
    p.right.step("Lower", bottle, table)
    p.right.hold(0.5, bottle, table)
    p.right.leave(0.8, name="ResumePosture")
    p.until(p.right)
    p.stand(0.8)
    p.walk(-1.2, speed=0.8)
    p.stand(0.7)
    p.finish(p.clock)
