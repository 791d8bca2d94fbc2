"""Demonstrations of robomimic and robosuite are read as MuJoCo places them, and nothing else is."""

import json
from pathlib import Path

import demonstration_files as samples
import h5py
import numpy as np
import pytest
import trimesh
from commands import capar as command

import capar
from capar.model.capture import TagType
from capar.model.errors import CaparError
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.bundle.patterns import find_captures
from extractors.readers.formats.demonstrations import ASSETS

MESH = '<mesh name="brick" file="{}"/>'
GEOM = '<geom type="mesh" mesh="brick"/>'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return samples.write(tmp_path / "carry.hdf5")


def test_a_demonstration_is_observed_without_a_capture_toml(file: Path) -> None:
    seen = capar.observe(f"{file}:demo_1")
    names = [each.name for each in seen.links[0].segments]
    assert seen.capture == "carry:demo_1"
    assert names == [
        "Reach", "Touch", "Lift", "Carry", "Lower", "TouchWith", "Withdraw", "Rest",
    ]  # fmt: skip
    rows = list(capar.label([seen], per_frame=True))
    held = [row["time_s"] for row in rows if row["holds"] == ["cube"]]
    assert abs(held[0] - samples.GRASP_S) < 0.11 and abs(held[-1] - samples.RELEASE_S) < 0.11


def test_a_gripper_holds_a_thing_while_both_jaws_touch_it(tmp_path: Path) -> None:
    table = samples.states(early_s=0.3)
    seen = capar.observe(samples.write(tmp_path / "carry.hdf5", demos=1, table=table))
    (span,) = [each for each in capar.label([seen]) if each["row"] == "possession"]
    assert span["start_s"] == pytest.approx(samples.GRASP_S, abs=0.11)
    assert span["end_s"] == pytest.approx(samples.RELEASE_S, abs=0.11)


def test_what_a_resting_gripper_lets_fall_is_dropped_though_few_frames_show_it(
    tmp_path: Path,
) -> None:
    table = samples.states(dropped=True)
    seen = capar.observe(samples.write(tmp_path / "drop.hdf5", demos=1, table=table))
    (drop,) = [each for each in seen.links[0].segments if each.name == "Drop"]
    assert drop.objects == ("cube",)
    assert drop.start_s == pytest.approx(samples.RELEASE_S, abs=0.11)


def test_motors_tell_the_gripper_and_joints_the_parts_and_what_is_only_seen_is_left_out(
    file: Path,
) -> None:
    capture = read_capture(f"{file}:demo_0")
    palm, *fingers = capture.sensors
    assert (palm.name, palm.side) == ("left_gripper", "left")
    assert [each.part_of for each in fingers] == ["left_gripper"] * 2
    tags = {each.name: each.tag for each in capture.objects}
    fixed, mobile = TagType.FIXED, TagType.MOBILE
    still = dict.fromkeys(("floor", "table", "chest"), fixed)
    assert tags == still | {"lid": mobile, "cube": mobile}
    assert capture.bodies["lid"].part_of == "chest"
    assert capture.bodies["cube"].shape.size == pytest.approx([0.04] * 3)
    floor = capture.bodies["floor"]
    assert floor.stream.positions[0, 2] + floor.shape.bounds[1, 2] == pytest.approx(0.0)


def test_its_demonstrations_are_takes_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    file = samples.write(tmp_path / "many.hdf5", demos=11)
    found = find_captures([f"{file}:*"])
    assert found == find_captures([str(file)]) == [f"{file}:demo_{n}" for n in range(11)]
    assert find_captures([f"{file}:demo_1*"]) == [f"{file}:demo_1", f"{file}:demo_10"]
    alone = samples.write(tmp_path / "one.hdf5", demos=1)
    assert read_capture(alone).name == "one"


def test_a_drafted_capture_toml_reads_as_the_file_does(file: Path, tmp_path: Path) -> None:
    done = command("new-capture", file, "-o", tmp_path / "mine", cwd=tmp_path)
    assert done.returncode == 0 and "130 frames at 20 Hz; sensors: 3, objects: 5" in done.stdout
    mine, own = read_capture(f"{tmp_path}/mine:demo_2"), read_capture(f"{file}:demo_2")
    assert [each.name for each in mine.objects] == [each.name for each in own.objects]
    assert np.array_equal(mine.sensors[0].stream.positions, own.sensors[0].stream.positions)
    assert mine.bodies["cube"].shape.digest == own.bodies["cube"].shape.digest


def test_the_digest_of_a_demonstration_is_not_that_of_its_neighbours(file: Path) -> None:
    before = read_capture(f"{file}:demo_0").sources
    with h5py.File(file, "a") as data:
        data["data/demo_1/states"][0, 0] = -1.0
    assert read_capture(f"{file}:demo_0").sources == before
    assert read_capture(f"{file}:demo_1").sources != before


def test_time_that_stands_still_is_that_of_the_stated_rate(tmp_path: Path) -> None:
    table = samples.states()
    table[:, 0] = 0.0
    file = samples.write(tmp_path / "carry.hdf5", table=table)
    assert read_capture(f"{file}:demo_0").rate_hz == pytest.approx(samples.HZ)


@pytest.mark.parametrize("where", ["beside", "assets"])
def test_a_mesh_is_found_by_the_end_of_its_path(
    where: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / ("assets" if where == "assets" else "")
    (folder / "objects").mkdir(parents=True)
    trimesh.creation.box((0.1, 0.04, 0.04)).export(folder / "objects" / "brick.stl")
    monkeypatch.setenv(ASSETS, str(tmp_path / "assets"))
    stated = MESH.format("/home/them/models/assets/objects/brick.stl")
    file = samples.write(tmp_path / "carry.hdf5", asset=stated, cube=GEOM)
    assert read_capture(f"{file}:demo_0").bodies["cube"].shape.size[0] == pytest.approx(0.1)


def told(place: object) -> str:
    with pytest.raises(CaparError) as caught:
        read_capture(str(place))
    return str(caught.value)


def test_a_mesh_elsewhere_is_not_read_even_where_its_path_is_right(tmp_path: Path) -> None:
    secret = tmp_path / "elsewhere" / "brick.stl"
    secret.parent.mkdir()
    trimesh.creation.box().export(secret)
    (tmp_path / "mine").mkdir()
    for path in (str(secret), f"../{secret.parent.name}/brick.stl"):
        file = samples.write(tmp_path / "mine" / "carry.hdf5", asset=MESH.format(path), cube=GEOM)
        message = told(f"{file}:demo_0")
        assert "brick.stl" in message and ASSETS in message
    (tmp_path / "mine" / "brick.stl").symlink_to(secret)
    assert ASSETS in told(f"{file}:demo_0")


@pytest.mark.parametrize(
    "asset",
    [
        '<include file="/etc/hostname"/>',
        '<model name="other" file="/etc/hostname"/>',
        '</asset><extension><plugin plugin="mujoco.sdf.bolt"/></extension><asset>',
        '</asset><worldbody><replicate count="1000000000"><geom size="1"/></replicate></worldbody>'
        "<asset>",
    ],
)
def test_a_model_that_asks_for_other_files_or_no_end_of_bodies_is_refused(
    asset: str, tmp_path: Path
) -> None:
    file = samples.write(tmp_path / "carry.hdf5", asset=asset)
    assert "has a model with <" in told(f"{file}:demo_0")


def test_states_of_other_files_are_not_read(tmp_path: Path) -> None:
    other, file = samples.write(tmp_path / "b.hdf5"), samples.write(tmp_path / "a.hdf5")
    with h5py.File(file, "a") as data:
        del data["data/demo_0/states"]
        data["data/demo_0/states"] = h5py.ExternalLink(str(other), "data/demo_0/states")
    assert "by a link, which is not followed" in told(f"{file}:demo_0")


def test_a_mistake_in_a_file_is_named_with_what_would_be_right(tmp_path: Path) -> None:
    wide = np.hstack([samples.states(), np.zeros((130, 1))])
    doctype = "<!DOCTYPE x [<!ENTITY a 'b'>]>" + samples.MODEL
    idle = samples.MODEL.replace("<actuator>", "<!--").replace("</actuator>", "-->")
    cases = {
        "no attribute 'model_file'": {"model": None},
        "has 27 numbers a state, and its model 26": {"table": wide},
        "is no plain XML": {"model": "<mujoco>"},
        "DTDForbidden": {"model": doctype},
        "no motor that moves a joint": {"model": idle},
        "no take 'demo_9'; there are: demo_0": {"take": "demo_9"},
        "has several takes": {"take": ""},
    }  # fmt: skip
    for message, how in cases.items():
        take = how.pop("take", "demo_0")
        file = samples.write(tmp_path / "bad.hdf5", **how)
        done = command("observe", f"{file}:{take}" if take else file, cwd=tmp_path)
        assert done.returncode == 2 and message in " ".join(done.stderr.split()), message
    plain = tmp_path / "plain.hdf5"
    with h5py.File(plain, "w") as data:
        data["x"] = np.zeros(3)
    assert "without a group 'data'" in told(plain)
    cut = tmp_path / "cut.hdf5"
    cut.write_bytes(samples.write(tmp_path / "a.hdf5").read_bytes()[:3000])
    assert "is damaged" in told(cut)


def test_labels_of_a_demonstration_are_by_its_frames(file: Path, tmp_path: Path) -> None:
    out = tmp_path / "labels.json"
    done = command(
        "label", f"{file}:demo_0", "-o", out, "--format", "json", "--per-frame", cwd=tmp_path
    )
    assert done.returncode == 0
    rows = json.loads(out.read_text())
    assert len(rows) == 130 and {row["effector"] for row in rows} == {"left_gripper"}
