"""Action representations: UPARs, IPARs, complex PARs, and the rules that named their segments."""

import re
from dataclasses import dataclass
from enum import StrEnum

from capar.model.errors import ParError

ACTION_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")  # what a primitive may be called: ``MoveObjTo``
UNKNOWN = "Unknown"  # the name of a segment whose features no rule covers
ACROSS = 1  # the axis (y) across an object's plane that parts its left (+y) from its right


@dataclass(frozen=True, slots=True, order=True)
class Nlt:
    """Normalised local transform: a place in an object's frame over its size, and a quaternion."""

    position: tuple[float, float, float]
    #: Unit quaternion w x y z that takes the constraint's axes to the object's
    orientation: tuple[float, float, float, float]

    def mirrored(self, axis: int = ACROSS) -> "Nlt":
        """The same place for the other side of the body (thesis 4.4.2.2), across an axis x, y or z.

        The constraint's own axes are those of the other side's end-effector, mirrored alike.
        """
        x, y, z = (0.0 - each if i == axis else each for i, each in enumerate(self.position))
        w, *vector = self.orientation
        i, j, k = (each if n == axis else 0.0 - each for n, each in enumerate(vector))
        return Nlt((x, y, z), (w, i, j, k))


@dataclass(frozen=True, slots=True, order=True)
class FeatureSet:
    """What characterises a primitive, as strings of bits over its n objects (thesis 4.4.1).

    A relation string has n bits for the end-effector with each object, dominant first, then
    n - 1 for the dominant object with each other one.
    """

    rel_start: str
    rel_end: str
    change_loc: str
    #: General type: ``hand``, ``foot`` ...; ``any`` where a primitive is open to all
    end_effector: str
    force: str

    def __post_init__(self) -> None:
        """Check that the strings are bits and that their lengths agree."""
        count = len(self.change_loc)
        lengths = (2 * count - 1, 2 * count - 1, count, count) if count else (0, 0, 0, 0)
        strings = (self.rel_start, self.rel_end, self.change_loc, self.force)
        if tuple(map(len, strings)) != lengths or set("".join(strings)) - {"0", "1"}:
            raise ParError(
                f"feature strings {strings}: over {count} objects they have {lengths} bits, "
                "each 0 or 1"
            )

    @property
    def count(self) -> int:
        """The number of objects, n."""
        return len(self.change_loc)


@dataclass(frozen=True, slots=True, order=True)
class Condition:
    """Something that holds or does not in the world: a contact, a posture, a time, a capability."""

    kind: str  #: ``contact``, ``posture``, ``duration`` or ``capable``
    arguments: tuple[str, ...]  #: Names or parameters that it is about: ``("EE", "obj1")``
    holds: bool = True


@dataclass(frozen=True, slots=True, order=True)
class Call:
    """An action with its arguments, to be done."""

    action: str
    objects: tuple[str, ...]
    purpose: str = ""


@dataclass(frozen=True, slots=True, order=True)
class Preparation:
    """A condition that must hold before, and the action that makes it hold (thesis 4.6.1.1)."""

    condition: Condition
    action: Call


@dataclass(frozen=True, slots=True, order=True)
class Constraint:
    """What the core semantics constrain (thesis Fig 4.16)."""

    features: FeatureSet
    #: The two in the relation that ends the action: -1 the end-effector, else an object's index
    colliding_objects: tuple[int, int]


@dataclass(frozen=True, slots=True)
class PathPoint:
    """A significant place of the end-effector inside a segment (thesis Fig 4.11)."""

    time: float  #: Share of the segment's duration [1]
    position: tuple[float, float, float]  #: World position of the end-effector [m]


@dataclass(frozen=True, slots=True)
class Style:
    """How a performer does a primitive to a purpose with an end-effector (thesis 4.4.2.3)."""

    action: str
    purpose: str
    ee: str
    #: Share of the way covered, at equal steps of time from 0 to 1 (thesis eq. 4.1)
    velocity: tuple[float, ...]
    path: tuple[PathPoint, ...]


class Motion(StrEnum):
    """How the moved object moves."""

    NONE = "none"
    TRANSLATION = "translation"
    ROTATION = "rotation"
    BOTH = "both"


@dataclass(frozen=True, slots=True)
class CoreSemantics:
    """An action's primary components of meaning (thesis 4.1.1)."""

    motion: Motion
    moved: str  #: The parameter or object that moves; empty if none does
    causal: bool  #: Whether the agent causes that motion
    force: tuple[str, ...]  #: The objects that force is applied to
    #: Where the moved object, or else the end-effector, begins and ends [m]; empty in a UPAR
    path: tuple[tuple[float, float, float], ...]
    purpose: str
    enables: tuple[str, ...]  #: Names of the actions that this one makes possible
    termination: tuple[Condition, ...]
    duration_s: float | None  #: None in a UPAR, whose duration is a parameter
    manner: str  #: Whose style it has; empty in a UPAR
    constraint: Constraint


@dataclass(frozen=True, slots=True)
class Upar:
    """An uninstantiated action: agents and objects are parameters (thesis 4.1.2)."""

    name: str
    agent: str
    objects: tuple[str, ...]  #: Parameters, dominant object first: ``obj1``, ``obj2``
    general: tuple[str, ...]  #: The more general actions that it specialises, nearest first
    applicability: tuple[Condition, ...]
    preparation: tuple[Preparation, ...]
    steps: tuple[Call, ...]
    core: CoreSemantics
    post_assertions: tuple[Condition, ...]
    parent: str = ""  #: The complex action that it was observed in


@dataclass(frozen=True, slots=True)
class Ipar:
    """A UPAR bound to an agent, objects and a time; what it says overrides the UPAR."""

    upar: str
    agent: str
    ee: str  #: The specific end-effector: ``right_hand``
    objects: tuple[str, ...]
    start_s: float
    core: CoreSemantics
    preparation: tuple[Preparation, ...]
    post_assertions: tuple[Condition, ...]
    posture: str = ""  #: Name of the posture that it ends in, where it ends in no contact
    parent: str = ""


@dataclass(frozen=True, slots=True)
class Step:
    """One sub-action of a complex PAR, with the parameters of thesis 4.6.2."""

    action: str
    ee: str  #: The link's end-effector, or ``all`` for a step common to every link
    objects: tuple[str, ...]
    share: float  #: Its part of the whole duration [1]
    purpose: str
    begin: float  #: Where it begins, as a share of the whole duration [1]
    segments: tuple[int, ...]  #: Indices of the observed segments that it stands for
    posture: str = ""


@dataclass(frozen=True, slots=True)
class LinkSteps:
    """The steps of one link, in order."""

    ee: str
    steps: tuple[Step, ...]


@dataclass(frozen=True, slots=True, order=True)
class Relation:
    """Allen's relation between steps of different links, each (end-effector, index)."""

    first: tuple[str, int]
    relation: str
    second: tuple[str, int]


@dataclass(frozen=True, slots=True)
class ComplexPar:
    """Sequences of steps, one a link, in parallel, and the step that ends them all."""

    name: str
    objects: tuple[str, ...]
    duration_s: float
    links: tuple[LinkSteps, ...]
    common: Step | None  #: The ResumePosture that ends every link, if all end in one
    relations: tuple[Relation, ...]

    @property
    def signature(self) -> tuple[tuple[str, tuple[tuple[str, tuple[int, ...]], ...]], ...]:
        """What makes two observations one action: per link, names and numbered objects.

        Durations, styles, names of objects and who performed do not count.
        """
        numbers = {name: index for index, name in enumerate(self.objects)}
        common = (self.common,) if self.common else ()
        return tuple(
            (
                link.ee,
                tuple(
                    (step.action, tuple(numbers[each] for each in step.objects))
                    for step in (*link.steps, *common)
                ),
            )
            for link in self.links
        )


@dataclass(frozen=True, slots=True, order=True)
class Threshold:
    """A number that rules decide by."""

    name: str  #: With its unit at its end: ``height_mm``
    value: int


@dataclass(frozen=True, slots=True, order=True)
class NamingRule:
    """What defines a name of segments in the rule base that named them."""

    name: str
    file: str  #: The rule file, by its folder and its name
    sha256: str  #: Of the file's text
    text: str
    #: Those that the definition reads, and the vocabulary that it names, by name; those by which
    #: segments are cut are not among them
    thresholds: tuple[Threshold, ...]
