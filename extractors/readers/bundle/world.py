"""From a file's unit and axes to metres in a right-handed world whose z axis points up."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Conventions, Notice, Source, Stream, upward
from capar.model.errors import CaptureError
from extractors.faults.quaternion_order import order_notices
from extractors.readers.recording import UNITS, Recording
from extractors.thresholds import Thresholds

LARGEST_M = 100.0
"""No room for motion capture spans more [m]."""

SMALLEST_M = 0.005
"""Nor do sensors and objects together span less [m]."""


@dataclass(frozen=True, eq=False)
class WorldRecording:
    """A recording in metres, right-handed, z up."""

    source: Source
    bodies: Mapping[str, Stream]
    markers: Mapping[str, Float[np.ndarray, "frames 3"]]
    marker_times: Float[np.ndarray, "frames"]
    parents: Mapping[str, str]
    notices: tuple[Notice, ...]
    conventions: Conventions
    """By which it was brought there."""

    places: Mapping[str, str] = field(default_factory=dict)
    """Place on the body of joints and markers, where the capture states it."""

    @property
    def mirrored(self) -> bool:
        """Whether the file's world is left-handed, so that shapes made for it must be mirrored."""
        return self.conventions.left_handed


def to_world(recording: Recording, *, unit_m: float, up: str, left_handed: bool) -> WorldRecording:
    """A recording brought to the world; a left-handed one is mirrored in x.

    Raises:
        CaptureError: The recording then spans what no room spans: a wrong unit.
    """
    turn = upward(up)
    bodies = {
        name: _moved(each, unit_m, turn, left_handed) for name, each in recording.bodies.items()
    }
    markers = {
        name: turn.apply(mirrored(each * unit_m) if left_handed else each * unit_m)
        for name, each in recording.markers.items()
    }
    check_span(recording.source.path, bodies, markers, unit_m)
    return WorldRecording(
        source=recording.source,
        bodies=bodies,
        markers=markers,
        marker_times=recording.marker_times,
        parents=recording.parents,
        notices=(
            *recording.notices,
            *order_notices(recording.bodies, recording.orders, unit_m, Thresholds()),
        ),
        conventions=Conventions(unit_m, up, left_handed),
    )


def mirrored(points: Float[np.ndarray, "points 3"]) -> Float[np.ndarray, "points 3"]:
    """Points with x negated."""
    return np.asarray(points * np.array([-1.0, 1.0, 1.0]))


def _moved(stream: Stream, unit_m: float, turn: Rotation, left_handed: bool) -> Stream:
    positions, orientations = stream.positions * unit_m, stream.orientations
    if left_handed:
        positions = mirrored(positions)
        orientations = orientations * np.array([1.0, 1.0, -1.0, -1.0])
    known = ~stream.lost
    turned = np.full_like(orientations, np.nan)
    if known.any():
        turned[known] = geometry.quaternions(turn * geometry.rotations(orientations[known]))
    return Stream(times=stream.times, positions=turn.apply(positions), orientations=turned)


def check_span(
    path: str,
    bodies: Mapping[str, Stream],
    markers: Mapping[str, Float[np.ndarray, "frames 3"]],
    unit_m: float,
) -> None:
    """Check that a recording is of the size of people.

    Raises:
        CaptureError: It is not; the message names the unit that would make it so.
    """
    every = [each.positions for each in bodies.values()] + list(markers.values())
    points = np.concatenate(every)
    points = points[~np.isnan(points).any(axis=1)]
    if not len(points):
        raise CaptureError(f"{path}: no body or marker is seen in any frame")
    # the middle nine tenths: a few wild samples do not decide about the unit
    low, high = np.quantile(points, [0.05, 0.95], axis=0)
    span = float(np.linalg.norm(high - low))
    if span > LARGEST_M or (span < SMALLEST_M and len(every) > 1):
        likely = _likely_unit(span / unit_m)
        raise CaptureError(
            f"{path}: in this unit ({unit_m:g} m) the recording spans {span:.4g} m; people move "
            f'in a few metres. The unit is likely {likely!r}: state unit = "{likely}"'
        )


def _likely_unit(span: float) -> str:
    """The unit in which a span is one of a person at work; the usual ones first."""
    fitting = [name for name in ("m", "mm", *UNITS) if 0.1 <= span * UNITS[name] <= 20.0]
    return fitting[0] if fitting else "m"
