"""What is read but doubtful gets a notice; what contradicts itself is refused with both sides."""

from pathlib import Path

import motion_files as samples
import numpy as np
import pytest
import trimesh

from capar.model.errors import CaptureError, FileError, UnknownNameError
from extractors.readers.bundle.capture_toml import files_of, read_capture
from extractors.readers.registry import read_recording

TRIAL = """unit = "m"
up = "z"
[files]
motion = "m.csv"
[[sensor]]
name = "right_hand"
end_effector = "hand"
body = "hand"
shape = { mesh = "hand.stl" }
"""


def notices(folder: Path, text: str = TRIAL, *, closed: bool = True) -> dict[str, str]:
    """The codes and messages of a capture's notices."""
    samples.write_csv(folder / "m.csv")
    mesh = trimesh.creation.box(extents=[0.1, 0.1, 0.1])
    if not closed:
        mesh.update_faces(np.arange(len(mesh.faces)) > 1)
    mesh.export(folder / "hand.stl")
    (folder / "capture.toml").write_text(text)
    return {each.code: each.message for each in read_capture(folder).notices}


def test_a_mesh_with_a_hole_is_told_with_its_body_and_its_open_edges(tmp_path: Path) -> None:
    said = notices(tmp_path, closed=False)
    message = "right_hand: the mesh hand.stl is not closed, it has 4 open edges"
    assert said == {"mesh-not-closed": message}


@pytest.mark.parametrize(("kind", "near"), [("hnd", "hand"), ("fot", "foot"), ("Head", "head")])
def test_an_end_effector_that_is_almost_a_known_one_gets_a_notice(
    kind: str, near: str, tmp_path: Path
) -> None:
    said = notices(tmp_path, TRIAL.replace('"hand"\nbody', f'"{kind}"\nbody'))
    assert f"did you mean '{near}'?" in said["end-effector-unknown"]


@pytest.mark.parametrize(("rate_hz", "doubtful"), [(500, True), (5, True), (100, False)])
def test_a_rate_far_from_every_recorded_one_gets_a_notice(
    rate_hz: int, doubtful: bool, tmp_path: Path
) -> None:
    said = notices(tmp_path, f"rate_hz = {rate_hz}\n{TRIAL}")
    assert ("rate-mistyped" in said) == doubtful
    if doubtful:
        assert "the files have 50 frames a second" in said["rate-mistyped"]


@pytest.mark.parametrize("kind", ["csv", "npz"])
def test_a_rate_that_contradicts_time_stamps_is_refused_with_both(
    kind: str, tmp_path: Path
) -> None:
    if kind == "csv":
        path, options = samples.write_csv(tmp_path / "m.csv"), {}
    else:
        path = tmp_path / "m.npz"
        turns = samples.TURNS.as_quat()[:, None]
        np.savez(path, t=samples.TIMES, names=["hand"], p=samples.PLACES[:, None], q=turns)
        options = {"time": "t", "arrays": samples.NPZ["arrays"]}
    assert len(read_recording(path, options={**options, "rate_hz": samples.RATE}).bodies) == 1
    with pytest.raises(CaptureError, match="rate_hz = 100, but the time stamps have 50 frames"):
        read_recording(path, options={**options, "rate_hz": 100.0})


def trc(folder: Path, *changes: tuple[str, str]) -> Path:
    """A TRC file with texts replaced."""
    path = samples.write_trc(folder / "m.trc")
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


@pytest.mark.parametrize("changes", [[("\t", ",")], [(".", ",")]], ids=["commas", "decimal commas"])
def test_a_trc_with_commas_reads_as_the_one_with_tabs_and_points(
    changes: list[tuple[str, str]], tmp_path: Path
) -> None:
    expected = read_recording(trc(tmp_path))
    found = read_recording(trc(tmp_path, ("Z4\n", "Z4\n\t\t\n"), *changes))
    assert list(found.markers) == list(samples.NAMES)
    assert np.array_equal(found.marker_times, expected.marker_times)
    for name in samples.NAMES:
        assert np.array_equal(found.markers[name], expected.markers[name])


def test_a_trc_whose_header_is_wrong_is_told_in_what(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"m\.trc:4: names a marker twice: a\. Rename one"):
        read_recording(trc(tmp_path, ("\tb\t", "\ta\t")))
    with pytest.raises(UnknownNameError, match=r"m\.trc:2: no header cell 'Units'.*'Unit'"):
        read_recording(trc(tmp_path, ("Units", "Unit")))


def test_a_trc_whose_header_contradicts_its_times_gets_a_notice(tmp_path: Path) -> None:
    assert not read_recording(trc(tmp_path)).notices
    (notice,) = read_recording(trc(tmp_path, ("50.0\t50.0", "250.0\t250.0"))).notices
    assert notice.message.startswith("the header states 250 frames a second, the time stamps 50")


def test_a_trc_with_fewer_rows_than_its_header_states_is_read_with_a_notice(
    tmp_path: Path,
) -> None:
    recording = read_recording(trc(tmp_path, (f"\t{samples.FRAMES}\t4", "\t900\t4")))
    assert len(recording.marker_times) == samples.FRAMES
    (notice,) = recording.notices
    assert notice.message == "the header states 900 frames, the file holds 12; was it cut short?"


SKELETON = """unit = "m"
up = "z"
[files.motion]
path = "m.npz"
fps = "fps"
arrays = [{ names = "names", positions = "pos", quaternions = "quat", order = "wxyz" }]
[files.motion.parents]
finger = "wrist"
[[sensor]]
name = "right_hand"
end_effector = "hand"
body = "wrist"
shape = { capsules = "children", radius_m = 0.02 }
"""


@pytest.mark.parametrize("apart_m", [0.0, 0.2])
def test_a_bone_that_changes_its_length_is_no_bone(tmp_path: Path, apart_m: float) -> None:
    frames = 60
    away = 0.1 + apart_m * np.linspace(0.0, 1.0, frames)
    places = np.zeros((frames, 2, 3))
    places[:, 1, 0] = away
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 2, 1))
    np.savez(
        tmp_path / "m.npz", names=np.array(["wrist", "finger"]), pos=places, quat=turns, fps=30.0
    )
    (tmp_path / "capture.toml").write_text(SKELETON)
    told = {each.code: each for each in read_capture(tmp_path).notices}
    assert ("bone-stretches" in told) == bool(apart_m)
    if apart_m:
        assert told["bone-stretches"].bodies == ("right_hand", "wrist", "finger")
        assert told["bone-stretches"]["longest_m"] == pytest.approx(0.29)


@pytest.mark.parametrize(
    ("places", "wrong"),
    [
        ('finger = "left_fingers"', ""),
        ('fingre = "left_fingers"', "no body 'fingre'.*'finger'"),
        ('finger = "left_fingre"', "no place on the body 'left_fingre'"),
    ],
)
def test_a_capture_states_places_on_the_body_of_names_that_do_not_tell_them(
    tmp_path: Path, places: str, wrong: str
) -> None:
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (30, 2, 1))
    names, spots = np.array(["wrist", "finger"]), np.zeros((30, 2, 3))
    spots[:, 1, 0] = 0.1
    np.savez(tmp_path / "m.npz", names=names, pos=spots, quat=turns, fps=30.0)
    text = SKELETON.replace("[[sensor]]", f"[files.motion.places]\n{places}\n[[sensor]]")
    (tmp_path / "capture.toml").write_text(text)
    if wrong:
        with pytest.raises(UnknownNameError, match=wrong):
            files_of(tmp_path)
    else:
        assert files_of(tmp_path)[0]["motion"].places == {"finger": "left_fingers"}


THING = '[[object]]\nname = "{name}"\ntag = "mobile"\nbody = "hand"\npart_of = "{base}"\n'


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        ([("lid", "bax")], "no object 'bax'"),
        ([("lid", "lid")], "no object 'lid'"),
        ([("lid", "box"), ("box", "lid")], "would be a part of itself"),
    ],
)
def test_an_object_is_a_part_of_another_and_never_of_itself(
    pairs: list[tuple[str, str]], said: str, tmp_path: Path
) -> None:
    things = "".join(THING.format(name=name, base=base) for name, base in pairs)
    with pytest.raises((CaptureError, FileError, UnknownNameError), match=said):
        notices(tmp_path, TRIAL + things)
