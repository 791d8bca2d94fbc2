"""Scenes of virtual performers who stand at a table; hands, feet, head and back are tracked."""

from dataclasses import replace

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
from scenes.hands.scene import performer
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage
from scenes.people.virtual import Figure, performing, stature

HOLD_S = 0.6
"""How long hands hold a thing before they let go [s]."""


def slab(depth: float = 0.6, width: float = 1.2) -> shapes.Form:
    """A table's top, standing on its origin."""
    return shapes.box(depth, width, 0.03, "table")


def at_table(
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
    f = at_table(s, who, script, "crate", crate, 0.24, aside)
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


@scene
def man_lays_a_hand_on_a_crate(s: PeopleStage) -> None:
    """A man lays his right hand on a crate for a second."""
    performer(s, yaw_deg=20)
    touched(s, "man", "right", seconds=1.0, aside=0.02)


@scene
def child_lays_the_left_hand_on_a_crate(s: PeopleStage) -> None:
    """A child lays the left hand on a crate, slowly."""
    performer(s, yaw_deg=-130)
    touched(s, "child", "left", seconds=0.7, aside=0.0, pace=0.8)


@scene
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


@scene
def woman_carries_a_mug(s: PeopleStage) -> None:
    """A woman lifts a mug, carries it to the left, and puts it down, with a stop at each corner."""
    performer(s, yaw_deg=-40)
    way = Move((0.0, 0.2, 0.0))
    script = moved_about(
        "mug", "right", (("up", 0.9, LIFT), ("on", 1.0, way), ("down", 0.9, LOWER))
    )
    f = at_table(s, "woman", script, "mug", shapes.vessel(0.036, 0.1), 0.22, -0.12)
    told(f, "right", "mug", STACKED)


@scene
def child_carries_a_mug_with_the_left_hand(s: PeopleStage) -> None:
    """A child lifts a mug with the left hand, carries it to the right, and puts it down."""
    performer(s, yaw_deg=110)
    way = Move((0.02, -0.15, 0.0))
    script = moved_about("mug", "left", (("up", 0.9, LIFT), ("on", 1.0, way), ("down", 1.0, LOWER)))
    f = at_table(s, "child", script, "mug", shapes.vessel(0.032, 0.09), 0.22, 0.12)
    told(f, "left", "mug", STACKED)


@scene
def man_lifts_a_mug_and_puts_it_back(s: PeopleStage) -> None:
    """A man lifts a mug straight up and lowers it at once."""
    performer(s, yaw_deg=-175)
    script = moved_about("mug", "right", (("up", 0.9, LIFT), ("down", 0.9, LOWER)))
    f = at_table(s, "man", script, "mug", shapes.vessel(0.038, 0.1), 0.23, -0.12)
    told(f, "right", "mug", (("Lift", ("mug",)), ("Lower", ("mug", "table"))))


def lifted(s: PeopleStage, who: str, *, height: float, pace: float, ahead: float) -> None:
    """A crate is lifted between both palms, held, and put back."""
    script = at_pace(lift_with_both_hands("crate", height=height), pace)
    crate = shapes.box(0.2, 0.24, 0.16, "crate")
    f = at_table(s, who, script, "crate", crate, ahead, 0.0)
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


@scene
def man_lifts_a_crate(s: PeopleStage) -> None:
    """A man lifts a crate with both hands, holds it and puts it back."""
    performer(s, yaw_deg=5)
    lifted(s, "man", height=0.25, pace=0.9, ahead=0.25)


@scene
def child_lifts_a_crate(s: PeopleStage) -> None:
    """A child lifts a crate with both hands, more slowly and less high."""
    performer(s, yaw_deg=-80)
    lifted(s, "child", height=0.16, pace=0.75, ahead=0.26)


@scene
def woman_lifts_a_crate(s: PeopleStage) -> None:
    """A woman lifts a crate with both hands faster than the others, and puts it back."""
    performer(s, yaw_deg=140)
    lifted(s, "woman", height=0.22, pace=1.1, ahead=0.25)


@scene
def woman_pushes_a_mug_aside(s: PeopleStage) -> None:
    """A woman pushes a mug over the table to the left with her right palm."""
    performer(s, yaw_deg=-15)
    script = moved_about("mug", "right", (("push", 1.1, Move((0.0, 0.14, 0.0))),))
    f = at_table(s, "woman", script, "mug", shapes.vessel(0.036, 0.1), 0.22, -0.14)
    told(f, "right", "mug", (("Push", ("mug", "table")),))


@scene
def man_lifts_a_jar_with_the_left_hand(s: PeopleStage) -> None:
    """A man lifts a jar with his left hand, holds it up, and puts it back."""
    performer(s, yaw_deg=60)
    script = moved_about(
        "jar", "left", (("up", 0.8, LIFT), ("stay", 0.8, Move()), ("down", 0.9, LOWER))
    )
    f = at_table(s, "man", script, "jar", shapes.vessel(0.034, 0.11, "jar"), 0.24, 0.12)
    told(f, "left", "jar", (("Lift", ("jar",)), ("Touch", ("jar",)), ("Lower", ("jar", "table"))))


@scene
def child_pushes_a_mug_aside(s: PeopleStage) -> None:
    """A child pushes a mug over the table to the right with the left palm."""
    performer(s, yaw_deg=85)
    script = moved_about("mug", "left", (("push", 1.2, Move((0.0, -0.1, 0.0))),))
    f = at_table(s, "child", script, "mug", shapes.vessel(0.033, 0.09), 0.22, 0.12)
    told(f, "left", "mug", (("Push", ("mug", "table")),))
