"""What rule files introduce, and which of them rest on what others introduce."""

import re
from collections.abc import Sequence
from pathlib import Path

from capar_rules.engine.slicing import FITS
from capar_rules.engine.syntax import Statement, split_arguments
from capar_rules.lint.rule_text import read_rules

_LIKELY = re.compile(r'\bprimitive\s*\(\s*"([^"\n]*)"\s*\)\s*\.')


def introduced(path: Path) -> list[str]:
    """The primitives that a rule file states, in their order.

    Of a file that is no logic program, those that it seems to state, so that it can be removed.
    """
    reading = read_rules(path, folders=(path.parent,))
    if reading.findings:
        return list(dict.fromkeys(_LIKELY.findall(reading.text)))
    return list(
        dict.fromkeys(
            split_arguments(head.text)[0].strip('"')
            for each in reading.statements
            for head in each.heads
            if head.signature == ("primitive", 1)
        )
    )


def dependants(path: Path, *, files: Sequence[Path]) -> dict[str, Path]:
    """Primitives of other rule files that rest on what a file introduces, each with its file.

    They specialise it, or a rule of theirs asks whether a segment fits it.
    """
    names = set(introduced(path))
    found: dict[str, Path] = {}
    for each in files:
        if each.resolve() != path.resolve():
            reading = read_rules(each, folders=(each.parent,))
            if any(names & _read(rule) for rule in reading.statements):
                found |= dict.fromkeys(introduced(each) or [each.stem], each)
    return found


def _read(rule: Statement) -> set[str]:
    """The primitives that a rule rests on."""
    atoms = [each for each in rule.heads if each.signature == ("specialises", 2)]
    atoms += [atom for each in rule.body for atom in each.atoms if atom.signature == FITS]
    return {split_arguments(each.text)[1].strip('"') for each in atoms}
