"""Read a rule file defensively: its size, characters and includes, then its statements."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from capar.model.errors import RuleError
from capar.model.facts import LARGEST
from capar_rules.engine.syntax import LARGEST_BYTES, Place, Statement, parse_text
from capar_rules.lint.findings import Finding
from capar_rules.lint.solver_messages import solver_findings

DEEPEST = 100
"""Greatest depth of nested brackets: deeper ones overflow the parser's stack."""

_INCLUDE = re.compile(r"#include\s*(\"([^\"\n]*)\"|<([^>\n]*)>|\S*)[^.\n]*\.?")
_STRING_OR_COMMENT = re.compile(r'"(?:[^"\\\n]|\\.)*"|%\*.*?\*%|%[^\n]*', re.DOTALL)


@dataclass(frozen=True)
class Reading:
    """A rule file's statements, or the findings that prevent parsing it."""

    file: str
    text: str
    statements: tuple[Statement, ...]
    findings: tuple[Finding, ...]
    included: tuple[Path, ...] = ()
    """Rule files that it includes."""


def read_rules(path: Path, *, folders: Iterable[Path] = ()) -> Reading:
    """Read a rule file; nothing in it is executed.

    Args:
        path: The file.
        folders: Folders of rules; what lies in one of them may be included.
    """
    text, findings = _text(path)
    if not findings:
        findings = list(_tokens(text, path, tuple(folders)))
    if findings:
        return Reading(str(path), text, (), tuple(findings))
    included = []
    for found in _includes(text):
        included.append(path.parent / found[2])
        text = text[: found.start()] + _blank(found) + text[found.end() :]
    try:
        statements = parse_text(text)
    except RuleError as error:
        return Reading(str(path), text, (), tuple(solver_findings(str(error), str(path))))
    placed = tuple(_placed(each, str(path)) for each in statements)
    return Reading(str(path), text, placed, (), tuple(included))


def _text(path: Path) -> tuple[str, list[Finding]]:
    start = Place(str(path), 1, 1)
    if not path.is_file():
        return "", [Finding(start, "no-file", "there is no such file.", "Name a rule file, *.lp.")]
    if path.stat().st_size > LARGEST_BYTES:
        return "", [
            Finding(
                start, "too-large", f"it has more than {LARGEST_BYTES // 1024} kB.",
                "Split it: one primitive a file.",
            )
        ]  # fmt: skip
    try:
        content = path.read_bytes()
    except OSError as error:
        message = f"it cannot be read: {error.strerror}."
        return "", [
            Finding(start, "no-file", message, "Grant yourself read permission, or move it.")
        ]
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        place = Place(str(path), line, error.start - content.rfind(b"\n", 0, error.start))
        return "", [Finding(place, "encoding", "this is no UTF-8 text.", "Save it as UTF-8.")]
    return text, []


def _tokens(text: str, path: Path, folders: tuple[Path, ...]) -> Iterator[Finding]:
    """What is refused before anything is parsed: it could harm the parser or read other files."""
    bare = _STRING_OR_COMMENT.sub(_blank, text)
    if "\0" in text:
        yield _at(text, text.index("\0"), path, "encoding", "there is a zero byte.", "Remove it.")
    if text.startswith("\ufeff"):
        yield _at(text, 0, path, "encoding", "there is a byte-order mark.", "Save it without one.")
    for found in list(re.finditer(r"(?!\A)[^\x00-\x7f]|\A[^\x00-\x7f\ufeff]", bare))[:1]:
        yield _at(
            text, found.start(), path, "syntax", f"{found[0]!r} is not allowed in rules.",
            "Outside quoted texts and comments, write ASCII letters and digits.",
        )  # fmt: skip
    for found in re.finditer(r"\b\d{10,}\b", bare):
        if int(found[0][:20]) > LARGEST:
            yield _at(
                text, found.start(), path, "number", f"{found[0][:20]} is too large for the rules.",
                f"Stay within {LARGEST}: millimetres, frames and milliseconds do.",
            )  # fmt: skip
    for found in re.finditer(r"#program\b", bare):
        yield _at(
            text, found.start(), path, "refused-statement", "#program is refused: rules stand in "
            "one program.", "Remove it.",
        )  # fmt: skip
    for found in re.finditer(r"#script\b", bare):
        yield _at(
            text, found.start(), path, "script", "#script runs code and is refused.",
            "Remove it; rules are logic alone.",
        )  # fmt: skip
    for found in _includes(text):
        name = found[2] or found[3] or ""
        target = (path.parent / name).resolve()
        inside = any(target.parent == each.resolve() for each in folders) and name.endswith(".lp")
        if found[2] is None or not inside or not target.is_file():
            yield _at(
                text, found.start(), path, "include",
                f"#include of {name!r} reaches outside the rule folders and is refused.",
                "The rule base is there already; include only rule files beside this one.",
            )  # fmt: skip
    depth = deepest = 0
    for sign in bare:
        depth += (sign in "([{") - (sign in ")]}")
        deepest = max(deepest, depth)
    if deepest > DEEPEST:
        yield Finding(
            Place(str(path), 1, 1), "too-deep", f"brackets nest {deepest} deep.",
            f"Nest them at most {DEEPEST} deep.",
        )  # fmt: skip


def _includes(text: str) -> list[re.Match[str]]:
    """Every #include outside comments; a % in a quoted text begins no comment."""
    return list(_INCLUDE.finditer(_STRING_OR_COMMENT.sub(_blank_comment, text)))


def _blank_comment(found: re.Match[str]) -> str:
    return found[0] if found[0].startswith('"') else _blank(found)


def _blank(found: re.Match[str]) -> str:
    return re.sub(r"[^\n]", " ", found[0])


def _at(text: str, at: int, path: Path, code: str, message: str, remedy: str) -> Finding:
    line = text.count("\n", 0, at) + 1
    return Finding(Place(str(path), line, at - text.rfind("\n", 0, at)), code, message, remedy)


def _placed(statement: Statement, file: str) -> Statement:
    """The statement with its file's name in all its places."""

    def here(place: Place) -> Place:
        return replace(place, file=file)

    return replace(
        statement,
        place=here(statement.place),
        heads=tuple(replace(each, place=here(each.place)) for each in statement.heads),
        body=tuple(
            replace(
                each,
                place=here(each.place),
                atoms=tuple(replace(atom, place=here(atom.place)) for atom in each.atoms),
            )
            for each in statement.body
        ),
        external=tuple(map(here, statement.external)),
    )
