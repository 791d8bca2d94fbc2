"""Scenes of virtual bodies that turn their hinges; the feet decide where the rest goes."""

from scenes.hands.scene import performer
from scenes.people.hinges import Bend, Sway, both, moved
from scenes.people.registry import scene
from scenes.people.stage import PeopleStage
from scenes.people.virtual import Figure


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


@scene
def man_waves(s: PeopleStage) -> None:
    """A man raises his right hand and waves four times."""
    performer(s, yaw_deg=-25)
    waves(s, "man", "right", rate_hz=1.6, cycles=4, angle=22.0)


@scene
def child_waves_with_the_left_hand(s: PeopleStage) -> None:
    """A child waves five times, quickly, with the left hand."""
    performer(s, yaw_deg=95)
    waves(s, "child", "left", rate_hz=2.2, cycles=5, angle=20.0)


@scene
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


@scene
def woman_points_ahead(s: PeopleStage) -> None:
    """A woman stretches her right arm out ahead, and holds it for more than a second."""
    performer(s, yaw_deg=35)
    points(s, "woman", "right", aside=0.0, held=1.3)


@scene
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


@scene
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


@scene
def child_dips_and_stays_low(s: PeopleStage) -> None:
    """A child bends the knees a little and stays so."""
    performer(s, yaw_deg=-45)
    f = moved(s, "child", 3.4, crouch(1.0, 2.0, 30.0))
    for side in ("right", "left"):
        says(f, side, (1.0, "Rest"), (2.0, "PostureChange"), (3.4, "Rest"))


@scene
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


@scene
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


@scene
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


@scene
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


@scene
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


@scene
def child_lifts_its_arms_ahead(s: PeopleStage) -> None:
    """A child lifts both arms ahead and up, and keeps them there."""
    performer(s, yaw_deg=-30)
    f = moved(s, "child", 3.6, both("shoulder_flexion", 0.8, 1.9, 125.0))
    for side in ("right", "left"):
        says(f, side, (0.8, "Rest"), (1.9, "PostureChange"), (3.6, "Rest"))


@scene
def man_dips_and_rises_at_once(s: PeopleStage) -> None:
    """A man bends his knees and stretches them again without a halt between."""
    performer(s, yaw_deg=175)
    f = moved(s, "man", 4.0, [*crouch(0.9, 1.8, 35.0), *crouch(1.8, 2.8, -35.0)])
    for side in ("right", "left"):
        says(f, side, (0.9, "Rest"), (2.8, "PostureChange"), (4.0, "Rest"))
