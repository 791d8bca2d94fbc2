"""The bundle of a closed form holds what it was made from."""

from pathlib import Path

import numpy as np
from bundles import DRINKING
from write_demo import demo_capture, write_tables

from capar.model import geometry
from extractors.readers.bundle.capture_toml import read_capture


def test_the_bundle_reads_as_its_closed_form() -> None:
    read, made = read_capture(DRINKING), demo_capture()
    assert read.name == made.name
    assert read.agent == made.agent
    assert read.purposes == made.purposes
    assert list(read.bodies) == list(made.bodies)
    for name, body in made.bodies.items():
        other = read.bodies[name]
        np.testing.assert_allclose(other.stream.times, body.stream.times, atol=1e-6)
        np.testing.assert_allclose(other.stream.positions, body.stream.positions, atol=1e-6)
        angles = geometry.angle_between(other.stream.orientations, body.stream.orientations)
        assert angles.max() < 1e-6 + 2e-8**0.5
        assert body.shape is not None
        assert other.shape is not None
        np.testing.assert_allclose(other.shape.bounds, body.shape.bounds, atol=1e-6)
        assert len(other.shape.faces) == len(body.shape.faces)
    for one, two in zip(read.sensors, made.sensors, strict=True):
        fields = ("name", "end_effector", "side", "link", "role", "eye", "gaze")
        assert [getattr(one, each) for each in fields] == [getattr(two, each) for each in fields]
    for thing, twin in zip(read.objects, made.objects, strict=True):
        assert (thing.name, thing.tag, thing.kind) == (twin.name, twin.tag, twin.kind)
        assert thing.mass_kg == twin.mass_kg


def test_the_tables_are_those_that_the_script_writes(tmp_path: Path) -> None:
    write_tables(demo_capture(), tmp_path)
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted(
        each.name for each in DRINKING.iterdir() if each.name != "capture.toml"
    )
    for each in tmp_path.iterdir():
        header, *_ = (DRINKING / each.name).read_text().splitlines()
        assert each.read_text().splitlines()[0] == header
