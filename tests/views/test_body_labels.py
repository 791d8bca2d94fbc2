"""Names of bodies in a picture can be read: none on another, none off the page."""

from itertools import combinations

from hypothesis import given, settings
from hypothesis import strategies as st

from capar.views.viewer.snapshot import Box, Labelled, distance, leader, meet, place_labels

PAGE = (9.0, 6.6)
places = st.tuples(st.floats(3.0, 6.0), st.floats(2.0, 4.5))
SCENES = 25
"""So many scenes are tried: one takes a quarter of a second."""

bodies = st.lists(st.tuples(places, st.floats(0.05, 0.6), st.floats(0.3, 1.0)), max_size=12)


def labelled(place: tuple[float, float], half: float, wide: float) -> Labelled:
    x, y = place
    box: Box = (x - half, x + half, y - half, y + half)
    return Labelled(box, (wide, 0.17))


@settings(max_examples=SCENES)
@given(bodies)
def test_no_name_stands_on_another_or_leaves_the_page(
    parts: list[tuple[tuple[float, float], float, float]],
) -> None:
    boxes = place_labels([labelled(*part) for part in parts], PAGE)
    for one, other in combinations(boxes, 2):
        assert not meet(one, other)
    for box in boxes:
        assert box[0] >= 0.0 and box[1] <= PAGE[0] and box[2] >= 0.0 and box[3] <= PAGE[1]


@settings(max_examples=SCENES)
@given(bodies)
def test_the_line_of_a_name_leads_from_its_body_to_it(
    parts: list[tuple[tuple[float, float], float, float]],
) -> None:
    named = [labelled(*part) for part in parts]
    for body, box in zip(named, place_labels(named, PAGE), strict=True):
        line = leader(box, body.middle)
        assert tuple(line[0]) == body.middle
        assert distance(box, (float(line[-1][0]), float(line[-1][1]))) < 1e-9


def test_a_name_alone_covers_no_small_body() -> None:
    point = labelled((4.0, 3.0), 0.05, 0.8)
    (box,) = place_labels([point], PAGE)
    assert not meet(box, point.box)
