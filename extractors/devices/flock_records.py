"""Records of a Flock of Birds on a serial line: words with phasing bits, and resynchronising.

A word's two bytes carry seven bits each, so its two lowest bits are lost; bit 7 is set only on
the first byte of a record. There is no checksum: a record counts where a phasing bit begins it,
none stands in it, its address is a known one, and the next byte, if it is there, has the next
phasing bit. Lost bytes are found so; a byte whose lower bits are garbled is not.
"""

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from extractors.devices.bird_formats import BirdFormat

PHASE = 0x80
KEPT = 0xFFFC
"""Bits of a word that the wire carries."""

SLACK_S = 0.004
"""What a record may take longer than its bytes do, and count without a byte after it [s]."""


@dataclass(frozen=True, slots=True)
class Record:
    """One bird's words."""

    address: int
    """Address in the flock; 0 where records carry none."""

    words: tuple[int, ...]
    stamp_s: float
    """When its first byte arrived [s]."""

    missed: int
    """How many records the bytes were of that were dropped since the record before."""


def encode_word(word: int) -> tuple[int, int]:
    """The two bytes of a signed word, without a phasing bit."""
    return word >> 2 & 0x7F, word >> 9 & 0x7F


def decode_word(low: int, high: int) -> int:
    """The signed word of two bytes."""
    value = (high & 0x7F) << 9 | (low & 0x7F) << 2
    return value - 0x10000 if value & 0x8000 else value


def encode_record(
    words: Iterable[int], *, address: int | None = None, buttons: int | None = None
) -> bytes:
    """The bytes of a record; with an address in group mode, with buttons in button mode."""
    out = bytearray(byte for word in words for byte in encode_word(word))
    out[0] |= PHASE
    out += bytes(each & 0x7F for each in (buttons, address) if each is not None)
    return bytes(out)


def record_size(form: BirdFormat, *, group: bool, buttons: bool = False) -> int:
    """Bytes of a record."""
    return 2 * form.words + buttons + group


class RecordParser:
    """Finds the records in a stream of bytes that may have lost some.

    Args:
        form: The format that the birds were told to send.
        addresses: The birds in the group; None where each bird has a line of its own.
        buttons: Whether records carry a button byte.
        byte_s: Time of a byte on the line, for time stamps [s].
    """

    def __init__(
        self,
        form: BirdFormat,
        *,
        addresses: Collection[int] | None = None,
        buttons: bool = False,
        byte_s: float = 0.0,
    ) -> None:
        self.dropped_bytes = 0
        self.wrong_addresses = 0
        self._words = form.words
        self._addresses = addresses
        self._size = record_size(form, group=addresses is not None, buttons=buttons)
        self._byte_s = byte_s
        self._buffer = bytearray()
        self._stamp_s = 0.0
        self._fed_s = 0.0
        self._dropped = self._refused = 0

    @property
    def pending(self) -> bool:
        """Whether a whole record waits for the byte after it."""
        return len(self._buffer) == self._size

    @property
    def pending_address(self) -> int | None:
        """Address of the record that waits for the byte after it; 0 where there are none."""
        if not self.pending:
            return None
        return self._buffer[-1] if self._addresses is not None else 0

    def feed(self, data: bytes, at_s: float = 0.0) -> list[Record]:
        """The records that some bytes complete, the last of which arrived at a moment [s]."""
        held = len(self._buffer)
        self._buffer += data
        self._fed_s = at_s
        total, at, out = len(self._buffer), 0, []
        while at < total:
            if (self._buffer[at] & PHASE) == 0:
                at = self._skip(at, 1)
                continue
            if at or not held:
                self._stamp_s = at_s - (total - 1 - at) * self._byte_s
            inside = self._phase_within(at)
            if inside:
                at = self._skip(at, inside)
            elif total - at <= self._size:
                break
            elif self._buffer[at + self._size] & PHASE:
                out += self._accept(at)
                at += self._size
            else:
                at = self._skip(at, 1)
        del self._buffer[:at]
        return out

    def settle(self, *, answered: bool = False) -> list[Record]:
        """The last record, if it is whole and came in one go, and the line is idle after it.

        Args:
            answered: Whether it ends the answer to a poll, so that nothing can follow it.
        """
        longest_s = 2.0 * self._size * self._byte_s + SLACK_S
        late = self._byte_s > 0.0 and self._fed_s - self._stamp_s > longest_s
        if not self.pending or (late and not answered):
            return []
        out = self._accept(0)
        self._buffer.clear()
        return out

    def clear(self) -> None:
        """Forget what was begun."""
        self._buffer.clear()

    def _phase_within(self, at: int) -> int:
        """How far on the next phasing bit stands where none may; 0 where there is none."""
        end = min(at + self._size, len(self._buffer))
        for index in range(at + 1, end):
            if self._buffer[index] & PHASE:
                return index - at
        return 0

    def _skip(self, at: int, count: int) -> int:
        self.dropped_bytes += count
        self._dropped += count
        return at + count

    def _accept(self, at: int) -> list[Record]:
        data = self._buffer[at : at + self._size]
        address = data[-1] if self._addresses is not None else 0
        if self._addresses is not None and address not in self._addresses:
            self.wrong_addresses += 1
            self._refused += 1
            return []
        words = tuple(decode_word(data[2 * i], data[2 * i + 1]) for i in range(self._words))
        missed = -(-self._dropped // self._size) + self._refused
        self._dropped = self._refused = 0
        record = Record(address, words, self._stamp_s, missed)
        return [record]
