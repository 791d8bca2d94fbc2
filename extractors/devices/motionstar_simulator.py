"""A MotionStar's Ethernet server for those who have none: BirdNet over TCP and UDP on loopback."""

import random
import socket
import time
from contextlib import suppress
from dataclasses import dataclass, replace

from extractors.devices import birdnet_packets as birdnet
from extractors.devices.bird_formats import FORMATS, Scaling, words_of_pose
from extractors.devices.birdnet_packets import Kind, Packet
from extractors.devices.motion_source import MotionSource
from extractors.devices.simulator import Simulator

RANGE_INCH = 144.0
RATE_HZ = 103.3


@dataclass(frozen=True)
class ServerFaults:
    """What goes wrong with what the server sends."""

    lost_share: float = 0.0
    """Share of the data packets that are lost."""

    numbered: bool = True
    """Whether data packets have sequence numbers of their own."""

    error: int = 0
    """Error code that it reports."""

    seed: int = 0


@dataclass(frozen=True, slots=True)
class SentPacket:
    """The words of a data packet, by the birds' addresses."""

    words: dict[int, tuple[int, ...]]
    intact: bool


class MotionStarSimulator(Simulator):
    """A server with a controller as unit 1, and one bird a sensor of the motion from 2 on.

    Args:
        motion: What is measured.
        faults: What goes wrong.
        log: Where every data packet is kept, if anywhere.
        port: Port for TCP and UDP; 0 takes a free one.
    """

    def __init__(
        self,
        motion: MotionSource,
        faults: ServerFaults | None = None,
        log: list[SentPacket] | None = None,
        port: int = 0,
    ) -> None:
        super().__init__(motion, RATE_HZ)
        self.port = port
        self._faults = faults or ServerFaults()
        self._log = log
        self._random = random.Random(self._faults.seed)
        self._birds = tuple(range(2, 2 + len(motion.sensors)))
        self._listening: socket.socket | None = None
        self._datagrams: socket.socket | None = None
        self._client: socket.socket | None = None
        self._peer: tuple[str, int] | None = None
        self._forget()

    def _forget(self) -> None:
        self._setups = {
            each: birdnet.BirdStatus(each, FORMATS["pos_ang"], RANGE_INCH) for each in self._birds
        }
        self._rate_hz, self._sending, self._sequence = RATE_HZ, False, 0
        self._buffer = bytearray()

    @property
    def place(self) -> str:
        """The place in a device address."""
        return f"127.0.0.1:{self.port}"

    def _plug(self) -> None:
        self._forget()
        self._listening = socket.create_server(("127.0.0.1", self.port))
        self.port = self._listening.getsockname()[1]
        self._datagrams = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._datagrams.bind(("127.0.0.1", self.port))

    def _unplug(self) -> None:
        for connection in (self._listening, self._datagrams, self._client):
            if connection is not None:
                connection.close()
        self._listening = self._datagrams = self._client = self._peer = None
        self._sending = False

    def _handles(self) -> list[int]:
        every = (self._listening, self._datagrams, self._client)
        return [each.fileno() for each in every if each is not None]

    def _attend(self, ready: set[int]) -> None:
        with suppress(OSError):
            if self._listening is not None and self._listening.fileno() in ready:
                self._client, _ = self._listening.accept()
                self._client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._peer = None
                self._buffer.clear()
            elif self._client is not None and self._client.fileno() in ready:
                self._hear(self._client)
            if self._datagrams is not None and self._datagrams.fileno() in ready:
                data, self._peer = self._datagrams.recvfrom(65536)
                self._obey_all(bytearray(data))

    def _hear(self, client: socket.socket) -> None:
        data = client.recv(65536)
        if not data:
            client.close()
            self._client, self._sending = None, False
            return
        self._buffer += data
        self._obey_all(self._buffer)

    def _obey_all(self, buffer: bytearray) -> None:
        with suppress(birdnet.PacketError):
            while (found := birdnet.decode_packet(buffer)) is not None:
                del buffer[: found[1]]
                self._send(self._obey(found[0]))

    def _send(self, packet: Packet) -> None:
        with suppress(OSError):
            if self._peer is not None and self._datagrams is not None:
                self._datagrams.sendto(packet.encode(), self._peer)
            elif self._client is not None:
                self._client.sendall(packet.encode())

    def _obey(self, packet: Packet) -> Packet:
        """The response to a command."""
        known = packet.xtype == 0 or packet.xtype in self._setups
        if packet.kind not in birdnet.RESPONSES or not known:
            return Packet(Kind.UNKNOWN, packet.sequence, packet.xtype)
        if packet.kind == Kind.GET_STATUS:
            return birdnet.reply(packet, body=self._status(packet.xtype))
        if packet.kind == Kind.SEND_SETUP:
            return self._set_up(packet)
        if packet.kind in (Kind.RUN_CONTINUOUS, Kind.STOP_DATA, Kind.SHUT_DOWN):
            self._sending = packet.kind == Kind.RUN_CONTINUOUS
            self._sequence = packet.sequence
        if packet.kind == Kind.SINGLE_SHOT:
            return birdnet.reply(packet, body=self._data(time.monotonic()))
        return birdnet.reply(packet)

    def _status(self, bird: int) -> bytes:
        if bird:
            return self._setups[bird].encode()
        units = (
            birdnet.unit_bits(sensor=False),
            *[birdnet.unit_bits(sensor=True)] * len(self._birds),
        )
        flags = 0x0C | 0x80 * self._sending | 0x40 * bool(self._faults.error)
        return birdnet.SystemStatus(self._rate_hz, units, 1, flags, self._faults.error).encode()

    def _set_up(self, packet: Packet) -> Packet:
        try:
            if packet.xtype == 0:
                self._rate_hz = birdnet.decode_system_status(packet.body).rate_hz or RATE_HZ
            else:
                setup = birdnet.decode_bird_status(packet.body)
                self._setups[packet.xtype] = replace(setup, range_inch=RANGE_INCH)
        except birdnet.PacketError:
            return Packet(Kind.ILLEGAL, packet.sequence, packet.xtype)
        return birdnet.reply(packet)

    def _words(self, at_s: float) -> dict[int, tuple[int, ...]]:
        positions, orientations = self._poses(at_s)
        return {
            bird: words_of_pose(position, turn, self._setups[bird].form, Scaling(RANGE_INCH))
            for bird, position, turn in zip(self._birds, positions, orientations, strict=True)
        }

    def _data(self, at_s: float) -> bytes:
        words = self._words(at_s)
        return birdnet.encode_data({b: (self._setups[b].form, w) for b, w in words.items()})

    def _measure(self, at_s: float) -> None:
        every = self._setups[self._birds[0]].report_every
        if not self._sending or self._cycle % max(1, every):
            return
        self._sequence = (self._sequence + self._faults.numbered) % 0x10000
        words = self._words(at_s)
        body = birdnet.encode_data({b: (self._setups[b].form, w) for b, w in words.items()})
        intact = self._random.random() >= self._faults.lost_share
        if self._log is not None:
            self._log.append(SentPacket(words, intact))
        if intact:
            since_s = at_s - self._start_s
            seconds, milli = int(since_s), int(since_s % 1.0 * 1000.0)
            self._send(Packet(Kind.DATA, self._sequence, 0, body, seconds, milli))
