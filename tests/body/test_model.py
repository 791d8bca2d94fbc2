"""The model has the measures, masses and ranges that its tables say, for bodies of any size."""

import mujoco
import numpy as np
import pytest
from combinations import EVERY
from virtual_bodies.sizes import PEOPLE as SIZES
from virtual_bodies.sizes import READY

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
from capar.body.fingers import GraspError, grasp
from capar.body.human import Human, PostureError, body_spec, sensor_sites, site_rows
from capar.body.skeleton import skeleton
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


@pytest.mark.parametrize("name", READY)
def test_mujoco_loads_the_model_without_a_warning(
    name: str, capfd: pytest.CaptureFixture[str]
) -> None:
    spec = body_spec(ready_made(name))
    model = spec.compile()
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert again.nq == model.nq
    assert all(warning.number == 0 for warning in data.warning)
    assert capfd.readouterr() == ("", "")


def test_two_bodies_share_a_scene_under_prefixes() -> None:
    scene = mujoco.MjSpec()
    for prefix, name in (("tall_", "man"), ("small_", "child")):
        frame = scene.worldbody.add_frame()
        scene.attach(body_spec(ready_made(name), prefix=prefix), frame=frame)
    model = scene.compile()
    assert model.nbody == 1 + 2 * len(skeleton(ready_made("man")))


def test_every_number_names_its_source() -> None:
    tables = table("anthropometry")
    for population in READY:
        for name, row in tables[population].items():
            assert name == "age" or row["source"] in tables["sources"]
    assert {row["source"] for row in table("joints")["joint"]} <= set(table("joints")["sources"])


def test_the_thesiss_eleven_sensors_have_a_place_each() -> None:
    places = {"l5", "head", "neck"} | {
        f"{side}_{part}" for side in ("right", "left") for part in ("hand", "elbow", "knee", "foot")
    }
    assert set(sensor_sites()) == {f"sensor_{each}" for each in places}


def test_the_measures_say_which_were_given() -> None:
    measures = estimate_measures(sex="female", given={"stature": 1.7, "upper_arm": 0.29})
    assert measures.given == {"stature", "upper_arm"}
    assert measures["upper_arm"] == 0.29
    assert "forearm" in measures.estimated
    assert measures.deviations["upper_arm"] < measures.deviations["forearm"]


def test_a_tall_percentile_is_not_tall_in_every_measure() -> None:
    usual, tall = (estimate_measures(percentile=each) for each in (50.0, 95.0))
    row = table("anthropometry")["man"]
    assert tall["stature"] == pytest.approx(row["stature"]["percentiles"][2], abs=0.01)
    assert usual["hand_length"] < tall["hand_length"] < row["hand_length"]["percentiles"][2]


def test_between_nine_and_eighteen_proportions_pass_from_the_childs_to_the_adults() -> None:
    heads = [
        (m := estimate_measures(sex="male", age=age))["head_length"] / m["stature"]
        for age in (9.0, 12.0, 15.0, 18.0)
    ]
    assert heads == sorted(heads, reverse=True)


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


@pytest.mark.parametrize("name", READY)
@pytest.mark.parametrize("side", ["right", "left"])
def test_a_hand_closes_round_a_width(name: str, side: str) -> None:
    human = Human.of(ready_made(name))
    width = 0.3 * human.measures["hand_length"]
    posture = human.posture(grasp(human, side, width))[None]
    tips = human.sites(posture, (f"{side}_fingertip", f"{side}_thumb_tip"))
    (finger, _), (thumb, _) = tips.values()
    assert np.linalg.norm(finger - thumb) == pytest.approx(width, abs=1e-3)
    assert set(grasp(human, side, None).values()) == {0.0}
    with pytest.raises(GraspError, match="closes round"):
        grasp(human, side, 0.5)
