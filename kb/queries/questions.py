"""Named questions: each is a file of SPARQL whose first comments say what it asks and of what.

A question that takes the shared filters says where, in a comment of its own: ``# filters
?segment``, or another variable. Parameters and filters are described in ``parameters.toml``.
Answers are written as a table, CSV, JSON or Turtle.
"""

import csv
import io
import json
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from pyoxigraph import Literal, NamedNode, RdfFormat, serialize

from capar.model.errors import CaparError, UnknownNameError
from capar.model.figures import figure, rounded
from kb.store import names, sparql, statements
from kb.store.answer_values import Answer, Plain, exact, plain, turtle
from kb.store.answer_values import Found as Term

if TYPE_CHECKING:
    from kb.store.answer_values import Answer
    from kb.store.stores import Store


_FOLDER = files("kb") / "queries"
_DESCRIBED: Mapping[str, Any] = tomllib.loads((_FOLDER / "parameters.toml").read_text("utf-8"))
PARAMETERS: Mapping[str, Mapping[str, Any]] = _DESCRIBED["parameters"]
FILTERS: Mapping[str, Mapping[str, Any]] = _DESCRIBED["filters"]

SYNONYMS = {("preposition", "inside"): "in", ("arrangement", "in"): "inside"}
"""Values by parameter and another word that people use for them."""

OF_LEXICON = frozenset({"lemma", "levin"})
"""The parameters that only a loaded lexicon can answer."""

NARROWING = frozenset({"capture", "address"})
"""Filters that leave so few that the others are best tested on each of these."""

_PARAMETER = re.compile(
    r"(?P<name>\w+) \((?P<kind>text|number)"
    r"(?:, (?:(?P<required>required)|default (?P<default>\w+)))?\): (?P<meaning>[^;]+)"
)
_MARK = re.compile(r"^ *# filters \?(\w+)$", re.MULTILINE)
_NOTE = re.compile(r"^# Note: (.+)$", re.MULTILINE)
_UNLESS = re.compile(r'^# Unless \?(\w+)(?: = "([^"]+)")?: (.+)$', re.MULTILINE)


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
        own = [each.name for each in self.parameters]
        for name in given:
            if name not in own:
                raise UnknownNameError(f"parameter of the question {self.name!r}", name, own)
        values = {each.name: self._value(each, given) for each in self.parameters}
        begin, end = (values.get(name, ()) for name in ("from", "until"))
        if begin and end and float(begin[0].value) > float(end[0].value):
            raise CaparError(
                f"question {self.name!r}: from={begin[0].value} is after until={end[0].value}"
            )
        given_filters = {e: values[e] for e in filters_of(self.query) if values[e]}
        query = _filtered(self.query, given_filters)
        for parameter in self.parameters:
            terms = values[parameter.name]
            if parameter.kind == "text":
                actions = tuple(names.shared("action", each.value) for each in terms)
                query = _stated(query, f"{parameter.name}_node", actions)
            query = _stated(query, parameter.name, terms)
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


def meant(parameter: str, text: str) -> list[str]:
    """The values that a text means for a parameter: several of some, the usual word for others."""
    words = text.split(",") if PARAMETERS[parameter].get("several") else [text]
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


def filters_of(query: str) -> tuple[str, ...]:
    """The names of the filters that a query takes; what it has a variable for it sets itself."""
    marked = set(_MARK.findall(query))
    return tuple(
        name
        for name, each in FILTERS.items()
        if marked & each["on"].keys()
        and not any(_unset(variable) in query for variable in (name, f"{name}_node"))
    )


def _unset(variable: str) -> str:
    """The line of a query whose variable may be given values."""
    return f"VALUES ?{variable} {{ UNDEF }}"


def _stated(query: str, variable: str, terms: Sequence[Literal | NamedNode]) -> str:
    line = _unset(variable)
    if len(terms) == 1 and variable.endswith("_node") and line in query:
        return query.replace(line, "").replace(f"?{variable}", str(terms[0]))
    stated = f"VALUES ?{variable} {{ {' '.join(map(str, terms))} }}"
    return query.replace(line, stated if terms else "")


def _filtered(query: str, given: Mapping[str, Sequence[Literal]]) -> str:
    """A query with the filters set for which there are values; one of several is enough."""
    narrow = bool(given.keys() & NARROWING)
    # Asked of both, a question is of one object in recordings: a kind is that object's.
    of_an_object = set(_MARK.findall(query)) >= {"seen", "thing"}

    def patterns(found: "re.Match[str]") -> str:
        held = (
            _filter(found[1], name, values, narrow=narrow)
            for name, values in given.items()
            if found[1] in FILTERS[name]["on"]
            and (name != "kind" or (found[1] == "thing") == of_an_object)
        )
        return "\n".join(f"  {pattern}" for pattern in held)

    return _MARK.sub(patterns, query)


def _filter(of: str, name: str, values: Sequence[Literal], *, narrow: bool) -> str:
    """A pattern with its values; what may fit in several ways still counts once.

    Where another filter leaves few, each of them is tested, instead of finding all that fit: a
    variable that is compared is bound last, a value that is written out is sought first.
    """
    stated = FILTERS[name]["on"][of]
    pattern = stated.replace("@action@", "@value@")
    terms: Sequence[Literal | NamedNode] = values
    if pattern != stated:
        terms = [names.shared("action", each.value) for each in values]
    several = len(values) > 1 or "|" in pattern
    if several and narrow:
        tests = (f"EXISTS {{ {pattern.replace('@value@', str(value))} }}" for value in terms)
        return f"FILTER({' || '.join(tests)})"
    one = f"?f_one_{name}"
    if narrow and FILTERS[name]["kind"] == "text" and name not in NARROWING:
        return f"{pattern.replace('@value@', one)} FILTER({one} = {terms[0]})"
    if not several:
        return str(pattern.replace("@value@", str(terms[0])))
    one_of = f"VALUES {one} {{ {' '.join(map(str, terms))} }}"
    did, general, rest = pattern.partition("/capar:kindOf @value@")
    if general:  # some actions are soon found, and then what is of one of them
        done = f"?f_done_{name}"
        few = f"{{ SELECT DISTINCT {done} {{ {one_of} {done} capar:kindOf {one} }} }}"
        return f"{few} {did} {done}{rest}"
    return f"{{ SELECT DISTINCT ?{of} {{ {one_of} {pattern.replace('@value@', one)} }} }}"


@cache
def questions() -> Mapping[str, Question]:
    """Every question by name, sorted."""
    found = sorted(
        (each for each in _FOLDER.iterdir() if each.name.endswith(".rq")), key=lambda at: at.name
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
        Parameter(each, FILTERS[each]["kind"], False, "", FILTERS[each]["meaning"])
        for each in shared
    )
    return Question(name, first.removeprefix("#").strip(), (*parameters, *filters), query)


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
        kind = PARAMETERS[parameter.name]["noun"]
        known = _texts(store, PARAMETERS[parameter.name]["known"])
        if not known and parameter.name in OF_LEXICON:
            raise CaparError(
                f"{store.place}: no {kind} is known, as no lexicon is loaded; "
                "`capar lexicon load` puts WordNet's verbs and Levin's classes in"
            )
        for value in meant(parameter.name, asked_for):
            if value not in known:
                listed = bool(PARAMETERS[parameter.name].get("listed"))
                raise UnknownNameError(kind, value, known, where=store.place, listed=listed)
    if {"capture", "time"} <= given.keys():
        capture, time_s = str(given["capture"]), float(str(given["time"]))
        lasts = f"?of a capar:Capture ; capar:name {Literal(capture)} ; capar:duration ?name"
        end_s = max(map(float, _texts(store, lasts)))
        if not 0.0 <= time_s <= max(end_s, round(end_s, 3)):
            raise CaparError(
                f"{store.place}: {capture} lasts from 0 to {end_s:.3f} s; {time_s:g} s lies outside"
            )
        body = str(given.get("body", ""))
        tracks = _texts(
            store,
            f"?seen capar:capture/capar:name {Literal(capture)} ; capar:link|capar:object ?of . "
            f"?of capar:name|capar:ee {Literal(body)} ; capar:track ?name",
        )
        for text in tracks if body else ():
            lost_s = statements.track_of(text).lost_around(time_s)
            if lost_s is not None:
                raise CaparError(
                    f"{store.place}: where {body!r} was at {time_s:g} s is not known: "
                    f"{capture} lost it from {lost_s[0]:.2f} to {lost_s[1]:.2f} s"
                )


def _texts(store: "Store", pattern: str) -> set[str]:
    query = sparql.complete(f"SELECT DISTINCT ?name WHERE {{ {pattern} }}")
    found = (row[0] for row in store.ask(query).rows)
    return {each.value for each in found if isinstance(each, Literal)}


def notes(asked: Question, answer: "Answer") -> list[str]:
    """What a question's file says beside an answer.

    ``# Note:`` always holds; ``# Unless ?recorded: ...`` where that column has no value in any
    row, or not the one that is named.
    """
    said = _NOTE.findall(asked.query)
    for column, value, text in _UNLESS.findall(asked.query):
        at = answer.variables.index(column)
        held = {term.value for row in answer.rows if isinstance(term := row[at], Literal)}
        if value not in held if value else not held:
            said.append(text)
    return said


RESULT_SET = "http://www.w3.org/2001/sw/DataAccess/tests/result-set#"


def header(answer: Answer) -> tuple[str, ...]:
    """The columns of an answer."""
    if answer.boolean is not None:
        return ("answer",)
    return ("subject", "predicate", "object") if answer.triples is not None else answer.variables


def cells(answer: Answer) -> list[tuple[str, ...]]:
    """The rows of an answer as texts for people: numbers short, IRIs with their prefixes."""
    if answer.boolean is not None:
        return [("yes" if answer.boolean else "no",)]
    rows = (map(plain, row) for row in _rows(answer))
    return [
        tuple("" if e is None else figure(e) if isinstance(e, float) else str(e) for e in row)
        for row in rows
    ]


def _rows(answer: Answer) -> list[tuple[Term, ...]]:
    if answer.triples is not None:
        return [(t.subject, t.predicate, t.object) for t in answer.triples]
    return list(answer.rows)


def as_csv(answer: Answer) -> str:
    """Comma-separated values with a header, numbers exact, IRIs in full."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header(answer))
    truth: list[list[Plain]] = [] if answer.boolean is None else [[answer.boolean]]
    for row in truth or [list(map(exact, row)) for row in _rows(answer)]:
        writer.writerow([str(e).lower() if isinstance(e, bool) else e for e in row])
    return out.getvalue()


def as_json(answer: Answer) -> str:
    """A list of objects, numbers to six places, IRIs in full, or a truth; or JSON-LD."""
    if answer.triples is not None:
        return (serialize(answer.triples, format=RdfFormat.JSON_LD) or b"").decode() + "\n"
    terms = (
        [rounded(e, 6) if isinstance(e, float) else e for e in map(exact, row)]
        for row in answer.rows
    )
    rows = [dict(zip(answer.variables, row, strict=True)) for row in terms]
    value = rows if answer.boolean is None else answer.boolean
    return json.dumps(value, indent=2, ensure_ascii=False) + "\n"


def as_turtle(answer: Answer) -> str:
    """Statements; rows and truths in the W3C's vocabulary of result sets."""
    if answer.triples is not None:
        return turtle(answer.triples, form=RdfFormat.TURTLE)
    lines = [f"@prefix rs: <{RESULT_SET}> .", "", "[] a rs:ResultSet"]
    if answer.boolean is not None:
        lines.append(f"    ; rs:boolean {str(answer.boolean).lower()}")
    lines += [f'    ; rs:resultVariable "{name}"' for name in answer.variables]
    for row in answer.rows:
        bindings = ", ".join(
            f'[ rs:variable "{name}" ; rs:value {term} ]'
            for name, term in zip(answer.variables, row, strict=True)
            if term is not None
        )
        lines.append(f"    ; rs:solution [ rs:binding {bindings} ]" if bindings else "")
    return "\n".join([*filter(None, lines[:1]), "", *filter(None, lines[2:])]) + " .\n"


def as_table(answer: Answer) -> str:
    """Aligned columns for anything that is no terminal."""
    rows = [header(answer), *cells(answer)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    padded = ([f"{c:<{width}}" for c, width in zip(row, widths, strict=True)] for row in rows)
    return "".join("  ".join(row).rstrip() + "\n" for row in padded)


def listing() -> Answer:
    """The named questions with their parameters, those in brackets not needed."""
    rows = []
    for question in questions().values():
        names = (p.name if p.required else f"[{p.name}]" for p in question.parameters)
        rows.append(tuple(map(Literal, (question.name, " ".join(names), question.text))))
    return Answer(("name", "parameters", "question"), tuple(rows))


FORMATS = {"table": as_table, "csv": as_csv, "json": as_json, "turtle": as_turtle}
"""How an answer may be printed."""
