"""VerbNet's files: read as values, kept in a store, and refused where they are not VerbNet's."""

import os
import random
from dataclasses import replace
from pathlib import Path

import pytest

from capar.model.errors import FileError
from capar.pipelines.linguistic_report import answer_verb, primitive_files, primitive_words
from kb.lexicon.loading import (
    every_verbnet_member,
    load_verbnet,
    verbnet_class_of,
    verbnet_of,
)
from kb.lexicon.verbnet import (
    Frame,
    Member,
    Phrase,
    Predicate,
    Role,
    VerbClass,
    key_rate,
    read_class,
    read_verbnet,
)
from kb.lexicon.wordnet import wordnet
from kb.store.stores import Store, open_store

EXAMPLE = Path(__file__).parent / "example-18.1.xml"
SHARED = Path(os.environ.get("CAPAR_LINGUISTICS", Path(__file__).parents[4] / "shared/linguistics"))
FULL = SHARED / "verbnet-3.4"
needs_verbnet = pytest.mark.skipif(
    not FULL.is_dir(), reason=f"no VerbNet in {FULL}; CAPAR_LINGUISTICS names its parent folder"
)


def test_a_class_is_read_with_all_that_it_states() -> None:
    read = read_class(EXAMPLE)
    contact = ("Instrument", "Patient")
    frame = Frame(
        "NP V NP PP.instrument",
        "Somebody prodded the drum with a stick.",
        (
            Phrase("NP", "Agent"),
            Phrase("VERB", ""),
            Phrase("NP", "Patient"),
            Phrase("PREP", "with"),
            Phrase("NP", "Instrument"),
            Phrase("PREP", "+loc"),
        ),
        (
            Predicate("contact", ("e1", *contact), holds=False),
            Predicate("contact", ("e2", *contact)),
        ),
    )
    below = VerbClass(
        "prod-18.1-1",
        "prod-18.1",
        (Member("kick", ("kick%2:35:00::", "kick%2:99:00::")),),
        (),
        (),
        (),
    )
    assert read == VerbClass(
        "prod-18.1",
        "",
        (Member("hit", ("hit%2:35:00::", "hit%2:35:03::")), Member("pick_up", ())),
        (Role("Agent", ("+int_control",)), Role("Patient", ("+concrete|-region",))),
        (frame,),
        (below,),
    )
    assert str(frame.semantics[0]) == "!contact(e1, Instrument, Patient)"
    assert below.levin == "18.1"


def test_the_rate_of_known_keys_is_counted() -> None:
    assert key_rate([read_class(EXAMPLE)], wordnet()) == (4, 3)


def test_a_store_gives_back_what_was_put_in() -> None:
    store = open_store(None)
    read = read_class(EXAMPLE)
    assert load_verbnet(store, (read,), wordnet())
    assert not load_verbnet(store, (read,), wordnet())
    assert verbnet_of(store, "hit") == (replace(read, subclasses=()),)
    assert verbnet_of(store, "kick") == (replace(read, subclasses=()), read.subclasses[0])
    assert verbnet_class_of(store, "18.1") == verbnet_of(store, "kick")
    assert verbnet_of(store, "sing") == ()
    assert [each.id for each in every_verbnet_member(store)] == ["prod-18.1", "prod-18.1-1"]


ENTITIES = """<!DOCTYPE VNCLASS [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;&a;">]>
<VNCLASS ID="x-1"><MEMBERS/><THEMROLES/><FRAMES/><SUBCLASSES/>&b;</VNCLASS>"""


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (ENTITIES, "declares what no VerbNet file needs"),
        ("<VNCLASS ID='x-1'><MEMBERS>", "is no XML"),
        ("<html/>", "begins with <html>"),
        ("<VNCLASS><MEMBERS/></VNCLASS>", "without ID"),
        ("<VNCLASS ID='x-1'><MEMBERS><MEMBER wn=''/></MEMBERS></VNCLASS>", "<MEMBER> without name"),
    ],
)
def test_a_file_that_is_not_verbnets_is_named(tmp_path: Path, text: str, problem: str) -> None:
    path = tmp_path / "broken-1.xml"
    path.write_text(text)
    with pytest.raises(FileError, match=problem) as caught:
        read_class(path)
    assert caught.value.path == path


def test_a_class_that_stands_twice_is_named(tmp_path: Path) -> None:
    for name in ("a.xml", "b.xml"):
        (tmp_path / name).write_bytes(EXAMPLE.read_bytes())
    with pytest.raises(FileError, match=r"prod-18\.1 twice"):
        read_verbnet(tmp_path)


@pytest.fixture(scope="module")
def full() -> tuple[VerbClass, ...]:
    return read_verbnet(FULL)


@pytest.fixture(scope="module")
def full_store(full: tuple[VerbClass, ...]) -> Store:
    store = open_store(None)
    load_verbnet(store, full, wordnet())
    return store


@needs_verbnet
def test_every_file_of_verbnet_3_4_is_read(full: tuple[VerbClass, ...]) -> None:
    every = [each for top in full for each in top.family]
    assert (len(full), len(every)) == (329, 609)
    assert sum(len(each.members) for each in every) == 6740
    assert sum(len(each.frames) for each in every) == 1602


@needs_verbnet
def test_classes_survive_the_store(full: tuple[VerbClass, ...], full_store: Store) -> None:
    stated = {each.id: each for top in full for each in top.family}
    for verb in ("touch", "put", "carry", "hit"):
        for each in verbnet_of(full_store, verb):
            assert each.frames == stated[each.id].frames
            assert {member.lemma for member in each.members} == {
                member.lemma for member in stated[each.id].members
            }


@needs_verbnet
def test_a_hundred_verbs_are_answered_with_their_classes_and_senses(
    full: tuple[VerbClass, ...], full_store: Store
) -> None:
    words = primitive_words(primitive_files())
    classes: dict[str, set[str]] = {}
    for each in (part for top in full for part in top.family):
        for member in each.members:
            classes.setdefault(member.lemma, set()).add(each.id)
    known = sorted(each for each in classes if wordnet().of_lemma(each))
    for verb in random.Random(5).sample(known, 100):
        answer = answer_verb(verb, words, store=full_store)
        assert {each.verbnet for each in answer.classes if each.verbnet} == classes[verb]
        assert len(answer.senses) == len(wordnet().of_lemma(verb))
