"""Filters that named questions share: which end-effector, whose, of which capture, when, with what.

A question that takes them says where, in a comment of its own: ``# filters ?segment``, or another
variable where it asks of something else.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pyoxigraph import Literal, NamedNode

from kb.store import names


@dataclass(frozen=True, slots=True)
class Filter:
    """A restriction that a question puts on its segments or observations."""

    kind: str
    """``text`` or ``number``."""

    meaning: str
    patterns: Mapping[str, str]
    """By the variable that it restricts: what must hold, with the value at ``@value@``, or the
    action of that name at ``@action@``."""


_NAME = "(capar:name|rdfs:label)"
FILTERS: Mapping[str, Filter] = {
    "action": Filter(
        "text",
        "the name of an action, which stands for every kind of it",
        {
            "segment": "?segment capar:action/capar:kindOf @action@ .",
            "joint": "?joint capar:action/capar:kindOf @action@ .",
            "place": "?place capar:ofAction/capar:kindOf @action@ .",
        },
    ),
    "address": Filter(
        "text",
        "a segment, as CAPTURE/EE/INDEX",
        {"segment": "?segment capar:address @value@ ."},
    ),
    "ee": Filter(
        "text",
        "the name of the end-effector",
        {
            "segment": "?segment capar:ofLink/capar:ee @value@ .",
            "link": "?link capar:ee @value@ .",
            "place": "?place capar:ee @value@ .",
        },
    ),
    "side": Filter(
        "text",
        "left, right or none",
        {
            "segment": "?segment capar:ofLink/capar:side @value@ .",
            "link": "?link capar:side @value@ .",
        },
    ),
    "effector": Filter(
        "text",
        "the kind of end-effector: hand, foot and the like",
        {
            "segment": "?segment capar:ofLink/capar:effectorType @value@ .",
            "link": "?link capar:effectorType @value@ .",
        },
    ),
    "other": Filter(
        "text",
        "the name of the other segment's action, which stands for every kind of it",
        {"two": "?two capar:action/capar:kindOf @action@ ."},
    ),
    "other_side": Filter(
        "text",
        "left, right or none, of the other segment",
        {"two": "?two capar:ofLink/capar:side @value@ ."},
    ),
    "other_ee": Filter(
        "text",
        "the name of the other segment's end-effector",
        {"two": "?two capar:ofLink/capar:ee @value@ ."},
    ),
    "other_effector": Filter(
        "text",
        "the other segment's kind of end-effector",
        {"two": "?two capar:ofLink/capar:effectorType @value@ ."},
    ),
    "performer": Filter(
        "text",
        "the name of an agent",
        {
            "segment": f"?segment capar:ofLink/capar:agent/{_NAME} @value@ .",
            "seen": f"?seen capar:agent/{_NAME} @value@ .",
            "place": f"?place capar:agent/{_NAME} @value@ .",
        },
    ),
    "capture": Filter(
        "text",
        "the name of a capture",
        {
            "segment": "?f_seen capar:segment ?segment ; capar:capture/capar:name @value@ .",
            "seen": "?seen capar:capture/capar:name @value@ .",
            "joint": "?f_seen capar:jointAction ?joint ; capar:capture/capar:name @value@ .",
            "place": "?f_seen capar:location ?place ; capar:capture/capar:name @value@ .",
            "contact": "?f_seen capar:fact ?contact ; capar:capture/capar:name @value@ .",
            "gaze": "?f_looks capar:fact ?gaze ; capar:capture/capar:name @value@ .",
            "two": "?f_two capar:segment ?two ; capar:capture/capar:name @value@ .",
        },
    ),
    "from": Filter(
        "number",
        "seconds since the first frame; what ends later counts",
        {"segment": "?segment capar:end ?f_end . FILTER(?f_end > @value@)"},
    ),
    "until": Filter(
        "number",
        "seconds since the first frame; what starts earlier counts",
        {"segment": "?segment capar:start ?f_start . FILTER(?f_start < @value@)"},
    ),
    "object": Filter(
        "text",
        "the name of the object or of its kind",
        {
            "thing": "?thing (capar:name|(capar:kind/capar:isA/capar:name)) @value@ .",
        },
    ),
    "kind": Filter(
        "text",
        "a kind of object that takes part, or one's name",
        {
            "thing": "?thing (capar:name|(capar:kind/capar:isA/capar:name)) @value@ .",
            "segment": "?segment capar:object ?f_object . "
            "?f_object capar:name|(capar:kind/capar:isA/capar:name) @value@ .",
            "seen": "?seen capar:object ?f_object . "
            "?f_object capar:name|(capar:kind/capar:isA/capar:name) @value@ .",
            "joint": "?joint capar:object ?f_object . "
            "?f_object capar:name|(capar:kind/capar:isA/capar:name) @value@ .",
        },
    ),
}
"""Every filter by name."""

NARROWING = frozenset({"capture", "address"})
"""Filters that leave so few that the others are best tested on each of these."""

OF_A_THING = frozenset({"seen", "thing"})
"""A question that is asked of both tells of one thing in recordings: a kind is that thing's."""

_MARKED = "segment|seen|link|joint|place|two|thing|contact|gaze"
_MARK = re.compile(rf"^ *# filters \?({_MARKED})$", re.MULTILINE)


def filters_of(query: str) -> tuple[str, ...]:
    """The names of the filters that a query takes; what it has a variable for it sets itself."""
    marked = {each[1] for each in _MARK.finditer(query)}
    return tuple(
        name
        for name, each in FILTERS.items()
        if marked & each.patterns.keys() and not _sets(query, name)
    )


def _sets(query: str, name: str) -> bool:
    """Whether a query has a variable of its own for what a filter restricts."""
    return any(unset(each) in query for each in (name, f"{name}_node"))


def unset(variable: str) -> str:
    """The line of a query whose variable may be given values."""
    return f"VALUES ?{variable} {{ UNDEF }}"


def node(value: Literal) -> NamedNode:
    """The action of a name: sought as such, not among all things that bear the name."""
    return names.shared("action", value.value)


def filtered(query: str, given: Mapping[str, Sequence[Literal]]) -> str:
    """A query with the filters set for which there are values; one of several is enough."""
    narrow = bool(given.keys() & NARROWING)
    of_a_thing = {each[1] for each in _MARK.finditer(query)} >= OF_A_THING

    def patterns(found: "re.Match[str]") -> str:
        held = (
            _set(found[1], FILTERS[name], name, values, narrow=narrow)
            for name, values in given.items()
            if found[1] in FILTERS[name].patterns
            and (name != "kind" or (found[1] == "thing") == of_a_thing)
        )
        return "\n".join(f"  {pattern}" for pattern in held)

    return _MARK.sub(patterns, query)


def _set(of: str, by: Filter, name: str, values: Sequence[Literal], *, narrow: bool) -> str:
    """A pattern with its values; what may fit in several ways still counts once.

    Where another filter leaves few, each of them is tested, instead of finding all that fit: a
    variable that is compared is bound last, a value that is written out is sought first.
    """
    pattern = by.patterns[of].replace("@action@", "@value@")
    terms = values if pattern == by.patterns[of] else tuple(map(node, values))
    several = len(values) > 1 or "|" in pattern
    if several and narrow:
        tests = (f"EXISTS {{ {pattern.replace('@value@', str(value))} }}" for value in terms)
        return f"FILTER({' || '.join(tests)})"
    if narrow and by.kind == "text" and name not in NARROWING:
        variable = f"?f_one_{name}"
        return f"{pattern.replace('@value@', variable)} FILTER({variable} = {terms[0]})"
    if not several:
        return pattern.replace("@value@", str(terms[0]))
    variable = f"?f_one_{name}"
    one_of = f"VALUES {variable} {{ {' '.join(map(str, terms))} }}"
    did, general, rest = pattern.partition("/capar:kindOf @value@")
    if general:  # some actions are soon found, and then what is of one of them
        done = f"?f_done_{name}"
        few = f"{{ SELECT DISTINCT {done} {{ {one_of} {done} capar:kindOf {variable} }} }}"
        return f"{few} {did} {done}{rest}"
    return f"{{ SELECT DISTINCT ?{of} {{ {one_of} {pattern.replace('@value@', variable)} }} }}"
