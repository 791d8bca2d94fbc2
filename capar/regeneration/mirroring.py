"""A capture as a mirror shows it: what one hand did, the other does."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from capar.model.capture import Capture, PivotContact, Shape, Stream

LOCAL = np.diag([1.0, -1.0, 1.0])
"""How each body's own frame is mirrored, so that it stays right-handed."""

OTHER = {"right": "left", "left": "right"}


def mirrored(capture: Capture, place: tuple[float, float], heading: float) -> Capture:
    """The capture mirrored at the performer's median plane, hands renamed.

    Args:
        capture: As it was recorded.
        place: Where the performer stands [m].
        heading: Which way the performer faces [rad].
    """
    normal = np.array([-np.sin(heading), np.cos(heading), 0.0])
    plane = np.eye(3) - 2.0 * np.outer(normal, normal)
    origin = np.array([*place, 0.0])
    names = {sensor.name: _renamed(sensor.name) for sensor in capture.sensors}
    sensors = tuple(
        replace(
            sensor,
            name=names[sensor.name],
            side=OTHER.get(sensor.side, sensor.side),
            link=_renamed(sensor.link),
            stream=_stream(sensor.stream, plane, origin),
            shape=mirrored_shape(sensor.shape),
            gaze=_vector(sensor.gaze),
            eye=_vector(sensor.eye),
            part_of=names.get(sensor.part_of, sensor.part_of),
        )
        for sensor in capture.sensors
    )
    objects = tuple(
        replace(
            thing, stream=_stream(thing.stream, plane, origin), shape=mirrored_shape(thing.shape)
        )
        for thing in capture.objects
    )
    return replace(
        capture,
        sensors=sensors,
        objects=objects,
        pivot_contacts=tuple(_pivot(pair, names) for pair in capture.pivot_contacts),
        purposes=(),
        conventions={
            names.get(name, name): convention for name, convention in capture.conventions.items()
        },
    )


def _pivot(pair: PivotContact, names: Mapping[str, str]) -> PivotContact:
    first, second = pair.first, pair.second
    return replace(pair, first=names.get(first, first), second=names.get(second, second))


def _renamed(name: str) -> str:
    """``right_hand`` and ``hand_right`` for the other side."""
    return "_".join(OTHER.get(part, part) for part in name.split("_"))


def _stream(
    stream: Stream, plane: Float[np.ndarray, "3 3"], origin: Float[np.ndarray, "3"]
) -> Stream:
    known = ~stream.lost
    spots, turns = np.full_like(stream.positions, np.nan), np.full_like(stream.orientations, np.nan)
    spots[known] = (stream.positions[known] - origin) @ plane + origin
    before = Rotation.from_quat(stream.orientations[known], scalar_first=True).as_matrix()
    turned = Rotation.from_matrix(plane @ before @ LOCAL)
    turns[known] = turned.as_quat(scalar_first=True)
    return Stream(np.array(stream.times), spots, turns)


def mirrored_shape(shape: Shape | None) -> Shape | None:
    """A shape mirrored in its own frame, so that the frame stays right-handed."""
    if shape is None:
        return None
    faces = np.array(shape.faces)[:, ::-1]
    return Shape(np.array(shape.vertices) @ LOCAL, faces, shape.source, shape.description)


def _vector(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = vector
    return (x, -y, z)
