"""The schema of capture.toml is what reading, messages, the reference page and editors go by."""

import json
import re
import tomllib
from pathlib import Path
from typing import get_args

import jsonschema
import motion_files as samples
import pytest
from typer.testing import CliRunner

from capar.cli import app
from capar.model.capture import UP, Role, TagType
from capar.model.errors import CaparError
from extractors.readers.bundle.capture_toml import read_capture
from extractors.readers.recording import UNITS
from extractors.readers.registry import READER_OPTIONS
from extractors.readers.schema.capture import MotionFile, ObjectEntry, SensorEntry, Unit, Up
from extractors.readers.schema.entry import Entry
from extractors.readers.schema.reference import TABLES, json_schema, reference

ROOT = Path(__file__).resolve().parents[3]
CAPTURES = sorted([*ROOT.glob("examples/*/capture.toml"), *ROOT.glob("capar/demo/*/capture.toml")])

TRIAL = """unit = "m"
up = "y"
[files]
motion = "m.csv"
[[sensor]]
name = "right_hand"
end_effector = "hand"
body = "hand"
shape = { capsules = [["hand", "hand"]], radius_m = 0.05 }
[[object]]
name = "mug"
tag = "mobile"
position = [0.5, 0.2, 0.9]
[object.shape]
box = [0.1, 0.1, 0.1]
"""


def message(folder: Path, text: str) -> str:
    """What is said of a capture.toml with a mistake."""
    samples.write_csv(folder / "m.csv")
    (folder / "capture.toml").write_text(text)
    with pytest.raises(CaparError) as caught:
        read_capture(folder)
    return str(caught.value).replace(f"{folder}/", "")


def test_the_reference_page_is_the_one_made_from_the_schema() -> None:
    assert (ROOT / "docs" / "capture-toml.md").read_text() == reference(), "run: make docs"


def test_every_table_is_on_the_reference_page_and_every_key_says_what_it_means() -> None:
    def tables(kind: type[Entry]) -> set[type[Entry]]:
        return {kind} | {each for sub in kind.__subclasses__() for each in tables(sub)}

    bases = {"Entry", "Takes", "Traits", "Tracked", "ObjectTraits"}
    own = {each for each in tables(Entry) if each.__module__.startswith("extractors.")}
    assert {each.__name__ for each in own} - bases == {each.__name__ for each in TABLES.values()}
    for kind in own:
        assert kind.__doc__
        assert all(field.description for field in kind.model_fields.values()), kind


def test_an_editor_finds_the_examples_right_and_a_mistake_in_them_wrong() -> None:
    printed = CliRunner().invoke(app, ["new-capture", "--schema"]).output
    schema = json.loads(printed)
    assert schema == json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    for path in CAPTURES:
        data = tomllib.loads(path.read_text())
        assert not list(validator.iter_errors(data)), path
        assert list(validator.iter_errors({**data, "untis": "m"}))
        assert list(validator.iter_errors({**data, "sensor": [{"name": "x"}]}))
    assert len(CAPTURES) >= 8


def test_the_words_of_the_schema_are_those_that_the_code_knows() -> None:
    assert set(get_args(Unit)) == set(UNITS)
    assert set(get_args(Up)) == set(UP)
    assert set(MotionFile.model_fields) >= READER_OPTIONS
    for kind, key, known in ((ObjectEntry, "tag", TagType), (SensorEntry, "role", Role)):
        for word in known:
            assert f"'{word.value}'" in str(kind.model_fields[key].annotation)


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("[files]", "rate = 3\n[files]", "capture.toml:3: no key 'rate'; .*'rate_hz'"),
        ('tag = "mobile"', 'tag = "mobil"', "capture.toml:12: no tag 'mobil'; .*'mobile'"),
        ('tag = "mobile"', "", "capture.toml:10: 'tag' is missing. tag: A part of the agent, fix"),
        ("[[object]]", "[[objects]]", "capture.toml:10: no key 'objects'; .* mean 'object'"),
        ('name = "mug"', 'name = "mug', "capture.toml:11: is not valid TOML: Illegal character"),
        ('name = "mug"', 'name = "Mug!"', "capture.toml:11: name 'Mug!': names begin"),
        ('name = "mug"', "name = 3", "capture.toml:11: name = 3 is not a text in quotes"),
        ("0.9]", "0.9, 1, 1]", r"capture.toml:13: position = .*at most 3. .*z axis points up"),
        ("0.9]", "true]", "capture.toml:13: position = True is not a number. .*z axis points up"),
        ("0.9]", "inf]", "capture.toml:13: position = inf is not a finite number."),
        ("0.2, 0.9]", "0.2]", "capture.toml:13: position = .* takes x, y and z. .*z axis points"),
        ("box =", "bx =", "capture.toml:14: a shape states exactly one of mesh, box"),
        ("box =", "sphere = 0.1\nbox =", "capture.toml:14: a shape states exactly one of"),
        ("0.1, 0.1]", "0.1, -1]", "capture.toml:15: box = -1; it must be greater than 0."),
        ("radius_m = 0.05", "radius = 1", "capture.toml:9: no key 'radius'; .*'radius_m'"),
        ('body = "hand"', "", "capture.toml:5: one of these must be given: body, markers."),
        ('body = "hand"', 'body = "hand"\nmarkers = ["a"]', "'body' cannot be given together"),
        ('body = "hand"', 'body = "hand"\norigin = ["a"]', "'origin' is given without 'markers'"),
        ("[[object]]", "[object]", "capture.toml:10: object is a single table. Give each under"),
        ('motion = "m.csv"', "motion = 3", "capture.toml:4: motion = 3 is not of a type"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_with_its_line_its_key_and_what_is_right(
    right: str, wrong: str, said: str, tmp_path: Path
) -> None:
    assert right in TRIAL
    assert re.search(
        said,
        message(
            tmp_path,
            TRIAL.replace(right, wrong),
        ),
        re.DOTALL,
    )


def test_several_mistakes_are_told_at_once_in_the_order_of_their_lines(tmp_path: Path) -> None:
    text = TRIAL.replace('"hand"\nbody', "3\nbody").replace('"mobile"', '"movable"')
    said = message(tmp_path, text)
    assert "has 2 mistakes" in said
    assert said.index("capture.toml:7: end_effector = 3") < said.index("capture.toml:12: no tag")


def test_an_option_of_another_format_is_told_with_those_of_this_one(tmp_path: Path) -> None:
    text = TRIAL.replace('motion = "m.csv"', 'motion = { path = "m.csv", fps = "rate" }')
    assert re.search(r"capture.toml:4: no csv option 'fps'.*rate_hz", message(tmp_path, text))
