"""Ground facts: what extractors measured, in the order in which they are written."""

from dataclasses import dataclass

import clingo

from capar.model import arrangement_facts, contact_facts, motion_facts, phase_facts, scene_facts
from capar.model.arrangement_facts import Bears as Bears
from capar.model.arrangement_facts import Between as Between
from capar.model.arrangement_facts import Lies as Lies
from capar.model.arrangement_facts import MovesWith as MovesWith
from capar.model.arrangement_facts import Passage as Passage
from capar.model.contact_facts import ClosingSpeed as ClosingSpeed
from capar.model.contact_facts import ContactNormal as ContactNormal
from capar.model.contact_facts import PressDirection as PressDirection
from capar.model.contact_facts import ReleaseSpeed as ReleaseSpeed
from capar.model.contact_facts import Rides as Rides
from capar.model.contact_facts import Seated as Seated
from capar.model.contact_facts import SightNormal as SightNormal
from capar.model.errors import FactError
from capar.model.fact_kinds import LARGEST as LARGEST
from capar.model.fact_kinds import Declaration, Span, kinds_of
from capar.model.fact_kinds import Fact as Fact
from capar.model.fact_kinds import Observed as Observed
from capar.model.fact_kinds import program as program
from capar.model.motion_facts import Displaced as Displaced
from capar.model.motion_facts import Distance as Distance
from capar.model.motion_facts import Place as Place
from capar.model.motion_facts import Posture as Posture
from capar.model.motion_facts import Resting as Resting
from capar.model.motion_facts import SweptAzimuth as SweptAzimuth
from capar.model.motion_facts import Travelled as Travelled
from capar.model.motion_facts import TrunkPlace as TrunkPlace
from capar.model.phase_facts import DrawsBack as DrawsBack
from capar.model.phase_facts import Flies as Flies
from capar.model.phase_facts import Guided as Guided
from capar.model.phase_facts import Leans as Leans
from capar.model.phase_facts import Lengthwise as Lengthwise
from capar.model.phase_facts import Opening as Opening
from capar.model.phase_facts import Phase as Phase
from capar.model.phase_facts import Reverses as Reverses
from capar.model.phase_facts import Rolls as Rolls
from capar.model.phase_facts import Swings as Swings
from capar.model.phase_facts import Travels as Travels
from capar.model.scene_facts import ForceTransfer as ForceTransfer
from capar.model.scene_facts import Frames as Frames
from capar.model.scene_facts import Gap as Gap
from capar.model.scene_facts import Intended as Intended
from capar.model.scene_facts import Link as Link
from capar.model.scene_facts import LookingAt as LookingAt
from capar.model.scene_facts import Moving as Moving
from capar.model.scene_facts import OfAgent as OfAgent
from capar.model.scene_facts import Pause as Pause
from capar.model.scene_facts import RateMhz as RateMhz
from capar.model.scene_facts import Shapeless as Shapeless
from capar.model.scene_facts import Solid as Solid
from capar.model.scene_facts import Tag as Tag
from capar.model.scene_facts import Touching as Touching
from capar.model.scene_facts import ZeroCrossing as ZeroCrossing


@dataclass(frozen=True, slots=True, order=True)
class FlickerCorrection(Observed):
    """A stretch that the rules do not take as it was measured: it is a flicker.

    It is taken for contact, ``touching``, or for none, ``apart``. Of one body, which stands twice,
    it is taken for an object's motion, ``moving``, or for none, ``still``; for an end-effector's
    rest, ``resting``, or for none, ``going``.
    """

    predicate = "doubted"
    declaration = Declaration(
        about="body",
        span=Span.INTERVAL,
        border=False,
        has_sentence=True,
        rdf=("FlickerCorrection", "body", "other", "firstFrame", "lastFrame", "takenFor"),
    )
    body: str
    other: str
    first: int
    last: int
    taken: str


@dataclass(frozen=True, slots=True, order=True)
class MovedBy(Observed):
    """What moves an object through a part of its motion, as the rules of movers tell.

    How is ``carried``, ``along``, ``pushed`` (or pulled, or struck), ``through``, ``set_going`` or
    ``body``; or ``unknown``, with ``beyond_reach``, ``left_behind`` or ``nobody`` for the mover.
    """

    predicate = "moved_by"
    declaration = Declaration(
        about="object",
        span=Span.INTERVAL,
        border=False,
        has_sentence=False,
        rdf=("MovedBy", "body", "mover", "how", "firstFrame", "lastFrame"),
    )
    object: str
    mover: str
    how: str
    first: int
    last: int


MEASURED: tuple[type[Observed], ...] = (
    *kinds_of(scene_facts),
    *kinds_of(motion_facts),
    *kinds_of(phase_facts),
    *kinds_of(contact_facts),
    *kinds_of(arrangement_facts),
)
"""Every kind of fact that extractors state, in the order in which they are written."""

ALL_FACT_KINDS: tuple[type[Observed], ...] = (*MEASURED, FlickerCorrection, MovedBy)
"""Every kind of fact that an observation rests on: measured, corrected, and what moves what."""


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
