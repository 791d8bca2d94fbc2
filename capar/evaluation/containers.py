"""What is reported to go into a container, compared with where it lay before and after."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from capar.model.capture import Capture, Shape, TagObject, TagType
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import DEFAULT, Profile

INTO = "into"


@dataclass(frozen=True, slots=True)
class Landing:
    """One object and one container."""

    object: str
    container: str
    reported: bool
    """Whether a segment says that the object goes into it."""

    true: bool
    """Whether its middle lies inside at the end and did not at the beginning."""


def landings(
    capture: Capture, containers: Iterable[str], *, rules: Profile | str = DEFAULT
) -> tuple[Landing, ...]:
    """Observe a capture and compare the preposition with the objects' first and last poses.

    The truth is given by the middle of an object's box and the extent of the container's alone.

    Raises:
        CaparError: The capture has no such container, or it has no shape.
    """
    names = list(containers)
    reported = {
        (body, other)
        for segment in observe(capture, rules=rules).segments
        for name, body, other in segment.prepositions
        if name == INTO and other in names
    }
    things = [each for each in capture.objects if each.tag is TagType.MOBILE and each.shape]
    return tuple(
        Landing(
            object=each.name,
            container=name,
            reported=(each.name, name) in reported,
            true=_inside(each, -1, capture.tag_object(name))
            and not _inside(each, 0, capture.tag_object(name)),
        )
        for name in names
        for each in things
    )


def halved(capture: Capture, container: str) -> tuple[Capture, tuple[str, str]]:
    """The capture with its container parted across the middle of its longest level side.

    What is put into one half is put beside the other.

    Returns:
        The capture in which two containers, marked as assumed, stand in the place of one; and
        their names.
    """
    whole = capture.tag_object(container)
    assert whole.shape is not None
    axis = int(np.argmax(whole.shape.size[:2]))
    halves = tuple(_half(whole, axis, side) for side in (-1.0, 1.0))
    others = tuple(each for each in capture.objects if each.name != container)
    return replace(capture, objects=(*others, *halves)), (halves[0].name, halves[1].name)


def _half(whole: TagObject, axis: int, side: float) -> TagObject:
    shape = whole.shape
    assert shape is not None
    vertices = np.array(shape.vertices)
    middle = float(shape.bounds[:, axis].mean())
    vertices[:, axis] = (vertices[:, axis] - middle) / 2.0 + middle
    vertices[:, axis] += side * float(shape.size[axis]) / 4.0
    word = "near" if side < 0.0 else "far"
    return replace(
        whole,
        name=f"{whole.name}_{word}",
        shape=Shape(vertices, np.array(shape.faces), shape.source, f"half of {shape.description}"),
        assumed=f"the {word} half of {whole.name}",
    )


def _inside(thing: TagObject, frame: int, container: TagObject) -> bool:
    """Whether the middle of an object's box lies in the container's, which stands level."""
    low, high = _box(container, frame)
    first, last = _box(thing, frame)
    middle = (first + last) / 2.0
    return bool(((middle >= low) & (middle <= high)).all())


def _box(thing: TagObject, frame: int) -> Float[np.ndarray, "2 3"]:
    """Lowest and highest corner along the world's axes [m]."""
    assert thing.shape is not None
    points = thing.stream.pose(frame).apply(np.array(thing.shape.vertices))
    return np.stack([points.min(axis=0), points.max(axis=0)])
