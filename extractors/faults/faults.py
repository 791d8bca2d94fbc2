"""All faults of a recording that it shows by itself, as notices with the likely remedy."""

from collections.abc import Iterator

from capar.model.capture import Capture
from capar.model.notices import Notice
from extractors.bodies.bodies import Bodies
from extractors.faults.gravity import gravity_notices
from extractors.faults.person_size import is_sized, size_notices
from extractors.faults.sides import side_notices
from extractors.thresholds import Thresholds


def faults(capture: Capture, bodies: Bodies, thresholds: Thresholds) -> Iterator[Notice]:
    """Notices of what cannot be: falls, sizes and sides that contradict what was declared.

    Args:
        capture: The trial.
        bodies: Its bodies.
        thresholds: What separates odd from impossible.
    """
    sized = is_sized(capture, thresholds)
    yield from gravity_notices(capture, bodies, thresholds, sized=sized)
    yield from size_notices(capture, thresholds)
    yield from side_notices(capture, thresholds)
