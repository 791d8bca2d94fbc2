"""Scripts in the thesis's form hold the PAR, and nothing of a capture becomes code."""

import ast
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from observations import drink_from_mug, pick_up_with_both_hands

from capar.model.errors import ParError
from capar.model.par import ComplexPar, Condition, Step
from capar.views.script import script


def read(node: ast.expr) -> Any:
    """A script's data: literals as they are, names as their text."""
    if isinstance(node, ast.Name):
        return f"<{node.id}>"
    if isinstance(node, ast.Tuple):
        return tuple(map(read, node.elts))
    if isinstance(node, ast.Dict):
        pairs = zip(node.keys, node.values, strict=True)
        return {read(key): read(value) for key, value in pairs if key is not None}
    assert isinstance(node, ast.Constant), ast.dump(node)
    return node.value


def functions(text: str) -> dict[str, ast.FunctionDef]:
    return {each.name: each for each in ast.parse(text).body if isinstance(each, ast.FunctionDef)}


def steps_of(par: ComplexPar) -> Any:
    """The nest that a complex PAR's script is to hold (thesis 4.6.2)."""
    names = {name: f"<obj{index + 1}>" for index, name in enumerate(par.objects)}

    def entry(step: Step) -> Any:
        fields = {
            "agents": "<agent>",
            "objects": tuple(names[each] for each in step.objects),
            "duration": step.share,
            "purpose": step.purpose,
            "EE": step.ee,
            "ComplexParent": par.name,
        }
        if step.posture:
            fields["Posture"] = (step.posture, f"{step.posture}.post")
        return (step.action, fields)

    sequences = [("<SEQUENCE>", *map(entry, each.steps)) for each in par.links]
    last = [entry(par.common)] if par.common else []
    if len(sequences) == 1:
        return (*sequences[0], *last)
    whole = ("<PARALLEL>", *sequences)
    return ("<SEQUENCE>", whole, *last) if last else whole


def held(text: str) -> Any:
    first = functions(text)["execution_steps"].body[0]
    assert isinstance(first, ast.Assign)
    return read(first.value)


@pytest.mark.parametrize("seen", [drink_from_mug(), pick_up_with_both_hands()])
def test_the_data_of_a_complex_script_are_the_par(seen: Any) -> None:
    par = seen.complex_par
    assert held(script(par)) == steps_of(par)
    parallel = replace(par, common=None)
    assert held(script(parallel)) == steps_of(parallel)

    assert script(seen) == script(par)


def test_the_drink_of_the_thesis_is_one_sequence_of_six() -> None:
    kind, *steps = held(script(drink_from_mug().complex_par))
    assert kind == "<SEQUENCE>"
    assert [name for name, _ in steps][:4] == ["Reach", "MoveObjTo", "MoveObj", "MoveObjTo"]
    assert steps[1][1]["objects"] == ("<obj1>", "<obj2>")
    assert steps[-1][1]["Posture"] == ("DrinkFromMugEnd", "DrinkFromMugEnd.post")


def test_a_upar_has_the_four_functions_of_the_thesis() -> None:
    for par in drink_from_mug().upars:
        found = functions(script(par))
        assert set(found) == {
            "applicability_condition",
            "preparatory_spec",
            "termination_conditions",
            "execution_steps",
        }
        for each in found.values():
            assert [arg.arg for arg in each.args.args] == ["self", par.agent, *par.objects]


@given(st.text(max_size=30), st.text(max_size=30), st.text(max_size=30))
def test_no_name_of_a_capture_becomes_code(name: str, thing: str, purpose: str) -> None:
    par = drink_from_mug().complex_par
    first = replace(par.links[0].steps[0], action=name, objects=(thing,), purpose=purpose)
    odd = replace(
        par,
        name=name,
        objects=(thing,),
        links=(replace(par.links[0], steps=(first,)),),
        common=None,
    )
    text = script(odd)
    assert held(text) == steps_of(odd)
    assert len(ast.parse(text).body) == 2


@given(st.text(max_size=30), st.text(max_size=30))
def test_no_condition_becomes_code(kind: str, argument: str) -> None:
    par = drink_from_mug().upars[0]
    odd = replace(par, name=argument, applicability=(Condition(kind, (argument,), False),))
    assert len(ast.parse(script(odd)).body) == 4


@pytest.mark.parametrize("name", ["obj 1", "1", "class", "", "a):\n    import os\ndef f("])
def test_a_parameter_that_is_no_name_is_refused(name: str) -> None:
    with pytest.raises(ParError, match="no Python name"):
        script(replace(drink_from_mug().upars[0], objects=(name, "obj2")))
