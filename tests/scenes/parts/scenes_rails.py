"""Drawers in trays, sliding lids, trolleys with doors, and some furniture that stands fast."""

from scenes.hands.paths import AHEAD, NEAR, RIGHTWARD, UP
from scenes.hands.performer import travel
from scenes.hands.scene import at_table, performer
from scenes.hands.scenes_place import claw
from scenes.hands.stage import Stage
from scenes.household.scenes_vessels import narrow
from scenes.objects.builders import Grip, floor, home_again, paused, seize
from scenes.parts import builders as parts
from scenes.parts.scenes_hinges import BELOW, steady, take_lid


def drawer_of_a_tray_opened_while_it_is_steadied(s: Stage) -> None:
    """The left palm lies at the side of a tray while the right hand draws its drawer out."""
    at_table(s, height=0.7, yaw_deg=36)
    pair = parts.tray(s, (0.62, 0.0))
    right, left = s.right(narrow()), s.left()
    right.rest(0.7)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 0.14, 0.9, hold=0.5)
    home_again(right, 0.9)
    steady(left, right, pair.base, 0.8, "+y")


def drawer_in_stages(s: Stage) -> None:
    """A drawer is drawn out by seven and by nine centimetres, and pushed in by six."""
    at_table(s, height=0.64, yaw_deg=-71, size=0.95, agent="old_woman")
    pair = parts.tray(s, (0.6, 0.06), deep=0.3).stated(closed=True)
    left = s.left(narrow(), idle=0.25)
    take_lid(left, pair, 1.1, 0.5)
    for out, hold in ((0.07, 0.6), (0.16, 1.0), (0.1, 0.5)):
        parts.work(left, pair, out, 0.9, hold=hold)
    home_again(left, 1.0)


def drawer_shut_and_tray_carried(s: Stage) -> None:
    """The right hand pushes a drawer in; then both palms carry the tray to the left."""
    table = at_table(s, height=0.68, yaw_deg=128)
    pair = parts.tray(s, (0.6, -0.15), start=0.13).stated()
    right, left = s.right(parts.fist()), s.left(parts.fist())
    right.idle(0.2)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 0.0, 0.8, hold=0.3)
    right.leave(0.9)
    right.idle(0.2)
    left.rest(right.clock)
    since = parts.both_palms(s, (right, left), pair.base, 1.0, 0.5)
    right.lift_carry_lower(pair.base, table, up=0.18, by=(0.0, 0.4), down=0.18)
    right.hold(0.4, pair.base, table)
    parts.both_off((right, left), since)


def tray_carried_open_and_shut_later(s: Stage) -> None:
    """Both palms carry a tray whose drawer stands out; then the left hand pushes the drawer in."""
    table = at_table(s, height=0.72, yaw_deg=-9, size=1.04)
    pair = parts.tray(s, (0.58, 0.2), start=0.1, wide=0.26).stated()
    right, left = s.right(parts.fist()), s.left(parts.fist())
    since = parts.both_palms(s, (right, left), pair.base, 1.0, 0.5)
    paused(right, pair.base, table, up=0.16, by=(0.08, -0.35), down=0.16, holds=(0.5, 0.4))
    right.hold(0.4, pair.base, table)
    parts.both_off((right, left), since)
    take_lid(left, pair)
    parts.work(left, pair, 0.0, 0.8, hold=0.5)
    right.rest(left.clock - right.clock)


def drawer_that_is_never_shut(s: Stage) -> None:
    """A drawer that stands out by six centimetres is drawn out further, and stays so."""
    at_table(s, height=0.63, yaw_deg=-140)
    pair = parts.tray(s, (0.66, -0.05), start=0.06, deep=0.32)
    right = s.right(narrow(), idle=0.2)
    take_lid(right, pair, 0.9, 0.4)
    parts.work(right, pair, 0.2, 1.0, "Slide", hold=0.7)
    home_again(right, 0.8)


def drawer_drawn_out_in_the_air(s: Stage) -> None:
    """The left palm carries a small tray near; in the air the right hand draws its drawer out."""
    at_table(s, height=0.65, yaw_deg=58, size=1.07)
    pair = parts.tray(s, (0.66, 0.22, s.height + 0.2), deep=0.2, wide=0.18)
    left, right = s.left(), s.right(narrow())
    parts.bear(left, pair, BELOW)
    left.hold(0.5, pair.base)
    travel(left, "Carry", (-0.08, -0.2, 0.0), 1.0, pair.base)
    right.rest(left.clock)
    take_lid(right, pair, 1.0, 0.3)
    parts.work(right, pair, 0.1, 0.8, hold=0.4)
    parts.work(right, pair, 0.0, 0.8, hold=0.3)
    home_again(right, 0.9)
    left.hold(right.clock - left.clock, pair.base)


def tray_pulled_by_its_drawer(s: Stage) -> None:
    """A shut drawer's handle is pulled, and the whole tray comes along over the table."""
    table = at_table(s, height=0.69, yaw_deg=-101)
    pair = parts.tray(s, (0.76, 0.1), deep=0.22).stated(closed=True)
    left = s.left(narrow(), idle=0.2)
    take_lid(left, pair, 0.9, 0.3)
    left.take(pair.base)
    travel(left, "Pull", (-0.18, 0.0, 0.0), 0.9, pair.base, table, hold=0.5)
    home_again(left, 0.9)


def pencil_case_slid_open(s: Stage) -> None:
    """The right palm lies at a case's end while the left hand slides the lid to the left."""
    at_table(s, height=0.74, yaw_deg=5)
    pair = parts.pencil_case(s, (0.52, 0.05))
    left, right = s.left(claw()), s.right()
    left.rest(0.8)
    take_lid(left, pair, 0.9, 0.3)
    parts.work(left, pair, 0.13, 0.9, hold=0.5)
    home_again(left, 0.9)
    steady(right, left, pair.base, 0.8, Grip((0.0, -0.15, 0.05), RIGHTWARD, AHEAD))


def pencil_case_slid_open_and_shut(s: Stage) -> None:
    """A lid is slid to the right by its knob, let go of, and slid back after a rest."""
    at_table(s, height=0.8, yaw_deg=-170, size=1.05)
    pair = parts.pencil_case(s, (0.5, 0.0), way=-1.0).stated(closed=True)
    right = s.right(claw(), idle=0.2)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 0.12, 0.8, hold=0.3)
    right.leave(0.9)
    right.rest(0.7)
    take_lid(right, pair, 0.9, 0.0)
    parts.work(right, pair, 0.0, 0.8, hold=0.5)


def bar() -> Grip:
    """The middle of a trolley's bar."""
    return Grip((0.0, 0.0, 0.25 + 0.4 + 0.012 + 0.09), NEAR, UP)


def trolley_door_opened(s: Stage) -> None:
    """The left fist lies on a trolley's bar while the right hand opens the door and shuts it."""
    performer(s, height=0.72, yaw_deg=24)
    floor(s)
    pair = parts.trolley(s, (0.72, 0.0, 0.0)).stated()
    right, left = s.right(narrow()), s.left(parts.fist())
    right.rest(0.9)
    take_lid(right, pair, 0.9, 0.3)
    parts.work(right, pair, 65.0, 1.3, hold=0.6)
    parts.work(right, pair, 0.0, 1.3, hold=0.3)
    home_again(right, 0.9)
    steady(left, right, pair.base, 1.0, Grip((0.0, 0.12, 0.752), NEAR, UP))


def trolley_pushed_with_its_door_open(s: Stage) -> None:
    """The left hand opens a trolley's door; then the right fist pushes the trolley by its bar."""
    performer(s, height=0.75, yaw_deg=-84, size=1.03)
    ground = floor(s)
    pair = parts.trolley(s, (0.7, 0.05, 0.0), way=-1.0)
    left, right = s.left(narrow()), s.right(parts.fist())
    left.idle(0.2)
    take_lid(left, pair, 1.0, 0.3)
    parts.work(left, pair, 80.0, 1.4, hold=0.3)
    left.leave(1.0)
    right.rest(left.clock)
    seize(right, pair.base, bar(), 1.0, hold=0.3)
    travel(right, "Push", (0.35, 0.0, 0.0), 1.5, pair.base, ground, hold=0.4)
    home_again(right, 1.0)
    left.rest(right.clock - left.clock)


def trolley_pushed_by_its_shut_door(s: Stage) -> None:
    """A palm on a trolley's shut door pushes the trolley away."""
    performer(s, height=0.7, yaw_deg=112)
    ground = floor(s)
    pair = parts.trolley(s, (0.6, -0.05, 0.0)).stated(closed=True)
    right = s.right(idle=0.2)
    seize(right, pair.part, pair.face, 0.9, hold=0.4, take=False)
    right.take(pair.base)
    travel(right, "Push", (0.3, 0.0, 0.0), 1.3, pair.base, ground, hold=0.5)
    home_again(right, 0.9)


def fixed_chest_opened(s: Stage) -> None:
    """The lid of a chest that stands fast is turned up by its lip and held."""
    at_table(s, height=0.45, yaw_deg=63)
    pair = parts.box(s, (0.62, 0.0), deep=0.3, wide=0.4, high=0.22, name="chest", tag="fixed")
    left = s.left(narrow(), idle=0.2)
    take_lid(left, pair, 1.0, 0.3)
    parts.work(left, pair, 70.0, 1.3, hold=0.9)
