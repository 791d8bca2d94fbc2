"""A vessel has room; what is bent, dented or closed has none, unless its kind is a vessel's."""

from itertools import pairwise

import numpy as np
import pytest
import trimesh
from measured_bodies import box, cup, shape, stream
from scipy.spatial import ConvexHull

from capar.model.capture import Shape, TagObject, TagType
from capar.model.facts import Leans, Posture, Shapeless, Solid
from extractors.bodies.bodies import geometry_of
from extractors.relations.places import enclosure, has_room, rooms
from extractors.thresholds import Thresholds

LIMITS = Thresholds()


def banana() -> Shape:
    """A tube that is bent by a third of a circle."""
    angles = np.linspace(0.0, 2.0 * np.pi / 3.0, 12)
    spine = 0.1 * np.column_stack((np.cos(angles), np.sin(angles), np.zeros(12)))
    links = [
        trimesh.creation.cylinder(0.018, segment=[one, other], sections=12)
        for one, other in pairwise(spine)
    ]
    return shape(trimesh.util.concatenate(links))


@pytest.mark.parametrize(
    ("form", "room"),
    [(cup(0.04, 0.1), True), (cup(0.12, 0.08), True), (box(0.1, 0.2, 0.3), False)],
)
def test_a_vessel_has_room_and_a_box_has_none(form: Shape, room: bool) -> None:
    assert has_room(form, LIMITS) is room


def test_nothing_is_in_a_thing_that_is_only_bent() -> None:
    assert not has_room(banana(), LIMITS)


def test_all_is_seen_from_inside_a_closed_thing_and_nothing_from_outside() -> None:
    form = box(0.2, 0.2, 0.2)
    assert enclosure(form, np.zeros(3)) == 1.0
    assert enclosure(form, np.array([5.0, 0.0, 0.0])) < 0.01


@pytest.mark.parametrize(
    ("form", "kind", "told"),
    [
        (banana(), "banana", [Solid("thing")]),
        (banana(), "bottle", []),
        (cup(0.04, 0.1), "thing", []),
        (None, "bottle", [Shapeless("thing")]),
    ],
)
@pytest.mark.parametrize(
    "tipped", [[Leans("thing", 3, 5)], [Posture("thing", 0, 0, 0), Posture("thing", 5, 900, 0)]]
)
def test_what_is_tipped_is_asked_about(
    form: Shape | None, kind: str, told: list[Solid], tipped: list[Leans]
) -> None:
    body = TagObject("thing", TagType.MOBILE, stream(np.zeros((9, 3))), form)
    things = {"thing": geometry_of(body, LIMITS)}
    assert list(rooms(things, {"thing": kind}, (), tipped, LIMITS)) == told
    assert list(rooms(things, {"thing": kind}, (), [], LIMITS)) == []


def test_room_in_a_shape_is_sought_once(monkeypatch: pytest.MonkeyPatch) -> None:
    sought: list[int] = []

    def hull(points: np.ndarray) -> ConvexHull:
        sought.append(len(points))
        return ConvexHull(points)

    monkeypatch.setattr("extractors.relations.places.ConvexHull", hull)
    mug, crate = cup(0.04, 0.1), box(0.1, 0.2, 0.3)
    told = [(has_room(mug, LIMITS), has_room(crate, LIMITS)) for _ in range(3)]
    assert told == [(True, False)] * 3
    assert sought == [len(mug.vertices), len(crate.vertices)]
