"""The schema of a capture.toml: every table and key with its type, unit, meaning and default."""

from datetime import date
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from capar.model import geometry
from capar.model.capture import NAME
from extractors.readers.recording import iso_time
from extractors.readers.schema.entry import Entry, key

Unit = Literal["m", "dm", "cm", "mm", "in", "ft"]
Handedness = Literal["right", "left"]
Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
Size = Annotated[float, Field(gt=0.0, le=20.0)]
Pair = Annotated[list[str], Field(min_length=2, max_length=2)]


def form_of_value(value: Any) -> str | None:
    """The tag of the member of a union that a value is read as: ``as text``, ``as list`` ..."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return "as number"
    kinds = ((str, "as text"), (list, "as list"), (dict | Entry, "as table"))
    return next((name for kind, name in kinds if isinstance(value, kind)), None)


def _unit_quaternion(value: list[float]) -> list[float]:
    norm = sum(each * each for each in value) ** 0.5
    if abs(norm - 1.0) > geometry.UNIT_TOLERANCE:
        raise PydanticCustomError(
            "quaternion", "a quaternion of norm {norm}", {"norm": f"{norm:.4g}"}
        )
    return value


Quaternion = Annotated[
    list[float], Field(min_length=4, max_length=4), AfterValidator(_unit_quaternion)
]


class Pose(Entry):
    """A position and an orientation."""

    position: Vector = key("Position; zero if not given.", [0.0, 0.0, 0.0], unit="m")
    orientation: Quaternion = key(
        "Unit quaternion w x y z; no rotation if not given.", [1.0, 0.0, 0.0, 0.0]
    )


class MeshShape(Pose):
    """A mesh file: STL, PLY, OBJ, OFF, GLB; or 3MF, DAE, X3D, glTF if trimesh can read them."""

    mesh: str = key("The file, relative to the capture.toml; ${NAME} is an environment variable.")
    unit: Unit = key("Unit of the mesh's coordinates.", "m")
    handedness: Handedness | None = key(
        "Axes of the mesh; if not given, those of the motion file of its body.", None
    )


class BoxShape(Pose):
    """A box about the origin of its own frame."""

    box: Annotated[list[Size], Field(min_length=3, max_length=3)] = key(
        "Lengths along x, y and z.", unit="m"
    )


class MarkerBoxShape(Pose):
    """The smallest box along the body's axes that holds markers."""

    box: Literal["markers"] = key("The word ``markers``.")
    around: list[str] = key(
        "Markers or bodies inside it; if not given, the body's own markers.", []
    )
    margin_m: float = key("Added on every side.", 0.0, unit="m")


class CylinderShape(Pose):
    """A cylinder about the z axis of its own frame."""

    cylinder: Annotated[list[Size], Field(min_length=2, max_length=2)] = key(
        "Radius and height.", unit="m"
    )


class SphereShape(Pose):
    """A sphere."""

    sphere: Size = key("Radius.", unit="m")


class CapsuleShape(Pose):
    """A cylinder with rounded ends, about the z axis of its own frame."""

    capsule: Annotated[list[Size], Field(min_length=2, max_length=2)] = key(
        "Radius, and distance between the centres of the two ends.", unit="m"
    )


class CapsulesShape(Pose):
    """Capsules between pairs of markers, joints or bodies, where these are in the mean."""

    capsules: Annotated[
        Annotated[Literal["children", "descendants"], Tag("as text")]
        | Annotated[list[Pair], Field(min_length=1), Tag("as list")],
        Discriminator(form_of_value),
    ] = key(
        "Pairs of names; or ``children``, from the body's joint to the next joints; or "
        "``descendants``, along every bone below it."
    )
    radius_m: Size = key("Radius of every capsule.", unit="m")


class PartsShape(Pose):
    """Several shapes as one; they may overlap."""

    parts: Annotated[list["AnyShape"], Field(min_length=1)] = key(
        "The shapes, each a table of this kind."
    )


SHAPES: dict[str, type[Pose]] = {
    "mesh": MeshShape,
    "box": BoxShape,
    "box_markers": MarkerBoxShape,
    "cylinder": CylinderShape,
    "sphere": SphereShape,
    "capsule": CapsuleShape,
    "capsules": CapsulesShape,
    "parts": PartsShape,
}
"""The kinds of shapes by the key that selects them; ``box = "markers"`` is one of its own."""


def shape_tag(value: Any) -> str | None:
    """The kind of shape that a table states, if it states exactly one."""
    if isinstance(value, Entry):
        return next((f"{name} shape" for name, kind in SHAPES.items() if type(value) is kind), None)
    found = [each for each in SHAPES if isinstance(value, dict) and each in value]
    if found == ["box"] and isinstance(value["box"], str):
        found = ["box_markers"]
    return f"{found[0]} shape" if len(found) == 1 else None


AnyShape = Annotated[
    Annotated[MeshShape, Tag("mesh shape")]
    | Annotated[BoxShape, Tag("box shape")]
    | Annotated[MarkerBoxShape, Tag("box_markers shape")]
    | Annotated[CylinderShape, Tag("cylinder shape")]
    | Annotated[SphereShape, Tag("sphere shape")]
    | Annotated[CapsuleShape, Tag("capsule shape")]
    | Annotated[CapsulesShape, Tag("capsules shape")]
    | Annotated[PartsShape, Tag("parts shape")],
    Discriminator(shape_tag, custom_error_type="shape", custom_error_message="no shape"),
]


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

    extend: Literal["none", "rest"] = key(
        "``rest``: before and after its recording the body stays where it was.", "none"
    )
    offset: Pose | None = key("Pose of the sensor or object in the recorded body's frame.", None)
    shape: AnyShape | None = key("Its surface, in its own frame.", None)
    agent: str = key("Name of the agent whose body it is or rides on; the first if not given.", "")


class Tracked(Traits):
    """Keys that say which body or which markers of a file something is."""

    file: str | None = key(
        "Name under ``[files]``; needed if several files have the name.",
        None,
        beside="body markers",
    )
    body: TextOrTexts | None = key(
        "Name of the body or joint in the file; or several names or patterns with *, one "
        "recorded after the other.",
        None,
        apart="markers",
    )
    markers: list[str] | None = key(
        "Three or more markers that keep their distances; or one, a point that does not turn.", None
    )
    residual_m: float = key(
        "Largest median distance of the markers from their rigid places.",
        0.010,
        unit="m",
        beside="markers",
    )
    arrangement: dict[str, Vector] | None = key(
        "Place of each marker in the body's frame [m]; else fitted to the recording.",
        None,
        beside="markers",
        apart="origin axes",
    )
    origin: list[str] = key(
        "Markers whose mean is the frame's origin; else the mean of all.", [], beside="markers"
    )
    axes: Annotated[
        dict[Literal["x", "y", "z"], Pair] | None, Field(min_length=2, max_length=2)
    ] = key(
        "Two axes, each from one marker to another; the second is made square to the first.",
        None,
        beside="markers",
    )
    extend: Literal["none", "rest"] = key(
        "``rest``: before and after its recording the body stays where it was.",
        "none",
        beside="body markers",
    )
    offset: Pose | None = key(
        "Pose of the sensor or object in the recorded body's frame.", None, beside="body markers"
    )


class SensorEntry(Tracked):
    """A tracked body segment: one that acts, or one that attends."""

    one_of: ClassVar[tuple[str, ...]] = ("body", "markers")

    name: Name = key("A name of its own: lower case, digits and _.")
    end_effector: str = key(
        "What the segment is, a noun without side: hand, foot, head, eyes, knee ..."
    )
    side: Literal["right", "left", "none"] = key("Its side.", "none")
    link: str | None = key("The chain that it ends, like right_arm; derived if not given.", None)
    part_of: str = key(
        "The sensor whose end-effector this one rides on too, as a finger on a hand: what it "
        "touches that end-effector touches.",
        "",
    )
    role: Literal["acts", "attends"] | None = key(
        "``acts`` makes segments, ``attends`` makes none; head and eyes attend, else acts.", None
    )
    gaze: Vector = key("Direction of sight in the sensor's frame.", [1.0, 0.0, 0.0])
    eye: Vector = key("Where sight starts in the sensor's frame.", [0.0] * 3, unit="m")


class ObjectTraits(Traits):
    """Keys that an ``[[object]]`` shares with many objects declared at once."""

    tag: Literal["self", "fixed", "mobile"] | None = key(
        "A part of the agent, fixed in the world, or able to be moved.", None
    )
    kind: Filled | None = key("Its noun; the name if not given.", None)
    assumed: str = key(
        "Why and how its pose or size is an assumption, where it was not recorded.", ""
    )
    deformable: bool = key("Whether it gives way under a hand.", False)
    motion_floor_m: Positive | None = key(
        "A smaller displacement of it is no motion.", None, unit="m"
    )
    mass_kg: Positive | None = key("Its mass.", None, unit="kg")


class ObjectEntry(Tracked, ObjectTraits):
    """Something that may be touched: recorded, fixed, or placed under what rests on it."""

    one_of: ClassVar[tuple[str, ...]] = ("body", "markers", "position", "top_at_bottom_of")

    name: Name = key("A name of its own: lower case, digits and _.")
    tag: Literal["self", "fixed", "mobile"] = key(
        "A part of the agent, fixed in the world, or able to be moved."
    )
    part_of: str = key(
        "The object that it is a part of, on a hinge or a rail; found by the motion if not given.",
        "",
    )
    closed_deg: float | None = key(
        "Its turn on its hinge where it is closed, from where its axes are parallel to those of "
        "its base, about the axis whose largest part in the base's frame is positive.",
        None,
        unit="degrees",
        beside="part_of",
        apart="closed_m",
    )
    closed_m: float | None = key(
        "Its shift on its rail where it is closed, from where its origin is level with its "
        "base's, along the axis whose largest part in the base's frame is positive.",
        None,
        unit="m",
        beside="part_of",
    )
    position: Annotated[list[float], Field(min_length=2, max_length=3)] | None = key(
        "x, y and z in the world, whose z axis points up whatever ``up`` says of the files; "
        "x and y only, where ``top_at_bottom_of`` gives the height.",
        None,
        unit="m",
        apart="body markers",
    )
    orientation: Quaternion | None = key(
        "Unit quaternion w x y z in the world, whose z axis points up.",
        None,
        beside="position",
        apart="body markers top_at_bottom_of",
    )
    top_at_bottom_of: str | None = key(
        "Object that rests on this one, or a pattern with *: the upper side is put at its "
        "lowest point.",
        None,
        apart="body markers",
    )
    at_s: float | None = key(
        "When that object rests on it; from the end if negative.",
        None,
        unit="s",
        beside="top_at_bottom_of",
    )
    of: Literal["median", "lowest"] = key(
        "Which height to take of several objects.", "median", beside="top_at_bottom_of"
    )
    turn_deg: float = key(
        "Rotation about the vertical.", 0.0, unit="deg", beside="top_at_bottom_of"
    )
    surface_m: float | None = key(
        "Height of the bearing surface in its own frame; its highest point if not given.",
        None,
        unit="m",
        beside="top_at_bottom_of",
    )


class ManySensors(Entry):
    """A sensor for each of many bodies of a file, named after them."""

    file: str = key("Name under ``[files]``.")
    bodies: TextOrTexts = key("The bodies' names; ``*`` is every body.", "*")
    names: dict[str, str] = key(
        "What bodies are called whose names in the file are those of others.", {}
    )
    sides: dict[Literal["left", "right"], str] = key("How the names of each side begin.", {})
    attends: list[str] = key("Bodies that attend; all others act.", [])
    end_effectors: dict[str, str] = key("What bodies are; else their names without side.", {})
    extend: Literal["none", "rest"] = key(
        "``rest``: before and after its recording the body stays where it was.", "none"
    )
    shape: AnyShape | None = key("The shape of each, in its own frame.", None)


class ObjectKind(ObjectTraits):
    """What the objects of one kind are; it prevails over what is said of all."""

    name: Name = key("Name of the first; others are numbered.")


class ManyObjects(ObjectTraits):
    """An object for each of many bodies of a file, by the kinds that their names tell."""

    file: str = key("Name under ``[files]``.")
    bodies: str = key("A pattern that their names fit.", "*")
    kinds: dict[str, ObjectKind] = key(
        "Kinds by how names begin; bodies of none are counted and left out.", {}
    )
    touched_by: str = key("A sensor that touches each by distance.", "", beside="touched_within_m")
    touched_within_m: float | None = key(
        "At this distance of origins or nearer.", None, unit="m", beside="touched_by"
    )


def _as_text(value: object) -> object:
    """TOML has dates of its own."""
    return value.isoformat() if isinstance(value, date) else value


def _is_time(value: str) -> str:
    stated = iso_time(value)
    if not stated:
        raise PydanticCustomError("time", "no date, or date and time, of ISO 8601")
    return stated


Up = Literal["z", "y", "x", "-z", "-y", "-x"]
Order = Literal["xyzw", "wxyz"]
Rotations = Literal["helical", "euler_xyz", "rpy"]
UnitOrScale = Annotated[
    Annotated[Unit, Tag("as text")] | Annotated[Positive, Tag("as number")],
    Discriminator(form_of_value),
]
Tolerance = Annotated[float, Field(ge=0.0, lt=1.0)]


class ArrayGroup(Entry):
    """Arrays of NPZ, or features of LeRobot: poses of bodies, or positions of points."""

    one_of: ClassVar[tuple[str, ...]] = ("names", "body")

    positions: str = key(
        "Array of positions: (frames, 3) or (frames, bodies, 3); of any array, a part of the last "
        "axis may be named: ``state[0:3]``, of LeRobot also ``state[x,y,z]``."
    )
    quaternions: str | None = key(
        "Array of quaternions; points without orientation have none.", None
    )
    rotations: str | None = key(
        "Array of three numbers for each orientation [rad], in place of quaternions.",
        None,
        apart="quaternions",
    )
    order: Order | Rotations | None = key(
        "Order of the quaternions' components; or what rotations are, as the file's "
        "``rotations`` says.",
        None,
    )
    names: TextOrTexts | None = key(
        "Array of the bodies' or points' names, or the names themselves.", None
    )
    body: str | None = key("Name of the one body.", None)


class MotionFile(Entry):
    """A motion file, with what it does not state itself; a path alone may be given as text."""

    path: str = key("The file, relative to the capture.toml; ${NAME} is an environment variable.")
    unit: UnitOrScale | None = key(
        "Unit of this file's lengths, or metres per unit as a number.", None
    )
    up: Up | None = key("The axis of this file that points up.", None)
    handedness: Handedness | None = key("Handedness of this file's axes.", None)
    parents: dict[str, str] = key("Parent of each joint, where the file holds no skeleton.", {})
    places: dict[str, str] = key(
        "Place on the body of joints or markers whose names do not tell it, or tell another.", {}
    )
    time: str | None = key("CSV, NPZ: column or array of times [s].", None)
    rate_hz: Positive | None = key(
        "CSV, NPZ: frames a second; checked against time stamps if there are any.", None, unit="Hz"
    )
    fps: str | None = key("NPZ: array that holds the rate [Hz].", None)
    arrays: list[ArrayGroup] | None = key("NPZ, LeRobot: what the arrays or features are.", None)
    columns: dict[str, list[str]] | None = key(
        "CSV: the 7 columns (x y z, quaternion) or 3 columns (x y z) of each body or point.", None
    )
    order: Order | None = key("CSV: order of the quaternions' columns; xyzw.", None)
    delimiter: str | None = key("CSV: what separates cells.", None)
    rotations: Rotations | None = key(
        "Vicon CSV: what RX, RY and RZ are: a vector along the axis, as long as the angle; "
        "angles about axes that turn with the body; roll, pitch and yaw about fixed axes x, y, z; "
        "helical.",
        None,
    )
    demo: str | None = key("HDF5: the name of the demonstration; the first if not given.", None)
    episode: str | None = key(
        "LeRobot: number of the episode; if neither it nor ``takes`` are given, each is a take.",
        None,
    )
    folder: str | None = key("JSON in a tar archive: the folder in it.", None)
    time_unit_s: Positive | None = key(
        "JSON: seconds per unit of the time stamps; 0.001.", None, unit="s"
    )


class Performer(Entry):
    """Who performs. One under ``[agent]``; several each under ``[[agent]]``."""

    name: Filled = key("A name of its own.", "agent")
    kind: Filled = key("A noun.", "person")
    measures: dict[str, float] = key("Lengths [m] by name (``stature``), and ``mass`` [kg].", {})


class Contact(Entry):
    """When two bodies count as touching."""

    tolerance_m: Tolerance | None = key(
        "Largest distance of surfaces in contact; derived from noise if not given.", None, unit="m"
    )
    dropout_s: Tolerance | None = key(
        "Shorter interruptions of a contact are closed.", None, unit="s"
    )
    minimum_s: Tolerance | None = key("Shorter contacts are dropped.", None, unit="s")


class Pivots(Entry):
    """Two bodies that touch while their origins are near, for bodies without shapes."""

    first: str = key("Name of a sensor or object.")
    second: str = key("Name of the other.")
    distance_m: float = key("They touch at this distance or nearer.", unit="m")


class Purposes(Entry):
    """What a step is done for; the first that fits counts."""

    purpose: str = key("The purpose, as an action.")
    action: str = key("Only steps of this name.", "")
    object: str = key("Only steps about this object.", "")
    goal: str = key("Only steps with this goal.", "")


def _has_name(value: dict[str, str]) -> dict[str, str]:
    if "take" not in value:
        raise PydanticCustomError("take", "no take")
    return value


class Takes(Entry):
    """The trials that one file describes."""

    takes: list[
        Annotated[
            Annotated[str, Tag("as text")]
            | Annotated[dict[str, str], AfterValidator(_has_name), Tag("as table")],
            Discriminator(form_of_value),
        ]
    ] = key(
        "Names of the trials that the file describes, each a text or a table with ``take``; the "
        "capture is called ``name:take``; "
        "{take} and the table's other keys in braces are replaced in every text.",
        [],
    )


class CaptureFile(Takes):
    """The whole file: general keys, then its tables."""

    one_of: ClassVar[tuple[str, ...]] = ("sensor", "sensors_from")

    name: Filled | None = key("Name of the capture; its folder's if not given.", None)
    recorded: Annotated[str, BeforeValidator(_as_text), AfterValidator(_is_time)] | None = key(
        "When it was recorded: a date, or a date and time with or without a time zone (ISO "
        "8601); it goes before what files say.",
        None,
    )
    unit: UnitOrScale | None = key(
        "Unit of lengths in files that do not state it, or metres per unit as a number.", None
    )
    up: Up | None = key("Axis that points up in files that do not state it.", None)
    handedness: Handedness = key(
        "Of the files' axes; a left-handed world is mirrored in x.", "right"
    )
    rate_hz: Positive | None = key(
        "Every stream is resampled to it; needed if files have different clocks.", None, unit="Hz"
    )
    from_s: float | None = key("What is kept begins here, after the first frame.", None, unit="s")
    to_s: float | None = key("What is kept ends here, after the first frame.", None, unit="s")
    force_transfer: bool = key("Whether force passes to objects in this trial.", False)
    parts: Literal["together", "apart"] = key(
        "Sensors on parts of one hand or foot, by their names (palm and fingers, heel and "
        "toes): ``together`` they are one end-effector, ``apart`` each is one of its own.",
        "together",
    )
    files: Annotated[
        dict[
            str,
            Annotated[
                Annotated[str, Tag("as text")] | Annotated[MotionFile, Tag("as table")],
                Discriminator(form_of_value),
            ],
        ],
        Field(min_length=1),
    ] = key('Motion files by names of your choice: ``motion = "recording.c3d"``.')
    agent: Annotated[
        Annotated[Performer, Tag("as table")] | Annotated[list[Performer], Tag("as list")],
        Discriminator(form_of_value),
    ] = key("Who performs: one under ``[agent]``, several each under ``[[agent]]``.", [])
    contact: Contact | None = key("When bodies touch.", None)
    sensor: list[SensorEntry] = key("Tracked body segments.", [])
    sensors_from: list[ManySensors] = key("Many sensors at once.", [])
    object: list[ObjectEntry] = key("What may be touched.", [])
    objects_from: list[ManyObjects] = key("Many objects at once.", [])
    pivot_contact: list[Pivots] = key("Contact by distance of origins.", [])
    purpose: list[Purposes] = key("What steps are done for.", [])

    @property
    def performers(self) -> list[Performer]:
        """Everyone who performs; the first is the one whom sensors belong to by default."""
        stated = [self.agent] if isinstance(self.agent, Performer) else self.agent
        return stated or [Performer()]
