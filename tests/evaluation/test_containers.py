"""What is put into a box goes into it, and what is put beside it, or was there before, does not."""

from pathlib import Path

import numpy as np
import pytest
from measured_bodies import box, pick_and_place
from motion_files import recordings_folder

from capar.evaluation.labels import Kind
from capar.evaluation.metrics import report
from capar.evaluation.objects import Landing, count_landings, halved, landings
from capar.evaluation.plan import Plan, read_plan
from capar.evaluation.running import evaluate
from capar.model.capture import Capture, ShapeSource
from capar.model.errors import CaparError
from extractors.readers.bundle.capture_toml import read_capture, takes

pytestmark = pytest.mark.long

SCENES = Path(__file__).parents[2] / "examples" / "boxed_vr" / "scenes.toml"


def test_two_halves_fill_the_box_that_they_part() -> None:
    capture, names = halved(pick_and_place(), "table")
    halves = [capture.tag_object(name) for name in names]
    sizes = [each.shape.size for each in halves if each.shape]
    assert np.allclose(sizes, [[1.0, 0.6, 0.04]] * 2)
    bounds = [each.shape.bounds for each in halves if each.shape]
    assert np.allclose(bounds[0][1, 1], bounds[1][0, 1])
    assert np.allclose([bounds[0][0], bounds[1][1]], box(1.0, 1.2, 0.04).bounds)
    assert all(each.assumed for each in halves)


def test_what_stands_on_a_table_went_into_nothing() -> None:
    assert [(each.reported, each.true) for each in landings(pick_and_place(), ["table"])] == [
        (False, False)
    ]


def test_groceries_go_into_the_box_where_they_are_found_in_the_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    found = landings(_with_assumed_carton("p78_s1"), ["carton"])
    assert sum(each.true for each in found) == 10
    assert all(each.reported and each.true for each in found)


def _with_assumed_carton(take: str) -> Capture:
    """A scene, whose box was not recorded and is derived from what lies in it."""
    capture = read_capture(f"{SCENES}:{take}")
    carton = capture.tag_object("carton")
    assert carton.shape is not None
    assert carton.shape.source is ShapeSource.ASSUMED
    assert "the lowest point of the lowest of" in carton.assumed
    return capture


def test_what_is_put_into_one_half_of_the_box_is_not_put_into_the_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Told otherwise may be what stands across the middle: at most one object in ten."""
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    capture, halves = halved(read_capture(f"{SCENES}:p78_s1"), "carton")
    found = landings(capture, halves)
    wrong = [each for each in found if each.reported != each.true]
    assert len(found) == 20
    assert sum(each.true for each in found) == 10
    assert len(wrong) <= 1
    assert not [each for each in wrong if each.reported]


def test_objects_without_a_mesh_are_counted_and_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    assert len(takes(SCENES)) == 16
    capture = read_capture(f"{SCENES}:p1_s1")
    (notice,) = [each for each in capture.notices if each.code == "objects-left-out"]
    assert notice.message.startswith("7 of 23 objects have no shape and are left out: ")
    assert sum(each.tag == "mobile" for each in capture.objects) == 16
    assert not [each for each in capture.objects if each.shape is None]


def test_landings_are_counted_by_what_is_told_and_what_is_true() -> None:
    found = [
        Landing("a", "box", told, true)
        for told, true, times in (
            (True, True, 3),
            (True, False, 1),
            (False, True, 2),
            (False, False, 4),
        )
        for _ in range(times)
    ]
    scores = count_landings(found).scores()
    assert (scores["objects"], scores["right"], scores["accuracy"]) == (10, 7, 70.0)
    assert (scores["went_in"], scores["told"]) == (5, 4)
    assert (scores["told_wrongly"], scores["untold"]) == (1, 2)


def test_a_scene_is_scored_by_its_evaluation_file(monkeypatch: pytest.MonkeyPatch) -> None:
    """One object lies in the box from the beginning, and one ends above its rim."""
    monkeypatch.setenv("CAPAR_DATA", str(recordings_folder()))
    _with_assumed_carton("p76_s1")
    plan = read_plan(SCENES.with_name("containers.toml"), takes=["p76_s1"])
    found = report(evaluate(plan))
    assert (found["all"]["objects"], found["all"]["right"]) == (12, 12)
    assert (found["all"]["went_in"], found["all"]["told"]) == (10, 10)
    assert any("have no shape and are left out" in each for each in found["notices"])


def test_containers_are_named_in_an_evaluation_file() -> None:
    with pytest.raises(CaparError, match="containers are named in an evaluation file"):
        Plan(Kind.CONTAINERS, ())
