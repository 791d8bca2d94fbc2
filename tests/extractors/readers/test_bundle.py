"""A capture.toml says what is what; what it says wrongly is pointed at by name and line."""

from pathlib import Path

import motion_files as samples
import numpy as np
import pytest

from capar.model import geometry
from capar.model.capture import Capture, Role, ShapeSource
from capar.model.errors import CaparError, CaptureError, FileError, UnknownNameError
from capar.pipelines.observation import observe
from extractors.readers.bundle.capture_toml import frame_times, read_capture, takes

BASE = """name = "trial"
unit = "m"
up = "z"

[files]
motion = "m.csv"

[[sensor]]
name = "right_hand"
end_effector = "hand"
side = "right"
body = "hand"
shape = { sphere = 0.05 }

[[object]]
name = "mug"
tag = "mobile"
position = [0.5, 0.2, 0.9]
shape = { cylinder = [0.04, 0.1] }
"""


def bundle(folder: Path, text: str = BASE, kind: str = "csv") -> Path:
    name, write = samples.WRITERS[kind]
    write(folder / name)
    (folder / "capture.toml").write_text(text)
    return folder


def test_a_bundle_is_read_with_every_part_on_one_clock(tmp_path: Path) -> None:
    capture = read_capture(bundle(tmp_path))
    hand = capture.sensor("right_hand")
    assert (hand.link, hand.role, hand.end_effector) == ("right_arm", Role.ACTS, "hand")
    assert np.allclose(hand.stream.positions, samples.PLACES, atol=1e-8)
    mug = capture.tag_object("mug")
    assert mug.shape is not None
    assert mug.shape.source is ShapeSource.STAND_IN
    assert np.allclose(mug.shape.size, [0.08, 0.08, 0.1], atol=1e-3)
    assert [each.format for each in capture.sources] == ["capture.toml", "csv"]


@pytest.mark.parametrize(("kind", "stated", "likely"), [("tsv", "m", "mm"), ("csv", "mm", "m")])
def test_a_unit_wrong_by_far_is_told_with_the_likely_one(
    kind: str, stated: str, likely: str, tmp_path: Path
) -> None:
    name = samples.WRITERS[kind][0]
    text = BASE.replace('"m.csv"', f'{{ path = "{name}", unit = "{stated}" }}')
    if kind == "tsv":
        text = text.replace('body = "hand"', 'markers = ["a", "b", "c", "d"]')
    place = bundle(tmp_path, text, kind)
    if kind == "csv":
        table = (place / name).read_text().splitlines()
        cells = ",".join(table[0].split(",")[1:])
        both = [f"{table[0]},{cells.replace('hand', 'mug')}"]
        both += [f"{row},{','.join(row.split(',')[1:])}" for row in table[1:]]
        (place / name).write_text("\n".join(both))
    with pytest.raises(CaptureError, match=f'unit = "{likely}"'):
        read_capture(place)


def test_markers_make_a_rigid_body_with_the_axes_that_are_asked_for(tmp_path: Path) -> None:
    text = BASE.replace("m.csv", "m.tsv").replace(
        'body = "hand"',
        'markers = ["a", "b", "c", "d"]\norigin = ["a"]\naxes = { x = ["a", "b"], y = ["a", "c"] }',
    )
    stream = read_capture(bundle(tmp_path, text, "tsv")).sensor("right_hand").stream
    assert np.allclose(stream.positions, samples.PLACES, atol=1e-6)
    truth = samples.TURNS.as_quat(scalar_first=True)
    assert geometry.angle_between(stream.orientations, truth).max() < 1e-5


def test_a_mirrored_world_is_found_where_the_arrangement_is_known(tmp_path: Path) -> None:
    places = ", ".join(
        f"{name} = [{-x}, {y}, {z}]"
        for name, (x, y, z) in zip(samples.NAMES, samples.CORNERS, strict=True)
    )
    text = BASE.replace("m.csv", "m.tsv").replace(
        'body = "hand"', f'markers = ["a", "b", "c", "d"]\narrangement = {{ {places} }}'
    )
    with pytest.raises(CaptureError, match="left-handed"):
        read_capture(bundle(tmp_path, text, "tsv"))


def test_a_left_handed_world_becomes_a_right_handed_one(tmp_path: Path) -> None:
    capture = read_capture(bundle(tmp_path, 'handedness = "left"\n' + BASE))
    right = read_capture(bundle(tmp_path))
    mirror = np.diag([-1.0, 1.0, 1.0])
    for frame in (0, 5, samples.FRAMES - 1):
        here = capture.sensor("right_hand").stream.pose(frame).as_matrix()
        there = right.sensor("right_hand").stream.pose(frame).as_matrix()
        assert np.allclose(here[:3, :3], mirror @ there[:3, :3] @ mirror, atol=1e-9)
        assert np.allclose(here[:3, 3], mirror @ there[:3, 3], atol=1e-9)


def test_a_support_stands_under_what_rests_on_it_and_says_so(tmp_path: Path) -> None:
    text = BASE + (
        '[[object]]\nname = "table"\ntag = "fixed"\nassumed = "no table was recorded"\n'
        'top_at_bottom_of = "mug"\nat_s = 0.1\nshape = { box = [1.0, 1.0, 0.04] }\n'
    )
    table = read_capture(bundle(tmp_path, text)).tag_object("table")
    assert table.shape is not None
    assert table.shape.source is ShapeSource.ASSUMED
    assert table.stream.positions[0, 2] == pytest.approx(0.85 - 0.02)
    assert "0.850 m, the lowest point of mug" in table.assumed


def test_frames_of_the_file_stay_convertible_to_seconds_at_any_rate(tmp_path: Path) -> None:
    place = bundle(tmp_path, "rate_hz = 120\n" + BASE)
    capture = read_capture(place)
    times = frame_times(place)
    assert capture.rate_hz == pytest.approx(120.0)
    assert np.allclose(times, samples.TIMES)
    hand = capture.sensor("right_hand").stream
    at = np.stack([np.interp(times, capture.times, each) for each in hand.positions.T], axis=1)
    assert np.allclose(at[:-1], samples.PLACES[:-1], atol=2e-4)


def test_a_take_fills_the_names_of_files(tmp_path: Path) -> None:
    text = 'takes = ["m", { take = "other" }]\n' + BASE.replace("m.csv", "{take}.csv")
    place = bundle(tmp_path, text)
    assert takes(place) == ["m", "other"]
    assert read_capture(f"{place}:m").name == "trial:m"
    with pytest.raises(UnknownNameError, match="no take 'n'"):
        read_capture(f"{place}:n")
    with pytest.raises(FileError, match="Name one of them"):
        read_capture(place)


def test_a_variable_that_is_not_set_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CAPAR_TRIALS", raising=False)
    text = BASE.replace("m.csv", "${CAPAR_TRIALS}/m.csv")
    with pytest.raises(FileError, match="export CAPAR_TRIALS"):
        read_capture(bundle(tmp_path, text))
    monkeypatch.setenv("CAPAR_TRIALS", str(tmp_path))
    sources = read_capture(tmp_path).sources
    assert sources[1].path == "${CAPAR_TRIALS}/m.csv"


def test_a_stretch_of_lost_frames_gets_a_notice_with_its_seconds(tmp_path: Path) -> None:
    place = bundle(tmp_path)
    lines = (place / "m.csv").read_text().splitlines()
    lines[3:10] = [each[:-1] + "0" for each in lines[3:10]]
    (place / "m.csv").write_text("\n".join(lines))
    capture = read_capture(place)
    assert capture.sensor("right_hand").stream.lost.sum() == 7
    assert [each.message for each in capture.notices] == [
        "right_hand is lost from 0.04 s to 0.16 s"
    ]


SKELETON = """unit = "cm"
up = "z"
[files]
motion = "m.bvh"
[[sensors_from]]
file = "motion"
"""


def test_every_sensor_of_a_skeleton_is_declared_at_once(tmp_path: Path) -> None:
    text = (
        SKELETON
        + """bodies = "*"
shape = { capsules = "children", radius_m = 0.02 }
"""
    )
    capture: Capture = read_capture(bundle(tmp_path, text, "bvh"))
    assert [each.name for each in capture.sensors] == ["hand", "tip"]
    hand, tip = (each.shape for each in capture.sensors)
    assert hand is not None and tip is not None
    assert np.allclose(hand.size, [0.14, 0.04, 0.04], atol=2e-3)
    assert np.allclose(tip.size, [0.04, 0.04, 0.04], atol=2e-3)


def test_a_body_that_bears_the_name_of_another_is_called_what_it_is(tmp_path: Path) -> None:
    text = (
        SKELETON
        + """names = { tip = "L_Thumb" }
sides = { left = "L_" }
"""
    )
    capture: Capture = read_capture(bundle(tmp_path, text, "bvh"))
    assert [(sensor.name, sensor.side, sensor.end_effector) for sensor in capture.sensors] == [
        ("hand", "none", "hand"),
        ("l_thumb", "left", "thumb"),
    ]
    with pytest.raises(CaparError, match="tips"):
        read_capture(bundle(tmp_path, text.replace("{ tip", "{ tips"), "bvh"))


MANO = """
[files.hands]
path = "hands.npz"
unit = "m"
up = "z"
rate_hz = 30.0
arrays = [
  { positions = "right_joints", names = [
    "wrist", "index_1", "index_2", "index_3", "middle_1", "middle_2", "middle_3",
    "little_1", "little_2", "little_3", "ring_1", "ring_2", "ring_3",
    "thumb_1", "thumb_2", "thumb_3",
    "thumb_tip", "index_tip", "middle_tip", "ring_tip", "little_tip",
  ] },
  { body = "cup", positions = "cup_pos", quaternions = "cup_quat", order = "wxyz" },
]

[[sensor]]
name = "right_hand"
end_effector = "hand"
side = "right"
markers = ["wrist", "index_1", "middle_1", "ring_1", "little_1"]
shape = { capsules = [["wrist", "index_1"], ["wrist", "little_1"]], radius_m = 0.012 }

[[sensor]]
name = "right_thumb"
end_effector = "thumb"
side = "right"
markers = ["thumb_tip"]
shape = { sphere = 0.008 }

[[sensor]]
name = "right_index"
end_effector = "index"
side = "right"
markers = ["index_tip"]
shape = { sphere = 0.008 }

[[object]]
name = "cup"
tag = "mobile"
body = "cup"
shape = { box = [0.05, 0.05, 0.1] }
"""


def test_joints_of_a_hand_in_an_npz_file_are_one_hand_with_its_fingertips(tmp_path: Path) -> None:
    times = np.arange(0.0, 5.0, 1.0 / 30.0)

    def eased(start: float, end: float) -> np.ndarray:
        share = np.clip((times - start) / (end - start), 0.0, 1.0)
        return np.asarray(share**2 * (3.0 - 2.0 * share))

    lift = 0.2 * eased(2.0, 3.0)
    open_m = 0.03 * (1.0 - eased(1.0, 1.4))
    joints = np.zeros((len(times), 21, 3))
    joints[:, :, 1] = -0.02 - 0.08 * np.linspace(1.0, 0.0, 21)
    joints[:, :, 0] = 0.01 * (np.arange(21) % 5)
    joints[:, 16] = np.stack([-0.033 - open_m, 0 * times, 0 * times], axis=1)
    joints[:, 17] = np.stack([0.033 + open_m, 0 * times, 0 * times], axis=1)
    way = np.stack([0 * times, -0.3 * (1.0 - eased(0.0, 1.0)), lift + 0.5], axis=1)
    cup = np.stack([0 * times, 0 * times, lift + 0.5], axis=1)
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    joints = joints + way[:, None]
    np.savez(tmp_path / "hands.npz", right_joints=joints, cup_pos=cup, cup_quat=turns)
    (tmp_path / "capture.toml").write_text(MANO)
    (link,) = observe(tmp_path).links
    done = [(each.name, each.objects) for each in link.segments if each.name != "Touch"]
    assert (link.ee, done) == ("right_hand", [("Reach", ("cup",)), ("Lift", ("cup",))])
