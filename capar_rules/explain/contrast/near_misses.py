"""What alone keeps a segment from a more specific name, told below the name that it has."""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import count

from capar_rules.engine.syntax import Literal, Signature, Statement, parse_text, split_arguments

FITS = ("fits", 2)
SPECIALISES = ("specialises", 2)
PRECEDES = ("precedes", 2)

_UNNAMED = re.compile(r"(?<=[(,])_(?=[,)])")


def near_misses(statements: Sequence[Statement], name: str) -> Iterator[Statement]:
    """Rules by which an explanation names each condition that alone keeps a segment from a name.

    Of a rule of a more specific primitive one condition is a negation, and all but that one hold:
    what holds instead of it decided that the segment has the more general name. It stands below
    ``kept_from(Segment, Specific)``, which stands below ``named(Segment, Name)``.

    Args:
        statements: A rule base.
        name: The name that the segment has.
    """
    specific = more_specific(statements, name)
    for rule in statements:
        for head in rule.heads:
            if head.signature == FITS:
                segment, other = split_arguments(head.text)
                if other.strip('"') in specific:
                    yield from _of_rule(rule, segment, other, name)


def more_specific(statements: Iterable[Statement], name: str) -> frozenset[str]:
    """The primitives that specialise one, directly or by others."""
    pairs = names_in_pairs(statements, SPECIALISES)
    found = {name}
    while wider := {one for one, general in pairs if general in found} - found:
        found |= wider
    return frozenset(found - {name})


def preceding(statements: Iterable[Statement], name: str) -> frozenset[str]:
    """The primitives that precede one."""
    return frozenset(one for one, other in names_in_pairs(statements, PRECEDES) if other == name)


def names_in_pairs(statements: Iterable[Statement], predicate: Signature) -> list[tuple[str, str]]:
    """The names in the facts of a predicate."""
    found = []
    for rule in statements:
        for head in rule.heads if not rule.body else ():
            if head.signature == predicate:
                one, other = (each.strip('"') for each in split_arguments(head.text))
                found.append((one, other))
    return found


def _of_rule(rule: Statement, segment: str, other: str, name: str) -> Iterator[Statement]:
    """The rules for each negation in the body of one rule."""
    for literal in rule.body:
        if literal.kind == "atom" and literal.sign == 1:
            atom = _named_variables(literal.atoms[0].text)
            body = "; ".join([*_others(rule, literal), atom, f'named({segment},"{name}")'])
            kept = f"kept_from({segment},{other})"
            yield from parse_text(f'also(named({segment},"{name}"),{kept}) :- {body}.')
            yield from parse_text(f"also({kept},{atom}) :- {body}.")


def _others(rule: Statement, literal: Literal) -> Iterator[str]:
    return (each.text for each in rule.body if each is not literal)


def _named_variables(atom: str) -> str:
    """The atom with a name for each unnamed variable, as it stands in a head too."""
    number = count()
    return _UNNAMED.sub(lambda _: f"Unnamed{next(number)}", atom)
