"""What one body did another does in a drawn scene, and the same action is observed again."""

import numpy as np
import pytest
from combinations import EVERY
from recorded_actions import recorded

from capar.pipelines.round_trips import body, numbered_scene, round_trip
from capar.regeneration.search import reachable

pytestmark = pytest.mark.long

RATE_HZ, SEED = 30.0, 7

TRIPS = [
    ("sip", "child", 3),
    ("touch_from_rest", "man", 3),
    ("slide", "man", 3),
    ("carry", "woman", 2),
    ("pick_up", "man", 0),
    ("turn", "child", 1),
    ("push", "child", 2),
    ("pour", "child", 3),
]
"""Action, agent, and number of the scene; 0 is the recorded one.

More of them: ``benchmarks/regeneration.py``.
"""

if EVERY:
    TRIPS += [
        ("drink", "child", 2), ("drink", "woman", 5), ("sip", "man", 10), ("touch", "child", 3),
        ("pour", "man", 2), ("pour", "child", 5),
    ]  # fmt: skip


@pytest.mark.parametrize(("action", "agent", "number"), TRIPS)
def test_the_same_action_comes_out_of_a_good_motion(action: str, agent: str, number: int) -> None:
    source = recorded(action)
    scene = numbered_scene(source, number, SEED)
    trip = round_trip(source, agent, body(agent, source), number, scene)
    assert not trip.refused
    assert trip.quality is not None
    assert trip.quality.passed, [gate for gate in trip.quality.gates if not gate.passed]
    assert trip.same_par, trip.names
    assert trip.same_contacts


NOISY = [("drink", "child", 0), ("touch", "child", 3), ("pick_up", "man", 0)]

if EVERY:
    NOISY += [("sip", "woman", 1), ("pour", "child", 2)]


@pytest.mark.parametrize(("action", "agent", "number"), NOISY)
def test_the_same_comes_of_a_recording_with_a_magnetic_trackers_noise(
    action: str, agent: str, number: int
) -> None:
    source = recorded(action, noisy=True)
    scene = numbered_scene(source, number, SEED)
    trip = round_trip(source, agent, body(agent, source), number, scene)
    assert not trip.failed
    assert trip.same_par, trip.names


def test_what_rests_in_a_noisy_recording_is_at_rest() -> None:
    source = recorded("touch", noisy=True)
    for path in (source.paths["crate"], source.hands["left"].path):
        assert np.ptp(path.translation, axis=0).max() == 0.0
        assert (path.rotation * path.rotation[0].inv()).magnitude().max() < 1e-7
    clean = recorded("touch").paths["crate"].translation[0]
    np.testing.assert_allclose(source.paths["crate"].translation[0], clean, atol=0.001)


def test_a_motion_is_smoothed_as_far_as_noise_allows() -> None:
    clean, noisy = (recorded("pour", noisy=each).paths["mug"].translation for each in (False, True))
    off = np.linalg.norm(noisy - clean, axis=1)
    assert np.sqrt(np.mean(off**2)) < 0.001  # the tracker's deviates by 2.6 mm
    assert off.max() < 0.003


@pytest.mark.parametrize("number", [2, 3])
def test_a_mug_is_emptied_over_the_bowl_wherever_that_stands(number: int) -> None:
    source = recorded("pour")
    scene = numbered_scene(source, number, SEED)
    bowl = scene.thing("bowl")
    apart = np.array(bowl.place[:2]) - source.scene.thing("bowl").place[:2]
    assert np.linalg.norm(apart) > 0.02
    draft = reachable(source, scene, body("man", source))
    (poise,) = source.leanings
    mug = draft.things["mug"][poise.lowest].apply(np.array(scene.thing("mug").shape.vertices))
    opening = np.asarray(bowl.place) + bowl.size * [0.0, 0.0, 1.0]
    lip = mug[np.argmin(np.linalg.norm(mug - opening, axis=1))]
    assert np.linalg.norm(lip[:2] - opening[:2]) < 0.5 * bowl.size[0]
    assert lip[2] > opening[2]


def test_a_thing_that_only_turns_is_turned_as_far() -> None:
    source = recorded("turn")
    scene = numbered_scene(source, 1, SEED)
    draft = reachable(source, scene, body("child", source))
    path = draft.things["mug"]
    turned = (path.rotation[-1] * path.rotation[0].inv()).as_rotvec()
    np.testing.assert_allclose(turned, [0.0, 0.0, np.radians(40.0)], atol=np.radians(1.0))
    np.testing.assert_allclose(path.translation[-1], path.translation[0], atol=0.002)
