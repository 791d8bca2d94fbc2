"""Stored actions found, recognised, and read back as PARs; the feature table (thesis 4.5)."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace

from pyoxigraph import Literal, NamedNode, Quad

from capar.model.errors import ParError, UnknownNameError
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
from kb.encode import shared
from kb.encode.pars import COMMON, MOTIONS, complex_node, is_known
from kb.store import names
from kb.store.answers import plain
from kb.store.sparql import stored
from kb.store.statements import LABEL, PropertyValues, StatementIndex, Statements, numbers
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


def observations(store: Store, filters: str = "") -> tuple[Stored, ...]:
    """Observations, by name; of those, the ones for which some patterns over ``?seen`` hold."""
    rows = store.ask(stored("observations", filters=filters)).texts()
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


class Pars:
    """Actions in a store."""

    store: Store

    def observations(self) -> tuple[Stored, ...]:
        """Every observation, by name."""
        return observations(self.store)

    def recognise(self, value: ComplexPar) -> str | None:
        """The name under which a complex action is known, whoever performed it."""
        return recognise(self.store, value)

    def find_pars(
        self,
        *,
        action: str | None = None,
        objects: Iterable[str] = (),
        performer: str | None = None,
    ) -> tuple[Stored, ...]:
        """Observations of complex actions that fit.

        Args:
            action: Name of the complex action, or of a step of it.
            objects: Kinds or names of objects, all of which take part.
            performer: Name of the agent.
        """
        filters = []
        if performer is not None:
            filters.append(f"?seen {CAPAR.agent}/{CAPAR.name} {Literal(performer)} .")
        if action is not None:
            word = Literal(action)
            filters.append(
                f"FILTER(?action = {word} || EXISTS {{ ?seen {CAPAR.step}/{CAPAR.name} {word} }})"
            )
        for name in objects:
            word = Literal(name)
            filters.append(
                f"FILTER(EXISTS {{ ?seen {CAPAR.object}/{CAPAR.name} {word} }} || "
                f"EXISTS {{ ?seen {CAPAR.object}/{CAPAR.kind}/{CAPAR.isA}/{CAPAR.name} {word} }})"
            )
        return observations(self.store, "\n  ".join(filters))

    def complex_par(self, name: str) -> ComplexPar:
        """A complex action as it was observed: by the observation's name, or by its own.

        Raises:
            UnknownNameError: There is none.
        """
        first = observations_of(self.store, name)[0]
        return _complex_par(*_reading(self.store, first.name))

    def upars(self, name: str | None = None) -> tuple[Upar, ...]:
        """Uninstantiated actions of a name, or all of them, by name and number of objects."""
        reading = StatementIndex(self.store.graph(names.GRAPHS["actions"]))
        found = [_upar(reading, node) for node in reading.things(CAPAR.Upar)]
        fitting = [each for each in found if name in {None, each.name}]
        return tuple(sorted(fitting, key=lambda each: (each.name, len(each.objects), repr(each))))

    def ipars(self, observation: str) -> tuple[Ipar, ...]:
        """The instantiated actions of an observation, links in order.

        Raises:
            UnknownNameError: There is no such observation.
        """
        reading, node = _reading(self.store, observation)
        order = reading.words(node, CAPAR.effectors)

        def place(each: NamedNode) -> tuple[int, float]:
            ee = reading.text(each, CAPAR.ee)
            return order.index(ee), reading.number(each, CAPAR.start)

        found = sorted(reading.things(CAPAR.Ipar), key=place)
        return tuple(_ipar(reading, each) for each in found)

    def effective(self, ipar: Ipar) -> Upar:
        """An action as it is to be done: what the IPAR says overrides its UPAR (thesis 4.1.2).

        Raises:
            UnknownNameError: Its UPAR is not known.
        """
        return effective(self.upars(ipar.upar), ipar)

    def feature_table(self) -> "tuple[FeatureRow, ...]":
        """Known sets of features with their names (thesis 4.5), sorted."""
        return _feature_rows(self.store)

    def feature_program(self) -> str:
        """The feature table as facts of the rules, one a line (``feature_row(...)``)."""
        lines: set[str] = set()
        for row in self.feature_table():
            bits = row.features
            words = (bits.rel_start, bits.rel_end, bits.change_loc, bits.force)
            name = _quoted(row.name)
            cells = ", ".join(map(_quoted, words))
            lines.add(f"primitive({name}).")
            lines.add(f"feature_row({name}, {bits.end_effector}, {cells}).")
            if row.general:
                lines.add(f"specialises({name}, {_quoted(row.general[0])}).")
        return "".join(f"{line}\n" for line in sorted(lines))

    def add_feature_row(
        self, name: str, features: FeatureSet, *, general: Iterable[str] = ()
    ) -> "FeatureRow":
        """Name a set of features; it stays when observations are forgotten.

        Raises:
            ParError: Another name was given to the same set of features.
        """
        for row in self.feature_table():
            if row.features == features and row.declared and row.name != name:
                raise ParError(
                    f"these features are named {row.name!r} already; "
                    "one set of features has one name that a user gave it"
                )
        self.store.insert(_feature_row(name, features, tuple(general)))
        return next(r for r in self.feature_table() if (r.name, r.features) == (name, features))


def recognise(store: Store, value: ComplexPar, *, besides: NamedNode | None = None) -> str | None:
    """The name that most observations give a complex action; of equals, the first by alphabet.

    Args:
        store: Where to look.
        value: The complex action.
        besides: An observation that does not count.
    """
    if not is_known(value):
        return None
    node = complex_node(value)
    found = store.ask(
        f"SELECT ?seen ?name WHERE {{ ?seen {CAPAR.enacts} {node} ; {CAPAR.name} ?name }}"
    )
    given = Counter(
        name.value for seen, name in found.rows if isinstance(name, Literal) and seen != besides
    )
    return min(given, key=lambda name: (-given[name], name)) if given else None


def _reading(store: Store, name: str) -> tuple[StatementIndex, NamedNode]:
    """Everything that an observation says or mentions, and the observation."""
    node = names.observation(name)
    own = store.graph(node)
    if not own:
        known = [each.name for each in observations(store)]
        raise UnknownNameError("observation", name, known, where=store.place)
    mentioned = store.ask(
        f"CONSTRUCT {{ ?s ?p ?o }} WHERE {{ {node} {CAPAR.mentions} ?s . "
        f"GRAPH {names.GRAPHS['actions']} {{ ?s ?p ?o }} }}"
    )
    return StatementIndex([*own, *(mentioned.triples or ())]), node


def effective(known: tuple[Upar, ...], ipar: Ipar) -> Upar:
    """The fitting one of some UPARs, its parameters bound and overridden by what the IPAR says."""
    features = ipar.core.constraint.features
    fitting = [each for each in known if each.core.constraint.features == features] or list(known)
    if not fitting:
        raise UnknownNameError("UPAR", ipar.upar, [])
    upar = fitting[0]
    parameters = (*upar.objects, upar.agent, "EE")
    bound = dict(zip(parameters, (*ipar.objects, ipar.agent, ipar.ee), strict=False))

    def condition(value: Condition) -> Condition:
        return replace(value, arguments=tuple(bound.get(each, each) for each in value.arguments))

    def call(value: Call) -> Call:
        return replace(value, objects=tuple(bound.get(each, each) for each in value.objects))

    def first(field: str) -> object:
        return getattr(ipar.core, field) or getattr(upar.core, field)

    overridden = ("moved", "force", "path", "purpose", "enables", "termination", "manner")
    duration_s = upar.core.duration_s if ipar.core.duration_s is None else ipar.core.duration_s
    core: dict[str, object] = {each: first(each) for each in overridden}
    return replace(
        upar,
        agent=ipar.agent,
        objects=ipar.objects,
        applicability=tuple(map(condition, upar.applicability)),
        preparation=ipar.preparation
        or tuple(Preparation(condition(e.condition), call(e.action)) for e in upar.preparation),
        steps=tuple(map(call, upar.steps)),
        core=replace(ipar.core, duration_s=duration_s, **core),  # type: ignore[arg-type]
        post_assertions=ipar.post_assertions or tuple(map(condition, upar.post_assertions)),
        parent=ipar.parent or upar.parent,
    )


# The feature table


@dataclass(frozen=True, slots=True, order=True)
class FeatureRow:
    """A line of the feature table (thesis 4.5)."""

    name: str
    features: FeatureSet
    general: tuple[str, ...]
    """What the action specialises, nearest first."""

    declared: bool
    """Whether a user named it, rather than an observation showing it."""

    seen: int
    """How many segments have these features and this name."""


def _feature_rows(store: Store) -> tuple[FeatureRow, ...]:
    reading = StatementIndex(store.graph(names.GRAPHS["actions"]))
    declared = {
        (reading.text(node, CAPAR.name), _features(reading, bits)): reading.words(
            node, CAPAR.general
        )
        for node in reading.things(CAPAR.FeatureRow)
        if (bits := reading.one(node, CAPAR.features))
    }
    seen: Counter[tuple[str, FeatureSet]] = Counter()
    general: dict[tuple[str, FeatureSet], tuple[str, ...]] = dict(declared)
    for seen_bits, name, more, times in store.ask(stored("features_seen")).rows:
        if isinstance(seen_bits, NamedNode) and isinstance(name, Literal):
            key = (name.value, _features(reading, seen_bits))
            seen[key] += int(plain(times) or 0)
            general.setdefault(key, tuple(str(plain(more) or "").split()))
    return tuple(
        sorted(FeatureRow(*key, general[key], key in declared, seen[key]) for key in general)
    )


def _feature_row(name: str, value: FeatureSet, general: tuple[str, ...]) -> list[Quad]:
    graph = names.GRAPHS["actions"]
    out = Statements(graph)
    bits, action = shared.features(out, value), shared.action(out, name)
    above = shared.actions(out, general)
    properties: PropertyValues = {
        LABEL: name,
        CAPAR.name: name,
        CAPAR.features: bits,
        CAPAR.action: action,
        CAPAR.general: " ".join(general),
        CAPAR.specialises: above,
    }
    node = out.share(
        names.shared("row", names.hashed((name, value))), (CAPAR.FeatureRow,), properties
    )
    keep = [each for each in (node, bits, action, *above) if each is not None]
    return [
        *(each for each in out.quads if each.predicate != CAPAR.mentions),
        *(Quad(each, CAPAR.declared, Literal(True), graph) for each in keep),
    ]


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


# Statements read back


_MOTION_OF = {node: motion for motion, node in MOTIONS.items()}


def _condition(of: StatementIndex, node: NamedNode) -> Condition:
    """A condition."""
    holds = of.value(node, CAPAR.holds) is not False
    return Condition(of.text(node, CAPAR.conditionKind), of.words(node, CAPAR.parameters), holds)


def _conditions(of: StatementIndex, node: NamedNode, predicate: NamedNode) -> tuple[Condition, ...]:
    """Conditions that are said of a thing, sorted."""
    return tuple(sorted(_condition(of, each) for each in of.all(node, predicate)))


def _features(of: StatementIndex, node: NamedNode) -> FeatureSet:
    """A set of features."""
    return FeatureSet(
        of.text(node, CAPAR.relStart),
        of.text(node, CAPAR.relEnd),
        of.text(node, CAPAR.changeLoc),
        of.text(node, CAPAR.effectorType),
        of.text(node, CAPAR.forceApplied),
    )


def _upar(of: StatementIndex, node: NamedNode) -> Upar:
    """An uninstantiated action; the parents it was seen in stand with its instances."""
    return Upar(
        name=of.text(node, CAPAR.name),
        agent=of.text(node, CAPAR.agentParameter),
        objects=of.words(node, CAPAR.parameters),
        general=of.words(node, CAPAR.general),
        applicability=_conditions(of, node, CAPAR.applicability),
        preparation=_preparation(of, node),
        steps=tuple(
            _call(of, each) for each in of.ordered(node, CAPAR.executionStep, by=CAPAR.index)
        ),
        core=_core(of, node),
        post_assertions=_conditions(of, node, CAPAR.postAssertion),
    )


def _ipar(of: StatementIndex, node: NamedNode) -> Ipar:
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
        post_assertions=_conditions(of, node, CAPAR.postAssertion),
        posture=of.text(node, CAPAR.posture),
        parent=of.text(node, CAPAR.parentName),
    )


def _preparation(of: StatementIndex, node: NamedNode) -> tuple[Preparation, ...]:
    found = []
    for preparation in of.ordered(node, CAPAR.preparation, by=CAPAR.index):
        needed, remedy = of.one(preparation, CAPAR.condition), of.one(preparation, CAPAR.remedy)
        if needed and remedy:
            found.append(Preparation(_condition(of, needed), _call(of, remedy)))
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
        termination=_conditions(of, node, CAPAR.termination),
        duration_s=None if duration is None else float(duration),
        manner=of.text(node, CAPAR.manner),
        constraint=Constraint(
            _features(of, bits),
            (
                of.count(constraint, CAPAR.collidingFirst),
                of.count(constraint, CAPAR.collidingSecond),
            ),
        ),
    )


def _complex_par(of: StatementIndex, node: NamedNode) -> ComplexPar:
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
