"""The same trial in another world: turned, with other names, or in another order."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from capar.model import geometry
from capar.model.capture import Capture, PivotContact, Purpose, Sensor, Stream, TagObject


def rotated(capture: Capture, rotation: Rotation) -> Capture:
    """Every pose turned about the world's origin."""

    def turned(stream: Stream) -> Stream:
        orientations = np.full_like(stream.orientations, np.nan)
        known = ~stream.lost
        orientations[known] = geometry.quaternions(
            rotation * geometry.rotations(stream.orientations[known])
        )
        return Stream(stream.times, stream.positions @ rotation.as_matrix().T, orientations)

    return replace(
        capture,
        sensors=tuple(replace(each, stream=turned(each.stream)) for each in capture.sensors),
        objects=tuple(replace(each, stream=turned(each.stream)) for each in capture.objects),
    )


def renamed(capture: Capture, mapping: Mapping[str, str]) -> Capture:
    """Sensors and objects under other names; those that are not in the mapping keep theirs."""

    def new(name: str) -> str:
        return mapping.get(name, name)

    def pivot(pair: PivotContact) -> PivotContact:
        return replace(pair, first=new(pair.first), second=new(pair.second))

    def purpose(each: Purpose) -> Purpose:
        return replace(each, object=new(each.object), goal=new(each.goal))

    return replace(
        capture,
        sensors=tuple(replace(each, name=new(each.name)) for each in capture.sensors),
        objects=tuple(replace(each, name=new(each.name)) for each in capture.objects),
        pivot_contacts=tuple(map(pivot, capture.pivot_contacts)),
        purposes=tuple(map(purpose, capture.purposes)),
    )


def reordered(capture: Capture, seed: int) -> Capture:
    """Sensors, and objects, in another order."""
    random = np.random.default_rng(seed)
    sensors: list[Sensor] = [capture.sensors[i] for i in random.permutation(len(capture.sensors))]
    objects: list[TagObject] = [
        capture.objects[i] for i in random.permutation(len(capture.objects))
    ]
    return replace(capture, sensors=tuple(sensors), objects=tuple(objects))
