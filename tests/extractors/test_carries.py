"""Carries that others recorded begin and end when their motion does, to a tenth of a second.

The recordings know an object only while it is carried. Each is extended at rest before its first
and after its last pose, so that where its stream begins or ends tells nothing.
"""

import json
import os
import tarfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Stream, TagObject, TagType
from extractors.motion_edges import motion_edges
from extractors.object_motion import motion_floor, moving, stays
from extractors.poses import poses
from extractors.thresholds import Thresholds

DATA = Path(os.environ.get("CAPAR_DATA", Path(__file__).parents[3] / "shared" / "data"))
ARCHIVE = DATA / "boxed_vr" / "boxed_dev_16scenes.tar.xz"
LIMITS = Thresholds()
RATE_HZ = 50.0
REST_S = 2.0
NEAR_S = 0.1

pytestmark = pytest.mark.skipif(not ARCHIVE.exists(), reason=f"no recording at {ARCHIVE}")


def _recorded() -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Times [s], places [m] and rotation matrices of every carry."""
    with tarfile.open(ARCHIVE) as archive:
        for member in archive:
            name = Path(member.name).name
            if not name.endswith("_trajectory.json") or name.startswith("main_camera"):
                continue
            file = archive.extractfile(member)
            assert file is not None
            rows = json.load(file)
            times = np.array([row["timeStamp"] for row in rows]) / 1000.0
            keep = np.r_[True, np.diff(times) > 0.0]
            places = np.array([row["translation"] for row in rows], float).reshape(-1, 3)
            turns = np.array([row["rotation"] for row in rows], float).reshape(-1, 3, 3)
            yield times[keep], places[keep], turns[keep]


def _errors() -> np.ndarray:
    """Onset and offset of each carry minus the recorded ones [s]; NaN where none is found."""
    mirror = np.diag([-1.0, 1.0, 1.0])
    out = []
    for times, places, turns in _recorded():
        clock = np.arange(times[0] - REST_S, times[-1] + REST_S, 1.0 / RATE_HZ)
        resampled = [np.interp(clock, times, places[:, axis]) for axis in range(3)]
        quaternions = geometry.continuous(
            geometry.quaternions(Rotation.from_matrix(mirror @ turns @ mirror))
        )
        thing = TagObject(
            "thing",
            TagType.MOBILE,
            Stream(
                clock - clock[0],
                np.stack(resampled, axis=1) @ mirror,
                geometry.slerp(times, quaternions, clock),
            ),
        )
        where = poses(thing, LIMITS)
        floor = motion_floor(where.noise, RATE_HZ, own_m=None, thresholds=LIMITS)
        found = moving(where, floor, LIMITS)
        if not found:
            out.append((np.nan, np.nan))
            continue
        rests = stays(where, floor, LIMITS)
        begin, _ = motion_edges(where, found[0], rests, LIMITS)
        _, end = motion_edges(where, found[-1], rests, LIMITS)
        out.append((clock[begin] - times[0], clock[end] - times[-1]))
    return np.array(out)


def test_recorded_carries_are_found_from_their_motion_alone() -> None:
    """What is missed lay still in the gripper: it had come to rest before it was let go."""
    errors = _errors()
    assert len(errors) == 285
    assert not np.isnan(errors).any()
    near = np.abs(errors) <= NEAR_S
    assert near[:, 0].mean() >= 0.95
    assert near.mean() >= 0.95
    late = errors[~near[:, 1], 1]
    assert (late < 0.0).all()
