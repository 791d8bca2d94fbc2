"""Named questions: each is a file of SPARQL whose first comments say what it asks and of what."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from pyoxigraph import Literal, NamedNode

from capar.model.errors import CaparError, UnknownNameError
from kb.queries.filters import FILTERS, filtered, filters_of, node, unset
from kb.store import sparql, statements
from ontology.namespace import RELATIONS

if TYPE_CHECKING:
    from kb.store.stores import Store

_PARAMETER = re.compile(
    r"(?P<name>\w+) \((?P<kind>text|number)"
    r"(?:, (?:(?P<required>required)|default (?P<default>\w+)))?\): (?P<meaning>[^;]+)"
)

_OBJECT = ("object", "?of a capar:TagObject ; capar:name|(capar:kind/capar:isA/capar:name) ?name")
_WHOLE = ("whole action", "?of a capar:Observation ; capar:name ?name")
BEARERS = {
    "address": ("segment", "?of a capar:Segment ; capar:address ?name"),
    "action": (
        "action",
        "{ ?of a capar:Observation ; rdfs:label ?name } UNION { ?of a ?kind ; capar:name ?name "
        "VALUES ?kind { capar:Action capar:Upar capar:JointAction capar:Observation } }",
    ),
    "arrangement": ("arrangement", "?of capar:arrangement ?name"),
    "body": ("body", "?of capar:body/capar:name ?name"),
    "capture": ("capture", "?of a capar:Capture ; capar:name ?name"),
    "ee": ("end-effector", "?of a capar:Link ; capar:ee ?name"),
    "effector": ("kind of end-effector", "?of a capar:Link ; capar:effectorType ?name"),
    "first": _WHOLE,
    "goal": _OBJECT,
    "kind": (
        "object or kind of object",
        "?of capar:name ?name ; a ?bearer VALUES ?bearer { capar:ObjectKind capar:TagObject }",
    ),
    "lemma": ("verb", "?of a ontolex:Word ; rdfs:label ?word BIND(STR(?word) AS ?name)"),
    "levin": ("class of Levin's", "?of a capar:LevinClass ; skos:notation ?name"),
    "object": _OBJECT,
    "observation": ("observation", "?of a capar:Observation ; rdfs:label ?name"),
    "other": ("action", "?of a capar:Action ; capar:name ?name"),
    "other_ee": ("end-effector", "?of a capar:Link ; capar:ee ?name"),
    "other_effector": ("kind of end-effector", "?of a capar:Link ; capar:effectorType ?name"),
    "other_side": ("side", "?of a capar:Link ; capar:side ?name"),
    "performer": ("performer", "?of a capar:Agent ; capar:name|rdfs:label ?name"),
    "preposition": ("preposition", "?of capar:preposition ?name"),
    "purpose": ("purpose", "?of capar:purpose ?name"),
    "relation": (
        "relation of Allen's",
        f"VALUES ?name {{ {' '.join(map(repr, (*RELATIONS, 'together')))} }}",
    ),
    "second": _WHOLE,
    "side": ("side", "?of a capar:Link ; capar:side ?name"),
}
"""What each parameter that is a text names, and the pattern of those that bear such a name."""


FEW = frozenset({"arrangement", "effector", "other_effector", "preposition", "relation", "side"})
"""Parameters whose values are few enough to list all of them where one is not known."""

SEVERAL = frozenset(
    {
        *("action", "arrangement", "body", "ee", "effector", "kind", "object", "other"),
        *("other_ee", "other_effector", "preposition"),
    }
)
"""Parameters that take several names with commas between them, of which one is enough."""

SYNONYMS = {("preposition", "inside"): "in", ("arrangement", "in"): "inside"}
"""Values by parameter and another word that people use for them."""

OF_LEXICON = frozenset({"lemma", "levin"})
"""The parameters that only a loaded lexicon can answer."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """Something that a question is asked of."""

    name: str
    kind: str
    """``text`` or ``number``."""

    required: bool
    default: str
    """What is meant when nothing is given; empty: anything."""

    meaning: str


@dataclass(frozen=True, slots=True)
class Question:
    """A question with a name."""

    name: str
    text: str
    """The question in words."""

    parameters: tuple[Parameter, ...]
    query: str

    def bind(self, given: Mapping[str, object]) -> str:
        """The query with its parameters set.

        Raises:
            UnknownNameError: A parameter that the question has not; the message lists those it has.
            QuestionError: A required one is missing, or a number is none.
        """
        names = [each.name for each in self.parameters]
        for name in given:
            if name not in names:
                raise UnknownNameError(f"parameter of the question {self.name!r}", name, names)
        values = {each.name: self._value(each, given) for each in self.parameters}
        _check_span(self, values)
        set_filters = filters_of(self.query)
        query = filtered(self.query, {each: values[each] for each in set_filters if values[each]})
        for parameter in self.parameters:
            query = _set(query, parameter, values[parameter.name])
        return sparql.complete(query)

    def _value(self, parameter: Parameter, given: Mapping[str, object]) -> tuple[Literal, ...]:
        value = given.get(parameter.name)
        text = parameter.default if value is None else str(value)
        if not text:
            if parameter.required:
                raise QuestionError(self, parameter)
            return ()
        if parameter.kind == "text":
            return tuple(map(Literal, meant(parameter.name, text)))
        try:
            return (Literal(float(text)),)
        except ValueError:
            raise QuestionError(self, parameter, text) from None


def _check_span(asked: Question, values: Mapping[str, Sequence[Literal]]) -> None:
    begin, end = (values.get(name, ()) for name in ("from", "until"))
    if begin and end and float(begin[0].value) > float(end[0].value):
        raise CaparError(
            f"question {asked.name!r}: from={begin[0].value} is after until={end[0].value}; "
            "what lies between them, or over one of them, would be found"
        )


def meant(parameter: str, text: str) -> list[str]:
    """The values that a text means for a parameter: several of some, the usual word for others."""
    words = text.split(",") if parameter in SEVERAL else [text]
    return [SYNONYMS.get((parameter, word.strip()), word.strip()) for word in words]


class QuestionError(CaparError):
    """A question that is asked without what it needs, or of something that is no number."""

    def __init__(self, question: Question, parameter: Parameter, text: str = "") -> None:
        self.question = question.name
        self.parameter = parameter.name
        problem = f"is a number, not {text!r}" if text else "must be given"
        listed = "; ".join(f"{each.name}: {each.meaning}" for each in question.parameters)
        super().__init__(
            f"question {question.name!r}: {parameter.name} {problem}. Its parameters: {listed}"
        )


def _set(query: str, parameter: Parameter, values: tuple[Literal, ...]) -> str:
    if parameter.kind == "text":
        query = _stated(query, f"{parameter.name}_node", tuple(map(node, values)))
    return _stated(query, parameter.name, values)


def _stated(query: str, variable: str, terms: Sequence[Literal | NamedNode]) -> str:
    line = unset(variable)
    if len(terms) == 1 and variable.endswith("_node") and line in query:
        return query.replace(line, "").replace(f"?{variable}", str(terms[0]))
    stated = f"VALUES ?{variable} {{ {' '.join(map(str, terms))} }}"
    return query.replace(line, stated if terms else "")


@cache
def questions() -> Mapping[str, Question]:
    """Every question by name, sorted."""
    folder = files("kb") / "queries"
    found = sorted(
        (each for each in folder.iterdir() if each.name.endswith(".rq")), key=lambda at: at.name
    )
    read = [_read(each.name.removesuffix(".rq"), each.read_text("utf-8")) for each in found]
    return {each.name: each for each in read}


def question(name: str) -> Question:
    """The question of that name.

    Raises:
        UnknownNameError: There is none; the message lists those that exist.
    """
    if name not in questions():
        raise UnknownNameError("question", name, questions())
    return questions()[name]


def check_known(store: "Store", asked: Question, given: Mapping[str, object]) -> None:
    """Check that what a question without answers asks about exists at all.

    Raises:
        UnknownNameError: Nothing that was observed bears a name; the message lists those there are.
        CaparError: The capture has no such time, or the body was lost then.
    """
    for parameter in asked.parameters:
        asked_for = str(given.get(parameter.name) or "")
        if parameter.kind != "text" or not asked_for:
            continue
        kind, pattern = BEARERS[parameter.name]
        known = _texts(store, pattern)
        if not known and parameter.name in OF_LEXICON:
            raise CaparError(
                f"{store.place}: no {kind} is known, as no lexicon is loaded; "
                "`capar lexicon load` puts WordNet's verbs and Levin's classes in"
            )
        for value in meant(parameter.name, asked_for):
            if value not in known:
                listed = parameter.name in FEW
                raise UnknownNameError(kind, value, known, where=store.place, listed=listed)
    if {"capture", "time"} <= given.keys():
        _check_time(store, str(given["capture"]), float(str(given["time"])))
        if "body" in given:
            _check_seen(store, str(given["capture"]), str(given["body"]), float(str(given["time"])))


def _check_time(store: "Store", capture: str, time_s: float) -> None:
    lasts = f"?of a capar:Capture ; capar:name {Literal(capture)} ; capar:duration ?name"
    end_s = max(map(float, _texts(store, lasts)))
    if not 0.0 <= time_s <= max(end_s, round(end_s, 3)):
        raise CaparError(
            f"{store.place}: {capture} lasts from 0 to {end_s:.3f} s; {time_s:g} s lies outside"
        )


def _check_seen(store: "Store", capture: str, body: str, time_s: float) -> None:
    tracks = _texts(
        store,
        f"?seen capar:capture/capar:name {Literal(capture)} ; capar:link|capar:object ?of . "
        f"?of capar:name|capar:ee {Literal(body)} ; capar:track ?name",
    )
    for text in tracks:
        lost_s = statements.track_of(text).lost_around(time_s)
        if lost_s is not None:
            raise CaparError(
                f"{store.place}: where {body!r} was at {time_s:g} s is not known: "
                f"{capture} lost it from {lost_s[0]:.2f} to {lost_s[1]:.2f} s"
            )


def counted_segments(store: "Store") -> str:
    """How many segments are stored, of how many observations."""
    query = """
SELECT (COUNT(DISTINCT ?segment) AS ?segments) (COUNT(DISTINCT ?of) AS ?observations)
{ ?of capar:segment ?segment }"""
    ((segments, observations),) = store.ask(sparql.complete(query)).rows
    return f"{_number(segments)} segments of {_number(observations)} observations"


def _number(term: object) -> str:
    return term.value if isinstance(term, Literal) else "0"


def _texts(store: "Store", pattern: str) -> set[str]:
    query = sparql.complete(f"SELECT DISTINCT ?name WHERE {{ {pattern} }}")
    found = (row[0] for row in store.ask(query).rows)
    return {each.value for each in found if isinstance(each, Literal)}


def _read(name: str, query: str) -> Question:
    first, second, *_ = query.splitlines()
    parameters = tuple(
        Parameter(
            each["name"],
            each["kind"],
            bool(each["required"]),
            each["default"] or "",
            each["meaning"].strip(),
        )
        for each in _PARAMETER.finditer(second)
    )
    own = {each.name for each in parameters}
    shared = (each for each in filters_of(query) if each not in own)
    filters = tuple(
        Parameter(each, FILTERS[each].kind, False, "", FILTERS[each].meaning) for each in shared
    )
    return Question(name, first.removeprefix("#").strip(), (*parameters, *filters), query)
