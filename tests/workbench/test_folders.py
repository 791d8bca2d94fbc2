"""No file outside of the folders that were named is read or written."""

from pathlib import Path

import pytest

from capar.model.errors import FileError
from capar.workbench.folders import Folders


@pytest.fixture
def folders(tmp_path: Path) -> Folders:
    for name in ("mine", "other", "secret"):
        (tmp_path / name).mkdir()
    (tmp_path / "secret" / "key.csv").write_text("x")
    (tmp_path / "mine" / "link").symlink_to(tmp_path / "secret")
    (tmp_path / "mine" / "loop").symlink_to(tmp_path / "mine" / "loop")
    return Folders([tmp_path / "mine", tmp_path / "other"])


@pytest.mark.parametrize(
    "text",
    ["../secret/key.csv", "/etc/passwd", "~/x", "~nobody_at_all/x", "link/key.csv", "a/../../x", "",
     "  ", "x\0y", ".." , "../mine2"],
)  # fmt: skip
def test_what_lies_outside_is_refused(folders: Folders, text: str) -> None:
    with pytest.raises(FileError):
        folders.inside(text)


def test_what_lies_inside_is_found_from_either_folder(folders: Folders) -> None:
    assert folders.inside("a/b.csv") == folders.first / "a" / "b.csv"
    assert folders.inside(folders.roots[1] / "x").name == "x"
    assert folders.inside("sub/../x.csv") == folders.first / "x.csv"


def test_nothing_that_is_there_is_replaced(folders: Folders) -> None:
    (folders.first / "there").mkdir()
    with pytest.raises(FileError, match="exists already"):
        folders.new("there")
    assert folders.new("new").parent == folders.first


def test_files_are_listed_without_those_behind_links(folders: Folders) -> None:
    (folders.first / "take.bvh").write_text("x")
    (folders.roots[1] / "other.bvh").write_text("x")
    assert folders.files([".bvh"]) == [str(folders.roots[1] / "other.bvh"), "take.bvh"]
    assert folders.files([".csv"]) == []


@pytest.mark.parametrize(
    "line",
    [
        'x = "../../secret/key.csv"',
        'x = { mesh = "/etc/passwd" }',
        'files.a = { path = "link/key.csv" }',
        'x = ["a", ["../../secret"]]',
        'x = "${HOME}/key.csv"',
    ],
)
def test_a_capture_toml_that_names_a_file_outside_is_refused(folders: Folders, line: str) -> None:
    (folders.first / "bundle").mkdir()
    (folders.first / "bundle" / "link").symlink_to(folders.first.parent / "secret")
    with pytest.raises(FileError):
        folders.check_bundle(line, folders.first / "bundle")


def test_a_capture_toml_of_the_folders_is_taken(folders: Folders) -> None:
    (folders.first / "take.csv").write_text("x")
    (folders.first / "bundle").mkdir()
    text = 'name = "a"\n[files]\nmotion = "../take.csv"\n[x]\ny = "anything at all"\n'
    folders.check_bundle(text, folders.first / "bundle")
    folders.check_bundle("this is no TOML [", folders.first)
