"""Slips of the pen in rule files are found, each with the word that was meant."""

from pathlib import Path

import pytest

from capar_rules.lint.checker_process import Request, base_of
from capar_rules.lint.checking import answer
from capar_rules.lint.findings import ERROR, NOTE, Finding, errors
from capar_rules.lint.word_checks import slip_findings

HEAD = '%* Nip: a slip. *%\nprimitive("Nip").\nspecialises("Nip", "Touch").\n'

SLIPS = {
    'fits(segment, "Nip") :- fits(Segment, "Touch").': (
        "constant-segment", 'Variables begin with a capital: fits(Segment, "Nip").',
    ),
    'fits(S, "Nip") :- fits(S, "Touch"), segment(segment, _, _).': (
        "constant-argument", "Variables begin with a capital: Segment.",
    ),
    'fits(S, "Nip") :- fits(S, "Tuoch").': ("unknown-primitive", "Did you mean Touch?"),
    'fits(S, Nip) :- fits(S, "Touch").': (
        "missing-quotes", 'Names of primitives are texts: "Nip".',
    ),
    'fits(S, "Nip") :- fits(S, Touch).': (
        "missing-quotes", 'Names of primitives are texts: "Touch".',
    ),
    'fits(S, "Nip") :- fits(S, touch).': (
        "missing-quotes", 'Names of primitives are texts: "Touch".',
    ),
    'fits(S, "Nip") :- fits(S, "Touch"), object_at(S, 0, O), tag(O, mobil).': (
        "unknown-word", "Did you mean mobile?",
    ),
    'fits(S, "Nip") :- fits(S, "Touch"), object_at(S, 0, O), not tag(O, mobil).': (
        "unknown-word", "Did you mean mobile?",
    ),
    'fits(seg(H, F), "Nip") :- segment(seg(H, F), F, _), link(H, _, lefft).': (
        "unknown-word", "Did you mean left?",
    ),
    'fits(S, "Nip") :- preposition(S, "unto", _, _).': ("unknown-word", "Did you mean onto?"),
    'fits(S, "Nip") :- preposition(S, onto, _, _).': ("missing-quotes", 'Write "onto".'),
    'fits(S, "Nip") :- fits(S, "Touch"), frame_at(S, "end", _).': (
        "needless-quotes", "Write end.",
    ),
    'fits(S, "Nip") :- fits(S, "Touch"), frame_at(S, ende, _).': (
        "unknown-word", "Did you mean end?",
    ),
    'fits(S, "Nip") :- fits(S, "Touch"), #count { O : on(S, enb, O, _) } > 0.': (
        "unknown-word", "Did you mean end?",
    ),
}  # fmt: skip
"""A rule with a slip; the finding, and how its remedy ends."""


def checked(folder: Path, *texts: str) -> list[tuple[Finding, ...]]:
    paths = [folder / f"nip_{number}.lp" for number in range(len(texts))]
    for path, text in zip(paths, texts, strict=True):
        path.write_text(text)
    return [answer(Request((str(path),), "extended")) for path in paths]


@pytest.fixture(scope="module")
def found_in(tmp_path_factory) -> dict[str, tuple[Finding, ...]]:
    found = checked(tmp_path_factory.mktemp("slips"), *(f"{HEAD}{each}\n" for each in SLIPS))
    return dict(zip(SLIPS, found, strict=True))


@pytest.mark.parametrize("rule", SLIPS)
def test_a_slip_is_found_with_the_word_that_was_meant(found_in, rule):
    code, remedy = SLIPS[rule]
    found = [each for each in errors(found_in[rule]) if each.code == code]
    assert any(each.remedy.endswith(remedy) for each in found), found_in[rule]
    assert {each.place.line for each in found} == {4}


@pytest.mark.parametrize("profile", ["extended", "thesis"])
def test_no_rule_that_ships_has_a_slip(profile):
    base = base_of(profile)
    named = [each for each in base.rules if each.place.file.endswith(("naming.lp", "position.lp"))]
    others = [each for each in base.rules if each not in named]
    assert [str(each) for each in slip_findings(others, base)] == []


def test_words_of_ones_own_and_kinds_that_are_rare_are_no_errors(tmp_path):
    own = (
        'fits(S, "Nip") :- fits(S, "Touch"), lively(S, much), named_here("Nip").\n'
        "lively(seg(H, F), much) :- segment(seg(H, F), F, _), link(H, elbow, _).\n"
        'named_here("Nip").\n'
    )
    (found,) = checked(tmp_path, HEAD + own)
    assert [each.code for each in found if "slip" not in each.remedy and each.code in {
        "unknown-word", "constant-argument", "missing-quotes", "unknown-primitive",
    }] == ["unknown-word"]  # fmt: skip
    (kind,) = [each for each in found if each.code == "unknown-word"]
    assert (kind.level, "elbow" in kind.message) == (NOTE, True)


def test_a_variable_that_joins_nothing_is_noted_and_an_anonymous_one_is_not(tmp_path):
    rule = 'fits(Segment, "Nip") :- fits(Segment, "Touch"), object_at(Segment, {}, Object), '
    rule += "tag(Object, mobile).\n"
    loose, fine = checked(tmp_path, HEAD + rule.format("Place"), HEAD + rule.format("_"))
    (note,) = [each for each in loose if each.code == "single-variable"]
    assert (note.level, note.message) == (NOTE, "Place occurs only once in this rule.")
    assert [each for each in fine if each.code == "single-variable"] == []


MISTAKES = {
    'primitive("nip it; good").': "bad-name",
    'primitive( "nip" ).': "bad-name",
    "primitive(nip).": "missing-quotes",
    'primitive("Nip").': "nothing-fits",
    'primitive("Nip"). primitive("Touch").': "taken-name",
    'primitive( "Touch" ).': "taken-name",
}
"""Primitives stated alone, each with what is wrong with it."""


@pytest.fixture(scope="module")
def found_in_names(tmp_path_factory) -> dict[str, tuple[Finding, ...]]:
    texts = (f"%* Nip: a slip. *%\n{each}\n" for each in MISTAKES)
    found = checked(tmp_path_factory.mktemp("names"), *texts)
    return dict(zip(MISTAKES, found, strict=True))


@pytest.mark.parametrize("stated", MISTAKES)
def test_names_that_cannot_be_and_what_nothing_fits_are_told(found_in_names, stated):
    found = {(each.code, each.level) for each in found_in_names[stated]}
    assert (MISTAKES[stated], ERROR) in found
