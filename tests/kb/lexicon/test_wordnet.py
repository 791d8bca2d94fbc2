"""WordNet's verbs: found by key, lemma and index; quick to load; the thesis's senses settled."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from capar.model.errors import UnknownNameError
from kb.lexicon.wordnet import Synset, frame_sentence, table, wordnet

SETTLED = [
    ("reach%2:42:00::", 6, "02691488", "i35083"),
    ("hit%2:35:03::", 1, "01407698", "i28752"),
    ("hit%2:35:00::", 3, "01402698", "i28723"),
    ("touch%2:35:00::", 1, "01208838", "i27654"),
    ("touch%2:35:01::", 5, "01208316", "i27653"),
    ("touch%2:35:04::", 8, "01209469", "i27655"),
    ("move%2:38:01::", 2, "01854282", "i30960"),
    ("resume%2:30:01::", 2, "00350937", "i23488"),
    ("reach%2:35:00::", 3, "01442758", "i28928"),
]
"""Senses that the thesis cites, and the one of reach that fits: key, number, offset, index."""

SYNSETS = st.sampled_from(list(wordnet()))


def test_the_lexicon_holds_every_verb_synset_of_wordnet_3_1() -> None:
    assert len(list(wordnet())) == 13789
    assert sum(len(each.senses) for each in wordnet()) == 25061
    assert len(wordnet().lemmas) == 11540


@pytest.mark.parametrize(("key", "number", "offset", "ili"), SETTLED)
def test_a_settled_sense_stands_where_it_should(
    key: str, number: int, offset: str, ili: str
) -> None:
    synset = wordnet().of_key(key)
    assert (synset.offset, synset.ili) == (offset, ili)
    assert next(each.number for each in synset.senses if each.key == key) == number


@given(SYNSETS)
def test_a_synset_is_found_by_each_of_its_names(synset: Synset) -> None:
    words = wordnet()
    for sense in synset.senses:
        assert words.of_key(sense.key) == synset
        assert (sense, synset) in words.of_lemma(sense.lemma)


@given(SYNSETS)
def test_what_is_above_a_synset_has_it_below(synset: Synset) -> None:
    words = wordnet()
    for above, steps in words.steps_above(synset).items():
        assert (synset in words.directly_below(above)) == (above.offset in synset.hypernyms)
        assert steps > 0
    assert all(frame_sentence(each) for each in synset.frames)


def test_senses_of_a_verb_come_in_their_order() -> None:
    numbers = [sense.number for sense, _ in wordnet().of_lemma("Pick up")]
    assert numbers == list(range(1, len(numbers) + 1))


def test_an_unknown_sense_is_answered_with_the_verbs_own() -> None:
    with pytest.raises(UnknownNameError, match=r"hit%2:35:99.*hit%2:35:00::"):
        wordnet().of_key("hit%2:35:99::")


def test_every_sense_that_we_claim_is_one_of_its_verb() -> None:
    for row in table("motion_senses"):
        synset = wordnet().of_key(row["key"])
        assert row["verb"] in synset.lemmas
