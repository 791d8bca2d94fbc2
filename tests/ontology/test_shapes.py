"""Every shape has an example that it passes and one that it refuses, and both judges agree."""

import re
from pathlib import Path

import pytest
from observations import drink_from_mug, pick_up_with_both_hands, with_unknown
from pyoxigraph import RdfFormat, Triple, parse

from kb.checks import by_shacl
from kb.encode.observation import encode
from kb.store.validation import by_thing, rules, violations
from ontology.files import shape_files

HERE = Path(__file__).parent
NAMES = [file.name.removesuffix(".ttl") for file in shape_files()]
WORDS = {
    "path", "nodeKind", "datatype", "minCount", "maxCount", "minInclusive", "maxInclusive", "in",
    "pattern", "lessThanOrEquals", "class", "message", "property", "targetClass", "NodeShape",
    "IRI",
}  # fmt: skip
"""What of SHACL the fast judge reads."""


def triples(path: Path) -> list[Triple]:
    return [each.triple for each in parse(path.read_bytes(), format=RdfFormat.TURTLE)]


def fast(stated: list[Triple]) -> set[tuple[str, str]]:
    return {
        (thing, message)
        for thing, _, message in (line.partition(": ") for line in violations(by_thing(stated)))
    }


def test_there_is_a_valid_and_an_invalid_example_for_each_shape_and_no_other() -> None:
    for folder in ("valid", "invalid"):
        assert sorted(path.stem for path in (HERE / folder).glob("*.ttl")) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_the_valid_example_is_passed_by_both_judges(name: str) -> None:
    stated = triples(HERE / "valid" / f"{name}.ttl")
    assert fast(stated) == set()
    assert by_shacl(stated) == []


@pytest.mark.parametrize("name", NAMES)
def test_each_thing_of_the_invalid_example_is_refused_alike(name: str) -> None:
    stated = triples(HERE / "invalid" / f"{name}.ttl")
    found = fast(stated)
    assert found == set(by_shacl(stated))
    things = {str(e.subject).strip("<>").split("/")[-1] for e in stated}
    assert {thing for thing, _ in found} == {e for e in things if not e.startswith("right_")}
    asked = {rule.message for rule in rules() if rule.shape.endswith(f"#{_shape(name)}>")}
    assert {message for _, message in found} == asked


def _shape(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


def test_messages_are_sentences_without_names_of_the_machinery() -> None:
    for rule in rules():
        assert re.fullmatch(r"[A-Z][^#<>{}]+\.", rule.message), rule.message
        assert "sh:" not in rule.message and "xsd" not in rule.message


def test_shapes_use_only_what_the_fast_judge_reads() -> None:
    for file in shape_files():
        assert set(re.findall(r"\bsh:(\w+)", file.read_text("utf-8"))) <= WORDS


@pytest.mark.parametrize("made", [drink_from_mug, pick_up_with_both_hands, with_unknown])
def test_observations_pass_both_judges(made: object) -> None:
    assert callable(made)
    stated = [each.triple for each in encode(made()).quads]
    assert fast(stated) == set()
    assert by_shacl(stated) == []
