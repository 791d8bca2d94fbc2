"""A body has the measures and ranges of its tables, its solver gets where it can, and it stands."""

import mink
import numpy as np
import pytest
from combinations import EVERY
from scipy.spatial.transform import RigidTransform
from virtual_bodies.sizes import PEOPLE as SIZES
from virtual_bodies.sizes import READY

from capar.body import virtual_scenes
from capar.body.anthropometry import (
    MeasuresError,
    estimate_measures,
    is_right,
    measure_names,
    measures_of,
    mirrored,
    ready_made,
    table,
)
from capar.body.gaze_control import share_costs
from capar.body.human import Human, PostureError, site_rows
from capar.body.inverse_kinematics import (
    MARGIN_M,
    BalanceLimit,
    BalanceTask,
    Solver,
    sole,
    standing_support,
    support,
)
from capar.body.performing import RELAXED, perform
from capar.body.scripts import SIDES, slide
from capar.model.capture import Agent
from capar.model.errors import UnknownNameError

DRAWN = len(SIZES) if EVERY else 40
"""How many sizes are tried; `CAPAR_SCENES=all` tries all."""

PEOPLE = dict(list(SIZES.items())[:DRAWN])


@pytest.mark.parametrize("who", PEOPLE)
def test_a_body_of_any_size_has_its_measures(who: str) -> None:
    measures = PEOPLE[who]
    human = Human.of(measures)
    assert human.model.body_subtreemass[0] == pytest.approx(measures["mass"], abs=1e-9)
    _check_lengths(human)
    _check_ranges(human)
    _check_mirrored(human)


def _check_lengths(human: Human) -> None:
    measures, standing = human.measures, human.posture()[None]
    joints = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shank", "shank": "foot"}
    for side in ("right", "left"):
        names = [f"{side}_{each}" for pair in joints.items() for each in pair]
        at = human.sites(standing, names)
        for limb, end in joints.items():
            length = np.linalg.norm(at[f"{side}_{limb}"][0] - at[f"{side}_{end}"][0])
            assert length == pytest.approx(measures[limb], abs=1e-3)
        tips = human.sites(standing, (f"{side}_fingertip", f"{side}_hand", f"{side}_sole"))
        hand = tips[f"{side}_hand"][0][0, 2] - tips[f"{side}_fingertip"][0][0, 2]
        assert hand == pytest.approx(measures["hand_length"], abs=1e-3)
        assert tips[f"{side}_sole"][0][0, 2] == pytest.approx(0.0, abs=1e-3)
    heights = {"head_top": "stature", "c7": "cervicale_height", "between_eyes": "eye_height"}
    for site, name in heights.items():
        places, _ = human.sites(standing, (site,))[site]
        assert places[0, 2] == pytest.approx(measures[name], abs=1e-3)


def _check_ranges(human: Human) -> None:
    rows = {row["name"]: row for row in table("joints")["joint"]}
    share = human.measures.adult_share
    assert len(human.joints) == 60
    for joint, limits in zip(human.joints, human.ranges, strict=True):
        row = rows[joint if joint in rows else mirrored(joint)]
        young = np.array(row.get("child", row["range"]))
        wanted = share * np.array(row["range"]) + (1.0 - share) * young
        np.testing.assert_allclose(np.degrees(limits), wanted, atol=1e-9)
        assert limits[0] <= 0.0 <= limits[1], f"{joint} cannot stand"


def _check_mirrored(human: Human) -> None:
    rng = np.random.default_rng(7)
    low, high = human.ranges.T
    drawn = dict(zip(human.joints, rng.uniform(low, high), strict=True))
    middle = {"bend", "turn"}
    other = {
        mirrored(n) if "right_" in n or "left_" in n else n: -a if n.split("_")[-1] in middle else a
        for n, a in drawn.items()
    }
    names = [human.model.body(each).name for each in range(1, human.model.nbody)]
    names += [row["name"] for row in site_rows()]
    one = human.sites(human.posture(drawn)[None], names)
    two = human.sites(human.posture(other)[None], names)
    flip = np.array([1.0, -1.0, 1.0])
    for name in names:
        twin = mirrored(name) if "right_" in name or "left_" in name else name
        np.testing.assert_allclose(one[name][0] * flip, two[twin][0], atol=1e-9)
    model = human.model
    for body in filter(is_right, names[: model.nbody - 1]):
        left, right = model.body(mirrored(body)), model.body(body)
        assert left.mass == right.mass
        np.testing.assert_allclose(left.ipos * flip, right.ipos)
        np.testing.assert_allclose(left.inertia, right.inertia)


@pytest.mark.parametrize("name", READY)
def test_a_standing_body_has_its_centre_of_mass_where_it_was_measured(name: str) -> None:
    human = Human.of(ready_made(name))
    x, y, z = human.centre_of_mass(human.posture())
    published = table("anthropometry")["standing_centre_of_mass"][name]["of_stature"]
    assert z / human.measures["stature"] == pytest.approx(published, abs=0.015)
    assert y == pytest.approx(0.0, abs=1e-9)
    assert -0.05 < x < 0.15, "it stands over its feet"


def test_a_capture_states_its_performers_measures() -> None:
    measures = measures_of(Agent("ada", "woman", {"stature": 1.6, "mass": 55.0, "shoe": 0.3}))
    assert measures.sex == "female"
    assert measures.given == {"stature", "mass"}


def test_measures_of_no_body_are_refused() -> None:
    with pytest.raises(UnknownNameError, match=r"no measure 'uper_arm'.*Did you mean 'upper_arm'"):
        estimate_measures(given={"uper_arm": 0.3})
    with pytest.raises(MeasuresError, match="a trunk has a quarter"):
        estimate_measures(given={"thigh": 0.9})
    with pytest.raises(MeasuresError, match="must rise"):
        estimate_measures(given={"eye_height": 1.9})
    with pytest.raises(MeasuresError, match="6 years"):
        estimate_measures(age=3.0)
    with pytest.raises(MeasuresError, match="both given"):
        estimate_measures(percentile=50.0, given={"stature": 1.7})
    with pytest.raises(MeasuresError, match=r"0.9 to 2.3"):
        estimate_measures(given={"stature": 17.0})
    assert "stature" in measure_names()


def test_a_posture_out_of_range_is_refused_with_the_range() -> None:
    human = Human.of(ready_made("man"))
    with pytest.raises(PostureError, match=r"right_elbow_flexion at 170.0 degrees.* 0 to 143"):
        human.posture({"right_elbow_flexion": float(np.radians(170.0))})
    with pytest.raises(UnknownNameError, match="no joint 'elbow'"):
        human.posture({"elbow": 0.1})


UPRIGHT_PALM = np.array([0.0, 0.5**0.5, 0.0, 0.5**0.5, 0.623, -0.16, 0.88])
"""``T_world_palm``, w x y z and [m]: a child's palm far before it, its fingers up."""


CHILD = Human.of(measures_of(Agent("child", "child", {"stature": 1.36, "mass": 30.5})))


def asked(human: Human) -> tuple[mink.Configuration, list[mink.Task]]:
    """A child at ease whose feet stay and whose palm is asked far forward; the palm is first."""
    eased = {f"{s}_{n}": float(np.radians(a)) for n, a in RELAXED.items() for s in SIDES}
    configuration = mink.Configuration(human.model)
    configuration.update(human.posture(eased))
    palm = mink.FrameTask("right_palm", "site", 60.0, 8.0)
    feet = [mink.FrameTask(f"{s}_foot", "body", 60.0, 8.0) for s in SIDES]
    ease = mink.PostureTask(human.model, cost=share_costs(human, 0.05))
    balance = mink.ComTask(cost=[2.0, 2.0, 0.0])
    for task in (*feet, ease, balance):
        task.set_target_from_configuration(configuration)
    palm.set_target(mink.SE3(UPRIGHT_PALM))
    damping = mink.DampingTask(human.model, cost=0.05)
    return configuration, [palm, *feet, ease, balance, damping]


def missed_m(configuration: mink.Configuration, tasks: list[mink.Task]) -> float:
    """How far the palm is from where it is asked to be [m]."""
    return float(np.linalg.norm(tasks[0].compute_error(configuration)[:3]))


def test_no_step_leads_further_away_and_the_palm_gets_there() -> None:
    human = CHILD
    configuration, tasks = asked(human)
    solver = Solver(human, tasks)
    errors = [solver.error(configuration)]
    while not solver.settled and len(errors) < 200:
        solver.step(configuration)
        errors.append(solver.error(configuration))
    assert solver.settled
    assert (np.diff(errors) <= 0.0).all()
    assert missed_m(configuration, tasks) < 0.002
    assert not human.outside(configuration.q[None], margin=1e-3).any()


SLACK_M = 0.002
"""What the steps of inverse kinematics may go beyond a margin, as they are straight [m]."""


@pytest.fixture(scope="module", params=("man", "woman", "child"))
def human(request: pytest.FixtureRequest) -> Human:
    return Human.of(ready_made(request.param))


def test_the_base_of_support_is_around_both_soles_and_what_is_between_them(human: Human) -> None:
    base = standing_support(human, human.posture())
    feet = human.sites(human.posture()[None], ("right_foot", "left_foot"))
    ankles = {name.removesuffix("_foot"): spots[0] for name, (spots, _) in feet.items()}
    for side, ankle in ankles.items():
        corners = (sole(human, side) + ankle)[:, :2]
        assert base.outside(corners).max() < 1e-6
    between = np.mean(list(ankles.values()), axis=0)[:2]
    assert base.outside(between) < -0.05
    length = human.measures["foot_length"]
    assert base.outside(between + np.array([length, 0.0])) > 0.0
    assert base.outside(between - np.array([0.5 * length, 0.0])) > 0.0
    one = support(human, {"left": RigidTransform.from_translation(ankles["left"])})
    assert one.outside(between) > 0.0


def leaning(human: Human, *, balanced: bool) -> tuple[mink.Configuration, float, float]:
    """Somebody drawn by the right palm to a place too far ahead to be reached without falling.

    Returns:
        The body, how far its weight is outside its feet, and how far the palm misses [m].
    """
    configuration = mink.Configuration(human.model)
    configuration.update(human.posture())
    base = standing_support(human, human.posture())
    palm = mink.FrameTask("right_palm", "site", 60.0, 0.0)
    start = configuration.get_transform_frame_to_world("right_palm", "site").translation()
    goal = start + np.array([0.62 * human.measures["stature"], 0.0, 0.0])
    palm.set_target(mink.SE3.from_translation(goal))
    feet = [mink.FrameTask(f"{side}_foot", "body", 60.0, 8.0) for side in ("right", "left")]
    ease = mink.PostureTask(human.model, cost=share_costs(human, 0.05))
    for foot in feet:
        foot.set_target_from_configuration(configuration)
    ease.set_target(human.posture())
    tasks = [palm, *feet, ease, mink.DampingTask(human.model, cost=0.05)]
    if balanced:
        solver = Solver(human, [*tasks, BalanceTask(base)], limits=[BalanceLimit(base)])
    else:
        solver = Solver(human, tasks)
    for _ in range(200):
        solver.step(configuration)
        if solver.settled:
            break
    outside = float(base.outside(configuration.data.subtree_com[1, :2]))
    spot = configuration.get_transform_frame_to_world("right_palm", "site").translation()
    return configuration, outside, float(np.linalg.norm(spot - goal))


def test_hips_stay_back_when_a_hand_is_drawn_far_ahead(human: Human) -> None:
    free, falls, _ = leaning(human, balanced=False)
    kept, stands, _ = leaning(human, balanced=True)
    assert falls > 0.0
    assert stands <= -MARGIN_M + SLACK_M
    assert kept.q[0] < free.q[0] - 0.03, "the pelvis is further back [m]"


def test_weight_that_is_beside_the_feet_is_drawn_back_above_them(human: Human) -> None:
    configuration = mink.Configuration(human.model)
    posture = human.posture()
    base = standing_support(human, posture)
    posture[0] += 0.3
    configuration.update(posture)
    edge, ease = BalanceTask(base), mink.PostureTask(human.model, cost=0.05)
    ease.set_target(posture)
    assert edge.compute_error(configuration)[0] > 0.05
    solver = Solver(human, [edge, ease], limits=[BalanceLimit(base)])
    for _ in range(40):
        solver.step(configuration)
    assert edge.compute_error(configuration)[0] < SLACK_M


@pytest.mark.long
@pytest.mark.parametrize("far", [0.25, 0.4, 0.5])
def test_a_performer_slides_a_far_mug_without_falling(far: float) -> None:
    human = Human.of(ready_made("child"))
    tall = human.measures["stature"]
    mug = virtual_scenes.Thing(
        "mug", virtual_scenes.cup(0.035, 0.09), (far * tall, -0.1 * tall, 0.45 * tall), round=True
    )
    desk = virtual_scenes.table(0.45 * tall, near_m=0.13 * tall)
    made = perform(
        human, virtual_scenes.scene(desk, mug), slide("mug", (0.0, 0.1, 0.0)), rate_hz=20.0
    )
    base = standing_support(human, made.motion[0])
    places = np.array([human.centre_of_mass(posture)[:2] for posture in made.motion])
    assert base.outside(places).max() <= -MARGIN_M + SLACK_M
