"""Objects declared at once from the bodies of a file, and supports under several of them."""

from pathlib import Path

import numpy as np
import pytest

from capar.model.capture import PivotContact, ShapeSource
from capar.model.errors import FileError, UnknownNameError
from extractors.readers.bundle.capture_toml import read_capture

HEIGHTS = {"can_7": 0.75, "can_9": 0.77, "bowl_3": 0.80, "spoon_1": 0.60}

TEXT = """name = "trial"
unit = "m"
up = "z"

[files]
motion = "m.csv"

[[sensor]]
name = "right_hand"
end_effector = "hand"
body = ["spoon_*"]

[[object]]
name = "table"
tag = "fixed"
assumed = "none was recorded"
top_at_bottom_of = "*"
at_s = 0.0
shape = { box = [1.0, 1.0, 0.02] }

[[objects_from]]
file = "motion"
bodies = "*_*"
tag = "mobile"
touched_by = "right_hand"
touched_within_m = 0.01
[objects_from.kinds]
can = { name = "can", shape = { box = [0.06, 0.06, 0.1] } }
bowl = { name = "dish", kind = "bowl", shape = { box = [0.2, 0.2, 0.06] } }
"""


def bundle(folder: Path, text: str = TEXT) -> Path:
    head = "t_s," + ",".join(
        f"{name}_{each}" for name in HEIGHTS for each in ("x", "y", "z", "qx", "qy", "qz", "qw")
    )
    rows = [
        ",".join([f"{0.01 * frame:.2f}", *(f"0,0,{z},0,0,0,1" for z in HEIGHTS.values())])
        for frame in range(20)
    ]
    (folder / "m.csv").write_text("\n".join([head, *rows]) + "\n")
    (folder / "capture.toml").write_text(text)
    return folder


def test_bodies_of_known_kinds_become_objects_and_the_others_are_counted(tmp_path: Path) -> None:
    capture = read_capture(bundle(tmp_path))
    objects = {each.name: each for each in capture.objects}
    assert set(objects) == {"table", "can", "can_2", "dish"}
    assert [objects[each].kind for each in ("can", "can_2", "dish")] == ["can", "can", "bowl"]
    assert objects["can"].stream.positions[0, 2] == pytest.approx(0.75)
    assert objects["can_2"].stream.positions[0, 2] == pytest.approx(0.77)
    (notice,) = [each for each in capture.notices if each.code == "objects-left-out"]
    assert notice.message == "1 of 4 objects have no shape and are left out: spoon_1"
    touched = {"can", "can_2", "dish"}
    assert set(capture.pivot_contacts) == {
        PivotContact("right_hand", name, 0.01) for name in touched
    }
    assert np.allclose(capture.sensor("right_hand").stream.positions[:, 2], 0.60)


@pytest.mark.parametrize(("of", "top"), [("median", 0.72), ("lowest", 0.70)])
def test_a_support_stands_under_the_objects_that_rest_on_it(
    of: str, top: float, tmp_path: Path
) -> None:
    """Their lowest points are at 0.70, 0.72 and 0.77 m."""
    text = TEXT.replace('top_at_bottom_of = "*"', f'top_at_bottom_of = "*"\nof = "{of}"')
    table = read_capture(bundle(tmp_path, text)).tag_object("table")
    assert table.shape is not None
    assert table.shape.source is ShapeSource.ASSUMED
    assert table.stream.positions[0, 2] + 0.01 == pytest.approx(top)
    assert f"top at {top:.3f} m" in table.assumed
    assert "3 objects" in table.assumed


@pytest.mark.parametrize(
    ("old", "new", "error", "words"),
    [
        ('bodies = "*_*"', 'bodies = "cup_*"', UnknownNameError, "cup_"),
        ('name = "can", ', "", FileError, "name"),
        ('file = "motion"', 'file = "mation"', UnknownNameError, "motion"),
        ("touched_within_m = 0.01", "", FileError, "touched_within_m"),
        ('top_at_bottom_of = "*"', 'top_at_bottom_of = "fork*"', FileError, "fork"),
        ('body = ["spoon_*"]', 'body = ["fork_*"]', UnknownNameError, "spoon_1"),
        ('tag = "mobile"', 'tag = "mobile"\ncolour = "red"', UnknownNameError, "colour"),
    ],
)
def test_what_is_wrong_is_pointed_at(
    old: str, new: str, error: type[Exception], words: str, tmp_path: Path
) -> None:
    assert old in TEXT
    with pytest.raises(error, match=words):
        read_capture(bundle(tmp_path, TEXT.replace(old, new)))
