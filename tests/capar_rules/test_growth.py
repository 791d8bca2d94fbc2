"""What grounding costs: joins that grow with the length of a capture, and rules kept reduced."""

from collections import Counter
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import clingo
import pytest
from bundles import DRINKING
from clingo import ast

from capar.model.capture import Capture
from capar.model.facts import Fact, Frames, Observed, Span, program
from capar.pipelines.observation import facts_program
from capar_rules.borders.numbering import number_borders
from capar_rules.engine import solver
from capar_rules.engine.profiles import profile
from capar_rules.engine.solver import fingerprint, reduced, solve
from capar_rules.lint.audit import PROFILES
from extractors.readers.bundle.capture_toml import read_capture

SHORT, LONG = 8, 32
"""How often the demo is repeated: half a minute and two minutes of it."""


@cache
def demo() -> tuple[Fact, ...]:
    capture: Capture = read_capture(DRINKING)
    return facts_program(capture)[0].facts


def repeated(facts: tuple[Fact, ...], times: int) -> tuple[Fact, ...]:
    """The same capture again and again, as one, with its borders."""
    frames = next(each for each in facts if isinstance(each, Frames)).last + 1
    out: list[Fact] = [Frames(0, frames * times - 1)]
    for fact in facts:
        assert isinstance(fact, Observed)
        if fact.declaration.span is Span.ALWAYS:
            out += [] if isinstance(fact, Frames) else [fact]
            continue
        named = [name for name in ("first", "last", "frame") if hasattr(fact, name)]
        for at in range(0, frames * times, frames):
            moved: Any = replace(fact, **{name: getattr(fact, name) + at for name in named})  # type: ignore[type-var]
            out.append(moved)
    return (*out, *number_borders(out, crossings_only=False))


class _Variables(ast.Transformer):
    def __init__(self) -> None:
        self.names: dict[str, None] = {}

    def visit_Variable(self, node: ast.AST) -> ast.AST:  # noqa: N802
        self.names |= {node.name: None} if node.name != "_" else {}
        return node


def counting(files: tuple[Path, ...]) -> tuple[str, dict[int, str]]:
    """Rules that report each match of each positive atom of their bodies, and their places."""
    nodes: list[ast.AST] = []
    ast.parse_files(list(map(str, files)), nodes.append, logger=lambda *_: None)
    texts, places = [], {}
    for number, node in enumerate(nodes):
        reports = []
        for at, literal in enumerate(node.body if node.ast_type is ast.ASTType.Rule else ()):
            if literal.ast_type is not ast.ASTType.Literal or literal.sign:
                continue
            if literal.atom.ast_type is ast.ASTType.SymbolicAtom:
                found = _Variables()
                found.visit(literal)
                names = ", ".join([str(number), str(at), *found.names])
                reports += [f"1 = @matched({names})"] if found.names else []
        if reports:
            body = "; ".join([*map(str, node.body), *reports])
            texts.append(f"{node.head} :- {body}.")
            begin = node.location.begin
            places[number] = f"{begin.filename}:{begin.line}: {node}"
        elif node.ast_type is not ast.ASTType.Program:
            texts.append(str(node))
    return "\n".join(texts), places


class _Matches:
    def __init__(self) -> None:
        self.of: Counter[tuple[int, int]] = Counter()

    def matched(self, rule: clingo.Symbol, atom: clingo.Symbol, *_: clingo.Symbol) -> clingo.Symbol:
        self.of[rule.number, atom.number] += 1
        return clingo.Number(1)


def matches(text: str, facts: tuple[Fact, ...]) -> dict[int, int]:
    """How often the solver matches the atom of each rule that it matches most often."""
    seen = _Matches()
    control = clingo.Control(["--warn=none"])
    control.add("base", [], f"{text}\n{program(facts)}")
    control.ground([("base", [])], context=seen)
    most: dict[int, int] = {}
    for (rule, _), count in seen.of.items():
        most[rule] = max(most.get(rule, 0), count)
    return most


@pytest.mark.parametrize("name", PROFILES)
def test_no_rule_joins_more_than_linearly_with_the_length_of_a_capture(name: str) -> None:
    """Of rules as files have them; who matches fewer atoms than there are facts walks over some."""
    text, places = counting(profile(name).files)
    short, long = repeated(demo(), SHORT), repeated(demo(), LONG)
    before, after = matches(text, short), matches(text, long)
    limit = {rule: max(1.2 * LONG / SHORT * before.get(rule, 0), len(long)) for rule in after}
    assert [places[rule] for rule, count in after.items() if count > limit[rule]] == []


def test_what_joins_every_contact_with_every_other_one_is_found(tmp_path: Path) -> None:
    rules = tmp_path / "rules.lp"
    rules.write_text("pair(X, F, G) :- touching(X, Y, F, _), touching(X, Z, G, _), F < G.\n")
    text, _ = counting((rules,))
    before, after = (sum(matches(text, repeated(demo(), n)).values()) for n in (SHORT, LONG))
    assert after > 3 * LONG / SHORT * before


@pytest.mark.parametrize("name", PROFILES)
def test_the_reduced_rules_that_are_shipped_are_those_of_the_files(name: str) -> None:
    """Else run ``python -m capar_rules.lint.audit``."""
    files = profile(name).files
    kept = solver._shipped().get(fingerprint(files), [])
    assert [tuple(row) for row in kept] == reduced(files)


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("times", [1, 3])
def test_reduced_rules_answer_as_all_of_them_do(name: str, times: int) -> None:
    facts = repeated(demo(), times)
    assert solve(profile(name).files, facts) == solve(profile(name).files, program(facts))


def test_rules_that_are_not_as_they_were_shipped_are_taken_from_their_files(tmp_path: Path) -> None:
    added = tmp_path / "mine.lp"
    added.write_text("named(Segment, mine) :- segment(Segment, _, _).\n")
    found = solve(profile(added=(added,)).files, repeated(demo(), 1)).of("named")
    assert "mine" in {name for _, name in found}
