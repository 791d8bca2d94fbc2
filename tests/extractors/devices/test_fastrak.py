"""The Fastrak driver reads what its simulator sends, in ASCII and binary."""

import pytest
import tracked

from capar.model.errors import DeviceError
from extractors.devices.fastrak import ITEMS, FastrakSimulator, FastrakTracker
from extractors.devices.simulator import Faults, Sent, SmoothMotion
from extractors.devices.tracker import parse_address


def tracker(simulator: FastrakSimulator, options: str) -> FastrakTracker:
    return FastrakTracker(parse_address(f"fastrak:{simulator.place}?{options}"))


@pytest.mark.parametrize("mode", ["stream", "point"])
@pytest.mark.parametrize("encoding", ["binary", "ascii"])
@pytest.mark.parametrize("stations", [1, 4])
@pytest.mark.parametrize("form", ITEMS)
def test_every_format_and_mode_arrives_whole(
    form: str, stations: int, encoding: str, mode: str
) -> None:
    log: list[Sent] = []
    with FastrakSimulator(SmoothMotion(stations), log=log) as simulator:
        options = f"format={form}&stations={stations}&encoding={encoding}&mode={mode}"
        with tracker(simulator, options) as fastrak:
            frames = tracked.take(fastrak, 40 // stations)
    assert simulator.skipped == 0
    assert fastrak.counts.lost_records == 0
    assert fastrak.counts.dropped_bytes == 0
    for each in tracked.held_by_fastrak(frames, log, form, binary=encoding == "binary"):
        assert each.wrong == 0
        assert each.accepted == each.sent


@pytest.mark.parametrize("encoding", ["binary", "ascii"])
def test_with_bytes_lost_nothing_wrong_is_accepted_and_nine_tenths_of_the_good_are_kept(
    encoding: str,
) -> None:
    log: list[Sent] = []
    faults = Faults(lost_share=0.005, seed=4)
    with (
        FastrakSimulator(SmoothMotion(4), faults, log) as simulator,
        tracker(simulator, f"stations=4&encoding={encoding}") as fastrak,
    ):
        frames = tracked.take(fastrak, 50)
    every = tracked.held_by_fastrak(frames, log, "pos_quat", binary=encoding == "binary")
    assert sum(each.wrong for each in every) == 0
    assert sum(each.accepted for each in every) >= 0.9 * sum(each.intact for each in every)
    damaged = sum(each.sent - each.intact for each in every)
    assert damaged > 0
    assert fastrak.counts.lost_records >= 0.5 * damaged


def test_a_line_that_is_too_slow_is_refused_with_the_arithmetic() -> None:
    with pytest.raises(DeviceError, match=r"120 records of 54 bytes are 6480 .* carry 960"):
        FastrakTracker(parse_address("fastrak:/dev/x?encoding=ascii&baud=9600"))
