"""BirdNet, Fastrak and VRPN: what is encoded is decoded, and nothing but our errors comes out."""

import contextlib
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from extractors.devices import fastrak as fastrak
from extractors.devices import motionstar as birdnet
from extractors.devices import vrpn as vrpn
from extractors.devices.bird_formats import FORMATS
from extractors.devices.records import RecordParser
from extractors.devices.tracker import DeviceLostError, take_messages

FORMS = st.sampled_from(sorted(FORMATS))
BYTE = st.integers(0, 255)
WORD = st.integers(-0x8000, 0x7FFF)


@given(
    st.builds(
        birdnet.Packet,
        kind=BYTE,
        sequence=st.integers(0, 0xFFFF),
        xtype=BYTE,
        body=st.binary(max_size=300),
        seconds=st.integers(0, 2**32 - 1),
        milliseconds=st.integers(0, 999),
        error=BYTE,
        error_extension=st.integers(0, 0xFFFF),
    ),
    st.binary(max_size=20),
)
def test_a_packet_is_decoded_as_it_was_encoded(packet: birdnet.Packet, rest: bytes) -> None:
    data = packet.encode()
    assert birdnet.decode_packet(data + rest) == (packet, len(data))
    for end in range(len(data)):
        assert birdnet.decode_packet(data[:end]) is None


def test_a_header_is_laid_out_as_the_protocol_says() -> None:
    packet = birdnet.Packet(210, 0x0102, 7, b"ab", 0x01020304, 0x0203, 5, 0x0607)
    assert packet.encode().hex(" ") == "01 02 02 03 01 02 03 04 d2 07 03 05 06 07 00 02 61 62"


@given(st.dictionaries(st.integers(1, 126), FORMS, max_size=12), st.data())
def test_the_birds_of_a_data_packet_are_decoded(forms: dict[int, str], data: st.DataObject) -> None:
    birds = {
        address: (FORMATS[form], data.draw(st.tuples(*[WORD] * FORMATS[form].words)))
        for address, form in forms.items()
    }
    assert birdnet.decode_data(birdnet.encode_data(birds)) == birds


@given(rate=st.integers(1, 999_999), units=st.binary(max_size=14))
def test_a_system_status_is_decoded_as_it_was_encoded(rate: int, units: bytes) -> None:
    status = birdnet.SystemStatus(rate / 1000.0, tuple(units))
    assert birdnet.decode_system_status(status.encode()) == status


@given(FORMS, st.integers(1, 0x0FFF), BYTE, st.binary(min_size=70, max_size=70))
def test_a_bird_status_keeps_what_it_does_not_know(
    form: str, inches: int, hemisphere: int, raw: bytes
) -> None:
    status = birdnet.BirdStatus(4, FORMATS[form], float(inches), hemisphere, 1, 0, raw)
    body = status.encode()
    assert [body[i] for i in range(70) if i not in (4, 6, 7, 8, 9, 10, 11)] == [
        raw[i] for i in range(70) if i not in (4, 6, 7, 8, 9, 10, 11)
    ]
    again = birdnet.decode_bird_status(body)
    assert (again.form, again.range_inch, again.address) == (FORMATS[form], inches, 4)


@given(st.binary(max_size=400))
def test_whatever_bytes_come_birdnet_raises_nothing_but_its_own_error(data: bytes) -> None:
    for decode in (
        birdnet.decode_packet,
        birdnet.decode_system_status,
        birdnet.decode_bird_status,
        birdnet.decode_data,
    ):
        with contextlib.suppress(birdnet.PacketError):
            decode(data)


CENTIMETRES = st.floats(-300.0, 300.0, width=32)
UNIT = st.floats(-1.0, 1.0, width=32)
DEGREES = st.floats(-180.0, 180.0, width=32)


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("form", fastrak.ITEMS)
@given(data=st.data())
def test_fastrak_records_come_out_however_their_bytes_are_cut(
    form: str, binary: bool, data: st.DataObject
) -> None:
    kinds = {"pos": [], "pos_ang": [DEGREES] * 3, "pos_quat": [UNIT] * 4}[form]
    records = st.tuples(st.integers(1, 4), st.tuples(*[CENTIMETRES] * 3, *kinds))
    sent = []
    for station, values in data.draw(st.lists(records, max_size=5)):
        norm = math.hypot(*values[3:]) if form == "pos_quat" else 1.0
        turned = [each / norm for each in values[3:]] if norm > 0.01 else [1.0, 0.0, 0.0, 0.0]
        sent.append((station, [*values[:3], *turned]))
    layout = fastrak.FastrakLayout(form, binary)
    wire = b"".join(layout.encode(*each) for each in sent)
    assert len(wire) == len(sent) * layout.size
    parser = RecordParser(layout, range(1, 5))
    cut = data.draw(st.integers(0, len(wire)))
    found = [*parser.feed(wire[:cut]), *parser.feed(wire[cut:])]
    assert [each.address for each in found] == [station for station, _ in sent]
    for (_, values), record in zip(sent, found, strict=True):
        assert record.values == pytest.approx(values, abs=0.0051 if not binary else 1e-4)
    assert parser.dropped_bytes == 0


def test_a_line_of_ascii_is_as_the_manual_prints_it() -> None:
    values = (13.42, 0.18, -2.55, -41.2, 5.0, 170.01)
    line = fastrak.FastrakLayout("pos_ang", binary=False).encode(1, values)
    assert line == b"01   13.42   0.18  -2.55 -41.20   5.00 170.01\r\n"


@pytest.mark.parametrize("binary", [False, True])
@given(st.lists(st.binary(max_size=200), max_size=10))
def test_whatever_bytes_come_fastrak_raises_nothing_and_keeps_little(
    binary: bool, data: list[bytes]
) -> None:
    layout = fastrak.FastrakLayout("pos_quat", binary)
    parser = RecordParser(layout, range(1, 5))
    for each in data:
        parser.feed(each)
        assert len(parser._buffer) < layout.size


INT = st.integers(-(2**31), 2**31 - 1)


@given(
    st.lists(st.builds(vrpn.Message, INT, INT, INT, INT, st.binary(max_size=120), INT), max_size=6),
    st.data(),
)
def test_vrpn_messages_come_out_however_their_bytes_are_cut(
    sent: list[vrpn.Message], data: st.DataObject
) -> None:
    wire = b"".join(each.encode() for each in sent)
    assert len(wire) % 8 == 0
    cut = data.draw(st.integers(0, len(wire)))
    buffer = bytearray(wire[:cut])
    found = list(take_messages(buffer, vrpn.decode_message))
    buffer += wire[cut:]
    assert [*found, *take_messages(buffer, vrpn.decode_message)] == sent


@given(st.text(max_size=40).filter(lambda text: "\0" not in text))
def test_a_vrpn_name_is_decoded_as_it_was_encoded(name: str) -> None:
    assert vrpn.decode_name(vrpn.encode_name(name)) == name


@given(st.lists(st.binary(max_size=100), max_size=10))
def test_whatever_bytes_come_vrpn_raises_nothing_but_its_own_error(data: list[bytes]) -> None:
    buffer = bytearray()
    with contextlib.suppress(DeviceLostError):
        for each in data:
            buffer += each
            for message in take_messages(buffer, vrpn.decode_message):
                vrpn.decode_name(message.payload)
                vrpn.decode_pose(message.payload)
