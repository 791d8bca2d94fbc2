"""Which rule for another name comes nearest to holding, and which of its conditions do not hold."""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

from capar_rules.engine.syntax import (
    FITS,
    Literal,
    Signature,
    Statement,
    named_node,
    nodes,
    nodes_read,
    parse_text,
    reached,
    split_arguments,
    stated,
)
from capar_rules.explain.conditions import COMPARED, Condition, Conditions
from capar_rules.explain.sentences import RuleBase, Sentences, pairs_of, parsed

MOST_FORMS = 24
"""Greatest number of forms that one rule is unfolded into."""

DEEPEST = 8
"""Greatest number of times that a condition without a sentence is replaced by its definition."""

MOST_FAILING = 2
"""A name whose rules all lack more conditions is not near."""

MOST_ASKED = 4
"""The same of a name that a user asks about."""

SHARES = {"not": 0.6, "contact_at": 0.4, "no_contact": 0.45, "moved": 0.4, "stays": 0.4}
"""How near to holding conditions are taken to be that are not measured, by their predicate [1]."""

LEAST_SHARE = 0.0
"""The same of all other conditions [1]."""

SCENE: tuple[Signature, ...] = (("link", 3), ("tag", 2), ("gap", 4), ("lifted", 2))
"""Conditions of what bodies are and where they were before, which could not be otherwise."""

SIDES = ("start", "end", "change", "force")
"""What the four strings of a row of the feature table are about."""

FEATURE: Signature = ("feature", 3)
SAME_STRINGS = 3
"""So many of the four strings of a row are the same in a neighbouring row."""

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')
_VARIABLE = re.compile(r"_*[A-Z]\w*")
_COMPOUND = re.compile(r"(\w*)(\(.*\))", re.DOTALL)

Bound = Mapping[str, str]
"""What the variables of a rule stand for."""


@dataclass(frozen=True)
class NearRule:
    """A rule that would give a segment a name, and what keeps it from holding."""

    name: str
    rule: str
    """File and line of the rule."""

    failing: tuple[Condition, ...]
    """The conditions that it asks for and that do not hold; empty if all hold."""

    @property
    def sentence(self) -> str:
        """What would have to hold."""
        if not self.failing:
            return f"{self.name} ({self.rule}) fits too, and a more specific name precedes it"
        return f"{self.name} ({self.rule}) would need that {' and '.join(self.needed)}"

    @property
    def needed(self) -> list[str]:
        """The conditions with the values that fail."""
        found = []
        for each in self.failing:
            values = [f"{one.value_text}, not {one.limit_text}"
                      for one in each.measures if one.limit]  # fmt: skip
            found.append(each.sentence + f" ({'; '.join(values)})" * bool(values))
        return list(dict.fromkeys(found))

    @property
    def vague(self) -> bool:
        """Whether a condition that fails is about no body in particular."""
        return any("_" in parsed(one.atom)[1] for one in self.failing)

    @property
    def order(self) -> tuple[int, float, str, str]:
        """The less, the nearer: by how many conditions fail, and by how much."""
        return len(self.failing), -round(self.nearness, 3), self.name, self.rule

    @property
    def nearness(self) -> float:
        """How near the furthest condition comes to holding: a share."""
        shares = []
        for each in self.failing:
            known = SHARES.get(re.split(r"\W", each.atom)[0], LEAST_SHARE)
            measured = [one.nearness for one in each.measures if one.limit]
            shares.append(min(measured, default=known))
        return min(shares, default=1.0)


@dataclass(frozen=True)
class Form:
    """A rule for a name, unfolded until a sentence describes each condition."""

    rule: Statement
    body: tuple[Literal, ...]
    joins: tuple[str, ...] = ()
    """Equalities that join the variables of definitions with those of the rule."""


def nearest_rules(
    base: RuleBase, names: Iterable[str], conditions: Conditions, *, most: int = MOST_FAILING
) -> list[NearRule]:
    """The rules for some names of which the fewest conditions fail, nearest first.

    Args:
        base: The rules.
        names: The names; for each the nearest of its rules is given.
        conditions: An answer that has whatever the rules read.
        most: Rules that lack more conditions are left out.
    """
    segment = conditions.scene.own
    forms = {name: forms_of(base, name) for name in names}
    read = {
        atom.signature[0] for found in forms.values() for form in found
        for literal in form.body for atom in literal.atoms
    } | {FITS[0], FEATURE[0]}  # fmt: skip
    derived = conditions.derived
    facts = (str(each) for each in derived.facts if type(each).predicate in read)
    atoms = _Atoms((*facts, *derived.atoms(read)))
    matches = [
        (len(match[0]), name, form.rule.place, match)
        for name, every in forms.items()
        for form in every
        if (match := atoms.nearest(form, segment, most, base.sentences)) is not None
    ]
    found: dict[str, NearRule] = {}
    for _, name, place, match in sorted(matches, key=lambda one: one[:3]):
        needed = tuple(
            one
            for literal in match[0]
            for one in _needed(base, literal, match[1], atoms, conditions)
        )
        near = NearRule(name, f"{Path(place.file).name}:{place.line}", needed)
        known = found.get(name)
        if (
            len(needed) <= most
            and all(one.sentence for one in needed)
            and (known is None or near.order < known.order)
        ):
            found[name] = near
    return sorted(found.values(), key=lambda one: one.order)


def _needed(
    base: RuleBase, literal: Literal, bound: Bound, atoms: "_Atoms", conditions: Conditions
) -> Iterator[Condition]:
    """What would have to hold for a condition that fails."""
    atom = _valued(literal.atoms[0].text, bound)
    atom = _TOKEN.sub(lambda found: found[0] if found[0].startswith('"') else "_", atom)
    if literal.atoms[0].signature == FEATURE:
        segment, side, wanted = split_arguments(atom)
        yield from _bits(segment, side, wanted, atoms, conditions)
    elif literal.atoms[0].signature == FITS and not literal.sign:
        general = split_arguments(atom)[1].strip('"')
        (near,) = nearest_rules(base, [general], conditions) or [NearRule(general, "", ())]
        yield from near.failing or [conditions.needed(atom)]
    elif literal.sign:
        yield conditions.needed(f"not {atoms.matching(literal, bound) or atom}")
    else:
        yield conditions.needed(atom)


def _bits(
    segment: str, side: str, wanted: str, atoms: "_Atoms", conditions: Conditions
) -> Iterator[Condition]:
    """The contacts and motions by which a string of features differs from the wanted one."""
    own = next((row[2] for row in atoms.rows[FEATURE] if row[:2] == (segment, side)), "")
    own, wanted = own.strip('"'), wanted.strip('"')
    scene, hand = conditions.scene, segment[4:].partition(",")[0]
    if len(own) != len(wanted):
        yield Condition("", f'feature({segment},{side},"{wanted}")', (), ())
        return
    form = "pairs" if side in ("start", "end") else "things"
    pairs = pairs_of(segment, scene.objects.get(segment, ()), wanted, form)
    first = segment[4:-1].split(",")[1]
    ticks = {"start": first, "end": str(scene.ends.get((hand, int(first)), 0))}
    for have, want, bodies in zip(own, wanted, pairs, strict=True):
        if have == want:
            continue
        if form == "pairs":
            yield conditions.needed(
                f"contact_at({hand},{','.join(bodies)},0,{ticks[side]})"
                if want == "1"
                else f"no_contact({segment},{side},{','.join(bodies)})"
            )
        elif side == "change":
            atoms_of = {"1": f"moved({bodies[0]},{segment})", "0": f"stays({bodies[0]},{segment})"}
            yield conditions.needed(atoms_of[want])
        else:
            yield conditions.needed(f"{'not ' * (want == '0')}struck({segment},{bodies[0]})")


# Names next to each other


def overruling(statements: Sequence[Statement], name: str) -> list[str]:
    """The primitives that specialise one, directly or by others, or that precede it."""
    below = [(general, one) for one, general in stated(statements, ("specialises", 2))]
    before = {one for one, other in stated(statements, ("precedes", 2)) if other == name}
    return sorted(reached(name, below) - {name} | before)


@lru_cache(maxsize=256)
def neighbours(base: RuleBase, name: str) -> list[str]:
    """The names next to one.

    What specialises it or the same as it, what excludes it, and what has a row of the feature
    table that differs in one string.
    """
    above, rows, asked = _names(base)
    own = above.get(name, set())
    below = {one for one, general in above.items() if name in general}
    excluded = {(signature, 1 - sign) for signature, sign in asked.get(name, ())}
    alike = {
        other
        for other, theirs in rows.items()
        if any(
            list(map(len, one)) == list(map(len, row))
            and sum(map(str.__eq__, one, row)) == SAME_STRINGS
            for one in rows.get(name, ())
            for row in theirs
        )
    }
    found = below | alike | {one for one, general in above.items() if own & general}
    found |= {one for one, conditions in asked.items() if conditions & excluded}
    for other in alike:
        under = {one for one, general in above.items() if other in general}
        found |= under if under & below else set()
    return sorted(found - {name, *own})


@lru_cache(maxsize=8)
def _names(
    base: RuleBase,
) -> tuple[
    dict[str, set[str]], dict[str, list[tuple[str, ...]]], dict[str, set[tuple[Signature, int]]]
]:
    """What each primitive specialises, its rows of features, and the conditions it asks for."""
    pairs = stated(base.statements, ("specialises", 2))
    names = [name for (name,) in stated(base.statements, ("primitive", 1))]
    rows: dict[str, list[tuple[str, ...]]] = defaultdict(list)
    for name, _, *bits in stated(
        (one for one in base.statements if not one.body), ("feature_row", 6)
    ):
        rows[name].append(tuple(bits))
    asked = {
        name: {
            (each.atoms[0].signature, each.sign)
            for rule in rules_of(base.statements, name)
            for each in rule.body
            if each.kind == "atom" and each.atoms[0].signature not in (FITS, FEATURE)
        }
        for name in names
    }
    return {name: reached(name, pairs) for name in names}, rows, asked


@lru_cache(maxsize=256)
def conditions_of(base: RuleBase, names: tuple[str, ...]) -> frozenset[Signature]:
    """The predicates, and nodes of names, that rules for names ask for."""
    named = {head.signature for each in base.statements for head in each.heads}
    return frozenset(
        node
        for name in names
        for form in forms_of(base, name)
        for literal in form.body
        for atom in literal.atoms
        for node in nodes_read(atom, named)
        if node != FITS
    )


# The rules for a name, each condition of which a sentence describes


def rules_of(statements: Sequence[Statement], name: str) -> Iterator[Statement]:
    """The rules by which segments fit one name; a row of the feature table is one of them."""
    for each in statements:
        for head in each.heads:
            if head.signature == FITS and nodes(head) == [named_node(name)]:
                yield each
            if head.signature == ("feature_row", 6) and not each.body:
                row, kind, *bits = split_arguments(head.text)
                if row == f'"{name}"':
                    asked = [
                        f"feature(Segment,{side},{text})"
                        for side, text in zip(SIDES, bits, strict=True)
                    ]
                    asked += [f"kind(Segment,{kind})"] * (kind != "any")
                    rule = parse_text(f"fits(Segment,{row}) :- {'; '.join(asked)}.")[0]
                    yield replace(rule, place=each.place)


@lru_cache(maxsize=512)
def forms_of(base: RuleBase, name: str) -> tuple[Form, ...]:
    """The rules for a name, unfolded until a sentence describes each condition of the segment."""
    found: list[Form] = []
    for rule in rules_of(base.statements, name):
        finished: list[Form] = []
        waiting = [(Form(rule, rule.body), 0)]
        while waiting and len(finished) + len(waiting) <= MOST_FORMS:
            form, depth = waiting.pop()
            own = set(split_arguments(rule.heads[0].text)[:1])  # the segment that it is about
            for one, _, other in (each.partition("=") for each in form.joins):
                own |= {one, other} if own & {one, other} else set()
            at = next(
                (
                    each
                    for each in form.body
                    if each.kind == "atom"
                    and not each.sign
                    and ";" not in each.text
                    and own & {*split_arguments(each.text)[:1]}
                    and each.atoms[0].signature not in (FITS, FEATURE)
                    and not base.sentences.describes(each.atoms[0].signature)
                    and _definitions(each, base.statements)
                ),
                None,
            )
            if at is None or depth == DEEPEST:
                finished.append(form)
                continue
            for number, definition in enumerate(_definitions(at, base.statements)):
                waiting.append((_unfolded(form, at, definition, f"{depth}_{number}"), depth + 1))
        found += [*finished, *(form for form, _ in waiting)]
    return tuple(found)


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
        return _TOKEN.sub(lambda one: one[0] if one[0][0] == '"' else f"{one[0]}_{mark}", text)

    heads = split_arguments(own(definition.heads[0].text))
    joins = zip(split_arguments(at.text), heads, strict=True)
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
    return Form(form.rule, rest, (*form.joins, *(f"{a}={b}" for a, b in joins if a != "_")))


# Matching a rule with what holds, by unification


class _Atoms:
    """Atoms that hold, by predicate."""

    def __init__(self, atoms: Iterable[str]) -> None:
        self.rows: dict[Signature, list[tuple[str, ...]]] = defaultdict(list)
        for atom in atoms:
            parts = _parts(atom)
            self.rows[atom.partition("(")[0], len(parts)].append(parts)

    def nearest(
        self, form: Form, segment: str, most: int, sentences: Sentences
    ) -> tuple[tuple[Literal, ...], Bound] | None:
        """The fewest conditions of a rule that fail, and what its variables stand for."""
        if any(not _plain(each) for each in form.body):
            return None
        failable = {id(each) for each in form.body if _may_fail(each, sentences)}
        hopeless = [
            each
            for each in form.body
            if _binds(each) and not self.rows.get(each.atoms[0].signature)
        ]
        if len(hopeless) > most or any(id(each) not in failable for each in hopeless):
            return None
        joins = [each.partition("=")[::2] for each in form.joins]
        start = dict(_unified(split_arguments(form.rule.heads[0].text)[0], segment, {}) or {})
        for allowed in range(len(hopeless), most + 1):
            found = next(self._matches(form.body, start, joins, failable, allowed), None)
            if found is not None:
                return found
        return None

    def matching(self, literal: Literal, bound: Bound) -> str:
        """An atom that a condition, taken without its negation, is met by; empty if none is."""
        atom = literal.atoms[0]
        wanted = _parts(atom.text)
        for row in self.rows.get(atom.signature, ()):
            if _all_unified(wanted, row, bound) is not None:
                return f"{atom.signature[0]}({','.join(row)})" if row else atom.signature[0]
        return ""

    def _matches(
        self,
        body: Sequence[Literal],
        bound: dict[str, str],
        joins: Sequence[tuple[str, str]],
        failable: set[int],
        allowed: int,
    ) -> Iterator[tuple[tuple[Literal, ...], dict[str, str]]]:
        """Ways to match conditions in turn, of which at most so many fail.

        Positive conditions come first, as they bind the variables of the others.
        """
        joined = _joined(bound, joins)
        if joined is None:
            return
        if not body:
            yield (), joined
            return
        literal = next((each for each in body if _binds(each)), body[0])
        rest = [each for each in body if each is not literal]
        for way in list(self._ways(literal, joined)):
            yield from self._matches(rest, way, joins, failable, allowed)
        if allowed and id(literal) in failable:
            for failing, way in self._matches(rest, joined, joins, failable, allowed - 1):
                yield (literal, *failing), way

    def _ways(self, literal: Literal, bound: dict[str, str]) -> Iterator[dict[str, str]]:
        """What the variables stand for where a condition holds."""
        if literal.kind == "comparison":
            if _compares(literal.text, bound):
                yield bound
            return
        atom = literal.atoms[0]
        wanted = _parts(atom.text)
        ways = (
            way
            for row in self.rows.get(atom.signature, ())
            if (way := _all_unified(wanted, row, bound)) is not None
        )
        if not literal.sign:
            yield from ways
        elif next(ways, None) is None:
            yield bound


def _may_fail(literal: Literal, sentences: Sentences) -> bool:
    """Whether a condition could be otherwise: not what a body is."""
    signature = literal.atoms[0].signature if literal.kind == "atom" else SCENE[0]
    if signature in SCENE:
        return False
    return bool(literal.sign) or signature == FEATURE or sentences.describes(signature)


def _valued(text: str, bound: Bound) -> str:
    """A text with what its variables stand for."""
    if text in bound:
        return bound[text]
    return _TOKEN.sub(lambda found: bound.get(found[0], found[0]), text)


def _plain(literal: Literal) -> bool:
    """Whether the search can judge a condition."""
    if literal.kind == "comparison":
        return bool(re.fullmatch(r"\w+\s*(=|!=|<=|>=|<|>)\s*\w+", literal.text))
    return literal.kind == "atom" and literal.sign < 2


def _binds(literal: Literal) -> bool:
    return literal.kind == "atom" and not literal.sign


def _joined(bound: dict[str, str], joins: Sequence[tuple[str, str]]) -> dict[str, str] | None:
    """The bindings with what equalities of two terms add; None if those do not hold."""
    for _ in range(len(joins) + 1):
        before = len(bound)
        for one, other in joins:
            first, second = _valued(one, bound), _valued(other, bound)
            way = _unified(first, second, bound) if _ground(second) else None
            if way is None and _ground(first):
                way = _unified(second, first, bound)
            if way is None and _ground(first) and _ground(second):
                return None
            bound = way if way is not None else bound
        if len(bound) == before:
            break
    return bound


@lru_cache(maxsize=1 << 14)
def _ground(text: str) -> bool:
    words = re.findall(r'"[^"]*"|\w+', text)
    return not any(_VARIABLE.fullmatch(each) for each in words if each != "_")


def _unified(pattern: str, text: str, bound: Bound) -> dict[str, str] | None:
    """The bindings under which a pattern is a text; None if there are none."""
    if _is_variable(pattern):
        known = bound.get(pattern, text)
        return {**bound, pattern: text} if known == text else None
    if pattern in ("_", text):
        return dict(bound)
    compound, other = _COMPOUND.fullmatch(pattern), _COMPOUND.fullmatch(text)
    if compound and not compound[1] and ";" in pattern:
        ways = (_unified(each.strip(), text, bound) for each in pattern[1:-1].split(";"))
        return next((way for way in ways if way is not None), None)
    if compound and other and other[1] == compound[1]:
        return _all_unified(_parts(pattern), _parts(text), bound)
    return None


def _all_unified(
    patterns: Sequence[str], texts: Sequence[str], bound: Bound
) -> dict[str, str] | None:
    """The bindings under which each pattern is the text at its place."""
    if len(patterns) != len(texts):
        return None
    way = dict(bound)
    for one, other in zip(patterns, texts, strict=True):
        if one in ("_", other):
            continue
        if not _is_variable(one):
            further = _unified(one, other, way)
            if further is None:
                return None
            way = further
        elif way.setdefault(one, other) != other:
            return None
    return way


@lru_cache(maxsize=1 << 14)
def _is_variable(text: str) -> bool:
    return _VARIABLE.fullmatch(text) is not None


@lru_cache(maxsize=1 << 14)
def _parts(text: str) -> tuple[str, ...]:
    return tuple(split_arguments(text)) if "(" in text else ()


def _compares(text: str, bound: Bound) -> bool:
    """Whether a comparison of two variables or constants holds; false of unknown ones."""
    one, sign, other = re.split(r"\s*(!=|<=|>=|<|>|=)\s*", _valued(text, bound))
    if not (_ground(one) and _ground(other)):
        return False
    if sign in ("=", "!="):
        return (one == other) == (sign == "=")
    numbers = one.lstrip("-").isdigit() and other.lstrip("-").isdigit()
    return numbers and COMPARED[sign](int(one), int(other))
