"""What was taken for flicker, as notices: which bodies, when, and what was taken instead."""

from collections.abc import Iterable, Iterator

from capar.model.facts import Fact, FlickerCorrection
from capar.model.notices import Notice, notice


def flicker_notices(facts: Iterable[Fact], rate_hz: float) -> Iterator[Notice]:
    """A notice for each stretch that is not taken as it was measured.

    Args:
        facts: Measurements and corrections.
        rate_hz: Frames a second.
    """
    for fact in facts:
        if isinstance(fact, FlickerCorrection):
            yield notice(
                "flicker",
                *dict.fromkeys((fact.body, fact.other)),
                start_s=fact.first / rate_hz,
                end_s=fact.last / rate_hz,
                length_s=(fact.last - fact.first + 1) / rate_hz,
                taken=fact.taken,
            )
