"""The shapes of a capture.toml as a schema: mesh files, primitives, capsules and parts."""

# ruff: noqa: RUF012  (pydantic copies the defaults of fields)

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from capar.model import geometry
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

    position: Annotated[Vector, key("Position; zero if not given.", unit="m")] = [0.0, 0.0, 0.0]
    orientation: Annotated[
        Quaternion, key("Unit quaternion w x y z; no rotation if not given.")
    ] = [1.0, 0.0, 0.0, 0.0]


class MeshShape(Pose):
    """A mesh file: STL, PLY, OBJ, OFF, GLB; or 3MF, DAE, X3D, glTF if trimesh can read them."""

    mesh: Annotated[
        str, key("The file, relative to the capture.toml; ${NAME} is an environment variable.")
    ]
    unit: Annotated[Unit, key("Unit of the mesh's coordinates.")] = "m"
    handedness: Annotated[
        Handedness | None,
        key("Axes of the mesh; if not given, those of the motion file of its body."),
    ] = None


class BoxShape(Pose):
    """A box about the origin of its own frame."""

    box: Annotated[
        Annotated[list[Size], Field(min_length=3, max_length=3)],
        key("Lengths along x, y and z.", unit="m"),
    ]


class MarkerBoxShape(Pose):
    """The smallest box along the body's axes that holds markers."""

    box: Annotated[Literal["markers"], key("The word ``markers``.")]
    around: Annotated[
        list[str], key("Markers or bodies inside it; if not given, the body's own markers.")
    ] = []
    margin_m: Annotated[float, key("Added on every side.", unit="m")] = 0.0


class CylinderShape(Pose):
    """A cylinder about the z axis of its own frame."""

    cylinder: Annotated[
        Annotated[list[Size], Field(min_length=2, max_length=2)],
        key("Radius and height.", unit="m"),
    ]


class SphereShape(Pose):
    """A sphere."""

    sphere: Annotated[Size, key("Radius.", unit="m")]


class CapsuleShape(Pose):
    """A cylinder with rounded ends, about the z axis of its own frame."""

    capsule: Annotated[
        Annotated[list[Size], Field(min_length=2, max_length=2)],
        key("Radius, and distance between the centres of the two ends.", unit="m"),
    ]


class CapsulesShape(Pose):
    """Capsules between pairs of markers, joints or bodies, where these are in the mean."""

    capsules: Annotated[
        Annotated[Literal["children", "descendants"], Tag("as text")]
        | Annotated[list[Pair], Field(min_length=1), Tag("as list")],
        Discriminator(form_of_value),
        key(
            "Pairs of names; or ``children``, from the body's joint to the next joints; or "
            "``descendants``, along every bone below it."
        ),
    ]
    radius_m: Annotated[Size, key("Radius of every capsule.", unit="m")]


class PartsShape(Pose):
    """Several shapes as one; they may overlap."""

    parts: Annotated[
        list["AnyShape"], key("The shapes, each a table of this kind."), Field(min_length=1)
    ]


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
