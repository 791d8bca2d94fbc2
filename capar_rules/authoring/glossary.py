"""The glossary of a rule base, read from the comments of its files.

A comment explains a predicate in a line such as ``   rises(Segment, Body)   it goes up``; inputs
and constants are explained at the end of their line. A predicate without explanation is internal
to its file.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from capar.model.errors import UnknownNameError
from capar_rules.engine.profiles import Profile
from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Place, Signature, parse, split_arguments
from capar_rules.lint.text_checks import known

_ATOM = r"[a-z_]\w*\((?:[^()]|\([^()]*\))*\)"
_DEFINED = re.compile(
    rf"#defined\s+(\w+)/0\.\s*%\s*(.+)|#defined\s+\w+/\d+\.\s*%\s*({_ATOM}):?\s*(.*)"
)
_CONSTANT = re.compile(r"#const\s+(\w+)\s*=\s*([^.]+)\.\s*%\s*(.+)")
_ENTRY = re.compile(rf" {{3}}({_ATOM})(?: +(\S.*)|$)")
_NOTE = re.compile(rf"%\s*({_ATOM}):\s+(.*)")
_COMMENT = re.compile(r"%\*.*?\*%", re.DOTALL)
INPUTS = "inputs.lp"
"""The file that explains the measured facts."""

_INDENT = 3
"""Indentation of the entries of a comment; continuation lines are indented further."""


STATED = (
    ("verb(Name, Verb)", "a rule file may state it: the English verb for the primitive"),
    ("sense(Name, Number)", "a rule file may state it: which of the verb's senses in WordNet"),
    ("levin(Name, Class)", "a rule file may state it: the verb class in Levin's book, as text"),
    ("purpose_of(Name, Purpose)", "a rule file may state it: what the primitive is done for"),
    ("also(Atom, Other)", "a rule file may state it: where Atom is told in reasons, Other is too"),
)
"""Predicates that a rule file may define, though no shipped rule reads or defines them."""


@dataclass(frozen=True, slots=True, order=True)
class Word:
    """A predicate or constant with its explanation."""

    file: str
    line: int
    """From one; zero if no rule file explains it."""

    name: str
    arguments: tuple[str, ...]
    meaning: str

    @property
    def signature(self) -> Signature:
        """The name with its number of arguments."""
        return self.name, len(self.arguments)

    def __str__(self) -> str:
        """The word as a rule writes it."""
        return f"{self.name}({', '.join(self.arguments)})" if self.arguments else self.name


def words_of_text(text: str, *, file: str) -> Iterator[Word]:
    """The predicates and constants that the comments of a rule file explain, in order."""
    found = [*_lines(text), *_entries(text)]
    for line, atom, meaning in sorted(found):
        name, arguments = atom.partition("(")[0], split_arguments(atom) if "(" in atom else []
        yield Word(file, line, name, tuple(arguments), meaning.rstrip("."))


def _lines(text: str) -> Iterator[tuple[int, str, str]]:
    """Entries of one line: inputs, constants, and comments between the rules."""
    for number, line in enumerate(text.splitlines(), 1):
        if found := _DEFINED.match(line):
            yield number, found[1] or found[3], found[2] or found[4]
        elif found := _CONSTANT.match(line):
            yield number, found[1], f"{found[3].rstrip('.')}; it is {found[2]}"
        elif found := _NOTE.match(line):
            yield number, found[1], found[2]


def _entries(text: str) -> Iterator[tuple[int, str, str]]:
    """Entries of comments that span several lines."""
    for comment in _COMMENT.finditer(text):
        first = text.count("\n", 0, comment.start()) + 1
        entry: tuple[int, str, str] | None = None
        before = ""
        for number, line in enumerate(comment[0].removesuffix("*%").splitlines(), first):
            indent = len(line) - len(line.lstrip())
            if found := _ENTRY.match(line):
                if entry:
                    yield entry
                    before = entry[2]
                meaning = (found[2] or "").strip()
                if before and meaning.startswith("..."):  # the meaning of the entry before
                    rest = meaning.removeprefix("...").strip()
                    meaning = f"{before}{' ' if rest.startswith('and ') else '; '}{rest}"
                entry = number, found[1], meaning
            elif entry and indent > _INDENT:
                entry = *entry[:2], f"{entry[2]} {line.strip()}"
            elif entry:
                yield entry
                entry, before = None, ""
        if entry:
            yield entry


@dataclass(frozen=True, slots=True)
class Glossary:
    """Every predicate and constant of a rule base."""

    words: tuple[Word, ...]
    """Those with an explanation, file by file: inputs and constants first, the user's own last."""

    internal: tuple[tuple[str, Signature], ...]
    """Predicates without explanation, each with its file."""

    defined: tuple[tuple[Signature, Place], ...]
    """Each predicate with the rules that define it."""

    primitives: frozenset[str]
    """The names of the primitives."""

    def find(self, name: str) -> tuple[Word, ...]:
        """The explanations of a word; several files may explain one.

        Raises:
            UnknownNameError: There is no such word.
        """
        found = tuple(each for each in self.words if each.name == name)
        found += tuple(
            Word(file, 0, word, ("_",) * arity, f"within {file} alone")
            for file, (word, arity) in self.internal
            if word == name
        )
        if not found:
            names = {each.name for each in self.words} | {word for _, (word, _) in self.internal}
            near = get_close_matches(name, sorted(names), n=5, cutoff=0.5)
            hint = f"; the nearest are {', '.join(near)}." if near else (
                "; `capar rules words` lists them."
            )  # fmt: skip
            if name in self.primitives:
                hint = (
                    f": it is a primitive. `capar rules show {name}` prints its rules; a rule asks "
                    f'for it with fits(Segment, "{name}").'
                )
            error = UnknownNameError("word of rules", name, names)
            error.args = (f"no word of rules {name!r}{hint}",)
            raise error
        return found

    def rules_of(self, signature: Signature) -> tuple[Place, ...]:
        """The places of the rules that define a predicate."""
        return tuple(dict.fromkeys(place for each, place in self.defined if each == signature))


def glossary(rules: Profile) -> Glossary:
    """The glossary of a rule base, from the comments of its files.

    Raises:
        RuleError: A file is no logic program.
    """
    statements = parse(rules.files)
    vocabulary = known(statements)
    first = [str(rule_file(INPUTS)), str(rule_file("thresholds.lp"))]
    others = {each.place.file for each in statements if each.place.file} - {*first}
    mine = [str(each) for each in rules.added]
    ordered = [*first, *sorted(others - {*mine}), *mine]
    words = [
        word
        for each in ordered
        for word in words_of_text(Path(each).read_text(encoding="utf-8"), file=_short(each))
    ]
    stated = [
        Word("any rule file", 0, text.partition("(")[0], tuple(split_arguments(text)), meaning)
        for text, meaning in STATED
    ]
    explained = {each.signature for each in (*words, *stated)}
    internal = {
        (_short(each.place.file), head.signature)
        for each in statements
        for head in each.heads
        if head.signature not in explained
    }
    return Glossary(
        (*words, *stated),
        tuple(sorted(internal)),
        tuple((head.signature, each.place) for each in statements for head in each.heads),
        frozenset(vocabulary.primitives),
    )


def _short(file: str) -> str:
    """A file's path; for shipped files relative to capar_rules."""
    path, home = Path(file), rule_file("inputs.lp").parent
    return str(path.relative_to(home)) if path.is_relative_to(home) else file
