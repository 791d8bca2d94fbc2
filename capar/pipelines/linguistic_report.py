"""The pipeline of the linguistic report: the rule base's words, the lexical rules, the report."""

import json
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from capar.model.errors import FileError, RuleError
from capar_rules.authoring.user_primitives import read_examples
from capar_rules.engine.solver import rule_file, solve
from kb.lexicon.links import PrimitiveWords
from kb.lexicon.loading import every_verbnet_member, verbnet_of
from kb.lexicon.verbs import (
    Case,
    Seen,
    Standing,
    VerbAnswer,
    about,
    keys_of_primitives,
    lexical_facts,
    seen_in,
    verbnet_members,
)
from kb.reports.linguistics import LinguisticReport, assemble

if TYPE_CHECKING:
    from kb.store.stores import Store

MAIN = "lexical/main.lp"

_TEXT = re.compile(r'"(?:[^"\\]|\\.)*"')
_TEXT_OR_COMMENT = re.compile(rf"({_TEXT.pattern})|%\*.*?\*%|%[^\n]*", re.DOTALL)
_NAMED = re.compile(r'^=> named\(.*,\s*"([^"]+)"\)', re.MULTILINE)
_CASE = re.compile(r"^%% ", re.MULTILINE)
_SAID = re.compile(rf"{_TEXT.pattern}|0|[1-9]\d*")
_FACT = re.compile(
    rf"(?:^|\.)\s*(?P<predicate>[a-z]\w*)\((?P<arguments>\s*{_TEXT.pattern}"
    rf"(?:\s*,\s*(?:{_SAID.pattern}))*\s*)\)\s*(?=\.)",
    re.MULTILINE,
)


def primitive_files(added: Iterable[Path] = ()) -> tuple[Path, ...]:
    """The rule files of primitives that ship, by name, and the user's."""
    return (*sorted(rule_file("primitives").glob("*.lp")), *sorted(added))


def primitive_words(files: Sequence[Path]) -> tuple[PrimitiveWords, ...]:
    """What the rule files call their primitives: the facts that each states, as they stand.

    Raises:
        FileError: A rule file that cannot be read.
        RuleError: Two files state one primitive.
    """
    found: dict[str, PrimitiveWords] = {}
    for path in files:
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise FileError(path, f"cannot be read ({error});", "name a rule file.") from None
        stated: dict[str, list[tuple[str, ...]]] = {}
        for match in _FACT.finditer(_TEXT_OR_COMMENT.sub(r"\1", text)):
            arguments = tuple(str(json.loads(each)) for each in _SAID.findall(match["arguments"]))
            stated.setdefault(match["predicate"], []).append(arguments)
        for (name,) in (each for each in stated.get("primitive", ()) if len(each) == 1):
            if name in found:
                raise RuleError(
                    f"{path}: primitive {name!r} is also stated by {found[name].file}; "
                    "one file states a primitive"
                )
            verbs, general, senses, levin, prepositions = (
                tuple(row[1] for row in stated.get(kind, ()) if row[0] == name and len(row) == 2)
                for kind in ("verb", "specialises", "sense", "levin", "preposition")
            )
            file = f"{path.parent.name}/{path.name}"
            found[name] = PrimitiveWords(name, verbs, general, senses, levin, prepositions, file)
    return tuple(sorted(found.values()))


def cases_of(files: Sequence[Path], folder: Path | None = None) -> tuple[Case, ...]:
    """Cases that show primitives: examples in the rule files, and expectations in a folder.

    Raises:
        FileError: The folder is none.
        RuleError: An example has a fault.
    """
    found = set[Case]()
    for path in files:
        examples = read_examples(path.read_text(encoding="utf-8"), file=path)
        stories = [each.story for each in examples if each.positive]
        for words in primitive_words([path]):
            found |= {Case(words.name, f"{words.file}: {story}") for story in stories}
    if folder is not None:
        if not folder.is_dir():
            raise FileError(folder, "is no folder;", "name one that holds rule cases.")
        for path in sorted(folder.rglob("*.cases")):
            place = str(path.relative_to(folder).with_suffix(""))
            for text in _CASE.split(path.read_text(encoding="utf-8"))[1:]:
                title = text.splitlines()[0]
                found |= {Case(name, f"{place}: {title}") for name in _NAMED.findall(text)}
    return tuple(sorted(found))


def linguistics(
    files: Sequence[Path] = (),
    *,
    store: "Store | None" = None,
    cases: Sequence[Case] = (),
) -> LinguisticReport:
    """The linguistic report over rule files of primitives and a store's observations."""
    chosen = tuple(files) or primitive_files()
    words = primitive_words(chosen)
    seen: tuple[Seen, ...] = seen_in(store) if store else ()
    members = verbnet_members(every_verbnet_member(store)) if store else {}
    # The names of every rule file that counts: what ships beside the primitives, and these.
    rules = sorted({each.stem for each in (*rule_file("").rglob("*.lp"), *chosen)})
    facts = lexical_facts(words, members=members, rules=rules, seen=seen, cases=cases)
    rows: dict[str, list[tuple[str, ...]]] = {}
    for predicate, arguments in solve([rule_file(MAIN)], facts).atoms:
        rows.setdefault(predicate, []).append(tuple(map(str, arguments)))
    return assemble(rows, words, seen, members)


def standing(verb: str, words: Sequence[PrimitiveWords]) -> Standing:
    """How the rule base stands to a verb, by the lexical rules."""
    facts = lexical_facts(words, members={}, verbs=(verb,), classes=False)
    answer = solve([rule_file(MAIN)], facts)

    does, general = (
        tuple(str(row[0]) for row in answer.of(predicate) if row[1] == verb)
        for predicate in ("represents", "generalises")
    )
    return Standing(does, () if does else general)


def answer_verb(
    verb: str, words: Sequence[PrimitiveWords], *, store: "Store | None" = None
) -> VerbAnswer:
    """Everything that is known of a verb.

    Raises:
        UnknownNameError: Neither WordNet nor the rule base has it.
    """
    plain = " ".join(verb.lower().replace("_", " ").split())
    return about(
        plain,
        standing=standing(plain, words),
        keys_of=keys_of_primitives(words),
        verbnet=verbnet_of(store, plain.replace(" ", "_")) if store else (),
        seen=seen_in(store) if store else (),
    )
