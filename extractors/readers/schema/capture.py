"""The schema of a capture.toml: every table and key with its type, unit, meaning and default."""

# ruff: noqa: RUF012  (pydantic copies the defaults of fields)

from datetime import date
from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from extractors.readers.recorded_times import iso_time
from extractors.readers.schema.bodies import (
    Filled,
    ManyObjects,
    ManySensors,
    ObjectEntry,
    Positive,
    SensorEntry,
)
from extractors.readers.schema.entry import Entry, key
from extractors.readers.schema.shapes import Handedness, Unit, form_of_value


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
UnitOrScale = Annotated[
    Annotated[Unit, Tag("as text")] | Annotated[Positive, Tag("as number")],
    Discriminator(form_of_value),
]
Tolerance = Annotated[float, Field(ge=0.0, lt=1.0)]


class ArrayGroup(Entry):
    """Arrays of an NPZ file that are the poses of bodies, or the positions of points."""

    one_of: ClassVar[tuple[str, ...]] = ("names", "body")

    positions: Annotated[str, key("Array of positions: (frames, 3) or (frames, bodies, 3).")]
    quaternions: Annotated[
        str | None, key("Array of quaternions; points without orientation have none.")
    ] = None
    order: Annotated[Order | None, key("Order of the quaternions' components.")] = None
    names: Annotated[str | None, key("Array of the bodies' names.")] = None
    body: Annotated[str | None, key("Name of the one body.")] = None


class MotionFile(Entry):
    """A motion file, with what it does not state itself; a path alone may be given as text."""

    path: Annotated[
        str, key("The file, relative to the capture.toml; ${NAME} is an environment variable.")
    ]
    unit: Annotated[
        UnitOrScale | None, key("Unit of this file's lengths, or metres per unit as a number.")
    ] = None
    up: Annotated[Up | None, key("The axis of this file that points up.")] = None
    handedness: Annotated[Handedness | None, key("Handedness of this file's axes.")] = None
    parents: Annotated[
        dict[str, str], key("Parent of each joint, where the file holds no skeleton.")
    ] = {}
    places: Annotated[
        dict[str, str],
        key("Place on the body of joints or markers whose names do not tell it, or tell another."),
    ] = {}
    time: Annotated[str | None, key("CSV, NPZ: column or array of times [s].")] = None
    rate_hz: Annotated[
        Positive | None,
        key("CSV, NPZ: frames a second; checked against time stamps if there are any.", unit="Hz"),
    ] = None
    fps: Annotated[str | None, key("NPZ: array that holds the rate [Hz].")] = None
    arrays: Annotated[list[ArrayGroup] | None, key("NPZ: what the arrays are.")] = None
    columns: Annotated[
        dict[str, list[str]] | None,
        key("CSV: the 7 columns (x y z, quaternion) or 3 columns (x y z) of each body or point."),
    ] = None
    order: Annotated[Order | None, key("CSV: order of the quaternions' columns; xyzw.")] = None
    delimiter: Annotated[str | None, key("CSV: what separates cells.")] = None
    folder: Annotated[str | None, key("JSON in a tar archive: the folder in it.")] = None
    time_unit_s: Annotated[
        Positive | None, key("JSON: seconds per unit of the time stamps; 0.001.", unit="s")
    ] = None


class Performer(Entry):
    """Who performs. One under ``[agent]``; several each under ``[[agent]]``."""

    name: Annotated[Filled, key("A name of its own.")] = "agent"
    kind: Annotated[Filled, key("A noun.")] = "person"
    measures: Annotated[
        dict[str, float], key("Lengths [m] by name (``stature``), and ``mass`` [kg].")
    ] = {}


class Contact(Entry):
    """When two bodies count as touching."""

    tolerance_m: Annotated[
        Tolerance | None,
        key("Largest distance of surfaces in contact; derived from noise if not given.", unit="m"),
    ] = None
    dropout_s: Annotated[
        Tolerance | None, key("Shorter interruptions of a contact are closed.", unit="s")
    ] = None
    minimum_s: Annotated[Tolerance | None, key("Shorter contacts are dropped.", unit="s")] = None


class Pivots(Entry):
    """Two bodies that touch while their origins are near, for bodies without shapes."""

    first: Annotated[str, key("Name of a sensor or object.")]
    second: Annotated[str, key("Name of the other.")]
    distance_m: Annotated[float, key("They touch at this distance or nearer.", unit="m")]


class Purposes(Entry):
    """What a step is done for; the first that fits counts."""

    purpose: Annotated[str, key("The purpose, as an action.")]
    action: Annotated[str, key("Only steps of this name.")] = ""
    object: Annotated[str, key("Only steps about this object.")] = ""
    goal: Annotated[str, key("Only steps with this goal.")] = ""


def _has_name(value: dict[str, str]) -> dict[str, str]:
    if "take" not in value:
        raise PydanticCustomError("take", "no take")
    return value


class Takes(Entry):
    """The trials that one file describes."""

    takes: Annotated[
        list[
            Annotated[
                Annotated[str, Tag("as text")]
                | Annotated[dict[str, str], AfterValidator(_has_name), Tag("as table")],
                Discriminator(form_of_value),
            ]
        ],
        key(
            "Names of the trials that the file describes, each a text or a table with ``take``; "
            "{take} and the table's other keys in braces are replaced in every text."
        ),
    ] = []


class CaptureFile(Takes):
    """The whole file: general keys, then its tables."""

    one_of: ClassVar[tuple[str, ...]] = ("sensor", "sensors_from")

    name: Annotated[Filled | None, key("Name of the capture; its folder's if not given.")] = None
    recorded: Annotated[
        Annotated[str, BeforeValidator(_as_text), AfterValidator(_is_time)] | None,
        key(
            "When it was recorded: a date, or a date and time with or without a time zone (ISO "
            "8601); it goes before what files say."
        ),
    ] = None
    unit: Annotated[
        UnitOrScale | None,
        key("Unit of lengths in files that do not state it, or metres per unit as a number."),
    ] = None
    up: Annotated[Up | None, key("Axis that points up in files that do not state it.")] = None
    handedness: Annotated[
        Handedness, key("Of the files' axes; a left-handed world is mirrored in x.")
    ] = "right"
    rate_hz: Annotated[
        Positive | None,
        key("Every stream is resampled to it; needed if files have different clocks.", unit="Hz"),
    ] = None
    from_s: Annotated[
        float | None, key("What is kept begins here, after the first frame.", unit="s")
    ] = None
    to_s: Annotated[
        float | None, key("What is kept ends here, after the first frame.", unit="s")
    ] = None
    force_transfer: Annotated[bool, key("Whether force passes to objects in this trial.")] = False
    parts: Annotated[
        Literal["together", "apart"],
        key(
            "Sensors on parts of one hand or foot, by their names (palm and fingers, heel and "
            "toes): ``together`` they are one end-effector, ``apart`` each is one of its own."
        ),
    ] = "together"
    files: Annotated[
        dict[
            str,
            Annotated[
                Annotated[str, Tag("as text")] | Annotated[MotionFile, Tag("as table")],
                Discriminator(form_of_value),
            ],
        ],
        Field(min_length=1),
        key('Motion files by names of your choice: ``motion = "recording.c3d"``.'),
    ]
    agent: Annotated[
        Annotated[Performer, Tag("as table")] | Annotated[list[Performer], Tag("as list")],
        Discriminator(form_of_value),
        key("Who performs: one under ``[agent]``, several each under ``[[agent]]``."),
    ] = []
    contact: Annotated[Contact | None, key("When bodies touch.")] = None
    sensor: Annotated[list[SensorEntry], key("Tracked body segments.")] = []
    sensors_from: Annotated[list[ManySensors], key("Many sensors at once.")] = []
    object: Annotated[list[ObjectEntry], key("What may be touched.")] = []
    objects_from: Annotated[list[ManyObjects], key("Many objects at once.")] = []
    pivot_contact: Annotated[list[Pivots], key("Contact by distance of origins.")] = []
    purpose: Annotated[list[Purposes], key("What steps are done for.")] = []

    @property
    def performers(self) -> list[Performer]:
        """Everyone who performs; the first is the one whom sensors belong to by default."""
        stated = [self.agent] if isinstance(self.agent, Performer) else self.agent
        return stated or [Performer()]
