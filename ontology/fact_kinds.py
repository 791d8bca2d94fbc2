"""The terms of the kinds of measured facts; written by ``make docs`` from ``capar/model``."""

from pyoxigraph import NamedNode

from ontology.closed import Closed


class FactKinds(metaclass=Closed):
    """A term for each kind of fact."""

    FramesFact: NamedNode
    RateFact: NamedNode
    LinkFact: NamedNode
    TagFact: NamedNode
    Belonging: NamedNode
    ZeroCrossings: NamedNode
    Pause: NamedNode
    Touching: NamedNode
    Gap: NamedNode
    Moving: NamedNode
    LookingAt: NamedNode
    ForceTransfer: NamedNode
    Intended: NamedNode
    SolidObject: NamedNode
    ShapelessObject: NamedNode
    Displacement: NamedNode
    Resting: NamedNode
    Places: NamedNode
    TrunkPlaces: NamedNode
    Ways: NamedNode
    Postures: NamedNode
    Distances: NamedNode
    SweptAzimuths: NamedNode
    Phase: NamedNode
    GuidedObject: NamedNode
    Openings: NamedNode
    Reversal: NamedNode
    DrawingBack: NamedNode
    Swinging: NamedNode
    LengthwiseSwinging: NamedNode
    Leaning: NamedNode
    Flying: NamedNode
    Rolling: NamedNode
    Travelling: NamedNode
    ContactNormal: NamedNode
    PressDirection: NamedNode
    SightNormal: NamedNode
    Riding: NamedNode
    ClosingSpeed: NamedNode
    ReleaseSpeed: NamedNode
    Seat: NamedNode
    WeightBearing: NamedNode
    Arrangement: NamedNode
    PlaceBetween: NamedNode
    Passage: NamedNode
    CoMotion: NamedNode
    FlickerCorrection: NamedNode
    MovedBy: NamedNode
