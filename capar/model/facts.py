"""Facts: typed values that are atoms of the rules; a kind states all that others derive from it."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from enum import Enum
from functools import cache
from itertools import groupby
from operator import attrgetter
from typing import Any, ClassVar, Self, TypeVar, cast, dataclass_transform, get_type_hints

import clingo

from capar.model.capture import NAME
from capar.model.errors import FactError

LARGEST = 2**31 - 1  # the largest integer of the solver, which wraps silently beyond


@dataclass(frozen=True, slots=True, order=True)
class Fact:
    """A relation with arguments; the predicate is a class's, the arguments are an instance's.

    Frames are numbered from zero; intervals are closed, [first, last].
    """

    predicate: ClassVar[str]

    def symbol(self) -> clingo.Symbol:
        """The fact as the solver's own value; FactError for integers beyond 32 bits."""
        values = (getattr(self, name) for name in _arguments(cast(Any, type(self))))
        return clingo.Function(self.predicate, [_symbol(each) for each in values])

    @classmethod
    def from_symbol(cls, symbol: clingo.Symbol) -> Self:
        """The fact that a solver's value states; FactError where it is of another kind."""
        kinds = _arguments(cast(Any, cls)).values()
        if symbol.name != cls.predicate or len(symbol.arguments) != len(kinds):
            raise FactError(f"{symbol} is no {cls.predicate}/{len(kinds)}")
        return cls(*map(_value, symbol.arguments, kinds))

    def __str__(self) -> str:
        """The fact as a line of a logic program, without its full stop."""
        return program((self,))[:-2]


def _symbol(value: Any) -> clingo.Symbol:
    if isinstance(value, int):
        return clingo.Number(_checked_int32(value))
    return clingo.Function(value) if NAME.fullmatch(value) else clingo.String(value)


@cache
def _word(value: str) -> str:
    """A name as the solver writes it."""
    return str(_symbol(value))


def _checked_int32(value: int) -> int:
    if abs(value) > LARGEST:
        raise FactError(f"{value} does not fit the solver's 32 bits")
    return value


def _value(symbol: clingo.Symbol, kind: type) -> Any:
    if symbol.type is clingo.SymbolType.Number and kind is int:
        return symbol.number
    if symbol.type is clingo.SymbolType.String and kind is str:
        return symbol.string
    if symbol.type is clingo.SymbolType.Function and kind is str and not symbol.arguments:
        return symbol.name
    raise FactError(f"{symbol} is no {kind.__name__}")


@cache
def _arguments(cls: Any) -> Mapping[str, type]:
    """The type of every argument of a kind of fact, in their order."""
    hints = get_type_hints(cls)
    return {each.name: hints[each.name] for each in fields(cls)}


def signatures(facts: Iterable[Fact]) -> frozenset[tuple[str, int]]:
    """The predicates of the facts, each with its number of arguments."""
    kinds: set[Any] = {type(fact) for fact in facts}
    return frozenset((kind.predicate, len(_arguments(kind))) for kind in kinds)


def program(facts: "tuple[Fact, ...]") -> str:
    """The facts as a logic program, one a line; FactError for integers beyond 32 bits."""
    lines: list[str] = []
    # By columns of one kind, in a third of the time of one fact after another.
    for kind, group in groupby(facts, cast(Any, type)):
        same = list(group)
        columns: list[Iterable[int | str]] = []
        for name, of in _arguments(kind).items():
            values = [getattr(fact, name) for fact in same]
            if of is int:
                _checked_int32(max(values, key=abs))
            columns.append(values if of is int else map(_word, values))
        if columns:
            line = f"{kind.predicate}({','.join(['%s'] * len(columns))}).\n"
            lines.extend(map(line.__mod__, zip(*columns, strict=True)))
        else:
            lines += [f"{kind.predicate}.\n"] * len(same)
    return "".join(lines)


class Span(Enum):
    """When the facts of a kind hold."""

    ALWAYS = ()
    INSTANT = ("frame",)
    INTERVAL = ("first", "last")


@dataclass(frozen=True, slots=True)
class Declaration:
    """What a kind of fact states about itself."""

    #: The class in the ontology and the property of each argument. Of a sampled kind: of each
    #: argument that is a name, and one for the rows of numbers, each led by its frame
    terms: str
    #: The field that names the body that the fact is about; empty where it is about none
    about: str
    #: When it holds. A kind of fact: during that kind's interval of the same bodies and the same
    #: first frame
    span: "Span | type[Observed]"
    #: Whether segments of the body that it is about, and of end-effectors that touch this body
    #: meanwhile, may begin or end where the fact begins or ends, so that places are measured there;
    #: a set: only those of these names in ``stretch``
    border: bool | frozenset[str] = False
    #: The name under which rules find the ticks in it (``spans/6``, ``encloses/6``), with fields
    #: in braces. Empty: rules do not join it by ticks
    stretch: str = ""
    #: The fields that name the other bodies of such a join; none: the body itself
    others: tuple[str, ...] = ()
    #: What an interval is taken for that is contradicted as flicker, such as ``apart``; empty
    #: where flicker is not resolved
    negated: str = ""
    #: The power of ten by which an argument becomes SI units in RDF, by its field
    powers: Mapping[str, int] = field(default_factory=dict)

    @property
    def rdf(self) -> tuple[str, ...]:
        """The class in the ontology, then the properties."""
        return tuple(self.terms.split())

    @property
    def sampled(self) -> bool:
        """Whether its facts are samples of a quantity at frames, which RDF keeps as one row."""
        return self.span is Span.INSTANT and not self.border


class Observed(Fact):
    """A fact that an observation rests on; its class is made by ``fact_kind``."""

    __slots__ = ()

    declaration: ClassVar[Declaration]

    def subject(self) -> str:
        """The body that the fact is about; empty where it is about none."""
        about = self.declaration.about
        return str(getattr(self, about)) if about else ""

    def ends(self) -> tuple[int, ...]:
        """The frames that the fact itself states: an instant, or the first and the last frame."""
        return _ends_of(cast(Any, type(self)))(self)

    def other_bodies(self) -> tuple[str, ...]:
        """The other body of each stretch that the fact states; at least the body itself."""
        others = self.declaration.others
        return tuple(str(getattr(self, each)) for each in others) or (self.subject(),)

    def stretch(self) -> str:
        """The name under which rules find the ticks in it; empty where they do not."""
        pattern = self.declaration.stretch
        return _BRACES.sub(lambda found: str(getattr(self, found[1])), pattern)

    def is_border(self) -> bool:
        """Whether a segment may begin or end where it does."""
        border = self.declaration.border
        return border if isinstance(border, bool) else self.stretch() in border

    def name(self, kind: "type[Observed]") -> tuple[object, ...]:
        """The name of an interval of a kind: of this one, or of the one that its span is."""
        return kind, *(getattr(self, each) for each in _naming_fields(cast(Any, kind)))

    def between(self, first: int, last: int) -> Self:
        """The same fact of another interval."""
        return replace(cast(Any, self), first=first, last=last)


_BRACES = re.compile(r"\{(\w+)\}")


@cache
def _ends_of(kind: type[Observed]) -> Callable[[Observed], tuple[int, ...]]:
    """What reads the frames that facts of a kind state; they are read very often."""
    names = kind.declaration.span.value if isinstance(kind.declaration.span, Span) else ("first",)
    if len(names) > 1:
        return attrgetter(*names)
    return lambda fact: tuple(getattr(fact, name) for name in names)


@cache
def _naming_fields(kind: Any) -> tuple[str, ...]:
    """The fields by which other facts name an interval of a kind."""
    return tuple(each for each in _arguments(kind) if each != "last")


_Kind = TypeVar("_Kind", bound=Observed)
_defined: list[type[Observed]] = []


@dataclass_transform(frozen_default=True, order_default=True)
def fact_kind(
    predicate: str, terms: str, span: "Span | type[Observed] | None" = None, **declared: Any
) -> Callable[[type[_Kind]], type[_Kind]]:
    """Make a class a kind of fact: a frozen dataclass with a predicate and a declaration.

    It is about the body that its first field names, if that is a text, and holds when its fields
    ``frame``, or ``first`` and ``last``, state, unless another span is declared.
    ``predicate``: its name in the rules. ``**declared``: other fields of its ``Declaration``.

    Raises:
        FactError: The declaration does not fit the fields.
    """

    def define(cls: type[_Kind]) -> type[_Kind]:
        own = "__annotations__" in vars(cls)  # else it has what its base has
        kind = dataclass(frozen=True, slots=True, init=own, repr=own, eq=own, order=own)(cls)
        has = _arguments(cast(Any, kind))
        first = next(iter(has), "")
        holds = next(each for each in reversed(Span) if set(each.value) <= set(has))
        made = Declaration(terms, first if has.get(first) is str else "", span or holds, **declared)
        names = _naming_fields(cast(Any, made.span)) if isinstance(made.span, type) else ()
        missing = {*names, *made.others, *_BRACES.findall(made.stretch)} - set(has)
        missing |= {each for each in made.powers if has.get(each) is not int}
        if missing:
            raise FactError(f"{cls.__name__} declares the fields {missing}, but has {list(has)}")
        count = 1 + (list(has.values()).count(str) + 1 if made.sampled else len(has))
        if len(made.rdf) != count:
            raise FactError(f"{cls.__name__} declares {made.rdf}: expected {count} terms")
        kind.predicate, kind.declaration = predicate, made
        _defined.append(kind)
        return kind

    return define


@dataclass(frozen=True, slots=True, order=True)
class ObjectInterval(Observed):
    """An object, from the first to the last frame."""

    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class BodyInterval(Observed):
    """A body, from the first to the last frame."""

    body: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class PairInterval(Observed):
    """Two bodies, from the first to the last frame."""

    body: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class OfContact(Observed):
    """The contact of two bodies that begins at the first frame."""

    body: str
    other: str
    first: int


@dataclass(frozen=True, slots=True, order=True)
class BodyPlace(Observed):
    """A place of a body at a frame [mm]."""

    body: str
    frame: int
    x: int
    y: int
    z: int


@fact_kind("frames", "FramesFact firstFrame lastFrame", span=Span.ALWAYS)
class Frames(Observed):
    """The capture's first and last frame."""

    first: int
    last: int


@fact_kind("rate_mhz", "RateFact rateMhz")
class RateMhz(Observed):
    """Frames in a thousand seconds."""

    rate: int


@fact_kind("link", "LinkFact body effectorType side")
class Link(Observed):
    """An end-effector that acts, its general type and its side."""

    ee: str
    kind: str
    side: str


@fact_kind("tag", "TagFact body tagName")
class Tag(Observed):
    """An object or body part watched for contact: self, fixed or mobile."""

    object: str
    type: str


@fact_kind("of_agent", "Belonging body agent")
class OfAgent(Observed):
    """Whose an end-effector or a body part is; stated where several agents perform."""

    body: str
    agent: str


@fact_kind("zero_crossing", "ZeroCrossings body samples")
class ZeroCrossing(Observed):
    """The end-effector's acceleration crosses zero at this frame (thesis 3.2.1)."""

    ee: str
    frame: int


@fact_kind("pause", "Pause body frame", border=True)
class Pause(Observed):
    """A zero crossing at which the end-effector is slow: it starts, stops or turns."""

    ee: str
    frame: int


@fact_kind(
    "touching",
    "Touching body other firstFrame lastFrame",
    border=True,
    others=("other",),
    negated="apart",
)
class Touching(PairInterval):
    """Two bodies touch from the first to the last frame; an end-effector stands first."""


@fact_kind("gap", "Gap body other firstFrame gap", span=Touching, powers={"micrometres": -6})
class Gap(OfContact):
    """How far two bodies are apart when they begin to touch [micrometres]; zero where they cut."""

    micrometres: int


@fact_kind("moving", "Moving body firstFrame lastFrame", border=True, negated="still")
class Moving(ObjectInterval):
    """An object is away from each place where it rests, from the first to the last frame."""


@fact_kind(
    "looking_at",
    "LookingAt body seen firstFrame lastFrame",
    border=True,
    stretch="looks",
    others=("object",),
)
class LookingAt(Observed):
    """The line of sight of a sensor that attends, or of a head that acts, meets it first."""

    sensor: str
    object: str
    first: int
    last: int


@fact_kind("force_transfer", "ForceTransfer")
class ForceTransfer(Observed):
    """The user says that force passes to objects in this trial (thesis 4.4.1)."""


@fact_kind("intended", "Intended rank actionName objectName goalName purpose")
class Intended(Observed):
    """The user's purpose for steps of an action with an object and a goal; "any" fits all."""

    rank: int
    action: str
    object: str
    goal: str
    purpose: str


@fact_kind("solid", "SolidObject body")
class Solid(Observed):
    """Neither surface nor kind leaves a hollow in an object that moves to and fro or is tipped."""

    object: str


@fact_kind("shapeless", "ShapelessObject body")
class Shapeless(Observed):
    """Of the same objects, one whose shape is unknown, so that what is in it is unknown too."""

    object: str


@fact_kind("displaced", "Displacement body firstFrame lastFrame", border=True)
class Displaced(ObjectInterval):
    """An object moves, from when it truly set off until it truly stopped.

    At those ends it was last within 1 mm and half a degree (or the noise) of a place of rest.
    """


@fact_kind(
    "resting", "Resting body firstFrame lastFrame", border=True, stretch="resting", negated="going"
)
class Resting(Observed):
    """An end-effector is at a place where it rests, from the first to the last frame."""

    ee: str
    first: int
    last: int


@fact_kind("place", "Places body samples")
class Place(BodyPlace):
    """Where the middle of a body is at a frame [millimetres]."""


@fact_kind("from_trunk", "TrunkPlaces body samples")
class TrunkPlace(BodyPlace):
    """A place from the agent's trunk [mm], in axes that turn with it about the vertical only."""


@fact_kind("travelled", "Ways body samples")
class Travelled(Observed):
    """Path length [mm] and turn about any axis [mrad] of a body since the capture began."""

    body: str
    frame: int
    way: int
    turn: int


@fact_kind("posture", "Postures body samples")
class Posture(Observed):
    """Angle of a body's upright axis to the vertical, and its turn about that so far [mrad]."""

    body: str
    frame: int
    lean: int
    spin: int


@fact_kind("apart", "Distances body other samples")
class Distance(Observed):
    """How far the middles of two bodies are apart at a frame [millimetres]."""

    body: str
    other: str
    frame: int
    millimetres: int


@fact_kind("wound", "SweptAzimuths body other samples")
class SweptAzimuth(Observed):
    """The angle by which a body has gone about another, seen from above [milliradians]."""

    body: str
    other: str
    frame: int
    milliradians: int


@fact_kind(
    "phase",
    "Phase body phaseKind firstFrame lastFrame",
    border=frozenset({"goes_level"}),
    stretch="goes_{kind}",
)
class Phase(Observed):
    """A part of an object's motion: rising, level or sinking, by its path; turning, or still."""

    object: str
    kind: str
    first: int
    last: int


@fact_kind("guided", "GuidedObject body guideKind other")
class Guided(Observed):
    """An object moves on one hinge or rail of a base throughout the recording.

    Where its closed place is not known it is called a ``pivot`` or a ``track``.
    """

    object: str
    kind: str
    base: str


@fact_kind("belongs_to", "PartOf body other")
class PartOf(Observed):
    """An object is a part of a thing that can be moved, of which the other body is the base."""

    object: str
    base: str


@fact_kind("opening", "Openings body samples")
class Opening(Observed):
    """How far an object on a guide is from its closed place [mm on a rail, mrad on a hinge].

    Where none is known, from one end of its range.
    """

    object: str
    frame: int
    amount: int


@fact_kind("reverses", "Reversal body frame", border=True, stretch="reverses")
class Reverses(Observed):
    """A moving object that rose begins to sink, or one that sank after that to rise again.

    Both are long enough and steep; the frame is in the middle. Guided objects turn back instead.
    """

    object: str
    frame: int


@fact_kind("draws_back", "DrawingBack body frame", border=True, stretch="draws_back")
class DrawsBack(Observed):
    """A moving object turns back on a level path, after a real way and before another one."""

    object: str
    frame: int


@fact_kind("swings", "Swinging body firstFrame lastFrame", border=True, stretch="swings")
class Swings(BodyInterval):
    """A body moves to and fro, again and again, from the first to the last frame."""


@fact_kind(
    "lengthwise", "LengthwiseSwinging body firstFrame lastFrame", border=True, stretch="lengthwise"
)
class Lengthwise(BodyInterval):
    """A long, thin body moves to and fro along its own length, from the first to the last frame."""


@fact_kind("leans", "Leaning body firstFrame lastFrame", border=True, stretch="leans")
class Leans(ObjectInterval):
    """An object's upright axis is far from the vertical, from the first to the last frame."""


@fact_kind("flies", "Flying body firstFrame lastFrame", border=True, stretch="flies")
class Flies(ObjectInterval):
    """An object falls freely, from the first to the last frame."""


@fact_kind("rolls", "Rolling body firstFrame lastFrame", stretch="rolls")
class Rolls(ObjectInterval):
    """An object goes and turns about a level axis without slipping below its middle."""


@fact_kind("travels", "Travelling body firstFrame lastFrame")
class Travels(ObjectInterval):
    """An object covers more way than a floor of motion in a moment, throughout."""


@fact_kind(
    "upward", "ContactNormal body other firstFrame upward", span=Touching, powers={"permille": -3}
)
class ContactNormal(OfContact):
    """How far a contact's normal points up, at its first frame [1/1000]: 1000 if it lies on it."""

    permille: int


@fact_kind(
    "presses",
    "PressDirection body other firstFrame pressX pressY",
    span=Touching,
    powers={"x": -3, "y": -3},
)
class PressDirection(OfContact):
    """Level x and y of the unit normal from an end-effector to what it presses [1/1000]."""

    x: int
    y: int


@fact_kind(
    "sighted", "SightNormal body other firstFrame sightward", span=Touching, powers={"permille": -3}
)
class SightNormal(OfContact):
    """How far a contact's normal points where the touched head looks [1/1000]: -1000 behind."""

    permille: int


@fact_kind("rides", "Riding body other firstFrame", span=Touching)
class Rides(OfContact):
    """A body is borne by another one, in or on it, and goes along when that one moves."""


@fact_kind(
    "closing",
    "ClosingSpeed body other firstFrame contactSpeed",
    span=Touching,
    powers={"speed": -3},
)
class ClosingSpeed(OfContact):
    """How fast two bodies approached each other when they began to touch [mm/s]."""

    speed: int


@fact_kind(
    "released",
    "ReleaseSpeed body other firstFrame contactSpeed",
    span=Touching,
    powers={"speed": -3},
)
class ReleaseSpeed(OfContact):
    """How fast an object goes when an end-effector's contact with it ends [mm/s]."""

    speed: int


@fact_kind("seated", "Seat body other firstFrame lastFrame", border=True)
class Seated(PairInterval):
    """A body is down on another one that bears it: in a contact, less its coming and going."""


@fact_kind(
    "bears",
    "WeightBearing body weightShare firstFrame lastFrame",
    border=frozenset({"bears_whole", "bears_none"}),
    stretch="bears_{share}",
)
class Bears(Observed):
    """A foot that is down bears the whole weight of the body, part of it, or none."""

    foot: str
    share: str
    first: int
    last: int


@fact_kind(
    "lies",
    "Arrangement body arrangement other firstFrame lastFrame",
    stretch="{how}",
    others=("other",),
)
class Lies(Observed):
    """How a body lies to another: inside, dipped into, above, below, beside, along or near it.

    An end-effector that touches it ``shifts`` from one place on it to another.
    """

    body: str
    how: str
    other: str
    first: int
    last: int


@fact_kind(
    "between",
    "PlaceBetween body one other firstFrame lastFrame",
    stretch="between",
    others=("one", "other"),
)
class Between(Observed):
    """A body's middle is between two others, from the first to the last frame."""

    body: str
    one: str
    other: str
    first: int
    last: int


@fact_kind(
    "passage",
    "Passage body arrangement other firstFrame sides",
    span=Lies,
    stretch="{how}_{sides}",
    others=("other",),
)
class Passage(Observed):
    """A body leaves the inside or the space above another at an opposite or merely another side."""

    body: str
    how: str
    other: str
    first: int
    sides: str


@fact_kind("moves_with", "CoMotion body other firstFrame lastFrame gap", powers={"gap": -3})
class MovesWith(Observed):
    """A travelling object is steady in another body's frame, so far from touching it [mm]."""

    object: str
    body: str
    first: int
    last: int
    gap: int


#: Every kind of fact that extractors state, in the order in which they are written
MEASURED: tuple[type[Observed], ...] = tuple(_defined)


@fact_kind("doubted", "FlickerCorrection body other firstFrame lastFrame takenFor")
class FlickerCorrection(PairInterval):
    """A measured interval that the rules take for the contrary: it is a flicker.

    Taken for ``touching`` or ``apart``; of one body, which stands twice, for ``moving`` or
    ``still``, or ``resting`` or ``going``.
    """

    taken: str


@fact_kind("moved_by", "MovedBy body mover how firstFrame lastFrame")
class MovedBy(Observed):
    """What moves an object through a part of its motion, as the rules of movers derive.

    How is ``carried``, ``along``, ``pushed`` (or pulled, or struck), ``through``, ``set_going`` or
    ``body``; or ``unknown``, with ``beyond_reach``, ``left_behind`` or ``nobody`` for the mover.
    """

    object: str
    mover: str
    how: str
    first: int
    last: int


#: Every kind of fact that an observation rests on: measured, corrected, and what moves what
ALL_FACT_KINDS: tuple[type[Observed], ...] = tuple(_defined)


def read_fact(text: str) -> Observed:
    """The measured fact that an atom states, such as ``touching(right_hand,mug,118,335)``.

    Raises:
        FactError: No atom, or of no predicate that extractors state.
    """
    try:
        symbol = clingo.parse_term(text, logger=lambda code, message: None)
    except (RuntimeError, TypeError, AttributeError):
        raise FactError(f"expected an atom such as tag(mug,mobile), found {text!r}") from None
    if symbol.type is clingo.SymbolType.Function and symbol.positive:
        for kind in ALL_FACT_KINDS:
            if kind.predicate == symbol.name:
                return kind.from_symbol(symbol)
    known = ", ".join(each.predicate for each in ALL_FACT_KINDS)
    raise FactError(f"{text!r} is no measured fact; their predicates are {known}")


#: First and last frame
Interval = tuple[int, int]
#: The kinds of intervals that other facts name by their first frames
_NAMED = {kind.declaration.span for kind in ALL_FACT_KINDS} - set(Span)


class FactIntervals:
    """The intervals of the facts of one capture."""

    def __init__(self, facts: Iterable[Fact]) -> None:
        """Index the intervals that other facts name."""
        self._named: dict[tuple[object, ...], Interval] = {
            fact.name(type(fact)): (fact.ends()[0], fact.ends()[-1])
            for fact in facts
            if isinstance(fact, Observed) and type(fact) in _NAMED
        }

    def of(self, fact: Fact) -> Interval | None:
        """When a fact holds; None: always, or throughout an interval that no fact states."""
        if not isinstance(fact, Observed) or fact.declaration.span is Span.ALWAYS:
            return None
        if isinstance(fact.declaration.span, Span):
            return fact.ends()[0], fact.ends()[-1]
        return self._named.get(fact.name(fact.declaration.span))
