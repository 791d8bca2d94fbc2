"""Ground facts: what extractors measured, as typed values that are atoms of the rules."""

from dataclasses import astuple, dataclass, fields
from functools import cache
from typing import Any, ClassVar, Self, cast, get_type_hints

import clingo

from capar.model.capture import NAME
from capar.model.errors import FactError

LARGEST = 2**31 - 1
"""The largest integer of the solver, which wraps silently beyond."""


@dataclass(frozen=True, slots=True, order=True)
class Fact:
    """A relation with arguments; the predicate is a class's, the arguments are an instance's.

    Frames are numbered from zero; intervals are closed, [first, last].
    """

    predicate: ClassVar[str]

    def symbol(self) -> clingo.Symbol:
        """The fact as the solver's own value.

        Raises:
            FactError: An integer that the solver cannot hold.
        """
        return clingo.Function(self.predicate, [_symbol(each) for each in astuple(self)])

    @classmethod
    def from_symbol(cls, symbol: clingo.Symbol) -> Self:
        """The fact that a solver's value states.

        Raises:
            FactError: Another predicate, another number of arguments, or another type.
        """
        kinds: tuple[type, ...] = _kinds(cast(Any, cls))
        if symbol.name != cls.predicate or len(symbol.arguments) != len(kinds):
            raise FactError(f"{symbol} is no {cls.predicate}/{len(kinds)}")
        return cls(
            *(_value(each, kind) for each, kind in zip(symbol.arguments, kinds, strict=True))
        )

    def __str__(self) -> str:
        """The fact as a line of a logic program, without its full stop."""
        return str(self.symbol())


def _symbol(value: Any) -> clingo.Symbol:
    if isinstance(value, int):
        if abs(value) > LARGEST:
            raise FactError(f"{value} does not fit the solver's 32 bits")
        return clingo.Number(value)
    return clingo.Function(value) if NAME.fullmatch(value) else clingo.String(value)


def _value(symbol: clingo.Symbol, kind: type) -> Any:
    if symbol.type is clingo.SymbolType.Number and kind is int:
        return symbol.number
    if symbol.type is clingo.SymbolType.String and kind is str:
        return symbol.string
    if symbol.type is clingo.SymbolType.Function and kind is str and not symbol.arguments:
        return symbol.name
    raise FactError(f"{symbol} is no {kind.__name__}")


@cache
def _kinds(cls: Any) -> tuple[type, ...]:
    hints = get_type_hints(cls)
    return tuple(hints[each.name] for each in fields(cls))


def program(facts: "tuple[Fact, ...]") -> str:
    """The facts as a logic program, one a line, in their order."""
    return "".join(f"{fact}.\n" for fact in facts)


@dataclass(frozen=True, slots=True, order=True)
class Frames(Fact):
    """The capture's first and last frame."""

    predicate = "frames"
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class RateMhz(Fact):
    """Frames in a thousand seconds."""

    predicate = "rate_mhz"
    rate: int


@dataclass(frozen=True, slots=True, order=True)
class Link(Fact):
    """An end-effector that acts, its general type and its side."""

    predicate = "link"
    ee: str
    kind: str
    side: str


@dataclass(frozen=True, slots=True, order=True)
class Tag(Fact):
    """An object or body part watched for contact: self, fixed or mobile."""

    predicate = "tag"
    object: str
    type: str


@dataclass(frozen=True, slots=True, order=True)
class ZeroCrossing(Fact):
    """The end-effector's acceleration crosses zero at this frame (thesis 3.2.1)."""

    predicate = "zero_crossing"
    ee: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Touching(Fact):
    """Two bodies touch from the first to the last frame; an end-effector stands first."""

    predicate = "touching"
    body: str
    other: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class Gap(Fact):
    """How far two bodies are apart when they begin to touch [micrometres]; negative: overlap."""

    predicate = "gap"
    body: str
    other: str
    first: int
    micrometres: int


@dataclass(frozen=True, slots=True, order=True)
class Moving(Fact):
    """An object is away from each place where it rests, from the first to the last frame."""

    predicate = "moving"
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class LookingAt(Fact):
    """The line of sight of a sensor that attends meets the object first."""

    predicate = "looking_at"
    sensor: str
    object: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, order=True)
class ForceTransfer(Fact):
    """The user says that force passes to objects in this trial (thesis 4.4.1)."""

    predicate = "force_transfer"


@dataclass(frozen=True, slots=True, order=True)
class Intended(Fact):
    """The user's purpose for steps of an action with an object and a goal; "any" fits all."""

    predicate = "intended"
    rank: int
    action: str
    object: str
    goal: str
    purpose: str


MEASURED: tuple[type[Fact], ...] = (
    Frames,
    RateMhz,
    Link,
    Tag,
    ZeroCrossing,
    Touching,
    Gap,
    Moving,
    LookingAt,
    ForceTransfer,
    Intended,
)
"""Every kind of fact that extractors state, in the order in which they are written."""


def read_fact(text: str) -> Fact:
    """The measured fact that an atom states, such as ``touching(right_hand,mug,118,335)``.

    Raises:
        FactError: No atom, or of no predicate that extractors state.
    """
    try:
        symbol = clingo.parse_term(text, logger=lambda code, message: None)
    except (RuntimeError, TypeError, AttributeError):
        raise FactError(f"expected an atom such as tag(mug,mobile), found {text!r}") from None
    if symbol.type is clingo.SymbolType.Function:
        for kind in MEASURED:
            if kind.predicate == symbol.name:
                return kind.from_symbol(symbol)
    known = ", ".join(each.predicate for each in MEASURED)
    raise FactError(f"{text!r} is no measured fact; their predicates are {known}")
