"""Preparing a user's query: refusing writes, declaring prefixes, expanding our functions."""

import re
from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from itertools import dropwhile, pairwise
from typing import NamedTuple

from kb.errors import QueryError
from ontology import BASE, DATA, PREFIXES, terms

_TOKEN = re.compile(
    r"""
      (?P<space>   \s+ | \#[^\r\n]* )
    | (?P<string>  \"\"\"(?:\\.|[^\\])*?\"\"\" | '''(?:\\.|[^\\])*?'''
                 | "(?:\\.|[^"\\\r\n])*" | '(?:\\.|[^'\\\r\n])*' )
    | (?P<iri>     <[^<>"{}|^`\x00-\x20]*> )
    | (?P<variable>[?$]\w+ )
    | (?P<printed> data:[\w\-:%.~]*[/\#][\w\-:%.~/\#]*[\w\-%~] )
    | (?P<name>    [A-Za-z_][\w.\-]*:(?:[\w\-:%.\\]*[\w\-:%\\])? | :[\w\-:%.\\]* )
    | (?P<word>    [A-Za-z_]\w* )
    | (?P<other>   . )
    """,
    re.VERBOSE | re.DOTALL,
)
_ESCAPE = re.compile(r"\\u([0-9A-Fa-f]{4})|\\U([0-9A-Fa-f]{8})")
_GAP = re.compile(r"@(\w+)@")
_UPDATES = {"insert", "delete", "load", "clear", "drop", "create", "add", "move", "copy", "with"}
_FORMS = {"select", "construct", "ask", "describe"}

_ELEMENT = (
    '<http://www.w3.org/2001/XMLSchema#double>(REPLACE(CONCAT(STR({0}), " x"), '
    'CONCAT("^(?:[^ ]+ ){{", STR({1}), "}}([^ ]+) .*$"), "$1"))'
)
_ELEMENT_AT = (
    '<http://www.w3.org/2001/XMLSchema#double>(REPLACE(CONCAT(STR({0}), " x"), '
    '"^(?:[^ ]+ ){{{1}}}([^ ]+) .*$", "$1"))'
)
"""The same for an index that is written out: a pattern that is made once."""

ARITIES = {"position": 3, "speed": 3, "distance": 4, "highestSpeed": 4, "pathLength": 4}
"""How many arguments the functions of ``track_functions`` take: observation and body first, times
in seconds last. They stand here, as that module takes most of a second to import."""

FUNCTIONS = {
    "element": (_ELEMENT, 2),
    "elements": ('(STRLEN(REPLACE(STR({0}), "[^ ]", "")) + 1)', 1),
    **{name: (f"<{BASE}{name}>({', '.join(['{}'] * n)})", n) for name, n in ARITIES.items()},
}
"""Our functions, as expressions of plain SPARQL or of the engine's calls, with their arity."""


_CALLED = {text: each for each in FUNCTIONS for text in (f"capar:{each}", f"<{BASE}{each}>")}
"""The names of our functions as queries write them."""


class Token(NamedTuple):
    """A piece of a query and what it is."""

    kind: str
    text: str


def tokens(query: str) -> Iterator[Token]:
    """The pieces of a query, which joined are the query."""
    for match in _TOKEN.finditer(query):
        yield Token(match.lastgroup or "other", match.group())


def is_meant(text: str) -> bool:
    """Whether a text is meant as SPARQL, by its first word and what follows; or says nothing."""
    pieces = list(dropwhile(lambda each: each.kind == "space", tokens(text)))
    if len(pieces) < 2:
        return not pieces
    first, after = pieces[0].text.lower(), pieces[1].kind
    known = {*_FORMS, *_UPDATES, "prefix", "base"}
    return first in known and after in {"space", "iri", "variable"}


def unknown_terms(query: str) -> list[str]:
    """A sentence for each word of a query that is written like one of the ontology and is none."""
    known = {*terms(), *FUNCTIONS}
    words = (
        piece.text.removeprefix("capar:")
        if piece.kind == "name"
        else piece.text[len(BASE) + 1 : -1]
        for piece in tokens(query)
        if piece.text.startswith(("capar:", f"<{BASE}"))
    )
    found = []
    for name in dict.fromkeys(words):
        if name and name not in known:
            near = [f"capar:{word}" for word in get_close_matches(name, sorted(known), n=3)]
            hint = f" Did you mean {' or '.join(near)}?" if near else ""
            found.append(f"the ontology has no capar:{name}, so nothing is found by it.{hint}")
    return found


def names_graphs(query: str) -> bool:
    """Whether a query says itself which graphs it is asked of (FROM), instead of all."""
    if "from" not in query.lower():
        return False
    words = pairwise([Token("space", ""), *tokens(query)])
    return any(
        each.kind == "word" and each.text.lower() == "from" and before.text != "@"
        for before, each in words
    )


def prepare(query: str) -> str:
    """A user's query with known prefixes declared and our functions spelt out.

    Raises:
        QueryError: It is empty, writes, or calls other services.
    """
    pieces = list(tokens(query))
    if all(each.kind == "space" for each in pieces):
        raise QueryError("the query is empty; `capar query --list` names questions to begin with")
    _refuse(pieces)
    if _ESCAPE.search(query):
        whole = _ESCAPE.sub(lambda at: chr(int(at.group(1) or at.group(2), 16)), query)
        _refuse(tokens(whole))
    return _completed(pieces)


def complete(query: str) -> str:
    """A query with known prefixes declared, and our functions and what answers print spelt out.

    Raises:
        QueryError: A function with another number of arguments than it takes.
    """
    return _completed(list(tokens(query)))


def _completed(pieces: list[Token]) -> str:
    meaningful = [each for each in pieces if each.kind != "space"]
    declared = {
        after.text.partition(":")[0]
        for before, after in pairwise(meaningful)
        if before.kind == "word" and before.text.lower() == "prefix"
    }
    used = {each.text.partition(":")[0] for each in meaningful if each.kind == "name"}
    missing = sorted((used & PREFIXES.keys()) - declared)
    return "".join(f"PREFIX {each}: <{PREFIXES[each]}> " for each in missing) + _expand(pieces)


def _refuse(pieces: Iterable[Token]) -> None:
    words = [each.text.lower() for each in pieces if each.kind == "word"]
    if "service" in words:
        raise QueryError("a query may not use SERVICE: it answers from this Actionary alone")
    for word in words:
        if word in _FORMS:
            return
        if word in _UPDATES:
            raise QueryError(
                f"a query may not write ({word.upper()}); SELECT, CONSTRUCT, ASK and DESCRIBE "
                "ask, and `capar import`, `capar forget` and `capar observe` write"
            )


def opens_tracks(query: str) -> bool:
    """Whether a query calls a function that opens sampled tracks, which no server knows."""
    if not any(each in query for each in ARITIES):
        return False
    pieces = [each for each in tokens(query) if each.kind != "space"]
    return any(
        after.text == "(" and _CALLED.get(before.text) in ARITIES
        for before, after in pairwise(pieces)
    )


def _expand(pieces: list[Token]) -> str:
    out: list[str] = []
    at = 0
    while at < len(pieces):
        name = _CALLED.get(pieces[at].text)
        opening = at + 1
        while name and opening < len(pieces) and pieces[opening].kind == "space":
            opening += 1
        if name and opening < len(pieces) and pieces[opening].text == "(":
            arguments, at = _arguments(pieces, opening)
            template, arity = FUNCTIONS[name]
            if len(arguments) != arity:
                raise QueryError(f"capar:{name} takes {arity} arguments, not {len(arguments)}")
            words = [_expand(each).strip() for each in arguments]
            if name == "element" and words[1].isdecimal():
                template = _ELEMENT_AT
            out.append(template.format(*words))
        else:
            out.append(_whole(pieces[at]))
            at += 1
    return "".join(out)


def _whole(piece: Token) -> str:
    """A piece of a query; an IRI of our data in full, where it stands as answers print it."""
    if piece.kind == "printed":
        return f"<{DATA}{piece.text.removeprefix('data:')}>"
    if piece.kind == "iri" and piece.text.startswith("<data:"):
        return f"<{DATA}{piece.text.removeprefix('<data:')}"
    return piece.text


def _arguments(pieces: list[Token], opening: int) -> tuple[list[list[Token]], int]:
    """The arguments between an opening parenthesis and its closing one, and what is after."""
    depth, arguments = 0, [[]]  # type: tuple[int, list[list[Token]]]
    for at in range(opening, len(pieces)):
        text = pieces[at].text if pieces[at].kind == "other" else ""
        depth += (text == "(") - (text == ")")
        if depth == 0:
            return arguments, at + 1
        if text == "," and depth == 1:
            arguments.append([])
        elif at > opening:
            arguments[-1].append(pieces[at])
    raise QueryError("a parenthesis of a capar: function is never closed")


def stored(name: str, /, **parts: str) -> str:
    """A query or update of ours from its file (``kb/store/queries``), its gaps filled."""
    return fill(_stored(name), **parts)


@cache
def _stored(name: str) -> str:
    """The text of a file with its IRIs in full: updates are joined, where prefixes may not be."""
    text = (files("kb") / "store" / "queries" / f"{name}.rq").read_text("utf-8")
    whole = ""
    for piece in tokens(text):
        prefix, _, local = piece.text.partition(":")
        known = piece.kind == "name" and prefix in PREFIXES
        whole += f"<{PREFIXES[prefix]}{local}>" if known else _whole(piece)
    return whole


def fill(template: str, **parts: str) -> str:
    """A query of ours with its gaps, written ``@name@``, filled in one pass."""
    return _GAP.sub(lambda at: parts[at.group(1)], template)
