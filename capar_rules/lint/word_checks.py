"""Likely typing errors in rules: constants for variables, missing quotes, unknown words."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches

from capar.model.par import ACTION_NAME
from capar_rules.engine.syntax import FITS, Atom, Signature, Statement, split_arguments
from capar_rules.lint.findings import ERROR, NOTE, Finding
from capar_rules.lint.text_checks import AUTHORED, Known, introduced_names

Slot = tuple[Signature, int]
"""A predicate and the index of an argument, from zero."""

KINDS = frozenset({"hand", "foot", "head"})
"""The usual kinds of end-effectors (thesis 4.4.1); a capture may have others."""

MEASURED: Mapping[Slot, frozenset[str]] = {
    (("tag", 2), 1): frozenset({"self", "fixed", "mobile"}),
    (("link", 3), 1): KINDS,
    (("link", 3), 2): frozenset({"right", "left", "none"}),
}
"""Words in arguments of measurements (inputs.lp), which no rule defines."""

VARIABLE = re.compile(r"_*[A-Z]\w*'*")
CONSTANT = re.compile(r"_*[a-z]\w*'*")
STRING = re.compile(r'"[^"]*"')
_TERM = re.compile(r"(_*[a-z]\w*)\(")


def closed(rules: Sequence[Statement]) -> dict[Slot, frozenset[str]]:
    """The arguments for which rules have only a finite set of words, each with those words.

    A compound such as ``seg(Hand, From)`` is listed as ``seg(``. Arguments that can be a number,
    any term or a measured value have no entry.
    """
    constants = {each.defines for each in rules if isinstance(each.defines, str)}
    told = [_row(head, each) for each in rules for head in each.heads]
    found: dict[Slot, frozenset[str] | None] = {
        (signature, place): frozenset()
        for signature, arguments, _ in told
        for place in range(len(arguments))
    }
    found |= MEASURED
    changed = True
    while changed:
        changed = False
        for signature, arguments, bound in told:
            for place, text in enumerate(arguments):
                slot = signature, place
                old = found[slot]
                if old is None or slot in MEASURED:
                    continue
                new = _words(text, bound, found, constants)
                wider = None if new is None else old | new
                if wider != old:
                    found[slot], changed = wider, True
    return {slot: words for slot, words in found.items() if words}


def _row(head: Atom, rule: Statement) -> tuple[Signature, list[str], dict[str, list[Slot]]]:
    """A head's arguments, and where each of the rule's variables is bound."""
    bound: dict[str, list[Slot]] = {}
    for literal in rule.body:
        for atom in literal.atoms if literal.kind == "atom" and not literal.sign else ():
            for place, text in enumerate(arguments_of(atom)):
                if VARIABLE.fullmatch(text):
                    bound.setdefault(text, []).append((atom.signature, place))
    return head.signature, arguments_of(head), bound


def arguments_of(atom: Atom) -> list[str]:
    """An atom's arguments as they are written; empty texts for a pool of atoms."""
    found = split_arguments(atom.text) if atom.signature[1] else []
    return found if len(found) == atom.signature[1] else [""] * atom.signature[1]


def _words(
    text: str,
    bound: Mapping[str, Iterable[Slot]],
    found: Mapping[Slot, frozenset[str] | None],
    constants: set[str],
) -> frozenset[str] | None:
    """The words that an argument of a head can be; None for anything."""
    if STRING.fullmatch(text) or (CONSTANT.fullmatch(text) and text not in constants):
        return frozenset({text})
    if (term := _TERM.match(text)) and text.endswith(")"):
        return frozenset({f"{term[1]}("})
    choices = [words for slot in bound.get(text, ()) if (words := found.get(slot)) is not None]
    return frozenset.intersection(*choices) if choices else None


MOST = 12
"""How many words a finding lists where none is similar."""

_TEXT = re.compile(r'"(?:[^"\\]|\\.)*"')
_OWN_NAME = re.compile(r"Any\d+")
_ANY_VARIABLE = re.compile(r"(?<!\w)[A-Z]\w*'*")


def slip_findings(own: Sequence[Statement], base: Known) -> Iterator[Finding]:
    """Every finding about the constants and texts that rules use."""
    mine = introduced_names(own)
    names = mine | set(base.primitives)
    words = closed(
        [
            *base.rules,
            *(each for each in own if FITS not in {head.signature for head in each.heads}),
        ]
    )
    yield from _names(own)
    constants = base.constants | {each.defines for each in own if isinstance(each.defines, str)}
    for statement in own:
        if statement.kind != "rule":
            continue
        yield from _heads(statement, mine)
        for literal in statement.body:
            for atom in literal.atoms:
                if atom.signature == FITS:
                    yield from _fits(atom, names)
                yield from _foreign(atom, words, constants, names)


def _heads(rule: Statement, mine: set[str]) -> Iterator[Finding]:
    for head in rule.heads:
        if head.signature == FITS:
            segment, name = arguments_of(head)
            if CONSTANT.fullmatch(segment):
                yield Finding(
                    head.place, "constant-segment",
                    f"{segment} is a constant here, and no segment is called that.",
                    f"Variables begin with a capital: fits({segment.capitalize()}, {name}).",
                )  # fmt: skip
            if not name.startswith('"'):
                yield _unquoted(head, name, mine)


def _fits(atom: Atom, names: set[str]) -> Iterator[Finding]:
    name = arguments_of(atom)[1]
    if VARIABLE.fullmatch(name) and not _OWN_NAME.fullmatch(name):
        if name in names:
            yield _unquoted(atom, name, names)
    elif CONSTANT.fullmatch(name):
        yield _unquoted(atom, name, names)
    elif STRING.fullmatch(name) and name.strip('"') not in names:
        yield Finding(
            atom.place, "unknown-primitive", f"there is no primitive {name}.",
            _nearest(name.strip('"'), names),
        )  # fmt: skip


def _unquoted(atom: Atom, name: str, names: set[str]) -> Finding:
    close = get_close_matches(name.lower(), [each.lower() for each in names], n=1)
    meant = next((each for each in sorted(names) if [each.lower()] == close), name)
    return Finding(
        atom.place, "missing-quotes", f"quotes are missing around {name}.",
        f'Names of primitives are texts: "{meant}".',
    )  # fmt: skip


def _foreign(
    atom: Atom,
    words: Mapping[Slot, frozenset[str]],
    constants: frozenset[str],
    names: set[str],
) -> Iterator[Finding]:
    """Words that can never occur in their argument, or kinds that captures rarely have."""
    if atom.signature in AUTHORED and atom.signature != FITS:
        return
    for place, text in enumerate(arguments_of(atom)):
        known = words.get((atom.signature, place))
        word = bool(CONSTANT.fullmatch(text) or STRING.fullmatch(text))
        if known is None or not word or text in known or text in constants:
            continue
        primitives = frozenset(f'"{each}"' for each in names)
        if known & primitives:
            known |= primitives
        if text in known or (atom.signature == FITS and place == 1):
            continue
        bare = sorted(each.strip('"') for each in known if not each.endswith("("))
        if f'"{text}"' in known:
            code, message, remedy = (
                "missing-quotes", f"quotes are missing around {text}.", f'Write "{text}".'
            )  # fmt: skip
        elif text.strip('"') in known:
            code, message, remedy = (
                "needless-quotes", f"{text} is written without quotes in {atom.signature[0]}.",
                f"Write {text.strip(chr(34))}.",
            )  # fmt: skip
        elif not bare:
            code, message, remedy = (
                "constant-argument", f"{text} is a constant in {atom.text}, and can never occur "
                "there.", f"Variables begin with a capital: {text.capitalize()}.",
            )  # fmt: skip
        else:
            code, message, remedy = (
                "unknown-word", f"{text} never occurs as argument {place + 1} of "
                f"{atom.signature[0]}.",
                _nearest(text.strip('"'), bare),
            )  # fmt: skip
        yield Finding(atom.place, code, message, remedy, NOTE if known == KINDS else ERROR)


def _names(own: Iterable[Statement]) -> Iterator[Finding]:
    """Names that a primitive may not have."""
    for statement in own:
        for head in statement.heads:
            if head.signature == ("primitive", 1):
                (argument,) = split_arguments(head.text)
                name = argument.strip('"')
                if not argument.startswith('"'):
                    yield Finding(
                        head.place, "missing-quotes", f"quotes are missing around {argument}.",
                        f'Names of primitives are texts: primitive("{argument.capitalize()}").',
                    )  # fmt: skip
                elif not ACTION_NAME.fullmatch(name):
                    yield Finding(
                        head.place, "bad-name", f"{argument} is no name of a primitive.",
                        "A capital comes first, then letters and digits alone: MoveObjTo.",
                    )  # fmt: skip


def fitting_findings(own: Sequence[Statement], base: Known) -> Iterator[Finding]:
    """Primitives without a rule or feature row that says which segments fit them."""
    heads = [head for each in (*base.rules, *own) for head in each.heads]
    where = {("fits", 2): 1, ("feature_row", 6): 0, ("specialises", 2): 1}
    spoken = {
        split_arguments(each.text)[where[each.signature]].strip('"')
        for each in heads
        if each.signature in where
    }
    for statement in own:
        for head in statement.heads:
            if head.signature == ("primitive", 1):
                (argument,) = split_arguments(head.text)
                if argument.strip('"') not in spoken:
                    yield Finding(
                        head.place, "nothing-fits", f"nothing says which segments fit {argument}.",
                        f"State a feature_row of it, or fits(Segment, {argument}) :- conditions.",
                    )  # fmt: skip


def single_findings(own: Iterable[Statement]) -> Iterator[Finding]:
    """Variables that occur only once in their rule."""
    for rule in own:
        counts = Counter(_ANY_VARIABLE.findall(_TEXT.sub('""', rule.text)))
        once = [
            each
            for each, count in sorted(counts.items())
            if rule.kind == "rule" and count == 1 and not _OWN_NAME.fullmatch(each)
        ]
        if once:
            several = len(once) > 1
            yield Finding(
                rule.place, "single-variable",
                f"{', '.join(once)} {'occur' if several else 'occurs'} only once in this rule.",
                "If that is meant, write _ instead; if not, look for a typing error.", NOTE,
            )  # fmt: skip


def _nearest(name: str, known: Iterable[str]) -> str:
    words = sorted(known)
    close = get_close_matches(name, words, n=1, cutoff=0.5)
    more = f" and {len(words) - MOST} more" if len(words) > MOST else ""
    there = f"There are {', '.join(words[:MOST])}{more}."
    return f"Did you mean {close[0]}?" if close else there


COMPOUND = frozenset({"seg("})
"""What stands where a predicate takes a segment: ``seg(Hand, From)``."""

FITTED: Slot = (FITS, 0)


def segment_slots(rules: Iterable[Statement]) -> frozenset[Slot]:
    """The arguments of predicates that are segments."""
    return frozenset(slot for slot, words in closed([*rules]).items() if words == COMPOUND)


def about_others(rule: Statement, slots: Iterable[Slot]) -> frozenset[str]:
    """The conditions, as written, about a segment that is not the one of the rule's head.

    A head without a segment has the first one of the body.
    """
    wanted = frozenset(slots)
    texts = [each.text.replace(" ", "") for each in rule.body
             if each.kind == "comparison" and not each.sign]  # fmt: skip
    equal = [set(each.split("=")) for each in texts if re.fullmatch(r"[^=!<>]+=[^=!<>]+", each)]
    home: set[str] = set()
    found = set()
    for literal in (None, *rule.body):
        atoms = rule.heads if literal is None else literal.atoms
        terms = {
            "".join(text.split())
            for atom in atoms
            for at, text in enumerate(arguments_of(atom))
            if (atom.signature, at) in wanted
        }
        home = home or terms
        while more := set[str]().union(*(each for each in equal if each & home)) - home:
            home |= more
        if literal is not None and terms - home:
            found.add(literal.text)
    return frozenset(found)
