"""Lab Streaming Layer: poses as type MoCap, events as type Markers (extra ``live``: pylsl).

Channels follow the metadata of XDF's MoCap type: an ``object`` each sensor, of channel types
``PositionX`` to ``PositionZ`` in metres and ``OrientationA`` (the scalar) to ``OrientationD``.
The frame is right-handed, z up, as everywhere here; a sensor that is lost is NaN.
"""

import time
from typing import Any

import numpy as np

from capar.model.capture import NAME
from capar.model.errors import DeviceError
from extractors.devices.tracker import Address, Description, DeviceLostError, Frame, LiveTracker

PARTS = (
    "PositionX", "PositionY", "PositionZ",
    "OrientationA", "OrientationB", "OrientationC", "OrientationD",
)  # fmt: skip
MARKER_TYPE = "Markers"
BUFFER_S = 60  # Seconds of samples that are kept while nobody polls.
LAST_S = 0.5
"""So long a stream of markers stays after its last one [s]: the library drops what is unsent."""

CLOCK_S = 5.0  # How often the difference of the clocks is measured [s].
READS = 3  # How often two clocks are read to compare them; that read counts which took least.


def _pylsl() -> Any:
    try:
        import pylsl
    except (ImportError, RuntimeError) as error:
        raise DeviceError(
            f"Lab Streaming Layer is not installed ({error}); install capar[live]"
        ) from None
    return pylsl


def _losses() -> tuple[type[Exception], ...]:
    """The errors of the library by which a stream is lost."""
    from pylsl import util

    return util.LostError, util.TimeoutError


def _ahead_s(lsl: Any) -> float:
    """How far the library's clock is ahead of this computer's monotonic one [s]."""
    reads = [(time.monotonic(), lsl.local_clock(), time.monotonic()) for _ in range(READS)]
    before, there, after = min(reads, key=lambda read: read[2] - read[0])
    return float(there - (before + after) / 2.0)


class LslTracker(LiveTracker):
    """A stream of poses in the network.

    A frame's ``host_s`` is the sender's time stamp on this computer's clock, as Lab Streaming
    Layer estimates it, and ``device_s`` the sender's own.

    Args:
        address: Like ``lsl:NAME?timeout=3``; ``NAME`` is the stream's.

    Raises:
        CaparError: An option is unknown, or the library is missing.
    """

    def __init__(self, address: Address) -> None:
        super().__init__()
        self._lsl = _pylsl()
        self._address = address
        self._timeout_s = address.number("timeout", 3.0, low=0.1, high=60.0)
        address.close()
        self._inlet: Any = None
        self._columns = np.zeros((0, 7), int)
        self._names: tuple[str, ...] = ()
        self._rate_hz = float("nan")
        self._offset_s = 0.0
        self._offset_at_s = 0.0

    def describe(self) -> Description:
        """The stream and its sensors."""
        return Description("lsl", self._address.place, self._names, self._rate_hz)

    def _connect(self) -> None:
        found = self._lsl.resolve_byprop("name", self._address.place, timeout=self._timeout_s)
        if not found:
            raise self._address.error(
                f"no stream of that name within {self._timeout_s:g} s. Is it sent, in this network?"
            )
        self._inlet = self._lsl.StreamInlet(found[0], max_buflen=BUFFER_S, recover=False)
        try:
            info = self._inlet.info(timeout=self._timeout_s)
            self._rate_hz = info.nominal_srate() or float("nan")
            self._names, self._columns = self._layout(info)
            self._inlet.open_stream(timeout=self._timeout_s)
            self._measure_offset()
        except _losses() as error:
            raise DeviceLostError(f"{self._address.text}: {error}") from None

    def _layout(self, info: Any) -> tuple[tuple[str, ...], np.ndarray]:
        """The sensors' names and, for each, the channels of its seven numbers."""
        columns: dict[str, dict[str, int]] = {}
        channel = info.desc().child("channels").child("channel")
        for index in range(info.channel_count()):
            kind, name = channel.child_value("type"), channel.child_value("object")
            if kind in PARTS:
                columns.setdefault(name, {})[kind] = index
            unit = channel.child_value("unit")
            if kind.startswith("Position") and unit not in ("meters", "m"):
                raise self._address.error(f"positions in {unit or 'no unit'}; they are in meters")
            channel = channel.next_sibling("channel")
        whole = {name: each for name, each in columns.items() if len(each) == len(PARTS)}
        if not whole or not all(map(NAME.fullmatch, whole)):
            raise self._address.error(
                f"its channels {list(columns)} are no sensors: each has an object (a name in "
                f"lower case) and the types {', '.join(PARTS)}"
            )
        return tuple(whole), np.array([[each[part] for part in PARTS] for each in whole.values()])

    def _measure_offset(self) -> None:
        """From the sender's clock to this computer's monotonic one."""
        correction_s = self._inlet.time_correction(timeout=self._timeout_s)
        self._offset_s = correction_s - _ahead_s(self._lsl)
        self._offset_at_s = time.monotonic()

    def _disconnect(self) -> None:
        if self._inlet is not None:
            self._inlet.close_stream()
            self._inlet = None

    def _read(self, timeout_s: float) -> list[Frame]:
        try:
            sample, stamp_s = self._inlet.pull_sample(timeout=timeout_s)
            samples, stamps = self._inlet.pull_chunk(timeout=0.0)
            if time.monotonic() - self._offset_at_s > CLOCK_S:
                self._measure_offset()
        except _losses() as error:
            raise DeviceLostError(f"the stream has ended ({error})") from None
        if sample is None:
            return []
        every = zip([sample, *samples], [stamp_s, *stamps], strict=True)
        return [self._frame(np.array(values), stamp) for values, stamp in every]

    def _frame(self, values: np.ndarray, stamp_s: float) -> Frame:
        poses = values[self._columns]
        norms = np.linalg.norm(poses[:, 3:], axis=1)
        bad = ~(np.abs(norms - 1.0) <= 0.05)
        self.counts.refused_records += int((bad & np.isfinite(norms)).sum())
        self.counts.lost_records += int((~np.isfinite(norms)).sum())
        self.counts.records += int((~bad).sum())
        poses[bad] = np.nan
        turned = poses[:, 3:] / np.where(bad, 1.0, norms)[:, None]
        return Frame(stamp_s + self._offset_s, stamp_s, poses[:, :3], turned)


class LslMarkers:
    """Sends events into the network as text, with the time at which each was announced.

    The stream is of type Markers with one channel and no regular rate, as recorders expect.

    Args:
        name: The stream's name.

    Raises:
        DeviceError: The library is missing.
    """

    def __init__(self, name: str) -> None:
        self._lsl = _pylsl()
        info = self._lsl.StreamInfo(
            name, MARKER_TYPE, 1, 0.0, self._lsl.cf_string, f"capar-markers-{name}"
        )
        self._outlet: Any = self._lsl.StreamOutlet(info)

    def send(self, line: str) -> None:
        """Send one event."""
        self._outlet.push_sample([line], self._lsl.local_clock())

    def wait(self, timeout_s: float) -> bool:
        """Whether somebody receives them within a time [s]."""
        return bool(self._outlet.wait_for_consumers(timeout_s))

    def close(self) -> None:
        """End the stream; what is on its way gets a moment to arrive."""
        if self._outlet.have_consumers():
            time.sleep(LAST_S)
        self._outlet = None
