"""The test motions are what they claim: laws of motion, true contacts, people who differ."""

from collections.abc import Callable
from functools import cache
from itertools import combinations

import fcl
import motions
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from jaxtyping import Bool, Float
from motions import PERFORMERS, TALL_MAN, Performer, Trial
from motions.drink import PUBLISHED_SHARES
from motions.paths import Move, pose
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Capture, Shape
from capar.model.facts import Touching
from extractors.measure import measure

Act = Callable[..., Trial]

PUBLISHED: tuple[Act, ...] = (
    motions.drink_from_mug,
    motions.touch_from_rest,
    motions.touch_cycle,
    motions.slide_object,
    motions.pick_up_with_both_hands,
)
ROWS: tuple[Act, ...] = (
    motions.hit,
    motions.touch_with,
    motions.move_obj,
    motions.move_obj_to,
    motions.resume_posture,
    motions.touch,
    motions.roll_object,
    motions.stand_on_one_leg,
)

act = pytest.mark.parametrize("act", (*PUBLISHED, *ROWS), ids=lambda each: each.__name__)
performer = pytest.mark.parametrize("performer", PERFORMERS, ids=lambda each: each.name)


@cache
def acted(act: Act, performer: Performer) -> Trial:
    """An act as it is recorded without noise, for all that is asked of it."""
    return act(performer)


@given(st.floats(0.05, 1.0), st.floats(0.2, 3.0))
def test_the_speed_of_a_straight_move_peaks_at_15_eighths_of_its_mean(
    distance_m: float, duration_s: float
) -> None:
    move = Move(0.0, duration_s, pose((0.0, 0.0, 0.0)), pose((0.0, distance_m, 0.0)))
    times = np.linspace(0.0, duration_s, 2001)
    speed = np.gradient(move.at(times).translation[:, 1], times)
    assert speed.max() == pytest.approx(1.875 * distance_m / duration_s, rel=1e-4)
    assert times[speed.argmax()] == pytest.approx(duration_s / 2.0, rel=2e-3)


@act
@performer
def test_true_contacts_are_those_of_the_meshes_within_two_frames(
    act: Act, performer: Performer
) -> None:
    """An independent check: exact distances of the meshes, where truth is of the paths alone."""
    trial = acted(act, performer)
    capture = trial.capture
    names = [each for each in capture.bodies if each not in _ignored(capture)]
    true = trial.truth.contacts(tolerance_m=0.005)
    for pair in combinations(names, 2):
        expected = [
            (each.begin_s, each.end_s) for each in true if {each.body, each.other} == set(pair)
        ]
        found = _touching(capture, *pair, tolerance_m=0.005)
        assert len(found) == len(expected), pair
        limit = 2.0 / capture.rate_hz + 1e-9
        np.testing.assert_allclose(
            np.reshape(found, (-1, 2)), np.reshape(expected, (-1, 2)), atol=limit, err_msg=str(pair)
        )


@act
@performer
def test_extracted_contacts_are_the_true_ones_within_two_frames(
    act: Act, performer: Performer
) -> None:
    trial = acted(act, performer)
    measured = measure(trial.capture)
    found = sorted(
        ("-".join(sorted((each.body, each.other))), each.first, each.last)
        for each in measured.facts
        if isinstance(each, Touching)
    )
    rate = trial.capture.rate_hz
    true = sorted(
        ("-".join(sorted((each.body, each.other))), each.begin_s * rate, each.end_s * rate)
        for each in trial.truth.contacts(tolerance_m=measured.calibration.contact_tolerance_m)
    )
    assert [pair for pair, _, _ in found] == [pair for pair, _, _ in true]
    np.testing.assert_allclose(
        [(first, last) for _, first, last in found],
        [(begin, end) for _, begin, end in true],
        atol=2.0,
    )


@performer
def test_grasp_to_lift_off_takes_less_than_a_tenth_of_a_second(performer: Performer) -> None:
    truth = motions.drink_from_mug(performer).truth
    contacts = {(each.body, each.other): each for each in reversed(truth.contacts())}
    taken = contacts["right_hand", "mug"].begin_s
    assert 0.0 < contacts["mug", "table"].end_s - taken < 0.1


def test_the_tall_man_drinks_in_402_frames_with_the_published_shares() -> None:
    trial = motions.drink_from_mug(TALL_MAN)
    assert len(trial.capture.times) == 402
    np.testing.assert_allclose(trial.truth.shares("right_hand"), PUBLISHED_SHARES, atol=0.02)


def test_noise_has_the_wanted_size_and_is_each_body_s_own() -> None:
    clean, noisy = (
        motions.touch_from_rest(TALL_MAN, rate_hz=240.0, **options).capture
        for options in ({}, {"noise_m": 0.003, "noise_rad": np.radians(1.0), "seed": 3})
    )
    rests = []
    for name in ("right_hand", "head", "box"):
        one, two = clean.bodies[name].stream, noisy.bodies[name].stream
        rest = two.positions - one.positions
        assert rest.std() == pytest.approx(0.003, rel=0.06)
        angles = geometry.angle_between(one.orientations, two.orientations)
        assert np.sqrt((angles**2).mean() / 3.0) == pytest.approx(np.radians(1.0), rel=0.06)
        rests.append(rest.ravel())
    assert np.abs(np.corrcoef(rests) - np.eye(3)).max() < 0.1
    table = noisy.bodies["table"].stream
    np.testing.assert_array_equal(table.positions, clean.bodies["table"].stream.positions)


def test_rotation_keeps_distances_and_names_and_orders_change_nothing_else() -> None:
    capture = motions.drink_from_mug(TALL_MAN, noise_m=0.001).capture
    turned = motions.rotated(capture, Rotation.from_rotvec([0.3, -0.4, 1.0]))
    names = {"mug": "beaker", "right_hand": "paw"}
    other = motions.reordered(motions.renamed(capture, names), seed=4)
    assert {each.name for each in other.objects} == {"beaker", "table", "head"}
    for pair in (("right_hand", "mug"), ("mug", "head")):
        plain = _distances(capture, *pair, every=20)
        new = tuple(names.get(each, each) for each in pair)
        np.testing.assert_allclose(_distances(turned, *pair, every=20), plain, atol=1e-9)
        np.testing.assert_allclose(_distances(other, *new, every=20), plain, atol=1e-12)


def _ignored(capture: Capture) -> set[str]:
    """The head counts where it is an object; of two hands each counts with things alone."""
    objects = {each.name for each in capture.objects}
    return {each.name for each in capture.attending} - objects


def _tree(shape: Shape) -> fcl.BVHModel:
    model = fcl.BVHModel()
    model.beginModel(len(shape.vertices), len(shape.faces))
    model.addSubModel(np.array(shape.vertices), np.array(shape.faces))
    model.endModel()
    return model


def _distances(
    capture: Capture, one: str, two: str, *, every: int = 1
) -> Float[np.ndarray, "frames"]:
    """Exact distance of two meshes at every so many frames [m]; zero where they cut each other."""
    distance = _exact(capture, one, two)
    return np.array([distance(frame) for frame in range(0, len(capture.times), every)])


def _exact(capture: Capture, one: str, two: str) -> Callable[[int], float]:
    """The exact distance of two meshes at a frame [m]; zero where they cut each other."""
    bodies = [capture.bodies[each] for each in (one, two)]
    things = [fcl.CollisionObject(_tree(each.shape)) for each in bodies if each.shape]

    def distance(frame: int) -> float:
        for body, thing in zip(bodies, things, strict=True):
            place, turn = body.stream.positions[frame], body.stream.orientations[frame]
            thing.setTransform(fcl.Transform(turn, place))
        return max(float(fcl.distance(*things, fcl.DistanceRequest(), fcl.DistanceResult())), 0.0)

    return distance


def _near(capture: Capture, one: str, two: str, *, within_m: float) -> Bool[np.ndarray, "frames"]:
    """At which frames two meshes are so near; frames are left out where none could have come so."""
    distance, slack_m = _exact(capture, one, two), 0.0
    near = np.zeros(len(capture.times), dtype=bool)
    for frame, way_m in enumerate(_most_moved(capture, one) + _most_moved(capture, two)):
        slack_m -= way_m
        if slack_m <= 0.0:
            slack_m = distance(frame) - within_m
            near[frame] = slack_m <= 0.0
    return near


def _most_moved(capture: Capture, name: str) -> Float[np.ndarray, "frames"]:
    """How far any place of a body may have moved since the frame before [m]."""
    body = capture.bodies[name]
    assert body.shape is not None
    turns = geometry.angle_between(body.stream.orientations[1:], body.stream.orientations[:-1])
    ways = np.linalg.norm(np.diff(body.stream.positions, axis=0), axis=1)
    return np.concatenate([[0.0], ways + turns * np.linalg.norm(body.shape.vertices, axis=1).max()])


def _touching(
    capture: Capture, one: str, two: str, *, tolerance_m: float
) -> list[tuple[float, float]]:
    near = _near(capture, one, two, within_m=tolerance_m)
    return [(capture.times[a], capture.times[b]) for a, b in geometry.runs(near)]
