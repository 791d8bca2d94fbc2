"""Lab Streaming Layer on this computer alone: its settings, and a sender of poses."""

import time
from typing import Any

import numpy as np

from extractors.devices.lsl import PARTS
from extractors.devices.tracker import Frame

LOOPBACK = """
[ports]
IPv6=disable
[multicast]
ResolveScope=machine
ListenAddress=127.0.0.1
AddressesOverride={127.0.0.1}
[lab]
KnownPeers={127.0.0.1}
"""


class LslOutlet:
    """Sends frames into the network, as ``LslTracker`` reads them."""

    def __init__(self, name: str, sensors: tuple[str, ...], rate_hz: float) -> None:
        import pylsl  # which reads its settings as it is loaded

        self._clock = pylsl.local_clock
        info = pylsl.StreamInfo(
            name, "MoCap", len(PARTS) * len(sensors), rate_hz, pylsl.cf_double64, f"capar-{name}"
        )
        channels = info.desc().append_child("channels")
        for sensor in sensors:
            for part in PARTS:
                channel = channels.append_child("channel")
                channel.append_child_value("object", sensor)
                channel.append_child_value("type", part)
                unit = "meters" if part.startswith("Position") else "quaternion"
                channel.append_child_value("unit", unit)
        self._outlet: Any = pylsl.StreamOutlet(info)

    def push(self, frame: Frame) -> None:
        """Send a frame, with the time at which it arrived here."""
        values = np.hstack([frame.positions, frame.orientations]).ravel()
        ahead_s = self._clock() - time.monotonic()
        self._outlet.push_sample(values.tolist(), frame.host_s + ahead_s)

    def close(self) -> None:
        """End the stream."""
        self._outlet = None
