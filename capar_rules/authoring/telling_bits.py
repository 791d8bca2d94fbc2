"""The fewest conditions that tell one segment from others: a minimal hitting set, by the solver."""

import re
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from capar.model.facts import Fact, program
from capar_rules.borders.border_numbers import number_borders
from capar_rules.engine.profiles import Profile
from capar_rules.engine.search import optima
from capar_rules.engine.solver import rule_file, solve
from capar_rules.engine.syntax import parse, parse_text

Place = tuple[str, int]
"""A segment: its end-effector, and the tick at which it begins."""

Bits = Mapping[Place, frozenset[str]]
"""The conditions that each segment fulfils."""

_CONDITION = re.compile(r"^condition\(Segment\) :- (.+)\.$", re.MULTILINE)


@dataclass(frozen=True)
class Distinction:
    """The conditions that tell a segment from others, and those that were left out."""

    chosen: tuple[str, ...]
    """The fewest that tell it from each that can be told apart; of equals those listed first."""

    common: tuple[str, ...]
    """Left out: every other segment fulfils them too."""

    spare: tuple[str, ...]
    """Left out: whatever they tell it from, the chosen ones do."""

    others: int
    """From how many segments it is told."""

    alike: int
    """How many of them nothing tells it from."""


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


def written_rule(name: str, found: Distinction, given: Sequence[str]) -> str:
    """The rule of a distinction, with what it is told from and what was left out in a comment."""
    body = ",\n    ".join([*given, *found.chosen])
    told = found.others - found.alike
    text = f"% The fewest conditions that tell it from {told} of the {found.others} others observed"
    text += "\n% that fit the same more general primitive.\n" if given else ".\n"
    if found.alike:
        text += f"% From {found.alike} of them nothing tells it: look for a word that does.\n"
    if found.common:
        text += _left_out("all of them fulfil it too", found.common)
    if found.spare:
        text += _left_out("it tells apart none that these do not", found.spare)
    return f'{text}fits(Segment, "{name}") :-\n    {body}.\n'


def _left_out(reason: str, bits: Sequence[str]) -> str:
    listed = textwrap.fill(
        "  ".join(each.replace(" ", "\0") for each in bits),
        96, initial_indent="%   ", subsequent_indent="%   ", break_long_words=False,
    ).replace("\0", " ")  # fmt: skip
    return f"% Left out, as {reason}:\n{listed}\n"


def distinction(
    own: frozenset[str], others: Sequence[frozenset[str]], *, given: Sequence[str] = ()
) -> Distinction:
    """The fewest conditions of one segment that tell it from others.

    At least one is chosen where any tells it from another.

    Args:
        own: What the segment fulfils.
        others: What the others fulfil.
        given: Conditions that the rule has anyway: only those who fulfil them are to be told apart.
    """
    rest = [each for each in others if {*given} <= each]
    usable = [each for each in conditions() if each in own]
    telling = {bit: [at for at, each in enumerate(rest) if bit not in each] for bit in usable}
    wider = {
        bit
        for bit in usable
        if telling[bit] or (not _implied(bit, given) and any(bit not in each for each in others))
    }
    told = {at for places in telling.values() for at in places}
    lines = [f"bit({number}). " for number, bit in enumerate(usable) if bit in wider]
    lines += [f"tells({number},{at})." for number, bit in enumerate(usable) for at in telling[bit]]
    lines += [f"other({at})." for at in sorted(told)]
    (best,) = optima("\n".join([*lines, _PROGRAM]), [("chosen", 1)]) if wider else [frozenset()]
    chosen = sorted(int(str(number)) for _, (number,) in best)
    left = [bit for number, bit in enumerate(usable) if number not in chosen]
    return Distinction(
        tuple(usable[number] for number in chosen),
        tuple(bit for bit in left if not telling[bit]),
        tuple(bit for bit in left if telling[bit]),
        len(rest),
        len(rest) - len(told),
    )


OF_FEATURES = ("possessing(", "touched_at(", "occupied(", "free(", "kind(")
"""Prefixes of conditions that the features of a primitive may imply."""


def _implied(bit: str, given: Sequence[str]) -> bool:
    return any(given) and bit.startswith(OF_FEATURES)


_PROGRAM = """
#defined bit/1. #defined tells/2. #defined other/1.
{ chosen(Number) : bit(Number) }.
told(Other) :- chosen(Number), tells(Number, Other).
:- other(Other), not told(Other).
:- not chosen(_), bit(_).
#minimize { 1@2, Number : chosen(Number) }.
#minimize { Number@1, Number : chosen(Number) }.
"""


def _place(term: object) -> Place:
    assert isinstance(term, tuple)
    return str(term[1]), int(term[2])
