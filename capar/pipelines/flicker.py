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
    for each in facts:
        if isinstance(each, FlickerCorrection):
            yield notice(
                "flicker",
                *dict.fromkeys((each.body, each.other)),
                start_s=each.first / rate_hz,
                end_s=each.last / rate_hz,
                length_s=(each.last - each.first + 1) / rate_hz,
                taken=each.taken,
            )
