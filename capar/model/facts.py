"""Ground facts: what extractors measured, in the order in which they are written."""

from dataclasses import dataclass

import clingo

from capar.model.atoms import LARGEST as LARGEST
from capar.model.atoms import Fact as Fact
from capar.model.atoms import program as program
from capar.model.errors import FactError
from capar.model.handling import Apart as Apart
from capar.model.handling import Bears as Bears
from capar.model.handling import Between as Between
from capar.model.handling import Closing as Closing
from capar.model.handling import Displaced as Displaced
from capar.model.handling import Flies as Flies
from capar.model.handling import Leans as Leans
from capar.model.handling import Lies as Lies
from capar.model.handling import Passage as Passage
from capar.model.handling import Place as Place
from capar.model.handling import Posture as Posture
from capar.model.handling import Resting as Resting
from capar.model.handling import Reverses as Reverses
from capar.model.handling import Rolls as Rolls
from capar.model.handling import Swings as Swings
from capar.model.handling import Travelled as Travelled
from capar.model.handling import Upward as Upward
from capar.model.handling import Wound as Wound


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
class OfAgent(Fact):
    """Whose an end-effector or a body part is; stated where several agents perform."""

    predicate = "of_agent"
    body: str
    agent: str


@dataclass(frozen=True, slots=True, order=True)
class ZeroCrossing(Fact):
    """The end-effector's acceleration crosses zero at this frame (thesis 3.2.1)."""

    predicate = "zero_crossing"
    ee: str
    frame: int


@dataclass(frozen=True, slots=True, order=True)
class Pause(Fact):
    """A zero crossing at which the end-effector is slow: it starts, stops or turns."""

    predicate = "pause"
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
    """How far two bodies are apart when they begin to touch [micrometres]; zero where they cut."""

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
    """The line of sight of a sensor that attends, or of a head that acts, meets it first."""

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


@dataclass(frozen=True, slots=True, order=True)
class Doubted(Fact):
    """A stretch that the rules do not take as it was measured: it is a flicker.

    It is taken for contact, ``touching``, or for none, ``apart``. Of one body, which stands twice,
    it is taken for an object's motion, ``moving``, or for none, ``still``; for an end-effector's
    rest, ``resting``, or for none, ``going``.
    """

    predicate = "doubted"
    body: str
    other: str
    first: int
    last: int
    taken: str


MEASURED: tuple[type[Fact], ...] = (
    Frames,
    RateMhz,
    Link,
    Tag,
    OfAgent,
    ZeroCrossing,
    Pause,
    Touching,
    Gap,
    Moving,
    LookingAt,
    ForceTransfer,
    Intended,
    Displaced,
    Resting,
    Place,
    Travelled,
    Posture,
    Apart,
    Wound,
    Upward,
    Closing,
    Reverses,
    Swings,
    Leans,
    Flies,
    Rolls,
    Bears,
    Lies,
    Between,
    Passage,
)
"""Every kind of fact that extractors state, in the order in which they are written."""

STATED: tuple[type[Fact], ...] = (*MEASURED, Doubted)
"""Every kind of fact that an observation rests on: what was measured, and what was doubted."""


def read_fact(text: str) -> Fact:
    """The measured fact that an atom states, such as ``touching(right_hand,mug,118,335)``.

    Raises:
        FactError: No atom, or of no predicate that extractors state.
    """
    try:
        symbol = clingo.parse_term(text, logger=lambda code, message: None)
    except (RuntimeError, TypeError, AttributeError):
        raise FactError(f"expected an atom such as tag(mug,mobile), found {text!r}") from None
    if symbol.type is clingo.SymbolType.Function and symbol.positive:
        for kind in STATED:
            if kind.predicate == symbol.name:
                return kind.from_symbol(symbol)
    known = ", ".join(each.predicate for each in STATED)
    raise FactError(f"{text!r} is no measured fact; their predicates are {known}")
