"""Bodies are fitted to markers, of which only some are at known places, and to whole captures."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from marker_people import walker, write_trc
from typer.testing import CliRunner
from virtual_bodies.moving import swinging

from capar.body.anthropometry import ready_made
from capar.body.body_fitting import fit_body, fit_places, whole_body
from capar.body.human import Human
from capar.body.marker_fitting import fit_markers
from capar.body.point_fitting import SkeletonError, with_legs
from capar.cli import app
from capar.model import geometry
from capar.views.viewer.snapshot import snapshot
from capar.views.viewer.stage import stage, with_mannequin
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import draft
from extractors.readers.names import BodyName, body_names, conventions, parts
from extractors.readers.registry import read_recording

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[3] / "shared" / "data"))
recorded = pytest.mark.skipif(not DATA.exists(), reason=f"no recordings at {DATA}")
EXAMPLES = Path(__file__).parents[2] / "examples"

PLACES = (
    "c7", "sternum_top", "sternum_low", "t10", "sacrum", "right_asis", "left_asis",
    *(f"{side}_{name}" for side in ("right", "left") for name in (
        "head_front", "head_back", "acromion", "elbow_lateral", "wrist_radial", "wrist_ulnar",
        "hand_back", "trochanter", "knee_lateral", "ankle_lateral", "heel", "toe_tip",
    )),
)  # fmt: skip
RIDING = {"right_thigh": (0.05, -0.06, -0.2), "left_shank": (-0.03, 0.05, -0.15)}


def marked() -> tuple[Human, np.ndarray, dict[str, np.ndarray], dict[str, BodyName]]:
    """A woman's motion, her markers a centimetre off their landmarks, and two that ride along."""
    human = Human.of(ready_made("woman"))
    motion = swinging(human, np.arange(0.0, 1.5, 1.0 / 30.0), 4, still_s=0.2)
    rng = np.random.default_rng(3)
    points, names = {}, {}
    places = human.sites(motion, {*PLACES, *RIDING, "pelvis"})
    for place in PLACES:
        points[place] = places[place][0] + rng.normal(0.0, 0.0005, (len(motion), 3))
        names[place] = BodyName(place, place, exact=True, by="a guide")
    for segment, local in RIDING.items():
        at, turn = places[segment]
        points[segment] = geometry.transforms(at, turn).apply(np.tile(local, (len(at), 1)))
        names[segment] = BodyName(segment, segment, exact=False, by="a guide")
    return human, motion, points, names


def test_a_body_is_found_back_from_its_markers_with_its_size_and_their_places() -> None:
    human, motion, points, names = marked()
    points["c7"][:10] = np.nan
    made = fit_markers(points, names)
    assert made.skeleton.median_m < 0.005
    for limb in ("upper_arm", "shank"):
        assert made.skeleton.human.measures[limb] == pytest.approx(human.measures[limb], rel=0.05)
    for joint in ("right_hand", "left_foot", "right_forearm"):
        true = human.sites(motion, [joint])[joint][0]
        found = made.skeleton.human.sites(made.skeleton.motion, [joint])[joint][0]
        assert float(np.median(np.linalg.norm(true - found, axis=1))) < 0.03
    assert np.isnan(made.skeleton.residuals_m["c7"][:10]).all()
    assert not made.skeleton.human.outside(made.skeleton.motion, margin=1e-4).any()


def test_too_few_markers_are_refused_with_those_that_there_are() -> None:
    _, _, points, names = marked()
    few = {name: names[name] for name in ("c7", "right_asis", "left_asis")}
    with pytest.raises(SkeletonError, match=r"3 markers at known places.*c7.*6 or more"):
        fit_markers(points, few)


def test_every_place_of_every_convention_is_of_a_part() -> None:
    for each in conventions().values():
        found = body_names([*each.points, *each.on])
        assert {name.part for name in found.values()} <= set(parts().values())


def test_legs_without_landmarks_are_as_long_as_their_clusters_move() -> None:
    usual = ready_made("woman")
    longer = {"thigh": 1.08 * usual["thigh"], "shank": 1.06 * usual["shank"]}
    human = Human.of(with_legs(usual, longer))
    motion = swinging(human, np.arange(0.0, 4.0, 1.0 / 30.0), 4, still_s=0.2)
    above = [place for place in PLACES if not place.endswith(("trochanter", "knee_lateral"))]
    above = [place for place in above if "ankle" not in place]
    legs = [f"{side}_{part}" for side in ("right", "left") for part in ("thigh", "shank", "foot")]
    where = human.sites(motion, {*above, *legs})
    points = {place: where[place][0] for place in above}
    names = {place: BodyName(place, place, exact=True, by="a guide") for place in above}
    rng = np.random.default_rng(6)
    for segment in legs:
        at, turn = where[segment]
        for number in range(3):
            local = rng.uniform(-0.05, 0.05, 3) - [0.0, 0.0, 0.02 if "foot" in segment else 0.2]
            name = f"{segment}_{number}"
            points[name] = geometry.transforms(at, turn).apply(np.tile(local, (len(at), 1)))
            names[name] = BodyName(name, segment, exact=False, by="a guide")
    made = fit_markers(points, names).skeleton
    for leg, length in longer.items():
        assert made.human.measures[leg] == pytest.approx(length, rel=0.035), leg


@recorded
@pytest.mark.parametrize(
    "file, median_m",
    [("walk_free_01.trc", 0.006), ("std_walking2_markers.trc", 0.006)],
)
def test_recorded_walks_are_followed_and_told_by_marker(
    file: str, median_m: float, tmp_path: Path
) -> None:
    source = DATA / "foreign_files" / file
    (tmp_path / "capture.toml").write_text(draft([read_recording(source)], tmp_path, "walk"))
    asked = CliRunner().invoke(app, ["fit", str(tmp_path), "--json"])
    assert asked.exit_code == 0, asked.output
    answer = json.loads(asked.output)
    assert answer["median_mm"] < 1e3 * median_m
    assert 1.4 < answer["stature_m"] < 1.95
    assert len(answer["sensors"]) >= 16


@pytest.mark.usefixtures("recordings")
def test_clusters_with_few_joints_between_them_are_followed_by_their_markers(
    tmp_path: Path,
) -> None:
    recording = read_recording(DATA / "foreign_files" / "propulsion.c3d")
    (tmp_path / "capture.toml").write_text(draft([recording], tmp_path, "propulsion"))
    made = fit_body(tmp_path, read_capture(tmp_path))
    assert len(made.residuals_m) > 25
    assert float(np.nanmedian(np.concatenate([*made.residuals_m.values()]))) < 0.02


@pytest.mark.usefixtures("recordings")
def test_a_body_of_poses_is_followed_from_its_capture() -> None:
    found = whole_body(EXAMPLES / "omomo_intermimic/largebox.toml:sub3_largebox_003")
    assert found is not None
    short = {name: each[:60] for name, each in found.points.items()}
    made = fit_places(type(found)(found.times[:60], short, found.names))
    kinked = {"Pelvis", "Torso", "Spine", "Chest"}  # by up to 80 degrees at one joint
    assert kinked < set(made.residuals_m)
    rest = [each for name, each in made.residuals_m.items() if name not in kinked]
    assert float(np.nanmedian(rest)) < 0.012
    assert made.motion.shape[0] == 60


@pytest.mark.usefixtures("recordings")
def test_a_capture_of_sensors_has_no_whole_body() -> None:
    assert whole_body(EXAMPLES / "bimacs_optitrack:take0") is None


@pytest.fixture(scope="module")
def walking(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The capture of somebody who walks with Plug-in Gait markers on, from its draft."""
    folder = tmp_path_factory.mktemp("walk")
    write_trc(folder / "walk.trc", {name: 1000.0 * at[100:160] for name, at in walker().items()})
    text = draft([read_recording(folder / "walk.trc")], folder, "walk")
    (folder / "capture.toml").write_text(text)
    return folder


def test_a_fit_is_exported_and_its_bvh_reads_back(walking: Path) -> None:
    forms = ("bvh", "glb", "npz", "csv", "mjcf")
    files = {form: walking / f"walk_{form}.{form}" for form in forms}
    options = [word for form, path in files.items() for word in (f"--{form}", str(path))]
    asked = CliRunner().invoke(app, ["fit", str(walking), "--json", *options])
    assert asked.exit_code == 0, asked.output
    assert all(path.stat().st_size for path in files.values())
    assert any("floor is assumed" in remark for remark in json.loads(asked.stdout)["remarks"])
    joints = read_recording(files["bvh"]).bodies
    markers = read_recording(walking / "walk.trc").markers
    ankles = (markers["RANK"][30], markers["LANK"][30])
    feet = [joints[f"{side}_foot"].positions[30][[2, 0, 1]] * 10.0 for side in ("right", "left")]
    for ankle, foot in zip(ankles, feet, strict=True):
        assert np.linalg.norm(ankle - foot) < 70.0  # the joint is half a foot's breadth inside
    again = draft([read_recording(files["bvh"])], walking, "again")
    assert 'unit = "cm"' in again
    assert 'up = "y"' in again
    assert again.count("[[sensor]]") == 5


def test_the_viewer_shows_the_fitted_body_beside_what_was_recorded(walking: Path) -> None:
    capture = read_capture(walking)
    fit, bare = fit_body(walking, capture), stage(capture)
    shown = with_mannequin(bare, fit)
    added = {each.name: each for each in shown.bodies[len(bare.bodies) :]}
    assert {each.kind for each in added.values()} == {"body"}
    assert {"body_head", "body_right_foot", "body_pelvis"} <= set(added)
    head = capture.sensor("head").stream.positions
    assert np.linalg.norm(added["body_head"].positions[0] - head[0]) < 0.15
    snapshot(shown, 0.3, walking / "walk.png")
    assert (walking / "walk.png").read_bytes()[:4] == b"\x89PNG"
