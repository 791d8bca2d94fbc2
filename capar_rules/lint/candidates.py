"""The worlds of the audit in which a user's primitive can fit, by what its rules build on."""

from collections.abc import Iterable, Mapping, Sequence

from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Atom, Statement, split_arguments
from capar_rules.lint.extents import Extents, Worlds, every_world
from capar_rules.lint.segment_terms import FITTED, about_others
from capar_rules.lint.word_places import STRING

ROW = ("feature_row", 6)
SPECIALISES = ("specialises", 2)


def candidates(user: Sequence[Statement], extents: Extents) -> Mapping[str, Worlds]:
    """The worlds in which each primitive of a user can fit, at most.

    A rule fires only where every primitive fits that it asks for; other conditions are left out.
    """
    found: dict[str, Worlds] = {name: frozenset() for rule in user for name in named_by(rule)}
    while True:
        wider = dict(found)
        for rule in user:
            for name in named_by(rule):
                wider[name] |= worlds_of(rule, found, extents)
        if wider == found:
            return found
        found = wider


def worlds_of(rule: Statement, own: Mapping[str, Worlds], extents: Extents) -> Worlds:
    """The worlds in which a rule can fire, at most."""
    worlds = every_world()
    others = about_others(rule, [FITTED])
    for literal in rule.body:
        if literal.text in others:
            continue
        if literal.kind == "atom" and not literal.sign and literal.atoms[0].signature == FITS:
            name = primitive_in(literal.atoms[0])
            if name in own:
                worlds &= own[name]
            elif name in extents.fits:
                worlds &= extents.fits[name]
    return worlds


def named_by(rule: Statement) -> list[str]:
    """The primitives that a rule or a row of the feature table makes fit."""
    heads = [each for each in rule.heads if each.signature in (FITS, ROW)]
    return [name for each in heads if (name := primitive_in(each))]


def primitive_in(atom: Atom) -> str:
    """The primitive in an atom of fits, primitive, feature_row or specialises; empty if none."""
    written = split_arguments(atom.text)[1 if atom.signature == FITS else 0]
    return written.strip('"') if STRING.fullmatch(written) else ""


def generals(name: str, rules: Iterable[Statement]) -> set[str]:
    """The primitives that one specialises, whether directly or through others."""
    pairs = [
        tuple(each.strip('"') for each in split_arguments(head.text))
        for rule in rules
        for head in rule.heads
        if head.signature == SPECIALISES
    ]
    found: set[str] = set()
    while wider := {over for under, over in pairs if under in {name, *found}} - found:
        found |= wider
    return found
