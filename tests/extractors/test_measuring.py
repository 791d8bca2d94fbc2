"""A capture's facts: the same however it is turned, named, or cut into windows."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import motions
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measured_bodies import ball, box, eased, hand, pick_and_place, still, stream
from motion_files import recordings_folder
from scipy.spatial.transform import Rotation
from windows import compared, repeated

from capar.model.calibration import Calibration
from capar.model.capture import (
    Agent,
    Capture,
    PivotContact,
    Purpose,
    Role,
    Sensor,
    ShapeSource,
    TagObject,
    TagType,
)
from capar.model.errors import CaptureError, UnknownNameError
from capar.model.facts import (
    MEASURED,
    Fact,
    Gap,
    Intended,
    LookingAt,
    Moving,
    OfAgent,
    Pause,
    Touching,
    ZeroCrossing,
)
from capar.model.json_form import to_json, value_from_json
from capar.model.locations import ConstraintLocation
from capar.model.observation import Segment
from capar.model.par import FeatureSet
from extractors.calibration import calibrate
from extractors.measure import Measurements, measure
from extractors.readers.bundle.capture_toml import read_capture
from extractors.segments import STEPS, constraint_location, path_style, velocity_style
from extractors.thresholds import Thresholds


def of_kind(capture: Capture, kind: type[Fact]) -> list[Fact]:
    return [each for each in measure(capture).facts if type(each) is kind]


def pairs(capture: Capture) -> list[tuple[str, str]]:
    return [(each.body, each.other) for each in of_kind(capture, Touching)]  # type: ignore[attr-defined]


@given(st.sampled_from([30.0, 60.0, 100.0, 240.0]), st.floats(0.0, 0.003), st.integers(0, 1000))
@settings(max_examples=12, deadline=None)
def test_picking_and_placing_is_measured_alike_at_any_rate_and_noise(
    rate_hz: float, noise_m: float, seed: int
) -> None:
    capture = pick_and_place(
        rate_hz=rate_hz, noise_m=noise_m, noise_rad=np.radians(noise_m / 0.003), seed=seed
    )
    touching = [each for each in of_kind(capture, Touching) if isinstance(each, Touching)]
    held = [each for each in touching if each.other == "thing"]
    assert len(held) == 1
    assert abs(held[0].first / rate_hz - 1.05) < 0.15
    assert abs(held[0].last / rate_hz - 2.85) < 0.15
    lying = [each for each in touching if (each.body, each.other) == ("thing", "table")]
    assert len(lying) == 2
    assert abs(lying[0].last / rate_hz - 1.45) < 0.15
    assert abs(lying[1].first / rate_hz - 2.35) < 0.15
    (moved,) = (each for each in of_kind(capture, Moving) if isinstance(each, Moving))
    assert 1.4 < moved.first / rate_hz < 1.65
    assert 2.15 < moved.last / rate_hz < 2.42


@given(st.integers(0, 10_000))
@settings(max_examples=8, deadline=None)
def test_facts_do_not_depend_on_how_the_world_is_turned(seed: int) -> None:
    plain = _without_up(pick_and_place())
    turned = _without_up(pick_and_place(world=Rotation.random(random_state=seed)))
    assert [type(each) for each in turned] == [type(each) for each in plain]
    for one, two in zip(plain, turned, strict=True):
        if not isinstance(one, Gap):
            assert str(one) == str(two)


def _without_up(capture: Capture) -> list[Fact]:
    """The facts that need not know which way is up."""
    kinds = (ZeroCrossing, Touching, Gap, Moving, LookingAt)
    return [each for each in measure(capture).facts if isinstance(each, kinds)]


def test_facts_do_not_depend_on_names() -> None:
    plain = measure(pick_and_place()).facts
    names = {"right_hand": "zz_paw", "thing": "a_cup", "table": "mesa"}
    named = measure(pick_and_place(names=("zz_paw", "a_cup", "mesa"))).facts
    expected = {_renamed(str(each), names) for each in plain}
    assert {str(each) for each in named} == expected


def _renamed(text: str, names: dict[str, str]) -> str:
    for old, new in names.items():
        text = text.replace(f"{old},", f"{new},").replace(f"{old})", f"{new})")
    return text


def test_facts_are_in_the_order_of_their_kinds_then_by_value_and_the_same_each_time() -> None:
    facts = measure(pick_and_place()).facts
    ranks = [MEASURED.index(type(each)) for each in facts]
    assert ranks == sorted(ranks)
    for kind in MEASURED:
        same = [each for each in facts if type(each) is kind]
        assert same == sorted(same)
    assert facts == measure(pick_and_place()).facts


def test_two_mobile_objects_touch_in_either_order_and_two_fixed_ones_never() -> None:
    frames = 50
    objects = (
        TagObject("cup", TagType.MOBILE, still((0, 0, 0.05), frames), box(0.1, 0.1, 0.1)),
        TagObject("tray", TagType.MOBILE, still((0, 0, -0.01), frames), box(0.4, 0.4, 0.02)),
        TagObject("wall", TagType.FIXED, still((0.3, 0, 0), frames), box(0.2, 0.2, 0.2)),
        TagObject("floor", TagType.FIXED, still((0.3, 0, -0.2), frames), box(1.0, 1.0, 0.2)),
    )
    hand = Sensor("hand", "hand", "right", "arm", still((0, 0, 2.0), frames), ball(0.04))
    found = pairs(Capture("stack", (hand,), objects))
    assert found == [("cup", "tray"), ("tray", "cup"), ("tray", "wall")]


def test_a_sensor_does_not_touch_the_object_that_it_is() -> None:
    where = still((0, 0, 1), 50)
    head = TagObject("head", TagType.SELF, where, ball(0.1))
    acts = Sensor("head", "head", "none", "neck", where, ball(0.1))
    assert pairs(Capture("head", (acts,), (head,))) == []


def test_bodies_without_shapes_touch_while_their_origins_are_near_and_it_is_said() -> None:
    way = np.zeros((200, 3))
    way[:, 0] = 0.5 - 0.005 * np.arange(200)
    hand = Sensor("hand", "hand", "right", "arm", stream(way))
    thing = TagObject("thing", TagType.MOBILE, still((0, 0, 0), 200))
    capture = Capture(
        "pivot", (hand,), (thing,), pivot_contacts=(PivotContact("thing", "hand", 0.1025),)
    )
    measured = measure(capture)
    touching = [each for each in measured.facts if isinstance(each, Touching)]
    assert touching == [Touching("hand", "thing", 80, 120)]
    assert "pivot-distance" in {each.code for each in measured.notices}


def test_what_is_assumed_lost_or_stood_in_for_is_told() -> None:
    way = np.tile([0.0, 0.0, 1.0], (200, 1))
    way[50:100] = np.nan
    stand_in = replace(ball(0.04), source=ShapeSource.STAND_IN, description="ball of 40 mm")
    hand = Sensor("hand", "hand", "right", "arm", stream(way), stand_in)
    shelf = TagObject(
        "shelf", TagType.FIXED, still((0, 0, 0), 200), box(1, 1, 0.1), assumed="from rest poses"
    )
    codes = {each.code for each in measure(Capture("x", (hand,), (shelf,))).notices}
    assert codes == {"contact-tolerance", "stand-in-shape", "assumed-support", "long-gap"}


def test_purposes_and_force_are_stated_in_the_users_order() -> None:
    plain = pick_and_place()
    capture = replace(
        plain, force_transfer=True, purposes=(Purpose("drink", action="Reach"), Purpose("tidy"))
    )
    assert of_kind(capture, Intended) == [
        Intended(0, "Reach", "any", "any", "drink"),
        Intended(1, "any", "any", "any", "tidy"),
    ]
    assert "force_transfer" in map(str, measure(capture).facts)


def test_the_nearest_object_on_the_line_of_sight_is_looked_at_and_where() -> None:
    times = np.arange(400) / 100.0
    turn = Rotation.from_rotvec(np.outer(times / 4.0, [0.0, 0.0, np.pi / 2]))
    seen = stream(np.zeros((400, 3)), orientations=turn.as_quat(scalar_first=True))
    head = Sensor("head", "head", "none", "neck", seen, None, Role.ATTENDS)
    hand = Sensor("hand", "hand", "right", "arm", still((0, 0, 9), 400))
    objects = (
        TagObject("near", TagType.FIXED, still((1.0, 0, 0), 400), box(0.2, 0.2, 0.2)),
        TagObject("far", TagType.FIXED, still((2.0, 0, 0), 400), box(0.2, 2.0, 0.2)),
        TagObject("head", TagType.SELF, seen, ball(0.1)),
    )
    measured = measure(Capture("sight", (hand, head), objects))
    looks = [each for each in measured.facts if isinstance(each, LookingAt)]
    assert [each.object for each in looks] == ["far", "near"]
    edge = np.arctan(0.1 / 0.9) / (np.pi / 2) * 400
    assert looks[1].last == pytest.approx(edge, abs=1.0)
    points = measured.attention["head"].points
    assert points[0] == pytest.approx([0.9, 0.0, 0.0], abs=1e-4)
    assert np.isnan(points[-1]).all()


def _eyed(*, lost_to: int = 0) -> Capture:
    """A head that faces one box, and eyes that see another one to its left."""
    head = Sensor("head", "head", "none", "neck", still((0, 0, 0), 200), None, Role.ATTENDS)
    left = [np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]
    spots = np.zeros((200, 3))
    spots[:lost_to] = np.nan
    sight = stream(spots, orientations=np.tile(left, (200, 1)))
    eyes = Sensor("eyes", "eyes", "none", "neck", sight, None, Role.ATTENDS)
    hand = Sensor("hand", "hand", "right", "arm", still((0, 0, 9), 200))
    objects = (
        TagObject("faced", TagType.FIXED, still((1.0, 0, 0), 200), box(0.2, 0.2, 0.2)),
        TagObject("seen", TagType.FIXED, still((0, 1.0, 0), 200), box(0.2, 0.2, 0.2)),
    )
    return Capture("eyed", (hand, head, eyes), objects)


@pytest.mark.parametrize("lost_to", [0, 80])
def test_a_head_looks_where_its_eyes_do_and_where_they_are_lost_it_faces(lost_to: int) -> None:
    looks = [fact for fact in measure(_eyed(lost_to=lost_to)).facts if isinstance(fact, LookingAt)]
    faced = [LookingAt("head", "faced", 0, lost_to - 1)] if lost_to else []
    assert looks == [*faced, LookingAt("head", "seen", lost_to, 199)]


def test_eyes_without_a_head_look_themselves() -> None:
    capture = _eyed()
    alone = replace(capture, sensors=tuple(s for s in capture.sensors if s.name != "head"))
    looks = [fact for fact in measure(alone).facts if isinstance(fact, LookingAt)]
    assert looks == [LookingAt("eyes", "seen", 0, 199)]


def test_of_several_agents_it_is_told_whose_hands_heads_and_other_parts_are_which() -> None:
    capture = pick_and_place()
    (hand,) = capture.sensors
    there = still((1.0, 1.0, 1.0), len(capture.times))
    bo = Sensor("bo_hand", "hand", "left", "left_arm", there, ball(0.05), agent="bo")
    own = TagObject("head", TagType.SELF, there, ball(0.1))
    others = TagObject("bo_head", TagType.SELF, there, ball(0.1), agent="bo")
    both = replace(
        capture, sensors=(hand, bo), objects=(*capture.objects, own, others), others=(Agent("bo"),)
    )
    assert of_kind(both, OfAgent) == [
        OfAgent("bo_hand", "bo"),
        OfAgent("bo_head", "bo"),
        OfAgent("head", "agent"),
        OfAgent("right_hand", "agent"),
    ]
    assert of_kind(capture, OfAgent) == []


SHORTEST = 2000
"""Fewest frames of a window [1]: two margins and two seconds at least."""


@cache
def whole(name: str) -> tuple[Capture, Measurements]:
    makers = {
        "drinking": lambda: motions.drink_from_mug(motions.WOMAN),
        "sliding": lambda: motions.slide_object(motions.TALL_MAN),
        "rolling": lambda: motions.roll_object(motions.WOMAN),
        "striking": lambda: motions.hit(motions.TALL_MAN),
    }
    capture = repeated(makers[name]().capture, 7)
    return capture, measure(capture)


def parts(data: st.DataObject, frames: int) -> tuple[int, int]:
    length = data.draw(st.integers(SHORTEST, min(frames, 3000)), label="length")
    first = data.draw(st.integers(0, frames - length), label="first")
    return first, first + length - 1


@pytest.mark.parametrize("name", ["drinking", "sliding", "rolling", "striking"])
@given(st.data())
@settings(max_examples=6, deadline=None)
def test_a_window_shows_what_the_whole_shows_in_its_inner_part(
    name: str, data: st.DataObject
) -> None:
    capture, measured = whole(name)
    found, expected = compared(capture, measured, *parts(data, len(capture.times)))
    assert found == expected


@pytest.mark.parametrize("place", ["manipnet:cube_med2", "hand_embodiment_pillow"])
def test_a_window_of_a_recording_shows_what_the_whole_shows(
    place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    capture = read_capture(str(Path(__file__).parents[2] / "examples" / place))
    measured = measure(capture)
    frames = len(capture.times)
    found, expected = compared(capture, measured, frames // 5, 4 * frames // 5)
    assert {type(each) for each in expected} >= {ZeroCrossing, Pause}
    assert found == expected


def test_measuring_with_its_own_calibration_changes_nothing() -> None:
    capture = pick_and_place(noise_m=0.0005, noise_rad=0.002)
    plain = measure(capture)
    again = measure(capture, calibrate(capture))
    assert again.facts == plain.facts
    assert again.notices == plain.notices
    assert again.calibration == plain.calibration == calibrate(capture)


def test_a_calibration_comes_back_from_json() -> None:
    known = calibrate(pick_and_place(noise_m=0.0005))
    assert value_from_json(to_json(known), Calibration) == known


@given(st.floats(0.0003, 0.003))
@settings(max_examples=5, deadline=None)
def test_it_states_the_noise_of_each_stream(noise_m: float) -> None:
    known = calibrate(pick_and_place(noise_m=noise_m))
    assert known.tag_object("thing").noise_m == pytest.approx(noise_m, rel=0.25)


def test_a_fixed_object_stands_where_it_was_calibrated_in_every_part() -> None:
    noise = np.random.default_rng(0).normal(0.0, 0.002, (400, 3))
    shaken = still((0.0, 0.0, 0.7), 400)
    shaken = replace(shaken, positions=shaken.positions + noise)
    table = TagObject("table", TagType.FIXED, shaken, ball(0.3))
    capture = Capture("x", (hand(np.zeros((400, 3)), ball(0.05)),), (table,))
    known = calibrate(capture)
    fixed = known.tag_object("table").fixed
    assert fixed is not None
    assert fixed.position_m == pytest.approx((0.0, 0.0, 0.7), abs=0.0005)
    part = replace(table, stream=replace(shaken, positions=shaken.positions + 0.001))
    measured = measure(replace(capture, objects=(part,)), known)
    settled = measured.bodies.objects["table"].poses.settled
    assert (settled.positions == np.array(fixed.position_m)).all()


def test_a_calibration_of_another_rate_or_without_a_body_is_refused() -> None:
    with pytest.raises(CaptureError, match="100 frames a second"):
        measure(pick_and_place(rate_hz=100.0), calibrate(pick_and_place(rate_hz=50.0)))
    capture = pick_and_place()
    with pytest.raises(UnknownNameError, match="table"):
        measure(capture, calibrate(replace(capture, objects=capture.objects[:1])))


LIMITS = Thresholds()


def ending(frame: int) -> Segment:
    """A segment of the right hand that ends at a frame, of which nothing else matters here."""
    return Segment(
        ee="right_hand",
        index=0,
        first=0,
        last=frame,
        start_s=0.0,
        end_s=1.0,
        name="Touch",
        general=(),
        candidates=(),
        level="",
        objects=("thing",),
        possessed=False,
        features=FeatureSet("0", "1", "0", "hand", "0"),
        begins=(),
        ends=(),
        purpose="",
    )


def where(capture: Capture, *, dominant: str, goal: str, frame: int) -> ConstraintLocation:
    measured = measure(capture)
    return constraint_location(
        capture, measured.bodies, measured.attention, ending(frame), dominant=dominant, goal=goal
    )


def test_a_grip_is_located_on_its_thing_and_a_thing_put_down_on_itself_and_its_goal() -> None:
    grip = where(pick_and_place(), dominant="", goal="thing", frame=200)
    assert grip.ee_nlt is None
    assert grip.goal_nlt is not None
    assert grip.goal_nlt.position[0] == pytest.approx(-0.5, abs=0.01)
    assert grip.goal_nlt.orientation == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=1e-6)
    put = where(pick_and_place(), dominant="thing", goal="table", frame=240)
    assert put.ee_nlt is not None
    assert put.goal_nlt is not None
    assert put.ee_nlt.position[2] == pytest.approx(-0.5, abs=0.01)
    assert put.goal_nlt.position[2] == pytest.approx(0.5, abs=0.03)


@given(st.floats(0.2, 3.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
@settings(max_examples=20)
def test_a_velocity_style_never_falls_and_does_not_depend_on_how_long_the_way_is(
    scale: float, y: float, z: float
) -> None:
    times = np.arange(101) / 100.0
    share = eased(times, 0.0, 1.0)
    way = np.outer(share, [scale, scale * y, scale * z])
    style = velocity_style(way, times, 0, 100, thresholds=LIMITS)
    assert len(style) == STEPS
    assert style[0] == 0.0
    assert style[-1] == 1.0
    assert all(np.diff(style) >= 0.0)
    assert style == pytest.approx(list(np.interp(np.linspace(0, 1, STEPS), times, share)), abs=1e-6)


def test_the_style_of_what_does_not_move_is_even() -> None:
    style = velocity_style(np.zeros((50, 3)), np.arange(50) / 100.0, 0, 49, thresholds=LIMITS)
    assert style == pytest.approx(list(np.linspace(0.0, 1.0, STEPS)))


def test_a_path_style_holds_the_places_strictly_inside_a_segment() -> None:
    times = np.arange(101) / 100.0
    way = np.outer(times, [1.0, 2.0, 3.0])
    points = path_style(way, times, np.array([0, 20, 45, 80, 100]), 20, 80)
    assert len(points) == 1
    assert points[0].time == pytest.approx(25 / 60)
    assert points[0].position == pytest.approx((0.45, 0.9, 1.35))
