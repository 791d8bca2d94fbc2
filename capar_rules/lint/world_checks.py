"""Checks that ask the solver: safety, and what a file's rules do over every possible segment."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence

from capar.model.errors import RuleError
from capar_rules.engine.search import Atom as Answered
from capar_rules.engine.search import brave, understand
from capar_rules.engine.slicing import heads_of, signatures_below, towards
from capar_rules.engine.syntax import Atom, Place, Signature, Statement, parse_text, split_arguments
from capar_rules.lint.audit import (
    ASKED,
    Audit,
    chosen_in_audit,
    evaluate,
    given_in_audit,
    summarise,
)
from capar_rules.lint.findings import NOTE, Finding
from capar_rules.lint.text_checks import Known
from capar_rules.lint.word_places import STRING

FIRED, IDLE, HELD = ("fired", 1), ("idle", 1), ("held", 3)
FITTED, POSSIBLE, FEATURE_ROW = ("fitted", 1), ("possible", 4), ("feature_row", 6)

MOST_RIVALS = 5
"""How many rivals an ambiguity lists."""

_MESSAGE = re.compile(r"[^:\n]*:(\d+):(\d+)(?:-[\d:]+)?: (?:error|info): (.*)")
_COMPUTES = re.compile(r"[-+*/\\|&?^~;]|\.\.")
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|\b_*[A-Z]\w*')
_UNSAFE = re.compile(r": note: '(\w+)' is unsafe")


def safety_findings(text: str, file: str) -> Iterator[Finding]:
    """What the solver reports when it grounds a file by itself."""
    try:
        brave(text, ())
    except RuleError as error:
        yield from solver_findings(str(error), file)


def unsafe_findings(text: str, file: str) -> Iterator[Finding]:
    """What the solver reports when it only reads a file: unsafe variables above all."""
    try:
        understand(text)
    except RuleError as error:
        yield from solver_findings(str(error), file)


def solver_findings(message: str, file: str) -> Iterator[Finding]:
    """The solver's messages as findings."""
    variables = _UNSAFE.findall(message)
    found = False
    for line in message.splitlines():
        match = _MESSAGE.match(line)
        if match is None:
            continue
        found = True
        place = Place(file, int(match[1]), int(match[2]))
        if "unsafe" in match[3]:
            names = ", ".join(dict.fromkeys(variables)) or "a variable"
            yield Finding(
                place, "unsafe-variable", f"nothing says which values {names} may take.",
                "Name it in a condition without not, such as segment(Segment, From, To).",
            )  # fmt: skip
        elif "syntax error" in match[3] or "lexer error" in match[3]:
            wrong = match[3].split("error, ")[-1]
            yield Finding(
                place, "syntax", f"this is no rule: {wrong}.",
                "A rule reads head :- condition, condition. and ends with a full stop.",
            )  # fmt: skip
        else:
            yield Finding(place, "refused", f"the solver refuses it: {match[3]}.", "Rewrite it.")
    if not found:
        yield Finding(
            Place(file, 1, 1), "refused", f"the solver refuses it: {message.strip()[:200]}.",
            "Rewrite it.",
        )  # fmt: skip


def world_findings(own: Sequence[Statement], base: Known) -> Iterator[Finding]:
    """Rules that can never fire or always do, and names that clash with others."""
    rules = [each for each in own if each.kind == "rule" and each.heads]
    judged = [rule for rule in rules if not _beyond(rule, own, base)]
    for rule in rules:
        if rule not in judged:
            words = ", ".join(f"{name}/{arity}" for name, arity in _beyond(rule, own, base))
            yield _not_judged(rule, f"{words}, which the worlds of the audit do not contain")
    atoms, limbs = _fitted(own, base, _probes(judged))
    yield from _firing(judged, atoms, lambda number: _missing(number, judged, own, base, atoms))
    yield from _clashes(own, _named(own, base, limbs))


def _fitted(
    own: Sequence[Statement], base: Known, probes: Iterable[Statement] = ()
) -> tuple[frozenset[Answered], frozenset[str]]:
    """Which rules fire, and the end-effectors in whose worlds a primitive of one's own fits."""
    marks = "".join(f'fitted(Hand) :- fits(seg(Hand,_), "{name}").\n' for name in _primitives(own))
    rules = [*base.rules, *own, *probes, *parse_text(marks)]
    atoms = evaluate(rules, (FIRED, IDLE, HELD, POSSIBLE, FITTED))
    return atoms, frozenset(str(row[0]) for name, row in atoms if name == "fitted")


def _named(own: Sequence[Statement], base: Known, limbs: frozenset[str]) -> Audit:
    """The audit of the worlds in which a primitive of one's own fits: it clashes in no other."""
    return summarise(evaluate([*base.rules, *own], (*ASKED, FEATURE_ROW), limbs=limbs))


def _not_judged(rule: Statement, what: str) -> Finding:
    return Finding(
        rule.place, "not-judged", f"whether it can fire was not checked: it depends on {what}.",
        "Give the file examples that it must and must not match.", NOTE,
    )  # fmt: skip


def _probes(rules: Sequence[Statement]) -> Iterator[Statement]:
    for number, rule in enumerate(rules):
        if rule.body:
            body = "; ".join(each.text for each in rule.body)
            text = f"fired({number}) :- {body}.\n"
            if rule.heads[0].signature == ("fits", 2):
                segment = split_arguments(rule.heads[0].text)[0]
                text += f"fired({number},{segment}) :- {body}.\n"
                text += f"idle({number}) :- segment(S,_,_); not fired({number},S).\n"
            for place, atom in _plain(rule):
                name, arity = atom.signature
                text += f"held({number},{place},so) :- {_loosened(atom.text)}.\n"
                if arity:
                    text += f"held({number},{place},any) :- {name}({','.join('_' * arity)}).\n"
            yield from parse_text(text)


def _plain(rule: Statement) -> Iterator[tuple[int, Atom]]:
    """The positive conditions of a rule without arithmetic, each with its index."""
    for place, literal in enumerate(rule.body):
        if literal.kind == "atom" and literal.sign == 0:
            atom = literal.atoms[0]
            if not _COMPUTES.search(STRING.sub("", atom.text)):
                yield place, atom


def _loosened(text: str) -> str:
    """An atom's text with its variables anonymous."""
    return _TOKEN.sub(lambda found: found[0] if found[0].startswith('"') else "_", text)


def _missing(
    number: int,
    judged: Sequence[Statement],
    own: Sequence[Statement],
    base: Known,
    atoms: frozenset[Answered],
) -> str:
    """A condition that no world fulfils though a real segment may; else an empty text.

    No world has such a relation, or the relation depends on one chosen over few arguments only.
    """
    held = {row[1:] for name, row in atoms if name == "held" and row[0] == number}
    for place, atom in _plain(judged[number]):
        if (place, "so") not in held and (
            (place, "any") not in held or _below([atom.signature], own, base) & chosen_in_audit()
        ):
            return atom.text
    return ""


def _firing(
    rules: Sequence[Statement], atoms: frozenset[Answered], missing: Callable[[int], str]
) -> Iterator[Finding]:
    fired = {row[0] for name, row in atoms if name == "fired" and len(row) == 1}
    idle = {row[0] for name, row in atoms if name == "idle"}
    possible = {tuple(map(str, row)) for name, row in atoms if name == "possible"}
    for number, rule in enumerate(rules):
        head = rule.heads[0]
        arguments = [each.strip('"') for each in split_arguments(head.text)]
        row = head.signature == ("feature_row", 6) and tuple(arguments[2:]) not in possible
        unfired = bool(rule.body) and number not in fired
        if unfired and (beyond := missing(number)):
            yield _not_judged(rule, f"{beyond}, which the worlds of the audit do not contain")
        elif unfired or row:
            what = f"the features {', '.join(arguments[2:])}" if row else "what it asks for"
            yield Finding(
                rule.place, "never-fires",
                f"this rule can never fire: no segment has {what}.",
                "`capar rules audit` lists the feature sets that segments can have.",
            )  # fmt: skip
        elif rule.body and head.signature == ("fits", 2) and number not in idle:
            yield Finding(
                rule.place, "always-fires", "this rule always fires: every segment fits it.",
                "Add a condition, such as features(Segment, Start, End, Change, Force).",
            )  # fmt: skip


def rivals(name: str, own: Sequence[Statement], base: Known) -> tuple[str, ...]:
    """The primitives that are ambiguous with one of a file's, most shared feature sets first."""
    return _rivals(name, _named(own, base, _fitted(own, base)[1]))


def _rivals(name: str, audit: Audit) -> tuple[str, ...]:
    """The same of an audit."""
    shared = {
        pair.second if pair.first == name else pair.first: len(pair.features)
        for pair in audit.ambiguous
        if name in (pair.first, pair.second)
    }
    return tuple(sorted(shared, key=lambda rival: (-shared[rival], rival)))


def _clashes(own: Sequence[Statement], audit: Audit) -> Iterator[Finding]:
    for name, place in _primitives(own).items():
        others = _rivals(name, audit)
        if others:
            pairs = [pair for pair in audit.ambiguous if name in (pair.first, pair.second)]
            where = ", ".join(bit or "none" for bit in pairs[0].features[0])
            told = ", ".join(others[:MOST_RIVALS])
            rest = len(others) - MOST_RIVALS
            yield Finding(
                place, "ambiguous",
                f"{name} and {told}{f' and {rest} more' if rest > 0 else ''} name the same "
                f"segments, such as those with features {where}, and neither is the more specific.",
                f"If {name} is a kind of {others[0]}, say "
                f'specialises("{name}", "{others[0]}"); if not, add a condition that keeps them '
                f'apart, such as not fits(Segment, "{others[0]}").',
            )  # fmt: skip
        if name in audit.shadowed:
            yield Finding(
                place, "shadowed", f"{name} never names a segment: others are always more "
                "specific.", "Remove what specialises it, or add a case of its own.",
            )  # fmt: skip


def _primitives(own: Sequence[Statement]) -> dict[str, Place]:
    """The names of a file's primitives, and where they are declared."""
    return {
        split_arguments(head.text)[0].strip('"'): head.place
        for each in own
        for head in each.heads
        if head.signature == ("primitive", 1)
    }


def _beyond(rule: Statement, own: Sequence[Statement], base: Known) -> tuple[Signature, ...]:
    """The measurements that a rule depends on and no world of the audit contains."""
    read = _below((atom.signature for each in rule.body for atom in each.atoms), own, base)
    defined = heads_of([*base.rules, *own])
    return tuple(sorted((read & base.measured) - given_in_audit() - defined))


def _below(
    signatures: Iterable[Signature], own: Sequence[Statement], base: Known
) -> frozenset[Signature]:
    """Predicates and what they depend on, down to what the worlds of the audit define."""
    below, given = frozenset(signatures), given_in_audit()
    slice_ = towards([*base.rules, *own], below - given, given=given)
    return below | signatures_below(each for each in slice_ if each.kind == "rule")
