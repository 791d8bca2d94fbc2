"""Which rule file defines each name, and which thresholds its definition rests on."""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path

from capar.model.par import NamingRule, Threshold
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import loaded_files

CUTTING = "segmentation"
"""The folder of the rules that say where segments begin and end, whose thresholds cut and do not
name."""

THRESHOLDS = "thresholds.lp"

FITS = re.compile(r'fits\([^,"]+,\s*"(\w+)"\)')
_STATED = re.compile(r'primitive\("(\w+)"\)')
_COMMENT = re.compile(r'"[^"]*"|%\*.*?\*%|%[^\n]*', re.DOTALL)
_CONSTANT = re.compile(r"^#const (\w+) = (-?\d+)\.", re.MULTILINE)
_PREDICATE = re.compile(r"\b_*[a-z]\w*(?=\()")
_WORD = re.compile(r"\b[a-z]\w*\b")


@dataclass(frozen=True)
class _Statement:
    heads: frozenset[str]
    """Predicates, or ``fits NAME``."""

    reads: frozenset[str]
    words: frozenset[str]
    file: Path


def naming_rules(base: Profile, names: Iterable[str]) -> tuple[NamingRule, ...]:
    """The rules of a rule base that define these names, by name; unknown names have none."""
    known = _rules(base, base.fingerprint)
    return tuple(known[each] for each in sorted(set(names)) if each in known)


@cache
def _rules(base: Profile, fingerprint: str) -> Mapping[str, NamingRule]:
    del fingerprint  # what is kept holds for these texts alone
    texts = {each: each.read_text("utf-8") for each in loaded_files(base.files)}
    thresholds = {
        name: int(value) for text in texts.values() for name, value in _CONSTANT.findall(text)
    }
    statements = [s for file, text in texts.items() for s in _statements(file, text)]
    below = _Dependencies([each for each in statements if each.file.parent.name != CUTTING])
    found = {}
    for file, text in texts.items():
        for name in _STATED.findall(_COMMENT.sub(_strings, text)):
            words = below.words(name)
            rests_on = (Threshold(each, thresholds[each]) for each in sorted(words & {*thresholds}))
            digest = sha256(text.encode()).hexdigest()
            place = f"{file.parent.name}/{file.name}"
            found[name] = NamingRule(name, place, digest, text, tuple(rests_on))
    return found


class _Dependencies:
    """Which words a definition uses, and the vocabulary that it reads by name.

    A predicate of the vocabulary is followed within its own file, and to the thresholds; beyond,
    nearly everything depends on everything.
    """

    def __init__(self, statements: Iterable[_Statement]) -> None:
        self._defining: dict[str, list[_Statement]] = defaultdict(list)
        for statement in statements:
            for head in statement.heads:
                self._defining[head].append(statement)

    def words(self, name: str) -> frozenset[str]:
        own = self._defining.get(f"fits {name}", [])
        found = {word for each in own for word in each.words}
        seen = set[tuple[str, str]]()
        waiting = {(read, "") for each in own for read in each.reads}
        while waiting:
            read, file = waiting.pop()
            seen.add((read, file))
            for statement in self._defining.get(read, ()):
                if not file or statement.file.name in {file, THRESHOLDS}:
                    found |= statement.words
                    waiting |= {(below, statement.file.name) for below in statement.reads} - seen
        return frozenset(found)


def _statements(file: Path, text: str) -> Iterator[_Statement]:
    for statement in re.split(r"\.(?=\s)", _COMMENT.sub(_strings, text)):
        head, _, body = statement.partition(":-")
        yield _Statement(
            frozenset(_nodes(head)),
            frozenset(_nodes(body)),
            frozenset(_WORD.findall(statement)),
            file,
        )


def _nodes(text: str) -> set[str]:
    """The predicates in a text, and for each name whose fitting it speaks of a node of its own."""
    named = {f"fits {name}" for name in FITS.findall(text)}
    return named | (set(_PREDICATE.findall(text)) - ({"fits"} if named else set()))


def _strings(found: "re.Match[str]") -> str:
    """A string as it is, and nothing for a comment."""
    return found[0] if found[0].startswith('"') else ""
