"""The Flock of Birds driver reads what its simulator sends, on clean, bad and broken lines."""

import numpy as np
import pytest
import tracked

from capar.model.errors import DeviceError
from extractors.devices.bird_formats import FORMATS
from extractors.devices.flock import (
    MOST_HZ,
    FlockLayout,
    FlockRig,
    FlockSimulator,
    FlockTracker,
)
from extractors.devices.simulator import Faults, Sent, SmoothMotion
from extractors.devices.tracker import parse_address

SECONDS = 0.8
WHOLE_S = 0.4
"""Of a line without faults, on which each record is sent and received alike [s]."""

QUIET_S = 0.05
SETTLE = "settle=0.2"


def tracker(simulator: FlockSimulator, options: str) -> FlockTracker:
    return FlockTracker(parse_address(f"flock:{simulator.place}?{SETTLE}&{options}"))


def highest(form: str, birds: int, *, group: bool) -> float:
    """The highest rate that the line carries, in tenths [Hz]."""
    limit_hz = FlockLayout(FORMATS[form], group).limit_hz(birds, 115200)
    return int(10.0 * min(MOST_HZ, limit_hz)) / 10.0


@pytest.mark.parametrize("mode", ["stream", "point"])
@pytest.mark.parametrize("birds", [1, 12])
@pytest.mark.parametrize("form", FORMATS)
def test_every_format_and_mode_arrives_whole_at_the_highest_rate_of_the_line(
    form: str, birds: int, mode: str
) -> None:
    log: list[Sent] = []
    group = birds > 1
    rig = FlockRig(erc=group, quiet_s=QUIET_S)
    rate_hz = highest(form, birds, group=group)
    with FlockSimulator(SmoothMotion(birds), rig, log=log) as simulator:
        options = f"birds={birds}&erc={'yes' if group else 'no'}&format={form}&mode={mode}"
        with tracker(simulator, f"{options}&rate={rate_hz}") as flock:
            frames = tracked.take(flock, int(WHOLE_S * rate_hz) if mode == "stream" else 10)
    assert flock.counts.lost_records == 0
    assert flock.counts.refused_records == 0
    assert simulator.skipped == 0
    for each in tracked.held_by_flock(
        frames, log, form, group=group, range_inch=144.0 if group else 36.0
    ):
        assert each.wrong == 0
        assert each.accepted == each.sent


@pytest.mark.parametrize("birds", [1, 12])
@pytest.mark.parametrize("form", ["pos", "pos_quat", "pos_mat"])
def test_with_bytes_lost_nothing_wrong_is_accepted_and_nine_tenths_of_the_good_are_kept(
    form: str, birds: int
) -> None:
    log: list[Sent] = []
    rig = FlockRig(quiet_s=QUIET_S)
    rate_hz = highest(form, birds, group=birds > 1)
    with (
        FlockSimulator(SmoothMotion(birds), rig, Faults(0.005, seed=3), log) as simulator,
        tracker(simulator, f"birds={birds}&format={form}&rate={rate_hz}") as flock,
    ):
        frames = tracked.take(flock, int(2.0 * SECONDS * rate_hz))
    every = tracked.held_by_flock(frames, log, form, group=birds > 1, range_inch=36.0)
    assert sum(each.wrong for each in every) == 0
    assert sum(each.accepted for each in every) >= 0.9 * sum(each.intact for each in every)
    damaged = sum(each.sent - each.intact for each in every)
    assert damaged > 0
    assert flock.counts.lost_records >= 0.5 * damaged


def test_a_bird_with_a_line_of_its_own_is_read_beside_the_others() -> None:
    log: list[Sent] = []
    rig = FlockRig(line_a_bird=True, quiet_s=QUIET_S)
    with (
        FlockSimulator(SmoothMotion(4), rig, log=log) as simulator,
        tracker(simulator, "rate=103.3&format=pos_quat") as flock,
    ):
        frames = tracked.take(flock, int(SECONDS * 103.3))
    assert flock.describe().sensors == ("bird1", "bird2", "bird3", "bird4")
    for each in tracked.held_by_flock(frames, log, "pos_quat", group=False, range_inch=36.0):
        assert each.wrong == 0
    whole = [each for each in frames if not np.isnan(each.positions).any()]
    assert len(whole) > 0.95 * len(frames)


def test_wrong_addresses_are_refused_and_counted_as_lost() -> None:
    log: list[Sent] = []
    faults = Faults(wrong_address_share=0.1, seed=1)
    with (
        FlockSimulator(SmoothMotion(5), FlockRig(quiet_s=QUIET_S), faults, log) as simulator,
        tracker(simulator, "birds=5&rate=60") as flock,
    ):
        frames = tracked.take(flock, 60)
    every = tracked.held_by_flock(frames, log, "pos_quat", group=True, range_inch=36.0)
    assert sum(each.wrong for each in every) == 0
    assert flock.counts.refused_records > 5
    assert flock.counts.lost_records > 5


@pytest.mark.parametrize("mode", ["stream", "point"])
def test_a_pulled_plug_is_survived_and_told(mode: str) -> None:
    log: list[Sent] = []
    with (
        FlockSimulator(SmoothMotion(3), FlockRig(quiet_s=QUIET_S), log=log) as simulator,
        tracker(simulator, f"birds=3&rate=60&mode={mode}") as flock,
    ):
        before = tracked.take(flock, 10)
        simulator.unplug()
        assert tracked.collect(flock, 0.5) == []
        simulator.replug()
        after = tracked.take(flock, 20)
    assert flock.counts.reconnections == 1
    assert [each.message.split(":")[0] for each in flock.events] == [
        "connection lost", "connected again"
    ]  # fmt: skip
    for each in tracked.held_by_flock(
        [*before, *after], log, "pos_quat", group=True, range_inch=36.0
    ):
        assert each.wrong == 0


def test_with_the_true_pauses_the_flock_is_configured_and_without_them_it_is_not() -> None:
    with FlockSimulator(SmoothMotion(2)) as simulator:
        with FlockTracker(parse_address(f"flock:{simulator.place}?birds=2&rate=60")) as flock:
            assert tracked.take(flock, 5)
        with pytest.raises(DeviceError, match=r"error 13|error 9"):
            FlockTracker(parse_address(f"flock:{simulator.place}?birds=2&{SETTLE}")).open()


def test_a_missing_bird_is_told_with_its_number() -> None:
    rig = FlockRig(quiet_s=QUIET_S, missing=(3,))
    with (
        FlockSimulator(SmoothMotion(3), rig) as simulator,
        pytest.raises(DeviceError, match=r"error 13: a bird on the bus .* \(unit 3\)"),
    ):
        tracker(simulator, "birds=3").open()


def test_an_error_of_the_device_is_told_in_words() -> None:
    with (
        FlockSimulator(SmoothMotion(1), FlockRig(quiet_s=QUIET_S), Faults(error=29)) as simulator,
        pytest.raises(DeviceError, match=r"error 29: the transmitter is not active"),
    ):
        tracker(simulator, "birds=1").open()


def test_a_rate_that_the_line_cannot_carry_is_refused_with_the_arithmetic() -> None:
    with pytest.raises(DeviceError, match=r"12 x 15 bytes .* 18594 bytes a second, .* 64 Hz"):
        FlockTracker(parse_address("flock:/dev/x?birds=12&rate=103.3"))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("bird=3", "no option 'bird'"),
        ("birds=0", "between 1 and 13"),
        ("birds=14", "between 1 and 13"),
        ("birds=2.5", "no whole number"),
        ("format=quaternion", "no format 'quaternion'"),
        ("rate=fast", "no number"),
        ("birds=2&names=a", "lists 1 names; there are 2 sensors"),
        ("birds=2&names=a,a", "twice"),
        ("names=Hand", "sensor name 'Hand'"),
        ("baud=9600&rate=100", "does not pass the line"),
        ("rate=100&every=2", "the birds do 144"),
        ("erc=maybe", "no erc 'maybe'"),
        ("birds", "not of the form NAME=VALUE"),
    ],
)
def test_a_wrong_option_is_told(options: str, said: str) -> None:
    with pytest.raises(Exception, match=said):
        FlockTracker(parse_address(f"flock:/dev/x?{options}"))
