"""Scenes in which a thing is pushed, pulled, slid, turned or rolled, up to what is in its way."""

import numpy as np

from scenes.hands import shapes
from scenes.hands.paths import about, min_jerk
from scenes.hands.scene import performer
from scenes.hands.scenes_two_hands import both_leave
from scenes.hands.stage import Stage
from scenes.household import builders
from scenes.household.builders import scene, tin_box
from scenes.household.scenes_covers import narrow
from scenes.objects import forms
from scenes.objects.builders import (
    NEAR,
    RIGHTWARD,
    UP,
    Grip,
    floor,
    home_again,
    seize,
    travel,
    wall,
)


@scene
def crate_pushed_to_the_wall_by_both(s: Stage) -> None:
    """Both palms push a wide crate away until it meets the wall, and stay on it."""
    performer(s, height=0.79, yaw_deg=22, size=1.05)
    s.table()
    behind = wall(s, 1.0)
    box = s.put("crate", forms.open_box(0.24, 0.5, 0.16, "crate"), (0.56, 0.0))
    hands = [s.right(), s.left()]
    for hand, aside in zip(hands, (-0.14, 0.14), strict=True):
        hand.idle(0.2)
        hand.reach(box, "-x", 0.9, fingers=UP, aside=(0.0, aside, 0.0))
        hand.hold(0.5, box)
    right, left = hands
    since = len(right.steps)
    left.join(box)
    right.take(box)
    travel(right, "Push", (0.3202, 0.0, 0.0), 1.5, box, behind)
    right.hold(0.8, box, behind)
    left.part(right, since)


@scene
def tin_pushed_sideways_to_a_partition(s: Stage) -> None:
    """The left palm pushes a tin to the right until it meets a low partition, and goes home."""
    performer(s, height=0.7, yaw_deg=-99)
    s.table()
    board = s.put("partition", shapes.box(0.4, 0.02, 0.1, "partition"), (0.55, -0.25), tag="fixed")
    tin = tin_box(s, (0.52, 0.15), "tin", (0.12, 0.1, 0.13))
    left = s.left()
    left.idle(0.2)
    left.reach(tin, "+y", 0.9, up=0.55)
    left.hold(0.3, tin)
    left.take(tin)
    travel(left, "Push", (0.0, -0.3402, 0.0), 1.2, tin, board)
    left.hold(0.4, tin, board)
    home_again(left, 0.9)


@scene
def box_pushed_slowly_until_it_meets_a_pot(s: Stage) -> None:
    """A box is pushed slowly over the table until it touches a pot, which stays in its place."""
    performer(s, height=0.83, yaw_deg=147, size=0.96, agent="old_man")
    s.table()
    pot = s.put("pot", forms.pot(0.12, 0.16), (0.88, -0.05))
    box = tin_box(s, (0.5, -0.05), "box", (0.14, 0.18, 0.15))
    right = s.right()
    right.idle(0.2)
    right.reach(box, "-x", 1.2, fingers=UP)
    right.take(box)
    travel(right, "Push", (0.88 - 0.12 - 0.07 - 0.5 + 0.0003, 0.0, 0.0), 2.6, box, pot)
    right.hold(0.8, box, pot)
    home_again(right, 1.2)


@scene
def chair_pulled_over_the_floor(s: Stage) -> None:
    """Both hands take the uprights of a chair's back and draw it near over the floor."""
    performer(s, height=0.8, yaw_deg=-43, size=1.02)
    ground = floor(s)
    seat = [shapes.block((0.02, -0.2, 0.4), (0.4, 0.2, 0.44))]
    legs = [
        shapes.block((x, y, 0.0), (x + 0.04, y + 0.04, 0.4))
        for x in (0.02, 0.36)
        for y in (-0.2, 0.16)
    ]
    back = [shapes.block((0.0, y - 0.004, 0.42), (0.06, y + 0.004, 0.95)) for y in (-0.15, 0.15)]
    rail = [shapes.block((0.03, -0.2, 0.5), (0.05, 0.2, 0.62))]
    chair = s.put("chair", shapes.Form("chair", (*seat, *legs, *back, *rail)), (0.55, 0.0, 0.0))
    hands = [s.right(narrow()), s.left(narrow())]
    for hand, y in zip(hands, (-0.15, 0.15), strict=True):
        hand.idle(0.2)
        seize(hand, chair, Grip((0.0, y, 0.8), NEAR, RIGHTWARD), 0.9, hold=0.4, take=False)
    right, left = hands
    since = len(right.steps)
    left.join(chair)
    right.take(chair)
    travel(right, "Pull", (-0.25, 0.0, 0.0), 1.3, chair, ground)
    right.hold(0.5, chair, ground)
    left.part(right, since)
    both_leave(hands, 0.9)


@scene
def pot_with_a_lid_turned(s: Stage) -> None:
    """The right palm on a pot's side turns it by fifty degrees; its lid turns along."""
    performer(s, height=0.76, yaw_deg=85)
    table = s.table()
    pot = s.put("pot", forms.pot(0.1, 0.14), (0.52, -0.05))
    lid = s.put("lid", forms.round_lid(0.103), (0.52, -0.05, s.height + 0.14))
    right = s.right()
    right.idle(0.2)
    right.reach(pot, "-y", 0.9, up=0.5)
    right.hold(0.4, pot)
    right.take(pot, lid)
    right.spin((0.52, -0.05, 0.0), UP, 50.0, 1.4)
    right.step("Turn", pot, table)
    right.hold(0.6, pot, table)


@scene
def plate_slid_in_two_goes(s: Stage) -> None:
    """A palm slides a plate to the left, stops for a second, and slides it ahead."""
    performer(s, height=0.87, yaw_deg=-167, size=1.07, agent="tall_man")
    table = s.table()
    plate = s.put("plate", shapes.Form("plate", (shapes.disc(0.12, 0.0, 0.025),)), (0.5, -0.2))
    right = s.right()
    right.idle(0.2)
    right.reach(plate, "+z", 0.9, up=1.0)
    right.hold(0.3, plate)
    right.take(plate)
    travel(right, "Slide", (0.02, 0.28, 0.0), 1.0, plate, table)
    right.hold(1.0, plate, table)
    travel(right, "Slide", (0.24, 0.0, 0.0), 0.9, plate, table)
    right.hold(0.4, plate, table)
    home_again(right, 0.9)


@scene
def tray_pulled_off_the_wall_and_pushed_back(s: Stage) -> None:
    """A tray is drawn away from the wall by its handle, held, and pushed back until it meets it."""
    performer(s, height=0.72, yaw_deg=38, size=0.98)
    table = s.table()
    behind = wall(s, 0.98)
    parts = forms.open_box(0.26, 0.3, 0.1, "tray").parts
    handle = shapes.block((-0.13 - forms.HANDLE_M, -0.004, 0.02), (-0.13, 0.004, 0.09))
    tray = s.put("tray", shapes.Form("tray", (*parts, handle)), (0.85 - 0.0002, 0.08))
    left = s.left(narrow())
    left.idle(0.2)
    grip = Grip((-0.13 - forms.HANDLE_M, 0.0, 0.06), NEAR, RIGHTWARD)
    seize(left, tray, grip, 1.0, hold=0.4)
    travel(left, "Pull", (-0.24, 0.0, 0.0), 1.0, tray, table)
    left.hold(0.8, tray, table)
    travel(left, "Push", (0.2402, 0.0, 0.0), 1.1, tray, behind)
    left.hold(0.6, tray, behind)


@scene
def bucket_pushed_over_the_floor_at_once(s: Stage) -> None:
    """A palm meets a bucket on the floor and pushes it ahead at once; a jar rides in it."""
    performer(s, height=0.4, yaw_deg=109, size=1.04)
    ground = floor(s)
    pail = s.put("bucket", forms.open_box(0.24, 0.24, 0.34, "bucket"), (0.5, -0.1, 0.0))
    tin = builders.jar(s, (0.52, -0.08, 0.008), height=0.2)
    right = s.right()
    right.idle(0.15)
    right.reach(pail, "-x", 0.8, up=0.75, fingers=UP)
    right.take(pail, tin)
    travel(right, "Push", (0.4, 0.0, 0.0), 1.0, pail, ground)
    right.hold(0.6, pail, ground)
    home_again(right, 0.9)


@scene
def tube_rolled_near(s: Stage) -> None:
    """A tube that lies across the table rolls near under the left palm, which goes twice as far."""
    performer(s, height=0.73, yaw_deg=-146, size=1.02)
    radius, far, duration = 0.065, 0.09, 1.0
    table = s.table()
    lying = shapes.disc(radius, -0.12, 0.12, 96).copy()
    lying.apply_transform([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    tube = s.put("tube", shapes.Form("tube", (lying,)), (0.65, 0.15, s.height + radius))
    left = s.left()
    left.idle(0.2)
    left.reach(tube, "+z", 0.9, up=1.0, along=-0.05)
    left.hold(0.4, tube)
    base, start = tube.body.at(left.clock), left.clock

    def rolled(since: np.ndarray) -> np.ndarray:
        way = -far * min_jerk(since / duration)
        out = about(base[:3, 3], (0.0, 1.0, 0.0), way / radius) @ base
        out[:, 0, 3] += way
        return out

    tube.body.play(start, start + duration, rolled)
    tube.free.append((start, start + duration))
    left.move((-2.0 * far, 0.0, 0.0), duration)
    left.step("Roll", tube, table)
    left.hold(0.7, tube, table)


@scene
def hand_goes_along_above_a_box_that_the_other_pulls(s: Stage) -> None:
    """The left hand pulls a box near; the right hand goes along over it and never touches it."""
    performer(s, height=0.77, yaw_deg=-14)
    table = s.table()
    box = s.put("box", shapes.drawer_box(0.16, 0.24, 0.14), (0.82, 0.05))
    left, right = s.left(narrow()), s.right(home=(0.72, -0.05, s.height + 0.26))
    left.idle(0.2)
    seize(left, box, Grip((-0.08 - 0.06, 0.0, 0.084), NEAR, RIGHTWARD), 0.9, hold=0.4)
    right.rest(left.clock)
    travel(left, "Pull", (-0.26, 0.0, 0.0), 1.2, box, table)
    right.go((0.46, -0.05, s.height + 0.26), 1.2)
    left.hold(0.6, box, table)
    right.rest(left.clock - right.clock)
