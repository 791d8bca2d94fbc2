"""A key of a capture.toml is changed in its text; everything else stays as it was written."""

import tomllib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from extractors.readers.drafting.toml_edit import (
    count,
    table,
    with_key,
    with_table,
    without_table,
    written,
)

TEXT = """# a trial
name = "trial"
unit = "mm"   # EDIT: or another

[files]
a = "a.bvh"

# the hand
[[sensor]]
name = "right_hand"   # which one
markers = [
    "a",
    "b",   # and one more
]
[sensor.offset]
position = [0, 0, 1]

# the head
[[sensor]]
name = "head"

[[object]]
name = "mug"
"""


@pytest.mark.parametrize(
    ("place", "key", "value"),
    [
        (("", 0), "unit", "cm"),
        (("", 0), "up", "y"),
        (("sensor", 0), "name", "left_hand"),
        (("sensor", 0), "markers", ["x", "y"]),
        (("sensor", 0), "side", "left"),
        (("sensor", 1), "eye", [0.1, 0.0, 0.0]),
        (("object", 0), "shape", {"sphere": 0.05}),
        (("sensor", 0), "markers", None),
    ],
)
def test_only_the_key_changes(place: tuple[str, int], key: str, value: Any) -> None:
    before, after = tomllib.loads(TEXT), tomllib.loads(with_key(TEXT, *place, key, value))
    own = before if not place[0] else before[place[0]][place[1]]
    if value is None:
        del own[key]
    else:
        own[key] = value
    assert after == before


def test_comments_stay_and_what_was_to_be_edited_is_done() -> None:
    text = with_key(TEXT, "sensor", 0, "name", "left_hand")
    assert 'name = "left_hand"   # which one' in text and "# the head" in text
    assert "EDIT" not in with_key(TEXT, "", 0, "unit", "cm")


def test_tables_come_and_go() -> None:
    assert (count(TEXT, "sensor"), count(TEXT, "object"), count(TEXT, "pivot")) == (2, 1, 0)
    more = with_table(TEXT, "object", {"name": "table", "tag": "fixed"})
    assert table(more, "object", 1) == {"name": "table", "tag": "fixed"}
    less = without_table(TEXT, "sensor", 1)
    assert count(less, "sensor") == 1 and "# the head" not in less and "# the hand" in less
    assert table(TEXT, "object", 5) == {}


VALUES = st.recursive(
    st.text() | st.integers(-(2**40), 2**40) | st.booleans() | st.floats(-1e6, 1e6),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.from_regex(r"[a-z]+", fullmatch=True), inner, max_size=3)
    ),
    max_leaves=6,
)


@given(VALUES)
def test_every_value_is_read_back_as_it_was_written(value: Any) -> None:
    assert tomllib.loads(f"x = {written(value)}")["x"] == value
    assert table(with_key(TEXT, "sensor", 1, "x", value), "sensor", 1)["x"] == value
