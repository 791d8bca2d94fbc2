"""Captures of single carries, made of a recording that has each object only while it is carried.

Where such an object's stream begins and ends is the label. So that it tells the program nothing,
the object rests before and after, and the hand that carries it is with it all the time: only
motion is left to say when the carry begins and ends.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from capar.evaluation.plan_schema import CarryOptions
from capar.model.capture import (
    Capture,
    PivotContact,
    Sensor,
    Stream,
    TagObject,
    TagType,
)
from capar.model.errors import UnknownNameError
from extractors.readers.bundle.capture_toml import read_capture, read_files
from extractors.readers.bundle.location import open_bundle
from extractors.readers.bundle.many import many_objects
from extractors.readers.bundle.resampling import resampled
from extractors.readers.schema.names import constant_name

if TYPE_CHECKING:
    from extractors.readers.bundle.world import WorldRecording
    from extractors.readers.schema.capture import CaptureFile

RATE_HZ = 50.0
"""The clock where the bundle states none [Hz]."""

TOUCHES_M = 0.005
"""The hand is where the object is: their distance is zero, and anything above it will do [m]."""


@dataclass(frozen=True)
class CarryCapture:
    """One carried object, at rest before and after, and when the recording has it."""

    object: str
    capture: Capture
    start_s: float
    """Its first recorded pose, on the capture's clock [s]."""

    end_s: float
    """Its last one [s]."""


def carry_captures(place: str, options: CarryOptions) -> Iterator[CarryCapture]:
    """A capture for each object that a recording has while it is carried, in order of time.

    Beside the object there are the bundle's fixed objects. An object that the bundle leaves out,
    for want of a shape, is there without one.

    Raises:
        CaparError: The bundle has a fault, or no such file or sensor.
    """
    document, _ = open_bundle(place)
    files = read_files(document)
    if options.presence_of not in files:
        raise UnknownNameError("file", options.presence_of, files, where=f"{document.file_path}")
    scene = read_capture(place)
    names = dict(_names(document, files, options.presence_of))
    recorded = files[options.presence_of].bodies
    for body in sorted(names, key=lambda each: float(recorded[each].times[0])):
        yield _carry(scene, names[body], recorded[body], options, document.rate_hz or RATE_HZ)


def _names(
    document: "CaptureFile", files: "dict[str, WorldRecording]", file: str
) -> Iterator[tuple[str, str]]:
    """Each carried body with its object's name; of one that is left out, with its own."""
    entries = [each for each in document.objects_from if each.file == file]
    for entry in entries:
        objects, notices = many_objects(entry, files)
        yield from ((str(each.body), each.name) for each in objects)
        left_out = [body for each in notices for body in each.bodies]
        for index, body in enumerate(left_out, 1):
            kind = constant_name(body.partition("(")[0])
            yield body, f"{kind}_{index}"


def _carry(
    scene: Capture, name: str, recorded: Stream, options: CarryOptions, rate_hz: float
) -> CarryCapture:
    begin, finish = float(recorded.times[0]), float(recorded.times[-1])
    zero = begin - options.extend_s
    clock = np.arange(zero, finish + options.extend_s, 1.0 / rate_hz)
    whole = resampled(recorded, clock, extend="rest")
    times = clock - zero
    stream = Stream(times, whole.positions, whole.orientations)
    hand = replace(scene.sensor(options.hand), stream=stream)
    capture = Capture(
        name=f"{scene.name}_{name}",
        sensors=(hand,),
        objects=(*_fixed(scene, times), _thing(scene, name, stream)),
        agent=scene.agent,
        contact_tolerance_m=scene.contact_tolerance_m,
        contact_dropout_s=scene.contact_dropout_s,
        contact_minimum_s=scene.contact_minimum_s,
        pivot_contacts=_pivots(scene, hand, name),
    )
    return CarryCapture(name, capture, begin - zero, finish - zero)


def _thing(scene: Capture, name: str, stream: Stream) -> TagObject:
    known = next((each for each in scene.objects if each.name == name), None)
    return replace(known, stream=stream) if known else TagObject(name, TagType.MOBILE, stream)


def _pivots(scene: Capture, hand: Sensor, name: str) -> tuple[PivotContact, ...]:
    pair = {hand.name, name}
    own = tuple(each for each in scene.pivot_contacts if {each.first, each.second} == pair)
    return own or (PivotContact(hand.name, name, TOUCHES_M),)


def _fixed(scene: Capture, times: np.ndarray) -> Iterator[TagObject]:
    """The fixed objects, where they are in the scene, on another clock."""
    for thing in scene.objects:
        if thing.tag is TagType.FIXED:
            frame = int(np.argmax(~thing.stream.lost))
            still = Stream(
                times,
                np.repeat(thing.stream.positions[[frame]], len(times), axis=0),
                np.repeat(thing.stream.orientations[[frame]], len(times), axis=0),
            )
            yield replace(thing, stream=still)
