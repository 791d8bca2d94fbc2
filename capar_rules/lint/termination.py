"""Rules whose grounding would not terminate, or hardly: found by their text."""

import re
from collections.abc import Iterator, Sequence

from capar_rules.engine.slicing import nodes
from capar_rules.engine.syntax import Literal, Signature, Statement, split_arguments
from capar_rules.lint.cycles import components
from capar_rules.lint.findings import Finding

WIDEST = 100_000
"""Greatest length of a range between two literal numbers."""

_RANGE = re.compile(r"(-?\d+)\.\.(-?\d+)")
_TEXT = re.compile(r'"(?:[^"\\\n]|\\.)*"')
_VARIABLE = re.compile(r"\b_*[A-Z]\w*")
_PLAIN = re.compile(r"_*[A-Z]\w*")


def growth_findings(own: Sequence[Statement]) -> Iterator[Finding]:
    """Ranges that are too wide, and recursions that keep making new values."""
    component = components(own)
    for rule in own:
        if rule.kind != "rule":
            continue
        for low, high in _RANGE.findall(_TEXT.sub("", rule.text)):
            if int(high) - int(low) > WIDEST:
                yield Finding(
                    rule.place, "unbounded", f"the range {low}..{high} is too wide.",
                    f"Hold at most {WIDEST} numbers, or take them from a measurement, such as "
                    "tick(Hand, Tick, Frame).",
                )  # fmt: skip
        for name in _growing(rule, component):
            yield Finding(
                rule.place, "unbounded", f"this rule keeps making new values of {name} from "
                "its own.",
                f"Bind {name} by a measurement that does not depend on this rule, such as "
                "tick(Hand, Tick, Frame).",
            )  # fmt: skip


def _growing(rule: Statement, component: dict[Signature, int]) -> list[str]:
    """Variables of the head that the recursion changes and nothing outside it binds."""
    mine = {component[node] for head in rule.heads for node in nodes(head) if node in component}
    again = [each for each in rule.body if _positive(each) and _within(each, component, mine)]
    if not again:
        return []
    bound = {
        name
        for each in rule.body
        if _positive(each) and each not in again
        for name in _VARIABLE.findall(_TEXT.sub("", each.text))
    }
    passed = {
        argument
        for each in again
        for argument in split_arguments(each.text)
        if _PLAIN.fullmatch(argument)
    }
    growing: list[str] = []
    for head in rule.heads:
        for argument in split_arguments(head.text):
            kept = bound | (passed if _PLAIN.fullmatch(argument) else set())
            names = _VARIABLE.findall(_TEXT.sub("", argument))
            growing += [name for name in names if name not in kept]
    return list(dict.fromkeys(growing))


def _positive(literal: Literal) -> bool:
    return literal.kind == "atom" and literal.sign == 0


def _within(literal: Literal, component: dict[Signature, int], mine: set[int]) -> bool:
    return any(component.get(node) in mine for atom in literal.atoms for node in nodes(atom))
