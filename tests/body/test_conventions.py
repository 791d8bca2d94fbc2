"""Other people's skeletons are recognised and the body follows them."""

import os
from pathlib import Path

import numpy as np
import pytest
from virtual_bodies.moving import swinging

from capar.body.anthropometry import ready_made
from capar.body.human import Human
from capar.body.point_fitting import SkeletonError, fit_skeleton, measures_from_points
from capar.model.errors import UnknownNameError
from extractors.readers.names import (
    ConventionError,
    convention,
    conventions,
    recognise,
)
from extractors.readers.registry import read_recording

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[3] / "shared" / "data"))
recorded = pytest.mark.skipif(not DATA.exists(), reason=f"no recordings at {DATA}")


def _own_points(name: str) -> tuple[Human, np.ndarray, dict[str, np.ndarray]]:
    """A woman's motion under another skeleton's names."""
    human = Human.of(ready_made("woman"))
    times = np.arange(0.0, 2.0, 1.0 / 30.0)
    motion = swinging(human, times, 4, still_s=0.2)
    named = convention(name).points
    places = human.sites(motion, set(named.values()))
    return human, motion, {point: places[place][0] for point, place in named.items()}


JOINTS = sorted(name for name, each in conventions().items() if not each.markers)


@pytest.mark.parametrize("name", JOINTS)
def test_a_skeleton_is_known_by_its_names_and_the_body_follows_it(name: str) -> None:
    _, _, points = _own_points(name)
    assert set(recognise(points).named(points).values()) == set(convention(name).points.values())
    made = fit_skeleton(points, convention(name))
    assert made.median_m < 0.010
    assert made.derived
    assert not made.human.outside(made.motion, margin=1e-4).any()


@pytest.mark.parametrize("name", ["smpl", "coco17", "mediapipe33"])
def test_its_bones_give_the_measures_of_who_moved(name: str) -> None:
    human, _, points = _own_points(name)
    found = measures_from_points(points, convention(name), sex="female")
    for limb in ("upper_arm", "forearm", "thigh", "shank"):
        assert found[limb] == pytest.approx(human.measures[limb], abs=1e-6)
        assert limb in found.given
    assert found["stature"] == pytest.approx(human.measures["stature"], abs=0.01)


def test_prefixes_of_names_are_left_out() -> None:
    names = [f"mixamorig:{each}" for each in convention("mixamo").points]
    assert recognise(names).named(names)["mixamorig:LeftArm"] == "left_upper_arm"


def test_names_of_no_convention_are_refused_with_the_nearest() -> None:
    with pytest.raises(ConventionError, match=r"nearest is '\w+', of which there are \d+%"):
        recognise(["mug", "table", "L_Hip"])
    with pytest.raises(UnknownNameError, match=r"no convention 'smlp'.*'smpl'"):
        convention("smlp")
    with pytest.raises(SkeletonError, match="four or more are needed"):
        fit_skeleton({"L_Hip": np.zeros((3, 3))}, convention("smpl"))


def test_every_place_that_a_convention_names_is_on_the_body() -> None:
    human = Human.of(ready_made("man"))
    for each in conventions().values():
        human.sites(human.posture()[None], set(each.points.values()))
        human.sites(human.posture()[None], set(each.on.values()))
        assert set(each.weights) <= set(each.points.values())
        assert each.source


@recorded
def test_recorded_people_are_followed_to_a_centimetre() -> None:
    omomo = np.load(DATA / "omomo_intermimic" / "npz" / "sub2_largetable_000.npz")
    joints = {str(n): omomo["body_pos"][:60, i] for i, n in enumerate(omomo["body_names"])}
    made = fit_skeleton(joints, recognise(joints))
    assert recognise(joints).name == "smpl"
    assert made.median_m < 0.010
    assert 1.6 < made.human.measures["stature"] < 1.9
    reach = np.load(DATA / "smartbody_mocap_reaching" / "npz" / "ReachForwardLow01.npz")
    upright = reach["pos_m"][:60][..., [2, 0, 1]]
    joints = {str(n): upright[:, i] for i, n in enumerate(reach["joint_names"])}
    assert fit_skeleton(joints, recognise(joints)).median_m < 0.005


@recorded
@pytest.mark.parametrize("file, unit_m, axes", [("cmu_walk.bvh", 0.05644, [2, 0, 1])])
def test_a_bvh_file_is_followed_too(file: str, unit_m: float, axes: list[int]) -> None:
    bodies = read_recording(DATA / "foreign_files" / file).bodies
    joints = {n: each.positions[20:80][:, axes] * unit_m for n, each in bodies.items()}
    made = fit_skeleton(joints, recognise(joints))
    assert made.median_m < 0.010
