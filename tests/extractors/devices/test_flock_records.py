"""Flock of Birds records: what is encoded is decoded, and damage is found."""

import numpy as np
import pytest
from flock_bits import decode
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from extractors.devices.bird_formats import FORMATS, Scaling, pose_of_words, words_of_pose
from extractors.devices.flock import KEPT, FlockLayout
from extractors.devices.records import RecordParser

WORDS = st.integers(-0x8000, 0x7FFF)
FORMS = st.sampled_from(sorted(FORMATS))
TO_WORLD = Rotation.from_euler("x", 180.0, degrees=True)
BIRDS = range(2, 14)


def kept(word: int) -> int:
    """A signed word without the two bits that the wire does not carry."""
    value = word & KEPT
    return value - 0x10000 if value & 0x8000 else value


def flock_parser(layout: FlockLayout, byte_s: float = 0.0) -> RecordParser:
    return RecordParser(layout, BIRDS if layout.group else (0,), byte_s)


def test_every_word_survives_but_for_its_two_lowest_bits() -> None:
    layout = FlockLayout(FORMATS["pos"], group=False)
    for word in range(-0x8000, 0x8000, 3):
        words = (word, word + 1, min(word + 2, 0x7FFF))
        data = layout.encode(words)
        assert [byte >= 0x80 for byte in data] == [True, *[False] * 5]
        assert layout.decode(data, ended=True) == (0, tuple(map(kept, words)))


def test_the_vendors_example_is_read_and_written() -> None:
    data = bytes.fromhex("C8 08 51 19 59 2A")
    layout = FlockLayout(FORMATS["pos"], group=False)
    parser = flock_parser(layout)
    assert parser.feed(data) == []
    (record,) = parser.settle()
    assert record.values == (0x1120, 0x3344, 0x5564)
    assert layout.encode(record.values) == data


@given(form=FORMS, data=st.data(), group=st.booleans(), count=st.integers(1, 6))
def test_records_come_out_however_their_bytes_are_cut(
    form: str, data: st.DataObject, group: bool, count: int
) -> None:
    words = st.tuples(*[WORDS] * FORMATS[form].words)
    sent = [(data.draw(words), data.draw(st.sampled_from(BIRDS))) for _ in range(count)]
    layout = FlockLayout(FORMATS[form], group)
    wire = b"".join(layout.encode(w, a) for w, a in sent)
    assert len(wire) == count * layout.size
    parser = flock_parser(layout)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(wire)), max_size=8)))
    parts = [wire[a:b] for a, b in zip([0, *cuts], [*cuts, len(wire)], strict=True)]
    found = [each for part in parts for each in parser.feed(part)] + parser.settle()
    assert [(each.values, each.address) for each in found] == [
        (tuple(map(kept, w)), a if group else 0) for w, a in sent
    ]
    assert parser.dropped_bytes == 0


@given(form=FORMS, seed=st.integers(0, 2**32 - 1), group=st.booleans())
def test_with_bytes_lost_no_wrong_record_is_accepted_and_few_good_ones_are_missed(
    form: str, seed: int, group: bool
) -> None:
    random = np.random.default_rng(seed)
    size = FORMATS[form].words
    sent = [tuple(random.integers(-0x8000, 0x8000, size).tolist()) for _ in range(400)]
    birds = [BIRDS[index % len(BIRDS)] for index in range(len(sent))]
    layout = FlockLayout(FORMATS[form], group)
    records = [layout.encode(w, b) for w, b in zip(sent, birds, strict=True)]
    lost = [random.random(len(each)) < 0.005 for each in records]
    wire = b"".join(
        bytes(np.frombuffer(each, np.uint8)[~gone])
        for each, gone in zip(records, lost, strict=True)
    )
    parser = flock_parser(layout)
    found = [(each.values, each.address) for each in (*parser.feed(wire), *parser.settle())]
    intact = [
        (tuple(map(kept, w)), b if group else 0)
        for w, b, gone in zip(sent, birds, lost, strict=True)
        if not gone.any()
    ]
    truth = iter(intact)
    assert all(each in truth for each in found), "a record that was not sent, or out of order"
    assert len(found) >= 0.9 * len(intact)


def test_time_stamps_are_those_of_first_bytes() -> None:
    layout = FlockLayout(FORMATS["pos"], group=False)
    parser = flock_parser(layout, 0.001)
    wire = layout.encode((4, 8, 12)) * 2
    found = [*parser.feed(wire[:8], 1.008), *parser.feed(wire[8:], 1.012), *parser.settle()]
    assert [each.stamp_s for each in found] == pytest.approx([1.001, 1.007])


@given(data=st.lists(st.binary(max_size=200), max_size=20), form=FORMS, group=st.booleans())
def test_whatever_bytes_come_nothing_is_raised_and_little_is_kept(
    data: list[bytes], form: str, group: bool
) -> None:
    parser = flock_parser(layout := FlockLayout(FORMATS[form], group))
    for each in data:
        for record in parser.feed(each):
            pose_of_words(record.values, FORMATS[form], Scaling())
        assert len(parser._buffer) <= layout.size


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("range_inch", [36.0, 72.0, 144.0])
@given(seed=st.integers(0, 2**32 - 1))
def test_both_decoders_read_the_pose_that_was_encoded(
    form: str, range_inch: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    position = random.uniform(-0.9, 0.9, 3) * range_inch * 0.0254
    rotation = Rotation.random(rng=random)
    if form in ("ang", "pos_ang"):
        rotation = Rotation.from_euler("ZYX", random.uniform(-1.4, 1.4, 3))
    scaling = Scaling(range_inch)
    shape = FORMATS[form]
    words = words_of_pose(position, rotation.as_quat(scalar_first=True), shape, scaling)
    data = FlockLayout(shape, group=True).encode(words, 5)
    found = FlockLayout(shape, group=True).decode(data, ended=True)
    assert isinstance(found, tuple)
    pose = pose_of_words(found[1], shape, scaling)
    other = decode(data, form, group=True, range_inch=range_inch)
    assert pose is not None
    assert other.addresses.tolist() == [5]
    step_m = 8.0 / 32768.0 * range_inch * 0.0254
    if shape.position:
        np.testing.assert_allclose(pose[0], position, atol=step_m)
        assert other.positions is not None
        np.testing.assert_allclose(TO_WORLD.apply(other.positions)[0], pose[0], atol=1e-12)
    if shape.orientation:
        ours = Rotation.from_quat(pose[1], scalar_first=True)
        assert (ours.inv() * rotation).magnitude() < 0.002
        assert other.rotations is not None
        assert (ours.inv() * TO_WORLD * other.rotations[0]).magnitude() < 1e-6


def test_words_that_are_no_rotation_are_refused() -> None:
    assert pose_of_words((20000, 20000, 0, 20000), FORMATS["quat"], Scaling()) is None
    assert pose_of_words((0,) * 9, FORMATS["mat"], Scaling()) is None
    mirror = (32767, 0, 0, 0, 32767, 0, 0, 0, -32768)
    assert pose_of_words(mirror, FORMATS["mat"], Scaling()) is None
