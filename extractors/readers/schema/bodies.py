"""Sensors and objects of a capture.toml as a schema: one by one, or many at once."""

# ruff: noqa: RUF012  (pydantic copies the defaults of fields)

from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from capar.model.capture import NAME
from extractors.readers.schema.entry import Entry, key
from extractors.readers.schema.shapes import (
    AnyShape,
    Pair,
    Pose,
    Quaternion,
    Vector,
    form_of_value,
)

Positive = Annotated[float, Field(gt=0.0)]


def _filled(value: str) -> str:
    if not value.strip():
        raise PydanticCustomError("empty", "empty")
    return value


def _constant(value: str) -> str:
    if not NAME.fullmatch(value):
        raise PydanticCustomError("name", "{name}", {"name": value})
    return value


Filled = Annotated[str, AfterValidator(_filled)]
Name = Annotated[str, AfterValidator(_constant)]
TextOrTexts = Annotated[
    Annotated[str, Tag("as text")] | Annotated[list[str], Tag("as list")],
    Discriminator(form_of_value),
]


class Traits(Entry):
    """Keys that sensors and objects share."""

    extend: Annotated[
        Literal["none", "rest"],
        key("``rest``: before and after its recording the body stays where it was."),
    ] = "none"
    offset: Annotated[
        Pose | None, key("Pose of the sensor or object in the recorded body's frame.")
    ] = None
    shape: Annotated[AnyShape | None, key("Its surface, in its own frame.")] = None
    agent: Annotated[
        str, key("Name of the agent whose body it is or rides on; the first if not given.")
    ] = ""


class Tracked(Traits):
    """Keys that say which body or which markers of a file something is."""

    file: Annotated[
        str | None,
        key("Name under ``[files]``; needed if several files have the name.",
            beside=("body", "markers")),
    ] = None  # fmt: skip
    body: Annotated[
        TextOrTexts | None,
        key(
            "Name of the body or joint in the file; or several names or patterns with *, one "
            "recorded after the other.",
            apart=("markers",),
        ),
    ] = None
    markers: Annotated[
        list[str] | None, key("Three or more markers that keep their distances.")
    ] = None
    residual_m: Annotated[
        float,
        key("Largest median distance of the markers from their rigid places.", unit="m",
            beside=("markers",)),
    ] = 0.010  # fmt: skip
    arrangement: Annotated[
        dict[str, Vector] | None,
        key("Place of each marker in the body's frame [m]; else fitted to the recording.",
            beside=("markers",), apart=("origin", "axes")),
    ] = None  # fmt: skip
    origin: Annotated[
        list[str],
        key("Markers whose mean is the frame's origin; else the mean of all.",
            beside=("markers",)),
    ] = []  # fmt: skip
    axes: Annotated[
        dict[Literal["x", "y", "z"], Pair] | None,
        Field(min_length=2, max_length=2),
        key("Two axes, each from one marker to another; the second is made square to the first.",
            beside=("markers",)),
    ] = None  # fmt: skip
    extend: Annotated[
        Literal["none", "rest"],
        key("``rest``: before and after its recording the body stays where it was.",
            beside=("body", "markers")),
    ] = "none"  # fmt: skip
    offset: Annotated[
        Pose | None,
        key("Pose of the sensor or object in the recorded body's frame.",
            beside=("body", "markers")),
    ] = None  # fmt: skip


class SensorEntry(Tracked):
    """A tracked body segment: one that acts, or one that attends."""

    one_of: ClassVar[tuple[str, ...]] = ("body", "markers")

    name: Annotated[Name, key("A name of its own: lower case, digits and _.")]
    end_effector: Annotated[
        str, key("What the segment is, a noun without side: hand, foot, head, eyes, knee ...")
    ]
    side: Annotated[Literal["right", "left", "none"], key("Its side.")] = "none"
    link: Annotated[
        str | None, key("The chain that it ends, like right_arm; derived if not given.")
    ] = None
    role: Annotated[
        Literal["acts", "attends"] | None,
        key("``acts`` makes segments, ``attends`` gives gaze; head and eyes attend, else acts."),
    ] = None
    gaze: Annotated[Vector, key("Direction of sight in the sensor's frame.")] = [1.0, 0.0, 0.0]
    eye: Annotated[Vector, key("Where sight starts in the sensor's frame.", unit="m")] = [0.0] * 3


class ObjectTraits(Traits):
    """Keys that an ``[[object]]`` shares with many objects declared at once."""

    tag: Annotated[
        Literal["self", "fixed", "mobile"] | None,
        key("A part of the agent, fixed in the world, or able to be moved."),
    ] = None
    kind: Annotated[Filled | None, key("Its noun; the name if not given.")] = None
    assumed: Annotated[
        str, key("Why and how its pose or size is an assumption, where it was not recorded.")
    ] = ""
    deformable: Annotated[bool, key("Whether it gives way under a hand.")] = False
    motion_floor_m: Annotated[
        Positive | None, key("A smaller displacement of it is no motion.", unit="m")
    ] = None
    mass_kg: Annotated[Positive | None, key("Its mass.", unit="kg")] = None


class ObjectEntry(Tracked, ObjectTraits):
    """Something that may be touched: recorded, fixed, or placed under what rests on it."""

    one_of: ClassVar[tuple[str, ...]] = ("body", "markers", "position", "top_at_bottom_of")

    name: Annotated[Name, key("A name of its own: lower case, digits and _.")]
    tag: Annotated[
        Literal["self", "fixed", "mobile"],
        key("A part of the agent, fixed in the world, or able to be moved."),
    ]
    position: Annotated[
        Annotated[list[float], Field(min_length=2, max_length=3)] | None,
        key(
            "x, y and z in the world, whose z axis points up whatever ``up`` says of the files; "
            "x and y only, where ``top_at_bottom_of`` gives the height.",
            unit="m",
            apart=("body", "markers"),
        ),
    ] = None
    orientation: Annotated[
        Quaternion | None,
        key(
            "Unit quaternion w x y z in the world, whose z axis points up.",
            beside=("position",),
            apart=("body", "markers", "top_at_bottom_of"),
        ),
    ] = None
    top_at_bottom_of: Annotated[
        str | None,
        key(
            "Object that rests on this one, or a pattern with *: the upper side is put at its "
            "lowest point.",
            apart=("body", "markers"),
        ),
    ] = None
    at_s: Annotated[
        float | None,
        key("When that object rests on it; from the end if negative.", unit="s",
            beside=("top_at_bottom_of",)),
    ] = None  # fmt: skip
    of: Annotated[
        Literal["median", "lowest"],
        key("Which height to take of several objects.", beside=("top_at_bottom_of",)),
    ] = "median"
    turn_deg: Annotated[
        float, key("Rotation about the vertical.", unit="deg", beside=("top_at_bottom_of",))
    ] = 0.0
    surface_m: Annotated[
        float | None,
        key("Height of the bearing surface in its own frame; its highest point if not given.",
            unit="m", beside=("top_at_bottom_of",)),
    ] = None  # fmt: skip


class ManySensors(Entry):
    """A sensor for each of many bodies of a file, named after them."""

    file: Annotated[str, key("Name under ``[files]``.")]
    bodies: Annotated[TextOrTexts, key("The bodies' names; ``*`` is every body.")] = "*"
    names: Annotated[
        dict[str, str], key("What bodies are called whose names in the file are those of others.")
    ] = {}
    sides: Annotated[
        dict[Literal["left", "right"], str], key("How the names of each side begin.")
    ] = {}
    attends: Annotated[list[str], key("Bodies that attend; all others act.")] = []
    end_effectors: Annotated[
        dict[str, str], key("What bodies are; else their names without side.")
    ] = {}
    extend: Annotated[
        Literal["none", "rest"],
        key("``rest``: before and after its recording the body stays where it was."),
    ] = "none"
    shape: Annotated[AnyShape | None, key("The shape of each, in its own frame.")] = None


class ObjectKind(ObjectTraits):
    """What the objects of one kind are; it prevails over what is said of all."""

    name: Annotated[Name, key("Name of the first; others are numbered.")]


class ManyObjects(ObjectTraits):
    """An object for each of many bodies of a file, by the kinds that their names tell."""

    file: Annotated[str, key("Name under ``[files]``.")]
    bodies: Annotated[str, key("A pattern that their names fit.")] = "*"
    kinds: Annotated[
        dict[str, ObjectKind],
        key("Kinds by how names begin; bodies of none are counted and left out."),
    ] = {}
    touched_by: Annotated[
        str, key("A sensor that touches each by distance.", beside=("touched_within_m",))
    ] = ""
    touched_within_m: Annotated[
        float | None,
        key("At this distance of origins or nearer.", unit="m", beside=("touched_by",)),
    ] = None
