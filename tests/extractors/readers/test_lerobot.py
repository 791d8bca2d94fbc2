"""Episodes of a LeRobot data set are captures: one mapping says which features are poses."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import motion_files as samples
import numpy as np
import pyarrow.parquet as pq
import pytest
from bundles import DRINKING
from commands import capar as command
from hypothesis import given
from hypothesis import strategies as st
from robot_data import demo_data, motion_data
from scipy.spatial.transform import Rotation
from shell import refused, run

import capar
from capar.model import geometry
from capar.model.errors import CaparError
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.bundle.patterns import find_captures
from extractors.readers.formats.npz import Arrays
from extractors.readers.registry import read_recording

NAMES = ["x", "y", "z", "qx", "qy", "qz", "qw", "gripper"]
STATE = np.column_stack([samples.PLACES, samples.TURNS.as_quat(), np.ones(samples.FRAMES)])
MAPPING = """unit = "m"
up = "z"
[files.robot]
path = "."
[[files.robot.arrays]]
body = "hand"
positions = "observation.state[0:3]"
quaternions = "observation.state[qx,qy,qz,qw]"
order = "xyzw"
[[sensor]]
name = "hand"
end_effector = "hand"
body = "hand"
"""


def episodes(folder: Path, *, count: int = 3, **how: Any) -> Path:
    """A data set in which episode n is n decimetres higher, with a mapping beside it."""
    lifted = [STATE + np.eye(8)[2] * 0.1 * n for n in range(count)]
    states = [{"observation.state": each} for each in lifted]
    motion_data(folder, states, names={"observation.state": NAMES}, **how)
    (folder / "capture.toml").write_text(MAPPING)
    return folder


def demo_as_data(folder: Path) -> Path:
    """The shipped capture as two episodes, with a mapping of all its bodies."""
    others = demo_data(folder, count=2)
    arrays = f"""[files.motion]
path = "."
[[files.motion.arrays]]
body = "right_hand"
positions = "observation.state[x,y,z]"
rotations = "observation.state[-3:]"
order = "helical"
[[files.motion.arrays]]
body = "mug"
positions = "observation.cup[:3]"
quaternions = "observation.cup[3:]"
order = "xyzw"
[[files.motion.arrays]]
names = {json.dumps(others)}
positions = "observation.others[0:3]"
quaternions = "observation.others[3:7]"
order = "xyzw"
"""
    text = (DRINKING / "capture.toml").read_text()
    text = re.sub(r'^name = ".*"\n', "", text, count=1, flags=re.MULTILINE)
    (folder / "capture.toml").write_text(text.replace('[files]\nmotion = "motion.csv"', arrays))
    for mesh in DRINKING.glob("*.obj"):
        shutil.copy(mesh, folder)
    return folder


def test_a_motion_is_seen_in_a_data_set_as_in_a_table(tmp_path: Path) -> None:
    robot = demo_as_data(tmp_path / "robot")
    ours, theirs = read_capture(f"{robot}:1"), read_capture(DRINKING)
    assert ours.name == "robot:1"
    for name, body in theirs.bodies.items():
        own = ours.bodies[name].stream
        assert np.allclose(own.times, body.stream.times, atol=1e-5)
        assert np.allclose(own.positions, body.stream.positions, atol=1e-6, equal_nan=True)
        apart = geometry.angle_between(own.orientations, body.stream.orientations)
        assert np.nanmax(np.degrees(apart)) < 1e-3
    seen = capar.observe(f"{robot}:1")
    assert [
        [(each.name, each.objects, each.first, each.last) for each in link.segments]
        for link in seen.links
    ] == [
        [(each.name, each.objects, each.first, each.last) for each in link.segments]
        for link in capar.observe(DRINKING).links
    ]


def test_labels_of_all_episodes_go_into_a_copy_of_the_data_set_they_are_read_from(
    tmp_path: Path,
) -> None:
    robot = demo_as_data(tmp_path / "robot")
    done = run("label", f"{robot}:*", "--format", "lerobot", "-o", tmp_path / "labelled")
    assert "subtasks of 2 episodes" in done
    (path,) = (tmp_path / "labelled" / "data").rglob("*.parquet")
    rows = pq.read_table(path).to_pylist()
    for number, place in enumerate(find_captures([f"{robot}:*"])):
        own = next(row for row in rows if row["episode_index"] == number)
        wanted = [each for link in capar.observe(place).links for each in link.segments]
        starts = [each["timestamp"] for each in own["language_persistent"]]
        assert starts == pytest.approx([each.start_s for each in wanted], abs=1.0 / 100)
    before, after = read_capture(f"{robot}:1"), read_capture(f"{tmp_path}/labelled:1")
    assert before.sources[1:] == after.sources[1:]
    toml = robot / "capture.toml"
    toml.write_text(f"from_s = 0.5\n{toml.read_text()}")
    words = ("label", f"{robot}:*", "--format", "lerobot", "-o", tmp_path / "late")
    assert "labels count from an episode's first frame" in refused(*words)


ORDERS = {
    "xyzw": samples.TURNS.as_quat(),
    "wxyz": samples.TURNS.as_quat(scalar_first=True),
    "helical": samples.TURNS.as_rotvec(),
    "euler_xyz": (tilted := Rotation.from_euler("x", 0.3) * samples.TURNS).as_euler("XYZ"),
    "rpy": tilted.as_euler("xyz"),
}


@pytest.mark.parametrize("order", ORDERS)
def test_orientations_are_quaternions_or_three_numbers(order: str, tmp_path: Path) -> None:
    both = np.column_stack([samples.PLACES, ORDERS[order]])
    robot = motion_data(tmp_path / "robot", [{"pose": both}])
    np.savez(tmp_path / "m.npz", pose=both)
    key = "quaternions" if order in {"xyzw", "wxyz"} else "rotations"
    group = {"body": "hand", "positions": "pose[0:3]", key: "pose[3:]", "order": order}
    turns = tilted if order in {"euler_xyz", "rpy"} else samples.TURNS
    for path, clock in ((robot, {}), (tmp_path / "m.npz", {"rate_hz": samples.RATE})):
        body = read_recording(path, options={"arrays": [group], **clock}).bodies["hand"]
        assert np.allclose(body.times, samples.TIMES, atol=1e-6)
        assert np.allclose(body.positions, samples.PLACES, atol=1e-6)
        apart = geometry.angle_between(body.orientations, turns.as_quat(scalar_first=True))
        assert np.degrees(apart).max() < 1e-3


PARTS = st.lists(
    st.one_of(
        st.integers(-9, 9),
        st.tuples(*[st.none() | st.integers(-9, 9)] * 2).map(lambda each: slice(*each)),
    ),
    min_size=1,
    max_size=3,
)


@given(width=st.integers(1, 8), parts=PARTS)
def test_a_part_of_an_array_is_what_python_takes_or_is_refused(
    width: int, parts: list[int | slice]
) -> None:
    array = np.arange(2.0 * width).reshape(2, width)
    texts, wanted, out = [], [], False
    for part in parts:
        if isinstance(part, int):
            texts.append(str(part))
            out |= not -width <= part < width
            wanted += [] if out else [part % width]
        else:
            bounds = [part.start, part.stop]
            texts.append(":".join("" if each is None else str(each) for each in bounds))
            out |= any(each is not None and not -width <= each <= width for each in bounds)
            out |= not range(width)[part]
            wanted += range(width)[part]
    arrays, text = Arrays(Path("m"), "array", {"a": array}), f"a[{', '.join(texts)}]"
    if out:
        with pytest.raises(CaparError, match="out of range: a has"):
            arrays.part(text)
    else:
        assert np.array_equal(arrays.part(text), array[:, wanted])


def test_episodes_are_takes_by_number_wherever_their_file_is(tmp_path: Path) -> None:
    robot = episodes(tmp_path / "robot", count=11)
    assert len(list((robot / "data").rglob("*.parquet"))) == 6
    found = find_captures([f"{robot}:*"])
    assert found == find_captures([str(robot)]) == [f"{robot}:{n}" for n in range(11)]
    for number, place in enumerate(found):
        lifted = read_capture(place).sensors[0].stream.positions[0] - samples.PLACES[0]
        assert lifted == pytest.approx([0.0, 0.0, 0.1 * number], abs=1e-6)
    elsewhere = tmp_path / "mine"
    elsewhere.mkdir()
    text = MAPPING.replace('path = "."', f'path = "{robot}"')
    (elsewhere / "capture.toml").write_text(text)
    assert read_capture(f"{elsewhere}:10").name == "mine:10"
    chosen = text.replace("[files.robot]", 'takes = ["10", "3"]\n[files.robot]\nepisode = "{take}"')
    (elsewhere / "capture.toml").write_text(chosen)
    assert find_captures([f"{elsewhere}:*"]) == [f"{elsewhere}:10", f"{elsewhere}:3"]


def test_an_observation_in_a_store_is_of_the_episode_that_its_name_ends_with(
    tmp_path: Path,
) -> None:
    from extractors.readers.bundle.capture_toml import place_of

    robot = episodes(tmp_path / "robot_10", count=11)
    for number in (0, 1, 10):
        assert place_of(robot, f"robot_10:{number}") == f"{robot}:{number}"


def test_a_source_changes_with_its_own_episode_only(tmp_path: Path) -> None:
    robot = episodes(tmp_path / "robot")
    before = [read_capture(f"{robot}:{n}").sources for n in range(2)]
    path = robot / "data" / "chunk-000" / "file-000.parquet"
    table = pq.read_table(path)
    lower = np.array(table["observation.state"].to_pylist(), np.float32)
    lower[-1, 2] -= 0.001
    column = table.column_names.index("observation.state")
    values = [*lower]
    pq.write_table(table.set_column(column, "observation.state", [values]), path)
    assert read_capture(f"{robot}:0").sources == before[0]
    assert read_capture(f"{robot}:1").sources != before[1]


def told(*words: object, folder: Path) -> str:
    done = command(*words, cwd=folder)
    assert done.returncode == 2, done.stderr
    return done.stderr


def test_what_a_data_set_without_a_mapping_says_to_write_is_read(tmp_path: Path) -> None:
    robot = episodes(tmp_path / "robot")
    (robot / "capture.toml").unlink()
    for words in (("observe", robot), ("observe", f"{robot}:*"), ("new-capture", robot),
                  ("inspect", robot)):  # fmt: skip
        said = told(*words, folder=tmp_path)
        assert "observation.state float32 (8) [x,y,z,qx,qy,qz,qw,gripper]" in said
        assert "observation.image video (480, 640, 3)" in said
    assert "timestamp" not in said
    (robot / "capture.toml").write_text(said.partition("like this:")[2])
    assert read_capture(f"{robot}:2").sensors[0].name == "gripper"


@pytest.mark.parametrize(
    ("names", "order"),
    [
        ("gripper,eef.x,eef.y,eef.z,roll,pitch,yaw,gripper", "rpy"),
        ("x,y,z,rx,ry,rz", "helical"),
        ("", "helical"),
        ("time,x,y,z", ""),
    ],
)
def test_what_it_says_to_write_goes_by_the_names_of_components(
    names: str, order: str, tmp_path: Path
) -> None:
    before = len(names.split("x,", maxsplit=1)[0].split(",")) - 1
    columns = [np.ones((samples.FRAMES, before)), samples.PLACES]
    columns += [ORDERS["rpy" if order == "rpy" else "helical"]] if order else []
    columns += [np.ones((samples.FRAMES, 1))] if order == "rpy" else []
    values = {"observation.pose": np.column_stack(columns), "action": np.ones((12, 9))}
    stated = {"observation.pose": names.split(",") if names else None}
    robot = motion_data(tmp_path / "robot", [values], names=stated)
    said = told("observe", robot, folder=tmp_path)
    (robot / "capture.toml").write_text(said.partition("like this:")[2])
    body = read_capture(f"{robot}:0").sensors[0].stream
    assert np.allclose(body.positions, samples.PLACES, atol=1e-6)
    turns = {"rpy": tilted, "helical": samples.TURNS, "": Rotation.identity(12)}[order]
    apart = geometry.angle_between(body.orientations, turns.as_quat(scalar_first=True))
    assert np.degrees(apart).max() < 1e-3


def test_a_mistake_is_named_with_what_would_be_right(tmp_path: Path) -> None:
    def mapped(right: str, wrong: str) -> Any:
        return lambda robot: (robot / "capture.toml").write_text(MAPPING.replace(right, wrong))

    def without(place: str) -> Any:
        return lambda robot: (robot / place).unlink()

    def info(**changed: Any) -> Any:
        def change(robot: Path) -> None:
            path = robot / "meta" / "info.json"
            path.write_text(json.dumps(json.loads(path.read_text()) | changed))

        return change

    video = {"observation.image": {"dtype": "video", "shape": [480, 640, 3], "names": None}}
    wide = {"observation.state": {"dtype": "float32", "shape": [9], "names": None}}
    first = "data/chunk-000/file-000.parquet"
    cases = [
        (mapped("state[0:3]", "sate[0:3]"), "no feature 'observation.sate'; .*'observation.state'"),
        (mapped("[0:3]", "[6:9]"), r"state\[6:9\] is out of range: observation.state has 8 comp"),
        (mapped("[0:3]", "[x,y,height]"), "no component of observation.state 'height'; there are"),
        (mapped("[0:3]", "[0:3"), r"a part is named like observation.state\[0:3\]"),
        (mapped("[0:3]", "[0:2]"), r"observation.state\[0:2\] is float32 \(12, 2\) where"),
        (mapped("state[0:3]", "image"), r"image video \(480, 640, 3\) holds no numbers"),
        (mapped('quaternions = "observation.state[qx,qy,qz,qw]"', ""),
         r"capture.toml:\d+: 'hand' is a point, .* Write markers = \[\"hand\"\] in place of body"),
        (mapped('"xyzw"', '"rpy"'), "no order of quaternions 'rpy'; there are: wxyz, xyzw"),
        (mapped("up =", 'takes = ["0"]\nup ='), "holds 3 episodes, and none is named"),
        (mapped('"."', '"."\nepisode = 3'), "episode = 3 is not a text in quotes"),
        (mapped('"."', '"nowhere"'), "nowhere: no such file. The folder .* holds: .* meta"),
        (mapped('path = "."', 'path = "."\nepisode = "7"'), "no episode '7'; there are: 0, 1, 2"),
        (info(codebase_version="v2.1"), "of v2.1; v3.0 is read. .*convert_dataset_v21_to_v30"),
        (info(codebase_version="v4.0"), "of v4.0; v3.0 is read.$"),
        (info(features=video), "no feature 'observation.state'; there are: observation.image"),
        (info(features=wide), r"has 96 numbers in 12 frames of observation.state float32 \(9\)"),
        (info(features={**wide, "mug": wide["observation.state"]}), "has 96 numbers"),
        (without(first), "file-000.parquet: no such file. The folder .* holds: file-001.parquet"),
        (without("meta/episodes/chunk-000/file-000.parquet"), "meta/episodes: lists no episode"),
        (lambda robot: (robot / first).write_bytes(b"PAR1"), "is a damaged lerobot file"),
        (lambda robot: (robot / "meta/info.json").write_text("{"), "is a damaged lerobot file"),
        (lambda robot: shutil.copy(robot / "data/chunk-000/file-001.parquet", robot / first),
         "has 0 frames of episode 0; meta/episodes states 12"),
    ]  # fmt: skip
    for number, (spoil, message) in enumerate(cases):
        robot = episodes(tmp_path / str(number))
        spoil(robot)
        stated = "\nepisode" in (robot / "capture.toml").read_text()
        place = robot if stated else f"{robot}:0"
        said = " ".join(told("observe", place, folder=tmp_path).split())
        assert re.search(message, said), f"{message}: {said}"
    assert "no take '9'; there are: 0, 1, 2" in told("observe", f"{robot}:9", folder=tmp_path)
    joints = {"dtype": "float32", "shape": [6], "names": ["shoulder_pan.pos", *"bcdef"]}
    for number, features in enumerate((video, {**video, "observation.state": joints})):
        films = episodes(tmp_path / f"films_{number}")
        info(features=features)(films)
        (films / "capture.toml").unlink()
        said = told("observe", films, folder=tmp_path)
        assert "seems to hold no poses" in said
        assert "observation.image video (480, 640, 3)" in said
        assert ("observation.state float32 (6) [shoulder_pan.pos,b" in said) == (number == 1)


def test_without_pyarrow_the_message_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = episodes(tmp_path / "robot")
    monkeypatch.setitem(__import__("sys").modules, "pyarrow", None)
    with pytest.raises(CaparError, match=r"pip install 'capar\[labels\]'"):
        read_capture(f"{robot}:0")


@pytest.mark.skipif(
    "CAPAR_LEROBOT" not in os.environ,
    reason="CAPAR_LEROBOT names the Python of an environment with the package lerobot 0.6 or newer",
)
def test_a_data_set_that_lerobot_wrote_is_read(tmp_path: Path) -> None:
    script = Path(__file__).parents[2] / "lerobot_data.py"
    command = [os.environ["CAPAR_LEROBOT"], script, "write", tmp_path / "robot", "20", "30"]
    environment = os.environ | {"HF_HUB_OFFLINE": "1"}
    subprocess.run(list(map(str, command)), env=environment, check=True)
    group = {"body": "tip", "positions": "observation.state[a,b,c]"}
    options = {"arrays": [group], "episode": "1"}
    recording = read_recording(tmp_path / "robot", options=options)
    frames = np.arange(30.0)
    assert recording.times == pytest.approx(frames / 30.0)
    still = np.zeros(30)
    assert np.array_equal(recording.markers["tip"], np.stack([frames, still + 0.5, still], axis=1))
