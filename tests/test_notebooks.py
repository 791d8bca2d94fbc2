"""The notebooks run from top to bottom, and are kept without what they print."""

import ast
import json
from pathlib import Path
from typing import Any

import pytest

FOLDER = Path(__file__).parents[1] / "examples" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def code_of(notebook: Path) -> list[dict[str, Any]]:
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return [each for each in cells if each["cell_type"] == "code"]


def run(cell: str, names: dict[str, Any]) -> Any:
    """Run a cell as a notebook does; the value of its last expression."""
    tree = ast.parse(cell)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None


def shown(value: Any) -> str:
    """What a notebook shows of a value."""
    page = getattr(value, "_repr_html_", None)
    return str(page()) if page else repr(value)


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda each: each.stem)
def test_a_notebook_is_kept_without_outputs(notebook: Path) -> None:
    for cell in code_of(notebook):
        assert cell["outputs"] == []
        assert cell["execution_count"] is None


def test_the_first_steps_observe_look_ask_and_explain(capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, Any] = {}
    cells = ["".join(each["source"]) for each in code_of(FOLDER / "first_steps.ipynb")]
    values = [run(each, names) for each in cells]
    printed = capsys.readouterr().out
    assert "<table>" in shown(values[0])
    seen = names["seen"]
    assert printed.startswith("The man")
    assert all(word in printed for word in ("mug", "right hand", "drank"))
    assert "Push (push_with.lp:2) would need" in printed
    about_mug = {each.name for each in seen.segments if "mug" in each.objects}
    assert {row["action"] for row in values[3]} == about_mug
    counts = {row["name"]: row["often"] for row in names["rows"]}
    stored = [each.name for each in seen.segments]
    assert counts == {name: stored.count(name) for name in set(stored)}
    imported = {
        name.name
        for cell in cells
        for node in ast.walk(ast.parse(cell))
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in node.names
    }
    assert imported == {"capar"}
