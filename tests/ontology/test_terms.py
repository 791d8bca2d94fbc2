"""Every term has a label and a definition, and code and files know the same terms."""

import ast
import inspect
import re
from pathlib import Path

import pytest
from pyoxigraph import Literal, NamedNode

import kb
import ontology
from capar.model.errors import UnknownNameError
from capar.model.observation import Border
from kb.encode.observation import BORDER_KINDS
from kb.store.validation import rules
from ontology import BASE, CAPAR, fact_kinds, terms
from ontology.files import closure, kinds, read, term_files
from ontology.namespace import PREFIXES, RDF, RDFS

LABEL = NamedNode(RDFS + "label")
DEFINITION = NamedNode(PREFIXES["skos"] + "definition")
TYPE = NamedNode(RDF + "type")
STATEMENTS = [each for file in term_files() for each in read(file)]
HERE = Path(ontology.__file__).parent
THESIS = (HERE / "thesis.md").read_text("utf-8")


def typed() -> set[str]:
    """Names of the terms that a file says are something."""
    return {
        each.subject.value.removeprefix(BASE)
        for each in STATEMENTS
        if each.predicate == TYPE
        and isinstance(each.subject, NamedNode)
        and each.subject.value.startswith(BASE)
    }


def test_the_closed_namespace_equals_the_files() -> None:
    assert set(terms()) == typed()


def test_the_terms_of_kinds_of_facts_are_those_that_their_classes_declare() -> None:
    assert (HERE / fact_kinds.TURTLE).read_text("utf-8") == fact_kinds.turtle()


def test_every_term_that_a_file_uses_is_stated() -> None:
    used = {
        node.value.removeprefix(BASE)
        for each in STATEMENTS
        for node in (each.subject, each.predicate, each.object)
        if isinstance(node, NamedNode) and node.value.startswith(BASE)
    }
    assert used <= typed()


@pytest.mark.parametrize("predicate", [LABEL, DEFINITION], ids=["label", "definition"])
def test_every_term_and_every_kind_has_one_of_each(predicate: NamedNode) -> None:
    counts: dict[str, int] = {}
    for each in STATEMENTS:
        if each.predicate == predicate and isinstance(each.object, Literal):
            assert each.object.value.strip()
            counts[str(each.subject)] = counts.get(str(each.subject), 0) + 1
    things = {str(CAPAR.__getattr__(name)) for name in terms()} | {
        f"<{PREFIXES['data']}kind/{name}>" for name in kinds()
    }
    assert {each: counts.get(each, 0) for each in things} == dict.fromkeys(things, 1)


def attributes_of_capar(path: Path) -> set[str]:
    """The terms that a module uses."""
    return {
        node.attr
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id == "CAPAR"
    }


def test_code_uses_no_term_that_the_ontology_lacks() -> None:
    for package in (kb, ontology):
        for path in Path(str(package.__file__)).parent.rglob("*.py"):
            assert attributes_of_capar(path) <= set(terms()), path


def test_queries_use_no_term_that_the_ontology_lacks() -> None:
    folder = Path(str(kb.__file__)).parent
    for path in folder.rglob("*.rq"):
        used = set(re.findall(r"\bcapar:(\w+)", path.read_text("utf-8")))
        assert used <= set(terms()), path.name


def test_shapes_use_no_term_that_the_ontology_lacks() -> None:
    for path in (HERE / "shapes").glob("*.ttl"):
        used = set(re.findall(r"\bcapar:(\w+)", path.read_text("utf-8")))
        assert used <= set(terms()), path.name


def test_a_misspelt_term_is_an_error_that_names_a_near_one() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'Upar'"):
        _ = CAPAR.Uper


def test_every_term_in_the_table_of_the_thesis_exists() -> None:
    rows = [line for line in THESIS.splitlines() if re.match(r"\| 4\.", line)]
    assert len(rows) > 50
    for row in rows:
        named = re.findall(r"`(\w+)`", row.split("|")[3])
        assert named, row
        assert set(named) <= set(terms()), row


def test_every_figure_of_the_thesis_has_rows() -> None:
    for figure in ("4.1", "4.2", "4.3", "4.8", "4.9", "4.11", "4.12", "4.13", "4.14", "4.16"):
        assert re.search(rf"^\| [^|]*{re.escape(figure)}\b", THESIS, re.MULTILINE), figure


def test_what_may_happen_at_a_border_is_the_same_in_files_shapes_code_and_model() -> None:
    kinds_of_border = {each.subject for each in STATEMENTS if each.object == CAPAR.BorderKind}
    named = {
        each.object.value: each.subject
        for each in STATEMENTS
        if each.predicate == CAPAR.name
        and each.subject in kinds_of_border
        and isinstance(each.object, Literal)
    }
    assert named == BORDER_KINDS
    shape = next(each for each in rules() if each.path == CAPAR.borderKind)
    assert shape.among == {str(each) for each in named.values()}
    source = inspect.getsource(Border)
    assert set(re.findall(r"``(\w+)``", source)) == set(named)


def test_the_kinds_form_a_hierarchy_under_one_root() -> None:
    pairs = [
        (str(each.subject), str(each.object))
        for each in STATEMENTS
        if each.predicate == CAPAR.broaderKind
    ]
    above = closure(pairs)
    root = f"<{PREFIXES['data']}kind/thing>"
    for name in kinds() - {"thing"}:
        node = f"<{PREFIXES['data']}kind/{name}>"
        assert root in above[node] and node not in above[node]


def test_every_file_opens_with_a_comment_that_says_what_it_holds() -> None:
    for path in HERE.rglob("*.ttl"):
        assert path.read_text("utf-8").startswith("# "), path
