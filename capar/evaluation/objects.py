"""Carries and containers: what happens to objects, compared with labels or with their own poses."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from capar.evaluation.labels import Label, Labels, check_known, check_span
from capar.evaluation.metrics import (
    SAME_S,
    Channel,
    Counts,
    Interval,
    Scored,
    errors_ms,
    rounded,
    summed,
)
from capar.evaluation.plan import CarryOptions, Pair, Plan
from capar.model.capture import Capture, PivotContact, Shape, Stream, TagObject, TagType
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

CARRY, INTO = "carry", "into"

RATE_HZ = 50.0
"""The clock where the bundle states none [Hz]."""

TOUCHES_M = 0.005
"""The hand is where the object is: their distance is zero, and anything above it will do [m]."""


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
class CarryCounts(Counts):
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
        shares = {"start": near[:, 0], "end": near[:, 1], "both": near.all(axis=1)}
        return {
            name: rounded(100.0 * float(np.mean(share))) if len(near) else None
            for name, share in shares.items()
        }


def score_carries(pair: Pair, plan: Plan, base: Profile) -> Scored:
    """Observe a capture and compare printed carries with labelled ones.

    A printed carry of an object is a run of consecutive segments of which the object is the
    dominant one: from the first in which it is carried to the last. Where the presence of objects
    in a recording is the label, each is observed in a capture of its own.
    """
    if not plan.carries.presence_of:
        labels, capture = plan.labels_of(pair), read_capture(pair.capture)
        check_known(labels, "object", [each.name for each in capture.objects], at="object")
        check_span(labels, capture.times)
        observation = observe(capture, rules=base)
        return compare_carries(pair.name, labels, observation, capture, plan.carries)
    parts: dict[str, CarryCounts] = {}
    channels: list[Channel] = []
    last_s = 0.0
    for capture, mark in carry_captures(pair.capture, plan.carries):
        labels = Labels(Path(pair.capture), (mark,), in_frames=False)
        observation = observe(capture, rules=base)
        scored = compare_carries(pair.name, labels, observation, capture, plan.carries)
        parts |= scored.parts
        channels += scored.channels
        last_s = max(last_s, float(capture.times[-1]))
    clock = np.arange(0.0, last_s + 0.02, 0.02)
    return Scored(pair.name, clock, tuple(channels), parts, summed(parts.values()))


def compare_carries(
    name: str, labels: Labels, observation: Observation, capture: Capture, options: CarryOptions
) -> Scored:
    """The carries of a capture beside their labels, which are in seconds."""
    parts, channels = {}, []
    for thing in dict.fromkeys(mark.object for mark in labels.marks):
        marks = [mark for mark in labels.marks if mark.object == thing and mark.sure]
        segments = tuple(each for each in observation.segments if each.objects[:1] == (thing,))
        found = printed_carries(segments, options.names)
        parts[thing] = _counts(marks, found, capture.tag_object(thing).stream, options)
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
    """Runs of segments of one object, from the first to the last in which it is carried."""
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


def _counts(
    marks: Sequence[Label], found: Sequence[Interval], stream: Stream, options: CarryOptions
) -> CarryCounts:
    def shared(each: Interval, mark: Label) -> float:
        return min(each.end_s, mark.end) - max(each.start_s, mark.start)

    # Each printed carry belongs to the labelled one that it overlaps most.
    owners = {each: max(marks, key=lambda mark: shared(each, mark)) for each in found if marks}
    owners = {each: mark for each, mark in owners.items() if shared(each, mark) > 0.0}
    carries = []
    for mark in marks:
        own = [each for each, owner in owners.items() if owner == mark]
        begins, ends = _motion(mark, stream, options.moves_m)
        late = max(begins - mark.start, mark.end - ends)
        carries.append(
            CarryEnds(
                start_error_s=min((each.start_s for each in own), default=np.inf) - mark.start,
                end_error_s=max((each.end_s for each in own), default=np.inf) - mark.end,
                moved=bool(np.isfinite(begins)),
                moves_at_ends=bool(late <= options.within_s),
            )
        )
    return CarryCounts(options.within_s, tuple(carries), extra=len(set(found) - set(owners)))


def _motion(mark: Label, stream: Stream, moves_m: float) -> tuple[float, float]:
    """When the object leaves its first place in the carry, and reaches its last one [s].

    Infinite where it never leaves it.
    """
    inside = (stream.times >= mark.start) & (stream.times <= mark.end) & ~stream.lost
    times, places = stream.times[inside], stream.positions[inside]
    if not len(times):
        return np.inf, -np.inf
    gone, back = (np.linalg.norm(places - places[end], axis=1) > moves_m for end in (0, -1))
    if not gone.any():
        return np.inf, -np.inf
    return float(times[gone][0]), float(times[back][-1])


def carry_captures(place: str, options: CarryOptions) -> Iterator[tuple[Capture, Label]]:
    """A capture for each object that a recording has while it is carried, in order of time.

    When the object's stream begins and ends is the label. So that this tells the program nothing,
    the object rests before and after, and the hand that carries it is with it all the time: only
    motion is left to say when the carry begins and ends. Beside the object there are the bundle's
    fixed objects. An object that the bundle leaves out, for want of a shape, is there without one.

    Raises:
        CaparError: The bundle has a fault, or no such file or sensor.
    """
    document, _ = open_bundle(place)
    files = read_files(document)
    if options.presence_of not in files:
        raise UnknownNameError("file", options.presence_of, files, where=f"{document.file_path}")
    scene = read_capture(place)
    names: dict[str, str] = {}
    for entry in (each for each in document.objects_from if each.file == options.presence_of):
        objects, notices = many_objects(entry, files)
        names |= {str(each.body): each.name for each in objects}
        left_out = [body for each in notices for body in each.bodies]
        for index, body in enumerate(left_out, 1):
            names[body] = f"{constant_name(body.partition('(')[0])}_{index}"
    recorded = files[options.presence_of].bodies
    for body in sorted(names, key=lambda each: float(recorded[each].times[0])):
        yield _carry(scene, names[body], recorded[body], options, document.rate_hz or RATE_HZ)


def _carry(
    scene: Capture, name: str, recorded: Stream, options: CarryOptions, rate_hz: float
) -> tuple[Capture, Label]:
    begin, finish = float(recorded.times[0]), float(recorded.times[-1])
    zero = begin - options.extend_s
    clock = np.arange(zero, finish + options.extend_s, 1.0 / rate_hz)
    whole, times = resampled(recorded, clock, extend="rest"), clock - zero
    stream = Stream(times, whole.positions, whole.orientations)
    hand = replace(scene.sensor(options.hand), stream=stream)
    known = next((each for each in scene.objects if each.name == name), None)
    thing = replace(known, stream=stream) if known else TagObject(name, TagType.MOBILE, stream)
    fixed = []
    for each in (one for one in scene.objects if one.tag is TagType.FIXED):
        first = int(np.argmax(~each.stream.lost))
        place, turn = each.stream.positions[[first]], each.stream.orientations[[first]]
        still = [np.repeat(one, len(times), axis=0) for one in (place, turn)]
        fixed.append(replace(each, stream=Stream(times, *still)))
    pair = {hand.name, name}
    pivots = tuple(each for each in scene.pivot_contacts if {each.first, each.second} == pair)
    capture = Capture(
        name=f"{scene.name}_{name}",
        sensors=(hand,),
        objects=(*fixed, thing),
        agent=scene.agent,
        contact_tolerance_m=scene.contact_tolerance_m,
        contact_dropout_s=scene.contact_dropout_s,
        contact_minimum_s=scene.contact_minimum_s,
        pivot_contacts=pivots or (PivotContact(hand.name, name, TOUCHES_M),),
    )
    return capture, Label("", begin - zero, finish - zero, CARRY, name)


@dataclass(frozen=True, slots=True)
class Landing:
    """One object and one container."""

    object: str
    container: str
    reported: bool
    """Whether a segment says that the object goes into it."""

    true: bool
    """Whether its middle lies inside at the end and did not at the beginning."""


@dataclass(frozen=True)
class LandingCounts(Counts):
    """How many objects went into a container, and of how many that is reported."""

    told_in: int = 0
    """It is reported, and true."""

    told_wrongly: int = 0
    """It is reported, and not true."""

    untold: int = 0
    """It is true, and not reported."""

    out: int = 0
    """It is neither."""

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


def score_containers(pair: Pair, plan: Plan, base: Profile) -> Scored:
    """Observe a capture and compare the preposition *into* with its objects' first and last poses.

    Raises:
        CaparError: The capture has a fault, or no such container.
    """
    assert plan.containers is not None, "a plan of containers names them"
    capture = read_capture(pair.capture)
    parts, notices = {}, []
    for name in plan.containers.names:
        whole, names = halved(capture, name) if plan.containers.halves else (capture, (name,))
        found = landings(whole, names, rules=base)
        count = Counter((each.reported, each.true) for each in found)
        parts[name] = LandingCounts(
            told_in=count[True, True],
            told_wrongly=count[True, False],
            untold=count[False, True],
            out=count[False, False],
        )
        for each in found:
            if each.reported != each.true:
                true = "went" if each.true else "did not go"
                reported = "is reported" if each.reported else "is not reported"
                notices.append(
                    f"{pair.name}: {each.object} {true} into {each.container} and {reported} to"
                )
    notices += [each.message for each in capture.notices if each.code == "objects-left-out"]
    return Scored(pair.name, capture.times, (), parts, summed(parts.values()), (), tuple(notices))


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
    out = []
    for name in names:
        container = capture.tag_object(name)
        for each in things:
            true = _inside(each, -1, container) and not _inside(each, 0, container)
            out.append(Landing(each.name, name, (each.name, name) in reported, true))
    return tuple(out)


def halved(capture: Capture, container: str) -> tuple[Capture, tuple[str, str]]:
    """The capture with its container parted across the middle of its longest level side.

    What is put into one half is put beside the other.

    Returns:
        The capture in which two containers, marked as assumed, stand in the place of one; and
        their names.
    """
    whole = capture.tag_object(container)
    shape = whole.shape
    assert shape is not None
    axis = int(np.argmax(shape.size[:2]))
    middle = float(shape.bounds[:, axis].mean())
    halves = []
    for word, side in (("near", -1.0), ("far", 1.0)):
        vertices = np.array(shape.vertices)
        vertices[:, axis] = (vertices[:, axis] - middle) / 2.0 + middle
        vertices[:, axis] += side * float(shape.size[axis]) / 4.0
        half = Shape(vertices, np.array(shape.faces), shape.source, f"half of {shape.description}")
        said = f"the {word} half of {container}"
        halves.append(replace(whole, name=f"{container}_{word}", shape=half, assumed=said))
    others = tuple(each for each in capture.objects if each.name != container)
    return replace(capture, objects=(*others, *halves)), (halves[0].name, halves[1].name)


def _inside(item: TagObject, frame: int, container: TagObject) -> bool:
    """Whether the middle of an object's box lies in the container's, which stands level."""
    corners = []
    for each in (container, item):
        assert each.shape is not None
        points = each.stream.pose(frame).apply(np.array(each.shape.vertices))
        corners.append((points.min(axis=0), points.max(axis=0)))
    (low, high), (first, last) = corners
    middle = (first + last) / 2.0
    return bool(((middle >= low) & (middle <= high)).all())
