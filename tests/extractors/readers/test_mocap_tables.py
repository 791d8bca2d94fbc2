"""Exports of Motive, Nexus and Tracker give back what was recorded, and are drafted as it was."""

import os
from pathlib import Path

import motion_files as samples
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.errors import CaparError, FileError
from capar.pipelines.observation import observe
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.drafting.draft import draft
from extractors.readers.names import parents_by_names
from extractors.readers.registry import read_recording

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[4] / "shared" / "data"))
LAYOUTS = DATA / "layouts"
ORDERS = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"]


def turned(path: Path, **options: str) -> float:
    """The largest angle between the orientations read and those written [deg]."""
    (body,) = read_recording(path, options=options).bodies.values()
    wanted = samples.TURNS.as_quat(scalar_first=True)
    return float(np.degrees(geometry.angle_between(body.orientations, wanted)).max())


@pytest.mark.parametrize("order", ORDERS)
def test_euler_angles_of_motive_turn_about_the_body_s_own_axes(order: str, tmp_path: Path) -> None:
    path = samples.write_motive(tmp_path / "m.csv", order=order)
    assert turned(path) < 1e-3
    assert read_recording(path).source.recorded_at == "2025-03-01T21:30:00.250"


angles = st.tuples(*[st.floats(-170.0, 170.0), st.floats(-80.0, 80.0), st.floats(-170.0, 170.0)])


@settings(max_examples=40, deadline=None)
@given(st.lists(angles, min_size=2, max_size=6), st.sampled_from(ORDERS))
def test_quaternions_and_angles_of_one_motion_are_read_alike(
    tmp_path_factory: pytest.TempPathFactory, triples: list[tuple[float, ...]], order: str
) -> None:
    turns = Rotation.from_euler(order, triples, degrees=True)
    folder = tmp_path_factory.mktemp("motive")
    read = []
    for kind, values in (("Quaternion", turns.as_quat()), (order, np.array(triples))):
        axes = "XYZW" if kind == "Quaternion" else order
        columns = len(axes) + 3
        head = [
            f"Format Version,1.24,Rotation Type,{kind},Length Units,Meters", "",
            ",Type" + ",Rigid Body" * columns, ",Name" + ",cup" * columns, ",ID" + ",1" * columns,
            "," + ",Rotation" * len(axes) + ",Position" * 3,
            "Frame,Time (Seconds)," + ",".join([*axes, *"XYZ"]),
        ]  # fmt: skip
        rows = [
            ",".join(map(repr, [n, n / 100.0, *map(float, row), 0.0, 0.0, 0.0]))
            for n, row in enumerate(values)
        ]
        path = folder / f"{kind}.csv"
        path.write_text("\n".join([*head, *rows]))
        read.append(read_recording(path).bodies["cup"].orientations)
    assert np.degrees(geometry.angle_between(*read)).max() < 1e-4
    assert (
        np.degrees(geometry.angle_between(read[0], turns.as_quat(scalar_first=True))).max() < 1e-4
    )


@pytest.mark.parametrize("rotations", ["helical", "euler_xyz", "quaternion"])
@pytest.mark.parametrize("unit", ["deg", "rad"])
def test_rotations_of_segments_are_read_as_they_are_stated(
    rotations: str, unit: str, tmp_path: Path
) -> None:
    if (rotations, unit) == ("quaternion", "deg"):
        unit = "rad"
    path = samples.write_segments(tmp_path / "s.csv", rotations=rotations, unit=unit)
    options = {"rotations": rotations} if rotations == "euler_xyz" else {}
    assert turned(path, **options) < 1e-3
    assert list(read_recording(path).bodies) == ["hand"]
    with pytest.raises(
        CaparError, match=r"no kind of rotations 'xyz'; there are: euler_xyz, helical"
    ):
        read_recording(path, options={"rotations": "xyz"})


MOTIVE = """\
Format Version,1.23,Take Name,a,Export Frame Rate,100,Rotation Type,Quaternion,Length Units,Meters

,,{kinds}
,,{names}
,,{ids}
,,{whats}
Frame,Time (Seconds),{axes}
0,0.00,{first}
1,0.01,{second}
2,0.02,{second}
"""


def motive(folder: Path, *things: tuple[str, str, int], empty: str = "") -> Path:
    """A file of Motive with bodies (7 columns) and markers (3), each at x = its number."""
    columns = [(kind, name, what, axis) for kind, name, width in things
               for what, axis in [*[("Rotation", each) for each in "XYZW"][: width - 3],
                                  *[("Position", each) for each in "XYZ"]]]  # fmt: skip
    numbers = {name: n for n, (_, name, _) in enumerate(things)}

    def row(lost: str) -> str:
        values = {"W": "1", "X": "", "Y": "0", "Z": "0"}
        cells = [
            "" if name == lost else str(numbers[name]) if (what, axis) == ("Position", "X")
            else values[axis] or "0"
            for _, name, what, axis in columns
        ]  # fmt: skip
        return ",".join(cells)

    kinds, names, whats, axes = (",".join(cells) for cells in zip(*columns, strict=True))
    path = folder / "take.csv"
    path.write_text(
        MOTIVE.format(
            kinds=kinds, names=names, whats=whats, axes=axes, first=row(""), second=row(empty),
            ids=",".join(["1"] * len(columns)),
        )
    )  # fmt: skip
    return path


def test_what_motive_lost_is_lost_and_what_was_seen_prevails_over_what_is_expected(
    tmp_path: Path,
) -> None:
    things = [
        ("Rigid Body", "Cup", 7), ("Rigid Body Marker", "Cup:Marker1", 3),
        ("Marker", "Cup:Marker1", 3), ("Marker", "Unlabeled 1043", 3),
    ]  # fmt: skip
    path = motive(tmp_path, *things, empty="Cup")
    recording = read_recording(path)
    assert list(recording.bodies["Cup"].lost) == [False, True, True]
    assert list(recording.markers) == ["Cup:Marker1", "Unlabeled 1043"]
    assert (recording.unit_m, recording.up) == (1.0, "y")
    path.write_text(path.read_text().replace("Rigid Body Marker,", "Bone,", 3).replace(
        "Length Units,Meters", "Length Units,Meters,Coordinate Space,Local"))  # fmt: skip
    with pytest.raises(FileError, match=r"relative to their parents.*Global"):
        read_recording(path)


@pytest.mark.parametrize(
    ("old", "new", "wrong"),
    [
        (",X,Y,Z,W", ",X,Y,Z,V", "three angles and Rotation Type 'Quaternion'"),
        (",X,Y,Z,W", ",X,X,Z,W", "two rigid body columns RotationX of 'Cup'"),
        ("Position,Position,Position", "Position,Position,Error", "lacks a column of the position"),
        ("Frame,Time", "Fr,Time", "lacks the rows of types"),
        ("Meters", "Meters,Total Exported Frames,9", "states 9 exported frames and holds 3"),
    ],
)
def test_a_damaged_export_of_motive_is_refused_with_what_is_wrong(
    old: str, new: str, wrong: str, tmp_path: Path
) -> None:
    path = motive(tmp_path, ("Rigid Body", "Cup", 7))
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(CaparError, match=wrong):
        read_recording(path)


def test_unlabeled_and_empty_trajectories_of_nexus_are_kept_apart(tmp_path: Path) -> None:
    path = tmp_path / "n.csv"
    path.write_text(
        "Trajectories;\n100;\n;;A:a;;;;;;\nFrame;Sub Frame;X;Y;Z;X;Y;Z;X'\n"
        ";;mm;mm;mm;mm;mm;mm;mm/s\n1;0;-391,888;1,5;2;;;;0\n2;0;-391,5;1,5;2;7;8;9;0\n"
    )
    recording = read_recording(path)
    assert list(recording.markers) == ["A:a", "unlabeled_2"]
    assert recording.markers["A:a"][0] == pytest.approx([-391.888, 1.5, 2.0])
    assert np.isnan(recording.markers["unlabeled_2"][0]).all()
    assert recording.times == pytest.approx([0.01, 0.02])
    path.write_text(path.read_text().replace("100;", "Hz;", 1))
    with pytest.raises(FileError, match=r"n\.csv:2: has no rate"):
        read_recording(path)
    path.write_text("Devices\n1000\n,,P\nFrame,Sub Frame,Fx\n,,N\n1,0,3\n")
    with pytest.raises(FileError, match="has Devices alone"):
        read_recording(path)


def test_bones_hang_on_each_other_by_their_names() -> None:
    bones = ["Hip", "Ab", "Chest", "Neck", "Head", "RShoulder", "RUArm", "RFArm", "RHand",
             "RThumb1", "LThigh", "LShin", "LFoot", "LToe"]  # fmt: skip
    parents = parents_by_names([*(f"Ann:{each}" for each in bones), "Cup"])
    assert parents["Ann:RHand"] == "Ann:RFArm"
    assert parents["Ann:RThumb1"] == "Ann:RHand"
    assert parents["Ann:LFoot"] == "Ann:LShin"
    assert parents["Ann:LToe"] == "Ann:LFoot"
    assert "Ann:Hip" not in parents
    assert "Cup" not in parents
    for name in parents:
        seen = [name]
        while seen[-1] in parents:
            seen.append(parents[seen[-1]])
            assert len(seen) <= len(bones)
        assert seen[-1] == "Ann:Hip"


def test_props_beside_a_skeleton_are_objects_and_their_markers_are_theirs(tmp_path: Path) -> None:
    things = [("Bone", f"Ann:{each}", 7) for each in ("Hip", "Chest", "RFArm", "RHand", "Head")]
    things += [("Rigid Body", "Cup", 7), *(("Marker", f"Cup:Marker{n}", 3) for n in range(3))]
    text = draft([read_recording(motive(tmp_path, *things))], tmp_path, "take")
    assert text.count("[[sensor]]") == 2
    (prop,) = [each for each in text.split("\n\n") if each.startswith('[[object]]\nname = "cup')]
    assert 'body = "Cup"' in prop
    assert "# of bodies that are in the file too: Cup:Marker0, Cup:Marker1, Cup:Marker2" in text


def test_a_hand_of_one_marker_is_a_point_that_does_not_turn(tmp_path: Path) -> None:
    samples.write_nexus(tmp_path / "n.csv")
    text = (tmp_path / "n.csv").read_text()
    (tmp_path / "n.csv").write_text(text.replace(",a,", ",A:R_Hand,"))
    drafted = draft([read_recording(tmp_path / "n.csv")], tmp_path, "n")
    assert 'markers = ["A:R_Hand"]' in drafted
    (tmp_path / "capture.toml").write_text(drafted)
    stream = read_capture(tmp_path).sensor("right_hand").stream
    assert np.allclose(stream.positions, samples.markers()[:, 0], atol=1e-6)
    assert np.allclose(stream.orientations, [1.0, 0.0, 0.0, 0.0])


@pytest.mark.skipif(not LAYOUTS.exists(), reason=f"no recordings at {LAYOUTS}")
@pytest.mark.parametrize(("name", "steps"), [
    ("motive.csv", ["Reach", "Lift"]), ("nexus.csv", ["Reach", "Touch", "Lift"]),
])  # fmt: skip
def test_a_draft_as_it_is_says_what_was_done(name: str, steps: list[str], tmp_path: Path) -> None:
    text = draft([read_recording(LAYOUTS / name)], tmp_path, name.partition(".")[0])
    (tmp_path / "capture.toml").write_text(text)
    seen = observe(tmp_path)
    assert [each.name for each in seen.segments] == steps
    assert {each.ee for each in seen.segments} == {"right_hand"}


@pytest.mark.skipif(not LAYOUTS.exists(), reason=f"no recordings at {LAYOUTS}")
def test_runs_of_spaces_part_the_cells_of_a_trc() -> None:
    recording = read_recording(LAYOUTS / "spaces.trc")
    assert list(recording.markers) == ["R.Hand", "L.Hand", "Box1", "Box2", "Box3", "Box4"]
