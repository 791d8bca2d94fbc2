"""Rule files judged by their text, several together: every check that runs nothing of them."""

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path

from capar_rules.engine.solver import rule_file
from capar_rules.engine.syntax import Statement, parse
from capar_rules.lint.cycles import cycle_findings
from capar_rules.lint.findings import Finding, errors
from capar_rules.lint.rule_text import Reading, read_rules
from capar_rules.lint.termination import growth_findings
from capar_rules.lint.text_checks import Known, known, static_findings
from capar_rules.lint.word_checks import slip_findings
from capar_rules.lint.world_checks import unsafe_findings

Told = Finding | Path
"""What a judge tells: a finding, or the file that it comes to now."""


@cache
def base_of(profile: str) -> Known:
    """The words of what ships, for a profile."""
    return known(parse([rule_file(f"{profile}.lp")]))


def read_together(paths: Iterable[Path]) -> Iterator[Reading | Path]:
    """Read rule files and all that they include, each once; before each, its path."""
    waiting = list(paths)
    folders = sorted({each.parent for each in waiting})
    seen: set[Path] = set()
    for path in waiting:
        if path.resolve() not in seen:
            seen.add(path.resolve())
            yield path
            reading = read_rules(path, folders=folders)
            waiting += reading.included
            yield reading


def judge(paths: Sequence[Path], base: Known) -> Iterator[Told]:
    """What is wrong with rule files that are to count together, beside what ships.

    Args:
        paths: The files; what they include is judged with them.
        base: The words of what ships.
    """
    readings = []
    for each in read_together(paths):
        if isinstance(each, Path):
            yield each
        else:
            readings.append(each)
            yield from each.findings
    if any(errors(each.findings) for each in readings):
        return
    for each in readings:
        yield Path(each.file)
        others = [other for other in readings if other is not each]
        yield from judge_one(each, whole(base, others))


def whole(base: Known, readings: Iterable[Reading]) -> Known:
    """The words of what ships, and of other files beside it."""
    added: list[Statement] = [rule for each in readings for rule in each.statements]
    return known([*base.rules, *added]) if added else base


def judge_one(reading: Reading, base: Known) -> Iterator[Finding]:
    """What is wrong with one file by its text alone; a stage with errors is the last."""
    own = reading.statements
    stages = (
        (*static_findings(own, base, file=reading.file), *slip_findings(own, base)),
        unsafe_findings(reading.text, reading.file),
        growth_findings(own),
        cycle_findings(own, base.rules),
    )
    for stage in stages:
        found = tuple(stage)
        yield from found
        if errors(found):
            return
