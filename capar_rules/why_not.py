"""Why a segment has not another name: the fewest changes that would have given it that name."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from capar.model.errors import RuleError, UnknownNameError
from capar.model.facts import Fact, program
from capar.model.observation import Segment
from capar_rules.auditing import physics, words_of
from capar_rules.engine import rule_file
from capar_rules.explaining import Explainer
from capar_rules.searching import optima, worlds
from capar_rules.sentences import Clock
from capar_rules.slicing import heads_of, towards
from capar_rules.statics import known
from capar_rules.syntax import Signature, Statement, parse, split_arguments

READ: tuple[Signature, ...] = (("reads", 5), ("holding", 4), ("moved", 2))
SCENE: tuple[Signature, ...] = (("link", 3), ("tag", 2), ("gap", 4), ("lifted", 2))

MOST_OBJECTS = 5
"""So many objects a change may speak of, nearest to the segment's own first."""


@dataclass(frozen=True)
class Change:
    """One thing that would have been otherwise."""

    holds: bool
    """Whether it would hold that did not, or else fail that did."""

    atom: str
    sentence: str


@dataclass(frozen=True)
class Alternative:
    """Changes that together would have made the segment what it is not."""

    name: str
    changes: tuple[Change, ...]

    @property
    def sentence(self) -> str:
        """The whole, as a counterfactual."""
        return f"It would be {self.name} {' and '.join(each.sentence for each in self.changes)}."


def why_not(
    explainer: Explainer, segment: Segment, name: str, *, limit: int = 1
) -> tuple[Alternative, ...]:
    """The smallest changes of what was read that would give a segment a name.

    Args:
        explainer: Of the segment's capture.
        segment: A segment of it.
        name: The name that it has not.
        limit: How many equally small answers to give, at most.

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
    ticks = explainer.ticks(segment)
    facts = next(iter(explainer.windows_of(segment.ee, ticks)))
    words = words_of(base)
    actual = _actual(base, facts, words, segment, ticks)
    text = _program(base, words, facts, actual, segment, ticks, name)
    found = optima(text, [("changed", 2)], limit=limit)
    clock = Clock(
        explainer.windows.rate, explainer.windows.frames, {(segment.ee, ticks[0]): ticks[1]}
    )
    return tuple(_alternative(name, each, explainer, clock) for each in found)


def _actual(
    base: Sequence[Statement],
    facts: Sequence[Fact],
    words: Sequence[Statement],
    segment: Segment,
    ticks: tuple[int, int],
) -> list[str]:
    """What the rules read of the segment, as atoms."""
    shown = [*READ, *SCENE, *_counted(words)]
    sliced = towards(base, shown)
    lines = [each.text for each in sliced] + [f"#show {name}/{arity}." for name, arity in shown]
    (atoms,) = worlds("\n".join([*lines, program(tuple(facts))]))[:1]
    term, borders = f"seg({segment.ee},{ticks[0]})", {str(each) for each in ticks}
    kept = []
    for atom in atoms:
        arguments = split_arguments(atom)
        if atom.startswith("event(") and "comes_to_rest" not in atom:
            continue
        own = atom.startswith(("link(", "tag(", "gap(")) or term in arguments
        if own or (arguments[0] == segment.ee and arguments[1:2] and arguments[1] in borders):
            kept.append(atom)
    return kept


def _counted(words: Iterable[Statement]) -> list[Signature]:
    return sorted(heads_of(words) - {("course", 2), ("member", 3)})


def _program(
    base: Sequence[Statement],
    words: Sequence[Statement],
    facts: Sequence[Fact],
    actual: Sequence[str],
    segment: Segment,
    ticks: tuple[int, int],
    name: str,
) -> str:
    """The rules over what might have been read, with the fewest changes from what was."""
    changes = [
        each
        for each in parse([rule_file("audit") / "changes.lp"])
        if each.kind != "comment" and each.place.file.endswith("changes.lp")
    ]
    stated = heads_of([*changes, *words]) | {*SCENE, ("segment", 3), ("tick", 3), ("border", 2)}
    rules = [each for each in base if not {head.signature for head in each.heads} & stated]
    targets = [("named", 2), *_counted(words)]
    kept = towards([*rules, *words], targets, given=stated - heads_of(words))
    lines = [_unfolded(each.text) for each in kept]
    lines += [each.text for each in (*changes, *physics())]
    lines += [rule for word in _counted(words) for rule in _counting(word)]
    lines += [*_scene(actual, segment, ticks), "#defined possesses/3."]
    lines += [f"{each}." for each in map(str, facts) if each == "force_transfer"]
    lines.append(f':- not named(seg({segment.ee},{ticks[0]}),"{name}").')
    return "\n".join(lines)


def _scene(actual: Sequence[str], segment: Segment, ticks: tuple[int, int]) -> list[str]:
    """The segment as it was: what cannot have been otherwise, and what might."""
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


def _counting(word: Signature) -> list[str]:
    name, arity = word
    variables = ",".join(f"V{each}" for each in range(arity))
    atom = f"{name}({variables})" if arity else name
    return [
        f"changed(1,{atom}) :- {atom}; not actual({atom}).",
        f"changed(0,{atom}) :- actual({atom}); not {atom}.",
    ]


def _unfolded(text: str) -> str:
    """A rule that reads the four features one by one: together they are too many to ground."""
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


def _alternative(
    name: str, atoms: Iterable[tuple[str, tuple[object, ...]]], explainer: Explainer, clock: Clock
) -> Alternative:
    changes = []
    for _, (bit, term) in atoms:
        predicate, *arguments = map(_text, term) if isinstance(term, tuple) else [str(term)]
        mood = "had" if bit == 1 else "had not"
        told = explainer.base.sentences.tell(predicate, arguments, clock, mood=mood)
        atom = f"{predicate}({','.join(arguments)})" if arguments else predicate
        plainly = f"had it {'not ' * (bit != 1)}been so that {atom}"
        changes.append(Change(bit == 1, atom, told or plainly))
    return Alternative(name, tuple(sorted(changes, key=lambda each: each.atom)))


def _text(term: object) -> str:
    if isinstance(term, tuple):
        return f"{term[0]}({','.join(map(_text, term[1:]))})"
    return str(term)
