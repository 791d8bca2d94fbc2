"""Primitives of a user that may name the same segments, as far as the audit's worlds can tell.

A condition on measurements that the worlds do not contain is left open: it may hold or not, for
each of the things that it speaks of. Two rules clash if some choice makes both fit; ``brief(S)``
and ``not brief(S)`` keep them apart, and so does ``not fits(Segment, "Other")``.
"""

import re
from collections.abc import Iterator, Sequence

from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Literal, Statement, parse_text, split_arguments
from capar_rules.lint.candidates import ROW, generals, primitive_in
from capar_rules.lint.findings import Finding
from capar_rules.lint.trials import Trial, primitives_of

OVERLAP = ("_overlap", 2)

_VARIABLE = re.compile(r"(?<![\w\"])_*[A-Z]\w*'*")
_ANONYMOUS = re.compile(r"\bAny\d+\b")
_STRING = re.compile(r'"[^"]*"')


def overlaps(trial: Trial, doubtful: set[str]) -> Iterator[Finding]:
    """Primitives of the file that may name segments together with others of the user.

    Args:
        trial: The file, beside the user's others.
        doubtful: Conditions, as written, of which no world has a case though a segment may.
    """
    user = [each for each in (*trial.own, *trial.beside) if each.kind == "rule" and each.heads]
    open_ = {
        literal.text
        for rule in user
        for literal in rule.body
        if rule.heads[0].signature == FITS and _is_open(trial, literal, doubtful)
    }
    pairs = _unordered(trial)
    if not open_ or not pairs:
        return
    names = {name for pair in pairs for name in pair}
    text = "".join(
        _relaxed(rule, name, names, open_) for rule in user for name in _fitted_by(rule, names)
    )
    text += "".join(f'_may(S,"{name}") :- fits(S,"{name}").\n' for name in _by_row(user) & names)
    text += "".join(
        f'_overlap("{name}","{other}") :- _may(S,"{name}"), _may(S,"{other}").\n'
        for name, other in pairs
    )
    found = {row for _, row in trial.ask(parse_text(text), (OVERLAP,), trial.worlds)}
    words = ", ".join(sorted({_ANONYMOUS.sub("_", each) for each in open_}))
    for name, other in sorted(pair for pair in pairs if pair in found):
        yield Finding(
            trial.names[name], "ambiguous",
            f"{name} and {other} may name the same segments: what keeps them apart, if anything "
            f"does, are conditions that the worlds of the audit do not contain ({words}).",
            f'If {name} is a kind of {other}, say specialises("{name}", "{other}"); if not, add '
            f'not fits(Segment, "{other}") to {name}.',
        )  # fmt: skip


def _unordered(trial: Trial) -> list[tuple[str, str]]:
    """Each primitive of the file with each other of the user that it may meet."""
    rules = [*trial.own, *trial.joined.rules]
    others = {name: generals(name, rules) for name in primitives_of(trial.beside)}
    return [
        (name, other)
        for name in trial.names
        for other in others
        if other not in trial.generals[name]
        and name not in others[other]
        and trial.reach([name]) & trial.reach([other])
    ]


def _is_open(trial: Trial, literal: Literal, doubtful: set[str]) -> bool:
    if literal.text in doubtful:
        return True
    named = any(atom.signature == FITS for atom in literal.atoms)
    return not named and bool(trial.measured_below(atom.signature for atom in literal.atoms))


def _fitted_by(rule: Statement, names: set[str]) -> list[str]:
    heads = [each for each in rule.heads if each.signature == FITS]
    return [name for each in heads if (name := primitive_in(each)) in names and rule.body]


def _by_row(rules: Sequence[Statement]) -> set[str]:
    return {primitive_in(head) for rule in rules for head in rule.heads if head.signature == ROW}


def _relaxed(rule: Statement, name: str, names: set[str], open_: set[str]) -> str:
    """A rule of fits with open conditions chosen freely, and conditions without values left out."""
    segment = split_arguments(rule.heads[0].text)[0]
    plain = [each for each in rule.body if each.kind == "atom" and each.text not in open_]
    positive = [_about_names(each, names) for each in plain if not each.sign]
    base = [f"segment({segment},_,_)", *positive]
    bound = _bound(base, rule)
    body, choices = [*base, *_equalities(rule, bound)], ""
    for literal in rule.body:
        if literal.text in open_ and literal.kind == "atom":
            atom = _free(literal, bound)
            body.append(f"not {atom}" if literal.sign == 1 else atom)
            choices += f"{{ {atom} }} :- {'; '.join([*base, *_equalities(rule, bound)])}.\n"
        elif _is_test(literal) and literal.text not in open_ and _variables(literal.text) <= bound:
            body.append(_about_names(literal, names))
    return f'{choices}_may({segment},"{name}") :- {"; ".join(body)}.\n'


def _is_test(literal: Literal) -> bool:
    """Whether it gives no variable a value: a comparison or a negated atom."""
    return literal.kind == "comparison" or (literal.kind == "atom" and bool(literal.sign))


def _about_names(literal: Literal, names: set[str]) -> str:
    """A condition on a primitive of the user asks whether it may fit."""
    atom = literal.atoms[0] if literal.atoms else None
    if atom is not None and atom.signature == FITS and primitive_in(atom) in names:
        return re.sub(r"\bfits\(", "_may(", literal.text)
    return literal.text


def _bound(conditions: Sequence[str], rule: Statement) -> set[str]:
    """The variables that have values, by conditions or by equations over those that do."""
    bound = {name for each in conditions for name in _variables(each)}
    while (
        wider := {
            name
            for left, right in _equations(rule)
            for name, other in ((left, right), (right, left))
            if _variables(other) <= bound and _VARIABLE.fullmatch(name)
        }
        - bound
    ):
        bound |= wider
    return bound


def _equations(rule: Statement) -> Iterator[tuple[str, str]]:
    for literal in rule.body:
        sides = literal.text.split(" = ")
        if literal.kind == "comparison" and len(sides) == 2 and not literal.sign:
            yield sides[0], sides[1]


def _equalities(rule: Statement, bound: set[str]) -> list[str]:
    texts = [f"{left} = {right}" for left, right in _equations(rule)]
    return [each for each in texts if _variables(each) <= bound]


def _free(literal: Literal, bound: set[str]) -> str:
    """A condition as a free atom, of what has values; what has none is any."""
    atom = literal.atoms[0]
    arguments = [
        each if _variables(each) <= bound and each != "_" else "any"
        for each in split_arguments(atom.text)
    ]
    inside = f"({','.join(arguments)})" if atom.signature[1] else ""
    return f"_open_{atom.signature[0]}{inside}"


def _variables(text: str) -> set[str]:
    return set(_VARIABLE.findall(_STRING.sub("", text)))
