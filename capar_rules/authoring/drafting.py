"""What a drafted rule needs: the fewest telling conditions, and short examples."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from functools import cache

from capar.model.facts import Fact, Frames, Link, RateMhz, Tag, Touching, program
from capar.model.observation import ObservedLink, Segment
from capar.model.par import UNKNOWN
from capar_rules.borders.numbering import number_borders
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import rule_file, solve, worlds
from capar_rules.engine.syntax import parse, parse_text, split_arguments, towards

Place = tuple[str, int]
"""A segment: its end-effector, and the tick at which it begins."""

Bits = Mapping[Place, frozenset[str]]
"""The conditions that each segment fulfils."""

_CONDITION = re.compile(r"^condition\(Segment\) :- (.+)\.$", re.MULTILINE)


@cache
def conditions() -> tuple[str, ...]:
    """The conditions of which a draft chooses, in the order of preference."""
    text = (rule_file("authoring") / "conditions.lp").read_text(encoding="utf-8")
    return tuple(_CONDITION.findall(text))


def bits_of(facts: Sequence[Fact], rules: Profile) -> Bits:
    """Which conditions each segment fulfils, and which primitives it fits, as ``fits`` conditions.

    Raises:
        RuleError: The rules have a fault.
    """
    heads = {head.signature for each in parse(rules.files) for head in each.heads}
    lines = ["#show _fulfils/2.", "#show _fits/2.", "_fits(Name, Segment) :- fits(Segment, Name)."]
    for number, text in enumerate(conditions()):
        (rule,) = parse_text(f"_fulfils({number}, Segment) :- {text}.")
        if all(atom.signature in heads for each in rule.body for atom in each.atoms):
            lines.append(rule.text)
    numbered = number_borders(facts, crossings_only=rules.crossings_only)
    answer = solve(rules.files, "\n".join([*lines, program((*facts, *numbered))]))
    found: dict[Place, set[str]] = {_place(term): set() for term, *_ in answer.of("segment")}
    for condition, term in answer.of("_fulfils"):
        found[_place(term)].add(conditions()[int(str(condition))])
    for name, term in answer.of("_fits"):
        found[_place(term)].add(fitting(str(name)))
    return {place: frozenset(bits) for place, bits in found.items()}


def fitting(name: str) -> str:
    """The condition that a segment fits a primitive."""
    return f'fits(Segment, "{name}")'


def rule_telling(
    name: str, own: frozenset[str], others: Sequence[frozenset[str]], *, given: Sequence[str] = ()
) -> str:
    """A rule of few conditions that tell a segment from others; empty if none do."""
    rest = [each for each in others if {*given} <= each]
    usable = [each for each in conditions() if each in own]
    chosen, left = distinction(usable, rest)
    if not chosen:
        return ""
    text = f"% Conditions that tell it from {len(rest) - left} of the {len(rest)} others observed"
    text += "\n% that fit the same more general primitive.\n" if given else ".\n"
    if left:
        text += f"% From {left} of them nothing tells it: look for a word that does.\n"
    body = ",\n    ".join([*given, *chosen])
    return f'{text}fits(Segment, "{name}") :-\n    {body}.\n'


def distinction(usable: Sequence[str], others: Sequence[frozenset[str]]) -> tuple[list[str], int]:
    """Conditions that tell a segment from others, and how many of those nothing tells it from.

    Taken in turn is the first that tells it from most of those left; needless ones go.
    """
    chosen: list[str] = []
    left = list(others)
    while usable and (best := max(usable, key=lambda bit: sum(bit not in each for each in left))):
        apart = [each for each in left if best in each]
        if len(apart) == len(left):
            break
        chosen.append(best)
        left = apart
    for bit in list(chosen):
        fewer = {*chosen} - {bit}
        if sum(fewer <= each for each in others) == len(left):
            chosen.remove(bit)
    return [bit for bit in usable if bit in chosen], len(left)


def _place(term: object) -> Place:
    assert isinstance(term, tuple)
    return str(term[1]), int(term[2])


MARGIN = 1
"""How many segments before and after it an excerpt contains."""

Names = tuple[str, ...]
"""What an end-effector does, in order."""


def excerpt(
    facts: Sequence[Fact],
    link: ObservedLink,
    segment: Segment,
    *,
    rules: Profile,
    name: str,
) -> tuple[tuple[Fact, ...], Names] | None:
    """Facts about a segment and its neighbours, as few as name it alike, and the names they give.

    Returns:
        The facts, with frames counted from the excerpt's first one; None if no cut keeps the name.
    """
    at = link.segments.index(segment)
    naming = _naming_rules(rules)
    called = [each.name == name for each in link.segments]
    low, high = 0, len(called)
    if segment.name != name:  # a counter-example ends where one of that name begins
        low = max((n + 1 for n in range(at) if called[n]), default=0)
        high = next((n for n in range(at, high) if called[n]), high)
    for margin in (MARGIN, 2 * MARGIN, len(link.segments)):
        near = link.segments[max(at - margin, low) : min(at + margin + 1, high)]
        wanted = sum(each.name == name for each in near)
        cut = tuple(_cut(facts, link.ee, near[0].first, near[-1].last))

        def told(some: Sequence[Fact], wanted: int = wanted) -> Names | None:
            names = _names(naming, some, rules)
            return names if names.count(name) == wanted else None

        if told(cut) == tuple(each.name for each in near):
            few = _shortened(cut, told)
            return few, told(few) or ()
    return None


def _naming_rules(rules: Profile) -> str:
    """The rules by which segments are cut and named, without those for all else."""
    kept = towards(parse(rules.files), (("named", 2), ("segment", 3)))
    return "\n".join([*(each.text for each in kept), "#show named/2.\n#show segment/3."])


def _names(naming: str, facts: Sequence[Fact], rules: Profile) -> Names:
    """What the one end-effector of an excerpt does, in order."""
    numbered = number_borders(facts, crossings_only=rules.crossings_only)
    (atoms,) = worlds(f"{naming}\n{program((*facts, *numbered))}")
    begins: dict[str, int] = {}
    names: dict[str, str] = {}
    for atom in atoms:
        arguments = split_arguments(atom)
        if atom.startswith("segment("):
            begins[arguments[0]] = int(arguments[1])
        else:
            names.setdefault(arguments[0], arguments[1].strip('"'))
    return tuple(names.get(each, UNKNOWN) for each in sorted(begins, key=begins.__getitem__))


def _cut(facts: Sequence[Fact], ee: str, first: int, last: int) -> Iterator[Fact]:
    """What concerns one end-effector between two frames, which are counted from the first."""
    touches = [each for each in facts if isinstance(each, Touching)]
    held = {each.other for each in touches if each.body == ee and _meets(each, first, last)}
    about = {ee} | held | {each.other for each in touches if each.body in held}
    about |= {each.body for each in touches if each.other in held and each.body in about}
    kept = {(each.body, each.other, each.first) for each in touches if _meets(each, first, last)}
    for fact in facts:
        if isinstance(fact, Frames):
            yield Frames(0, last - first)
        elif isinstance(fact, RateMhz) or not fields(fact):
            yield fact
        elif isinstance(fact, Link):
            if fact.ee == ee:
                yield fact
        elif _bodies(fact) <= about and _meets(fact, first, last, kept):
            yield _shifted(fact, first, last)


def _bodies(fact: Fact) -> set[str]:
    """The bodies of a fact: its texts in fields that name one."""
    named = ("ee", "body", "other", "object", "base", "first_other", "second_other", "sensor")
    return {str(getattr(fact, each)) for each in named if hasattr(fact, each)} - {""}


def _meets(fact: Fact, first: int, last: int, kept: Iterable[tuple[str, str, int]] = ()) -> bool:
    """Whether it holds at some time between the frames; of a contact, whether that one does."""
    if hasattr(fact, "frame"):
        return bool(first <= fact.frame <= last)
    if hasattr(fact, "first") and hasattr(fact, "last"):
        return bool(fact.first < last and fact.last > first)
    if hasattr(fact, "first"):
        return any(since == fact.first for _, _, since in kept)
    return True


def _shifted(fact: Fact, first: int, last: int) -> Fact:
    moved = {
        key: min(max(getattr(fact, key) - first, 0), last - first)
        for key in ("first", "last", "frame")
        if hasattr(fact, key)
    }
    return replace(fact, **moved) if moved else fact


def _shortened(
    facts: tuple[Fact, ...], told: Callable[[Sequence[Fact]], Names | None]
) -> tuple[Fact, ...]:
    """The facts without those kinds that change none of the names."""
    names = told(facts)
    for kind in sorted({type(each).predicate for each in facts} - {*NEEDED}):
        fewer = tuple(each for each in facts if type(each).predicate != kind)
        facts = fewer if told(fewer) == names else facts
    return facts


NEEDED = tuple(each.predicate for each in (Frames, RateMhz, Link, Tag, Touching))
"""Predicates without which an example tells no story."""
