"""The words of the knowledge base as a closed namespace: a misspelt term is an error."""

# ruff: noqa: N815  (the terms of an ontology are in mixed case)

from typing import Any

from pyoxigraph import NamedNode

from capar.model.errors import UnknownNameError

BASE = "https://w3id.org/capar/ontology#"
"""The namespace of every term of ours."""

DATA = "https://w3id.org/capar/data/"
"""The namespace of what is stored: observations, agents, kinds, actions."""


class Closed(type):
    """A class whose annotated names are the terms of a namespace, and nothing else is."""

    def __getattr__(cls, name: str) -> Any:
        """The term of that name.

        Raises:
            UnknownNameError: The ontology has no such term.
        """
        if name.startswith("__"):
            raise AttributeError(name)
        if name not in cls.__annotations__:
            raise UnknownNameError("term of the ontology", name, cls.__annotations__)
        term = NamedNode(BASE + name)
        setattr(cls, name, term)
        return term


class CAPAR(metaclass=Closed):
    """Every term of the ontology's files, file by file."""

    # agents.ttl
    Agent: NamedNode
    Performer: NamedNode
    Measure: NamedNode
    Capability: NamedNode
    ValueRange: NamedNode
    Distribution: NamedNode
    Normal: NamedNode
    Poisson: NamedNode
    Uniform: NamedNode
    Link: NamedNode
    performer: NamedNode
    agent: NamedNode
    capability: NamedNode
    nominal: NamedNode
    parameter: NamedNode
    mean: NamedNode
    standardDeviation: NamedNode
    distribution: NamedNode
    measure: NamedNode
    value: NamedNode
    link: NamedNode
    ee: NamedNode
    effectorType: NamedNode
    side: NamedNode
    # objects.ttl
    PhysicalObject: NamedNode
    TagObject: NamedNode
    ObjectKind: NamedNode
    Tag: NamedNode
    Self: NamedNode
    Fixed: NamedNode
    Mobile: NamedNode
    object: NamedNode
    dominant: NamedNode
    subordinate: NamedNode
    kind: NamedNode
    isA: NamedNode
    broaderKind: NamedNode
    tag: NamedNode
    size: NamedNode
    shape: NamedNode
    assumedFrom: NamedNode
    affords: NamedNode
    declared: NamedNode
    # sites.ttl
    Site: NamedNode
    StateSpace: NamedNode
    RelativeDirection: NamedNode
    SpecialDirection: NamedNode
    coordinateSystem: NamedNode
    graspSite: NamedNode
    state: NamedNode
    relativeDirection: NamedNode
    specialDirection: NamedNode
    position: NamedNode
    orientation: NamedNode
    velocity: NamedNode
    acceleration: NamedNode
    forceVector: NamedNode
    torque: NamedNode
    dampingForce: NamedNode
    restitution: NamedNode
    direction: NamedNode
    vector: NamedNode
    nlt: NamedNode
    path: NamedNode
    # actions.ttl
    Action: NamedNode
    Par: NamedNode
    Upar: NamedNode
    Ipar: NamedNode
    Condition: NamedNode
    Call: NamedNode
    Preparation: NamedNode
    CoreSemantics: NamedNode
    Motion: NamedNode
    NoMotion: NamedNode
    Translation: NamedNode
    Rotation: NamedNode
    TranslationAndRotation: NamedNode
    name: NamedNode
    ofAction: NamedNode
    instanceOf: NamedNode
    specialises: NamedNode
    parameters: NamedNode
    agentParameter: NamedNode
    general: NamedNode
    arity: NamedNode
    applicability: NamedNode
    preparation: NamedNode
    condition: NamedNode
    remedy: NamedNode
    executionStep: NamedNode
    core: NamedNode
    motion: NamedNode
    moved: NamedNode
    causal: NamedNode
    forceOn: NamedNode
    pathEnds: NamedNode
    purpose: NamedNode
    enables: NamedNode
    termination: NamedNode
    duration: NamedNode
    manner: NamedNode
    postAssertion: NamedNode
    parentName: NamedNode
    posture: NamedNode
    start: NamedNode
    conditionKind: NamedNode
    holds: NamedNode
    index: NamedNode
    # complex.ttl
    ComplexPar: NamedNode
    ComplexStep: NamedNode
    Step: NamedNode
    complexStep: NamedNode
    enacts: NamedNode
    step: NamedNode
    realises: NamedNode
    effectors: NamedNode
    segmentNumbers: NamedNode
    share: NamedNode
    begin: NamedNode
    standsFor: NamedNode
    nextStep: NamedNode
    objectNumbers: NamedNode
    # constraints.ttl
    Constraint: NamedNode
    ConstraintLocation: NamedNode
    constraint: NamedNode
    collidingFirst: NamedNode
    collidingSecond: NamedNode
    location: NamedNode
    ofSegment: NamedNode
    goal: NamedNode
    seen: NamedNode
    dominantKind: NamedNode
    goalKind: NamedNode
    seenKind: NamedNode
    eeNlt: NamedNode
    goalNlt: NamedNode
    vNlt: NamedNode
    # styles.ttl
    AgentStyle: NamedNode
    style: NamedNode
    velStyle: NamedNode
    pathStyle: NamedNode
    # features.ttl
    FeatureSet: NamedNode
    FeatureRow: NamedNode
    features: NamedNode
    relStart: NamedNode
    relEnd: NamedNode
    changeLoc: NamedNode
    forceApplied: NamedNode
    objectCount: NamedNode
    # events.ttl
    Segment: NamedNode
    UnknownSegment: NamedNode
    Border: NamedNode
    Fact: NamedNode
    FramesFact: NamedNode
    RateFact: NamedNode
    LinkFact: NamedNode
    TagFact: NamedNode
    ZeroCrossing: NamedNode
    Touching: NamedNode
    Gap: NamedNode
    Moving: NamedNode
    LookingAt: NamedNode
    ForceTransfer: NamedNode
    Intended: NamedNode
    segment: NamedNode
    fact: NamedNode
    ofLink: NamedNode
    action: NamedNode
    candidate: NamedNode
    failedAt: NamedNode
    possesses: NamedNode
    beginsWith: NamedNode
    endsWith: NamedNode
    borderKind: NamedNode
    body: NamedNode
    other: NamedNode
    objects: NamedNode
    next: NamedNode
    frame: NamedNode
    firstFrame: NamedNode
    lastFrame: NamedNode
    end: NamedNode
    micrometres: NamedNode
    rateMhz: NamedNode
    sensor: NamedNode
    objectName: NamedNode
    actionName: NamedNode
    goalName: NamedNode
    tagName: NamedNode
    rank: NamedNode
    # provenance.ttl
    Observation: NamedNode
    Capture: NamedNode
    SourceFile: NamedNode
    RuleBase: NamedNode
    Notice: NamedNode
    capture: NamedNode
    ruleBase: NamedNode
    notice: NamedNode
    noticeCode: NamedNode
    message: NamedNode
    profile: NamedNode
    version: NamedNode
    identity: NamedNode
    frames: NamedNode
    rate: NamedNode
    filePath: NamedNode
    fileFormat: NamedNode
    sha256: NamedNode
    mentions: NamedNode
    # functions.ttl
    SparqlFunction: NamedNode
    element: NamedNode
    elements: NamedNode
    # lexicon.ttl
    LevinClass: NamedNode
    VerbNetClass: NamedNode
    ClassMember: NamedNode
    ThematicRole: NamedNode
    VerbFrame: NamedNode
    SemanticPredicate: NamedNode
    LexicalLink: NamedNode
    CapabilityClaim: NamedNode
    LexicalRemark: NamedNode
    linkedAction: NamedNode
    linkedSense: NamedNode
    levinClass: NamedNode
    classMember: NamedNode
    memberVerb: NamedNode
    memberSense: NamedNode
    thematicRole: NamedNode
    verbFrame: NamedNode
    semanticPredicate: NamedNode
    lemma: NamedNode
    senseKey: NamedNode
    senseNumber: NamedNode
    oldSenseNumber: NamedNode
    synsetOffset: NamedNode
    lexicographerFile: NamedNode
    genericSentence: NamedNode
    classSize: NamedNode
    claimedBy: NamedNode
    claimedStatus: NamedNode
    printedClass: NamedNode
    claimedVerb: NamedNode
    reason: NamedNode
    section: NamedNode
    quote: NamedNode
    restriction: NamedNode
    pattern: NamedNode
    example: NamedNode
    syntax: NamedNode
    predicateName: NamedNode
    arguments: NamedNode


def terms() -> tuple[str, ...]:
    """Names of every term, sorted."""
    return tuple(sorted(CAPAR.__annotations__))
