"""Quaternions in another order than declared are noticed where bodies turn as one."""

from pathlib import Path

import numpy as np
import pytest
from bundles import DRINKING
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import PERFORMERS, drink_from_mug
from motions.performers import Performer
from scipy.spatial.transform import Rotation
from write_demo import write_tables

from capar.model.capture import Stream
from capar.model.notices import Notice
from extractors.faults.quaternion_order import SHIFT, order_notices
from extractors.readers.bundle.capture_toml import read_capture
from extractors.thresholds import Thresholds

ROOT = Path(__file__).parents[3]
ORDERS = st.sampled_from(sorted(SHIFT))


def told(bodies: dict[str, Stream], declared: str) -> list[Notice]:
    return list(order_notices(bodies, dict.fromkeys(bodies, declared), 1.0, Thresholds()))


def misread(bodies: dict[str, Stream], declared: str) -> dict[str, Stream]:
    """The bodies of a file in the other order, read in the declared one."""
    shift = -SHIFT[declared][1]
    return {
        name: Stream(each.times, each.positions, np.roll(each.orientations, shift, axis=1))
        for name, each in bodies.items()
    }


@settings(max_examples=8, deadline=None)
@given(st.sampled_from(PERFORMERS), ORDERS, st.integers(0, 99))
def test_a_drink_read_in_the_wrong_order_is_noticed_and_the_sound_one_is_not(
    performer: Performer, declared: str, seed: int
) -> None:
    capture = drink_from_mug(performer, noise_m=0.0005, noise_rad=0.005, seed=seed).capture
    bodies = {name: capture.bodies[name].stream for name in ("right_hand", "mug")}
    assert told(bodies, declared) == []
    (each,) = told(misread(bodies, declared), declared)
    assert (each["declared"], each["order"]) == (declared, SHIFT[declared][0])


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 999), ORDERS)
def test_bodies_that_turn_each_for_itself_show_no_order(seed: int, declared: str) -> None:
    random = np.random.default_rng(seed)
    times = np.arange(600) / 100.0

    def wandering() -> Stream:
        turns = Rotation.from_rotvec(np.cumsum(random.normal(0.0, 0.05, (600, 3)), axis=0))
        places = np.cumsum(random.normal(0.0, 0.005, (600, 3)), axis=0) + random.normal(size=3)
        return Stream(times, places, turns.as_quat(scalar_first=True))

    assert told({"a": wandering(), "b": wandering()}, declared) == []


@pytest.mark.parametrize("order", ["xyzw", "wxyz"])
def test_a_bundle_with_the_wrong_order_is_told_what_to_state(tmp_path: Path, order: str) -> None:
    demo = read_capture(DRINKING)
    write_tables(demo, tmp_path)
    text = (DRINKING / "capture.toml").read_text(encoding="utf-8")
    path = '{ path = "motion.csv", order = "' + order + '" }'
    changed = text.replace('motion = "motion.csv"', f"motion = {path}")
    assert changed != text
    (tmp_path / "capture.toml").write_text(changed, encoding="utf-8")
    notices = [each for each in read_capture(tmp_path).notices if each.code == "order-contradicted"]
    assert [each["order"] for each in notices] == ([] if order == "xyzw" else ["xyzw"])
