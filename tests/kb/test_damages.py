"""Damage of statements or files is refused, and found by check."""

import re
from pathlib import Path

import pytest
from observations import drink_from_mug
from pyoxigraph import Literal, NamedNode, Quad
from pyoxigraph import Store as Oxigraph

from kb.actionary import Actionary
from kb.checks import check
from kb.errors import DamagedError, ShapeError
from kb.exchange import bring_in, export, read
from kb.store.stores import DATA_FOLDER, EmbeddedStore
from ontology import CAPAR

LINK = "<https://w3id.org/capar/data/observation/DrinkFromMug#link.right_hand>"
KIND = "<https://w3id.org/capar/data/kind/mug>"
DOUBLE = "\\^\\^<http://www.w3.org/2001/XMLSchema#double>"


def term(name: str) -> str:
    return f"<https://w3id.org/capar/ontology#{name}>"


DAMAGES = {
    "wrong class at ofLink": (rf"{term('ofLink')} \S+", f"{term('ofLink')} {KIND}", "one link"),
    "wrong class at action": (
        rf"(#segment\S+ {term('action')}) \S+",
        rf"\1 {LINK}",
        "one action",
    ),
    "wrong class at body": (rf"(#fact\S+ {term('body')}) \S+", rf"\1 {KIND}", "a body"),
    "misspelt property": (term("firstFrame"), term("firstFrme"), "Did you mean capar:firstFrame"),
    "impossible duration": (
        rf"(#segment\S+ {term('duration')}) \S+",
        r'\1 "-3.5"^^<http://www.w3.org/2001/XMLSchema#double>',
        "not negative",
    ),
    "another duration than from start to end": (
        rf"(#segment\S+ {term('duration')}) \S+",
        r'\1 "9.5"^^<http://www.w3.org/2001/XMLSchema#double>',
        "which is not 9.5 s",
    ),
    "impossible order of frames": (
        rf"(#fact\S+ {term('lastFrame')}) \S+",
        r'\1 "0"^^<http://www.w3.org/2001/XMLSchema#integer>',
        "not after its last",
    ),
    "impossible share of a whole": (
        rf"(#step\S+ {term('share')}) \S+",
        r'\1 "1.7"^^<http://www.w3.org/2001/XMLSchema#double>',
        "between 0 and 1",
    ),
    "milliseconds for seconds": (
        rf"(#fact\S+ {term('(?:start|end)')}) \"([\d.]+)\"{DOUBLE}",
        r'\1 "\g<2>e3"^^<http://www.w3.org/2001/XMLSchema#double>',
        "is not at",
    ),
    "millimetres for metres": (
        rf"({term('size')}) \"([\d.]+) ([\d.]+) ([\d.]+)\"",
        r'\1 "\g<2>e3 \g<3>e3 \g<4>e3"',
        "lengths are in metres",
    ),
}
"""What is replaced by what in an export, and what is told."""


def damaged(name: str) -> tuple[bytes, str]:
    pattern, replacement, told = DAMAGES[name]
    source = Actionary.in_memory()
    source.add(drink_from_mug())
    whole = export(source.store, "nquads", observation="DrinkFromMug").decode()
    text, count = re.subn(pattern, replacement, whole)
    assert count > 0
    return text.encode(), told


@pytest.mark.parametrize("name", DAMAGES)
def test_a_damaged_export_is_refused_and_leaves_nothing(name: str) -> None:
    text, told = damaged(name)
    target = Actionary.in_memory()
    before = set(target.store.quads())
    with pytest.raises(ShapeError, match=re.escape(told)):
        bring_in(target.store, read(text, "nquads"))
    assert set(target.store.quads()) == before


@pytest.mark.parametrize("name", DAMAGES)
def test_the_same_damage_in_a_store_is_found_by_check(name: str, tmp_path: Path) -> None:
    text, told = damaged(name)
    with Actionary.open(tmp_path / "damaged") as actionary:
        actionary.store.insert(read(text, "nquads"))
        for full in (False, True):
            assert any(told in each.message for each in check(actionary.store, full=full))


def test_what_is_undamaged_has_no_problem() -> None:
    actionary = Actionary.in_memory()
    actionary.add(drink_from_mug())
    assert check(actionary.store) == ()
    text = export(actionary.store, "nquads", observation="DrinkFromMug")
    bring_in(Actionary.in_memory().store, read(text, "nquads"))


def test_what_is_imported_may_refer_to_what_the_store_knows() -> None:
    actionary = Actionary.in_memory()
    actionary.add(drink_from_mug())
    segment = NamedNode("https://w3id.org/capar/data/observation/DrinkFromMug#segment.right_hand.0")
    mine = "<https://example.org/mine>"
    lines = [
        f"{mine} {each.predicate} {each.object} ."
        for each in actionary.store.quads()
        if each.subject == segment
    ]
    assert bring_in(actionary.store, read("\n".join(lines).encode(), "turtle")) == (len(lines), 0)
    with pytest.raises(ShapeError, match="mine: "):
        bring_in(Actionary.in_memory().store, read("\n".join(lines).encode(), "turtle"))


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
