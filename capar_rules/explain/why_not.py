"""Why a segment does not have another name: the fewest changes that would give it that name."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from capar.model.errors import RuleError, UnknownNameError
from capar.model.facts import Fact, program
from capar.model.observation import Segment
from capar_rules.engine.solver import Atom, optima, rule_file, worlds
from capar_rules.engine.syntax import (
    Signature,
    Statement,
    heads_of,
    parse,
    signatures_below,
    split_arguments,
    towards,
)
from capar_rules.explain.explanation import Explainer
from capar_rules.explain.nearest import SCENE
from capar_rules.explain.sentences import Scene
from capar_rules.lint.audit import physics, words_of
from capar_rules.lint.text_checks import known

BEYOND = "Contacts, possession and motion as they were do not settle what it is called."


@dataclass(frozen=True)
class Change:
    """One atom that would have to change."""

    holds: bool
    """Whether the atom would hold; otherwise it would cease to hold."""

    atom: str
    sentence: str


@dataclass(frozen=True)
class Alternative:
    """Changes that together would give the segment another name."""

    name: str
    changes: tuple[Change, ...]
    """Empty if the segment has that name in no possible world; then ``note`` says why."""

    note: str = ""
    """What precedes the changes: that the name fits too, or that the reason lies elsewhere."""

    @property
    def sentence(self) -> str:
        """The whole, as a counterfactual."""
        only = "no more than " if self.note and self.changes else ""
        conditions = " and ".join(each.sentence for each in self.changes)
        would = f"It would be {only}{self.name} if {conditions}." if self.changes else ""
        return f"{self.note} {would}".strip()


def why_not(
    explainer: Explainer, segment: Segment, name: str, *, limit: int = 1
) -> tuple[Alternative, ...]:
    """The smallest changes of what was measured that would give a segment a name.

    First it is proven that without a change the segment keeps its name.

    Args:
        explainer: The explainer of the segment's capture.
        segment: A segment of it.
        name: A name that it does not have.
        limit: Greatest number of equally small answers.

    Returns:
        One for each answer; none if no segment between these borders could be so named.

    Raises:
        UnknownNameError: No rule gives that name.
        RuleError: The segment has that name, or does not follow from these facts and rules.
    """
    base = explainer.base.statements
    primitives = known(base).primitives
    if name not in primitives:
        raise UnknownNameError("primitive", name, primitives)
    if name == segment.name:
        raise RuleError(f"segment {segment.index} of {segment.ee!r} is {name} already")
    text = worlds_around(explainer, segment)
    if not text:
        return (Alternative(name, (), BEYOND),)
    ticks = explainer.ticks(segment)
    term = explainer.term(segment)
    goal = f':- not named({term},"{name}").'
    found = optima(f"{text}\n{goal}", [("changed", 2), ("dominant", 2)], limit=SPARE * limit)
    windows = explainer.windows
    ends = {(segment.ee, ticks[0]): ticks[1]}
    note = _note(segment, name)
    answers: dict[tuple[str, ...], Alternative] = {}
    for atoms in found:
        objects = sorted(str(each[1]) for predicate, each in atoms if predicate == "dominant")
        about = {term: objects[:1]}
        scene = Scene(windows.rate, windows.frames, ends, explainer.names, about, term)
        told = _alternative(name, note, atoms, explainer, scene)
        answers.setdefault(tuple(each.atom for each in told.changes), told)
    told_all = tuple(answers.values())[:limit]
    return told_all or ((Alternative(name, (), note),) if note else ())


SPARE = 3
"""Worlds to find for each answer, as some differ only in their objects."""


def worlds_around(explainer: Explainer, segment: Segment) -> str:
    """The program of counterfactual worlds of a segment.

    Empty if in the world without changes the segment does not have its own name. It is the same
    for every other name, so the explainer keeps it.
    """
    if segment not in explainer.worlds:
        explainer.worlds[segment] = _worlds_around(explainer, segment)
    return explainer.worlds[segment]


def _worlds_around(explainer: Explainer, segment: Segment) -> str:
    base, ticks = explainer.base.statements, explainer.ticks(segment)
    term = explainer.term(segment)
    called = f'named({term},"{segment.name}")' if segment.known else f"unknown({term})"
    for facts in explainer.windows_of(segment.ee, ticks):
        actual = measured(base, facts, segment, ticks)
        text = worlds_of(base, facts, actual, segment, ticks)
        if optima(f"{text}\n:- not {called}.\n:- changed(_,_).", [("changed", 2)]):
            return text
    return ""


def _note(segment: Segment, name: str) -> str:
    """That the other name fits too, if the segment's own name is more specific."""
    if name not in segment.general:
        return ""
    article = "an" if name[0] in "AEIOU" else "a"
    return f"It is {article} {name} too: {segment.name} is more specific."


def _alternative(
    name: str, note: str, atoms: Iterable[Atom], explainer: Explainer, scene: Scene
) -> Alternative:
    changes = []
    for bit, term in (each for predicate, each in atoms if predicate == "changed"):
        predicate, *arguments = map(_text, term) if isinstance(term, tuple) else [str(term)]
        atom = f"{predicate}({','.join(arguments)})" if arguments else predicate
        holds = bit == 1
        told, _ = explainer.base.sentences.say(predicate, arguments, scene, absent=not holds)
        told = told or f"{atom} {'held' if holds else 'did not hold'}"
        changes.append(Change(holds, atom, told))
    return Alternative(name, tuple(sorted(changes, key=lambda each: each.atom)), note)


def _text(term: object) -> str:
    if isinstance(term, tuple):
        return f"{term[0]}({','.join(map(_text, term[1:]))})"
    return str(term)


# The counterfactual worlds of a segment

READ: tuple[Signature, ...] = (("reads", 5), ("holding", 4), ("moved", 2))
BESIDE: Signature = ("read_beside", 5)
"""Contacts at the borders of objects that the end-effector does not possess."""

MOVED: frozenset[Signature] = frozenset((("moves", 2), ("carried_off", 2)))
"""Preconditions of relations that are measured even where the preconditions do not hold."""

BODILY: frozenset[Signature] = frozenset((("figure", 2), ("meets", 5)))
"""Preconditions of relations of the body that the segment is about."""

COURSE: frozenset[Signature] = frozenset(
    (name, 2) for name in ("course", "rises", "comes_down", "sinks", "travels", "stays_near")
)
"""Relations of the course of a body: one choice, counted as one change (changes.lp)."""

MOST_OBJECTS = 5
"""Greatest number of objects that changes may involve, nearest to the segment's own first."""


def counted(words: Iterable[Statement]) -> list[Signature]:
    """The relations, apart from contacts, possession and motion, whose changes are counted."""
    return sorted(heads_of(words) - COURSE - {("member", 3)})


def measured(
    base: Sequence[Statement], facts: Sequence[Fact], segment: Segment, ticks: tuple[int, int]
) -> list[str]:
    """The atoms that hold of a segment, also those that would if it were about other bodies.

    Args:
        base: A rule base.
        facts: Facts around the segment.
        segment: The segment.
        ticks: The numbers of its borders.
    """
    words = words_of(base)
    told = [*counted(words), *sorted(COURSE & heads_of(words))]
    lines = _every_move(segment, ticks)
    plain = _measured(base, facts, (*READ, *SCENE, BESIDE, *told), MOVED, lines)
    bodily = heads_of(word for word in words if signatures_below([word]) & BODILY)
    lines += _every_figure(segment, ticks)
    wider = _measured(base, facts, sorted(bodily & {*told}), {*MOVED, ("figure", 2)}, lines)
    return _bearing(sorted({*plain, *wider}), segment, ticks)


def _measured(
    base: Sequence[Statement],
    facts: Sequence[Fact],
    shown: Sequence[Signature],
    instead: Iterable[Signature],
    lines: Iterable[str],
) -> tuple[str, ...]:
    """The shown atoms that follow from facts, with some relations stated instead of derived."""
    others = [each for each in base if not {head.signature for head in each.heads} & {*instead}]
    rules = towards(others, [*shown, ("contact_at", 5)])
    shows = (f"#show {name}/{arity}." for name, arity in shown)
    text = [*(rule.text for rule in rules), *lines, *shows, program(tuple(facts))]
    (atoms,) = worlds("\n".join(text))[:1]
    return atoms


def _every_move(segment: Segment, ticks: tuple[int, int]) -> list[str]:
    """State that the segment's object moves, and read contacts of objects not possessed."""
    term, ee = f"seg({segment.ee},{ticks[0]})", segment.ee
    own = [
        f"{name}({term},{each}) :- tag({each},mobile)."
        for each in segment.objects[:1]
        for name, _ in sorted(MOVED)
    ]
    return [
        *own,
        f"read_beside({ee},Border,Body,Other,Since) :- contact_at({ee},Body,Other,Since,Border); "
        f"Border = ({ticks[0]};{ticks[1]}); tag(Body,mobile).",
    ]


def _every_figure(segment: Segment, ticks: tuple[int, int]) -> list[str]:
    """State that the segment is about each body that it might be about."""
    term = f"seg({segment.ee},{ticks[0]})"
    return [
        f"figure({term},{segment.ee}).",
        f"figure({term},Object) :- tag(Object,mobile).",
        *(
            f"meets({term},{side},Body,Other,Since) :- "
            f"read_beside({segment.ee},{tick},Body,Other,Since)."
            for side, tick in zip(("start", "end"), ticks, strict=True)
        ),
    ]


def _bearing(atoms: Iterable[str], segment: Segment, ticks: tuple[int, int]) -> list[str]:
    """The atoms about a segment; contacts of possessed objects are among its readings already."""
    term, borders = f"seg({segment.ee},{ticks[0]})", {str(each) for each in ticks}
    kept, beside = [], []
    for atom in atoms:
        arguments = split_arguments(atom)
        if atom.startswith("event(") and "comes_to_rest" not in atom:
            continue
        if atom.startswith("read_beside("):
            beside.append(arguments)
            continue
        own = atom.startswith(("link(", "tag(", "gap(")) or term in arguments
        if own or (arguments[0] == segment.ee and arguments[1:2] and arguments[1] in borders):
            kept.append(atom)
    held = {tuple(split_arguments(each)[1:3]) for each in kept if each.startswith("holding(")}
    kept += [f"reads({','.join(each)})" for each in beside if (each[1], each[2]) not in held]
    return kept


def worlds_of(
    base: Sequence[Statement],
    facts: Sequence[Fact],
    actual: Sequence[str],
    segment: Segment,
    ticks: tuple[int, int],
) -> str:
    """The program of counterfactual worlds, which minimises changes from what was measured."""
    changes, words = _changes(), words_of(base)
    free = [
        each for each in words if not any(head.signature == ("course", 2) for head in each.heads)
    ]
    stated = heads_of([*changes, *words]) | {*SCENE, ("segment", 3), ("tick", 3), ("border", 2)}
    rules = [each for each in base if not {head.signature for head in each.heads} & stated]
    targets = [("named", 2), ("unknown", 1), ("dominant", 2), *sorted(heads_of(words))]
    kept = towards([*rules, *free], targets, given=stated - heads_of(words))
    lines = [_unfolded(each.text) for each in kept]
    lines += [each.text for each in (*changes, *physics())]
    lines += [rule for word in counted(words) for rule in _counting(word)]
    lines += [*_possible(free), *_scene(actual, segment, ticks), "#defined possesses/3."]
    lines += [f"{each}." for each in map(str, facts) if each == "force_transfer"]
    return "\n".join(lines)


@cache
def _changes() -> tuple[Statement, ...]:
    return tuple(
        each
        for each in parse([rule_file("lint/worlds/changes.lp")])
        if each.kind != "comment" and each.place.file.endswith("changes.lp")
    )


def _counting(word: Signature) -> list[str]:
    name, arity = word
    variables = ",".join(f"V{each}" for each in range(arity))
    atom = f"{name}({variables})" if arity else name
    return [
        f"changed(1,{atom}) :- {atom}; not actual({atom}).",
        f"changed(0,{atom}) :- could({atom}); not {atom}; not instead({atom}).",
    ]


def _possible(words: Iterable[Statement]) -> Iterator[str]:
    """For each choice, when an atom of it could hold: when the body of its rule does."""
    for word in words:
        if word.head_kind != "choice":
            continue
        body = "; ".join(literal.text for literal in word.body)
        for head in word.heads:
            if head.signature in heads_of(words) and head.signature != ("tag", 2):
                yield f"could(Atom) :- actual(Atom); Atom = {head.text}; {body}."


def _scene(actual: Sequence[str], segment: Segment, ticks: tuple[int, int]) -> list[str]:
    """The segment as measured: fixed facts, and actual atoms that worlds may change."""
    first, last = ticks
    ee = segment.ee
    fixed = tuple(f"{name}(" for name, _ in SCENE)
    return [
        *(f"{each}." for each in actual if each.startswith(fixed)),
        *(f"actual({each})." for each in actual),
        *(f"{{ {each} }}." for each in actual if each.startswith(("lies_at(", "overlaps("))),
        *(f"candidate({each})." for each in _candidates(actual, segment)),
        f"segment(seg({ee},{first}),{first},{last}).",
        f"border({ee},({first};{last})).",
        f"tick({ee},{first},{segment.first}).",
        f"tick({ee},{last},{segment.last}).",
    ]


def _unfolded(text: str) -> str:
    """The rule with its features read one by one: all combinations are too many to ground."""
    head, sign, body = text.partition(" :- ")
    if not sign or head.startswith("features("):
        return "" if head.startswith("features(") else text
    parts = []
    for each in body.removesuffix(".").split("; "):
        if each.startswith("features("):
            segment, *strings = split_arguments(each)
            sides = ("start", "end", "change", "force")
            parts += [
                f"feature({segment},{side},{string})"
                for side, string in zip(sides, strings, strict=True)
            ]
        else:
            parts.append(each)
    return f"{head} :- {'; '.join(parts)}."


def _candidates(actual: Sequence[str], segment: Segment) -> list[str]:
    """The segment's own objects, those that touch them, then others by name."""
    near = [split_arguments(each)[3] for each in actual if each.startswith("reads(")]
    others = sorted(split_arguments(each)[0] for each in actual if each.startswith("tag("))
    return list(dict.fromkeys([*segment.objects, *sorted(near), *others]))[:MOST_OBJECTS]
