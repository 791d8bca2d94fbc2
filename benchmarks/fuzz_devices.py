"""A million random and damaged inputs to every parser of tracker data.

Run as ``python benchmarks/fuzz_devices.py [INPUTS]``. Each input is either noise or a real
message with bytes overwritten, cut out or put in. Nothing but the parsers' own errors may come
out, none may take long, and memory may not grow; the script prints the figures and fails if not.
"""

import random
import resource
import struct
import sys
import time
from collections.abc import Callable

from capar.model.errors import DeviceError
from extractors.devices import fastrak as fastrak
from extractors.devices import flock as flock
from extractors.devices import motionstar as birdnet
from extractors.devices import vrpn as vrpn
from extractors.devices.bird_formats import FORMATS, Scaling, pose_of_words
from extractors.devices.records import RecordParser
from extractors.devices.tracker import parse_address, take_messages

LONGEST_S = 1.0
GROWTH_KB = 8192
"""Growth of the process that the interpreter's own bookkeeping accounts for [kB]."""

BIRDS = range(2, 14)
WORDS = (0x1120, 0x3344, 0x5564, 0x7FF0, 0, 0, 0, 0, 0, 0, 0, 0)
TARGETS: dict[str, tuple[bytes, Callable[[bytes], object]]] = {}


def flock_target(name: str, *, group: bool) -> tuple[bytes, Callable[[bytes], object]]:
    form = FORMATS[name]
    layout = flock.FlockLayout(form, group)
    parser = RecordParser(layout, BIRDS if group else (0,))
    sample = b"".join(layout.encode(WORDS[: form.words], each) for each in BIRDS)

    def take(data: bytes) -> None:
        for record in (*parser.feed(data), *parser.settle()):
            pose_of_words(record.values, form, Scaling())

    return sample, take


def fastrak_target(form: str, *, binary: bool) -> tuple[bytes, Callable[[bytes], object]]:
    layout = fastrak.FastrakLayout(form, binary)
    values = (1.0, -20.0, 30.0, 1.0, 0.0, 0.0, 0.0)[: len(fastrak.PLACES[form])]
    return layout.encode(2, values) * 4, RecordParser(layout, range(1, 5)).feed


def vrpn_take(data: bytes) -> None:
    for message in take_messages(bytearray(data), vrpn.decode_message):
        vrpn.decode_name(message.payload)
        vrpn.decode_pose(message.payload)


def targets() -> dict[str, tuple[bytes, Callable[[bytes], object]]]:
    pose = vrpn.encode_pose(3, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    name = vrpn.Message(0, 0, 0, -1, vrpn.encode_name("Tracker0")).encode()
    data = birdnet.encode_data(dict.fromkeys(BIRDS, (FORMATS["pos_quat"], WORDS[:7])))
    status = birdnet.SystemStatus(103.3, (0xF0, *[0xE0] * 12)).encode()
    bird = birdnet.BirdStatus(3, FORMATS["pos_quat"], 144.0).encode()
    out = {
        f"flock {form}{' group' * group}": flock_target(form, group=group)
        for form in FORMATS
        for group in (False, True)
    }
    out |= {
        f"fastrak {form} {'binary' if binary else 'ascii'}": fastrak_target(form, binary=binary)
        for form in fastrak.ITEMS
        for binary in (False, True)
    }
    return out | {
        "birdnet packet": (birdnet.Packet(210, 1, 0, data).encode(), birdnet.decode_packet),
        "birdnet data": (data, birdnet.decode_data),
        "birdnet system": (status, birdnet.decode_system_status),
        "birdnet bird": (bird, birdnet.decode_bird_status),
        "vrpn": (name + vrpn.Message(1, 2, 0, 4, pose).encode() * 3, vrpn_take),
        "address": (b"flock:/dev/ttyUSB0?birds=12&format=pos_quat", lambda data: parse_address(
            data.decode("latin-1"))),
    }  # fmt: skip


def damaged(sample: bytes, source: random.Random) -> bytes:
    if source.random() < 0.3:
        return source.randbytes(source.randrange(200))
    out = bytearray(sample)
    for _ in range(source.randrange(1, 5)):
        at = source.randrange(len(out) + 1)
        text = source.randbytes(source.randrange(1, 4))
        width = source.choice((0, len(text)))
        out[at : at + width] = text if source.random() < 0.7 else b""
    return bytes(out)


def main(inputs: int) -> int:
    source, longest, refused = random.Random(1), 0.0, 0
    every = list(targets().items())
    start = time.monotonic()
    early_kb = 0
    for index in range(inputs):
        if index == inputs // 10:
            early_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        name, (sample, take) = every[index % len(every)]
        data = damaged(sample, source)
        before = time.perf_counter()
        try:
            take(data)
        except DeviceError:
            refused += 1
        except (struct.error, ValueError, IndexError, KeyError, OverflowError) as error:
            print(f"{name}: {error!r} from {data.hex()}")
            return 1
        longest = max(longest, time.perf_counter() - before)
    growth_kb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - early_kb
    print(
        f"{inputs} inputs to {len(every)} parsers in {time.monotonic() - start:.0f} s: "
        f"{refused} refused with an error of ours, none crashed; longest {longest * 1e3:.1f} ms; "
        f"memory grew by {growth_kb} kB after the first tenth"
    )
    return int(longest > LONGEST_S or growth_kb > GROWTH_KB)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000))
