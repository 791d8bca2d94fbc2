"""`import capar` opens quickly on everything, and no submodule takes the name of a function."""

import ast
import importlib
import pickle
import pkgutil
import subprocess
import sys
from collections.abc import Callable
from copy import deepcopy
from importlib import resources
from pathlib import Path

import pytest
from observations import drink_from_mug, pick_up_with_both_hands

import capar

DEMO = str(resources.files("capar") / "demo" / "drink_from_mug")
PACKAGES = ("capar", "extractors", "capar_rules", "kb", "ontology")
HEAVY = {"numpy", "scipy", "matplotlib", "rdflib", "pyoxigraph", "clingo", "trimesh", "pydantic",
         "typer", "rich", "rosbags", "pandas"}  # fmt: skip


def every_submodule() -> list[str]:
    found = []
    for package in PACKAGES:
        path = importlib.import_module(package).__path__
        found += [each.name for each in pkgutil.walk_packages(path, f"{package}.")]
    return [each for each in found if not each.endswith("__main__")]


def test_importing_the_front_door_imports_nothing_heavy() -> None:
    code = "import sys, capar; print(' '.join(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not HEAVY & set(done.stdout.split())


def loaded(*command: str) -> set[str]:
    """The modules that a process has imported when its command has ended."""
    code = (
        f"import sys; from capar.cli import main; sys.argv = {['capar', *command]}\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "print('modules:', *sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.partition("modules:")[2].split())


def test_the_help_imports_nothing_that_only_observing_needs() -> None:
    modules = loaded("--help")
    assert "typer" in modules
    assert not (HEAVY - {"typer", "rich", "pydantic"}) & modules


def test_observing_imports_neither_the_meshes_of_all_formats_nor_what_stores_and_draws() -> None:
    modules = loaded("observe", DEMO)
    assert "numpy" in modules
    unneeded = {"trimesh", "networkx", "PIL", "matplotlib", "rdflib", "rich", "mujoco", "rosbags"}
    assert not unneeded & modules


def test_a_question_imports_nothing_that_only_observing_needs(tmp_path: Path) -> None:
    with capar.open_actionary(tmp_path) as book:
        book.add(drink_from_mug())
    modules = loaded("query", "segments", "--actionary", str(tmp_path))
    assert "pyoxigraph" in modules
    assert not (HEAVY - {"typer", "pyoxigraph", "pydantic"}) & modules
    code = "import sys, kb.store.stores; print(*sys.modules)"  # the process that answers it
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not (HEAVY - {"pyoxigraph"}) & set(done.stdout.split())


def test_no_submodule_takes_the_place_of_a_public_function() -> None:
    """Importing ``package.name`` sets an attribute of the package, over a function of that name."""
    for name in every_submodule():
        importlib.import_module(name)
    seen = capar.observe(capar.read_capture(DEMO))
    assert "mug" in capar.describe(seen)
    assert capar.explain(DEMO, "right_hand/0")[0].name == seen.segments[0].name
    assert capar.why_not(DEMO, "right_hand/0", "Push")
    assert capar.from_json(capar.to_json(seen)) == seen
    with capar.open_actionary(":memory:") as book:
        book.add(seen)
        assert [each.name for each in book.observations()] == [seen.capture]


@pytest.mark.parametrize("name", capar.__all__)
def test_every_public_name_is_there_with_a_docstring(name: str) -> None:
    value = getattr(capar, name)
    assert value.__doc__
    assert name in dir(capar)


OURS = ("capar", "extractors", "kb")


def test_what_type_checkers_see_is_what_is_there() -> None:
    """The lazy names and the imports for type checkers are the same."""
    tree = ast.parse(Path(capar.__file__).read_text(encoding="utf-8"))
    checked = next(each for each in tree.body if isinstance(each, ast.If))
    stated = {
        name.asname: each.module
        for each in checked.body
        if isinstance(each, ast.ImportFrom) and str(each.module).split(".")[0] in OURS
        for name in each.names
    }
    assert stated == capar._LAZY
    assert set(capar.__all__) == {*stated, "label", "open_actionary"}
    assert (Path(capar.__file__).parent / "py.typed").is_file()


def test_a_name_that_is_not_there_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'obsreve'"):
        capar.obsreve  # noqa: B018


@pytest.mark.parametrize("make", [drink_from_mug, pick_up_with_both_hands])
def test_an_observation_can_be_sent_to_another_process(make: object) -> None:
    seen = make()  # type: ignore[operator]
    assert pickle.loads(pickle.dumps(seen)) == seen
    assert deepcopy(seen) == seen


def test_a_calibration_is_made_of_a_place_as_of_a_capture() -> None:
    assert capar.calibrate(DEMO) == capar.calibrate(capar.read_capture(DEMO))


@pytest.mark.parametrize("function", [capar.observe, capar.explain, capar.calibrate])
def test_what_is_neither_a_capture_nor_a_place_is_refused_by_its_type(
    function: Callable[[object], object],
) -> None:
    with pytest.raises(
        capar.CaparError, match=r"expected a Capture, or the folder .* found int: 3"
    ):
        function(3)
