"""Stored actions: listed, recognised, and read back as PARs."""

from collections import Counter
from dataclasses import dataclass

from pyoxigraph import Literal, NamedNode

from capar.model.errors import UnknownNameError
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
from kb.encode.pars import COMMON, MOTIONS, complex_node, is_known
from kb.store import names
from kb.store.sparql import stored
from kb.store.statements import StatementIndex, numbers
from kb.store.stores import Store
from ontology import CAPAR
from ontology.namespace import ALLEN


@dataclass(frozen=True, slots=True, order=True)
class Stored:
    """An observation that the Actionary holds."""

    name: str
    """The capture's name, by which it is forgotten or replaced."""

    action: str
    """What its complex action is called."""

    agent: str
    profile: str
    version: str
    rules: str
    duration_s: float


def observations(store: Store) -> tuple[Stored, ...]:
    """Every observation, by name."""
    rows = store.ask(stored("observations")).texts()
    return tuple(Stored(a, b, c, d, e, f, float(duration)) for a, b, c, d, e, f, duration in rows)


def observations_of(store: Store, name: str) -> tuple[Stored, ...]:
    """The observation of a name, else those of the complex action of that name.

    Raises:
        UnknownNameError: There is none.
    """
    seen = observations(store)
    found = tuple(e for e in seen if e.name == name) or tuple(e for e in seen if e.action == name)
    if not found:
        known = {each.name for each in seen} | {each.action for each in seen}
        raise UnknownNameError("complex action", name, known, where=store.place)
    return found


def unknown_observation(store: Store, name: str) -> UnknownNameError:
    """The error for an observation that is not stored."""
    known = [each.name for each in observations(store)]
    return UnknownNameError("observation", name, known, where=store.place)


class Pars:
    """Actions in a store."""

    store: Store

    def observations(self) -> tuple[Stored, ...]:
        """Every observation, by name."""
        return observations(self.store)

    def recognise(self, value: ComplexPar, *, besides: NamedNode | None = None) -> str | None:
        """The name that most observations give a complex action; of equals, the first by alphabet.

        Args:
            value: The complex action, whoever performed it.
            besides: An observation that does not count.
        """
        if not is_known(value):
            return None
        found = self.store.ask(
            f"SELECT ?seen ?name {{ ?seen {CAPAR.enacts} {complex_node(value)} ; "
            f"{CAPAR.name} ?name }}"
        )
        given = Counter(
            name.value for seen, name in found.rows if isinstance(name, Literal) and seen != besides
        )
        return min(given, key=lambda name: (-given[name], name)) if given else None

    def complex_par(self, name: str) -> ComplexPar:
        """A complex action as it was observed: by the observation's name, or by its own.

        Raises:
            UnknownNameError: There is none.
        """
        of, node = self._read(observations_of(self.store, name)[0].name)
        links: dict[str, list[NamedNode]] = {}
        place = {}
        for step in of.ordered(node, CAPAR.step, by=CAPAR.index):
            place[step] = of.text(step, CAPAR.ee), of.count(step, CAPAR.index)
            links.setdefault(place[step][0], []).append(step)
        common = links.pop(COMMON, [])
        return ComplexPar(
            name=of.text(node, CAPAR.name),
            objects=of.words(node, CAPAR.objects),
            duration_s=of.number(node, CAPAR.duration),
            links=tuple(
                LinkSteps(ee, tuple(_step(of, each) for each in links.get(ee, [])))
                for ee in of.words(node, CAPAR.effectors)
            ),
            common=_step(of, common[0]) if common else None,
            relations=tuple(
                sorted(
                    Relation(place[each], relation, place[other])
                    for each in place
                    for relation, iri in ALLEN.items()
                    for other in of.all(each, NamedNode(iri))
                )
            ),
        )

    def upars(self, name: str | None = None) -> tuple[Upar, ...]:
        """Uninstantiated actions of a name, or all of them, by name and number of objects.

        Their parents stand with their instances.
        """
        of = StatementIndex(self.store.graph(names.GRAPHS["actions"]))
        found = [
            Upar(
                name=of.text(node, CAPAR.name),
                agent=of.text(node, CAPAR.agentParameter),
                objects=of.words(node, CAPAR.parameters),
                general=of.words(node, CAPAR.general),
                applicability=_conditions(of, node, CAPAR.applicability),
                preparation=_preparation(of, node),
                steps=tuple(
                    _call(of, e) for e in of.ordered(node, CAPAR.executionStep, by=CAPAR.index)
                ),
                core=_core(of, node),
                post_assertions=_conditions(of, node, CAPAR.postAssertion),
            )
            for node in of.things(CAPAR.Upar)
            if name in {None, of.text(node, CAPAR.name)}
        ]
        return tuple(sorted(found, key=lambda each: (each.name, len(each.objects), repr(each))))

    def ipars(self, observation: str) -> tuple[Ipar, ...]:
        """The instantiated actions of an observation, links in order.

        Raises:
            UnknownNameError: There is no such observation.
        """
        of, whole = self._read(observation)
        order = of.words(whole, CAPAR.effectors)
        found = []
        for node in of.things(CAPAR.Ipar):
            agent = of.one(node, CAPAR.agent)
            found.append(
                Ipar(
                    upar=of.text(node, CAPAR.name),
                    agent=names.last_word(agent).partition(".")[0] if agent else "",
                    ee=of.text(node, CAPAR.ee),
                    objects=of.words(node, CAPAR.objects),
                    start_s=of.number(node, CAPAR.start),
                    core=_core(of, node),
                    preparation=_preparation(of, node),
                    post_assertions=_conditions(of, node, CAPAR.postAssertion),
                    posture=of.text(node, CAPAR.posture),
                    parent=of.text(node, CAPAR.parentName),
                )
            )
        return tuple(sorted(found, key=lambda each: (order.index(each.ee), each.start_s)))

    def _read(self, name: str) -> tuple[StatementIndex, NamedNode]:
        """Everything that an observation says or mentions, and the observation."""
        node = names.observation(name)
        own = self.store.graph(node)
        if not own:
            raise unknown_observation(self.store, name)
        mentioned = self.store.ask(
            f"CONSTRUCT {{ ?s ?p ?o }} WHERE {{ {node} {CAPAR.mentions} ?s . "
            f"GRAPH {names.GRAPHS['actions']} {{ ?s ?p ?o }} }}"
        )
        return StatementIndex([*own, *(mentioned.triples or ())]), node


# Statements read back

_MOTION_OF = {node: motion for motion, node in MOTIONS.items()}


def _condition(of: StatementIndex, node: NamedNode) -> Condition:
    holds = of.value(node, CAPAR.holds) is not False
    return Condition(of.text(node, CAPAR.conditionKind), of.words(node, CAPAR.parameters), holds)


def _conditions(of: StatementIndex, node: NamedNode, predicate: NamedNode) -> tuple[Condition, ...]:
    return tuple(sorted(_condition(of, each) for each in of.all(node, predicate)))


def _preparation(of: StatementIndex, node: NamedNode) -> tuple[Preparation, ...]:
    return tuple(
        Preparation(_condition(of, needed), _call(of, remedy))
        for each in of.ordered(node, CAPAR.preparation, by=CAPAR.index)
        if (needed := of.one(each, CAPAR.condition)) and (remedy := of.one(each, CAPAR.remedy))
    )


def _call(of: StatementIndex, node: NamedNode) -> Call:
    words = of.words(node, CAPAR.parameters)
    return Call(of.text(node, CAPAR.name), words, of.text(node, CAPAR.purpose))


def _core(of: StatementIndex, owner: NamedNode) -> CoreSemantics:
    node = of.one(owner, CAPAR.core) or owner
    constraint = of.one(node, CAPAR.constraint) or node
    bits = of.one(constraint, CAPAR.features) or constraint
    ends = numbers(of.text(node, CAPAR.pathEnds))
    duration = of.value(node, CAPAR.duration)
    return CoreSemantics(
        motion=_MOTION_OF[of.one(node, CAPAR.motion) or CAPAR.NoMotion],
        moved=of.text(node, CAPAR.moved),
        causal=of.value(node, CAPAR.causal) is True,
        force=of.words(node, CAPAR.forceOn),
        path=tuple((ends[i], ends[i + 1], ends[i + 2]) for i in range(0, len(ends), 3)),
        purpose=of.text(node, CAPAR.purpose),
        enables=tuple(names.last_word(each) for each in of.all(node, CAPAR.enables)),
        termination=_conditions(of, node, CAPAR.termination),
        duration_s=None if duration is None else float(duration),
        manner=of.text(node, CAPAR.manner),
        constraint=Constraint(
            FeatureSet(
                of.text(bits, CAPAR.relStart),
                of.text(bits, CAPAR.relEnd),
                of.text(bits, CAPAR.changeLoc),
                of.text(bits, CAPAR.effectorType),
                of.text(bits, CAPAR.forceApplied),
            ),
            (
                of.count(constraint, CAPAR.collidingFirst),
                of.count(constraint, CAPAR.collidingSecond),
            ),
        ),
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
