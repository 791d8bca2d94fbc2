"""The rules by which segments have a name, each condition of which a sentence describes."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from capar_rules.engine.syntax import (
    FITS,
    Literal,
    Statement,
    named_node,
    nodes,
    parse_text,
    split_arguments,
)
from capar_rules.explain.sentences import Sentences

MOST_FORMS = 24
"""Greatest number of forms that one rule is unfolded into."""

DEEPEST = 4
"""Greatest number of times that a condition without a sentence is replaced by its definition."""

TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')
"""A text in quotes, or a variable."""

VARIABLE = re.compile(r"_*[A-Z]\w*")

SIDES = ("start", "end", "change", "force")
"""What the four strings of a row of the feature table are about."""


@dataclass(frozen=True)
class Form:
    """A rule for the name after unfolding."""

    rule: Statement
    body: tuple[Literal, ...]
    """Conditions that are counted."""

    joins: tuple[str, ...] = ()
    """Equalities that join the variables of definitions with those of the rule."""


def rules_of(statements: Sequence[Statement], name: str) -> Iterator[Statement]:
    """The rules by which segments fit one name; a row of the feature table is one of them."""
    for each in statements:
        for head in each.heads:
            if head.signature == FITS and nodes(head) == [named_node(name)]:
                yield each
            if head.signature == ("feature_row", 6) and not each.body:
                row, kind, *bits = split_arguments(head.text)
                if row == f'"{name}"':
                    yield replace(_row_rule(row, kind, bits), place=each.place)


def _row_rule(row: str, kind: str, bits: Sequence[str]) -> Statement:
    """The row of the feature table as a rule with a condition for each of its four strings."""
    asked = [f"feature(Segment,{side},{text})" for side, text in zip(SIDES, bits, strict=True)]
    asked += [f"kind(Segment,{kind})"] * (kind != "any")
    return parse_text(f"fits(Segment,{row}) :- {'; '.join(asked)}.")[0]


def forms_of(
    rule: Statement, statements: Sequence[Statement], sentences: Sentences
) -> Sequence[Form]:
    """The rule with each condition that no sentence describes replaced by what defines it."""
    return _forms_of(rule, statements, sentences, of_segment=False, deepest=DEEPEST)


def forms_of_segment(
    rule: Statement, statements: Sequence[Statement], sentences: Sentences
) -> Sequence[Form]:
    """The same, but only conditions of the segment itself are replaced, and more of them."""
    return _forms_of(rule, statements, sentences, of_segment=True, deepest=2 * DEEPEST)


def _forms_of(
    rule: Statement,
    statements: Sequence[Statement],
    sentences: Sentences,
    *,
    of_segment: bool,
    deepest: int,
) -> Sequence[Form]:
    finished: list[Form] = []
    waiting = [(Form(rule, rule.body), 0)]
    while waiting and len(finished) + len(waiting) <= MOST_FORMS:
        form, depth = waiting.pop()
        own = _terms_of_segment(form) if of_segment else None
        at = next((each for each in form.body if _unfolds(each, statements, sentences, own)), None)
        if at is None or depth == deepest:
            finished.append(form)
            continue
        for number, definition in enumerate(_definitions(at, statements)):
            waiting.append((_unfolded(form, at, definition, f"{depth}_{number}"), depth + 1))
    return finished + [form for form, _ in waiting]


def _terms_of_segment(form: Form) -> frozenset[str]:
    """The segment that the rule is about, and what it is equal to."""
    found = set(split_arguments(form.rule.heads[0].text)[:1])
    for one, _, other in (each.partition("=") for each in form.joins):
        found |= {one, other} if found & {one, other} else set()
    return frozenset(found)


def _unfolds(
    literal: Literal,
    statements: Sequence[Statement],
    sentences: Sentences,
    own: frozenset[str] | None,
) -> bool:
    if literal.kind != "atom" or literal.sign or ";" in literal.text:
        return False
    if own is not None and not own & {*split_arguments(literal.text)[:1]}:
        return False
    name, arity = literal.atoms[0].signature
    if sentences.describes(name, arity, as_lacking=own is not None):
        return False
    return bool(_definitions(literal, statements))


def _definitions(literal: Literal, statements: Sequence[Statement]) -> list[Statement]:
    """The rules that define a condition; none if one of them cannot take its place."""
    asked = literal.atoms[0].signature
    found = [each for each in statements if any(one.signature == asked for one in each.heads)]
    plain = all(
        each.head_kind == "atom"
        and len(each.heads) == 1
        and each.body
        and all(one.kind in ("atom", "comparison") for one in each.body)
        for each in found
    )
    return found if plain else []


def _unfolded(form: Form, at: Literal, definition: Statement, mark: str) -> Form:
    """The form with a condition replaced by the body of a rule that defines it."""

    def own(text: str) -> str:
        return TOKEN.sub(lambda one: one[0] if one[0][0] == '"' else f"{one[0]}_{mark}", text)

    heads = split_arguments(own(definition.heads[0].text))
    asked = split_arguments(at.text)
    joins = [f"{one}={other}" for one, other in zip(asked, heads, strict=True) if one != "_"]
    body = [
        replace(
            each,
            text=own(each.text),
            atoms=tuple(replace(one, text=own(one.text)) for one in each.atoms),
        )
        for each in definition.body
    ]
    place = form.body.index(at)
    rest = (*form.body[:place], *body, *form.body[place + 1 :])
    return Form(form.rule, rest, (*form.joins, *joins))
