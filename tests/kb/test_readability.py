"""Checking reads every statement by way of every index of the database."""

from pathlib import Path

import pytest
from observations import drink_from_mug
from pyoxigraph import Literal, NamedNode, Quad
from pyoxigraph import Store as Oxigraph

from kb.actionary import Actionary
from kb.checks import check
from kb.errors import DamagedError
from kb.store.stores import DATA_FOLDER, EmbeddedStore
from ontology import CAPAR

INDICES = 7
"""Six orders of a statement's terms, and the terms by their numbers."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An Actionary of which each index has one file."""
    place = tmp_path_factory.mktemp("kept") / "actionary"
    with Actionary.open(place) as actionary:
        actionary.add(drink_from_mug())
    database = Oxigraph(place / DATA_FOLDER)
    database.optimize()
    database.flush()
    return place


def largest(folder: Path) -> list[Path]:
    files = sorted((folder / DATA_FOLDER).glob("*.sst"), key=lambda each: each.stat().st_size)
    return files[-INDICES:]


@pytest.mark.parametrize("index", range(INDICES))
def test_a_flipped_byte_in_any_index_is_found(folder: Path, index: int) -> None:
    file = largest(folder)[index]
    whole = file.read_bytes()
    middle = len(whole) // 3
    file.write_bytes(whole[:middle] + bytes([whole[middle] ^ 0xFF]) + whole[middle + 1 :])
    try:
        with pytest.raises(DamagedError):
            EmbeddedStore(folder, read_only=True).check_readable()
    finally:
        file.write_bytes(whole)


def test_what_is_whole_is_readable_and_right(folder: Path) -> None:
    assert len(largest(folder)) == INDICES
    with Actionary.open(folder, read_only=True) as actionary:
        assert check(actionary.store) == ()


def test_a_reference_to_nothing_is_found(folder: Path) -> None:
    nowhere = NamedNode("https://w3id.org/capar/data/observation/DrinkFromMug#nowhere")
    actionary = Actionary.in_memory()
    actionary.add(drink_from_mug())
    graph = NamedNode("https://w3id.org/capar/data/observation/DrinkFromMug")
    mentions = NamedNode("https://w3id.org/capar/ontology#mentions")
    actionary.store.insert([Quad(graph, mentions, nowhere, graph)])
    (problem,) = check(actionary.store)
    assert problem.observation == "DrinkFromMug"
    assert "mentions points to DrinkFromMug#nowhere" in problem.message


def test_a_place_beyond_a_things_reach_is_found_where_its_size_is_known() -> None:
    graph = NamedNode("https://w3id.org/capar/data/observation/DrinkFromMug")
    for size, told in (("0.0 0.0 0.0", 0), ("0.1 0.1 0.1", 1)):
        actionary = Actionary.in_memory()
        actionary.add(drink_from_mug())
        place, thing = (NamedNode(f"{graph.value}#{each}") for each in ("far", "thing"))
        for node, word, value in (
            (place, "dominant", thing),
            (place, "eeNlt", Literal("9 0 0 1 0 0 0", datatype=CAPAR.nlt)),
            (thing, "size", Literal(size, datatype=CAPAR.vector)),
        ):
            actionary.store.insert([Quad(node, getattr(CAPAR, word), value, graph)])
        found = [each for each in check(actionary.store) if "outside the reach" in each.message]
        assert len(found) == told
