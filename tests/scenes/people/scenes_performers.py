"""Virtual performers, joints that turn, gestures about oneself, and pairs of people."""

from dataclasses import replace

import numpy as np

from capar.body.scripts import (
    STAND,
    Hand,
    Move,
    Phase,
    Script,
    at_pace,
    lift_with_both_hands,
    touch,
)
from scenes.hands import shapes
from scenes.hands.paths import facing, pose
from scenes.hands.performer import PRESS, travel
from scenes.hands.scene import performer
from scenes.hands.things import Thing
from scenes.people.body import START_S, Person, mug, person, set_down, take_up
from scenes.people.stage import PeopleStage, smooth
from scenes.people.virtual import Bend, Figure, Sway, both, moved, performing, stature

HOLD_S = 0.6
"""How long hands hold a thing before they let go [s]."""


def slab(depth: float = 0.6, width: float = 1.2) -> shapes.Form:
    """A table's top, standing on its origin."""
    return shapes.box(depth, width, 0.03, "table")


def performing_at_table(
    s: PeopleStage, who: str, script: Script, name: str, form: shapes.Form,
    ahead: float, aside: float, *, top: float = 0.52, around: bool = False,
) -> Figure:  # fmt: skip
    """Somebody at a table on which one thing stands; places are shares of the stature."""
    tall = stature(who)
    high = top * tall
    return performing(
        s, who, script, slab(), (0.13 * tall + 0.3, 0.0, high - 0.03),
        (name, form, (ahead * tall, aside * tall, high), around),
    )  # fmt: skip


def touched(s: PeopleStage, who: str, side: str, *, seconds: float, aside: float, pace: float = 1.0
            ) -> None:  # fmt: skip
    """A hand is laid on a crate, and goes back."""
    script = at_pace(touch("crate", side=side, seconds=seconds), pace)
    crate = shapes.box(0.15, 0.2, 0.15, "crate")
    f = performing_at_table(s, who, script, "crate", crate, 0.24, aside)
    f.does(
        side,
        (0, "Rest", ()),
        (1, "Reach", ("crate",)),
        (2, "Touch", ("crate",)),
        (3, "ResumePosture", ("crate",)),
        (4, "Rest", ()),
    )
    f.holds(side, "crate", 2, 2)
    f.rests("left" if side == "right" else "right")


def man_lays_a_hand_on_a_crate(s: PeopleStage) -> None:
    """A man lays his right hand on a crate for a second."""
    performer(s, yaw_deg=20)
    touched(s, "man", "right", seconds=1.0, aside=0.02)


def child_lays_the_left_hand_on_a_crate(s: PeopleStage) -> None:
    """A child lays the left hand on a crate, slowly."""
    performer(s, yaw_deg=-130)
    touched(s, "child", "left", seconds=0.7, aside=0.0, pace=0.8)


def woman_touches_a_crate_for_a_moment(s: PeopleStage) -> None:
    """A woman lays her right hand on a crate for two seconds."""
    performer(s, yaw_deg=75)
    touched(s, "woman", "right", seconds=2.0, aside=-0.04, pace=1.1)


def moved_about(name: str, side: str, moves: tuple[tuple[str, float, Move], ...]) -> Script:
    """Take a thing with one hand, move it so, hold it, and let go."""
    own = {side: Hand("holds", name)}
    return (
        STAND,
        Phase("reach", 1.1, {side: Hand("reaches", name)}, look=name),
        Phase("grasp", 0.4, own, look=name),
        *(Phase(title, seconds, own, {name: move}, look=name) for title, seconds, move in moves),
        Phase("hold", HOLD_S, own, look=name),
        Phase("return", 1.1, look="ahead"),
        replace(STAND, seconds=0.8),
    )


def told(f: Figure, side: str, name: str, names: tuple[tuple[str, tuple[str, ...]], ...]) -> None:
    """The steps of such a script, with the other hand at rest."""
    count = len(names)
    f.does(
        side,
        (0, "Rest", ()),
        (1, "Reach", (name,)),
        (2, "Touch", (name,)),
        *((3 + k, title, things) for k, (title, things) in enumerate(names)),
        (3 + count, "TouchWith", (name, "table")),
        (4 + count, "ResumePosture", (name,)),
        (5 + count, "Rest", ()),
    )
    f.holds(side, name, 2, 3 + count)
    f.rests("left" if side == "right" else "right")


LIFT, LOWER = Move((0.0, 0.0, 0.2)), Move((0.0, 0.0, -0.2))
STACKED = ("Lift", ("mug",)), ("Carry", ("mug",)), ("Lower", ("mug", "table"))


def woman_carries_a_mug(s: PeopleStage) -> None:
    """A woman lifts a mug, carries it to the left, and puts it down, with a stop at each corner."""
    performer(s, yaw_deg=-40)
    way = Move((0.0, 0.2, 0.0))
    script = moved_about(
        "mug", "right", (("up", 0.9, LIFT), ("on", 1.0, way), ("down", 0.9, LOWER))
    )
    f = performing_at_table(s, "woman", script, "mug", shapes.vessel(0.036, 0.1), 0.22, -0.12)
    told(f, "right", "mug", STACKED)


def child_carries_a_mug_with_the_left_hand(s: PeopleStage) -> None:
    """A child lifts a mug with the left hand, carries it to the right, and puts it down."""
    performer(s, yaw_deg=110)
    way = Move((0.02, -0.15, 0.0))
    script = moved_about("mug", "left", (("up", 0.9, LIFT), ("on", 1.0, way), ("down", 1.0, LOWER)))
    f = performing_at_table(s, "child", script, "mug", shapes.vessel(0.032, 0.09), 0.22, 0.12)
    told(f, "left", "mug", STACKED)


def man_lifts_a_mug_and_puts_it_back(s: PeopleStage) -> None:
    """A man lifts a mug straight up and lowers it at once."""
    performer(s, yaw_deg=-175)
    script = moved_about("mug", "right", (("up", 0.9, LIFT), ("down", 0.9, LOWER)))
    f = performing_at_table(s, "man", script, "mug", shapes.vessel(0.038, 0.1), 0.23, -0.12)
    told(f, "right", "mug", (("Lift", ("mug",)), ("Lower", ("mug", "table"))))


def lifted(s: PeopleStage, who: str, *, height: float, pace: float, ahead: float) -> None:
    """A crate is lifted between both palms, held, and put back."""
    script = at_pace(lift_with_both_hands("crate", height=height), pace)
    crate = shapes.box(0.2, 0.24, 0.16, "crate")
    f = performing_at_table(s, who, script, "crate", crate, ahead, 0.0)
    for side in ("right", "left"):
        f.does(
            side,
            (0, "Rest", ()),
            (1, "Reach", ("crate",)),
            (2, "Touch", ("crate",)),
            (3, "Lift", ("crate",)),
            (4, "Touch", ("crate",)),
            (5, "Lower", ("crate", "table")),
            (6, "TouchWith", ("crate", "table")),
            (7, "ResumePosture", ("crate",)),
            (8, "Rest", ()),
        )
        f.holds(side, "crate", 2, 6)


def man_lifts_a_crate(s: PeopleStage) -> None:
    """A man lifts a crate with both hands, holds it and puts it back."""
    performer(s, yaw_deg=5)
    lifted(s, "man", height=0.25, pace=0.9, ahead=0.25)


def child_lifts_a_crate(s: PeopleStage) -> None:
    """A child lifts a crate with both hands, more slowly and less high."""
    performer(s, yaw_deg=-80)
    lifted(s, "child", height=0.16, pace=0.75, ahead=0.26)


def woman_lifts_a_crate(s: PeopleStage) -> None:
    """A woman lifts a crate with both hands faster than the others, and puts it back."""
    performer(s, yaw_deg=140)
    lifted(s, "woman", height=0.22, pace=1.1, ahead=0.25)


def woman_pushes_a_mug_aside(s: PeopleStage) -> None:
    """A woman pushes a mug over the table to the left with her right palm."""
    performer(s, yaw_deg=-15)
    script = moved_about("mug", "right", (("push", 1.1, Move((0.0, 0.14, 0.0))),))
    f = performing_at_table(s, "woman", script, "mug", shapes.vessel(0.036, 0.1), 0.22, -0.14)
    told(f, "right", "mug", (("Push", ("mug", "table")),))


def man_lifts_a_jar_with_the_left_hand(s: PeopleStage) -> None:
    """A man lifts a jar with his left hand, holds it up, and puts it back."""
    performer(s, yaw_deg=60)
    script = moved_about(
        "jar", "left", (("up", 0.8, LIFT), ("stay", 0.8, Move()), ("down", 0.9, LOWER))
    )
    f = performing_at_table(s, "man", script, "jar", shapes.vessel(0.034, 0.11, "jar"), 0.24, 0.12)
    told(f, "left", "jar", (("Lift", ("jar",)), ("Touch", ("jar",)), ("Lower", ("jar", "table"))))


def child_pushes_a_mug_aside(s: PeopleStage) -> None:
    """A child pushes a mug over the table to the right with the left palm."""
    performer(s, yaw_deg=85)
    script = moved_about("mug", "left", (("push", 1.2, Move((0.0, -0.1, 0.0))),))
    f = performing_at_table(s, "child", script, "mug", shapes.vessel(0.033, 0.09), 0.22, 0.12)
    told(f, "left", "mug", (("Push", ("mug", "table")),))


def says(f: Figure, side: str, *steps: tuple[float, str]) -> None:
    """What a hand does without touching anything: until when [s], and the step's name."""
    hand = f.hands[side]
    for end, name in steps:
        hand.clock = end
        hand.step(name)


def raising(side: str, start: float, end: float, elbow: float = 95.0) -> list[Bend | Sway]:
    """An arm goes up beside the head, the forearm upright, or comes down again."""
    angles = {"shoulder_abduction": 70.0, "shoulder_rotation": -76.0, "elbow_flexion": elbow}
    return [Bend(f"{side}_{joint}", start, end, angle) for joint, angle in angles.items()]


def back(acts: list[Bend | Sway], start: float, end: float) -> list[Bend | Sway]:
    """The same turns the other way round, later."""
    return [Bend(each.joint, start, end, -each.angle) for each in acts if isinstance(each, Bend)]


def waves(
    s: PeopleStage, who: str, side: str, *, rate_hz: float, cycles: int, angle: float
) -> None:
    """An arm goes up, waves, and comes down."""
    up = raising(side, 0.8, 1.8)
    swing = Sway(f"{side}_elbow_flexion", 1.8, rate_hz, cycles, angle)
    end = swing.end
    f = moved(s, who, end + 1.8, [*up, swing, *back(up, end, end + 1.0)])
    says(
        f,
        side,
        (0.8, "Rest"),
        (1.8, "PostureChange"),
        (end, "Wave"),
        (end + 1.0, "PostureChange"),
        (end + 1.8, "Rest"),
    )
    f.rests("left" if side == "right" else "right")


def man_waves(s: PeopleStage) -> None:
    """A man raises his right hand and waves four times."""
    performer(s, yaw_deg=-25)
    waves(s, "man", "right", rate_hz=1.6, cycles=4, angle=22.0)


def child_waves_with_the_left_hand(s: PeopleStage) -> None:
    """A child waves five times, quickly, with the left hand."""
    performer(s, yaw_deg=95)
    waves(s, "child", "left", rate_hz=2.2, cycles=5, angle=20.0)


def woman_waves_slowly(s: PeopleStage) -> None:
    """A woman waves three times, with a wide swing and slowly."""
    performer(s, yaw_deg=-150)
    waves(s, "woman", "right", rate_hz=1.1, cycles=3, angle=25.0)


def points(s: PeopleStage, who: str, side: str, *, aside: float, held: float) -> None:
    """An arm is stretched out level, held so, and taken back."""
    up: list[Bend | Sway] = [
        Bend(f"{side}_shoulder_flexion", 0.7, 1.6, 82.0),
        Bend(f"{side}_shoulder_abduction", 0.7, 1.6, aside),
        Bend(f"{side}_elbow_flexion", 0.7, 1.6, -8.0),
    ]
    end = 1.6 + held
    f = moved(s, who, end + 1.8, [*up, *back(up, end, end + 1.0)])
    says(
        f,
        side,
        (0.7, "Rest"),
        (1.6, "PostureChange"),
        (end, "Point"),
        (end + 1.0, "PostureChange"),
        (end + 1.8, "Rest"),
    )
    f.hands[side].aliases["Point"] = "Rest"
    f.rests("left" if side == "right" else "right")


def woman_points_ahead(s: PeopleStage) -> None:
    """A woman stretches her right arm out ahead, and holds it for more than a second."""
    performer(s, yaw_deg=35)
    points(s, "woman", "right", aside=0.0, held=1.3)


def man_points_aside(s: PeopleStage) -> None:
    """A man points ahead and to the left with his left arm for two seconds."""
    performer(s, yaw_deg=-100)
    points(s, "man", "left", aside=25.0, held=2.0)


def crouch(start: float, end: float, deep: float) -> list[Bend | Sway]:
    """Both legs bend so that the soles keep the floor, or stretch again if below zero."""
    return [
        *both("hip_flexion", start, end, deep),
        *both("knee_flexion", start, end, 1.6 * deep),
        *both("ankle_dorsiflexion", start, end, 0.6 * deep),
    ]


def woman_crouches(s: PeopleStage) -> None:
    """A woman bends her knees, stays low for a second, and stands up; her hands go with her."""
    performer(s, yaw_deg=160)
    f = moved(s, "woman", 5.6, [*crouch(0.8, 2.0, 45.0), *crouch(3.2, 4.6, -45.0)])
    for side in ("right", "left"):
        says(
            f,
            side,
            (0.8, "Rest"),
            (2.0, "PostureChange"),
            (3.2, "Rest"),
            (4.6, "PostureChange"),
            (5.6, "Rest"),
        )


def child_dips_and_stays_low(s: PeopleStage) -> None:
    """A child bends the knees a little and stays so."""
    performer(s, yaw_deg=-45)
    f = moved(s, "child", 3.4, crouch(1.0, 2.0, 30.0))
    for side in ("right", "left"):
        says(f, side, (1.0, "Rest"), (2.0, "PostureChange"), (3.4, "Rest"))


def man_bows(s: PeopleStage) -> None:
    """A man bends his back forward, stays so, and comes up again; his hands hang and go along."""
    performer(s, yaw_deg=70)
    spine = {"lumbar_lower": 15.0, "lumbar_upper": 18.0, "thorax_lower": 14.0, "thorax_upper": 8.0}
    down: list[Bend | Sway] = [
        Bend(f"{level}_flexion", 0.9, 2.0, angle) for level, angle in spine.items()
    ]
    down += both("shoulder_flexion", 0.9, 2.0, 50.0)
    f = moved(s, "man", 5.0, [*down, *back(down, 3.0, 4.2)])
    for side in ("right", "left"):
        says(
            f,
            side,
            (0.9, "Rest"),
            (2.0, "PostureChange"),
            (3.0, "Rest"),
            (4.2, "PostureChange"),
            (5.0, "Rest"),
        )


def man_spreads_his_arms(s: PeopleStage) -> None:
    """A man lifts both arms aside to the level of his shoulders, waits, and lets them sink."""
    performer(s, yaw_deg=-5)
    up: list[Bend | Sway] = list(both("shoulder_abduction", 0.7, 1.7, 70.0))
    f = moved(s, "man", 5.0, [*up, *back(up, 2.9, 4.1)])
    for side in ("right", "left"):
        says(
            f,
            side,
            (0.7, "Rest"),
            (1.7, "PostureChange"),
            (2.9, "Rest"),
            (4.1, "PostureChange"),
            (5.0, "Rest"),
        )


def child_looks_about(s: PeopleStage) -> None:
    """A child turns the head to the left and to the right; hands and feet stay where they are."""
    performer(s, yaw_deg=125)
    turns = [("neck_turn", 25.0), ("head_turn", 25.0)]
    acts = [
        Bend(joint, start, start + 0.8, share * angle)
        for joint, angle in turns
        for start, share in ((0.8, 1.0), (2.2, -2.0), (3.6, 1.0))
    ]
    f = moved(s, "child", 5.2, acts)
    f.rests("right", "left")


def woman_waves_with_both_hands(s: PeopleStage) -> None:
    """A woman raises both hands, waves four times with both at once, and lets them sink."""
    performer(s, yaw_deg=-115)
    up = [each for side in ("right", "left") for each in raising(side, 0.8, 1.9)]
    swings = [Sway(f"{side}_elbow_flexion", 1.9, 1.5, 4, 20.0) for side in ("right", "left")]
    end = swings[0].end
    f = moved(s, "woman", end + 2.0, [*up, *swings, *back(up, end, end + 1.1)])
    for side in ("right", "left"):
        says(
            f,
            side,
            (0.8, "Rest"),
            (1.9, "PostureChange"),
            (end, "Wave"),
            (end + 1.1, "PostureChange"),
            (end + 2.0, "Rest"),
        )


def man_turns_his_trunk(s: PeopleStage) -> None:
    """A man turns his upper body to the left with raised forearms, waits, and turns back."""
    performer(s, yaw_deg=10)
    turns = {"thorax_lower": 14.0, "thorax_upper": 16.0, "lumbar_upper": 5.0}
    aside: list[Bend | Sway] = [
        Bend(f"{level}_turn", 0.9, 1.8, angle) for level, angle in turns.items()
    ]
    f = moved(s, "man", 5.2, [*both("elbow_flexion", -1.0, -0.5, 75.0), *aside,
                              *back(aside, 3.0, 4.1)])  # fmt: skip
    for side in ("right", "left"):
        says(
            f,
            side,
            (0.9, "Rest"),
            (1.8, "PostureChange"),
            (3.0, "Rest"),
            (4.1, "PostureChange"),
            (5.2, "Rest"),
        )


def child_lifts_its_arms_ahead(s: PeopleStage) -> None:
    """A child lifts both arms ahead and up, and keeps them there."""
    performer(s, yaw_deg=-30)
    f = moved(s, "child", 3.6, both("shoulder_flexion", 0.8, 1.9, 125.0))
    for side in ("right", "left"):
        says(f, side, (0.8, "Rest"), (1.9, "PostureChange"), (3.6, "Rest"))


def man_dips_and_rises_at_once(s: PeopleStage) -> None:
    """A man bends his knees and stretches them again without a halt between."""
    performer(s, yaw_deg=175)
    f = moved(s, "man", 4.0, [*crouch(0.9, 1.8, 35.0), *crouch(1.8, 2.8, -35.0)])
    for side in ("right", "left"):
        says(f, side, (0.9, "Rest"), (2.8, "PostureChange"), (4.0, "Rest"))


APART_M = 0.16
"""Half the distance of the palms between two claps [m]."""


def ready(p: Person, ahead: float, high: float) -> None:
    """Both palms come up before the chest, facing each other, apart."""
    for sign, hand in ((-1.0, p.right), (1.0, p.left)):
        hand.idle(0.2)
        turned = facing((0.0, -sign, 0.0), (0.5, 0.0, 1.0))
        hand.fly(pose((ahead, sign * APART_M, high), turned), 0.9)
        hand.step("PostureChange")
        hand.rest(0.6)


def clap(p: Person, *, contact: float, claps: int, beat_s: float) -> None:
    """Palms meet so many times; between two claps they go apart and come back."""
    right, left = p.right, p.left
    for number in range(claps):
        if number:
            for sign, hand in ((-1.0, right), (1.0, left)):
                hand.move((0.0, sign * 0.1, 0.0), beat_s / 2.0, depart=0.3)
                hand.move((0.0, -sign * 0.1, 0.0), beat_s / 2.0, arrive=0.7)
        else:
            for sign, hand in ((-1.0, right), (1.0, left)):
                hand.move((0.0, -sign * (APART_M + PRESS / 2.0), 0.0), 0.4, arrive=0.7)
        right.meet_hand(left, right.clock, right.clock + contact)
        right.step("Clap", left)
        left.step("Clap", right)
        for hand in (right, left):
            hand.idle(contact)


def hands_home(p: Person) -> None:
    """Both hands leave each other and go home."""
    for hand, other in ((p.right, p.left), (p.left, p.right)):
        hand.fly(hand.home, 1.0, depart=0.3)
        hand.step("ResumePosture", other)
        hand.idle(0.2)


def clap_once(s: PeopleStage) -> None:
    """Somebody claps the hands once."""
    performer(s, yaw_deg=10)
    s.contact_minimum_s = 0.0
    p = person(s)
    ready(p, 0.35, 1.15)
    clap(p, contact=0.08, claps=1, beat_s=0.0)
    hands_home(p)


def clap_three_times(s: PeopleStage) -> None:
    """A child claps three times."""
    performer(s, yaw_deg=-85)
    s.contact_minimum_s = 0.0
    p = person(s, size=0.8)
    ready(p, 0.3, 0.92)
    clap(p, contact=0.06, claps=3, beat_s=0.6)
    hands_home(p)


def touch_the_other_hand(s: PeopleStage) -> None:
    """The right palm is laid on the back of the left hand, which stays where it is."""
    performer(s, yaw_deg=140)
    p = person(s)
    right, left = p.right, p.left
    back = left.now
    out = -back[:3, 0]
    depth = shapes.HAND_DEPTH
    place = back[:3, 3] + (depth - PRESS) * out
    goal = pose(place, facing(-out, (0.3, 0.0, -1.0)))
    right.rest(0.6)
    right.go_without_step((0.2, 0.5, 1.35), 0.9)
    right.fly(goal, 0.9, arrive=0.12)
    right.step("Reach", left)
    start = right.clock
    left.wait(start)
    right.clock += 0.9
    right.meet_hand(left, start, right.clock)
    right.step("TouchOneself", left)
    left.clock = right.clock
    left.step("TouchOneself", right)
    right.fly(pose((0.2, 0.5, 1.35), facing(-out, (0.3, 0.0, -1.0))), 0.8, depart=0.12)
    right.fly(right.home, 1.0)
    right.step("ResumePosture", left)
    right.idle(0.2)
    p.finish(right.clock)


def touch_the_own_head(s: PeopleStage) -> None:
    """The left hand is laid on the own forehead and taken away."""
    performer(s, yaw_deg=-20)
    p = person(s, size=1.03)
    left = p.left
    left.rest(0.7)
    left.reach(p.head, "+x", 1.1, fingers=(0.0, -1.0, 0.4))
    left.clock += 1.0
    left.step("TouchOneself", p.head)
    left.leave(1.1)
    left.rest(0.6)
    p.finish(left.clock)


def lean_on_a_table(s: PeopleStage) -> None:
    """Both hands are laid on a table while the upper body bends over it, and come back with it."""
    performer(s, yaw_deg=75)
    p = person(s)
    table = s.desk((0.6, 0.0, 0.75))
    p.stand(0.6)
    p.bend(20.0, 1.1)
    for sign, hand in ((-1.0, p.right), (1.0, p.left)):
        hand.rest(0.6)
        goal = pose((0.45, sign * 0.24, 0.75 - PRESS), facing((0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
        hand.fly(goal, 1.1, arrive=0.12)
        hand.meet(table)
        hand.step("Reach", table)
        hand.hold(1.6, table)
    p.until(p.right)
    p.bend(-20.0, 1.1)
    for hand in p.hands.values():
        hand.leave(1.1)
        hand.rest(0.6)


def hands_on_the_table_one_after_the_other(s: PeopleStage) -> None:
    """The left hand is laid on a table, then the right one, and the left one is taken away."""
    performer(s, yaw_deg=-145)
    p = person(s, size=0.93)
    table = s.desk((0.6, 0.0, 0.7))
    for sign, hand, start in ((1.0, p.left, 0.6), (-1.0, p.right, 2.4)):
        hand.wait(start)
        goal = pose((0.42, sign * 0.22, 0.7 - PRESS), facing((0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
        hand.fly(goal, 1.0, arrive=0.12)
        hand.meet(table)
        hand.step("Reach", table)
    p.left.hold(p.right.clock + 0.5 - p.left.clock, table)
    p.left.leave(1.0)
    p.left.idle(0.2)
    p.finish(p.left.clock)


def ends(*people: Person) -> None:
    """Everybody waits for whoever is last."""
    end = max(limb.clock for p in people for limb in (*p.hands.values(), *p.feet.values()))
    for each in people:
        each.finish(end)


def offered(giver: Person, taker: Person, thing: Thing, side: str, *, wait: float = 0.0) -> None:
    """The giver's right hand holds a thing still; the taker's right hand comes and takes it."""
    hand, other = giver.right, taker.right
    if wait:
        hand.hold(wait, thing)
    other.wait(hand.clock)
    begin = hand.clock
    ahead = taker.heading[:, 0]
    other.reach(thing, side, 1.0, fingers=ahead, name="Accept", when=begin)
    hand.hold(other.clock + 0.6 - hand.clock, thing)
    other.until(hand.clock)
    hand.leave(1.0, name="HandOver")
    hand.idle(0.2)
    other.hold(0.5, thing)
    other.take(thing)
    hand.aliases["HandOver"] = "Give"
    other.aliases["Accept"] = "Receive"


def face_to_face(s: PeopleStage, far: float, sizes: tuple[float, float]) -> tuple[Person, Person]:
    """Two people who look at each other."""
    anna = person(s, "anna", at=(-far / 2.0, 0.0), size=sizes[0])
    ben = person(s, "ben", at=(far / 2.0, 0.0), facing_deg=180.0, size=sizes[1])
    return anna, ben


def holding(s: PeopleStage, p: Person, name: str, form: shapes.Form, ahead: float) -> Thing:
    """A thing that somebody holds at its right side from the first frame on."""
    place = p.chest.at(0.0) @ pose((ahead, -0.15, 1.0 * p.size))
    thing = s.put(name, form, place[:3, 3])
    thing.body.first[:3, :3] = place[:3, :3]
    p.right.begin_at(thing, "-y", up=0.5, fingers=p.heading[:, 0])
    p.right.take(thing)
    return thing


def hand_a_ball_over(s: PeopleStage) -> None:
    """Anna holds a ball out to Ben, who takes it and keeps it."""
    performer(s, yaw_deg=20)
    anna, ben = face_to_face(s, 1.2, (1.0, 1.05))
    ball = holding(s, anna, "ball", shapes.ball(0.06), 0.4)
    anna.right.hold(0.8, ball)
    anna.right.move((0.15, 0.1, 0.0), 0.9)
    anna.right.step("Carry", ball)
    offered(anna, ben, ball, "+y", wait=0.5)
    ben.right.move((0.12, 0.0, 0.0), 0.8)
    ben.right.step("Carry", ball)
    ends(anna, ben)


def hand_a_box_over_to_a_child(s: PeopleStage) -> None:
    """A tall person holds a box; a child takes it, holds it for a second, and lifts it."""
    performer(s, yaw_deg=-110)
    anna, ben = face_to_face(s, 1.1, (1.04, 0.82))
    box = holding(s, anna, "box", shapes.box(0.12, 0.12, 0.12), 0.45)
    offered(anna, ben, box, "+y", wait=1.0)
    ben.right.move((0.0, 0.0, 0.12), 0.7)
    ben.right.step("Raise", box)
    ben.right.hold(0.6, box)
    ends(anna, ben)


def walk_up_and_take_what_is_offered(s: PeopleStage) -> None:
    """Ben walks up to Anna, stands, and takes the can that she holds out."""
    performer(s, yaw_deg=65)
    anna, ben = face_to_face(s, 2.4, (0.95, 1.0))
    can = holding(s, anna, "can", shapes.box(0.09, 0.09, 0.12, "can"), 0.5)
    ben.stand(0.7)
    ben.walk(1.25, speed=0.9)
    ben.right.rest(0.6)
    offered(anna, ben, can, "+y", wait=ben.right.clock)
    ends(anna, ben)


def bring_a_can_and_hand_it_over(s: PeopleStage) -> None:
    """Anna carries a can to Ben, who stands and waits, and gives it to him."""
    performer(s, yaw_deg=-30, offset=(0.3, 0.5))
    anna, ben = face_to_face(s, 2.6, (1.0, 0.92))
    can = holding(s, anna, "can", shapes.box(0.09, 0.09, 0.12, "can"), 0.5)
    anna.stand(0.8)
    anna.walk(1.4, speed=0.8, first="left")
    offered(anna, ben, can, "+y", wait=0.7)
    ends(anna, ben)


def one_works_and_one_watches(s: PeopleStage) -> None:
    """Anna lifts a mug and puts it back; Ben stands across the table and does nothing."""
    performer(s, yaw_deg=150)
    anna, ben = face_to_face(s, 1.7, (0.98, 1.02))
    table = s.desk((0.0, 0.0, 0.76), (0.7, 1.0))
    cup = mug(s, (-0.25, -0.1, 0.76))
    anna.right.rest(0.6)
    take_up(anna.right, cup, "-y", lift=0.2)
    set_down(anna.right, cup, table, 0.2)
    anna.right.idle(0.2)
    ends(anna, ben)


def one_walks_past_another(s: PeopleStage) -> None:
    """Anna walks past Ben, who stands aside."""
    performer(s, yaw_deg=-70)
    anna = person(s, "anna", at=(-1.2, 0.0), hang=True)
    ben = person(s, "ben", at=(0.0, 1.0), facing_deg=-90.0, hang=True, size=0.9)
    anna.stand(0.7)
    anna.walk(2.3, speed=1.2)
    anna.stand(0.7)
    anna.finish(anna.clock)
    ends(anna, ben)


def carry_a_board_together(s: PeopleStage) -> None:
    """Two people lift a board off two trestles, carry it six steps aside, and hold it."""
    performer(s, yaw_deg=35)
    board = s.put("board", shapes.box(1.2, 0.3, 0.06, "board"), (0.0, 0.0, 0.82))
    for name, x in (("first_trestle", -0.3), ("second_trestle", 0.3)):
        s.put(name, shapes.box(0.06, 0.5, 0.82, "trestle"), (x, 0.0, 0.0), tag="fixed")
    anna, ben = face_to_face(s, 1.95, (1.0, 1.0))
    hands = [anna.right, anna.left, ben.right, ben.left]
    for hand in hands:
        own = anna if hand in hands[:2] else ben
        hand.rest(0.6)
        side, aside = ("-x", 1.0) if own is anna else ("+x", -1.0)
        aside *= -0.1 if hand.side == "right" else 0.1
        hand.reach(board, side, 1.0, up=0.5, fingers=(0.0, 0.0, 1.0), aside=(0.0, aside, 0.0))
    latest = max(each.clock for each in hands)
    for hand in hands:
        hand.hold(latest + 0.5 - hand.clock, board)
    leader = hands[0]
    since = len(leader.steps)
    for hand in hands[1:]:
        hand.join(board)
    leader.take(board)
    travel(leader, "Lift", (0.0, 0.0, 0.12), 0.9, board, hold=0.6)
    far, begin = 0.6, leader.clock
    for p, way in ((anna, far), (ben, -far)):
        p.clock = begin
        p.sidle(way, 3, pace=0.55)
    span = anna.clock - begin
    leader.body.shift(begin, anna.clock, lambda since: np.outer(
        smooth(since / span, START_S / span), (0.0, far, 0.0)))  # fmt: skip
    leader.clock = anna.clock
    leader.step("Carry", board)
    leader.hold(0.8, board)
    for hand in hands[1:]:
        hand.part(leader, since)


def greet_by_a_clap_of_hands(s: PeopleStage) -> None:
    """Anna and Ben raise their right hands, clap them together, and take them down."""
    performer(s, yaw_deg=-160)
    s.hands_as_objects = True
    s.contact_minimum_s = 0.0
    anna, ben = face_to_face(s, 1.2, (1.0, 1.0))
    high = 1.35
    for p, sign in ((anna, 1.0), (ben, -1.0)):
        hand = p.right
        hand.idle(0.2)
        turned = facing((sign, 0.0, 0.0), (0.0, 0.0, 1.0))
        hand.fly(pose((-sign * 0.2, 0.0, high), turned), 0.9)
        hand.step("PostureChange")
        hand.rest(0.6)
        hand.move((sign * (0.2 + PRESS / 2.0), 0.0, 0.0), 0.4, arrive=1.0)
    a, b = anna.right, ben.right
    a.meet_hand(b, a.clock, a.clock + 0.06)
    for p, hand, other in ((anna, a, b), (ben, b, a)):
        hand.step("Clap", other)
        hand.idle(0.06)
        hand.fly(p.chest.at(0.0) @ p.local["right"], 1.0, depart=0.3)
        hand.step("ResumePosture", other)
        hand.idle(0.2)
        hand.aliases["Clap"] = "Hit"
    ends(anna, ben)
