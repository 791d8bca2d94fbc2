"""RDF statements back to PARs: the values that were encoded, conditions in sorted order."""

from pyoxigraph import NamedNode

from capar.model.par import (
    Call,
    ComplexPar,
    Condition,
    Constraint,
    CoreSemantics,
    FeatureSet,
    Ipar,
    LinkSteps,
    Preparation,
    Relation,
    Step,
    Upar,
)
from kb.encode.complex_pars import COMMON
from kb.encode.pars import MOTIONS
from kb.lookup.statement_index import StatementIndex
from kb.store import names
from kb.store.literals import numbers
from ontology import CAPAR
from ontology.vocabularies import ALLEN

_MOTION_OF = {node: motion for motion, node in MOTIONS.items()}


def condition(of: StatementIndex, node: NamedNode) -> Condition:
    """A condition."""
    holds = of.value(node, CAPAR.holds) is not False
    return Condition(of.text(node, CAPAR.conditionKind), of.words(node, CAPAR.parameters), holds)


def conditions(of: StatementIndex, node: NamedNode, predicate: NamedNode) -> tuple[Condition, ...]:
    """Conditions that are said of a thing, sorted."""
    return tuple(sorted(condition(of, each) for each in of.all(node, predicate)))


def features(of: StatementIndex, node: NamedNode) -> FeatureSet:
    """A set of features."""
    return FeatureSet(
        of.text(node, CAPAR.relStart),
        of.text(node, CAPAR.relEnd),
        of.text(node, CAPAR.changeLoc),
        of.text(node, CAPAR.effectorType),
        of.text(node, CAPAR.forceApplied),
    )


def upar(of: StatementIndex, node: NamedNode) -> Upar:
    """An uninstantiated action; the parents it was seen in stand with its instances."""
    return Upar(
        name=of.text(node, CAPAR.name),
        agent=of.text(node, CAPAR.agentParameter),
        objects=of.words(node, CAPAR.parameters),
        general=of.words(node, CAPAR.general),
        applicability=conditions(of, node, CAPAR.applicability),
        preparation=_preparation(of, node),
        steps=tuple(
            _call(of, each) for each in of.ordered(node, CAPAR.executionStep, by=CAPAR.index)
        ),
        core=_core(of, node),
        post_assertions=conditions(of, node, CAPAR.postAssertion),
    )


def ipar(of: StatementIndex, node: NamedNode) -> Ipar:
    """An instantiated action."""
    agent = of.one(node, CAPAR.agent)
    return Ipar(
        upar=of.text(node, CAPAR.name),
        agent=names.last_word(agent).partition(".")[0] if agent else "",
        ee=of.text(node, CAPAR.ee),
        objects=of.words(node, CAPAR.objects),
        start_s=of.number(node, CAPAR.start),
        core=_core(of, node),
        preparation=_preparation(of, node),
        post_assertions=conditions(of, node, CAPAR.postAssertion),
        posture=of.text(node, CAPAR.posture),
        parent=of.text(node, CAPAR.parentName),
    )


def _preparation(of: StatementIndex, node: NamedNode) -> tuple[Preparation, ...]:
    found = []
    for preparation in of.ordered(node, CAPAR.preparation, by=CAPAR.index):
        needed, remedy = of.one(preparation, CAPAR.condition), of.one(preparation, CAPAR.remedy)
        if needed and remedy:
            found.append(Preparation(condition(of, needed), _call(of, remedy)))
    return tuple(found)


def _call(of: StatementIndex, node: NamedNode) -> Call:
    words = of.words(node, CAPAR.parameters)
    return Call(of.text(node, CAPAR.name), words, of.text(node, CAPAR.purpose))


def _core(of: StatementIndex, owner: NamedNode) -> CoreSemantics:
    node = of.one(owner, CAPAR.core) or owner
    constraint = of.one(node, CAPAR.constraint) or node
    bits = of.one(constraint, CAPAR.features) or constraint
    motion = of.one(node, CAPAR.motion)
    ends = numbers(of.text(node, CAPAR.pathEnds))
    duration = of.value(node, CAPAR.duration)
    return CoreSemantics(
        motion=_MOTION_OF[motion or CAPAR.NoMotion],
        moved=of.text(node, CAPAR.moved),
        causal=of.value(node, CAPAR.causal) is True,
        force=of.words(node, CAPAR.forceOn),
        path=tuple((ends[i], ends[i + 1], ends[i + 2]) for i in range(0, len(ends), 3)),
        purpose=of.text(node, CAPAR.purpose),
        enables=tuple(names.last_word(each) for each in of.all(node, CAPAR.enables)),
        termination=conditions(of, node, CAPAR.termination),
        duration_s=None if duration is None else float(duration),
        manner=of.text(node, CAPAR.manner),
        constraint=Constraint(
            features(of, bits),
            (
                of.count(constraint, CAPAR.collidingFirst),
                of.count(constraint, CAPAR.collidingSecond),
            ),
        ),
    )


def complex_par(of: StatementIndex, node: NamedNode) -> ComplexPar:
    """The complex action as an observation saw it."""
    links: dict[str, list[NamedNode]] = {}
    for step in of.ordered(node, CAPAR.step, by=CAPAR.index):
        links.setdefault(of.text(step, CAPAR.ee), []).append(step)
    common = links.pop(COMMON, [])
    order = of.words(node, CAPAR.effectors)
    return ComplexPar(
        name=of.text(node, CAPAR.name),
        objects=of.words(node, CAPAR.objects),
        duration_s=of.number(node, CAPAR.duration),
        links=tuple(
            LinkSteps(ee, tuple(_step(of, each) for each in links.get(ee, []))) for ee in order
        ),
        common=_step(of, common[0]) if common else None,
        relations=_relations(of, [each for steps in links.values() for each in steps]),
    )


def _step(of: StatementIndex, node: NamedNode) -> Step:
    return Step(
        action=of.text(node, CAPAR.name),
        ee=of.text(node, CAPAR.ee),
        objects=of.words(node, CAPAR.objects),
        share=of.number(node, CAPAR.share),
        purpose=of.text(node, CAPAR.purpose),
        begin=of.number(node, CAPAR.begin),
        segments=tuple(map(int, of.words(node, CAPAR.segmentNumbers))),
        posture=of.text(node, CAPAR.posture),
    )


def _relations(of: StatementIndex, steps: list[NamedNode]) -> tuple[Relation, ...]:
    found = []
    for node in steps:
        first = of.text(node, CAPAR.ee), of.count(node, CAPAR.index)
        for relation, iri in ALLEN.items():
            for other in of.all(node, NamedNode(iri)):
                second = of.text(other, CAPAR.ee), of.count(other, CAPAR.index)
                found.append(Relation(first, relation, second))
    return tuple(sorted(found))
