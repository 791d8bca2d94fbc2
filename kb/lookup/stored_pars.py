"""Finding stored actions, and reading them back as PARs."""

from dataclasses import replace

from pyoxigraph import Literal, NamedNode

from capar.model.errors import UnknownNameError
from capar.model.par import Call, ComplexPar, Condition, CoreSemantics, Ipar, Preparation, Upar
from kb.findings import Stored
from kb.lookup import par_decoding
from kb.lookup.statement_index import StatementIndex
from kb.lookup.stored import observations
from kb.store import names
from kb.store.stores import Store
from ontology import CAPAR


def find(
    store: Store, *, action: str | None, objects: tuple[str, ...], performer: str | None
) -> tuple[Stored, ...]:
    """Observations of complex actions that fit."""
    filters = []
    if performer is not None:
        filters.append(f"?seen {CAPAR.agent}/{CAPAR.name} {Literal(performer)} .")
    if action is not None:
        word = Literal(action)
        filters.append(
            f"FILTER(?action = {word} || EXISTS {{ ?seen {CAPAR.step}/{CAPAR.name} {word} }})"
        )
    for thing in objects:
        word = Literal(thing)
        filters.append(
            f"FILTER(EXISTS {{ ?seen {CAPAR.object}/{CAPAR.name} {word} }} || "
            f"EXISTS {{ ?seen {CAPAR.object}/{CAPAR.kind}/{CAPAR.isA}/{CAPAR.name} {word} }})"
        )
    return observations(store, "\n  ".join(filters))


def observation_reading(store: Store, name: str) -> tuple[NamedNode, StatementIndex]:
    """An observation and everything that it says or mentions."""
    node = names.observation(name)
    own = store.graph(node)
    if not own:
        known = [each.name for each in observations(store)]
        raise UnknownNameError("observation", name, known, where=store.place)
    shared = store.ask(
        f"CONSTRUCT {{ ?s ?p ?o }} WHERE {{ {node} {CAPAR.mentions} ?s . "
        f"GRAPH {names.GRAPHS['actions']} {{ ?s ?p ?o }} }}"
    )
    return node, StatementIndex([*own, *(shared.triples or ())])


def complex_par(store: Store, name: str) -> ComplexPar:
    """A complex action as it was observed, by an observation's name or by its own."""
    seen = observations(store)
    fitting = [each for each in seen if each.name == name] or [
        each for each in seen if each.action == name
    ]
    if not fitting:
        known = {each.name for each in seen} | {each.action for each in seen}
        raise UnknownNameError("complex action", name, known, where=store.place)
    node, reading = observation_reading(store, fitting[0].name)
    return par_decoding.complex_par(reading, node)


def upars(store: Store, name: str | None) -> tuple[Upar, ...]:
    """Uninstantiated actions, by name and number of objects."""
    reading = StatementIndex(store.graph(names.GRAPHS["actions"]))
    found = [par_decoding.upar(reading, node) for node in reading.things(CAPAR.Upar)]
    fitting = [each for each in found if name in {None, each.name}]
    return tuple(sorted(fitting, key=lambda each: (each.name, len(each.objects), repr(each))))


def ipars(store: Store, observation: str) -> tuple[Ipar, ...]:
    """The instantiated actions of an observation, links in order."""
    node, reading = observation_reading(store, observation)
    order = reading.words(node, CAPAR.effectors)
    found = [
        (order.index(reading.text(each, CAPAR.ee)), reading.number(each, CAPAR.start), each)
        for each in reading.things(CAPAR.Ipar)
    ]
    found.sort(key=lambda each: each[:2])
    return tuple(par_decoding.ipar(reading, each) for _, _, each in found)


def effective(known: tuple[Upar, ...], ipar: Ipar) -> Upar:
    """An action as it is to be done: parameters bound, and overridden where the IPAR speaks."""
    features = ipar.core.constraint.features
    fitting = [each for each in known if each.core.constraint.features == features] or list(known)
    if not fitting:
        raise UnknownNameError("UPAR", ipar.upar, [])
    upar = fitting[0]
    bound = dict(
        zip((*upar.objects, upar.agent, "EE"), (*ipar.objects, ipar.agent, ipar.ee), strict=False)
    )
    return replace(
        upar,
        agent=ipar.agent,
        objects=ipar.objects,
        applicability=tuple(_bound(each, bound) for each in upar.applicability),
        preparation=ipar.preparation
        or tuple(
            Preparation(_bound(each.condition, bound), _call(each.action, bound))
            for each in upar.preparation
        ),
        steps=tuple(_call(step, bound) for step in upar.steps),
        core=_overridden(upar.core, ipar.core),
        post_assertions=ipar.post_assertions
        or tuple(_bound(each, bound) for each in upar.post_assertions),
        parent=ipar.parent or upar.parent,
    )


def _bound(value: Condition, to: dict[str, str]) -> Condition:
    return replace(value, arguments=tuple(to.get(each, each) for each in value.arguments))


def _call(value: Call, to: dict[str, str]) -> Call:
    return replace(value, objects=tuple(to.get(thing, thing) for thing in value.objects))


def _overridden(upar: CoreSemantics, ipar: CoreSemantics) -> CoreSemantics:
    """What the instance leaves empty stays as the action has it."""
    return replace(
        ipar,
        moved=ipar.moved or upar.moved,
        force=ipar.force or upar.force,
        path=ipar.path or upar.path,
        purpose=ipar.purpose or upar.purpose,
        enables=ipar.enables or upar.enables,
        termination=ipar.termination or upar.termination,
        duration_s=upar.duration_s if ipar.duration_s is None else ipar.duration_s,
        manner=ipar.manner or upar.manner,
    )
