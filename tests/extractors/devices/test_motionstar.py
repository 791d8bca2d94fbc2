"""The MotionStar driver reads what its simulated server sends, over TCP and UDP."""

import numpy as np
import pytest
import tracked

from capar.model.errors import DeviceError
from extractors.devices.bird_formats import FORMATS
from extractors.devices.flock import MOST_HZ
from extractors.devices.motionstar import MotionStarSimulator, MotionStarTracker
from extractors.devices.simulator import Faults, Sent, SmoothMotion
from extractors.devices.tracker import parse_address


def tracker(simulator: MotionStarSimulator, options: str) -> MotionStarTracker:
    return MotionStarTracker(parse_address(f"motionstar:{simulator.place}?{options}"))


@pytest.mark.parametrize("transport", ["tcp", "udp"])
@pytest.mark.parametrize("form", FORMATS)
def test_every_format_arrives_whole_at_the_highest_rate(form: str, transport: str) -> None:
    log: list[Sent] = []
    with MotionStarSimulator(SmoothMotion(12), log=log) as simulator:
        options = f"transport={transport}&format={form}&rate={MOST_HZ:g}"
        with tracker(simulator, options) as motionstar:
            frames = tracked.take(motionstar, 100)
    assert motionstar.counts.lost_records == 0
    assert motionstar.counts.refused_records == 0
    for each in tracked.held_by_motionstar(frames, log, form):
        assert each.wrong == 0
        assert each.accepted == each.sent


def test_lost_packets_are_counted_and_the_others_kept() -> None:
    log: list[Sent] = []
    with (
        MotionStarSimulator(SmoothMotion(3), Faults(0.1, seed=1), log) as simulator,
        tracker(simulator, "birds=3&transport=udp") as motionstar,
    ):
        frames = tracked.take(motionstar, 100)
    for each in tracked.held_by_motionstar(frames, log, "pos_quat"):
        assert each.wrong == 0
        assert each.accepted == each.intact < each.sent
        assert motionstar.counts.lost_records == 3 * (each.sent - each.intact)


def test_a_server_that_does_not_number_its_packets_is_told() -> None:
    with (
        MotionStarSimulator(SmoothMotion(2), Faults(numbered=False)) as simulator,
        tracker(simulator, "birds=2") as motionstar,
    ):
        tracked.take(motionstar, 20)
    assert [each.message for each in motionstar.events] == [
        "the server does not number its packets, so losses cannot be counted"
    ]


@pytest.mark.parametrize("transport", ["tcp", "udp"])
def test_a_pulled_plug_is_survived_and_told(transport: str) -> None:
    log: list[Sent] = []
    with (
        MotionStarSimulator(SmoothMotion(2), log=log) as simulator,
        tracker(simulator, f"birds=2&transport={transport}") as motionstar,
    ):
        before = tracked.take(motionstar, 10)
        simulator.unplug()
        before += tracked.collect(motionstar, 0.4)
        simulator.replug()
        after = tracked.take(motionstar, 20)
    assert motionstar.counts.reconnections == 1
    assert motionstar.events[0].message.startswith("connection lost")
    for each in tracked.held_by_motionstar([*before, *after], log, "pos_quat"):
        assert each.wrong == 0


def test_time_stamps_of_the_server_are_passed_on() -> None:
    with (
        MotionStarSimulator(SmoothMotion(1)) as simulator,
        tracker(simulator, "birds=1&rate=100&every=2") as motionstar,
    ):
        frames = tracked.take(motionstar, 20)
    steps = np.diff([each.device_s or 0.0 for each in frames])
    assert steps == pytest.approx(0.02, abs=0.0011)
    assert motionstar.describe().rate_hz == 50.0


def test_a_server_with_other_birds_is_refused_with_those_it_has() -> None:
    with (
        MotionStarSimulator(SmoothMotion(2)) as simulator,
        pytest.raises(DeviceError, match=r"has 2 birds, at \[2, 3\]; birds=12"),
    ):
        tracker(simulator, "rate=100").open()
