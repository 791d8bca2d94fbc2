"""What rule files state of words is compared with the shipped tables."""

from pathlib import Path

import pytest

from capar.pipelines.linguistic_report import linguistics, primitive_files, primitive_words
from kb.lexicon.links import sense_links
from kb.lexicon.verbs import doubts, doubts_of
from kb.reports.formats import FORMATS, write


def cover(folder: Path, stated: str) -> Path:
    path = folder / "cover.lp"
    path.write_text(f'%* Cover: over all of it. *%\nprimitive("Cover").\n{stated}\n')
    return path


def test_a_verb_a_class_and_a_sense_that_there_are_leave_no_doubt() -> None:
    assert doubts("cover", ("9.8",), ("1", "cover%2:35:00::")) == ()
    assert doubts("pick up", (), ()) == ()


def test_each_unknown_is_told_with_what_is_near_it() -> None:
    verb, levin, sense = doubts("coverr", ("9.1", "99.9"), ("77",))
    assert verb.startswith("WordNet has no verb 'coverr'; the nearest are cover")
    assert levin.startswith("Levin has no class '99.9'; the nearest is 9.9")
    assert sense == "WordNet has no sense 77 of 'coverr'"


def test_a_known_verb_is_told_with_the_number_of_its_senses() -> None:
    (number,) = doubts("cover", (), ("26", "77"))
    assert number == "WordNet has no sense 77 of 'cover'; it has 1 to 26"
    (key,) = doubts("cover", (), ("cover%2:35:77::",))
    assert key.startswith("WordNet has no verb sense 'cover%2:35:77::'; the nearest are cover%2:35")


def test_a_verb_near_none_is_told_so() -> None:
    assert doubts("zzz", (), ()) == ("WordNet has no verb 'zzz', nor one near it",)


def test_nothing_that_ships_is_in_doubt() -> None:
    assert doubts_of(primitive_words(primitive_files())) == ()


def test_a_doubt_names_its_file_and_primitive(tmp_path: Path) -> None:
    path = cover(tmp_path, 'verb("Cover", "coverr"). levin("Cover", "99.9"). sense("Cover", 77).')
    found = doubts_of(primitive_words([path]))
    assert len(found) == 3
    for each in found:
        assert each.startswith(f"{tmp_path.name}/cover.lp: Cover: ")


def test_a_sense_is_stated_by_its_number_or_its_key(tmp_path: Path) -> None:
    (number,) = primitive_words([cover(tmp_path, 'verb("Cover", "cover"). sense("Cover", 2).')])
    assert [each.key for each in sense_links(number)] == ["cover%2:35:01::"]
    text = 'verb("Cover", "cover"). sense("Cover", "cover%2:35:01::").'
    (key,) = primitive_words([cover(tmp_path, text)])
    assert sense_links(key) == sense_links(number)


def test_a_sense_that_there_is_not_counts_as_not_stated(tmp_path: Path) -> None:
    (wrong,) = primitive_words([cover(tmp_path, 'verb("Cover", "cover"). sense("Cover", 77).')])
    (bare,) = primitive_words([cover(tmp_path, 'verb("Cover", "cover").')])
    assert sense_links(wrong) == sense_links(bare)


@pytest.mark.parametrize("form", [each for each in FORMATS if each not in {"csv", "svg"}])
def test_the_report_tells_the_doubts(tmp_path: Path, form: str) -> None:
    wrong = cover(tmp_path, 'verb("Cover", "coverr").')
    assert "coverr" in write(linguistics([wrong]), form)
    told = " ".join(write(linguistics([wrong]), form).replace(r"\allowbreak{}", "").split())
    assert "WordNet has no verb" in told
    assert "WordNet has no verb" not in write(linguistics(), form)
