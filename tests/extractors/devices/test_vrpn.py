"""The VRPN client reads what a simulated server sends."""

import socket
import threading

import numpy as np
import pytest
import tracked

from capar.model.errors import DeviceError
from extractors.devices.simulator import Sent, SmoothMotion
from extractors.devices.tracker import parse_address
from extractors.devices.vrpn import VrpnSimulator, VrpnTracker, decode_pose


def tracker(simulator: VrpnSimulator, options: str) -> VrpnTracker:
    return VrpnTracker(parse_address(f"vrpn:{simulator.place}?{options}"))


def test_every_pose_arrives() -> None:
    log: list[Sent] = []
    with VrpnSimulator(SmoothMotion(4), 120.0, log) as simulator:
        with tracker(simulator, "sensors=4") as vrpn:
            frames = tracked.take(vrpn, 150)
        assert simulator.answers >= 1
    assert vrpn.counts.refused_records == 0
    assert not any(np.isnan(each.positions).any() for each in frames)
    for each in tracked.held_by_vrpn(frames, log):
        assert each.wrong == 0
        assert each.accepted == each.sent


def test_a_lost_connection_is_survived_and_told() -> None:
    log: list[Sent] = []
    with (
        VrpnSimulator(SmoothMotion(2), 100.0, log) as simulator,
        tracker(simulator, "sensors=2") as vrpn,
    ):
        before = tracked.take(vrpn, 10)
        simulator.unplug()
        before += tracked.collect(vrpn, 0.3)
        simulator.replug()
        after = tracked.take(vrpn, 20)
    assert vrpn.counts.reconnections == 1
    for each in tracked.held_by_vrpn([*before, *after], log):
        assert each.wrong == 0


@pytest.mark.parametrize("up", ["x", "y", "-z"])
def test_the_axis_that_is_up_becomes_z(up: str) -> None:
    log: list[Sent] = []
    with (
        VrpnSimulator(SmoothMotion(1), 100.0, log) as simulator,
        tracker(simulator, f"up={up}") as vrpn,
    ):
        frames = tracked.take(vrpn, 10)
    axis, sign = "xyz".index(up[-1]), -1.0 if up.startswith("-") else 1.0
    heights = [each.positions[0, 2] for each in frames]
    poses = [decode_pose(each.data) for each in log[: len(heights)]]
    sent = [sign * pose[1][axis] for pose in poses if pose is not None]
    assert heights == pytest.approx(sent)


def test_a_server_that_is_no_vrpn_is_refused() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]

        def answer() -> None:
            client, _ = server.accept()
            client.sendall(b"SSH-2.0-OpenSSH_9.2p1 Debian-2\r\n")
            client.close()

        thread = threading.Thread(target=answer)
        thread.start()
        with pytest.raises(DeviceError, match="no VRPN 7 server"):
            VrpnTracker(parse_address(f"vrpn:T@127.0.0.1:{port}")).open()
        thread.join()
