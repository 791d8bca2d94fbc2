"""Rules over several windows are the rules, once for each window."""

import pytest

from capar_rules.engine.solver import worlds
from capar_rules.engine.syntax import parse_text
from capar_rules.explain.numbered import NUMBERS, Numbering

RULES = """
kind(cup). kind(mug). tag(table, fixed).
seen(Thing, (first; second)) :- at(Thing, _), kind(Thing).
early(Thing) :- at(Thing, Time), Time < 3.
late(Thing) :- at(Thing, _), not early(Thing).
last(Time) :- Time = #max { When : at(_, When), kind(cup) ; 0 }.
all_early :- early(Thing) : at(Thing, _).
either(1;2) :- last(2).
{ moved(Thing) : at(Thing, _) } 1 :- all_early.
:- moved(mug).
"""
WINDOWS = (
    {"at": ["cup,1", "mug,2"]},
    {"at": ["mug,5"]},
    {},
)
PREDICATES = (
    "seen/2",
    "early/1",
    "late/1",
    "last/1",
    "all_early/0",
    "either/1",
    "moved/1",
    "tag/2",
)


def shows(wider: int) -> str:
    named = (each.split("/") for each in PREDICATES)
    return "\n".join(f"#show {name}/{int(arity) + wider}." for name, arity in named)


def answers(window: dict[str, list[str]]) -> list[tuple[str, ...]]:
    facts = "".join(f"{name}({each})." for name, rows in window.items() for each in rows)
    return worlds(f"{RULES}#defined at/2.\n{shows(0)}\n{facts}")


@pytest.mark.parametrize("number", range(len(WINDOWS)))
def test_what_follows_in_a_window_is_what_follows_from_it_alone(number: int) -> None:
    statements = parse_text(RULES)
    numbering = Numbering(statements)
    facts = "".join(
        f"{NUMBERS}({n})." + "".join(f"at({n},{row})." for row in window.get("at", []))
        for n, window in enumerate(WINDOWS)
    )
    text = "\n".join(numbering.rule(each) for each in statements if each.kind == "rule")
    together = worlds(f"{text}\n{shows(1)}\n{facts}")
    found = {tuple(sorted(own(atom) for atom in world if of(atom) == number)) for world in together}
    assert found == {tuple(sorted(each)) for each in answers(WINDOWS[number])}


def of(atom: str) -> int:
    return int(atom.partition("(")[2].split(",")[0].rstrip(")"))


def own(atom: str) -> str:
    name, _, rest = atom.partition("(")
    inside = rest.removesuffix(")").partition(",")[2]
    return f"{name}({inside})" if inside else name
