"""All faults that a recording shows by itself, as notices with the likely remedy."""

from collections.abc import Iterator, Mapping, Sequence

from capar.model.capture import Capture
from capar.model.notices import Notice
from extractors.bodies.bodies import Bodies
from extractors.contact.contacts import Contact
from extractors.faults.gravity import gravity_notices
from extractors.faults.person_size import is_sized, shape_notices, size_notices
from extractors.faults.rests import rest_notices
from extractors.faults.sides import side_notices
from extractors.signals.intervals import Interval
from extractors.thresholds import Thresholds


def faults(
    capture: Capture,
    bodies: Bodies,
    touches: Sequence[Contact],
    motions: Mapping[str, list[Interval]],
    thresholds: Thresholds,
) -> Iterator[Notice]:
    """Notices of what cannot be: falls, rests, sizes and sides that contradict what was declared.

    A fall shows axis and unit exactly; rests and sizes are asked only where no fall does.

    Args:
        capture: The trial.
        bodies: Its bodies.
        touches: Who touches whom, and when.
        motions: When each object moves.
        thresholds: What separates odd from impossible.
    """
    if not capture.acting:
        yield Notice("nothing-acts")
    sized = is_sized(capture, thresholds)
    falls = list(gravity_notices(capture, bodies, thresholds, sized=sized))
    yield from falls
    if not any(each.code == "up-contradicted" for each in falls):
        yield from rest_notices(capture, bodies, touches, motions, thresholds)
    if not any(each.code == "unit-contradicted" for each in falls):
        yield from size_notices(capture, thresholds)
    yield from shape_notices(capture, thresholds)
    yield from side_notices(capture, thresholds)
