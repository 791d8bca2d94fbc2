"""Carries and containers: what happens to objects, compared with labels or with their own poses."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from capar.evaluation.labels import Kind, Label, Labels, check_known, check_span
from capar.evaluation.metrics import (
    SAME_S,
    Channel,
    Evaluation,
    Interval,
    Scored,
    errors_ms,
    rounded,
    summed,
)
from capar.evaluation.plan import CarryOptions, Pair, Plan, Progress
from capar.evaluation.scoring import read_case_labels
from capar.model.capture import Capture, PivotContact, Sensor, Shape, Stream, TagObject, TagType
from capar.model.errors import UnknownNameError
from capar.model.observation import Observation, Segment
from capar.pipelines.observation import observe
from capar_rules.engine.profiles import DEFAULT, Profile
from extractors.readers.bundle.bodies import resampled
from extractors.readers.bundle.capture_toml import (
    many_objects,
    open_bundle,
    read_capture,
    read_files,
)
from extractors.readers.names import constant_name

if TYPE_CHECKING:
    from extractors.readers.bundle.bodies import WorldRecording
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


CARRY = "carry"


@dataclass(frozen=True, slots=True)
class CarryEnds:
    """One labelled carry, and how far the printed ends are from its own."""

    start_error_s: float
    """Printed start minus labelled start [s]; infinite where no carry was found."""

    end_error_s: float
    moved: bool
    """Whether the object moved by more than ``moves_m`` in it; else it is excluded."""

    moves_at_ends: bool
    """Whether its motion begins and ends within ``within_s`` of the labels."""


@dataclass(frozen=True)
class CarryCounts:
    """Labelled carries, and how many were found beside them."""

    within_s: float
    carries: tuple[CarryEnds, ...] = ()
    extra: int = 0
    """Printed carries of labelled objects that overlap no labelled one."""

    def __add__(self, other: "CarryCounts") -> "CarryCounts":
        """Both together."""
        return replace(self, carries=self.carries + other.carries, extra=self.extra + other.extra)

    def scores(self) -> dict[str, Any]:
        """Shares of carries whose printed start, end and both are near [%], and errors [ms]."""
        counted = [carry for carry in self.carries if carry.moved]
        sharp = [carry for carry in counted if carry.moves_at_ends]
        return {
            "carries": len(self.carries),
            "excluded": len(self.carries) - len(counted),
            "counted": len(counted),
            "within_s": self.within_s,
            **self._shares(counted),
            "start_ms": errors_ms([carry.start_error_s for carry in counted]),
            "end_ms": errors_ms([carry.end_error_s for carry in counted]),
            "extra": self.extra,
            "moving_at_both_ends": {"carries": len(sharp), **self._shares(sharp)},
        }

    def _shares(self, carries: Sequence[CarryEnds]) -> dict[str, Any]:
        errors_s = [(carry.start_error_s, carry.end_error_s) for carry in carries]
        near = np.abs(np.array(errors_s).reshape(-1, 2)) <= self.within_s + SAME_S
        shares = (near[:, 0], near[:, 1], near.all(axis=1))
        names = ("start", "end", "both")
        return {
            name: rounded(100.0 * float(np.mean(share))) if len(near) else None
            for name, share in zip(names, shares, strict=True)
        }


def score_carries(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Observe captures and compare printed carries with labelled ones.

    A printed carry of an object is a run of segments, one after the other, of which the object is
    the dominant one: from the first in which it is carried to the last.

    Raises:
        CaparError: A capture or a label file has a fault.
    """
    one = _recorded if plan.carries.presence_of else _labelled
    return Evaluation(
        Kind.CARRIES, tuple(one(pair, plan, base) for pair in progress(plan.pairs)), plan.groups
    )


def compare_carries(
    name: str, labels: Labels, observation: Observation, capture: Capture, options: CarryOptions
) -> Scored:
    """The carries of a capture beside their labels, which are in seconds."""
    parts, channels = {}, []
    for thing in dict.fromkeys(mark.object for mark in labels.marks):
        marks = [mark for mark in labels.marks if mark.object == thing and mark.sure]
        segments = _segments_of(observation, thing)
        found = printed_carries(segments, options.names)
        stream = capture.tag_object(thing).stream
        parts[thing] = _counts(marks, found, stream, options)
        true = tuple(Interval(mark.start, mark.end, CARRY) for mark in marks)
        channels.append(Channel(thing, true, found, silent=True, segments=segments))
    return Scored(
        name=name,
        times=capture.times,
        channels=tuple(channels),
        parts=parts,
        whole=summed(parts.values()),
        notices=labels.notices,
    )


def printed_carries(segments: Iterable[Segment], names: Sequence[str]) -> tuple[Interval, ...]:
    """Runs of segments of one object, from the first to the last in which it is carried.

    Args:
        segments: Those of which the object is the dominant one, in order of time.
        names: What they are called, or specialise, where they carry it.
    """
    runs: list[list[Segment]] = []
    for segment in segments:
        if not runs or (runs[-1][-1].ee, runs[-1][-1].index + 1) != (segment.ee, segment.index):
            runs.append([])
        runs[-1].append(segment)
    out = []
    for run in runs:
        carrying = [step for step in run if {step.name, *step.general} & set(names)]
        if carrying:
            out.append(Interval(carrying[0].start_s, carrying[-1].end_s, CARRY))
    return tuple(sorted(out))


def _labelled(pair: Pair, plan: Plan, base: Profile) -> Scored:
    labels = read_case_labels(pair, plan)
    capture = read_capture(pair.capture)
    check_known(labels, "object", [each.name for each in capture.objects], at="object")
    check_span(labels, capture.times)
    observation = observe(capture, rules=base)
    return compare_carries(pair.name, labels, observation, capture, plan.carries)


def _recorded(pair: Pair, plan: Plan, base: Profile) -> Scored:
    """Carries that the presence of objects in a recording tells, each in a capture of its own."""
    parts: dict[str, CarryCounts] = {}
    channels: list[Channel] = []
    last_s = 0.0
    for carry in carry_captures(pair.capture, plan.carries):
        mark = Label("", carry.start_s, carry.end_s, CARRY, carry.object)
        observation = observe(carry.capture, rules=base)
        labels = Labels(Path(pair.capture), (mark,), in_frames=False)
        scored = compare_carries(pair.name, labels, observation, carry.capture, plan.carries)
        parts |= scored.parts
        channels += scored.channels
        last_s = max(last_s, float(carry.capture.times[-1]))
    clock = np.arange(0.0, last_s + 0.02, 0.02)
    return Scored(pair.name, clock, tuple(channels), parts, summed(parts.values()))


def _segments_of(observation: Observation, thing: str) -> tuple[Segment, ...]:
    """The segments that are about an object, link by link in order of time."""
    return tuple(each for each in observation.segments if each.objects[:1] == (thing,))


def _counts(
    marks: Sequence[Label], found: Sequence[Interval], stream: Stream, options: CarryOptions
) -> CarryCounts:
    carries = []
    taken: set[Interval] = set()
    for mark in marks:
        own = [each for each in found if _nearest_mark(each, marks) == mark]
        taken |= set(own)
        start = min((each.start_s for each in own), default=float("inf"))
        end = max((each.end_s for each in own), default=float("inf"))
        carries.append(_ends(mark, start, end, stream, options))
    return CarryCounts(options.within_s, tuple(carries), extra=len(set(found) - taken))


def _nearest_mark(found: Interval, marks: Sequence[Label]) -> Label | None:
    """The labelled carry that it overlaps most."""

    def shared(mark: Label) -> float:
        return min(found.end_s, mark.end) - max(found.start_s, mark.start)

    best = max(marks, key=shared, default=None)
    return best if best is not None and shared(best) > 0.0 else None


def _ends(
    mark: Label, start_s: float, end_s: float, stream: Stream, options: CarryOptions
) -> CarryEnds:
    begins, ends = _motion(mark, stream, options.moves_m)
    late = max(begins - mark.start, mark.end - ends)
    return CarryEnds(
        start_error_s=start_s - mark.start,
        end_error_s=end_s - mark.end,
        moved=bool(np.isfinite(begins)),
        moves_at_ends=bool(late <= options.within_s),
    )


def _motion(mark: Label, stream: Stream, moves_m: float) -> tuple[float, float]:
    """When the object leaves its first place in the carry, and reaches its last one [s].

    Infinite where it never leaves it.
    """
    inside = (stream.times >= mark.start) & (stream.times <= mark.end) & ~stream.lost
    times, places = stream.times[inside], stream.positions[inside]
    if not len(times):
        return float("inf"), float("-inf")
    gone = _away(places, places[0]) > moves_m
    back = _away(places, places[-1]) > moves_m
    if not gone.any():
        return float("inf"), float("-inf")
    return float(times[gone][0]), float(times[back][-1])


def _away(
    places: Float[np.ndarray, "frames 3"], place: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "frames"]:
    return np.asarray(np.linalg.norm(places - place, axis=1))


INTO = "into"


@dataclass(frozen=True, slots=True)
class Landing:
    """One object and one container."""

    object: str
    container: str
    reported: bool
    """Whether a segment says that the object goes into it."""

    true: bool
    """Whether its middle lies inside at the end and did not at the beginning."""


def landings(
    capture: Capture, containers: Iterable[str], *, rules: Profile | str = DEFAULT
) -> tuple[Landing, ...]:
    """Observe a capture and compare the preposition with the objects' first and last poses.

    The truth is given by the middle of an object's box and the extent of the container's alone.

    Raises:
        CaparError: The capture has no such container, or it has no shape.
    """
    names = list(containers)
    reported = {
        (body, other)
        for segment in observe(capture, rules=rules).segments
        for name, body, other in segment.prepositions
        if name == INTO and other in names
    }
    things = [each for each in capture.objects if each.tag is TagType.MOBILE and each.shape]
    return tuple(
        Landing(
            object=each.name,
            container=name,
            reported=(each.name, name) in reported,
            true=_inside(each, -1, capture.tag_object(name))
            and not _inside(each, 0, capture.tag_object(name)),
        )
        for name in names
        for each in things
    )


def halved(capture: Capture, container: str) -> tuple[Capture, tuple[str, str]]:
    """The capture with its container parted across the middle of its longest level side.

    What is put into one half is put beside the other.

    Returns:
        The capture in which two containers, marked as assumed, stand in the place of one; and
        their names.
    """
    whole = capture.tag_object(container)
    assert whole.shape is not None
    axis = int(np.argmax(whole.shape.size[:2]))
    halves = tuple(_half(whole, axis, side) for side in (-1.0, 1.0))
    others = tuple(each for each in capture.objects if each.name != container)
    return replace(capture, objects=(*others, *halves)), (halves[0].name, halves[1].name)


def _half(whole: TagObject, axis: int, side: float) -> TagObject:
    shape = whole.shape
    assert shape is not None
    vertices = np.array(shape.vertices)
    middle = float(shape.bounds[:, axis].mean())
    vertices[:, axis] = (vertices[:, axis] - middle) / 2.0 + middle
    vertices[:, axis] += side * float(shape.size[axis]) / 4.0
    word = "near" if side < 0.0 else "far"
    return replace(
        whole,
        name=f"{whole.name}_{word}",
        shape=Shape(vertices, np.array(shape.faces), shape.source, f"half of {shape.description}"),
        assumed=f"the {word} half of {whole.name}",
    )


def _inside(thing: TagObject, frame: int, container: TagObject) -> bool:
    """Whether the middle of an object's box lies in the container's, which stands level."""
    low, high = _box(container, frame)
    first, last = _box(thing, frame)
    middle = (first + last) / 2.0
    return bool(((middle >= low) & (middle <= high)).all())


def _box(thing: TagObject, frame: int) -> Float[np.ndarray, "2 3"]:
    """Lowest and highest corner along the world's axes [m]."""
    assert thing.shape is not None
    points = thing.stream.pose(frame).apply(np.array(thing.shape.vertices))
    return np.stack([points.min(axis=0), points.max(axis=0)])


@dataclass(frozen=True)
class LandingCounts:
    """How many objects went into a container, and of how many that is told."""

    told_in: int = 0
    """It is told, and true."""

    told_wrongly: int = 0
    """It is told, and not true."""

    untold: int = 0
    """It is true, and not told."""

    out: int = 0
    """It is neither."""

    def __add__(self, other: "LandingCounts") -> "LandingCounts":
        """Both together."""
        return LandingCounts(
            self.told_in + other.told_in,
            self.told_wrongly + other.told_wrongly,
            self.untold + other.untold,
            self.out + other.out,
        )

    def scores(self) -> dict[str, Any]:
        """Counts, and the share that is right [%]."""
        total = self.told_in + self.told_wrongly + self.untold + self.out
        right = self.told_in + self.out
        return {
            "objects": total,
            "right": right,
            "went_in": self.told_in + self.untold,
            "told": self.told_in + self.told_wrongly,
            "told_wrongly": self.told_wrongly,
            "untold": self.untold,
            "accuracy": rounded(100.0 * right / total) if total else None,
        }


def score_containers(plan: Plan, base: Profile, progress: Progress) -> Evaluation:
    """Observe captures and compare the preposition *into* with the objects' first and last poses.

    Raises:
        CaparError: A capture has a fault, or no such container.
    """
    return Evaluation(
        Kind.CONTAINERS,
        tuple(_scored(pair, plan, base) for pair in progress(plan.pairs)),
        plan.groups,
    )


def count_landings(found: Iterable[Landing]) -> LandingCounts:
    """The counts of landings."""
    return sum((LandingCounts(**{_field(each): 1}) for each in found), LandingCounts())


def _field(landing: Landing) -> str:
    if landing.reported:
        return "told_in" if landing.true else "told_wrongly"
    return "untold" if landing.true else "out"


def _scored(pair: Pair, plan: Plan, base: Profile) -> Scored:
    assert plan.containers is not None, "a plan of containers names them"
    capture = read_capture(pair.capture)
    parts, notices = {}, []
    for name in plan.containers.names:
        whole, names = halved(capture, name) if plan.containers.halves else (capture, (name,))
        found = landings(whole, names, rules=base)
        parts[name] = count_landings(found)
        notices += [_shown(pair, each) for each in found if each.reported != each.true]
    notices += [each.message for each in capture.notices if each.code == "objects-left-out"]
    return Scored(pair.name, capture.times, (), parts, summed(parts.values()), (), tuple(notices))


def _shown(pair: Pair, landing: Landing) -> str:
    true = "went" if landing.true else "did not go"
    told = "is told to" if landing.reported else "is not told to"
    return f"{pair.name}: {landing.object} {true} into {landing.container} and {told}"
