"""An observation: everything that was understood of one capture, frozen."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from importlib import import_module
from typing import Any, Literal, Self

from capar.model.calibration import Calibration
from capar.model.capture import Agent, Notice, Source
from capar.model.errors import CaparError, UnknownNameError
from capar.model.facts import Fact
from capar.model.locations import ConstraintLocation, GuideLocation, SampledTrack
from capar.model.par import UNKNOWN, ComplexPar, FeatureSet, Ipar, NamingRule, Style, Upar

#: What shows an observation in some form, as ``MODULE:FUNCTION``; imported when asked for
VIEWS = {
    "html": "capar.views.page:observation_page",
    "frame": "capar.views.tables:observation_frame",
}


def display(form: str) -> Callable[..., Any]:
    """The function that shows observations in that form, a key of ``VIEWS``."""
    module, _, function = VIEWS[form].partition(":")
    show: Callable[..., Any] = getattr(import_module(module), function)
    return show


Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class ForceStyle:
    """How an end-effector set a thing going that then moved on alone (thesis 3.4.3, Fig 4.13)."""

    object: str
    ee: str
    start_s: float  #: When it was struck or let go [s]
    end_s: float  #: Until when its motion was followed [s]
    struck: bool  #: Whether it was at rest before; else it was let go in motion
    position_m: Vector  #: Of its box's middle at the start [m]
    velocity_mps: Vector  #: Of the thing, just after the start [m/s]
    striker_mps: Vector  #: Of the end-effector, just before [m/s]
    follow_mps: Vector  #: Of the end-effector, just after [m/s]
    #: Between end-effector and thing, along the line of impact (eq. 3.5) [1]; None of a thing that
    #: was let go
    restitution: float | None
    #: Deceleration over speed while it slid, along x and y [1/s]; None if it did not slide
    damping_per_s: tuple[float, float] | None
    #: Slope of acceleration over velocity against time (eq. 3.9), the thesis's damping [1/s^2]
    thesis_damping: tuple[float, float] | None
    #: Restitution between the thing and what it fell on [1]; None if it did not bounce
    bounce: float | None
    #: Momentum that it was given [N s]; None where its mass is not stated
    impulse_ns: Vector | None
    #: Root mean square distance of its recorded places from the fitted motion [m]
    residual_m: float


#: End-effectors of which a body has two, and what both are called
BOTH = {"hand": "hands", "foot": "feet"}
MOST_SHOWN = 240  # so many letters of segments' names are shown in one line


@dataclass(frozen=True, slots=True, order=True)
class Border:
    """Why a segment begins or ends: the relation that began or ended there."""

    #: What changes there.
    #: ``first``, ``last``; of a contact ``begins``, ``ends``; of a body ``starts_moving``,
    #: ``stops_moving``, ``turns``, ``comes_to_rest``, ``leaves_rest``, ``reverses``,
    #: ``levels``, ``begins_swinging``, ``ends_swinging``, ``tips``, ``rights``,
    #: ``begins_looking``, ``ends_looking`` or ``shifts_weight``
    kind: str
    body: str = ""
    other: str = ""


@dataclass(frozen=True, slots=True)
class Segment:
    """The motion of one link between two borders (thesis 4.3.2)."""

    ee: str
    index: int  #: Its number in the link, from zero
    first: int  #: Frame of the border where it begins
    last: int  #: Frame of the border where it ends; the next segment begins there
    start_s: float
    end_s: float
    name: str  #: The most specific name that the rules give, or ``Unknown``
    general: tuple[str, ...]  #: What it specialises, nearest first
    #: Names that fit equally well, or, if unknown, those that fit furthest
    candidates: tuple[str, ...]
    level: str  #: The feature at which an unknown segment parted from every known set; else empty
    objects: tuple[str, ...]  #: Dominant object first
    possessed: bool  #: Whether the end-effector possesses the dominant object
    features: FeatureSet
    begins: tuple[Border, ...]
    ends: tuple[Border, ...]
    purpose: str
    #: Where its body is or goes: preposition, body, and the other body; sorted
    prepositions: tuple[tuple[str, str, str], ...] = ()
    #: Which of its objects the performer looks at, and when; sorted.
    #: ``throughout``, at its ``start`` or ``end``, ``meanwhile`` and at neither, or ``before``: in
    #: the segment that comes before it
    looks: tuple[tuple[str, str], ...] = ()

    @property
    def known(self) -> bool:
        """Whether a rule named it."""
        return self.name != UNKNOWN


@dataclass(frozen=True, slots=True)
class ObservedLink:
    """One acting end-effector and its segments in order."""

    ee: str
    kind: str
    side: str
    segments: tuple[Segment, ...]
    agent: str = ""  #: Whose it is, where several agents perform; else empty


@dataclass(frozen=True, slots=True)
class JointAction:
    """What several end-effectors do with one object as one action: the part that all share."""

    name: str  #: The most specific name that fits every segment in it
    #: What all their segments are about; the object that all of them possess first
    objects: tuple[str, ...]
    #: Who takes part, sorted; whoever has several segments in it, as each foot in a walk, once for
    #: each of them
    ees: tuple[str, ...]
    segments: tuple[int, ...]  #: The index of each one's segment, in that order
    first: int  #: Frame from which all of them do it
    last: int  #: Frame to which they do
    start_s: float
    end_s: float

    @property
    def who(self) -> tuple[str, ...]:
        """Who takes part, each once, sorted."""
        return tuple(dict.fromkeys(self.ees))


@dataclass(frozen=True, slots=True, order=True)
class SegmentRelation:
    """What a segment means beside another one, as the rules derive it.

    Kinds are those of `SEGMENT_RELATIONS`; a segment is its end-effector and its index.
    """

    kind: str
    segment: tuple[str, int]
    other: tuple[str, int]


#: It goes on with the other; it does so after a pause; it is a short part of it; it turns upright
#: what was poured from in it; it holds what the other works in
SEGMENT_RELATIONS = ("same_action", "resumes", "fragment_of", "rights", "steadies")


@dataclass(frozen=True, slots=True)
class ObservedObject:
    """What the scene says of a tag object."""

    name: str
    kind: str
    tag: str
    #: Lengths along its own axes [m]; zero where it has no shape
    size_m: tuple[float, float, float]
    shape: str
    assumed: str
    #: Where it was in the first frame in which it is known [m]
    position_m: tuple[float, float, float]
    orientation: tuple[float, float, float, float]  #: Unit quaternion w x y z there


#: What a data frame of an observation can hold a row of
FrameOf = Literal["segments", "contacts", "motions", "facts"]


@dataclass(frozen=True, slots=True)
class Observation:
    """A capture understood: its scene, facts, segments and PARs, and where they come from."""

    capture: str
    profile: str
    rules: str  #: SHA-256 of the rule base
    version: str
    agent: Agent
    duration_s: float
    rate_hz: float
    frames: int
    objects: tuple[ObservedObject, ...]
    links: tuple[ObservedLink, ...]
    facts: tuple[Fact, ...]
    upars: tuple[Upar, ...]
    ipars: tuple[Ipar, ...]  #: One for each segment, links in order
    complex_par: ComplexPar
    locations: tuple[ConstraintLocation, ...]
    styles: tuple[Style, ...]
    sources: tuple[Source, ...]
    notices: tuple[Notice, ...]
    #: What several end-effectors did with one object as one action, in order of time
    joint: tuple[JointAction, ...] = ()
    #: Which segments are one action, or serve another one; sorted
    relations: tuple[SegmentRelation, ...] = ()
    others: tuple[Agent, ...] = ()  #: Who else performed, where several agents did
    #: What was decided once for the whole recording; None where it was not kept
    calibration: Calibration | None = None
    guides: tuple[GuideLocation, ...] = ()  #: The hinges and rails on which objects move, by object
    #: What set things going that then moved on alone, in order of time
    forces: tuple[ForceStyle, ...] = ()
    tracks: tuple[SampledTrack, ...] = ()  #: Where each sensor and object was throughout, by name
    naming: tuple[NamingRule, ...] = ()  #: The rules that named its segments, by name

    @property
    def segments(self) -> tuple[Segment, ...]:
        """Every segment, links in order."""
        return tuple(each for link in self.links for each in link.segments)

    def __repr__(self) -> str:
        """One line: the capture, and the names of each end-effector's segments."""
        done = "; ".join(
            f"{link.ee}: {' '.join(each.name for each in link.segments) or 'nothing'}"
            for link in self.links
        )
        done = done if len(done) <= MOST_SHOWN else f"{done[: MOST_SHOWN - 3]}..."
        return (
            f"<Observation {self.capture!r}, {self.duration_s:.2f} s, {self.profile} rules, "
            f"{len(self.segments)} segments; {done}>"
        )

    def _repr_html_(self) -> str:
        """Its table and picture, as notebooks show them."""
        page: str = display("html")(self)
        return page

    def to_frame(self, of: FrameOf = "segments") -> Any:
        """A pandas DataFrame of segments, contacts, motions or facts, one a row; times in s."""
        return display("frame")(self, of)

    def performer(self, ee: str) -> str:
        """Name of the agent whose end-effector that is."""
        return next((each.agent for each in self.links if each.ee == ee), "") or self.agent.name

    def who(self, joint: JointAction) -> str:
        """Who takes part in a joint action: ``both hands``, or each end-effector by its name."""
        own = [link for link in self.links if link.ee in joint.ees]
        pair = sorted((link.kind, link.side) for link in own)
        for kind, several in BOTH.items():
            if (
                len(joint.who) == 2
                and len({link.agent for link in own}) == 1
                and pair == [(kind, "left"), (kind, "right")]
            ):
                return f"both {several}"
        *some, last = (name.replace("_", " ") for name in joint.who)
        return f"{', '.join(some)} and {last}"


FORM = "CAPTURE/END_EFFECTOR/INDEX"
EXAMPLE = "drink_from_mug/right_hand/3"


class AddressError(CaparError):
    """A text that is no address of a segment."""


@dataclass(frozen=True, slots=True)
class SegmentAddress:
    """Which segment is meant: of which end-effector, counted from zero, in which capture."""

    ee: str
    index: int  #: Its number in the link, from zero
    capture: str = ""  #: Name or path of the capture; empty where there is only one

    def __post_init__(self) -> None:
        """Check that the address can be read back from its text."""
        if not self.ee or "/" in self.ee or self.index < 0:
            raise AddressError(
                f"end-effector {self.ee!r} and index {self.index} are no address of a segment; "
                "an end-effector has a name without '/', an index is 0 or more"
            )

    @classmethod
    def parse(cls, text: str) -> Self:
        """The address that a text states; the capture may itself contain slashes.

        Raises:
            AddressError: It is no address; the message says what one looks like.
        """
        *before, ee, index = ["", *text.strip().rsplit("/", 2)][-3:]
        if not ee or not (index.isascii() and index.isdecimal()):
            raise AddressError(
                f"{text!r} is no address of a segment; write {FORM}, such as {EXAMPLE}, "
                "and leave CAPTURE out where there is only one"
            )
        return cls(ee, int(index), "".join(before))

    def __str__(self) -> str:
        """The text from which ``parse`` reads the address back."""
        capture = f"{self.capture}/" if self.capture else ""
        return f"{capture}{self.ee}/{self.index}"


def split_capture(text: str) -> tuple[str, SegmentAddress]:
    """The capture that an address names, and the address in it; AddressError if it has none."""
    address = SegmentAddress.parse(text)
    if not address.capture:
        raise AddressError(f"{text!r} names no capture; write {FORM}, such as {EXAMPLE}")
    return address.capture, replace(address, capture="")


def find_segment(
    links: Iterable[ObservedLink], address: SegmentAddress, *, capture: str
) -> Segment:
    """The segment of a capture's links at an address; UnknownNameError where there is none."""
    if address.capture not in {"", capture}:
        raise UnknownNameError("capture", address.capture, [capture])
    known = {
        str(SegmentAddress(segment.ee, segment.index)): segment
        for link in links
        for segment in link.segments
    }
    name = str(SegmentAddress(address.ee, address.index))
    if name not in known:
        raise UnknownNameError("segment", name, known, where=capture)
    return known[name]
